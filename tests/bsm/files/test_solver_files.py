"""Nastran, Abaqus and Gmsh: what is taken comes out as their own libraries have it, and all else is refused by name."""

import re
import struct

import numpy as np
import pytest

import bsm
from tests.motion import sequence_in

SQUARE = ((1, 0, 0, 0), (2, 1, 0, 0), (3, 1, 1, 0), (4, 0, 1, 0))
GRIDS = "".join(f"GRID,{n},,{x}.,{y}.,{z}.\n" for n, x, y, z in SQUARE)
WIDE = "GRID*   {:16}                {:16.1f}{:16.1f}*\n*       {:16.1f}\n"
NODES = "*Node\n" + "".join(f"{n}, {x}, {y}, {z}\n" for n, x, y, z in SQUARE)
QUAD = "*Element, type=S4, elset=a\n1, 1, 2, 3, 4\n"


def read(path, text):
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return bsm.read_mesh(path)


def area_of(mesh):
    a, b, c = mesh.positions[mesh.faces.T]
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


def box_of(mesh):
    used = mesh.positions[np.unique(mesh.faces)]
    return [*used.min(axis=0).round(6).tolist(), *used.max(axis=0).round(6).tolist()]


NASTRAN = {
    "free fields": (GRIDS + "CQUAD4,1,7,1,2,3,4\n", 1, [0, 0, 0, 1, 1, 0]),
    "wide fields": (
        "BEGIN BULK\n"
        + "".join(WIDE.format(*row) for row in SQUARE)
        + "CQUAD4  1       7       1       2       3       4       30.0    0.5\nENDDATA\nnothing\n",
        1,
        [0, 0, 0, 1, 1, 0],
    ),
    "tabs, comments, exponents": (
        "sol 101\ncend\nbegin bulk $ here\n$GRID\n"
        "GRID\t1\t\t-1.-1\t0.\t0.\nGRID\t2\t\t1.\t0.\t0.\nGRID\t3\t\t1.\t1.D0\t0.\n"
        "CTRIA3\t1\t7\t1\t2\t3\t45.\n",
        0.55,
        [-0.1, 0, 0, 1, 1, 0],
    ),
    "coordinate systems in others": (
        "CORD2R,5,,10.,0.,0.,10.,0.,1.,\n,10.,1.,0.\nCORD2R,6,5,1.,0.,0.,1.,0.,1.,\n,2.,0.,0.\n"
        + GRIDS.replace(",,", ",6,", 4).replace("GRID,1,6", "GRID,1,6")
        + "CQUAD4,1,7,1,2,3,4\n",
        1,
        [9, 1, 0, 10, 2, 0],
    ),
    "nodes that make a cylindrical system": (
        "GRID,11,,10.,0.,0.\nGRID,12,,10.,0.,1.\nGRID,13,,11.,0.,0.\nCORD1C,4,12,11,13,5,11,12,13\n"
        "GRID,1,5,1.,0.,0.\nGRID,2,5,1.,90.,0.\nGRID,3,5,2.,0.,0.\nCTRIA3,1,7,1,2,3\n",
        0.5,
        [10, 0, 0, 12, 1, 0],
    ),
    "a spherical system": (
        "CORD2S,5,,0.,0.,0.,0.,0.,1.,\n,1.,0.,0.\nGRID,1,5,1.,90.,0.\nGRID,2,5,1.,90.,90.\nGRID,3,5,1.,0.,0.\n"
        "CTRIA3,1,7,1,2,3\n",
        3**0.5 / 2,
        [0, 0, 0, 1, 1, 1],
    ),
    "one card twice": (GRIDS + GRIDS + "CTRIA3,1,7,1,2,3\n", 0.5, [0, 0, 0, 1, 1, 0]),
    "an edge without a node": (GRIDS + "CTRIA6,1,7,1,2,3\n", 0.5, [0, 0, 0, 1, 1, 0]),
}


@pytest.mark.parametrize("what", NASTRAN)
def test_bulk_data_is_read_as_it_is_meant(what, tmp_path):
    text, area, box = NASTRAN[what]
    mesh = read(tmp_path / "a.bdf", text).mesh
    assert area_of(mesh) == pytest.approx(area) and box_of(mesh) == pytest.approx(box)
    assert mesh.attributes[0].name == "property" and set(mesh.attributes[0].values[:, 0]) == {7}


