"""The program that prints the tables of denoising."""

from pathlib import Path

import pytest

from tools import benchmark_denoise


def test_an_unknown_table_is_refused_with_the_known_ones(capsys) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(SystemExit) as stopped:
        benchmark_denoise.main(["nowhere", "best"])
    assert stopped.value.code == 2
    assert next(iter(benchmark_denoise.TABLES)) in capsys.readouterr().err


def test_a_wrong_answer_stops_the_benchmark(monkeypatch, capsys) -> None:  # type: ignore[no-untyped-def]
    monkeypatch.setitem(benchmark_denoise.TABLES, "metrics", lambda folder: benchmark_denoise.expect("one", False))
    assert benchmark_denoise.main(["nowhere", "metrics"]) == 1
    assert "one" in capsys.readouterr().err


@pytest.mark.real
def test_the_metrics_table_checks_and_prints(meshes: Path, capsys) -> None:  # type: ignore[no-untyped-def]
    assert benchmark_denoise.main([str(meshes), "metrics"]) == 0
    assert "ms" in capsys.readouterr().out
