"""What people read is plain English: no words of a private dialect, short sentences, no line wider than a screen.

Each limit is today's number and may only fall. `python -m tests.test_words` prints every number by file.
"""

import re
import subprocess
from collections import Counter
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
READ = {".py", ".pyi", ".md", ".c", ".h", ".cpp", ".hpp", ".ts", ".mjs", ".js", ".rs"}
DIALECT = re.compile(
    r"\b(?:told|said|news|(?:stand(?:s|ing)?|stood) for|so many|bear(?:s|ing)?|borne|to be had|(?:is|are) there after"
    r"|at right angles to|c[oa]mes? to the same|of that|what comes of|comes? late)\b",
    re.IGNORECASE,
)
"""Words of translations. Name the actor and the thing instead."""
PROGRAMS = re.compile(r"/built/|viewer\.js$")  # written by programs
DIALECT_LIMIT = 0
EXCEPTIONS = {
    "docs/measured.md": ("bear",),  # the name of a mesh
    "tests/test_words.py": ("",),
    "tools/vectors/bad_sequences.py": ("as one frame is told of",),  # as the manifest of 1.0 has it
}
"""Parts of lines in which such a word is right, by file; an empty part is the whole file. At most 20."""
WIDE = 120  # columns
WIDE_LIMITS = {"C": 0, "prose": 0}
DOCUMENTS = ("README.md", "CHANGELOG.md", "CONTRIBUTING.md", "codec/PAPER.md", "docs", "engine", "src/bsm", "tools")
"""Where Markdown, and the header in C, must have short sentences."""
MEAN, LONGEST = 15, 35  # words of a sentence
MARK = re.compile(r"^[ \t]*(?:#+:?|//+!?|/?\*+(?!/))?[ \t]*", re.MULTILINE)


@cache
def tracked():
    """The texts of files that people read, without links and what programs wrote."""
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    paths = [Path(name) for name in listed.split("\0") if Path(name).suffix in READ and not PROGRAMS.search(name)]
    paths = [path for path in paths if (ROOT / path).is_file() and not (ROOT / path).is_symlink()]
    texts = {str(path): (ROOT / path).read_text("utf-8") for path in paths}
    return {name: text for name, text in texts.items() if not text.startswith("/* Written by")}


def dialect():
    """How often each file uses words of the dialect."""
    found = {}
    for name, text in tracked().items():
        allowed = EXCEPTIONS.get(name, ())
        text = "\n".join(line for line in text.splitlines() if not any(part in line for part in allowed))
        words = DIALECT.findall(re.sub(r"[\s_]+", " ", MARK.sub("", text)))
        found[name] = Counter(word.lower() for word in words)
    return found


def wide():
    """Lines over `WIDE` columns in C, and in Markdown outside of tables, blocks of code and links."""
    found = {"C": Counter(), "prose": Counter()}
    for name, text in tracked().items():
        if name.endswith((".c", ".h", ".cpp", ".hpp")):
            found["C"][name] = sum(len(line) > WIDE for line in text.splitlines())
        elif name.endswith(".md"):
            text = re.sub(r"^```.*?^```", "", text, flags=re.MULTILINE | re.DOTALL)
            lines = [line for line in text.splitlines() if not line.startswith(("|", "    "))]
            found["prose"][name] = sum(len(line) > WIDE for line in lines)
    return found


def sentences(text):
    """The sentences of Markdown: no tables, code, headings and pictures; an item of a list ends one."""
    text = re.sub(r"^(?:```.*?^```|<!--.*?-->)$", "", text, flags=re.MULTILINE | re.DOTALL)
    text = re.sub(r"^(?: {4}|\||#|!\[|<).*$", "\n", text, flags=re.MULTILINE)
    text = re.sub(r"^ *(?:[-*]|\d+\.) ", "\n\n", text, flags=re.MULTILINE)
    text = re.sub(r"!?\[([^]]*)\]\([^)]*\)", r"\1", re.sub(r"`[^`]*`", "Code", text))
    parts = (
        part for item in re.split(r"\n\s*\n", text) for part in re.split(r"(?<=[.!?])[)\"*]*\s+(?=[A-Z(\"*])", item)
    )
    return [" ".join(part.split()) for part in parts if re.search(r"\w", part)]


def comments(text):
    """The comments of C, as paragraphs."""
    return "\n\n".join(
        re.sub(r"^ *\*+ ?", "", part, flags=re.MULTILINE) for part in re.findall(r"/\*+(.*?)\*/", text, re.DOTALL)
    )


def lengths(text):
    """Words of each sentence."""
    return [len([word for word in sentence.split() if re.search(r"\w", word)]) for sentence in sentences(text)]


def documents():
    """What users read, by name."""
    texts = {name: text for name, text in tracked().items() if name.endswith(".md") and name.startswith(DOCUMENTS)}
    return texts | {"engine/bsmdec.h": comments(tracked()["engine/bsmdec.h"])}


def test_words_of_the_dialect_only_get_fewer():
    found = dialect()
    total = sum(sum(words.values()) for words in found.values())
    worst = sorted(found, key=lambda name: -sum(found[name].values()))[:10]
    assert total <= DIALECT_LIMIT, f"{total} of at most {DIALECT_LIMIT}; most of them in {worst}"


def test_exceptions_are_few_and_needed():
    parts = [(name, part) for name, parts in EXCEPTIONS.items() for part in parts]
    assert len(parts) <= 20
    lines = {
        name: [line for line in tracked()[name].splitlines() if DIALECT.search(line.replace("_", " "))]
        for name in EXCEPTIONS
    }
    assert not [part for name, part in parts if not any(part in line for line in lines[name])]


@pytest.mark.parametrize("kind", WIDE_LIMITS)
def test_wide_lines_only_get_fewer(kind):
    found = wide()[kind]
    assert found.total() <= WIDE_LIMITS[kind], f"{found.total()} of at most {WIDE_LIMITS[kind]}: {found.most_common(5)}"


def test_sentences_are_short():
    counted = {name: lengths(text) for name, text in documents().items()}
    every = [words for found in counted.values() for words in found]
    assert sum(every) / len(every) <= MEAN
    assert not {name: max(found) for name, found in counted.items() if found and max(found) > LONGEST}


def test_sentences_are_counted_as_a_reader_does():
    text = (
        "# No title\n\nOne `two three` (four). Five\nsix 1.5.\n\n- Seven.\n\n| no | table |\n\n    code\n\nTwo *words.*"
    )
    assert lengths(text) == [3, 3, 1, 2]
    assert lengths(comments("/** One two. */ int x; /* Three\n * four */")) == [2, 2]


if __name__ == "__main__":
    for name, words in sorted(dialect().items(), key=lambda item: -item[1].total()):
        if words:
            print(f"{words.total():5} {name}: {', '.join(f'{word} {count}' for word, count in words.most_common())}")
    for kind, found in wide().items():
        print(kind, found.total(), found.most_common(12))
    print("words of the dialect:", sum(words.total() for words in dialect().values()))
    every = []
    for name, text in documents().items():
        every += (found := lengths(text))
        mean, longest = sum(found) / max(len(found), 1), max(found, default=0)
        print(f"{name:36}{len(found):4} sentences, mean {mean:5.1f}, longest {longest}")
    print(f"all: mean {sum(every) / len(every):.1f}, longest {max(every)}")
