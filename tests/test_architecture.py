"""The arrows of CONTRIBUTING.md: which package may import which."""

import ast
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
KNOW_BYTES = ("bsm.codec.static", "bsm.codec.sequence")
KNOWN_TO_ALL = tuple(f"bsm.bitstream.{name}" for name in ("errors", "limits", "once"))
FLOORS = {
    "bsm": (
        ("bitstream", "__version__", "_engine", "_kernels"),
        ("codec",),
        ("console", "events", "lengths", "pictures"),
        ("decoding",),
        ("files",),
        ("comparison", "evaluation", "exits", "options"),
        ("libraries",),
        ("jobs",),
        ("api",),
        ("blender", "gltf", "research", "viewer"),
        ("tiles", "vtk"),
        ("pyvista", "trimesh"),
        # Finds the module of a command by its name.
        ("cli",),
        ("commands",),
        ("__main__",),
    ),
    "bsm.codec": (
        ("_kernels", "arrays", "choices", "threads"),
        # Encoders decode what they wrote: by the compiled decoder, which stands below everything.
        ("geometry",),
        ("decoded",),
        ("blocks", "look"),
        ("basis",),
        ("signal",),
        ("static", "denoise"),
        ("sequence",),
    ),
    "bsm.bitstream": (
        ("_kernels", "errors", "once"),
        ("limits",),
        ("entropy",),
        ("connectivity", "coefficients", "fields"),
        ("attributes",),
        ("container",),
    ),
    "bsm.codec.static": (
        ("work",),
        ("coding", "targets", "units"),
        ("preamble_encoding",),
        ("attributes",),
        ("options", "verification"),
        ("ways",),
        ("choice",),
        ("encoder",),
    ),
}
BITSTREAM_LIBRARIES = {"numpy", "msgpack", "zstandard"}
# Of these, only numpy is there wherever a mesh or a sequence is encoded.
CODEC_LIBRARIES = {"numpy": "bsm.codec", "scipy": "bsm.codec.denoise", "pymetis": "bsm.codec.blocks.overlap"}


# Where each room is, and the name that it is imported by.
FOLDERS = {"bitstream": "bsm.bitstream", "codec": "bsm.codec", "src/bsm": "bsm", "tools": "tools", "spec": "spec"}
ROOMS = (*FOLDERS.values(), "tests")


def module_name(path: Path, folder: str) -> str:
    parts = path.relative_to(ROOT / folder).with_suffix("").parts
    return ".".join((FOLDERS[folder], *(parts[:-1] if parts[-1] == "__init__" else parts)))


MODULES = {
    module_name(path, folder): path
    for folder in FOLDERS
    for path in (ROOT / folder).rglob("*.py")
    if not folder.startswith("src") or not {"codec", "bitstream"} & set(path.relative_to(ROOT / folder).parts[:1])
}


def room_of(name: str) -> str:
    """The room that a module stands in; of a library, its name."""
    return max((room for room in ROOMS if f"{name}.".startswith(f"{room}.")), key=len, default=name.split(".")[0])


