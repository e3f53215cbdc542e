"""Tokens of sources: comments, docstrings and line breaks cost nothing, code and data do."""

import json
from pathlib import Path

import pytest

from tools.measure.density import measure_density
from tools.measure.house import function_lengths
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


def test_lengths_of_functions_leave_docstrings_and_comments_out() -> None:
    assert function_lengths(
        'def f():\n    """Say\n    it."""\n    x = 1\n    # why\n    return x\n'
    ) == [3]


def test_density_counts_what_stands_in_lines_of_code() -> None:
    text = '"""A module."""\n\n# why\nfound = [given if given else 0 for given in values]\n'
    density = measure_density(text)
    assert density.lines == 1
    assert (density.conditionals, density.comprehensions) == (1, 1)
    # The docstring is a statement and a string; then the assignment, its two sides, and the parts of the comprehension.
    assert density.nodes == 2 + 1 + 2 + 1 + 3 + 2
    nodes, conditionals, comprehensions, participles = density.figures
    assert (nodes, conditionals, comprehensions) == (11, 1000, 1000)
    assert participles == pytest.approx(1000 * 4 / 5)
