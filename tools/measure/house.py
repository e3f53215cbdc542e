"""How large the house is, beside what it may be: `python -m tools.measure house`; the exit code is 1 above a limit.

Of the files that git knows, in lines as `wc` counts them. A limit is lowered by whoever makes the house smaller,
and raised only by a commit that says why.
"""

from __future__ import annotations

import argparse
import ast
import dataclasses
import re
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterable
from pathlib import Path

import bsm
from bsm.bitstream.container.header import HEADER_FIELDS
from bsm.codec.static.options import EncodeOptions, Paper
from bsm.commands import flags
from bsm.evaluation.sample import knot

ROOT = Path(__file__).parents[2]
PRODUCT = ("src", "codec", "bitstream")
LANGUAGES = {"C and C++": (".c", ".h", ".cpp", ".hpp"), "Rust": (".rs",), "TypeScript": (".ts",)}
OTHERS = ("engine/", "web/src/")
"""Where the product is in other languages than Python, beside `PRODUCT`; without examples and tests."""
BESIDE = (".pyi", ".html", ".css")
WIDE = 120  # columns
SEARCH = ("choice/", "encoder.py", "targets.py")
"""Of codec/static: what finds the smallest stream that keeps a promise."""
CORE = re.compile(r"core[^/]*\.md$")
"""Of spec/: what a decoder of plain static meshes must read."""

LIMITS = {
    "product in all languages, lines": 59_918,
    "product Python, lines": 32_342,
    "product C and C++, lines": 20_663,
    "product Rust, lines": 908,
    "product TypeScript, lines": 6_005,
    "product lines over 120 columns": 216,
    "all Python, lines": 71_896,
    "product stubs, pages and build lists, lines": 374,
    "product modules": 200,
    "product C files and headers": 72,
    "docstring lines of the product, percent": 12,
    "numbers of a header": 36,
    "fields of EncodeOptions and Paper": 29,
    "settings of --set": 12,
    "words of prose in spec/*.md": 22_674,
    "words of prose in the core": 10_215,
    "tuned constants of the search": 44,
    "files that encoding a mesh walks through": 56,
}


def house() -> dict[str, float]:
    """What there is of each thing in `LIMITS`."""
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, check=True, capture_output=True, text=True).stdout.split(
        "\n"
    )
    files = [Path(name) for name in listed if name and (ROOT / name).is_file() and not (ROOT / name).is_symlink()]
    python = [file for file in files if file.suffix == ".py"]
    product = [file for file in files if file.parts[0] in PRODUCT]
    modules = [file for file in product if file.suffix == ".py"]
    law = [file for file in files if file.parts[0] == "spec" and file.suffix == ".md" and len(file.parts) == 2]
    search = [file for file in modules if str(file).startswith(tuple(f"codec/static/{name}" for name in SEARCH))]
    others = [
        file
        for file in files
        if (file.parts[0] in PRODUCT or str(file).startswith(OTHERS)) and not {"examples", "tests"} & {*file.parts}
    ]
    own = {name: [file for file in others if file.suffix in ends] for name, ends in LANGUAGES.items()}
    texts = [file for every in own.values() for file in every] + modules
    lines = total(count_lines, modules)
    return dict(
        zip(
            LIMITS,
            (
                total(count_lines, texts),
                lines,
                *(total(count_lines, every) for every in own.values()),
                total(count_wide, texts),
                total(count_lines, python),
                total(count_lines, [file for file in others if file.suffix in BESIDE or file.name == "CMakeLists.txt"]),
                len(modules),
                sum(file.suffix in (".c", ".h") for file in product),
                100.0 * total(docstring_lines, modules) / lines,
                sum(declared.lengths[1] or 1 for declared in HEADER_FIELDS.values()),
                len(dataclasses.fields(EncodeOptions)) + len(dataclasses.fields(Paper)) - 1,
                len(flags.SETTINGS),
                total(count_prose, law),
                total(count_prose, [file for file in law if CORE.search(file.name)]),
                total(count_constants, search),
                len(walked()),
            ),
            strict=True,
        )
    )


def total(count: Callable[[str], int], files: Iterable[Path]) -> int:
    """The sum over the texts of files."""
    return sum(count((ROOT / file).read_text(encoding="utf-8")) for file in files)


def count_lines(text: str) -> int:
    """As `wc -l`."""
    return text.count("\n")


def count_wide(text: str) -> int:
    """Lines over `WIDE` columns."""
    return sum(len(line) > WIDE for line in text.splitlines())


def count_prose(text: str) -> int:
    """Words outside of tables and indented code."""
    return sum(len(line.split()) for line in text.splitlines() if not line.startswith(("|", "    ")))


def docstring_lines(text: str) -> int:
    """Lines of texts that stand as statements: docstrings, and those behind constants and fields."""
    expressions = (node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.Expr))
    texts = (node.value for node in expressions if isinstance(node.value, ast.Constant))
    return sum((node.end_lineno or 0) - node.lineno + 1 for node in texts if isinstance(node.value, str))


def count_constants(text: str) -> int:
    """Numbers that the module gives names; each entry of a tuple or table is one, and so is an expression."""
    values = (node.value for node in ast.parse(text).body if isinstance(node, ast.Assign | ast.AnnAssign))
    return sum(map(_numbers, filter(None, values)))


def _numbers(value: ast.expr) -> int:
    if isinstance(value, ast.Tuple | ast.List | ast.Set):
        return sum(map(_numbers, value.elts))
    if isinstance(value, ast.Dict):
        return sum(map(_numbers, value.values))
    parts = (node.value for node in ast.walk(value) if isinstance(node, ast.Constant))
    return int(any(type(part) in (int, float) for part in parts))


def walked() -> set[str]:
    """Product files with a function that runs while a mesh file is encoded with the default options."""
    found: set[str] = set()
    package = Path(bsm.__file__).parent
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "mesh.ply")
        bsm.save(knot(4000), path)
        bsm.encode(path, threads=1)  # what is imported on the way does not count
        sys.setprofile(lambda frame, event, _: found.add(frame.f_code.co_filename))
        try:
            bsm.encode(path, threads=1)
        finally:
            sys.setprofile(None)
    homes = (package, *(ROOT / name for name in PRODUCT))
    return {name for name in found if any(Path(name).is_relative_to(home) for home in homes)}


def main() -> int:
    """Print all beside its limit."""
    argparse.ArgumentParser(description=__doc__.split("\n")[0]).parse_args()
    above = 0
    for what, number in house().items():
        limit = LIMITS[what]
        above += number > limit
        print(f"{what:44}{number:10.5g}{limit:10.5g}  {'above' if number > limit else ''}".rstrip())
    return int(above > 0)
