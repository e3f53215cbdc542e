"""Texts that people read are plain English: none of the patterns of translations, short sentences, no wide lines.

Each limit is the present number and may only fall.
"""

import ast
import re
import subprocess
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
READ = {".py", ".pyi", ".md", ".c", ".h", ".cpp", ".hpp", ".ts", ".mjs", ".js", ".rs"}
PATTERNS = {
    "a clause in place of a noun": re.compile(
        r"\b[Ww]hat (?:is|are|was|were|has|have|had|comes|becomes|it|they|a|the) "
        r"|\b(?:[Ww]hoever|[Nn]obody|[Tt]hose who)\b"
    ),
    "behind in place of after": re.compile(
        r"\bbehind (?:the|a|an|it|them|that|those|END|each|blocks|positions|\w+s)\b"
    ),
    "no after is": re.compile(r"\b(?:is|are|was|were) no \w+"),
    "a ratio in place of a percentage": re.compile(r"(?<![\d\w])\.\d+ of (?:the|its|all|a)\b"),
    "alone after a noun": re.compile(r"\b\w+s alone\b"),
    "a verb of state": re.compile(
        r"\b(?:speaks? of|strikes?\b|hangs? on|is another|are another|comes? again)"
    ),
}
"""Patterns of sentences, not words: each has a plain form that names the actor or the thing."""
LIMITS = {"documents": 4, "strings": 3}
EXCEPTIONS = ("What it must show",)
"""Parts of lines in which a pattern is right. Questions are right, too."""
PUBLIC = (
    "README.md",
    "CHANGELOG.md",
    "CONTRIBUTING.md",
    "library/README.md",
    "web/README.md",
    "library/bsmdec.h",
)
PRODUCT = ("src/", "codec/", "bitstream/")
PROGRAMS = re.compile(r"/built/|viewer\.js$")  # written by programs
WIDE = 120  # columns
DOCUMENTS = (
    "README.md",
    "CHANGELOG.md",
    "CONTRIBUTING.md",
    "codec/PAPER.md",
    "docs",
    "library",
    "src/bsm",
    "tools",
    "web",
)
"""Where Markdown, and the header in C, must have short sentences."""
MEAN, LONGEST = 15, 35  # words of a sentence


@cache
def tracked():
    """The texts of files that people read, without links."""
    listed = subprocess.run(
        ["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True, text=True
    ).stdout
    paths = [
        Path(name)
        for name in listed.split("\0")
        if Path(name).suffix in READ and not PROGRAMS.search(name)
    ]
    paths = [path for path in paths if (ROOT / path).is_file() and not (ROOT / path).is_symlink()]
    return {str(path): (ROOT / path).read_text("utf-8") for path in paths}


def texts(kind: str) -> Iterator[tuple[str, int, str]]:
    """Lines of public documents, or strings of two words or more in the product, each with its file and line."""
    for name, text in tracked().items():
        if kind == "strings" and name.startswith(PRODUCT) and name.endswith(".py"):
            for node in ast.walk(ast.parse(text)):
                if (
                    isinstance(node, ast.Constant)
                    and isinstance(node.value, str)
                    and " " in node.value
                ):
                    yield name, node.lineno, node.value
        elif kind == "documents" and (
            name in PUBLIC or (name.startswith(("docs/", "spec/")) and name.endswith(".md"))
        ):
            yield from ((name, number, line) for number, line in enumerate(text.splitlines(), 1))


def found(kind: str) -> list[str]:
    """Places of the patterns, as file, line, pattern and text."""
    return [
        f"{name}:{line}: {pattern}: {place.group()}"
        for name, line, text in texts(kind)
        if not any(part in text for part in EXCEPTIONS)
        for pattern, expression in PATTERNS.items()
        for place in expression.finditer(text)
    ]


def wide():
    """Names and texts of lines over `WIDE` columns in C, and in Markdown outside of tables and blocks of code."""
    for name, text in tracked().items():
        prose = name.endswith(".md")
        if prose or name.endswith((".c", ".h", ".cpp", ".hpp")):
            text = (
                re.sub(r"^```.*?^```", "", text, flags=re.MULTILINE | re.DOTALL) if prose else text
            )
            lines = (
                line for line in text.splitlines() if not (prose and line.startswith(("|", "    ")))
            )
            yield from (f"{name}: {line}" for line in lines if len(line) > WIDE)


def sentences(text):
    """The sentences of Markdown: no tables, code, headings and pictures; an item of a list ends one."""
    text = re.sub(r"^(?:```.*?^```|<!--.*?-->)$", "", text, flags=re.MULTILINE | re.DOTALL)
    text = re.sub(r"^(?: {4}|\||#|!\[|<).*$", "\n", text, flags=re.MULTILINE)
    text = re.sub(r"^ *(?:[-*]|\d+\.) ", "\n\n", text, flags=re.MULTILINE)
    text = re.sub(r"!?\[([^]]*)\]\([^)]*\)", r"\1", re.sub(r"`[^`]*`", "Code", text))
    parts = (
        part
        for item in re.split(r"\n\s*\n", text)
        for part in re.split(r"(?<=[.!?])[)\"*]*\s+(?=[A-Z(\"*])", item)
    )
    return [" ".join(part.split()) for part in parts if re.search(r"\w", part)]


def comments(text):
    """The comments of C, as paragraphs."""
    return "\n\n".join(
        re.sub(r"^ *\*+ ?", "", part, flags=re.MULTILINE)
        for part in re.findall(r"/\*+(.*?)\*/", text, re.DOTALL)
    )


def lengths(text):
    """Words of each sentence."""
    return [
        len([word for word in sentence.split() if re.search(r"\w", word)])
        for sentence in sentences(text)
    ]


def documents():
    """What users read, by name."""
    texts = {
        name: text
        for name, text in tracked().items()
        if name.endswith(".md") and name.startswith(DOCUMENTS)
    }
    return texts | {"library/bsmdec.h": comments(tracked()["library/bsmdec.h"])}


@pytest.mark.parametrize("kind", LIMITS)
def test_patterns_of_translations_only_get_fewer(kind):
    places = found(kind)
    assert len(places) <= LIMITS[kind], "\n".join(
        [f"{len(places)} of at most {LIMITS[kind]}:", *places]
    )


@pytest.mark.parametrize(
    ("text", "pattern"),
    [
        ("Return what is left.", "a clause in place of a noun"),
        ("bytes behind the end", "behind in place of after"),
        ("the key is no integer", "no after is"),
        ("at .95 of the time", "a ratio in place of a percentage"),
        ("streams alone", "alone after a noun"),
        ("METADATA speaks of it", "a verb of state"),
        ("the key is not an integer; 0.95 of 1; bytes after END; only streams", None),
    ],
)
def test_patterns_are_found(text, pattern):
    assert [name for name, expression in PATTERNS.items() if expression.search(text)] == (
        [pattern] if pattern else []
    )


def test_no_line_is_wide():
    assert not list(wide())


def test_sentences_are_short():
    counted = {name: lengths(text) for name, text in documents().items()}
    every = [words for found in counted.values() for words in found]
    assert sum(every) / len(every) <= MEAN
    assert not {
        name: max(found) for name, found in counted.items() if found and max(found) > LONGEST
    }


def test_sentences_are_counted_as_a_reader_does():
    text = (
        "# No title\n\nOne `two three` (four). Five\nsix 1.5.\n\n- Seven.\n\n"
        "| no | table |\n\n    code\n\nTwo *words.*"
    )
    assert lengths(text) == [3, 3, 1, 2]
    assert lengths(comments("/** One two. */ int x; /* Three\n * four */")) == [2, 2]
