"""BSM: a streaming spectral codec and denoiser for triangle meshes, static and animated.

`encode` compresses a mesh to bytes, and `decode` restores it. Options are keywords, named as on the command line:

>>> import bsm
>>> corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
>>> mesh = bsm.TriangleMesh(corners, [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)])
>>> data = bsm.encode(mesh, theta=5)
>>> bsm.decode(data).faces.shape
(4, 3)
>>> bsm.compare(mesh, data).theta_deg < 5
True

Functions that take a `TriangleMesh` also take a mesh of trimesh, pyvista, Open3D or meshio, a pair (positions, faces),
or a file. Files and streams are given by their names, as bytes or opened. `load` and `save` choose the format by its
suffix, including .bsm. A `Decoder` decodes a stream block by block while it arrives:

>>> with bsm.Decoder() as decoder:
...     [len(event.vertices) for event in decoder.events([data]) if isinstance(event, bsm.BlockEvent)]
[4]

Every error is a `BsmError`, but for an `OSError` where a file cannot be read or written. Only the names listed here are
stable; `bsm.codec` and `bsm.bitstream` are internal.
"""

import importlib
import importlib.util
import sys
from typing import Any

# The finder of an editable install would add the root of the checkout, and with it tools, tests and spec.
__path__ = [__file__.removesuffix("__init__.py")]

__version__ = "1.0.0"

try:
    _built = importlib.import_module("bsm._core").version
except ImportError:
    _built = "missing"
# Kernels of another version would mostly work, and now and then decode other bits.
if _built != __version__:
    raise ImportError(
        f"BSM {__version__} needs its compiled kernels, and they are {_built}: install both together, with "
        "`pip install .` (or `pip install -e .`) in the folder of pyproject.toml"
    )

# The public names of each module, which is loaded when one of them is first asked for. The build makes a stub of them
# for type checkers (tools/keywords.py).
_NAMES = {
    "bsm.account.comparison": "MeshComparison",
    "bsm.api": (
        "compare decode decode_frames decode_sequence denoise encode encode_frames encode_many "
        "encode_sequence info load look save"
    ),
    "bsm.bitstream.errors": (
        "ArgumentError BsmError BsmWarning CorruptError DependencyError FormatError HarmError LimitError "
        "MeshError NumericError OptionError TargetError TruncatedError UnsupportedError VerificationError"
    ),
    "bsm.bitstream.limits": "Limits",
    "bsm.codec.decoding": "Decoder SequenceDecoder",
    "bsm.codec.denoise": "DenoiseOptions",
    "bsm.codec.events": (
        "END_OF_STREAM NEED_DATA AttributeEvent BlockEvent ConnectivityEvent EndEvent FrameEvent HeaderEvent "
        "LossEvent RefinementEvent Signal"
    ),
    "bsm.codec.geometry.attributes": "Attribute",
    "bsm.codec.geometry.mesh": "TriangleMesh",
    "bsm.codec.geometry.metrics": "Comparison",
    "bsm.codec.look.measure": "Look",
    "bsm.codec.sequence.encoder": "SequenceEncoder",
    "bsm.codec.sequence.options": "SequenceOptions",
    "bsm.codec.sequence.targets": "SequenceTarget",
    "bsm.codec.static.encoder": "Encoder",
    "bsm.codec.static.options": "PRESETS EncodeOptions Paper",
    "bsm.codec.static.targets": "Contract Target",
    "bsm.files.formats.polygons": "MeshFile",
    "bsm.files.mesh": "read_mesh",
    "bsm.tiles.shards": "Tiles open_tiles",
    "bsm.viewer.notebook": "show",
}
_HOMES = {name: module for module, names in _NAMES.items() for name in names.split()}

__all__ = ["__version__", *_HOMES]


# Importing trimesh with every `import bsm` would take most of its time. So its import is watched for, and the watch
# ends with it.
class _Trimesh:
    """Let trimesh read and write .bsm from its import on."""

    @classmethod
    def find_spec(cls, name: str, path: Any = None, target: Any = None) -> Any:
        if name != "trimesh":
            return None
        sys.meta_path.remove(cls)
        spec: Any = importlib.util.find_spec(name)
        run = spec and spec.loader.exec_module

        def exec_module(module: Any) -> None:
            run(module)
            importlib.import_module("bsm.trimesh")

        if spec:
            spec.loader.exec_module = exec_module
        return spec


if "trimesh" in sys.modules:
    importlib.import_module("bsm.trimesh")
else:
    sys.meta_path.insert(0, _Trimesh)


def __getattr__(name: str) -> object:
    if name not in _HOMES:
        raise AttributeError(f"module 'bsm' has no attribute {name!r}")
    # Kept, so that the second use of a name does not come here.
    value = globals()[name] = getattr(importlib.import_module(_HOMES[name]), name)
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
