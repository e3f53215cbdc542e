"""Meshes of simulations: surfaces, the skin of volumes, their data, steps as frames, and what is left out."""

import numpy as np
import pytest

import bsm
from bsm.files.formats.with_meshio import _SHAPES, of_meshio
from bsm.files.motion.frames import Wanted
from bsm.files.sequence import open_sequence

meshio, _ = pytest.importorskip("meshio"), pytest.importorskip("h5py")
POINTS = np.array([(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1, 2)], float)
CUBES = [[0, 1, 4, 3, 6, 7, 10, 9], [1, 2, 5, 4, 7, 8, 11, 10]]
KINDS = {"vtk": "vtk", "vtu": "vtu", "inp": "abaqus", "nas": "nastran", "msh": "gmsh", "xdmf": "xdmf"}
CORNERS = {"tetra": [0, 1, 3, 6], "pyramid": [0, 1, 4, 3, 6], "wedge": [0, 1, 3, 6, 7, 9], "hexahedron": CUBES[0]}
VOLUMES = {"tetra": 1 / 6, "pyramid": 1 / 3, "wedge": 1 / 2, "hexahedron": 1}


def volume_of(mesh):
    a, b, c = mesh.positions[mesh.faces.T]
    return float((a * np.cross(b, c)).sum() / 6)


@pytest.mark.parametrize("suffix", KINDS)
def test_a_volume_of_each_format_is_its_skin_with_its_data(suffix, tmp_path):
    data = {} if suffix in ("inp", "nas") else {"kind": [[1.0, 2.0]]}
    path = tmp_path / f"a.{suffix}"
    meshio.write(path, meshio.Mesh(POINTS, {"hexahedron": CUBES}, {"heat": np.arange(12.0)}, data), KINDS[suffix])
    mesh, notes, dropped = vars(found := bsm.read_mesh(path)).values()
    assert (len(mesh.positions), len(mesh.faces), volume_of(mesh)) == (12, 20, pytest.approx(2))
    named = {attribute.name: attribute.values[:, 0].tolist() for attribute in mesh.attributes}
    assert not data or (named["heat"] == [*range(12)] and named["kind"] == [1.0] * 10 + [2.0] * 10)
    assert dropped[0] == "the inside of volumes" and dropped[0] in notes[1] and found.mesh is mesh
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 3])
    with pytest.raises(bsm.BsmError):
        bsm.read_mesh(path)


@pytest.mark.parametrize("kind", CORNERS)
@pytest.mark.parametrize("up", [1, -1])
def test_volumes_are_seen_from_outside_and_quadratic_ones_at_all_their_nodes(kind, up):
    points, given, (_, edges, most) = POINTS * (1, 1, up), CORNERS[kind], _SHAPES[kind]
    middles = [points[[given[int(end)] for end in edge]].mean(axis=0) for edge in edges.split()]
    every = [*given, *range(12, 12 + most - len(given))]
    for name, cells, used in (kind, given, len(given)), (f"{kind}{most}", every, len(given) + len(middles)):
        mesh = of_meshio(meshio.Mesh([*points, *middles, *points], {name: [cells]})).checked(bsm.Limits()).mesh
        assert volume_of(mesh) == pytest.approx(VOLUMES[kind]) and len(mesh.positions) == used


def test_surfaces_stay_in_order_and_others_are_named():
    kinds = (
        ("line", [[0, 1]]),
        ("quad", [[0, 1, 4, 3]]),
        ("tetra", [[1, 2, 4, 8]]),
        ("triangle", [[1, 2, 4], [2, 5, 4]]),
    )
    left = ("polyhedron4", [[[0, 1, 3], [0, 1, 6], [0, 3, 6], [1, 3, 6]]])
    found = of_meshio(meshio.Mesh(POINTS, [*kinds, left], cell_data={"n": [[0], [1], [2], [3, 4], [5]]}))
    assert found.dropped == ("cells of the type line", "cells of the type polyhedron4", "the inside of volumes")
    assert found.columns[0].values[:, 0].tolist() == [1, 2, 2, 2, 3, 4] and found.sizes.tolist() == [4, 3, 3, 3, 3, 3]
    flat = of_meshio(meshio.Mesh(POINTS[:6, :2], [("quad9", [[0, 2, 5, 3, 1, 5, 4, 3, 4]])])).checked(bsm.Limits()).mesh
    assert len(flat.faces) == 6 and not flat.positions[:, 2].any()


@pytest.mark.parametrize("data", ["XML", "HDF"])
def test_steps_are_frames(data, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with meshio.xdmf.TimeSeriesWriter("a.xdmf", data) as writer:
        writer.write_points_cells(POINTS, {"hexahedron": CUBES})
        for step in range(3):
            writer.write_data(step / 4, point_data={"heat": np.full(12, step / 8)})
    frames = open_sequence("a.xdmf", wanted=Wanted())
    assert [mesh.attributes[0].values[0, 0] for mesh in frames.meshes] == [0, 1 / 8, 1 / 4]
    assert frames.frame_rate == 4 and "left out: the inside of volumes" in frames.notes
    assert "later steps (2)" in bsm.read_mesh("a.xdmf").dropped
    if data == "HDF":
        (tmp_path / "a.xdmf").write_text((tmp_path / "a.xdmf").read_text().replace("a.h5:", "../a.h5:"))
        with pytest.raises(bsm.FormatError, match="not in the folder"):
            bsm.read_mesh("a.xdmf")
