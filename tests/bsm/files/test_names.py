"""Names and sets: a format gets its own names back, and nothing that a library counts vanishes."""

import csv
import importlib
import locale
import warnings
from pathlib import Path

import numpy as np
import pytest

import bsm
from bsm import read_mesh
from bsm.cli import main
from bsm.files import unread
from bsm.files.table import FORMATS
from tests.bsm.files.test_file_attributes import attribute
from tests.motion import sequence_in
from tests.shapes import file_of

SETTINGS = Path(unread.__file__).with_name("settings.csv")


def ply(path, vertex, rows, face="", of_faces=("", ""), comments=()):
    """Write two triangles whose vertices, of which each has its own row, have some properties."""
    head = [
        "ply",
        "format ascii 1.0",
        *comments,
        "element vertex 6",
        *(f"property float {axis}" for axis in "xyz"),
    ]
    head += [f"property {one}" for one in vertex.split(", ") if one]
    head += ["element face 2", "property list uchar int vertex_indices"]
    head += [f"property {one}" for one in face.split(", ") if one]
    points = ["0 0 0", "1 0 0", "1 1 .2", "0 0 0", "1 1 .2", "0 1 0"]
    lines = [f"{point} {row}" for point, row in zip(points, rows, strict=True)]
    lines += [
        f"3 {corners} {row}" for corners, row in zip(("0 1 2", "3 4 5"), of_faces, strict=True)
    ]
    path.write_text("\n".join([*head, "end_header", *lines, ""]))
    return path


def properties(data):
    """The properties of a PLY by its header, lists in brackets."""
    found = {}
    for line in data.split(b"end_header")[0].decode().splitlines():
        match line.split():
            case ["element", name, _]:
                found[name] = now = []
            case ["property", "list", _, _, name]:
                now.append(f"[{name}]")
            case ["property", _, name]:
                now.append(name)
    return found["vertex"][3:], found["face"][1:]


def there_and_back(path):
    mesh = read_mesh(path).mesh
    return properties(file_of(bsm.decode(bsm.encode(mesh, preset="lossless")), "ply"))


@pytest.mark.parametrize(
    ("vertex", "numbers"),
    [
        ("uchar red, uchar green, uchar blue", 3),
        ("int red, int green, int blue", 3),
        ("ushort red, ushort green, ushort blue, ushort alpha", 4),
        ("float red, float green, float blue", 3),
        ("uchar r, uchar g, uchar b", 3),
        ("uchar diffuse_red, uchar diffuse_green, uchar diffuse_blue", 3),
        ("float s, float t", 2),
        ("float u, float v", 2),
        ("float texture_u, float texture_v", 2),
        ("float nx, float ny, float nz", 3),
        ("float quality, int label", 2),
    ],
)
def test_properties_of_vertices_come_back_under_their_names(vertex, numbers, tmp_path):
    rows = [" ".join(str(40 * row + place) for place in range(numbers)) for row in range(6)]
    names = [one.split()[1] for one in vertex.split(", ")]
    assert there_and_back(ply(tmp_path / "a.ply", vertex, rows)) == (names, [])


def test_colors_that_are_floats_to_255_keep_their_names_and_numbers(tmp_path):
    rows = [f"{row}.5 255 12.25" for row in range(6)]
    path = ply(tmp_path / "a.ply", "float red, float green, float blue", rows)
    assert there_and_back(path) == (["red", "green", "blue"], [])


@pytest.mark.parametrize(
    "face", ["int texnumber", "int material_index", "int material", "float quality", "int label"]
)
def test_properties_of_faces_come_back_under_their_names(face, tmp_path):
    path = ply(tmp_path / "a.ply", "float quality", range(6), face, ("0", "1"))
    assert there_and_back(path) == (["quality"], [face.split()[1]])


