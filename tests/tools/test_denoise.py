"""The program that prints the tables of denoising."""

import json

import pytest

from tools.measure import denoise


def test_an_unknown_table_is_refused_with_the_known_ones(capsys) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(SystemExit) as stopped:
        denoise.main(["nowhere", "best"])
    assert stopped.value.code == 2
    assert "automatic" in capsys.readouterr().err


def test_a_wrong_answer_stops_the_benchmark(monkeypatch, capsys) -> None:  # type: ignore[no-untyped-def]
    monkeypatch.setitem(denoise.TABLES, "automatic", lambda folder: denoise.expect("one", False))
    assert denoise.main(["nowhere", "automatic"]) == 1
    assert "one" in capsys.readouterr().err


def test_the_readme_shows_what_was_measured() -> None:
    figures = json.loads(denoise.FIGURES.read_text(encoding="utf-8"))
    text = denoise.PAGE.read_text(encoding="utf-8")
    assert denoise.put_in(text, denoise.denoising_tables(figures)) == text
    assert set(figures["automatic"]) == set(denoise.PARTNERS)
    assert set(figures) == set(denoise.TABLES)