ABAQUS = {
    "blocks, blanks and long lines": (
        "*HEADING\nas written\n"
        + NODES
        + "*node, nset=more\n9,,,2.d0\n*ELEMENT, TYPE=S3R,\nELSET=b\n1,1,2,\n9\n",
        1,
        1,
    ),
    "shells and solids": (
        NODES
        + "".join(f"{n + 4}, {x}, {y}, 1\n" for n, x, y, _ in SQUARE)
        + "*Element, type=C3D8R\n1, 1,2,3,4,5,6,\n7,8\n"
        "*Element, type=M3D4\n2, 5,6,7,8\n*Step\n*Static\n*End Step\n",
        6,
        1,
    ),
    "instances": (
        "*Part, name=A\n"
        + NODES
        + QUAD
        + "*End part\n*Assembly, name=x\n*Instance, name=A-1, part=a\n*End instance\n"
        "*Instance, name=A-2, part=A\n0, 0, 5\n*End Instance\n*Node\n1, 9,9,9\n*End Assembly\n",
        2,
        2,
    ),
    "a part that is in no assembly": ("*Part, name=A\n" + NODES + QUAD + "*End Part\n", 1, 1),
    "named sets": (
        NODES + QUAD + "*Nset, nset=n\n1, 2\n*ELSET,ELSET=pl\n1\n*Surface, name=s\npl, SPOS\n",
        1,
        1,
    ),
    "beams and masses": (
        NODES + QUAD + "*Element, type=B31\n2, 1, 2\n*Element, type=MASS\n3, 1\n",
        1,
        1,
    ),
}


@pytest.mark.parametrize("what", ABAQUS)
def test_input_of_abaqus_is_read_as_it_is_meant(what, tmp_path):
    text, area, parts = ABAQUS[what]
    mesh, notes, _ = vars(read(tmp_path / "a.inp", text)).values()
    numbers = next((a.values for a in mesh.attributes if a.name == "part"), np.zeros(1))
    assert area_of(mesh) == pytest.approx(area) and len(np.unique(numbers)) == parts
    assert (
        "beams" not in what
        or "left out: elements of the type B31 (1), elements of the type MASS (1)" in notes
    )


@pytest.mark.parametrize("isolated", [None, True])
def test_files_include_others(isolated, tmp_path):
    (tmp_path / "below").mkdir()
    (tmp_path / "below" / "n.inp").write_text(NODES)
    (tmp_path / "e.txt").write_text("1, 1,2,3,4")
    (tmp_path / "a.inp").write_text(
        '*INCLUDE, INPUT="below/n.inp"\n*Element, input=e.txt, type=S4\n*Step\n'
    )
    (tmp_path / "g.dat").write_text("include 'below/more.dat'\n" + GRIDS[17:])
    (tmp_path / "below" / "more.dat").write_text(GRIDS[:17])
    (tmp_path / "a.bdf").write_text("BEGIN BULK\nINCLUDE 'g.\n dat'\nCQUAD4,1,7,1,2,3,4\nENDDATA\n")
    for name in ("a.inp", "a.bdf"):
        assert area_of(bsm.read_mesh(tmp_path / name, isolated=isolated).mesh) == pytest.approx(1)


def test_sets_of_elements_are_groups(tmp_path):
    found = read(
        tmp_path / "a.inp", NODES + "9, 2,0,0\n" + QUAD + "*Element, type=S3, elset=b\n2, 2,9,3\n"
    ).mesh
    assert [found.metadata[f"group.{n}.name"] for n in range(2)] == ["a", "b"]
    assert found.attributes[0].values[:, 0].tolist() == [0, 0, 1]


