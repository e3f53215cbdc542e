"""How large the house is, beside what it may be: `python -m tools.measure house`; the exit code is 1 above a limit.

Of the files that git knows, in lines as `wc` counts them. The product has two parts: the codec proper, and the rest,
which serves people around it. Numbers with limits are only lowered; the others show where the lines are.
"""

import argparse
import ast
import re
import subprocess
from collections.abc import Callable, Iterable
from itertools import chain
from pathlib import Path

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
BOUND = re.compile(r"(?:KERNEL|CHECKED)\((\w+)\)")
"""A kernel that Python may call, by its name in C and in Python."""
CONTEXT = re.compile(r"\b(Context|Arena) \*")

LIMITS = {
    "codec proper, lines": 35_770,
    "rest of the product, lines": 31_129,
    "tests, lines": 30_831,
    "tools, lines": 17_370,
    "tuned constants of the search": 36,
    "kernels driven by both Python and C": 11,
}


def house() -> dict[str, int]:
    """Return the number of each thing in `LIMITS`, then the lines of each language."""
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    files = [Path(name) for name in listed.splitlines() if (ROOT / name).is_file() and not (ROOT / name).is_symlink()]
    product = [file for file in files if str(file).startswith(PRODUCT) and not {"examples", "tests"} & {*file.parts}]
    lines = {
        f"product {name}, lines": total(count_lines, [file for file in product if file.suffix in ends])
        for name, ends in LANGUAGES.items()
    }
    written = [file for file in product if file.suffix in {*chain.from_iterable(LANGUAGES.values())}]
    codec = total(count_lines, [file for file in written if CODEC.match(str(file))])
    code = [file for file in files if file.suffix in CODE]
    beside = [total(count_lines, [file for file in code if str(file).startswith(rooms)]) for rooms in (TESTS, "tools/")]
    search = [file for file in product if SEARCH.match(str(file))]
    counted = (codec, sum(lines.values()) - codec, *beside, total(count_constants, search), len(driven_twice(product)))
    python = total(count_lines, [file for file in files if file.suffix == ".py"])
    return dict(zip(LIMITS, counted, strict=True)) | lines | {"all Python, lines": python}


def total(count: Callable[[str], int], files: Iterable[Path]) -> int:
    """Return the sum over the texts of files."""
    return sum(count((ROOT / file).read_text(encoding="utf-8")) for file in files)


def count_lines(text: str) -> int:
    """Count as `wc -l`."""
    return text.count("\n")


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
    above = [what for what, limit in LIMITS.items() if found[what] > limit]
    for what, number in found.items():
        print(f"{what:46}{number:8}{LIMITS.get(what, ''):8}  {'above' if what in above else ''}".rstrip())
    return int(bool(above))
