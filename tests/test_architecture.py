"""The arrows of CONTRIBUTING.md: which package may import which; no circle and no class name twice in any language."""

import ast
import io
import re
import sys
import tokenize
from collections import Counter, defaultdict
from functools import cache
from graphlib import CycleError, TopologicalSorter
from itertools import pairwise
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
# Of Python, then of C: those that decode.
KNOW_BYTES = tuple(
    f"bsm.codec.{name}"
    for name in (
        *("decoding", "events", "static", "sequence"),
        *("basis.patches", "basis.structure", "basis.dictionaries"),
        *("signal.decoding", "signal.chain", "signal.assembly", "signal.layer"),
    )
)
KNOWN_TO_ALL = tuple(
    f"bsm.bitstream.{name}"
    for name in ("errors", "limits", "once", "kernel", "context", "costs", "trellis")
)
FLOORS = {
    "bsm": (
        ("__version__", "_core"),
        ("bitstream",),
        ("codec",),
        ("ground",),
        ("files",),
        ("account", "encoding", "evaluation", "keywords"),
        ("jobs",),
        ("api",),
        ("gltf", "research", "viewer"),
        ("tiles", "vtk"),
        ("openmesh", "pyvista", "trimesh"),
        ("commands",),
        ("cli",),
        ("__main__",),
    ),
    "bsm.codec": (
        ("arrays", "choices", "progress"),
        ("threads",),
        # Encoders decode what they wrote: by the compiled decoder, which stands below everything.
        ("geometry",),
        ("events",),
        ("decoding",),
        ("blocks", "look"),
        ("basis",),
        ("signal",),
        ("static", "denoise"),
        ("sequence",),
    ),
    "bsm.bitstream": (
        ("errors", "once", "kernel"),
        ("context", "costs", "limits", "pool", "trellis"),
        ("entropy",),
        ("connectivity", "coefficients", "fields"),
        ("attributes",),
        ("container",),
        ("payloads",),
    ),
    "bsm.codec.static": (
        ("coding", "presets", "targets", "units"),
        ("preamble_encoding",),
        ("attributes",),
        ("options", "verification"),
        ("ways",),
        ("choice",),
        ("encoder",),
    ),
    "library": (
        ("bsmdec", "arithmetic"),
        ("attribute", "bsmenc"),
        ("attribute_set",),
        ("state", "writing"),
        ("ahead",),
        ("stages",),
        ("sequence",),
        ("decoder",),
        ("changes", "split"),
        ("whole", "encode"),
        ("python", "wasm"),
    ),
}
BITSTREAM_LIBRARIES = {"numpy", "msgpack", "zstandard"}
# Of these, only numpy is there wherever a mesh or a sequence is encoded.
# The kernels of `bitstream`, writers that it calls, and the words of the public header: statuses, limits, memory.
OF_BYTES = ("bsm._core.bitstream", "bsm._core.GivenMesh", "library.bsmdec")
# What encoders call of the library.
OF_ENCODERS = (
    "Chain",
    "Cut",
    "Field",
    "GivenMesh",
    "Track",
    "gop_memory",
    "rounded",
    "turned_tangents",
)
CODEC_LIBRARIES = {
    "numpy": "bsm.codec",
    "scipy": "bsm.codec.denoise",
    "pymetis": "bsm.codec.blocks.overlap",
}


# Where each room is, and the name that it is imported by.
FOLDERS = {
    "bitstream": "bsm.bitstream",
    "codec": "bsm.codec",
    "src/bsm": "bsm",
    "library": "library",
    "tools": "tools",
    "plugins": "plugins",
    "spec": "spec",
}
ROOMS = (*FOLDERS.values(), "tests")
WEB = ROOT / "web/src"
# In the place of files that a build for pages is without; what C has of the library there.
INSTEAD = ("absent", "host")


def module_name(path: Path, folder: str) -> str:
    parts = path.relative_to(ROOT / folder).with_suffix("").parts
    return ".".join((FOLDERS[folder], *(parts[:-1] if parts[-1] == "__init__" else parts)))


MODULES = {
    module_name(path, folder): path
    for folder in FOLDERS
    for path in (ROOT / folder).rglob("*.py")
    if not folder.startswith("src")
    or not {"codec", "bitstream"} & set(path.relative_to(ROOT / folder).parts[:1])
}


def sources(*endings: str) -> dict[Path, str]:
    """The texts of the C of rooms; a file and its header are one module, and so are those of a level of processors."""
    paths = (
        path
        for folder in ("bitstream", "codec", "src/bsm", "library")
        for path in (ROOT / folder).rglob("*")
    )
    left_out = ("examples", "rust", "include", "codec", "bitstream")
    return {
        path: re.sub(r"/\*.*?\*/", "", path.read_text(encoding="utf-8"), flags=re.DOTALL)
        for path in sorted({path.resolve() for path in paths if path.suffix in endings})
        if not set(path.relative_to(ROOT).parts[1:-1]) & set(left_out) and path.stem not in INSTEAD
    }