ELEMENTS = "$Elements\n2\n1 2 2 1 1 1 2 3\n2 2 2 1 1 1 3 4\n$EndElements\n"
TWICE = (
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n"
    + "".join(f"{n} {x} {y} {z}\n" for n, x, y, z in SQUARE)
    + f"$EndNodes\n{ELEMENTS}{ELEMENTS}"
    + '$ElementData\n1\n"x"\n1\n0\n3\n0\n1\n2\n1 5\n2 6\n$EndElementData\n'
)
REFUSED = {
    "a.bdf": (
        ("INCLUDE 'b.bdf'\n", "b.bdf: no such file beside the mesh"),
        ("INCLUDE '../b.bdf'\n", "not in the folder of the mesh"),
        ("INCLUDE 'a.bdf'\n", "included twice"),
        ("GRDSET,,5\n", "GRDSET"),
        ("CQUADX,1,1,1,2,3\n", "CQUADX"),
        (
            "CORD3G,5,,0.,0.,0.,0.,0.,1.,\n,1.,0.,0.\nGRID,1,5,0.,0.,0.\n",
            "coordinate system 5 is not there",
        ),
        ("BEGIN BULK\nBEGIN SUPER=1\n", "BEGIN SUPER=1"),
        (GRIDS + "GRID,1,,5.,5.,5.\nCTRIA3,1,7,1,2,3\n", "node 1 is there twice"),
        (GRIDS + "CTRIA3,1,7,1,2,8\n", "node 8 is not there"),
        ("GRID,1,8,0.,0.,0.\n" + GRIDS[17:] + "CTRIA3,1,7,1,2,3\n", "coordinate system 8"),
        ("CORD2R,1,1,0.,0.,0.,0.,0.,1.,\n,1.,0.,0.\nGRID,1,1,0.,0.,0.\n", "refers to itself"),
        ("GRID,1,,x,0.,0.\n", "line 1"),
        (GRIDS + "CTRIA6,1,7,1,2,3,4\n", "CTRIA6 with 4 of 6 nodes"),
        ("1,2,3\n", "not a card"),
    ),
    "a.inp": (
        ("*System\n1,0,0\n", "line 1: SYSTEM is not read"),
        (NODES + QUAD + "*Elgen\n1,2,1,1\n", "ELGEN"),
        ("*Ngen\n1,2\n", "NGEN"),
        ("*Node, system=C\n1,1,90\n", "NODE with SYSTEM"),
        ("*Include, input=b.inp\n", "b.inp: no such file beside the mesh"),
        ("*Include, input=a.inp\n", "included twice"),
        ("*Element, input=b.inp, type=S4\n", "b.inp: no such file"),
        ("*Surface, input=b.inp\n", "SURFACE with INPUT"),
        (NODES + "*Element, type=U1\n1, 1,2,3,4\n", "U1"),
        (NODES + "*Element, type=C3D15V\n1, 1\n", "C3D15V"),
        (NODES + "*Element, type=S4\n1, 1,2,3\n", "do not have 4 nodes"),
        (NODES + "1, 5,5,5\n" + QUAD, "node 1 is there twice"),
        ("*Instance, library=x\n", "INSTANCE"),
        ("# AVS UCD File\n", "not a file of Abaqus"),
        ("*Imperfection, file=x\n", "IMPERF"),
    ),
    "a.msh": (
        ("$Nodes\n$EndNodes\n$Nodes\n1\n$EndNodes\n", "another .Nodes is not read here"),
        (TWICE.replace("$Nodes", "$Nodes\n1 2"), "makes no sense"),
        (TWICE.replace("1 2 2 1 1 1 2 3", "1 21 2 1 1 1 2 3"), "type 21 .*-order 2"),
        (TWICE.replace("2.2 0 8", "1 0 8"), "the version 1"),
        ("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Faces\n$EndFaces\n", "Faces is not read here"),
        (
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0 0\n$EndNodes\n",
            "ends amid its numbers",
        ),
    ),
}


@pytest.mark.parametrize(
    ("name", "text", "why"), [(name, *case) for name, cases in REFUSED.items() for case in cases]
)
def test_what_may_change_the_mesh_is_refused_by_name(name, text, why, tmp_path):
    with pytest.raises(bsm.BsmError) as error:
        read(tmp_path / name, text)
    assert re.search(why, str(error.value))
    assert "not read here" not in str(error.value) or re.search("[.]vtu|gmsh", str(error.value))


# ------------------------------------------------------------------------------------------------- as the makers write


def test_sections_that_are_there_again_are_read_once(tmp_path):
    mesh = read(tmp_path / "a.msh", TWICE).mesh
    assert area_of(mesh) == 1 and mesh.attributes[0].values[:, 0].tolist() == [5, 6]


@pytest.mark.parametrize(("version", "binary"), [(2.2, 0), (2.2, 1), (4.0, 0), (4.1, 0), (4.1, 1)])
def test_partitions_parameters_and_views_of_gmsh(version, binary, tmp_path):
    gmsh = pytest.importorskip("gmsh", reason="files are written with Gmsh: pip install gmsh")
    path = str(tmp_path / "a.msh")
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.model.occ.addRectangle(0, 0, 0, 2, 1)
        gmsh.model.occ.synchronize()
        gmsh.model.addPhysicalGroup(2, [1], name="plate")
        gmsh.model.mesh.setPeriodic(1, [2], [4], [1, 0, 0, 2, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1])
        gmsh.model.mesh.generate(2)
        gmsh.model.mesh.recombine()
        gmsh.model.mesh.partition(2)
        parametric = version > 3  # in version 2, parameters are a section that is refused
        options = {
            "MshFileVersion": version,
            "Binary": binary,
            "SaveAll": 1,
            "SaveParametric": parametric,
        }
        for option, value in options.items():
            gmsh.option.setNumber(f"Mesh.{option}", value)
        gmsh.write(path)
        tags, places, _ = gmsh.model.mesh.getNodes()
        view = gmsh.view.add("x")
        for step in range(2):
            values = [[x + step] for x in places[::3]]
            gmsh.view.addModelData(
                view, step, gmsh.model.getCurrent(), "NodeData", tags, values, step
            )
        gmsh.view.write(view, str(tmp_path / "view.msh"))
    finally:
        gmsh.finalize()
    found = bsm.read_mesh(path)
    assert area_of(found.mesh) == pytest.approx(2)
    # With SaveAll, Gmsh writes none there.
    assert ("the group plate" in found.dropped) == (version < 3)
    moving = sequence_in(str(tmp_path / "view.msh"))
    assert moving.count == 2 and moving.frame_rate == 1
    for step, mesh in enumerate(moving.meshes):
        assert area_of(mesh) == pytest.approx(2)
        assert np.allclose(mesh.attributes[0].values[:, 0], mesh.positions[:, 0] + step)