def test_wedges_stay_lists_where_a_file_has_them(tmp_path):
    places = ("6 0 0 1 0 1 1 0", "6 .5 0 1 0 1 1 1")
    for images in ((), ("comment TextureFile a.png", "comment TextureFile b.png")):
        path = ply(
            tmp_path / "a.ply",
            "",
            [""] * 6,
            "list uchar float texcoord, int texnumber",
            places,
            images,
        )
        assert there_and_back(path) == ([], ["texnumber", "[texcoord]"])


def test_meshlab_and_openmvs_find_the_image_of_each_face(tmp_path):
    trimesh = pytest.importorskip("trimesh")
    (tmp_path / "a.mtl").write_text(
        "newmtl plain\nKd 1 0 0\nnewmtl one\nmap_Kd 1.png\nnewmtl two\nmap_Kd 2.png\n"
    )
    faces = "usemtl plain\nf 1/1 2/2 3/3\nusemtl two\nf 1/1 3/3 4/4\nusemtl one\nf 2/2 4/4 3/3\n"
    points = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    (tmp_path / "a.obj").write_text(f"mtllib a.mtl\n{points}{faces}")
    mesh = read_mesh(tmp_path / "a.obj").mesh
    bsm.save(mesh, tmp_path / "b.ply")
    theirs = trimesh.load(tmp_path / "b.ply", process=False).metadata["_ply_raw"]
    header = (tmp_path / "b.ply").read_bytes().split(b"end_header")[0].decode().splitlines()
    images = [line.split()[-1] for line in header if "TextureFile" in line]
    rows = theirs["face"]["data"]
    shown = [
        images[number] if number >= 0 else "" for number in rows["texnumber"].reshape(-1).tolist()
    ]
    assert shown == ["", "2.png", "1.png"]
    # The numbers of images follow from the materials, and are not read as another attribute.
    assert [one.name for one in read_mesh(tmp_path / "b.ply").mesh.attributes] == [
        "material",
        "texcoord",
    ]


# ------------------------------------------------------------------------------------------------------ other libraries


def save_vtk(path, kind, **arrays):
    """Write a square of two triangles with VTK; arrays are of cells, and names of components follow a bar."""
    core, data = (
        pytest.importorskip(f"vtkmodules.vtkCommon{name}") for name in ("Core", "DataModel")
    )
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter, vtkXMLUnstructuredGridWriter

    points = core.vtkPoints()
    for point in ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)):
        points.InsertNextPoint(point)
    grid = data.vtkUnstructuredGrid() if kind == "vtu" else data.vtkPolyData()
    grid.SetPoints(points)
    grid.Allocate(2)
    for corners in ((0, 1, 2), (0, 2, 3)):
        grid.InsertNextCell(5, 3, corners)
    for name, (values, *components) in arrays.items():
        array = numpy_to_vtk(np.asarray(values), deep=True)
        array.SetName(name)
        for place, component in enumerate(components):
            array.SetComponentName(place, component)
        grid.GetCellData().AddArray(array)
    writer = vtkXMLUnstructuredGridWriter() if kind == "vtu" else vtkXMLPolyDataWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(grid)
    writer.Write()
    return path


@pytest.mark.parametrize("kind", ["vtu", "vtp"])
def test_components_come_back_to_vtk_under_their_names(kind, tmp_path):
    stress = [[1.0, 2, 3, 4, 5, 6], [7, 8, 9, 10, 11, 12]], "S11", "S12", "S13", "S22", "S23", "S33"
    path = save_vtk(tmp_path / f"a.{kind}", kind, S=stress, U=([[1.0, 2, 3]] * 2, "UX", "UY", "UZ"))
    mesh = read_mesh(path).mesh
    assert attribute(mesh, "S.S12").values[:, 0].tolist() == [2, 8]
    bsm.save(bsm.decode(bsm.encode(mesh, preset="lossless")), tmp_path / "b.vtp")
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(tmp_path / "b.vtp"))
    reader.Update()
    cells = reader.GetOutput().GetCellData()
    for name, (values, *components) in {
        "S": stress,
        "U": ([[1.0, 2, 3]] * 2, "UX", "UY", "UZ"),
    }.items():
        array = cells.GetArray(name)
        assert [array.GetComponentName(place) for place in range(len(components))] == components
        rows = [array.GetTuple(row) for row in range(2)]
        assert sorted(rows) == sorted(map(tuple, values))


