"""Grids of VTK, and files of them, as VTK writes them."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

_WRITERS = {
    "vtk": ("vtkIOLegacy", "vtkUnstructuredGridWriter"), "vtu": ("vtkIOXML", "vtkXMLUnstructuredGridWriter"),
    "pvtu": ("vtkIOXML", "vtkXMLPUnstructuredGridWriter"), "vtkhdf": ("vtkIOHDF", "vtkHDFWriter"),
    "exo": ("vtkIOExodus", "vtkExodusIIWriter"), "case": ("vtkIOEnSight", "vtkEnSightWriter"),
}  # fmt: skip


def grid(
    points: Any,
    cells: Iterable[tuple[int, Any]],
    of_points: Mapping[str, Any] | None = None,
    of_cells: Mapping[str, Any] | None = None,
) -> Any:
    """An unstructured grid of cells, each with its type in VTK and its points."""
    model = pytest.importorskip(
        "vtkmodules.vtkCommonDataModel", reason="needs the extra simulation"
    )
    core = pytest.importorskip("vtkmodules.vtkCommonCore")
    support = pytest.importorskip("vtkmodules.util.numpy_support")
    found, places = model.vtkUnstructuredGrid(), core.vtkPoints()
    places.SetData(support.numpy_to_vtk(np.array(points, np.float64), deep=True))
    found.SetPoints(places)
    for kind, corners in cells:
        found.InsertNextCell(int(kind), len(corners), [int(corner) for corner in corners])
    for data, arrays in ((found.GetPointData(), of_points), (found.GetCellData(), of_cells)):
        for name, values in (arrays or {}).items():
            array = support.numpy_to_vtk(np.array(values), deep=True)
            array.SetName(name)
            data.AddArray(array)
    return found


def save(path: Path, data: Any) -> None:
    """Let VTK write a set of data, in the format of the name."""
    module, writer = _WRITERS[path.suffix[1:]]
    one = getattr(pytest.importorskip(f"vtkmodules.{module}"), writer)()
    one.SetFileName(str(path))
    one.SetInputData(data)
    assert one.Write()


def save_grid(
    path: Path, points: Any, cells: Iterable[tuple[int, Any]], *arrays: Mapping[str, Any]
) -> None:
    save(path, grid(points, cells, *arrays))