@pytest.mark.parametrize(("version", "binary"), [(2.2, 0), (2.2, 1), (4.0, 0), (4.1, 0), (4.1, 1)])
@pytest.mark.parametrize("order", [1, 2])
def test_files_of_gmsh(version, binary, order, tmp_path, monkeypatch):
    gmsh = pytest.importorskip("gmsh", reason="files are written with Gmsh: pip install gmsh")
    path = str(tmp_path / "a.msh")
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.model.occ.addBox(0, 0, 0, 1, 2, 3)
        gmsh.model.occ.addRectangle(5, 0, 0, 1, 1)
        gmsh.model.occ.synchronize()
        gmsh.model.addPhysicalGroup(3, [1], name="inside")
        gmsh.model.addPhysicalGroup(2, [7], name="plate")
        gmsh.option.setNumber("Mesh.MeshSizeMin", 0.7)
        gmsh.model.mesh.generate(3)
        gmsh.model.mesh.setOrder(order)
        for option, value in (("MshFileVersion", version), ("Binary", binary)):
            gmsh.option.setNumber(f"Mesh.{option}", value)
        gmsh.write(path)
        tags, places, _ = gmsh.model.mesh.getNodes()
        of = dict(zip(tags.astype(int).tolist(), places[::3].tolist(), strict=True))
    finally:
        gmsh.finalize()
    for step in range(2 * (not binary)):  # Gmsh repeats the form before values
        rows = "".join(f"{number} {of[number] + step}\n" for number in sorted(of, reverse=True))
        with open(path, "a") as file:
            file.write(f"$MeshFormat\n{version:g} 0 8\n$EndMeshFormat\n")
            file.write(
                f'$NodeData\n1\n"x"\n1\n{step}\n3\n{step}\n1\n{len(of)}\n{rows}$EndNodeData\n'
            )
    mesh, _, dropped = vars(bsm.read_mesh(path)).values()
    values = next((a.values[:, 0] for a in mesh.attributes if a.name == "x"), mesh.positions[:, 0])
    assert np.allclose(values, mesh.positions[:, 0]) and (binary or "later steps (1)" in dropped)
    assert area_of(mesh) == pytest.approx(22 + 1) and box_of(mesh) == pytest.approx(
        [0, 0, 0, 6, 2, 3]
    )
    numbers = next(a.values[:, 0] for a in mesh.attributes if a.name == "group")
    sides = mesh.positions[mesh.faces].mean(axis=1)[:, 0] > 4
    names = [mesh.metadata[f"group.{n}.name"] for n in range(2)]
    assert [names[number] for number in numbers] == [
        "plate" if side else "inside" for side in sides
    ]

    if not binary:
        moving = sequence_in(path)
        assert (
            moving.count == 2
            and moving.frame_rate == 1
            and "later steps" not in " ".join(moving.notes)
        )
        second = [*moving.meshes][1]
        at = next(a.values[:, 0] for a in second.attributes if a.name == "x")
        assert np.allclose(at, second.positions[:, 0] + 1)


