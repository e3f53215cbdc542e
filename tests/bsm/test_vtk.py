"""Sequences in VTK and pyvista, with their times; the plug-in of ParaView without ParaView."""

import importlib.util
import sys
import types
from pathlib import Path

import numpy as np
import pytest

import bsm
from bsm import Attribute, OptionError
from tests.motion import bending
from tests.shapes import torus

pytest.importorskip("vtkmodules")
ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def stream(tmp_path_factory):
    positions, faces = bending(7)
    corners = positions[0][faces][:, :, :2].reshape(-1, 2).astype(np.float32)
    uv = Attribute("texcoord", corners, "corner", "texcoord")
    path = tmp_path_factory.mktemp("vtk") / "a.bsm"
    path.write_bytes(
        bsm.encode_sequence(positions, faces, mesh_attributes=[uv], frame_rate=25, gop=3)
    )
    return path


def corners_of(data):
    """The positions at the corners of all faces, however vertices were split."""
    from vtkmodules.util.numpy_support import vtk_to_numpy

    points = vtk_to_numpy(data.GetPoints().GetData())
    return points[vtk_to_numpy(data.GetPolys().GetConnectivityArray())]


def test_a_pipeline_of_vtk_has_times(stream):
    from bsm.vtk import StreamSource

    decoded, faces = bsm.decode_sequence(stream)
    source = StreamSource()
    source.SetFileName(str(stream))
    source.UpdateInformation()
    steps = source.GetOutputInformation(0).Get(source.GetExecutive().TIME_STEPS())
    assert steps == pytest.approx(np.arange(7) / 25)
    for number in (0, 1, 5, 2, 6):
        source.UpdateTimeStep(number / 25)
        assert np.array_equal(
            corners_of(source.GetOutputDataObject(0)), decoded[number][faces.reshape(-1)]
        )
    assert source.GetOutputDataObject(0).GetPointData().GetTCoords().GetName() == "texcoord"


def test_a_mesh_has_no_times(tmp_path):
    from bsm.vtk import StreamSource

    mesh = torus(6, 5)
    (tmp_path / "a.bsm").write_bytes(bsm.encode(mesh))
    source = StreamSource()
    source.SetFileName(str(tmp_path / "a.bsm"))
    source.Update()
    assert source.GetTimestepValues() is None
    assert source.GetOutputDataObject(0).GetNumberOfCells() == len(mesh.faces)


def test_a_reader_for_pyvista(stream):
    pytest.importorskip("pyvista")
    from bsm.pyvista import SequenceReader

    decoded, faces = bsm.decode_sequence(stream)
    reader = SequenceReader(stream)
    assert reader.number_time_points == 7 and reader.time_values == pytest.approx(np.arange(7) / 25)
    for number in (3, 4, 0):
        reader.set_active_time_point(number)
        assert reader.active_time_value == number / 25
        shown = reader.read()
        assert np.allclose(
            shown.points[shown.regular_faces.reshape(-1)], decoded[number][faces.reshape(-1)]
        )
    assert np.allclose(reader.at(0.121).points, reader.at(3 / 25).points)
    with pytest.raises(OptionError):
        reader.set_active_time_point(7)


def test_the_plug_in_tells_paraview_what_it_needs(stream, monkeypatch):
    """Its file is loaded with stand-ins for ParaView's decorators, which record their arguments."""
    times = {}

    def noting(kind):
        def decorator(**words):
            times[kind] = words
            return lambda decorated: decorated

        return decorator

    names = {"smproxy": ["reader"], "smproperty": ["stringvector", "doublevector"]}
    names |= {"smdomain": ["filelist"], "smhint": ["filechooser"]}
    library = types.ModuleType("paraview.util.vtkAlgorithm")
    for name, kinds in names.items():
        setattr(library, name, types.SimpleNamespace(**{kind: noting(kind) for kind in kinds}))
    for name in ("paraview", "paraview.util"):
        monkeypatch.setitem(sys.modules, name, types.ModuleType(name))
    monkeypatch.setitem(sys.modules, "paraview.util.vtkAlgorithm", library)
    spec = importlib.util.spec_from_file_location(
        "bsm_paraview", ROOT / "plugins" / "paraview" / "bsm_paraview.py"
    )
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    assert times["reader"]["extensions"] == "bsm" and times["stringvector"]["name"] == "FileName"
    assert times["doublevector"]["si_class"] == "vtkSITimeStepsProperty"
    reader = module.BSMReader()
    reader.SetFileName(str(stream))
    assert len(reader.GetTimestepValues()) == 7
    reader.UpdateTimeStep(0.08)
    assert reader.GetOutputDataObject(0).GetNumberOfCells() == 960