SOURCES = sources(".c", ".h", ".cpp", ".hpp")


def c_name(path: Path) -> str:
    """The module of a C file: `codec/basis/cosines.simd.c` is `bsm.codec.basis.cosines`."""
    folder = max((folder for folder in FOLDERS if path.is_relative_to(ROOT / folder)), key=len)
    return module_name(path.with_name(path.name.split(".")[0]), folder)


def included(path: Path) -> set[Path]:
    """The headers that a C file includes itself, by their paths from the root or from its own folder."""
    names = re.findall(r'^\s*#\s*include "([^"]+)"', SOURCES[path], re.MULTILINE)
    return {(ROOT if "/" in name else path.parent) / name for name in names}


@cache
def seen(path: Path) -> frozenset[Path]:
    """All headers that a C file includes, straight or through others."""
    return frozenset().union(*({header} | seen(header) for header in included(path)))


def words(path: Path) -> set[str]:
    """Names in a C file, but for those of members."""
    return set(re.findall(r"(?<![.\w])(?<!->)[A-Za-z_]\w*", SOURCES[path]))


def defined(path: Path) -> list[str]:
    """The functions of a C file that others may call."""
    kinds = r"(?!static|typedef|return|else|INLINE|SHARED|KERNEL static|OFTEN static)(?:\w+[ *]+)+"
    return re.findall(
        rf"^{kinds}(?:ISA\()?(\w+)\)?\([^;{{}}]*\)\s*\{{", SOURCES[path], re.MULTILINE
    )


def arrows_of_c() -> dict[str, set[str]]:
    """What each module of C includes or calls: functions that are declared in a header it sees, and defined once."""
    homes, arrows = defaultdict(set), defaultdict(set)
    for path in SOURCES:
        for function in defined(path):
            homes[function].add(c_name(path))
    for path in SOURCES:
        declared = set().union(*map(words, seen(path)))
        calls = words(path) & declared & homes.keys() if path.suffix in (".c", ".cpp") else ()
        called = {home for name in calls for home in homes[name] if len(homes[name]) == 1}
        arrows[c_name(path)] |= {*map(c_name, included(path)), *called} - {c_name(path)}
    return arrows


def arrows_of_python() -> dict[str, set[str]]:
    """What each module of Python imports; a package is what its `__init__.py` holds."""
    arrows = {}
    for name, path in MODULES.items():
        steps = (item.split(".") for item in imports(path.read_text()))
        found = {
            ".".join(parts[:count]) for parts in steps for count in (len(parts), len(parts) - 1)
        } & MODULES.keys()
        arrows[name] = {item for item in found if not f"{name}.".startswith(f"{item}.")}
    return arrows


def arrows_of_typescript() -> dict[str, set[str]]:
    """What each module of TypeScript imports of others, types too."""
    files = {
        path.relative_to(WEB).with_suffix("").as_posix(): path for path in sorted(WEB.rglob("*.ts"))
    }
    pattern = r"""(?:from|import)\s*\(?\s*["'](\.[^"']+)["']"""
    return {
        name: {
            (path.parent / item).resolve().relative_to(WEB).as_posix()
            for item in re.findall(pattern, path.read_text())
        }
        & files.keys()
        for name, path in files.items()
    }


def circle_in(arrows: dict[str, set[str]]) -> list[str]:
    """Modules that need each other, in turn; none is the usual."""
    try:
        TopologicalSorter(arrows).prepare()
    except CycleError as error:
        return list(error.args[1])
    return []


def room_of(name: str) -> str:
    """The room that a module stands in; of a library, its name."""
    return max(
        (room for room in ROOMS if f"{name}.".startswith(f"{room}.")),
        key=len,
        default=name.split(".")[0],
    )


@cache
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
    found = (
        (level, room)
        for level, rooms in enumerate(FLOORS[package])
        for room in rooms
        if room in nouns
    )
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
        return library in BITSTREAM_LIBRARIES or imported.startswith(OF_BYTES)
    if room == "bsm.codec":
        if imported.startswith("bsm._core.bitstream"):
            return importer.startswith(KNOW_BYTES)
        if imported.startswith("bsm._core."):
            of_encoders = imported.rpartition(".")[2] in ("codec", *OF_ENCODERS)
            return of_encoders or importer == "bsm.codec.decoding"
        if library == "bsm.bitstream":
            return importer.startswith(KNOW_BYTES) or imported.startswith(KNOWN_TO_ALL)
        return library in CODEC_LIBRARIES and f"{importer}.".startswith(
            f"{CODEC_LIBRARIES[library]}."
        )
    if room == "spec":
        return library not in ROOMS
    if room == "library":
        return library in ("bsm.bitstream", "bsm.codec")
    if room == "bsm":
        return library not in ("tools", "plugins", "tests", "spec") and not imported.startswith(".")
    # Which Blender names as it likes.
    return not imported.startswith(".") or importer == "plugins.blender.extension"


