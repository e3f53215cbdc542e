"""What `python -m tools.measure look` prints."""

import json

import numpy as np
import pytest

from bsm.codec.look.measure import judged
from bsm.files.mesh import write_mesh
from tests.shapes import torus
from tools.measure import look
from tools.measure.look import Draco, main, size_at


def test_sizes_lie_between_those_of_two_numbers_of_bits():
    curve = [Draco(9, 1000, judged(0.08, 0.0, 0.0)), Draco(10, 2000, judged(0.02, 0.0, 0.0))]
    assert size_at(curve, 0.08) == pytest.approx(1000)
    assert size_at(curve, 0.02) == pytest.approx(2000)
    assert size_at(curve, 0.04) == pytest.approx(2**0.5 * 1000)
    assert np.isnan(size_at(curve, 0.1))


def test_a_row_for_each_wish(tmp_path, monkeypatch, capsys):
    pytest.importorskip("DracoPy")
    monkeypatch.setattr(look, "BITS", range(9, 13))
    path = tmp_path / "torus.ply"
    write_mesh(path, torus(20, 16))
    words = ["look", str(path), "--presets", "fine", "--options", "grid=11", "theta=0.0001"]
    monkeypatch.setattr("sys.argv", [*words, "--json"])
    main()
    draco, fine, grid, never = json.loads(capsys.readouterr().out)["rows"]
    assert draco["over_draco"] == 1
    assert fine["bytes"] < draco["bytes"]
    assert 0 < fine["distance"] <= 0.5
    assert grid["distance"] > 0
    assert "error" in never
    monkeypatch.setattr("sys.argv", words)
    main()
    assert capsys.readouterr().out.count("| torus |") == 4
