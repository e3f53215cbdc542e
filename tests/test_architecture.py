"""The arrows of CONTRIBUTING.md: which package may import which."""

import ast
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
KNOW_BYTES = {f"codec.{what}{side}" for what in ("", "sequence_", "gop_") for side in ("encoder", "decoder")}
BITSTREAM_LIBRARIES = {"numpy", "numba", "msgpack", "zstandard"}
CODEC_LIBRARIES = {"numpy", "scipy", "numba", "llvmlite", "pymetis", "threadpoolctl"}


def module_name(path: Path) -> str:
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


MODULES = {
    module_name(path): path
    for package in ("bitstream", "codec", "tools", "spec")
    for path in ROOT.glob(f"{package}/**/*.py")
}


def imports(source: str) -> set[str]:
    """Dotted names of all modules that a source imports, at the top and inside functions."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            found.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            if node.level:
                found.add("." * node.level)
            elif node.module in ("bitstream", "codec", "tools"):
                found.update(f"{node.module}.{alias.name}" for alias in node.names)
            else:
                found.add(node.module or "")
    return found


def allowed(importer: str, imported: str) -> bool:
    """Whether one module may import the other."""
    room, library = importer.split(".")[0], imported.split(".")[0]
    if library in sys.stdlib_module_names:
        return True
    if room == "bitstream":
        return library == "bitstream" or library in BITSTREAM_LIBRARIES
    if room == "codec":
        if library == "bitstream":
            return importer in KNOW_BYTES or imported in ("bitstream.errors", "bitstream.limits")
        return library == "codec" or library in CODEC_LIBRARIES
    if room == "spec":
        return library not in ("bitstream", "codec", "tools")
    return not imported.startswith(".")


@pytest.mark.parametrize("name", sorted(MODULES))
def test_imports_follow_the_arrows(name):
    wrong = sorted(item for item in imports(MODULES[name].read_text()) if not allowed(name, item))
    assert not wrong, f"{name} may not import {', '.join(wrong)} (see CONTRIBUTING.md)"


@pytest.mark.parametrize(
    ("importer", "source", "expected"),
    [
        ("bitstream.wire", "import numpy as np\nfrom bitstream.errors import BsmError", True),
        ("bitstream.wire", "def f():\n    import codec.mesh", False),
        ("bitstream.wire", "import scipy.sparse", False),
        ("codec.mesh", "from bitstream import errors", True),
        ("codec.mesh", "from bitstream import packets", False),
        ("codec.mesh", "from bitstream.reader import Reader", False),
        ("codec.decoder", "from bitstream.reader import Reader", True),
        ("codec.decoder", "import tools.cli", False),
        ("codec.mesh", "from . import graph", False),
        ("tools.cli", "import codec.mesh, bitstream.reader, matplotlib", True),
        ("spec.reference", "from codec.mesh import TriangleMesh", False),
    ],
)
def test_the_rule_itself(importer, source, expected):
    assert all(allowed(importer, item) for item in imports(source)) is expected


def test_nothing_escapes():
    assert {"bitstream.wire", "codec.mesh", "tools"} <= set(MODULES)