def test_a_tensor_of_xdmf_has_the_order_of_xdmf(tmp_path):
    pytest.importorskip("lxml")
    items = {"Topology": ("1 3", "0 1 2"), "Geometry": ("3 3", "0 0 0 1 0 0 0 1 0")}
    topology, geometry = (
        f'<DataItem Dimensions="{size}">{text}</DataItem>' for size, text in items.values()
    )
    tensor = '<DataItem Dimensions="1 6">1 2 3 4 5 6</DataItem>'  # xx xy xz yy yz zz
    (tmp_path / "a.xdmf").write_text(
        '<Xdmf Version="3.0"><Domain><Grid>'
        f'<Topology TopologyType="Triangle" NumberOfElements="1">{topology}</Topology>'
        f'<Geometry GeometryType="XYZ">{geometry}</Geometry>'
        f'<Attribute Name="S" AttributeType="Tensor6" Center="Cell">{tensor}</Attribute></Grid></Domain></Xdmf>'
    )
    mesh = read_mesh(tmp_path / "a.xdmf").mesh
    found = {
        name: float(attribute(mesh, f"S.{name}").values[0, 0])
        for name in ("xx", "yy", "zz", "xy", "yz", "xz")
    }
    assert found == {"xx": 1, "xy": 2, "xz": 3, "yy": 4, "yz": 5, "zz": 6}


@pytest.mark.parametrize("kind", ["vtu", "vtp"])
def test_hidden_cells_are_left_out_and_named(kind, tmp_path):
    path = save_vtk(tmp_path / f"a.{kind}", kind, vtkGhostType=(np.array([0, 32], np.uint8),))
    found = read_mesh(path)
    assert len(found.mesh.faces) == 1 and not found.mesh.attributes
    assert found.dropped == ("hidden cells (1)",)


def test_strips_of_a_vtp_are_triangles(tmp_path):
    core, data = (
        pytest.importorskip(f"vtkmodules.vtkCommon{name}") for name in ("Core", "DataModel")
    )
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

    points, strips, polygons = core.vtkPoints(), data.vtkCellArray(), data.vtkCellArray()
    for place in range(7):
        points.InsertNextPoint(place / 2, place % 2, 0)
    strips.InsertNextCell(5, (0, 1, 2, 3, 4))
    polygons.InsertNextCell(3, (4, 5, 6))
    surface, heat = data.vtkPolyData(), core.vtkFloatArray()
    heat.SetName("heat")
    for value in (1, 2):  # of the polygon, then of the strip
        heat.InsertNextValue(value)
    surface.SetPoints(points)
    surface.SetPolys(polygons)
    surface.SetStrips(strips)
    surface.GetCellData().AddArray(heat)
    writer = vtkXMLPolyDataWriter()
    writer.SetFileName(str(tmp_path / "a.vtp"))
    writer.SetInputData(surface)
    writer.Write()
    mesh = read_mesh(tmp_path / "a.vtp").mesh
    assert mesh.faces.tolist() == [[4, 5, 6], [0, 1, 2], [1, 3, 2], [2, 3, 4]]
    assert attribute(mesh, "heat").values[:, 0].tolist() == [1, 2, 2, 2]