@pytest.mark.parametrize("version", [b"2.2", b"4.0", b"4.1"])
@pytest.mark.parametrize("last", [3, 2**31 - 1])
def test_numbers_of_nodes_may_be_far_apart(version, last, tmp_path):
    numbers, places = [1, 2, last], np.array([[0, 0, 0], [2, 0, 0], [0, 1, 0]], np.float64)
    rows = b"".join(
        struct.pack("<i3d", number, *place) for number, place in zip(numbers, places, strict=True)
    )
    if version == b"2.2":
        nodes = b"3\n" + rows
        elements = b"1\n" + struct.pack("<3i", 2, 1, 0) + struct.pack("<4i", 1, 1, 2, last)
    elif version == b"4.0":
        nodes = struct.pack("<2Q3iQ", 1, 3, 1, 2, 0, 3) + rows
        elements = struct.pack("<2Q3iQ4i", 1, 1, 1, 2, 2, 1, 1, 1, 2, last)
    else:
        nodes = struct.pack("<4Q3iQ3Q", 1, 3, 1, last, 2, 1, 0, 3, *numbers) + places.tobytes()
        elements = struct.pack("<4Q3iQ4Q", 1, 1, 1, 1, 2, 1, 2, 1, 1, 1, 2, last)
    head = b"$MeshFormat\n" + version + b" 1 8\n" + struct.pack("<i", 1) + b"\n$EndMeshFormat\n"
    path = tmp_path / "a.msh"
    path.write_bytes(
        head + b"$Nodes\n" + nodes + b"\n$EndNodes\n$Elements\n" + elements + b"\n$EndElements\n"
    )
    assert area_of(bsm.read_mesh(path).mesh) == pytest.approx(1)


@pytest.mark.parametrize("version", [2.2, 4.1])
def test_elements_of_several_groups_are_there_once(version, tmp_path):
    gmsh = pytest.importorskip("gmsh", reason="files are written with Gmsh: pip install gmsh")
    path = tmp_path / "a.msh"
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.model.occ.addRectangle(0, 0, 0, 2, 1)
        gmsh.model.occ.synchronize()
        for name in ("one", "other"):
            gmsh.model.addPhysicalGroup(2, [1], name=name)
        gmsh.model.mesh.generate(2)
        gmsh.option.setNumber("Mesh.MshFileVersion", version)
        gmsh.write(str(path))
    finally:
        gmsh.finalize()
    found = bsm.read_mesh(path)
    assert area_of(found.mesh) == pytest.approx(2)
    marks = {attribute.name: attribute.values for attribute in found.mesh.attributes}
    assert marks.keys() == {"one", "other"} and all(values.all() for values in marks.values())
    assert not found.dropped and any("several groups" in note for note in found.notes)


def test_files_of_pynastran(tmp_path):
    bdf = pytest.importorskip(
        "pyNastran.bdf.bdf", reason="files are written with pyNastran: pip install pyNastran"
    )
    model, rng = bdf.BDF(debug=None), np.random.default_rng(3)
    model.add_cord2r(5, [10.0, 1.0, 2.0], [10.0, 1.0, 3.0], [10.0, 2.0, 2.0])
    model.add_cord2c(6, [1.0, 40.0, 2.0], [1.0, 50.0, 3.0], [1.0, 2.0, 2.0], rid=5)
    model.add_cord1s(9, 4, 8, 12)
    places = rng.normal(size=(20, 3)).round(3)
    for number, place in enumerate(places.tolist(), 1):
        model.add_grid(number, place, cp=(0, 5, 6, 9)[number % 4])
    for number in range(1, 16):
        model.add_ctria3(
            number, 7, [number, number + 1, number + 4], theta_mcid=30.0 * (number % 3)
        )
    model.add_chexa(99, 8, [*range(1, 9)])
    model.add_pshell(7, 1, 0.1)
    model.add_psolid(8, 1)
    model.add_mat1(1, 3e7, None, 0.3)
    model.cross_reference()
    for size in (8, 16):
        path = tmp_path / f"a{size}.bdf"
        model.write_bdf(str(path), size=size)
        mesh = bsm.read_mesh(path).mesh
        theirs = np.array([model.nodes[number].get_position() for number in range(1, 21)])
        numbers = np.array([[number, number + 1, number + 4] for number in range(1, 16)]) - 1
        a, b, c = theirs[numbers].swapaxes(0, 1)
        shells = mesh.attributes[0].values[:, 0] == 7
        ours = np.linalg.norm(
            np.cross(*np.diff(mesh.positions[mesh.faces[shells]], axis=1).swapaxes(0, 1)), axis=1
        )
        assert ours == pytest.approx(np.linalg.norm(np.cross(b - a, c - a), axis=1), rel=1e-4)
        assert len(mesh.positions) == 19 and (~shells).sum() == 12


def test_lines_of_no_stl_are_named(tmp_path):
    facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
    found = read(tmp_path / "a.stl", f"solid a\ncolor 1 0 0\n{facet}endsolid a\n")
    assert area_of(found.mesh) == pytest.approx(0.5) and found.dropped == (
        "lines that begin with color",
    )
