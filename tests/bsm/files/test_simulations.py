"""Meshes of simulations: surfaces, the skin of volumes, their data, steps as frames, and what is left out."""

import numpy as np
import pytest

import bsm
from bsm.files import apart
from bsm.files.formats.cells import _SHAPES, of_meshio
from tests.grids import grid, save, save_grid
from tests.motion import sequence_in
from tests.shapes import file_of

meshio, _ = pytest.importorskip("meshio"), pytest.importorskip("h5py")
pytest.importorskip("lxml", reason="needs the extra simulation")
pytest.importorskip("vtkmodules", reason="needs the extra simulation")
POINTS = np.array([(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1, 2)], float)
CUBES = [[0, 1, 4, 3, 6, 7, 10, 9], [1, 2, 5, 4, 7, 8, 11, 10]]
KINDS = {
    "vtk": "vtk",
    "vtu": "vtu",
    "inp": "abaqus",
    "nas": "nastran",
    "msh": "gmsh",
    "xdmf": "xdmf",
}
CORNERS = {
    "tetra": [0, 1, 3, 6],
    "pyramid": [0, 1, 4, 3, 6],
    "wedge": [0, 1, 3, 6, 7, 9],
    "hexahedron": CUBES[0],
}
VOLUMES = {"tetra": 1 / 6, "pyramid": 1 / 3, "wedge": 1 / 2, "hexahedron": 1}


def volume_of(mesh):
    a, b, c = mesh.positions[mesh.faces.T]
    return float((a * np.cross(b, c)).sum() / 6)


@pytest.mark.parametrize("suffix", KINDS)
def test_a_volume_of_each_format_is_its_skin_with_its_data(suffix, tmp_path):
    data = {} if suffix in ("inp", "nas") else {"kind": [[1.0, 2.0]]}
    path = tmp_path / f"a.{suffix}"
    more = {"binary": False} if suffix == "msh" else {}
    model = meshio.Mesh(POINTS, {"hexahedron": CUBES}, {"heat": np.arange(12.0)}, data)
    # Meshio writes values of Gmsh as `repr`, which numpy 2 gives a type.
    with np.printoptions(legacy="1.21"):
        meshio.write(path, model, KINDS[suffix], **more)
    mesh, notes, dropped = vars(found := bsm.read_mesh(path)).values()
    assert (len(mesh.positions), len(mesh.faces), volume_of(mesh)) == (12, 20, pytest.approx(2))
    named = {attribute.name: attribute.values[:, 0] for attribute in mesh.attributes}
    order = np.lexsort(mesh.positions.T)
    sides = 1.0 + (mesh.positions[mesh.faces].mean(axis=1)[:, 0] > 1)
    assert not data or (
        named["heat"][order].tolist() == [*range(12)] and (named["kind"] == sides).all()
    )
    assert "the inside of volumes" in dropped and dropped[0] in notes[1] and found.mesh is mesh
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 3])
    with pytest.raises(bsm.BsmError):
        bsm.read_mesh(path)


@pytest.mark.parametrize("kind", CORNERS)
@pytest.mark.parametrize("up", [1, -1])
def test_volumes_are_seen_from_outside_and_quadratic_ones_at_all_their_nodes(kind, up):
    points, given, (_, edges, most) = POINTS * (1, 1, up), CORNERS[kind], _SHAPES[kind]
    middles = [points[[given[int(end)] for end in edge]].mean(axis=0) for edge in edges.split()]
    every = [*given, *range(12, 12 + most - len(given))]
    for name, cells, used in (
        (kind, given, len(given)),
        (f"{kind}{most}", every, len(given) + len(middles)),
    ):
        mesh = (
            of_meshio(meshio.Mesh([*points, *middles, *points], {name: [cells]}))
            .checked(bsm.Limits())
            .mesh
        )
        assert volume_of(mesh) == pytest.approx(VOLUMES[kind]) and len(mesh.positions) == used