def exodus(path, steps=1):
    """Write two hexahedra with sets, a variable of the model, and displacements, as Exodus has them."""
    netcdf = pytest.importorskip("scipy.io")
    pytest.importorskip("vtkmodules.vtkIOExodus")
    grid = [(x, y, z) for x in (0, 1, 2) for y in (0, 1) for z in (0, 1)]
    file = netcdf.netcdf_file(str(path), "w")
    for name, value in {"api_version": 5.14, "version": 5.14}.items():
        setattr(file, name, np.float32(value))
    file.floating_point_word_size, file.file_size, file.title = np.int32(8), np.int32(1), b"bar"
    sizes = {
        "time_step": None,
        "len_string": 33,
        "len_line": 81,
        "four": 4,
        "len_name": 33,
        "num_dim": 3,
        "num_nodes": 12,
    }
    sizes |= {
        "num_elem": 2,
        "num_el_blk": 1,
        "num_el_in_blk1": 2,
        "num_nod_per_el1": 8,
        "num_side_sets": 2,
    }
    sizes |= {
        "num_side_ss1": 1,
        "num_side_ss2": 2,
        "num_node_sets": 1,
        "num_nod_ns1": 4,
        "num_nod_var": 4,
        "num_glo_var": 1,
    }
    for name, size in sizes.items():
        file.createDimension(name, size)

    def put(name, kind, dimensions, values):
        variable = file.createVariable(name, kind, dimensions)
        variable[:] = np.array(values)
        return variable

    def words(name, dimension, texts):
        variable = file.createVariable(name, "c", (dimension, "len_name"))
        variable[:] = np.full((len(texts), 33), b"\0")
        for row, text in enumerate(texts):
            variable[row, : len(text)] = np.array([*text], "c")

    for axis, values in zip("xyz", np.array(grid, float).T):
        put(f"coord{axis}", "d", ("num_nodes",), values)
    cells = [[1, 2, 4, 3, 5, 6, 8, 7], [5, 6, 8, 7, 9, 10, 12, 11]]
    put("connect1", "i", ("num_el_in_blk1", "num_nod_per_el1"), cells).elem_type = b"HEX8"
    for kind, count in (("eb", 1), ("ss", 2), ("ns", 1)):
        dimension = {"eb": "num_el_blk", "ss": "num_side_sets", "ns": "num_node_sets"}[kind]
        put(f"{kind}_status", "i", (dimension,), [1] * count)
        put(f"{kind}_prop1", "i", (dimension,), [*range(1, count + 1)]).name = b"ID"
    words("eb_names", "num_el_blk", ["bar"])
    words("ss_names", "num_side_sets", ["inlet", "inside"])
    words("ns_names", "num_node_sets", ["fixed"])
    for number, (elements, sides) in enumerate([([1], [5]), ([1, 2], [6, 5])], 1):
        put(f"elem_ss{number}", "i", (f"num_side_ss{number}",), elements)
        put(f"side_ss{number}", "i", (f"num_side_ss{number}",), sides)
    put("node_ns1", "i", ("num_nod_ns1",), [1, 2, 3, 4])
    words("name_nod_var", "num_nod_var", ["disp_x", "disp_y", "disp_z", "temp"])
    words("name_glo_var", "num_glo_var", ["energy"])
    file.createVariable("time_whole", "d", ("time_step",))[:steps] = np.arange(steps, dtype=float)
    for number in range(1, 5):
        values = np.zeros((steps, 12)) + (
            10.0 * np.arange(steps)[:, None] + 5 if number == 1 else 0
        )
        file.createVariable(f"vals_nod_var{number}", "d", ("time_step", "num_nodes"))[:steps] = (
            values
        )
    file.createVariable("vals_glo_var", "d", ("time_step", "num_glo_var"))[:steps] = (
        7.0 + np.arange(steps)[:, None]
    )
    file.close()
    return path


