"""How large the house is, and how it reads, beside the last release: `python -m tools.measure house`.

Sizes are in tokens (`tokens.py`), so that comments and line breaks cost nothing; density and names are those of
`density.py`. These numbers are information: growth is judged where it is proposed. The exit code is 1 only where a line
of the product has over 140 characters.
"""

import argparse
import ast
import re
import subprocess
from collections.abc import Callable, Iterable
from pathlib import Path

from tools.measure.density import Density, measure_density
from tools.measure.tokens import comment_lines, count_tokens

ROOT = Path(__file__).parents[2]
PRODUCT = ("src/", "codec/", "bitstream/", "library/", "web/src/", "plugins/")
CODEC = re.compile(r"(bitstream|codec(?!/denoise)|library)/")
TESTS = ("tests/", "web/test/")
CODE = (".py", ".c", ".cpp", ".rs", ".sh", ".js", ".mjs", ".ts", ".html")
LANGUAGES = {
    "Python": (".py", ".pyi"),
    "C and C++": (".c", ".h", ".cpp", ".hpp"),
    "Rust": (".rs",),
    "TypeScript": (".ts",),
}
SEARCH = re.compile(r"codec/static/(choice/.*|encoder|targets)\.py$")
"""The modules that find the smallest stream that keeps a promise."""
ROOMS = {
    "product": ("codec/", "bitstream/", "src/bsm/"),
    "codec/static": ("codec/static/",),
    "codec/sequence": ("codec/sequence/",),
    "codec/denoise": ("codec/denoise/",),
    "bsm/files": ("src/bsm/files/",),
    "bsm/gltf": ("src/bsm/gltf/",),
    "bsm/files/motion": ("src/bsm/files/motion/",),
    "bsm/commands": ("src/bsm/commands/",),
    "bsm/api.py": ("src/bsm/api.py",),
    "tools": ("tools/",),
}
"""The folders whose density is printed."""
INTERNALS = re.compile(
    r"^\s*(?:from|import) bsm\.(?!cli|vtk|pyvista|openmesh|_core|__main__)\w", re.MULTILINE
)
"""An import of a module that users do not import."""
PATCHES = re.compile(r"\bmonkeypatch\.setattr\b")
WIDEST = 140
"""Characters of a line; a wider one fails the check."""

LAST_RELEASE = {
    "codec proper, tokens": 370_468,
    "rest of the product, tokens": 344_875,
    "tools, tokens": 165_530,
    "named numbers of the search": 32,
    "function of Python, 95th percentile, lines": 27,
    "comment lines of Python, per thousand": 39,
    "tools, lines of Python": 16_611,
    "tests, lines": 36_099,
    "tests, imports of internals": 474,
    "tests, patches": 77,
    "product, lines of Python": 37_838,
    "product, lines of C and C++": 26_702,
    "product, lines of Rust": 1_207,
    "product, lines of TypeScript": 9_372,
}


def list_files() -> list[Path]:
    """Return the files that git knows, relative to the root, without links."""
    listing = subprocess.run(
        ["git", "ls-files"], cwd=ROOT, check=True, capture_output=True, text=True
    ).stdout
    files = [Path(name) for name in listing.splitlines()]
    return [file for file in files if (ROOT / file).is_file() and not (ROOT / file).is_symlink()]


