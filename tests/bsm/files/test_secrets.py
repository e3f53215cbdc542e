"""No file of any format brings out what lies outside of its folder, by whatever means it names that."""

import base64
import json
import os
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import bsm
from bsm.files import landlock
from tests.bsm.program import bsm as bsm_of
from tests.grids import save_grid
from tests.motion import sequence_in

h5py = pytest.importorskip("h5py", reason="needs the extra simulation")
pytest.importorskip("lxml", reason="needs the extra simulation")
pytest.importorskip("vtkmodules", reason="needs the extra simulation")
NUMBER, WORD = 424242.0, "SECRET-7c1f"
"""What the secret files hold."""
POINTS = np.array([(x, y, x * y / 3) for y in range(3) for x in range(4)], float)
CELLS = [(9, [0, 1, 5, 4]), (9, [1, 2, 6, 5]), (9, [5, 6, 10, 9])]
HEAT = np.full(12, NUMBER)
TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
PNG = base64.b64decode(
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="
)
Make = Callable[[Path, str], None]
"""Write a file that names another one."""
CASES: dict[str, tuple[str, Make]] = {}
"""By their names: the suffix of the secret file, and how a file is written that names it."""


def case(name: str, suffix: str) -> Callable[[Make], Make]:
    def add(make: Make) -> Make:
        CASES[name] = suffix, make
        return make

    return add


# --------------------------------------------------------------------------------------------------- the secrets


def secret(path: Path) -> None:
    """Write a file that holds the secret, sound in its format."""
    path.parent.mkdir(exist_ok=True)
    match path.suffix[1:]:
        case "h5" | "cgns" as kind:
            with h5py.File(path, "w") as file:
                file["d"], file["word"] = HEAT, WORD
                if kind == "cgns":
                    cgns(file, HEAT)
        case "vtu" | "vtkhdf":
            save_grid(path, POINTS, CELLS, {"heat": HEAT}, {})
        case "usda":
            text = 'def Mesh "m" {\nint[] faceVertexCounts = [3]\nint[] faceVertexIndices = [0, 1, 2]\n'
            text += f"point3f[] points.timeSamples = {{ 0: [(0, 0, 0), (1, 0, 0), (0, {NUMBER}, 0)] }}\n}}\n"
            path.write_text(f"#usda 1.0\n{text}")
        case "raw":
            path.write_bytes(HEAT.tobytes())
        case "bin":
            path.write_bytes(
                np.array([[0, 0, 0], [NUMBER, 0, 0], [0, 1, 0]], "f4").tobytes() + b"\0\1\2\0"
            )
        case "png":
            path.write_bytes(PNG + WORD.encode())
        case "mtl":
            path.write_text(f"newmtl {WORD}\nKd 1 0 0\n")
        case "geo":
            lines = [
                "first",
                "second",
                "node id assign",
                "element id assign",
                "part",
                f"{1:10}",
                WORD,
                "coordinates",
            ]
            lines += [
                f"{3:10}",
                *(f"{x:12.5e}" for x in (0, NUMBER, 0, 0, 0, 1, 0, 0, 0)),
                "tria3",
                f"{1:10}",
            ]
            path.write_text("\n".join([*lines, f"{1:10}{2:10}{3:10}"]) + "\n")
        case "bdf":
            path.write_text(
                f"GRID,1,,0.,0.,0.\nGRID,2,,{NUMBER},0.,0.\nGRID,3,,0.,1.,0.\nCTRIA3,1,1,1,2,3\n"
            )
        case "inp":
            path.write_text(
                f"*NODE\n1,0,0,0\n2,{NUMBER},0,0\n3,0,1,0\n*ELEMENT, TYPE=S3\n1,1,2,3\n"
            )
        case "obj":
            path.write_text(TRIANGLE.replace("v 1", f"v {NUMBER}"))
        case _:
            path.write_text(f"{WORD} {NUMBER}\n")