def test_sets_of_exodus_are_marks_and_displacements_are_values(tmp_path):
    found = read_mesh(exodus(tmp_path / "a.exo"))
    mesh = found.mesh
    assert np.ptp(mesh.positions, axis=0).tolist() == [2, 1, 1] and mesh.positions[:, 0].min() == 0
    assert set(attribute(mesh, "disp_").values[:, 0].tolist()) == {5}
    inlet = attribute(mesh, "inlet").values[:, 0] > 0
    # Side 5 of the first hexahedron: its nodes 1, 4, 3, 2, all at x = 0.
    assert inlet.sum() == 2 and (mesh.positions[mesh.faces[inlet]][..., 0] == 0).all()
    fixed = attribute(mesh, "fixed").values[:, 0] > 0
    assert fixed.sum() == 4 and (mesh.positions[fixed][:, 0] == 0).all()
    assert "faces of the side set inside inside of volumes (2)" in found.dropped
    assert mesh.metadata["energy"] == 7


def test_frames_of_exodus_move_and_keep_the_numbers_of_all_steps(tmp_path):
    frames = sequence_in(str(exodus(tmp_path / "a.exo", 3)))
    moved = [mesh.positions[:, 0].min() for mesh in frames.meshes]
    assert moved == [5, 15, 25] and frames.metadata["energy"] == "7.0 8.0 9.0"


def test_each_setting_of_the_readers_of_vtk_is_decided():
    vtkAlgorithm = pytest.importorskip("vtkmodules.vtkCommonExecutionModel").vtkAlgorithm

    from bsm.files.formats.with_vtk import _READERS

    rows = [*csv.DictReader(SETTINGS.read_text().splitlines())]
    decided = {(row["reader"], setting) for row in rows for setting in row["settings"].split()}
    assert all(row["reason"] for row in rows)
    own = {
        kind: row.modules[1]
        for kind, row in FORMATS.items()
        if row.modules[1:] and "vtkmodules" in row.modules[1]
    }
    names = {
        _READERS.get(kind) or _READERS[module.partition(".")[2]]: module
        for kind, module in own.items()
    }
    every = set()
    for name, module in names.items():
        reader = getattr(importlib.import_module(module), name)
        texts = {word.removeprefix("Set") for word in dir(reader) if word.startswith("Set")} - {
            w[3:] for w in dir(vtkAlgorithm)
        }
        made = reader()
        for word in texts:
            getter = getattr(made, f"Get{word}", None)
            if getter is not None and "file" not in word.lower():
                try:
                    with warnings.catch_warnings():
                        warnings.simplefilter("ignore", DeprecationWarning)
                        value = getter()
                except TypeError:  # it needs arguments, so it is not a setting
                    continue
                every |= {(name, word)} if isinstance(value, int | float) else set()
    assert not every - decided, sorted(every - decided)


# ------------------------------------------------------------------------------------------------------------------ USD

SCENE = """#usda 1.0
(
    metersPerUnit = 1
    upAxis = "Y"
)
class Xform "C" {
  def Mesh "M" (prepend apiSchemas = ["MaterialBindingAPI"]) {
    point3f[] points = [(0,0,0),(1,0,0),(1,1,0)]
    int[] faceVertexCounts = [3]
    int[] faceVertexIndices = [0,1,2]
    uniform token subdivisionScheme = "none"
  }
}
def Xform "A" (instanceable = true
 prepend references = </C>
 prepend apiSchemas = ["MaterialBindingAPI"]) {
  color3f[] primvars:displayColor = [(1,0,0)] (interpolation = "constant")
  rel material:binding = </Red>
}
def Xform "B" (instanceable = true
 prepend references = </C>
 prepend apiSchemas = ["MaterialBindingAPI"]) {
  color3f[] primvars:displayColor = [(0,0,1)] (interpolation = "constant")
  rel material:binding = </Blue>
  double3 xformOp:translate = (3,0,0)
  uniform token[] xformOpOrder = ["xformOp:translate"]
}
def Material "Red" {
  token outputs:surface
}
def Material "Blue" {
  token outputs:surface
}
def PointInstancer "I" {
  rel prototypes = [</I/P>]
  int[] protoIndices = [0,0,0]
  point3f[] positions = [(6,0,0),(8,0,0),(10,0,0)]
  color3f[] primvars:displayColor = [(1,0,0),(0,1,0)] (interpolation = "vertex")
  int[] primvars:displayColor:indices = [0,1,0]
  float[] primvars:heat = [1,2,3] (interpolation = "vertex")
  def Mesh "P" {
    point3f[] points = [(0,0,0),(1,0,0),(1,1,0)]
    int[] faceVertexCounts = [3]
    int[] faceVertexIndices = [0,1,2]
    uniform token subdivisionScheme = "none"
  }
}
"""


