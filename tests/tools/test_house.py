"""What `python -m tools.measure house` counts."""

from tools.measure.house import count_constants, docstring_lines


def test_entries_of_tables_count_and_an_expression_is_one():
    text = "A = 1.0 / 16\nB, C = 2, (3.0, 4)\nNAMES = ('x', 'y')\nT = {'a': 5, 'b': (6, 7)}\ndef f(x=8): y = 9\n"
    assert count_constants(text) == 1 + 3 + 3


def test_texts_that_stand_alone_are_docstrings():
    assert docstring_lines('"""One\n\ntwo."""\nA = """no\none"""\n"""Of A."""\ndef f():\n    "Three."\n') == 5