def cgns(file: "h5py.File", values: np.ndarray, link: str = "") -> None:
    """Write a surface as CGNS has it, whose solution may be in another file."""

    def node(
        above: "h5py.Group", name: str, label: str, kind: str = "MT", data: object = None
    ) -> "h5py.Group":
        one = above.create_group(name) if name else above
        for key, text, size in (
            ("name", name or "HDF5 MotherNode", 33),
            ("label", label, 33),
            ("type", kind, 3),
        ):
            one.attrs.create(key, np.bytes_(text.encode()), dtype=f"S{size}")
        if name:
            one.attrs["flags"] = np.array([1], np.int32)
        if data is not None:
            one[" data"] = data
        return one

    def text(words: str) -> np.ndarray:
        return np.frombuffer(words.encode(), np.int8)

    node(file, "", "Root Node of HDF5 File")
    file[" format"] = text("IEEE_LITTLE_32\0")
    file[" hdf5version"] = text("HDF5 Version 1.8.17".ljust(33, "\0"))
    node(file, "CGNSLibraryVersion", "CGNSLibraryVersion_t", "R4", np.array([3.2], np.float32))
    base = node(file, "Base", "CGNSBase_t", "I4", np.array([2, 3], np.int32))
    zone = node(base, "Zone", "Zone_t", "I4", np.array([[12], [3], [0]], np.int32))
    node(zone, "ZoneType", "ZoneType_t", "C1", text("Unstructured"))
    grid = node(zone, "GridCoordinates", "GridCoordinates_t")
    for axis, name in enumerate("XYZ"):
        node(grid, f"Coordinate{name}", "DataArray_t", "R8", POINTS[:, axis])
    quads = node(zone, "Quads", "Elements_t", "I4", np.array([7, 0], np.int32))
    node(quads, "ElementRange", "IndexRange_t", "I4", np.array([1, 3], np.int32))
    corners = np.concatenate([np.array(corners) for _, corners in CELLS]).astype(np.int32) + 1
    node(quads, "ElementConnectivity", "DataArray_t", "I4", corners)
    solution = node(zone, "Solution", "FlowSolution_t")
    node(solution, "GridLocation", "GridLocation_t", "C1", text("Vertex"))
    if link:
        heat = node(solution, "heat", "", "LK")
        heat[" file"], heat[" path"] = text(link + "\0"), text("/Base/Zone/Solution/heat\0")
        heat[" link"] = h5py.ExternalLink(link, "/Base/Zone/Solution/heat")
    else:
        node(solution, "heat", "DataArray_t", "R8", values)


# ------------------------------------------------------------------------------------------------------- HDF5


def show(file: "h5py.Group", place: str, name: str, means: str) -> None:
    """Put a table of another file into a group."""
    if place in file:
        del file[place]
    if means == "raw":
        file.create_dataset(place, (12,), "f8", external=[(name, 0, 96)])
    elif means == "link":
        file[place] = h5py.ExternalLink(name, "/d")
    elif means == "soft":
        file["away"], file[place] = h5py.ExternalLink(name, "/"), h5py.SoftLink("/away/d")
    else:
        layout = h5py.VirtualLayout((12,), "f8")
        layout[:] = h5py.VirtualSource(name, "d", (12,))
        file.create_virtual_dataset(place, layout)


def xdmf(values: str) -> str:
    def item(words: str, dims: str, form: str = "XML") -> str:
        return f'<DataItem Dimensions="{dims}" Format="{form}">{words}</DataItem>'

    places, corners = (
        " ".join(map(str, np.ravel(table))) for table in (POINTS, [corners for _, corners in CELLS])
    )
    grid = f'<Topology TopologyType="Quadrilateral" NumberOfElements="3">{item(corners, "3 4")}</Topology>'
    grid += f'<Geometry GeometryType="XYZ">{item(places, "12 3")}</Geometry>'
    grid += f'<Attribute Name="heat" Center="Node">{item(values, "12", "HDF")}</Attribute>'
    return f'<Xdmf><Domain><Grid Name="g">{grid}</Grid></Domain></Xdmf>'


def _hdf(means: str) -> None:
    suffix = "raw" if means == "raw" else "h5"

    @case(f"xdmf, {means}", suffix)
    def of_xdmf(folder: Path, name: str) -> None:
        with h5py.File(folder / "own.h5", "w") as file:
            show(file, "heat", name, means)
        (folder / "a.xdmf").write_text(xdmf("own.h5:/heat"))

    @case(f"vtkhdf, {means}", suffix)
    def of_vtk(folder: Path, name: str) -> None:
        save_grid(folder / "a.vtkhdf", POINTS, CELLS, {"heat": np.zeros(12)}, {})
        with h5py.File(folder / "a.vtkhdf", "r+") as file:
            show(file, "VTKHDF/PointData/heat", name, means)

    @case(f"exo, {means}", suffix)
    def of_exodus(folder: Path, name: str) -> None:
        with h5py.File(folder / "a.exo", "w") as file:
            show(file, "coordx", name, means)


