"""How large the house is, beside what it may be: `python -m tools.measure house`; the exit code is 1 above a limit.

Of the files that git knows, in tokens (`tokens.py`), so that comments and line breaks cost nothing. The product has two
parts: the codec proper, and the rest, which serves people around it. A limit is the count of the last release; a single
change may be above it by `SLACK`, so that a fix can land with its test. After each release the limit is the count.
Numbers without a limit show where the lines are, and how they read.
"""

import argparse
import ast
import re
import subprocess
from collections.abc import Callable, Iterable
from itertools import chain
from pathlib import Path

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
BOUND = re.compile(r"(?:GUARDED|CHECKED)\((\w+)\)")
"""A kernel that Python may call, by its name in C and in Python."""
DEFINED = re.compile(r"^[A-Za-z_][\w \t*]*?\b\w+\(([^;{}()]*(?:\([^()]*\)[^;{}()]*)*)\)\s*\{", re.MULTILINE)
"""A function of C where it is defined, and its parameters."""
CONTEXT = re.compile(r"\b(Context|Arena) \*")

LIMITS = {
    "codec proper, tokens": 363_251,
    "rest of the product, tokens": 342_983,
    "tools, tokens": 163_402,
    "tuned constants of the search": 32,
    "kernels driven by both Python and C": 12,
}
SLACK = 0.02
"""What a single change may add to a limit in tokens."""


def house() -> dict[str, int]:
    """Return the number of each thing in `LIMITS`, then how the sources read, then the lines of each language."""
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    files = [Path(name) for name in listed.splitlines() if (ROOT / name).is_file() and not (ROOT / name).is_symlink()]
    product = [file for file in files if str(file).startswith(PRODUCT) and not {"examples", "tests"} & {*file.parts}]
    tools = [file for file in files if str(file).startswith("tools/")]
    search = [file for file in product if SEARCH.match(str(file))]
    tokens = {file: count_tokens(ROOT / file) for file in (*product, *tools)}
    codec = sum(tokens[file] for file in product if CODEC.match(str(file)))
    rest = sum(tokens[file] for file in product) - codec
    counted = (
        codec,
        rest,
        sum(map(tokens.__getitem__, tools)),
        total(count_constants, search),
        len(driven_twice(product)),
    )
    return dict(zip(LIMITS, counted, strict=True)) | reading(product) | lines(files, product)


def reading(product: Iterable[Path]) -> dict[str, int]:
    """Return how the sources of the product read: comments, long lines, long functions, many parameters."""
    python = [file for file in product if file.suffix == ".py"]
    sources = [file for file in product if file.suffix in {*chain.from_iterable(LANGUAGES.values())}]
    comments = total(lambda text: len(comment_lines(text)), python)
    return {
        "comment lines of Python, per thousand": 1000 * comments // total(count_lines, python),
        "lines over 140 characters": total(lambda text: sum(len(line) > 140 for line in text.splitlines()), sources),
        "functions of Python over 40 lines, without docstrings and comments": total(long_functions, python),
        "functions of C with nine parameters and more": total(
            many_parameters, [file for file in product if file.suffix == ".c"]
        ),
    }


def lines(files: Iterable[Path], product: Iterable[Path]) -> dict[str, int]:
    """Return the lines of each language in the product, of the tests, and of all Python."""
    sums = {
        f"product {name}, lines": total(count_lines, [file for file in product if file.suffix in ends])
        for name, ends in LANGUAGES.items()
    }
    tests = [file for file in files if file.suffix in CODE and str(file).startswith(TESTS)]
    python = [file for file in files if file.suffix == ".py"]
    return sums | {"tests, lines": total(count_lines, tests), "all Python, lines": total(count_lines, python)}


def total(count: Callable[[str], int], files: Iterable[Path]) -> int:
    """Return the sum over the texts of files."""
    return sum(count((ROOT / file).read_text(encoding="utf-8")) for file in files)


def count_lines(text: str) -> int:
    """Count as `wc -l`."""
    return text.count("\n")


def long_functions(text: str) -> int:
    """Count the functions of Python that have over 40 lines without their docstrings and comments."""
    functions = (node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.FunctionDef))
    comments = comment_lines(text)
    return sum(_length(function, comments) > 40 for function in functions)


def _length(function: ast.FunctionDef, comments: list[int]) -> int:
    described = ast.get_docstring(function, clean=False) is not None
    first = function.body[0]
    last = function.end_lineno or function.lineno
    said = sum(function.lineno < line <= last for line in comments)
    return last - function.lineno + 1 - said - (described * ((first.end_lineno or first.lineno) - first.lineno + 1))


def many_parameters(text: str) -> int:
    """Count the functions of C, where they are defined, that take nine parameters or more."""
    return sum(found[1].count(",") >= 8 for found in DEFINED.finditer(text))


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


def driven_twice(product: Iterable[Path]) -> list[str]:
    """Return the kernels that the product's Python and the C that charges and takes memory both call."""
    texts = {file: (ROOT / file).read_text("utf-8") for file in product if file.suffix in (".py", ".c", ".cpp")}
    bound = [name for file, text in texts.items() if file.name == "kernels.cpp" for name in BOUND.findall(text)]
    drivers = "\n".join(text for file, text in texts.items() if file.suffix == ".c" and CONTEXT.search(text))
    python = "\n".join(text for file, text in texts.items() if file.suffix == ".py")
    return [
        name
        for name in bound
        if re.search(rf"\b{name}\(", drivers) and re.search(rf"\b_kernels\.{name}\b|import .*\b{name}\b", python)
    ]


def main() -> int:
    """Print everything, with its limit where it has one."""
    argparse.ArgumentParser(description=__doc__.split("\n")[0]).parse_args()
    found = house()
    above = [what for what, limit in LIMITS.items() if found[what] > limit * (1 + SLACK * what.endswith("tokens"))]
    for what, number in found.items():
        print(f"{what:66}{number:8}{LIMITS.get(what, ''):8}  {'above' if what in above else ''}".rstrip())
    return int(bool(above))