def test_imports_and_includes_follow_the_arrows():
    found = {(name, item) for name, path in MODULES.items() for item in imports(path.read_text())}
    found |= {(c_name(path), c_name(header)) for path in SOURCES for header in included(path)}
    wrong = sorted(f"{name} may not use {item}" for name, item in found if not allowed(name, item))
    assert not wrong, f"{', '.join(wrong)} (see CONTRIBUTING.md)"


@pytest.mark.parametrize(
    ("importer", "source"),
    [
        ("bsm.bitstream.container.wire", "def f():\n    import bsm.codec.geometry.mesh"),
        (
            "bsm.bitstream.entropy.coder",
            "from bsm.bitstream.connectivity.faces import encode_connectivity",
        ),
        ("bsm.codec.geometry.mesh", "from bsm.bitstream.container import packets"),
        ("bsm.codec.blocks.overlap", "from bsm.bitstream.container.header import Header"),
        ("bsm.codec.static.encoder", "from bsm._core import Decoder"),
        ("bsm.codec.static.coding", "from bsm.codec.static.ways.grid import Grid"),
        ("bsm.codec.geometry.mesh", "from . import graph"),
        ("bsm.codec.sequence.step_search", "import scipy.sparse"),
        ("bsm.cli", "import tools.attack"),
        ("spec.reference", "from bsm.codec.geometry.mesh import TriangleMesh"),
        ("library.ahead", "import library.stages"),
    ],
)
def test_what_the_rule_forbids(importer, source):
    assert not all(allowed(importer, item) for item in imports(source))


@pytest.mark.parametrize("arrows", [arrows_of_python, arrows_of_c, arrows_of_typescript])
def test_no_circles(arrows):
    assert not circle_in(arrows())


def test_circles_are_found(monkeypatch):
    assert circle_in({"a": {"b"}, "b": {"c"}, "c": {"a"}, "d": {"a"}})
    wire, context = ROOT / "bitstream/container/wire.c", ROOT / "bitstream/context.c"
    assert "library.stages" in arrows_of_c()["library.decoder"]
    assert "bsm.bitstream.container.reader" not in arrows_of_c()["bsm.bitstream.container.grammar"]
    call = "\nvoid never_called(Reader *reader) { end_reader(reader); }\n"
    monkeypatch.setitem(SOURCES, wire, SOURCES[wire] + call)
    assert circle_in(arrows_of_c())
    monkeypatch.undo()
    monkeypatch.setitem(SOURCES, context, SOURCES[context] + call)
    assert not circle_in(arrows_of_c())  # what no header declares is another function
    monkeypatch.setitem(
        SOURCES, context, f'{SOURCES[context]}#include "bitstream/container/container.h"\n'
    )
    assert circle_in(arrows_of_c())


PRODUCT = [
    path
    for path in MODULES.values()
    if path.parts[len(ROOT.parts)] not in ("tools", "plugins", "spec")
]


def test_no_class_name_stands_twice():
    of_c, of_typescript = (
        r"^(?:\} |class )(\w+)(?:;| :)",
        r"^(?:export )?(?:class|interface|type) (\w+)",
    )
    for files, pattern in (
        (PRODUCT, r"^class (\w+)"),
        (SOURCES, of_c),
        (WEB.rglob("*.ts"), of_typescript),
    ):
        names = Counter(
            name for path in files for name in re.findall(pattern, path.read_text(), re.MULTILINE)
        )
        assert len(names) > 99 and not [name for name, count in names.items() if count > 1]


def prose(path: Path) -> str:
    """Comments and docstrings of a source."""
    text = path.read_text(encoding="utf-8")
    if path.suffix != ".py":
        return "".join(re.findall(r"/\*.*?\*/|//[^\n]*", text, re.DOTALL))
    tokens = list(tokenize.generate_tokens(io.StringIO(text).readline))
    return "".join(
        token.string
        for token in tokens
        if token.type == tokenize.COMMENT or token.string.startswith('"""')
    )


def test_comments_name_files_that_are_there():
    """A name without a folder is that of a file beside, or further up; one with a folder ends a path."""
    files = [path.relative_to(ROOT) for path in (*PRODUCT, *SOURCES, *WEB.rglob("*.ts"))]
    wrong = []
    for file in files:
        for name in re.findall(
            r"(?<![\w/.<*-])(?:\w+/)*\w[\w.]*\.(?:py|c|h|ts|md)\b(?![\w(/*.])", prose(ROOT / file)
        ):
            beside = any((ROOT / folder / name).is_file() for folder in file.parents)
            if not beside and not (
                "/" in name and any(f"/{other}".endswith(f"/{name}") for other in files)
            ):
                wrong.append(f"{file}: {name}")
    assert not wrong


