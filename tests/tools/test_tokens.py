"""Tokens of sources: comments, docstrings and line breaks cost nothing, code and data do."""

import json
from pathlib import Path

import pytest

from tools.measure.house import long_functions, many_parameters
from tools.measure.tokens import comment_lines, count_python, count_scanned, count_tokens

PYTHON = """def area(a, b):
    return a * b
"""  # def area ( a , b ) : return a * b


def test_comments_docstrings_and_line_breaks_of_python_cost_nothing() -> None:
    told = '"""A module."""\n# why\ndef area(\n    a,\n    b,\n):\n    """Return it."""\n\n    return a * b  # units\n'
    assert count_python(PYTHON) == count_python(told) == 12
    assert comment_lines(told) == [2]


def test_a_string_is_one_token_also_with_places() -> None:
    assert count_python('x = f"{a + b} and {f(c)}"') == count_python('x = "a"') == 3


@pytest.mark.parametrize(
    ("text", "count"),
    [
        ("int a = b->c; // why", 7),
        ("int a = b->c; /* why\n not */", 7),
        ('call("a // b", \'"\', 1.5e3)', 8),
        ("const a = `x ${b + c} y`;", 3 + 1 + 3 + 1),
        ("fn f<'a>(x: &'a str) {}", 16),
    ],
)
def test_tokens_of_other_languages(text: str, count: int) -> None:
    assert count_scanned(text) == count


def test_tables_count_their_data(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("a,b,\n1,,2\n")
    (tmp_path / "a.json").write_text(json.dumps({"a": [1, 2, {"b": None}], "c": "d"}))
    (tmp_path / "a.txt").write_text("words\n")
    assert [count_tokens(tmp_path / name) for name in ("a.csv", "a.json", "a.txt")] == [4, 4, 0]


def test_long_functions_and_many_parameters_are_found() -> None:
    body = "    x = 1\n" * 39
    assert long_functions(f'def f():\n    """Say\n    it."""\n{body}') == 0
    assert long_functions(f"def f():\n    x = 0\n{body}    return x\n") == 1
    assert long_functions(f"def f():\n{body[10:]}    # why\n    return x\n") == 0
    assert many_parameters("static int f(int a, int b, int c, int d, int e, int f, int g, int h, int i) {\n}\n") == 1
    assert (
        many_parameters(
            "int f(int a, int b) {\n}\nint g(int a, int b, int c, int d, int e, int f, int g, int h, int i);\n"
        )
        == 0
    )