for _means in ("raw", "link", "soft", "virtual"):
    _hdf(_means)


@case("xdmf, the file itself", "h5")
def _(folder: Path, name: str) -> None:
    (folder / "a.xdmf").write_text(xdmf(f"{name}:/d"))


@case("cgns, link", "cgns")
def _(folder: Path, name: str) -> None:
    with h5py.File(folder / "a.cgns", "w") as file:
        cgns(file, HEAT, name)


# -------------------------------------------------------------------------------------------------------- VTK


def _pieces(name: str) -> str:
    return (
        '<VTKFile type="PUnstructuredGrid" version="0.1"><PUnstructuredGrid GhostLevel="0"><PPointData>'
        '<PDataArray type="Float64" Name="heat"/></PPointData><PPoints><PDataArray type="Float64" Name="Points" '
        f'NumberOfComponents="3"/></PPoints><Piece Source="{name}"/></PUnstructuredGrid></VTKFile>'
    )


for _suffix in ("pvtu", "vtu", "vtm"):  # VTK goes by the type, and not by the suffix

    @case(f"{_suffix}, pieces", "vtu")
    def _(folder: Path, name: str, suffix: str = _suffix) -> None:
        (folder / f"a.{suffix}").write_text(_pieces(name))


@case("vtm, blocks", "vtu")
def _(folder: Path, name: str) -> None:
    text = f'<vtkMultiBlockDataSet><DataSet index="0" file="{name}"/></vtkMultiBlockDataSet>'
    (folder / "a.vtm").write_text(
        f'<VTKFile type="vtkMultiBlockDataSet" version="1.0">{text}</VTKFile>'
    )


@case("vtpc, partitions", "vtu")
def _(folder: Path, name: str) -> None:
    text = f'<Partitions index="0"><DataSet index="0" file="{name}"/></Partitions>'
    kind = "vtkPartitionedDataSetCollection"
    text = f'<VTKFile type="{kind}" version="1.0"><{kind}>{text}</{kind}></VTKFile>'
    (folder / "a.vtpc").write_text(text)


@case("case, model", "geo")
def _(folder: Path, name: str) -> None:
    (folder / "a.case").write_text(f"FORMAT\ntype: ensight gold\n\nGEOMETRY\nmodel: {name}\n")


@case("foam, include", "txt")
def _(folder: Path, name: str) -> None:
    (folder / "system").mkdir()
    head = "FoamFile{version 2.0;format ascii;class dictionary;object controlDict;}"
    (folder / "system" / "controlDict").write_text(
        f'{head}\n#include "{name}"\nstartTime 0;endTime 1;deltaT 1;\n'
    )
    (folder / "a.foam").write_text("")


# -------------------------------------------------------------------------------------------------------- USD

STAGES = {
    "layer": "( subLayers = [@{}@] )",
    "reference": 'def "R" ( references = @{}@</m> ) {{}}',
    "payload": 'def "R" ( payload = @{}@</m> ) {{}}',
    "variant": 'def "R" (\n variants = {{ string v = "x" }}\n prepend variantSets = "v" ) {{\n variantSet "v" = {{\n'
    '  "x" ( references = @{}@</m> ) {{\n }}\n }}\n}}',
    "expression": '( expressionVariables = {{ string A = "{}" }} )\ndef "R" ( references = @`"${{A}}"`@</m> ) {{}}',
}
CLIPPED = """def Mesh "m" ( clips = {{
    dictionary default = {{
        double2[] active = [(0, 0)]
        double2[] times = [(0, 0)]
        asset[] assetPaths = [@{0}@]
        asset manifestAssetPath = @{0}@
        string primPath = "/m"
    }}
}} ) {{
    int[] faceVertexCounts = [3]
    int[] faceVertexIndices = [0, 1, 2]
    point3f[] points
}}"""

for _name, _text in {**STAGES, "clips": CLIPPED}.items():

    @case(f"usda, {_name}", "usda")
    def _(folder: Path, name: str, text: str = _text) -> None:
        pytest.importorskip("pxr", reason="needs the extra usd")
        (folder / "a.usda").write_text("#usda 1.0\n" + text.format(name))