def test_instances_have_their_own_colors_materials_and_values(tmp_path):
    pytest.importorskip("pxr.Usd")
    (tmp_path / "a.usda").write_text(SCENE)
    mesh = read_mesh(tmp_path / "a.usda").mesh
    assert mesh.positions[mesh.faces[:, 0], 0].tolist() == [0, 3, 6, 8, 10]
    colors = attribute(mesh, "color").values[mesh.faces[:, 0], :3].tolist()
    red, green, blue = [255, 0, 0], [0, 255, 0], [0, 0, 255]
    assert colors == [red, blue, red, green, red]
    names = [
        mesh.metadata.get(f"material.{number}.name")
        for number in attribute(mesh, "material").values[:2, 0]
    ]
    assert names == ["Red", "Blue"]
    assert attribute(mesh, "heat").values[:, 0].tolist() == [0, 0, 1, 2, 3]


def scene_of_collada(path):
    """Three nodes of one geometry, whose material each of them binds."""

    def node(place, material):
        bound = f'<instance_material symbol="M" target="#{material}"/>'
        bound = f"<bind_material><technique_common>{bound}</technique_common></bind_material>"
        instance = f'<instance_geometry url="#g">{bound}</instance_geometry>'
        return f"<node><translate>{place} 0 0</translate><scale>2 2 2</scale>{instance}</node>"

    def effect(name, color):
        shading = f"<lambert><diffuse><color>{color} 1</color></diffuse></lambert>"
        return f'<effect id="e{name}"><profile_COMMON><technique>{shading}</technique></profile_COMMON></effect>'

    names = ("Red", "Blue")
    materials = "".join(
        f'<material id="{n}" name="{n}"><instance_effect url="#e{n}"/></material>' for n in names
    )
    axes = "".join(f'<param name="{axis}" type="float"/>' for axis in "XYZ")
    accessor = f'<accessor source="#a" count="3" stride="3">{axes}</accessor>'
    path.write_text(f"""<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
        <asset><up_axis>Y_UP</up_axis></asset>
        <library_effects>{effect("Red", "1 0 0")}{effect("Blue", "0 0 1")}</library_effects>
        <library_materials>{materials}</library_materials>
        <library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="9">0 0 0 1 0 0 0 1 0
        </float_array><technique_common>{accessor}</technique_common></source>
        <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
        <triangles count="1" material="M"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
        </mesh></geometry></library_geometries>
        <library_visual_scenes><visual_scene id="s">{node(0, "Red")}{node(3, "Blue")}{node(6, "Red")}</visual_scene>
        </library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>""")