def test_headers_without_a_source_have_names_of_their_own():
    """A reader takes `x.h` for the header of `x.c`, wherever that is."""
    headers = [
        path
        for path in SOURCES
        if path.suffix == ".h" and not any(path.parent.glob(f"{path.stem}.*c*"))
    ]
    others = {path.stem.split(".")[0] for path in SOURCES if path.suffix in (".c", ".cpp")}
    assert not [str(path.relative_to(ROOT)) for path in headers if path.stem in others]


def test_nothing_escapes():
    assert {"bsm.bitstream.container.wire", "bsm.codec.geometry.mesh", "tools"} <= set(MODULES)
    assert {"library.stages", "library.python.binding", "bsm.codec.basis.cosines"} <= set(
        map(c_name, SOURCES)
    )
    assert {"engine", "viewer/view"} <= arrows_of_typescript().keys()


def rows_of_map(heading: str) -> list[list[str]]:
    """The cells of the table of CONTRIBUTING.md that follows a text."""
    _, _, text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8").partition(heading)
    table = re.search(r"^\|[-|]+\|\n((?:\|.*\n)+)", text, re.MULTILINE)
    assert table
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in table[1].splitlines()]


def rooms_in(folder: str) -> set[str]:
    """The folders with sources below a folder."""
    paths = [path for path in (ROOT / folder).iterdir() if path.is_dir() and not path.is_symlink()]
    return {path.name for path in paths if [*path.glob("*.py"), *path.glob("*.c")]}


@pytest.mark.parametrize("folder", ["bitstream", "codec", "src/bsm"])
def test_the_map_has_the_rooms_and_floors_of_the_tree(folder):
    rows = {cells[0]: cells[1] for cells in rows_of_map("## The map")}
    floors = [re.findall(r"\w+", words) for words in rows[f"`{folder}/`"].split("·")]
    package = FOLDERS[folder]
    assert rooms_in(folder) <= {name for names in floors for name in names}
    levels = [{floor(f"{package}.{name}", package)[0] for name in names} for names in floors]
    assert max(level for each in levels for level in each) < len(FLOORS[package]), (
        "a room that is on no floor"
    )
    assert all(max(below) < min(above) for below, above in pairwise(levels))


def test_the_rooms_of_the_encoder_are_those_of_the_tree():
    folder = ROOT / "codec/static"
    cells = [
        re.findall(r"`(?:static/)?(\w+)[./]", row[0])
        for row in rows_of_map("The rooms of `codec/static/`")
    ]
    names = [name for names in cells for name in names]
    files = {path.stem for path in folder.glob("*.py") if path.stem != "__init__"}
    assert sorted(names) == sorted(rooms_in("codec/static") | files)
    levels = [floor(f"bsm.codec.static.{name}", "bsm.codec.static")[0] for name in names]
    assert levels == sorted(levels)


def is_defined(name: str) -> bool:
    """Whether a dotted name is that of a module, or of what a module defines; `bsm` loads its names on demand."""
    module, _, rest = name, "", ""
    while module and module not in MODULES:
        module, _, part = module.rpartition(".")
        rest = f"{part}.{rest}".strip(".")
    if not rest:
        return bool(module)
    source = MODULES[module].read_text(encoding="utf-8") if module else ""
    first, *inside = rest.split(".")
    begins = (
        rf'["\s]{first}["\s]'
        if module == "bsm"
        else rf"^(?:def |class |from .* import .*\b)?{first}\b"
    )
    return bool(re.search(begins, source, re.MULTILINE)) and all(part in source for part in inside)


def unknown_names(text: str) -> list[str]:
    """The dotted names of a text that nothing has."""
    names = re.findall(r"`((?:bsm|codec|bitstream|tools)\.[\w.]+\w)", text)
    return [name for name in names if not is_defined(re.sub(r"^(?=codec|bitstream)", "bsm.", name))]


def test_docstrings_name_what_there_is():
    assert unknown_names("`codec.denoise.normals`, `bsm.nothing`, `codec.look`, `bsm.encode`") == [
        "codec.denoise.normals",
        "bsm.nothing",
    ]
    wrong = {}
    for name, path in MODULES.items():
        tree = ast.parse(path.read_text(encoding="utf-8"))
        kinds = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
        texts = [
            ast.get_docstring(node) or "" for node in ast.walk(tree) if isinstance(node, kinds)
        ]
        if names := unknown_names("\n".join(texts)):
            wrong[name] = names
    assert not wrong
