"""The arrows of CONTRIBUTING.md: which package may import which."""

import ast
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
KNOW_BYTES = ("codec.static", "codec.sequence")
FLOORS = {
    "codec": (
        ("_kernels", "arrays", "choices", "threads"),
        ("geometry",),
        ("blocks",),
        ("basis",),
        ("signal",),
        ("static", "denoise"),
        ("sequence",),
    ),
    "bitstream": (
        ("_kernels", "errors", "limits"),
        ("entropy",),
        ("connectivity", "coefficients", "fields"),
        ("attributes",),
        ("container",),
    ),
}
BITSTREAM_LIBRARIES = {"numpy", "msgpack", "zstandard"}
CODEC_LIBRARIES = {"numpy", "scipy", "pymetis"}


def module_name(path: Path) -> str:
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


MODULES = {
    module_name(path): path
    for package in ("bitstream", "codec", "bsm", "tools", "spec")
    for path in ROOT.glob(f"{package}/**/*.py")
}


ROOMS = ("bitstream", "codec", "bsm", "tools", "spec", "tests")


def imports(source: str) -> set[str]:
    """Dotted names of all modules that a source imports, at the top and inside functions."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            found.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            if node.level:
                found.add("." * node.level)
            elif node.module and node.module.split(".")[0] in ROOMS:
                found.update(f"{node.module}.{alias.name}" for alias in node.names)
            else:
                found.add(node.module or "")
    return found


def floor(name: str) -> int:
    """On which floor of its package a module stands."""
    package, *rest = name.split(".")
    nouns = {rest[0], ".".join(rest[:2])} if rest else set()
    return next((level for level, room in enumerate(FLOORS[package]) if nouns & set(room)), len(FLOORS[package]))


def allowed(importer: str, imported: str) -> bool:
    """Whether one module may import the other."""
    room, library = importer.split(".")[0], imported.split(".")[0]
    if library in sys.stdlib_module_names:
        return True
    if room in FLOORS and library == room:
        return floor(imported) <= floor(importer)
    if room == "bitstream":
        return library in BITSTREAM_LIBRARIES
    if room == "codec":
        if library == "bitstream":
            return importer.startswith(KNOW_BYTES) or imported.startswith(("bitstream.errors", "bitstream.limits"))
        return library in CODEC_LIBRARIES
    if room == "spec":
        return library not in ROOMS
    if room == "bsm":
        return library not in ("tools", "tests", "spec") and not imported.startswith(".")
    return not imported.startswith(".")


@pytest.mark.parametrize("name", sorted(MODULES))
def test_imports_follow_the_arrows(name):
    wrong = sorted(item for item in imports(MODULES[name].read_text()) if not allowed(name, item))
    assert not wrong, f"{name} may not import {', '.join(wrong)} (see CONTRIBUTING.md)"


@pytest.mark.parametrize(
    ("importer", "source", "expected"),
    [
        ("bitstream.container.wire", "import numpy as np\nfrom bitstream.errors import BsmError", True),
        ("bitstream.container.wire", "def f():\n    import codec.geometry.mesh", False),
        ("bitstream.container.wire", "import scipy.sparse", False),
        ("bitstream.connectivity.faces", "from bitstream.entropy.range_coder import Coder", True),
        ("bitstream.entropy.range_coder", "from bitstream.connectivity.faces import encode_connectivity", False),
        ("codec.geometry.mesh", "from bitstream.errors import MeshError", True),
        ("codec.geometry.mesh", "from bitstream.container import packets", False),
        ("codec.geometry.mesh", "from bitstream.container.reader import Reader", False),
        ("codec.geometry.mesh", "from codec.blocks.overlap import Blocks", False),
        ("codec.static.decoder", "from bitstream.container.reader import Reader", True),
        ("codec.static.decoder", "from codec.sequence.decoder import SequenceDecoder", False),
        ("codec.static.decoder", "import bsm.cli", False),
        ("codec.geometry.mesh", "from . import graph", False),
        ("bsm.cli", "import codec.geometry.mesh, bitstream.container.reader, matplotlib", True),
        ("bsm.cli", "import tools.fuzz", False),
        ("spec.reference", "from codec.geometry.mesh import TriangleMesh", False),
    ],
)
def test_the_rule_itself(importer, source, expected):
    assert all(allowed(importer, item) for item in imports(source)) is expected


def test_nothing_escapes():
    assert {"bitstream.container.wire", "codec.geometry.mesh", "tools"} <= set(MODULES)
