"""VTP: every way in which VTK writes one, what VTK reads of ours, and what is refused."""

import base64
import itertools
import struct

import numpy as np
import pytest

import bsm
from bsm import read_mesh
from tests.bsm.test_libraries import painted
from tests.shapes import file_of, torus
from tests.streams import memory_below

WAYS = list(
    itertools.product(
        ("Ascii", "Binary", "Appended"), ("None", "ZLib"), (0, 1), ("32", "64"), ("Little", "Big")
    )
)


def equal(first, second):
    assert np.allclose(first.positions, second.positions, atol=1e-6) and np.array_equal(
        first.faces, second.faces
    )
    assert [a.name for a in first.attributes] == [a.name for a in second.attributes]
    for ours, theirs in zip(first.attributes, second.attributes, strict=True):
        assert (ours.domain, ours.semantic) == (theirs.domain, theirs.semantic)
        assert np.allclose(ours.values, theirs.values, atol=1e-6)


def test_vtk_sees_what_is_written(tmp_path):
    pyvista = pytest.importorskip("pyvista")
    assert bsm.save(painted(), tmp_path / "a.vtp") == (
        "map_Kd of material skin (for programs other than bsm)",
    )
    seen = pyvista.read(tmp_path / "a.vtp")
    assert (
        seen.point_data.active_scalars_name == "height"
        and seen.cell_data.active_scalars_name == "label"
    )
    assert seen.point_data.active_texture_coordinates_name == "texcoord"
    ours = bsm.load(tmp_path / "a.vtp")
    assert seen.field_data["unit"][0] == "mm" and dict(ours.metadata) == dict(painted().metadata)
    assert np.allclose(seen.points, ours.positions) and np.array_equal(
        seen.regular_faces, ours.faces
    )
    assert np.array_equal(seen.point_data["height"], ours.attributes[1].values[:, 0])


@pytest.mark.parametrize(("mode", "compressor", "encoded", "head", "order"), WAYS)
def test_what_vtk_writes_is_read(tmp_path, mode, compressor, encoded, head, order):
    pytest.importorskip("vtkmodules")
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLPolyDataWriter

    bsm.save(painted(), tmp_path / "a.vtp")
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(tmp_path / "a.vtp"))
    reader.Update()
    writer = vtkXMLPolyDataWriter()
    writer.SetFileName(str(tmp_path / "b.vtp"))
    writer.SetInputData(reader.GetOutput())
    writer.SetBlockSize(1000)
    writer.SetEncodeAppendedData(encoded)
    for name in (f"DataModeTo{mode}", f"CompressorTypeTo{compressor}", f"HeaderTypeToUInt{head}"):
        getattr(writer, f"Set{name}")()
    getattr(writer, f"SetByteOrderTo{order}Endian")()
    writer.Write()
    equal(bsm.load(tmp_path / "b.vtp"), bsm.load(tmp_path / "a.vtp"))


def test_fields_of_many_strings_take_little_memory_and_surplus_base64_is_left():
    letters = " ".join(["97"] * 20_000 + ["0"] * 20_000)
    surplus = base64.b64encode(struct.pack("<Q", 1) + b"x").decode() + "A"
    arrays = f'<Array type="String" Name="a" format="ascii">{letters}</Array>'
    arrays += f'<DataArray type="UInt8" Name="b" format="binary">{surplus}</DataArray>'
    # Not read.
    arrays += '</FieldData><Lines><DataArray type="Int64" format="appended" offset=""/></Lines><FieldData>'
    data = file_of(torus(), "vtp").replace(
        b"<PolyData>", f"<PolyData><FieldData>{arrays}</FieldData>".encode()
    )
    with memory_below(32 << 20):
        read = read_mesh(data)
    assert read.dropped == ("a",) and read.mesh.metadata["b"] == b"x"


def test_polygons_and_lines(tmp_path):
    pyvista = pytest.importorskip("pyvista")
    points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 2, 2)]
    mesh = pyvista.PolyData(np.array(points, float), faces=[4, 0, 1, 2, 3], lines=[2, 0, 4])
    mesh.cell_data["kind"] = np.array([7, 8])
    mesh.save(tmp_path / "a.vtp")
    read = bsm.read_mesh(tmp_path / "a.vtp")
    assert len(read.mesh.faces) == 2 and "lines" in read.dropped
    assert read.mesh.attributes[0].values.ravel().tolist() == [8, 8]


def test_exact_numbers_come_back():
    mesh = torus()
    heat = bsm.Attribute("heat <&> \x01", np.linspace(0, 1, len(mesh.positions)) ** 3)
    far = bsm.TriangleMesh(mesh.positions + 1e7, mesh.faces, (heat,))
    again = read_mesh(file_of(far, "vtp")).mesh
    assert np.array_equal(again.positions, far.positions)
    assert again.attributes[0].name == "heat <&> _" and np.array_equal(
        again.attributes[0].values, heat.values
    )


@pytest.mark.parametrize(
    ("before", "after"),
    [
        (b'type="PolyData"', b'type="ImageData"'),
        (b'NumberOfPolys="', b'NumberOfPolys="9'),
        (b'NumberOfPoints="', b'NumberOfPoints="99999999'),
        (b'NumberOfComponents="3"', b'NumberOfComponents="0"'),
        (b'Name="offsets"', b'Name="ends"'),
        (b'offset="0"', b'offset="99999999"'),
        (b"<PolyData>", b"<!DOCTYPE a><PolyData>"),
        (b"<PolyData>", b"<PolyData>" + b"<a>" * 20),
        (b'header_type="UInt64"', b'header_type="UInt64" compressor="vtkZLibDataCompressor"'),
        (b'NumberOfStrips="0"', b'NumberOfStrips="1"'),
        (b'byte_order="LittleEndian"', b'byte_order="BigEndian"'),
    ],
)
def test_what_is_wrong_is_reported(before, after):
    data = file_of(torus(), "vtp")
    assert data.count(before) >= 1
    with pytest.raises(bsm.BsmError):
        read_mesh(data.replace(before, after))


def test_what_is_cut_short_is_reported():
    data = file_of(torus(5, 4), "vtp")
    for size in range(100, len(data) - 40, 7):
        with pytest.raises(bsm.BsmError):
            read_mesh(data[:size], "vtp")


def test_a_bomb_of_zlib_is_refused():
    import base64
    import zlib

    block = zlib.compress(bytes(1 << 26), 9)
    head = np.array([4, 1 << 26, 0, *[len(block)] * 4], "<u8").tobytes()
    text = base64.b64encode(head) + base64.b64encode(block * 4)
    data = (
        b'<VTKFile type="PolyData" header_type="UInt64" compressor="vtkZLibDataCompressor"><PolyData>'
        b'<Piece NumberOfPoints="3" NumberOfPolys="1"><Points><DataArray type="Float32" NumberOfComponents="3" '
        b'format="binary">' + text + b"</DataArray></Points><Polys>"
        b'<DataArray type="Int64" Name="connectivity" format="ascii">0 1 2</DataArray>'
        b'<DataArray type="Int64" Name="offsets" format="ascii">3</DataArray></Polys></Piece></PolyData></VTKFile>'
    )
    with pytest.raises(bsm.LimitError):
        read_mesh(data)