def scene_of_3mf(path):
    """Two objects of one material each, the first of them placed twice, as lib3mf writes them."""
    lib3mf = pytest.importorskip("lib3mf")
    wrapper = lib3mf.get_wrapper()
    model = wrapper.CreateModel()
    materials = model.AddBaseMaterialGroup()
    red = materials.AddMaterial("Red", wrapper.RGBAToColor(255, 0, 0, 255))
    blue = materials.AddMaterial("Blue", wrapper.RGBAToColor(0, 0, 255, 255))
    points = [lib3mf.Position(point) for point in ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1))]
    triangles = [
        lib3mf.Triangle(corners) for corners in ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2))
    ]
    objects = []
    for material in (red, blue):
        shape = model.AddMeshObject()
        shape.SetGeometry(points, triangles)
        shape.SetObjectLevelProperty(materials.GetResourceID(), material)
        objects.append(shape)
    for shape, place in ((objects[0], 0), (objects[1], 3), (objects[0], 6)):
        doubled = ((2, 0, 0), (0, 2, 0), (0, 0, 2), (place, 0, 0))
        rows = [(lib3mf.ctypes.c_float * 3)(*row) for row in doubled]
        model.AddBuildItem(shape, lib3mf.Transform((lib3mf.ctypes.c_float * 3 * 4)(*rows)))
    own_locale = locale.setlocale(locale.LC_ALL)
    model.QueryWriter("3mf").WriteToFile(str(path))
    # lib3mf leaves that of C, in which files are read as ASCII.
    locale.setlocale(locale.LC_ALL, own_locale)


def scene_of_gltf(path):
    """Two meshes of the same accessors and one material each, the first of them placed twice."""
    pygltflib = pytest.importorskip("pygltflib")
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
    document = pygltflib.GLTF2(scene=0, scenes=[pygltflib.Scene(nodes=[0, 1, 2])])
    for name, color in (("Red", [1, 0, 0, 1]), ("Blue", [0, 0, 1, 1])):
        surface = pygltflib.PbrMetallicRoughness(baseColorFactor=color)
        part = pygltflib.Primitive(
            attributes=pygltflib.Attributes(POSITION=0), material=len(document.materials)
        )
        document.materials.append(pygltflib.Material(name=name, pbrMetallicRoughness=surface))
        document.meshes.append(pygltflib.Mesh(primitives=[part]))
    for mesh, place in ((0, 0), (1, 3), (0, 6)):
        document.nodes.append(pygltflib.Node(mesh=mesh, translation=[place, 0, 0], scale=[2, 2, 2]))
    bounds = {"min": [0, 0, 0], "max": [1, 1, 0]}
    document.accessors = [
        pygltflib.Accessor(bufferView=0, componentType=5126, count=3, type="VEC3", **bounds)
    ]
    document.bufferViews = [pygltflib.BufferView(buffer=0, byteLength=points.nbytes)]
    document.buffers = [pygltflib.Buffer(byteLength=points.nbytes)]
    document.set_binary_blob(points.tobytes())
    document.save_binary(str(path))


@pytest.mark.parametrize(
    ("suffix", "write", "color"),
    [
        ("dae", scene_of_collada, "Kd"),
        ("3mf", scene_of_3mf, "Kd"),
        ("glb", scene_of_gltf, "baseColorFactor"),
    ],
)
def test_placed_parts_keep_their_place_and_material(suffix, write, color, tmp_path):
    write(tmp_path / f"a.{suffix}")
    mesh = read_mesh(tmp_path / f"a.{suffix}").mesh
    parts = attribute(mesh, "part").values[:, 0]
    spans = []
    materials = []
    for part in range(3):
        corners = mesh.positions[mesh.faces[parts == part]].reshape(-1, 3)
        spans.append((corners[:, 0].min(), corners[:, 0].max()))
        materials.append(set(attribute(mesh, "material").values[parts == part, 0]))
    assert spans == [(0, 2), (3, 5), (6, 8)]
    assert materials == [{0}, {1}, {0}]
    for number, expected in ((0, ("Red", "1 0 0")), (1, ("Blue", "0 0 1"))):
        assert mesh.metadata[f"material.{number}.name"] == expected[0]
        assert mesh.metadata[f"material.{number}.{color}"][:5] == expected[1]


def test_a_surface_of_subdivision_is_said_to_be_one(tmp_path):
    pytest.importorskip("pxr.Usd")
    (tmp_path / "a.usda").write_text(SCENE.replace('uniform token subdivisionScheme = "none"', ""))
    assert "subdivisionScheme of Mesh" in read_mesh(tmp_path / "a.usda").dropped


