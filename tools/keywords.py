"""Write stubs for type checkers: the public names of `bsm`, and the typed keywords of `bsm.encode` and its kin.

These are src/bsm/__init__.pyi and src/bsm/keywords.pyi. Keywords are the fields of options, and targets.

The build does it (CMakeLists.txt) where nothing is installed yet, so the sources are read, not imported.
"""

import ast
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
BOUNDS = {"preset": "str | None", "look": "float | None", "max_error": "float | str | None"}
MESHES, SEQUENCES = "codec/static/options.py", "codec/sequence/options.py"
HEAD = '''"""Keywords of `bsm.encode` and its kin, for type checkers; `bsm.encoding.options` checks values."""

from collections.abc import Callable, Mapping
from typing import TypedDict

from bsm.codec.static.options import Paper
from bsm.codec.static.targets import Contract, Target
'''


def body_of(path: str) -> list[ast.stmt]:
    return ast.parse((ROOT / path).read_text("utf-8")).body


def fields_of(path: str, name: str) -> dict[str, str]:
    """The fields of a class of options, and their types."""
    kind = next(
        node for node in body_of(path) if isinstance(node, ast.ClassDef) and node.name == name
    )
    found = (node for node in kind.body if isinstance(node, ast.AnnAssign))
    return {ast.unparse(node.target): ast.unparse(node.annotation) for node in found}


def table(path: str, name: str) -> Any:
    """The value of a constant."""
    found = (node for node in body_of(path) if isinstance(node, ast.Assign))
    return next(
        ast.literal_eval(node.value) for node in found if ast.unparse(node.targets[0]) == name
    )


def targets(name: str) -> dict[str, str]:
    """The targets in a table of `bsm.encoding.options`, of which only a size may have a unit."""
    keys = table("src/bsm/encoding/options.py", name)
    return {key: "int | str | None" if key == "size" else "float | None" for key in keys}


def main() -> None:
    public = "__version__: str\n__all__: list[str]\n"
    for home, names in table("src/bsm/__init__.py", "_NAMES").items():
        public += "".join(f"from {home} import {name} as {name}\n" for name in names.split())
    (ROOT / "src/bsm/__init__.pyi").write_text(public, "utf-8")
    meshes = (
        fields_of(MESHES, "EncodeOptions")
        | fields_of(MESHES, "Paper")
        | targets("TARGETS")
        | BOUNDS
    )
    sequences = (
        fields_of(SEQUENCES, "SequenceOptions")
        | targets("SEQUENCE_TARGETS")
        | {"effort": "str"}
        | BOUNDS
    )
    kinds = {
        "OptionKeywords": meshes,
        "EncodeKeywords": meshes
        | {"simplify": "bool", "progress": "Callable[[int, int], None] | None"},
        "SequenceKeywords": sequences,
        "DenoiseKeywords": fields_of("codec/denoise/filters.py", "DenoiseOptions"),
    }
    text = HEAD
    for name, fields in kinds.items():
        text += f"\nclass {name}(TypedDict, total=False):\n"
        text += "".join(f"    {field}: {kind}\n" for field, kind in fields.items())
    (ROOT / "src/bsm/keywords.pyi").write_text(text, "utf-8")


if __name__ == "__main__":
    main()