def imports(source: str) -> set[str]:
    """Dotted names of all modules that a source imports, at the top and inside functions."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            found.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            if node.level:
                found.add("." * node.level)
            elif node.module and room_of(node.module) in ROOMS:
                found.update(f"{node.module}.{alias.name}" for alias in node.names)
            else:
                found.add(node.module or "")
    return found


def floor(name: str, package: str) -> tuple[int, str]:
    """On which floor of a package a module stands, and in which room of it."""
    rest = name.split(".")[len(package.split(".")) :]
    nouns = {rest[0], ".".join(rest[:2])} if rest else set()
    found = ((level, room) for level, rooms in enumerate(FLOORS[package]) for room in rooms if room in nouns)
    return next(found, (len(FLOORS[package]), ""))


def within(importer: str, imported: str, package: str) -> bool:
    """Whether the arrow goes down, or stays in a room."""
    (above, here), (below, there) = floor(importer, package), floor(imported, package)
    return below < above or here == there or imported == package


def allowed(importer: str, imported: str) -> bool:
    """Whether one module may import the other."""
    room, library = room_of(importer), room_of(imported)
    if library in sys.stdlib_module_names:
        return True
    for package in FLOORS:
        inside = all(f"{name}.".startswith(f"{package}.") for name in (importer, imported))
        if inside and not within(importer, imported, package):
            return False
    if room in FLOORS and library == room:
        return True
    if room == "bsm.bitstream":
        return library in BITSTREAM_LIBRARIES
    if room == "bsm.codec":
        if imported.startswith("bsm._engine."):
            return importer == "bsm.codec.decoded"
        if library == "bsm.bitstream":
            return importer.startswith(KNOW_BYTES) or imported.startswith(KNOWN_TO_ALL)
        return library in CODEC_LIBRARIES and f"{importer}.".startswith(f"{CODEC_LIBRARIES[library]}.")
    if room == "spec":
        return library not in ROOMS
    if room == "bsm":
        return library not in ("tools", "tests", "spec") and not imported.startswith(".")
    return not imported.startswith(".")


def test_imports_follow_the_arrows():
    found = {(name, item) for name, path in MODULES.items() for item in imports(path.read_text())}
    wrong = sorted(f"{name} may not import {item}" for name, item in found if not allowed(name, item))
    assert not wrong, f"{', '.join(wrong)} (see CONTRIBUTING.md)"


@pytest.mark.parametrize(
    ("importer", "source", "expected"),
    [
        ("bsm.bitstream.container.wire", "import numpy as np\nfrom bsm.bitstream.errors import BsmError", True),
        ("bsm.bitstream.container.wire", "def f():\n    import bsm.codec.geometry.mesh", False),
        ("bsm.bitstream.container.wire", "import scipy.sparse", False),
        ("bsm.bitstream.connectivity.faces", "from bsm.bitstream.entropy.range_coder import Coder", True),
        (
            "bsm.bitstream.entropy.range_coder",
            "from bsm.bitstream.connectivity.faces import encode_connectivity",
            False,
        ),
        ("bsm.codec.geometry.mesh", "from bsm.bitstream.errors import MeshError", True),
        ("bsm.codec.geometry.mesh", "from bsm.bitstream.container import packets", False),
        ("bsm.codec.geometry.mesh", "from bsm.bitstream.container.writer import Writer", False),
        ("bsm.codec.geometry.mesh", "from bsm.codec.blocks.overlap import Blocks", False),
        ("bsm.codec.static.encoder", "from bsm.bitstream.container.writer import Writer", True),
        ("bsm.codec.static.encoder", "from bsm.codec.sequence.encoder import SequenceEncoder", False),
        ("bsm.codec.static.encoder", "from bsm.decoding import Decoder", False),
        ("bsm.codec.static.encoder", "from bsm._engine import Decoder", False),
        ("bsm.codec.decoded", "from bsm._engine import Decoder", True),
        ("bsm.decoding", "from bsm._engine import Decoder", True),
        ("bsm.decoding", "import bsm.cli", False),
        ("bsm.codec.static.ways.grid", "from bsm.codec.static.coding import Scheme", True),
        ("bsm.codec.static.coding", "from bsm.codec.static.ways.grid import Grid", False),
        ("bsm.codec.static.choice.blocks", "from bsm.codec.static.encoder import encode", False),
        ("bsm.codec.geometry.mesh", "from . import graph", False),
        ("bsm.codec.denoise.probe", "import scipy.sparse", True),
        ("bsm.codec.sequence.step_search", "import scipy.sparse", False),
        ("bsm.cli", "import bsm.codec.geometry.mesh, bsm.bitstream.container.writer, matplotlib", True),
        ("bsm.cli", "import tools.attack", False),
        ("spec.reference", "from bsm.codec.geometry.mesh import TriangleMesh", False),
    ],
)
def test_the_rule_itself(importer, source, expected):
    assert all(allowed(importer, item) for item in imports(source)) is expected


def test_nothing_escapes():
    assert {"bsm.bitstream.container.wire", "bsm.codec.geometry.mesh", "tools"} <= set(MODULES)