def measure_sizes(files: Iterable[Path]) -> dict[str, int]:
    """Return each number that `LAST_RELEASE` has."""
    product = list(filter(_is_product, files))
    tools = _below(files, ("tools/",))
    tests = [file for file in _below(files, TESTS) if file.suffix in CODE]
    python = _with_suffix(product, (".py",))
    tokens = {file: count_tokens(ROOT / file) for file in product}
    codec = sum(count for file, count in tokens.items() if CODEC.match(str(file)))
    lengths = sorted(length for file in python for length in function_lengths(_read(file)))
    comments = _total(lambda text: len(comment_lines(text)), python)
    sizes = {
        "codec proper, tokens": codec,
        "rest of the product, tokens": sum(tokens.values()) - codec,
        "tools, tokens": sum(count_tokens(ROOT / file) for file in tools),
        "named numbers of the search": _total(
            count_constants, [file for file in product if SEARCH.match(str(file))]
        ),
        "function of Python, 95th percentile, lines": lengths[len(lengths) * 95 // 100],
        "comment lines of Python, per thousand": 1000 * comments // _total(count_lines, python),
        "tools, lines of Python": _total(count_lines, _with_suffix(tools, (".py",))),
        "tests, lines": _total(count_lines, tests),
        "tests, imports of internals": _total(
            lambda text: len(INTERNALS.findall(text)), _with_suffix(tests, (".py",))
        ),
        "tests, patches": _total(
            lambda text: len(PATCHES.findall(text)), _with_suffix(tests, (".py",))
        ),
    }
    for language, suffixes in LANGUAGES.items():
        sizes[f"product, lines of {language}"] = _total(
            count_lines, _with_suffix(product, suffixes)
        )
    return sizes


def measure_room(files: Iterable[Path], folders: tuple[str, ...]) -> Density:
    """Return the density of the Python below some folders."""
    room = _with_suffix(_below(files, folders), (".py",))
    return sum((measure_density(_read(file)) for file in room), Density())


def wide_lines(files: Iterable[Path]) -> list[str]:
    """Return the place of each line of the product that is wider than `WIDEST`."""
    suffixes = tuple(suffix for language in LANGUAGES.values() for suffix in language)
    places = []
    for file in _with_suffix(filter(_is_product, files), suffixes):
        for number, line in enumerate(_read(file).splitlines(), 1):
            if len(line) > WIDEST:
                places.append(f"{file}:{number}")
    return places


def function_lengths(text: str) -> list[int]:
    """Return the lines of each function of a source in Python, without docstrings and comments."""
    comments = comment_lines(text)
    return [
        _length(node, comments)
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.FunctionDef)
    ]


def _length(function: ast.FunctionDef, comments: list[int]) -> int:
    last = function.end_lineno or function.lineno
    length = last - function.lineno + 1
    length -= sum(function.lineno < line <= last for line in comments)
    if ast.get_docstring(function, clean=False) is None:
        return length
    docstring = function.body[0]
    return length - ((docstring.end_lineno or docstring.lineno) - docstring.lineno + 1)


def count_lines(text: str) -> int:
    """Count as `wc -l`."""
    return text.count("\n")


def count_constants(text: str) -> int:
    """Count the numbers that a module gives names; each entry of a tuple or table is one, and so is an expression."""
    values = (
        node.value for node in ast.parse(text).body if isinstance(node, ast.Assign | ast.AnnAssign)
    )
    return sum(map(_count_numbers, filter(None, values)))


def _count_numbers(value: ast.expr) -> int:
    if isinstance(value, ast.Tuple | ast.List | ast.Set):
        return sum(map(_count_numbers, value.elts))
    if isinstance(value, ast.Dict):
        return sum(map(_count_numbers, value.values))
    constants = (node.value for node in ast.walk(value) if isinstance(node, ast.Constant))
    return int(any(type(constant) in (int, float) for constant in constants))


def _is_product(file: Path) -> bool:
    return str(file).startswith(PRODUCT) and not {"examples", "tests"} & {*file.parts}


def _below(files: Iterable[Path], folders: tuple[str, ...]) -> list[Path]:
    return [file for file in files if str(file).startswith(folders)]


def _with_suffix(files: Iterable[Path], suffixes: tuple[str, ...]) -> list[Path]:
    return [file for file in files if file.suffix in suffixes]


def _read(file: Path) -> str:
    return (ROOT / file).read_text(encoding="utf-8")


def _total(count: Callable[[str], int], files: Iterable[Path]) -> int:
    return sum(count(_read(file)) for file in files)


def main() -> int:
    """Print sizes beside the last release's, then the density of the rooms, then lines that are too wide."""
    argparse.ArgumentParser(description=__doc__.split("\n")[0]).parse_args()
    files = list_files()
    print(f"{'':44}{'now':>9}{'last release':>14}")
    for name, size in measure_sizes(files).items():
        print(f"{name:44}{size:9,}{LAST_RELEASE[name]:14,}")
    print(
        "\nof Python: expressions a line, conditional expressions and comprehensions in 1,000 lines,"
    )
    print("bare participles in 1,000 names")
    for name, folders in ROOMS.items():
        nodes, conditionals, comprehensions, participles = measure_room(files, folders).figures
        print(f"{name:24}{nodes:6.1f}{conditionals:6.0f}{comprehensions:6.0f}{participles:7.1f}")
    places = wide_lines(files)
    for place in places:
        print(f"{place}: over {WIDEST} characters")
    return int(bool(places))
