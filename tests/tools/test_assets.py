"""The comparison of assets with Draco's: what it prints is what both streams are."""

import numpy as np
import pytest

import bsm
from bsm import Attribute, TriangleMesh
from tests.bsm.program import python
from tests.shapes import torus
from tools.measure import assets


def test_assets_are_measured_with_their_first_normals_and_coordinates(tmp_path):
    pytest.importorskip("DracoPy")
    mesh = torus(40, 24)
    directions = (mesh.positions - mesh.positions.mean(axis=0)).astype(np.float32)
    normals = Attribute(
        "normal", directions / np.linalg.norm(directions, axis=1)[:, None], "vertex", "normal"
    )
    texcoords = Attribute(
        "texcoord", (0.3 * mesh.positions[:, :2] + 0.5).astype(np.float32), "vertex", "texcoord"
    )
    bsm.save(TriangleMesh(mesh.positions, mesh.faces, (normals, texcoords)), tmp_path / "a.ply")
    bsm.save(mesh, tmp_path / "bare.ply")
    done = python(
        "-m", "tools.measure", "assets", tmp_path / "bare.ply", tmp_path / "a.ply", text=True
    )
    rows = [[cell.strip() for cell in line.split("|")[1:-1]] for line in done.stdout.splitlines()]
    # The header, its rule, the one asset that has attributes, and the two lines over all.
    assert [row[0] for row in rows[2:]] == ["a", "median of 1", "largest of 1"]
    asset = assets.asset_of(str(tmp_path / "a.ply"))
    assert asset is not None and {attribute.semantic for attribute in asset.attributes} == {
        "normal",
        "texcoord",
    }
    expected = len(assets.stream_of(asset, "normal")) / len(assets.draco_of(asset))
    assert float(rows[2][4]) == pytest.approx(expected, abs=0.006)
