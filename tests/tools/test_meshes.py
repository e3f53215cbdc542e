"""The folder of real meshes is checked by what is in it."""

import numpy as np
import pytest

from bsm.evaluation.sample import knot
from bsm.files.mesh import write_mesh
from tools import meshes as tool


def test_what_is_missing_or_another_is_listed(tmp_path, monkeypatch):
    mesh = knot(300)
    monkeypatch.setattr(tool, "STATIC", {"a": (len(mesh.positions), len(mesh.faces)), "b": (7, 7), "c": (1, 1)})
    monkeypatch.setattr(tool, "DYNAMIC", {"d": (2, 5), "e": (1, 1)})
    for folder in ("static", "dynamic"):
        (tmp_path / folder).mkdir()
    for name in "ab":
        write_mesh(tmp_path / "static" / f"{name}.ply", mesh)
    np.savez(tmp_path / "dynamic/d.npz", positions=np.zeros((2, 5, 3)))
    found = list(tool.faults(tmp_path))
    assert [line.partition(": ")[0] for line in found] == [
        str(tmp_path / name) for name in ("static/b.ply", "static/c.ply", "dynamic/e.npz")
    ]
    assert "not 7 and 7" in found[0]


@pytest.mark.real
def test_our_folder_is_right(meshes):
    sizes = [len(found) for found in (tool.STATIC, tool.DYNAMIC)]
    assert sizes == [19, 3] and list(tool.faults(meshes)) == []