# ---------------------------------------------------------------------------------------------------------- no values


def test_values_that_are_none_are_marked_and_lossless_refuses_them(tmp_path, capsys):
    path = ply(tmp_path / "a.ply", "float distance", ["1", "2", "nan", "3", "nan", "5"])
    mesh = read_mesh(path).mesh
    assert attribute(mesh, "distance").values[:, 0].tolist() == [1, 2, 2.5, 3, 2.5, 5]
    assert attribute(mesh, "distance.none").values[:, 0].tolist() == [0, 0, 1, 0, 1, 0]
    assert main(["encode", str(path), "--preset", "lossless", "-o", str(tmp_path / "a.bsm")]) == 11
    assert "distance" in capsys.readouterr().err
    bsm.save(bsm.decode(bsm.encode(mesh, preset="grid14")), tmp_path / "b.ply")
    raw = (
        pytest.importorskip("trimesh").load(tmp_path / "b.ply", process=False).metadata["_ply_raw"]
    )
    assert [*raw["vertex"]["properties"]] == ["x", "y", "z", "distance"]
    corners = np.array([row[1] for row in raw["face"]["data"]["vertex_indices"].tolist()])
    assert np.isnan(raw["vertex"]["data"]["distance"])[corners].sum() == 2


def test_colors_of_which_some_are_none_are_colors(tmp_path):
    path = ply(
        tmp_path / "a.ply", "float red, float green, float blue", ["nan nan nan", *["1 .5 0"] * 5]
    )
    assert attribute(read_mesh(path).mesh, "color").semantic == "color"


def test_a_material_of_two_libraries_and_images_in_tiles_are_named(tmp_path, capsys):
    for name, color in (("a", "1 0 0"), ("b", "0 1 0")):
        (tmp_path / f"{name}.mtl").write_text(f"newmtl A\nKd {color}\n")
    body = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl A\nf 1 2 3\n"
    (tmp_path / "a.obj").write_text(f"mtllib a.mtl\n{body}mtllib b.mtl\n")
    assert read_mesh(tmp_path / "a.obj").dropped == ("the material A of a later library",)
    (tmp_path / "a.mtl").write_text("newmtl A\nmap_Kd skin.<UDIM>.png\n")
    (tmp_path / "b.obj").write_text(f"mtllib a.mtl\n{body}")
    assert (
        main(
            [
                "encode",
                str(tmp_path / "b.obj"),
                "--preset",
                "lossless",
                "-o",
                str(tmp_path / "b.bsm"),
            ]
        )
        == 11
    )
    assert "skin.<UDIM>.png" in capsys.readouterr().err


def test_compare_names_the_properties_of_one_side(tmp_path, capsys):
    path = ply(tmp_path / "a.ply", "float heat", range(6), "int texnumber", ("0", "1"))
    bsm.save(read_mesh(path).mesh, tmp_path / "b.obj")
    assert main(["compare", str(path), str(tmp_path / "b.obj")]) == 0
    assert f"only in {path}: heat" in capsys.readouterr().out


def test_frames_of_split_vertices_keep_their_promise(tmp_path):
    colors = [*["255 0 0"] * 3, *["0 0 255"] * 3]
    for number in range(3):
        path = ply(tmp_path / f"f{number}.ply", "uchar red, uchar green, uchar blue", colors)
        path.write_text(path.read_text().replace("1 1 .2 ", f"1 1 .{2 + number} "))
    assert main(["encode", str(tmp_path), "-q", "-o", str(tmp_path / "a.bsm")]) == 0
    assert (
        main(
            [
                "decode",
                str(tmp_path / "a.bsm"),
                "-q",
                "--format",
                "ply",
                "-o",
                f"{tmp_path / 'out'}/",
            ]
        )
        == 0
    )
    for frame in (tmp_path / "out").iterdir():
        assert properties(frame.read_bytes()) == (["red", "green", "blue"], [])