# ------------------------------------------------------------------------------------------------ all others


@case("usda, texture", "png")
def _(folder: Path, name: str) -> None:
    pytest.importorskip("pxr", reason="needs the extra usd")
    from tests.bsm.files.test_usd_references import LOOK, MESH, stage

    (folder / "a.usda").write_text(
        stage(MESH + LOOK % {"above": "", "file": f"asset inputs:file = @{name}@"})
    )


@case("obj, mtllib", "mtl")
def _(folder: Path, name: str) -> None:
    (folder / "a.obj").write_text(f"mtllib {name}\nusemtl {WORD[:6]}\n{TRIANGLE}")


@case("obj, image", "png")
def _(folder: Path, name: str) -> None:
    (folder / "a.mtl").write_text(f"newmtl m\nmap_Kd {name}\n")
    (folder / "a.obj").write_text(f"mtllib a.mtl\nusemtl m\n{TRIANGLE}")


@case("ply, image", "png")
def _(folder: Path, name: str) -> None:
    head = f"ply\nformat ascii 1.0\ncomment TextureFile {name}\nelement vertex 3\n"
    head += "".join(f"property float {axis}\n" for axis in "xyz")
    head += "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    (folder / "a.ply").write_text(head + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")


def _gltf(image: str, buffer: str) -> str:
    views = [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 3}]
    accessors = [
        {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
        {"bufferView": 1, "componentType": 5121, "count": 3, "type": "SCALAR"},
    ]
    primitive = {"attributes": {"POSITION": 0}, "indices": 1, "material": 0}
    tree = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
    }
    tree |= {"meshes": [{"primitives": [primitive]}], "accessors": accessors, "bufferViews": views}
    tree |= {
        "buffers": [{"byteLength": 39, "uri": buffer}],
        "images": [{"uri": image}],
        "textures": [{"source": 0}],
    }
    return json.dumps(
        tree | {"materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]}
    )


@case("gltf, buffer", "bin")
def _(folder: Path, name: str) -> None:
    data = "data:image/png;base64," + base64.b64encode(PNG).decode()
    (folder / "a.gltf").write_text(_gltf(data, name))


@case("gltf, image", "png")
def _(folder: Path, name: str) -> None:
    secret(folder / "own.bin")
    data = (
        (folder / "own.bin")
        .read_bytes()
        .replace(np.float32(NUMBER).tobytes(), np.float32(1).tobytes())
    )
    (folder / "a.gltf").write_text(
        _gltf(name, "data:application/octet-stream;base64," + base64.b64encode(data).decode())
    )
    (folder / "own.bin").unlink()


DAE = (Path(__file__).parent / "every" / "every.dae").read_text()


@case("dae, image", "png")
def _(folder: Path, name: str) -> None:
    pytest.importorskip("collada", reason="needs the extra formats")
    assert "a.image" in DAE
    (folder / "a.dae").write_text(DAE.replace("a.image", name))


@case("dae, entity", "txt")
def _(folder: Path, name: str) -> None:
    pytest.importorskip("collada", reason="needs the extra formats")
    doctype = f'<!DOCTYPE COLLADA [<!ENTITY x SYSTEM "{name}">]>'
    text = DAE.partition("?>")[2].replace("</author>", "&x;</author>", 1)
    (folder / "a.dae").write_text(
        f'<?xml version="1.0"?>{doctype}{text.replace("<contributor>", "<contributor>&x;", 1)}'
    )


@case("xdmf, entity", "txt")
def _(folder: Path, name: str) -> None:
    doctype = f'<!DOCTYPE Xdmf [<!ENTITY x SYSTEM "{name}">]>'
    text = xdmf("").replace('Format="HDF">', 'Format="XML">&x; 1 1 1 1 1 1 1 1 1 1')
    (folder / "a.xdmf").write_text(f'<?xml version="1.0"?>{doctype}{text}')


@case("xdmf, include", "txt")
def _(folder: Path, name: str) -> None:
    include = f'<xi:include xmlns:xi="http://www.w3.org/2001/XInclude" href="{name}" parse="text"/>'
    text = xdmf("").replace('Format="HDF">', f'Format="XML">{include}')
    (folder / "a.xdmf").write_text(text)


@case("3mf, relation", "txt")
def _(folder: Path, name: str) -> None:
    pytest.importorskip("lib3mf", reason="needs the extra formats")
    bsm.save(bsm.TriangleMesh(POINTS, [[0, 1, 5], [0, 5, 4], [1, 2, 6]]), folder / "own.3mf")
    with (
        zipfile.ZipFile(folder / "own.3mf") as own,
        zipfile.ZipFile(folder / "a.3mf", "w") as other,
    ):
        for entry in own.namelist():
            other.writestr(entry, own.read(entry))
        kind = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dtexture"
        relation = f'<Relationship Target="{name}" Id="r9" Type="{kind}"/>'
        space = "http://schemas.openxmlformats.org/package/2006/relationships"
        text = f'<?xml version="1.0"?><Relationships xmlns="{space}">{relation}</Relationships>'
        other.writestr("3D/_rels/3dmodel.model.rels", text)
    (folder / "own.3mf").unlink()


@case("bdf, include", "bdf")
def _(folder: Path, name: str) -> None:
    (folder / "a.bdf").write_text(f"BEGIN BULK\nINCLUDE '{name}'\nENDDATA\n")


@case("inp, include", "inp")
def _(folder: Path, name: str) -> None:
    (folder / "a.inp").write_text(f"*INCLUDE, INPUT={name}\n")


@case("pvd, files", "obj")
def _(folder: Path, name: str) -> None:
    rows = "".join(f'<DataSet timestep="{time}" file="{name}"/>' for time in range(2))
    (folder / "a.pvd").write_text(
        f'<VTKFile type="Collection"><Collection>{rows}</Collection></VTKFile>'
    )


@case("series, files", "obj")
def _(folder: Path, name: str) -> None:
    (folder / "a.series").write_text(
        json.dumps({"files": [{"name": name, "time": time} for time in range(2)]})
    )


# -------------------------------------------------------------------------------------------------- the search


def said_of(path: Path, *, isolated: bool | None) -> tuple[str, bool]:
    """Return all words of notes, metadata and errors for a file, and whether the number is in its stream."""
    try:
        if path.suffix in (".pvd", ".series"):
            frames = sequence_in(path, isolated=isolated)
            assert frames is not None
            words, meshes = (
                f"{frames.notes}{frames.metadata}",
                [bsm.TriangleMesh(next(iter(frames.frames)), frames.faces)],
            )
        else:
            found = bsm.read_mesh(path, isolated=isolated)
            words, meshes = f"{found.notes}{found.dropped}{found.mesh.metadata}", [found.mesh]
        decoded = bsm.decode(bsm.encode(meshes[0], preset="lossless"))
    except bsm.BsmError as error:
        return str(error), False
    tables = [decoded.positions, *(attribute.values for attribute in decoded.attributes)]
    return words + str(dict(decoded.metadata)), any(
        bool((np.abs(table - NUMBER) < 1).any()) for table in tables
    )


def outcome(path: Path, *, isolated: bool | None) -> bool:
    words, has_number = said_of(path, isolated=isolated)
    return has_number or WORD in words or f"{NUMBER:.0f}" in words


def written(folder: Path, name: str, means: str) -> Path:
    """Write a file of a case into a folder that is new, naming its secret in some way; return it."""
    suffix, make = CASES[name]
    place = {"beside": folder / "other", "own": folder / "in"}.get(
        means, folder
    ) / f"secret.{suffix}"
    (folder / "in").mkdir()
    ways = {
        "beside": f"../other/{place.name}",
        "own": place.name,
        "absolute": str(place),
        "link": f"link.{suffix}",
    }
    make(folder / "in", ways.get(means, f"../{place.name}"))
    secret(place)
    if means == "link":
        (folder / "in" / f"link.{suffix}").symlink_to(place)
    return next(
        path for path in (folder / "in").iterdir() if path.stem == "a" and path.suffix != ".mtl"
    )


@pytest.mark.parametrize("means", ["above", "beside", "absolute", "link"])
@pytest.mark.parametrize("wall", ["usual", "isolated", "without a wall"])
@pytest.mark.parametrize("name", CASES)
def test_nothing_of_other_folders_is_read(name, wall, means, tmp_path, monkeypatch):
    if wall == "without a wall":
        monkeypatch.setattr(landlock, "lack", lambda: "a kernel with Landlock")
    elif landlock.lack() is not None:
        pytest.skip(f"no wall here: it needs {landlock.lack()}")
    isolated = {"usual": None, "isolated": True, "without a wall": False}[wall]
    assert not outcome(written(tmp_path, name, means), isolated=isolated)


UNREAD = ("raw", "exo", "foam", "entity", "include", "relation", "expression", "vtm, pieces")
"""Means by which not even files of the own folder are read."""


@pytest.mark.parametrize(
    "name", [name for name in CASES if not any(word in name for word in UNREAD)]
)
def test_files_of_the_own_folder_are_read_by_the_same_means(name, tmp_path):
    assert outcome(written(tmp_path, name, "own"), isolated=None)


# ------------------------------------------------------------------------------------------------------- links


@pytest.mark.parametrize("words", [(), ("--untrusted",)])
def test_links_to_other_folders_are_not_followed_in_folders(words, tmp_path):
    if words and landlock.lack() is not None:
        pytest.skip(f"no wall here: it needs {landlock.lack()}")
    secret(tmp_path / "secret.obj")
    (tmp_path / "passwords").write_text(f"{WORD}\n")
    (tmp_path / "in" / "below").mkdir(parents=True)
    (tmp_path / "in" / "own.obj").write_text(TRIANGLE)
    for name, target in (("a", "secret.obj"), ("below/b", "passwords")):
        (tmp_path / "in" / f"{name}.obj").symlink_to(tmp_path / target)
    (tmp_path / "in" / "c.obj").symlink_to("own.obj")
    done = bsm_of("encode", "-r", tmp_path / "in", "-o", tmp_path / "out", *words, text=True)
    assert done.returncode != 0 and WORD not in done.stderr + done.stdout
    assert done.stderr.count("this is a link to another folder") == 2
    assert sorted(path.name for path in (tmp_path / "out").rglob("*.bsm")) == ["c.bsm", "own.bsm"]


def test_frames_of_strangers_are_no_links_to_other_folders(tmp_path):
    if landlock.lack() is not None:
        pytest.skip(f"no wall here: it needs {landlock.lack()}")
    secret(tmp_path / "secret.obj")
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "0.obj").write_text(TRIANGLE)
    (tmp_path / "in" / "1.obj").symlink_to(tmp_path / "secret.obj")
    with pytest.raises(bsm.FormatError, match="link to another folder"):
        sequence_in(tmp_path / "in", isolated=True)
    for words in ((), ("--frames", "0:2")):
        done = bsm_of(
            "encode", tmp_path / "in", "-o", tmp_path / "a.bsm", "--untrusted", *words, text=True
        )
        assert done.returncode != 0 and "link to another folder" in done.stderr
    assert sequence_in(tmp_path / "in").count == 2