def test_surfaces_stay_in_order_and_others_are_named():
    kinds = (
        ("line", [[0, 1]]),
        ("quad", [[0, 1, 4, 3]]),
        ("tetra", [[1, 2, 4, 8]]),
        ("triangle", [[1, 2, 4], [2, 5, 4]]),
    )
    left = ("polyhedron4", [[[0, 1, 3], [0, 1, 6], [0, 3, 6], [1, 3, 6]]])
    found = of_meshio(
        meshio.Mesh(POINTS, [*kinds, left], cell_data={"n": [[0], [1], [2], [3, 4], [5]]})
    )
    assert found.dropped == (
        "cells of the type line (1)",
        "cells of the type polyhedron4 (1)",
        "the inside of volumes",
    )
    assert found.columns[0].values[:, 0].tolist() == [
        1,
        2,
        2,
        2,
        3,
        4,
    ] and found.sizes.tolist() == [4, 3, 3, 3, 3, 3]
    flat = (
        of_meshio(meshio.Mesh(POINTS[:6, :2], [("quad9", [[0, 2, 5, 3, 1, 5, 4, 3, 4]])]))
        .checked(bsm.Limits())
        .mesh
    )
    assert len(flat.faces) == 6 and not flat.positions[:, 2].any()


@pytest.mark.parametrize("data", ["XML", "HDF"])
def test_steps_are_frames(data, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with meshio.xdmf.TimeSeriesWriter("a.xdmf", data) as writer:
        writer.write_points_cells(POINTS, {"hexahedron": CUBES})
        for step in range(3):
            writer.write_data(step / 4, point_data={"heat": np.full(12, step / 8)})
    frames = sequence_in("a.xdmf")
    assert [mesh.attributes[0].values[0, 0] for mesh in frames.meshes] == [0, 1 / 8, 1 / 4]
    assert frames.frame_rate == 4 and "left out: the inside of volumes" in frames.notes
    assert "later steps (2)" in bsm.read_mesh("a.xdmf").dropped
    if data == "HDF":
        (tmp_path / "a.xdmf").write_text(
            (tmp_path / "a.xdmf").read_text().replace("a.h5:", "../a.h5:")
        )
        with pytest.raises(bsm.FormatError, match="not in the folder"):
            bsm.read_mesh("a.xdmf")


# ----------------------------------------------------------------------------------------------------------------- VTK

HEXAHEDRA = [(12, cube) for cube in CUBES]


@pytest.mark.parametrize("suffix", ["vtk", "vtu", "vtkhdf", "exo"])
@pytest.mark.parametrize("isolated", [None, False])
def test_what_vtk_writes_is_read_with_its_values(suffix, isolated, tmp_path):
    path = tmp_path / f"a.{suffix}"
    of_points, of_cells = {"heat": np.arange(12.0)}, {"kind": np.array([1.0, 2.0])}
    save_grid(path, POINTS, HEXAHEDRA, of_points, of_cells)
    mesh = bsm.read_mesh(path, isolated=isolated).mesh
    named = {attribute.name: attribute.values[:, 0] for attribute in mesh.attributes}
    assert volume_of(mesh) == pytest.approx(2) and len(mesh.positions) == 12
    assert named["heat"][np.lexsort(mesh.positions.T)].tolist() == [*range(12)]
    assert (named["kind"] == 1 + (mesh.positions[mesh.faces].mean(axis=1)[:, 0] > 1)).all()


@pytest.mark.parametrize("kind", CORNERS)
@pytest.mark.parametrize("curved", [False, True])
def test_skins_of_vtk_look_outwards_with_the_values_of_their_cells(kind, curved, tmp_path):
    types = {"tetra": (10, 24), "pyramid": (14, 27), "wedge": (13, 26), "hexahedron": (12, 25)}
    given, points = CORNERS[kind], [*POINTS]
    edges = _SHAPES[kind][1].split() if curved else []
    cells = []
    for move in (0, 5):
        first = len(points)
        points += [*np.add(POINTS, (move, 0, 0))]
        middles = [first + 12 + place for place in range(len(edges))]
        points += [
            (POINTS[given[int(a)]] + POINTS[given[int(b)]]) / 2 + (move, 0, 0) for a, b in edges
        ]
        cells.append((types[kind][curved], [*(first + corner for corner in given), *middles]))
    save_grid(tmp_path / "a.vtu", points, cells, {}, {"n": np.array([3, 8])})
    mesh = bsm.read_mesh(tmp_path / "a.vtu").mesh
    assert volume_of(mesh) == pytest.approx(2 * VOLUMES[kind])
    moved = mesh.positions[mesh.faces].mean(axis=1)[:, 0] > 4
    assert (mesh.attributes[0].values[:, 0] == np.where(moved, 8, 3)).all()


@pytest.mark.parametrize("suffix", ["vtu", "vtk"])
@pytest.mark.parametrize("curved", [False, True])
def test_surface_cells_on_the_sides_of_volumes_are_there_once(suffix, curved, tmp_path):
    pairs = [(0, 1), (1, 3), (3, 0), (0, 6), (1, 6), (3, 6)] if curved else []
    points = [*POINTS, *(POINTS[[a, b]].mean(axis=0) for a, b in pairs)]
    solid = [0, 1, 3, 6, *range(12, 12 + len(pairs))]
    shells = [[0, 3, 1, 14, 13, 12], [0, 1, 6, 12, 16, 15]] if curved else [[0, 3, 1], [0, 1, 6]]
    cells = [(24 if curved else 10, solid), *((22 if curved else 5, shell) for shell in shells)]
    save_grid(tmp_path / f"a.{suffix}", points, cells, {}, {"n": np.array([9, 1, 2])})
    mesh = bsm.read_mesh(tmp_path / f"a.{suffix}").mesh
    assert volume_of(mesh) == pytest.approx(1 / 6) and len(mesh.faces) == (16 if curved else 4)
    assert np.bincount(mesh.attributes[0].values[:, 0].astype(int), minlength=10)[
        [1, 2, 9]
    ].tolist() == ([4, 4, 8] if curved else [1, 1, 2])


def test_cells_of_another_piece_close_the_skin_and_go(tmp_path):
    save_grid(
        tmp_path / "a.vtu", POINTS, HEXAHEDRA, {}, {"vtkGhostType": np.array([0, 1], np.uint8)}
    )
    mesh = bsm.read_mesh(tmp_path / "a.vtu").mesh
    assert len(mesh.faces) == 10 and mesh.positions[mesh.faces].max() == 1


def test_a_collection_of_partitions_is_read(tmp_path):
    model = pytest.importorskip("vtkmodules.vtkCommonDataModel").vtkPartitionedDataSetCollection()
    model.SetPartition(0, 0, grid(POINTS, HEXAHEDRA[:1]))
    model.SetPartition(1, 0, grid(POINTS, HEXAHEDRA[1:]))
    writer = pytest.importorskip(
        "vtkmodules.vtkIOParallelXML"
    ).vtkXMLPartitionedDataSetCollectionWriter()
    writer.SetFileName(str(tmp_path / "a.vtpc"))
    writer.SetInputData(model)
    assert writer.Write()
    assert volume_of(bsm.read_mesh(tmp_path / "a.vtpc").mesh) == pytest.approx(2)


LEGACY = "# vtk DataFile Version 3.0\nx\nASCII\nDATASET "
XML = '<VTKFile type="{0}" version="0.1" byte_order="LittleEndian"><{0}{1}>{2}</{0}></VTKFile>'
PIECE = (
    '<Piece NumberOfPoints="3" NumberOfCells="1"><Points><DataArray type="Float64" NumberOfComponents="3" '
    'format="ascii">{0} 0 0 {1} 0 0 {0} 1 0</DataArray></Points><Cells><DataArray type="Int32" Name="connectivity" '
    'format="ascii">0 1 2</DataArray><DataArray type="Int32" Name="offsets" format="ascii">3</DataArray>'
    '<DataArray type="UInt8" Name="types" format="ascii">5</DataArray></Cells></Piece>'
)
WRITTEN = {
    "strips.vtk": (
        LEGACY
        + "POLYDATA\nPOINTS 4 float\n0 0 0 1 0 0 0 1 0 1 1 0\nTRIANGLE_STRIPS 1 5\n4 0 1 2 3\n",
        2,
        1,
    ),
    "lines.vtk": (
        LEGACY
        + "POLYDATA\nPOINTS 4 float\n0 0 0 1 0 0 1 1 0 0 1 0\nLINES 1 3\n2 0 1\nPOLYGONS 1 5\n4 0 1 2 3\n"
        "CELL_DATA 2\nSCALARS n int 1\nLOOKUP_TABLE default\n7 8\n",
        2,
        1,
    ),
    "flat.vtk": (
        LEGACY + "STRUCTURED_POINTS\nDIMENSIONS 3 2 1\nORIGIN 0 0 0\nSPACING 1 1 1\n",
        4,
        2,
    ),
    "box.vtk": (
        LEGACY
        + "RECTILINEAR_GRID\nDIMENSIONS 2 2 2\nX_COORDINATES 2 float\n0 1\nY_COORDINATES 2 float\n0 1\n"
        "Z_COORDINATES 2 float\n0 1\n",
        12,
        6,
    ),
    "pieces.vtu": (
        XML.format("UnstructuredGrid", "", PIECE.format(0, 1) + PIECE.format(5, 7)),
        2,
        1.5,
    ),
}


@pytest.mark.parametrize("name", WRITTEN)
def test_kinds_of_data_of_vtk(name, tmp_path):
    text, faces, area = WRITTEN[name]
    (tmp_path / name).write_text(text)
    mesh, _, dropped = vars(bsm.read_mesh(tmp_path / name)).values()
    a, b, c = mesh.positions[mesh.faces.T]
    assert len(mesh.faces) == faces and np.linalg.norm(
        np.cross(b - a, c - a), axis=1
    ).sum() / 2 == pytest.approx(area)
    assert name != "lines.vtk" or (
        mesh.attributes[0].values[:, 0].tolist() == [8, 8] and "points and lines" in dropped
    )


@pytest.mark.parametrize(
    ("name", "text", "why"),
    [
        (
            "a.vtk",
            LEGACY + "STRUCTURED_POINTS\nDIMENSIONS 2000 2000 2000\n",
            "2000 x 2000 x 2000.*contour",
        ),
        (
            "a.vti",
            XML.format("ImageData", ' WholeExtent="0 299 0 299 0 299"', ""),
            "300 x 300 x 300",
        ),
        (
            "a.vtk",
            LEGACY + "RECTILINEAR_GRID\nDIMENSIONS 900 900 900\nX_COORDINATES 2 float\n0 1\n",
            "grid of 900 x 900 x 900",
        ),
        ("a.vtk", LEGACY + "UNSTRUCTURED_GRID\nPOINTS 3 float\n0 0 0 1 0 0\n", "VTK|rror"),
        ("a.vtu", "<VTKFile", "."),
        ("a.vtu", "", "."),
        ("a.exo", "CDF", "."),
    ],
)
def test_what_has_no_surface_is_refused_by_its_header(name, text, why, tmp_path):
    (tmp_path / name).write_text(text)
    with pytest.raises(bsm.FormatError, match=why):
        bsm.read_mesh(tmp_path / name)


def test_blocks_are_parts_with_their_names(tmp_path):
    model = pytest.importorskip("vtkmodules.vtkCommonDataModel")
    blocks = model.vtkMultiBlockDataSet()
    for number, name in enumerate(("left", "right")):
        blocks.SetBlock(number, grid(np.add(POINTS, (5 * number, 0, 0)), HEXAHEDRA))
        blocks.GetMetaData(number).Set(model.vtkCompositeDataSet.NAME(), name)
    writer = pytest.importorskip("vtkmodules.vtkIOXML").vtkXMLMultiBlockDataWriter()
    writer.SetFileName(str(tmp_path / "a.vtm"))
    writer.SetInputData(blocks)
    writer.Write()
    mesh = bsm.read_mesh(tmp_path / "a.vtm").mesh
    assert [mesh.metadata[f"part.{number}.name"] for number in range(2)] == ["left", "right"]
    assert volume_of(mesh) == pytest.approx(4)


def test_steps_of_exodus_are_frames(tmp_path):
    source = pytest.importorskip("vtkmodules.util.vtkAlgorithm").VTKPythonAlgorithmBase

    class Steps(source):
        def __init__(self):
            super().__init__(nInputPorts=0, nOutputPorts=1, outputType="vtkUnstructuredGrid")

        def RequestInformation(self, request, inputs, outputs):
            about, key = outputs.GetInformationObject(0), self.GetExecutive()
            about.Set(key.TIME_STEPS(), [0.0, 0.5, 1.0], 3)
            about.Set(key.TIME_RANGE(), [0.0, 1.0], 2)
            return 1

        def RequestData(self, request, inputs, outputs):
            about, key = outputs.GetInformationObject(0), self.GetExecutive().UPDATE_TIME_STEP()
            time = about.Get(key) if about.Has(key) else 0.0
            found = grid(POINTS, HEXAHEDRA, {"heat": np.full(12, time)})
            type(found).GetData(about).DeepCopy(found)
            return 1

    writer = pytest.importorskip("vtkmodules.vtkIOExodus").vtkExodusIIWriter()
    steps = Steps()
    writer.SetInputConnection(steps.GetOutputPort())
    writer.SetFileName(str(tmp_path / "a.exo"))
    writer.WriteAllTimeStepsOn()
    assert writer.Write()
    frames = sequence_in(str(tmp_path / "a.exo"))
    assert frames.count == 3 and frames.frame_rate == 2
    assert [
        next(a for a in mesh.attributes if a.name == "heat").values[0, 0] for mesh in frames.meshes
    ] == [0, 0.5, 1]
    assert "later steps (2)" in bsm.read_mesh(tmp_path / "a.exo").dropped


def end(process):
    """Kill a process, and wait until it is gone."""
    process.kill()
    process.wait()


def test_a_crash_of_vtk_is_an_error_and_the_next_file_is_read(tmp_path, monkeypatch):
    save_grid(tmp_path / "a.vtu", POINTS, HEXAHEDRA)
    bsm.read_mesh(tmp_path / "a.vtu")
    end(apart._process())
    # What crashed once is read again in a new process.
    assert len(bsm.read_mesh(tmp_path / "a.vtu").mesh.faces) == 20
    end(apart._process())
    with monkeypatch.context() as crashing, pytest.raises(bsm.FormatError, match="crashed VTK"):
        crashing.setattr(apart, "_COMMAND", "import os; os.abort()")
        bsm.read_mesh(tmp_path / "a.vtu")
    assert len(bsm.read_mesh(tmp_path / "a.vtu").mesh.faces) == 20


def test_a_folder_and_a_pattern_find_every_format_that_is_read(tmp_path):
    for number in range(3):
        save(tmp_path / f"s_{number}.vtu", grid(np.add(POINTS, (0, 0, number)), HEXAHEDRA))
    for name in (str(tmp_path), str(tmp_path / "s_*.vtu")):
        frames = sequence_in(name)
        assert [frame[:, 2].min() for frame in frames.frames] == [0, 1, 2]


def test_an_order_of_nodes_in_xdmf_is_refused(tmp_path):
    meshio.write(
        tmp_path / "a.xdmf", meshio.Mesh(POINTS, {"hexahedron": CUBES}), "xdmf", data_format="XML"
    )
    text = (tmp_path / "a.xdmf").read_text()
    assert len(bsm.read_mesh(tmp_path / "a.xdmf").mesh.faces) == 20
    (tmp_path / "a.xdmf").write_text(
        text.replace("<Topology ", '<Topology Order="1 0 2 3 4 5 6 7" ', 1)
    )
    with pytest.raises(bsm.FormatError, match=r"order of nodes.*\.vtu"):
        bsm.read_mesh(tmp_path / "a.xdmf")


def test_the_name_of_a_file_tells_its_format_before_its_lines_do(tmp_path):
    """An array called v looks like the vertices of an OBJ, and pieces of polygons like a VTP."""
    text = "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n0 0 0 1 0 0 0 1 0\nPOLYGONS 1 4\n"
    text += "3 0 1 2\nPOINT_DATA 3\nFIELD f 2\nu 1 3 float\n1 2 3\nv 1 3 float\n4 5 6\n"
    (tmp_path / "a.vtk").write_text(text)
    mesh = bsm.read_mesh(tmp_path / "a.vtk").mesh
    assert {a.name: a.values[:, 0].tolist() for a in mesh.attributes} == {
        "u": [1, 2, 3],
        "v": [4, 5, 6],
    }
    (tmp_path / "b.vtp").write_bytes(file_of(mesh, "vtp"))
    text = "<VTKFile type='PPolyData'><PPolyData><PPoints><PDataArray type='Float32' NumberOfComponents='3'/></PPoints>"
    pieces = "<Piece Source='b.vtp'/>" * 2
    (tmp_path / "b.pvtp").write_text(f"{text}{pieces}</PPolyData></VTKFile>")
    assert len(bsm.read_mesh(tmp_path / "b.pvtp").mesh.faces) == 2
