"""The comparison of attributes with Draco's: normals that it computes, and figures that stay what they are."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

from bsm import TriangleMesh
from tools.measure import attributes

CUBE = TriangleMesh(
    np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float),
    [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4],
     [1, 5, 7], [1, 7, 3]],
)  # fmt: skip


def test_sharp_edges_part_normals():
    (sharp,) = attributes.with_normals(CUBE, 30.0).attributes
    assert len(sharp.values) == 24
    assert sorted(np.unique(np.abs(sharp.values), axis=0).tolist()) == [[0, 0, 1], [0, 1, 0], [1, 0, 0]]
    (smooth,) = attributes.with_normals(CUBE, 120.0).attributes
    assert len(smooth.values) == 8
    outwards = (CUBE.positions[CUBE.faces] - 0.5) / np.sqrt(0.75)
    assert smooth.indices is not None
    np.testing.assert_allclose(smooth.values[smooth.indices], outwards, atol=1e-6)


@pytest.mark.real
@pytest.mark.parametrize(
    ("name", "what", "most"), [("spot_uv.obj", "texcoord", 0.7), ("cortex_sulc.ply", "sulc", 0.45)]
)
def test_real_attributes_are_small(
    meshes: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], name: str, what: str, most: float
):
    pytest.importorskip("DracoPy")
    monkeypatch.setattr(sys, "argv", ["attributes", str(meshes / "assets" / name), "--grid", "12"])
    attributes.main()
    rows = [[cell.strip() for cell in line.split("|")] for line in capsys.readouterr().out.splitlines()]
    found = {row[2].split(",")[0]: row for row in rows if row[1] == name}
    assert float(found[what][5]) < most and float(found["whole file"][5]) < 0.85
