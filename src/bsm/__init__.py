"""BSM: a streaming spectral codec and denoiser for triangle meshes, static and animated.

A mesh is compressed to bytes and restored from them; what it takes and what it may cost is said by keyword, as on the
command line:

>>> import bsm
>>> corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
>>> mesh = bsm.TriangleMesh(corners, [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)])
>>> data = bsm.encode(mesh, theta=5)
>>> bsm.decode(data).faces.shape
(4, 3)
>>> bsm.compare(mesh, data).theta_deg < 5
True

Instead of a `TriangleMesh` there may be a mesh of trimesh, pyvista, Open3D or meshio, a pair (positions, faces), or the
name of a file; instead of bytes any buffer, the name of a file, or a binary file. `load` and `save` know every format
by its suffix, .bsm included. A stream that is still arriving is decoded block by block:

>>> with bsm.Decoder() as decoder:
...     [len(event.vertices) for event in decoder.events([data]) if isinstance(event, bsm.BlockEvent)]
[4]

Every error is a `BsmError`. Only what is listed here is promised to stay; the packages `bsm.codec` and
`bsm.bitstream` are where it lives.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

# The finder of an editable install would add the root of the checkout, and with it tools, tests and spec.
__path__ = [__file__.removesuffix("__init__.py")]

# What type checkers see; the same names as below.
# fmt: off
# isort: off
if TYPE_CHECKING:
    from bsm.bitstream.errors import (
        ArgumentError as ArgumentError, BsmError as BsmError, CorruptError as CorruptError,
        DependencyError as DependencyError, FormatError as FormatError, HarmError as HarmError,
        LimitError as LimitError, MeshError as MeshError, NumericError as NumericError, OptionError as OptionError,
        TargetError as TargetError, TruncatedError as TruncatedError, UnsupportedError as UnsupportedError,
        VerificationError as VerificationError,
    )
    from bsm.bitstream.limits import Limits as Limits
    from bsm.api import (
        compare as compare, decode as decode, decode_frames as decode_frames, decode_sequence as decode_sequence,
        denoise as denoise, encode as encode, encode_frames as encode_frames, encode_many as encode_many,
        encode_sequence as encode_sequence, load as load, look as look, save as save,
    )
    from bsm.comparison import MeshComparison as MeshComparison
    from bsm.files.mesh import read_mesh as read_mesh
    from bsm.tiles.shards import Tiles as Tiles, open_tiles as open_tiles
    from bsm.viewer.notebook import show as show
    from bsm.files.formats.polygons import MeshFile as MeshFile
    from bsm.codec.denoise import DenoiseOptions as DenoiseOptions
    from bsm.codec.geometry.attributes import Attribute as Attribute
    from bsm.codec.geometry.mesh import TriangleMesh as TriangleMesh
    from bsm.codec.geometry.metrics import Comparison as Comparison
    from bsm.codec.look.measure import Look as Look
    from bsm.decoding import Decoder as Decoder, SequenceDecoder as SequenceDecoder
    from bsm.codec.sequence.encoder import SequenceEncoder as SequenceEncoder
    from bsm.codec.sequence.options import SequenceOptions as SequenceOptions
    from bsm.codec.sequence.targets import SequenceTarget as SequenceTarget
    from bsm.codec.static.encoder import Encoder as Encoder
    from bsm.events import (
        END_OF_STREAM as END_OF_STREAM, NEED_DATA as NEED_DATA, AttributeEvent as AttributeEvent,
        BlockEvent as BlockEvent, ConnectivityEvent as ConnectivityEvent, EndEvent as EndEvent,
        FrameEvent as FrameEvent, HeaderEvent as HeaderEvent, LossEvent as LossEvent,
        RefinementEvent as RefinementEvent, Signal as Signal,
    )
    from bsm.codec.static.options import PRESETS as PRESETS, EncodeOptions as EncodeOptions, Paper as Paper
    from bsm.codec.static.targets import Contract as Contract, Target as Target
# isort: on
# fmt: on

__version__ = "1.0.0"

try:
    _built = importlib.import_module("bsm._kernels").version
except ImportError:
    _built = "missing"
if _built != __version__:
    raise ImportError(
        f"BSM {__version__} needs its compiled kernels, and they are {_built}: install both together, with "
        "`pip install .` (or `pip install -e .`) in the folder of pyproject.toml"
    )

# Where each name lives, loaded when it is first asked for.
_ROOMS = {
    "bsm.bitstream.errors": (
        "ArgumentError BsmError CorruptError DependencyError FormatError HarmError LimitError MeshError NumericError "
        "OptionError TargetError TruncatedError UnsupportedError VerificationError"
    ),
    "bsm.bitstream.limits": "Limits",
    "bsm.api": (
        "compare decode decode_frames decode_sequence denoise encode encode_frames encode_many encode_sequence load "
        "look save"
    ),
    "bsm.comparison": "MeshComparison",
    "bsm.files.mesh": "read_mesh",
    "bsm.tiles.shards": "Tiles open_tiles",
    "bsm.viewer.notebook": "show",
    "bsm.files.formats.polygons": "MeshFile",
    "bsm.codec.denoise": "DenoiseOptions",
    "bsm.codec.geometry.attributes": "Attribute",
    "bsm.codec.geometry.mesh": "TriangleMesh",
    "bsm.codec.geometry.metrics": "Comparison",
    "bsm.codec.look.measure": "Look",
    "bsm.decoding": "Decoder SequenceDecoder",
    "bsm.codec.sequence.encoder": "SequenceEncoder",
    "bsm.codec.sequence.options": "SequenceOptions",
    "bsm.codec.sequence.targets": "SequenceTarget",
    "bsm.codec.static.encoder": "Encoder",
    "bsm.events": (
        "END_OF_STREAM NEED_DATA AttributeEvent BlockEvent ConnectivityEvent EndEvent FrameEvent HeaderEvent LossEvent "
        "RefinementEvent Signal"
    ),
    "bsm.codec.static.options": "PRESETS EncodeOptions Paper",
    "bsm.codec.static.targets": "Contract Target",
}
_HOMES = {name: room for room, names in _ROOMS.items() for name in names.split()}

__all__ = ["__version__", *_HOMES]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'bsm' has no attribute {name!r}")
    value = globals()[name] = getattr(importlib.import_module(_HOMES[name]), name)
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
