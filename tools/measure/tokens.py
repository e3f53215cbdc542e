"""Counts the tokens of a source, so that comments, docstrings, blank lines and line breaks cost nothing.

A limit in lines rewards dense lines and punishes comments that say why. Tokens do neither: a wrapped call counts as
much as the same call on one line. Python is read by its own tokenizer; a string is one token, whatever it interpolates,
and a comma before a closing bracket is none, since a formatter adds it where it wraps. C, C++, Rust and TypeScript are
read by one small scanner, in which adjacent operators are one token, and each `${...}` of a template is read as code.
In tables a token is a datum: each cell of a .csv that is not empty, each value of a .json.
"""

import ast
import csv
import io
import json
import re
import tokenize
from pathlib import Path

SCANNED = (".c", ".h", ".cpp", ".hpp", ".rs", ".ts")
SCANNER = re.compile(
    r"""(?P<comment>//[^\n]*|/\*.*?\*/)
    |(?P<template>`(?:\\.|[^`\\])*`)
    |"(?:\\.|[^"\\])*" | '(?:\\[^'\n]+|[^'\\\n])'    # a lifetime of Rust has no second quote: its quote is a token
    |\w+(?:\.\d\w*)? | [-+*/%&|^<>=!~?:.]+ | [^\w\s]""",
    re.DOTALL | re.VERBOSE,
)
PLACES = re.compile(r"\$\{(.*?)\}", re.DOTALL)
LAYOUT = {
    tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT, tokenize.ENCODING,
    tokenize.ENDMARKER,
}  # fmt: skip


def count_tokens(file: Path) -> int:
    """Count the tokens of a source or a table, by its suffix; 0 for others."""
    if file.suffix not in (".py", ".pyi", ".csv", ".json", *SCANNED):
        return 0
    text = file.read_text(encoding="utf-8")
    if file.suffix in (".py", ".pyi"):
        return count_python(text)
    if file.suffix == ".csv":
        return sum(bool(cell) for row in csv.reader(io.StringIO(text)) for cell in row)
    return _values(json.loads(text)) if file.suffix == ".json" else count_scanned(text)


def count_python(text: str) -> int:
    """Count the tokens of Python, without docstrings."""
    words = [
        token
        for token in tokenize.generate_tokens(io.StringIO(text).readline)
        if token.type not in LAYOUT
    ]
    # Python 3.12 cuts f-strings into pieces; older ones do not.
    begin, end = getattr(tokenize, "FSTRING_START", None), getattr(tokenize, "FSTRING_END", None)
    depth = count = 0
    before = ""
    for token in words:
        depth -= token.type == end
        count += depth == 0 and token.type != begin
        depth += token.type == begin
        count -= depth == 0 and before == "," and token.string in (")", "]", "}")
        before = token.string
    return count - len(docstrings(text))


def docstrings(text: str) -> list[ast.Expr]:
    """Return the statements that are a string alone: docstrings of modules, classes, functions and constants."""
    nodes = (node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.Expr))
    return [
        node
        for node in nodes
        if isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)
    ]


def comment_lines(text: str) -> list[int]:
    """The numbers of the lines of Python that are comments."""
    words = tokenize.generate_tokens(io.StringIO(text).readline)
    return [
        word.start[0]
        for word in words
        if word.type == tokenize.COMMENT and word.line.lstrip().startswith("#")
    ]


def count_scanned(text: str) -> int:
    """Count the tokens of C, C++, Rust or TypeScript."""
    count = 0
    for found in SCANNER.finditer(text):
        if found.lastgroup == "template":
            count += 1 + sum(map(count_scanned, PLACES.findall(found[0])))
        else:
            count += found.lastgroup != "comment"
    return count


def _values(data: object) -> int:
    if isinstance(data, dict | list):
        return sum(map(_values, data.values() if isinstance(data, dict) else data))
    return 1
