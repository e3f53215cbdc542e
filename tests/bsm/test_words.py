"""The words that users meet in messages and help: words of this project are in the glossary, or are not used."""

import ast
import re
from pathlib import Path

import pytest

from bsm.cli import COMMANDS, command_parser

ROOT = Path(__file__).parents[2]
PRODUCT = ROOT / "src" / "bsm"
OWN = (
    *(
        "attribute",
        "block",
        "bound",
        "chain",
        "coefficient",
        "component",
        "dictionary",
        "generation",
        "GOP",
    ),
    *(
        "grid",
        "layer",
        "level",
        "preset",
        "promise",
        "refinement",
        "run",
        "section",
        "segment",
        "stream",
    ),
    *("target", "tile"),
)
"""Words with a meaning of their own here."""
PRIVATE = (
    "binds",
    "packet",
    "payload",
    "frame of type",
    "END frame",
    "varint",
    "closed loop",
    "rehearsal",
    "rung",
)
"""Words of the source and the specification, which users do not need."""


def helps() -> dict[str, str]:
    return {f"bsm {name} --help": command_parser(name).format_help() for name in COMMANDS}


def messages() -> dict[str, str]:
    """Return the texts of notes and errors by their places, without the values in them."""
    texts = {}
    for path in sorted(PRODUCT.rglob("*.py")):
        if path.relative_to(PRODUCT).parts[0] in ("bitstream", "codec"):
            continue
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if not isinstance(node, ast.Call):
                continue
            called = (
                node.func.attr
                if isinstance(node.func, ast.Attribute)
                else getattr(node.func, "id", "")
            )
            if called not in ("note", "say", "warn") and not called.endswith("Error"):
                continue
            parts = [part for argument in node.args for part in ast.walk(argument)]
            words = [
                part.value
                for part in parts
                if isinstance(part, ast.Constant) and isinstance(part.value, str)
            ]
            texts[f"{path.relative_to(ROOT)}:{node.lineno}"] = " ".join(words)
    return texts


@pytest.fixture(scope="module")
def texts() -> dict[str, str]:
    return helps() | messages()


def test_words_of_our_own_are_in_the_glossary(texts):
    rows = re.findall(r"^\| (.*?) \|", (ROOT / "docs/glossary.md").read_text("utf-8"), re.MULTILINE)
    explained = {word for row in rows for word in re.findall(r"[A-Za-z]+", row)}
    everything = " ".join(texts.values())
    used = {word for word in OWN if re.search(rf"\b{word}s?\b", everything)}
    assert len(texts) > 200 and len(used) > 12
    assert used <= explained


def test_no_message_uses_words_of_the_source(texts):
    found = [
        f"{place}: {word}" for place, text in texts.items() for word in PRIVATE if word in text
    ]
    assert found == []