def test_a_list_of_strangers_is_parsed_in_their_process(tmp_path, monkeypatch):
    if landlock.lack() is not None:
        pytest.skip(f"no wall here: it needs {landlock.lack()}")
    path = written(tmp_path, "pvd, files", "own")
    monkeypatch.setattr("bsm.files.motion.folder.listed", lambda *given: 1 // 0)
    assert sequence_in(path, isolated=True).count == 2


@pytest.mark.skipif(os.name != "posix" or sys.platform == "darwin", reason="names are text here")
def test_a_name_that_is_not_utf8_is_stored_as_text(tmp_path):
    (tmp_path / "in").mkdir()
    Path(os.fsdecode(os.fsencode(tmp_path / "in") + b"/\xff\xfe.obj")).write_text(TRIANGLE)
    done = bsm_of("encode", "-r", tmp_path / "in", "-o", tmp_path / "out", text=True)
    assert done.returncode == 0, done.stderr
    (stream,) = (tmp_path / "out").iterdir()
    assert bsm.decode(stream.read_bytes()).metadata["source_name"] == "\ufffd\ufffd.obj"


@pytest.mark.parametrize("kind", ["xdmf", "vtkhdf"])
def test_errors_of_hdf5_are_those_of_h5py(kind, tmp_path):
    (tmp_path / "own.h5").write_bytes(b"\x89HDF\r\n\x1a\n" + bytes(100))
    (tmp_path / "a.xdmf").write_text(xdmf("own.h5:/heat"))
    if kind == "vtkhdf":
        (tmp_path / "own.h5").replace(tmp_path / "a.vtkhdf")
    with pytest.raises(bsm.FormatError, match="h5py cannot read"):
        bsm.read_mesh(tmp_path / f"a.{kind}")
