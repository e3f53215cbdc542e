"""Every format that is read: garbage, a cut file and a huge count give a mesh or one of our errors, never another."""

import base64
import importlib.util
import json
import random
import re
from contextlib import suppress
from pathlib import Path

import pytest

from bsm import BsmError, Limits, read_mesh
from bsm.files.table import FORMATS, USD_FORMATS, WRITTEN_FORMATS
from tests.gltf import unpack
from tests.grids import save_grid
from tests.motion import bending, save_frames
from tests.shapes import file_of, torus

MESHIO = {
    "inp": "abaqus",
    "bdf": "nastran",
    "nas": "nastran",
    "msh": "gmsh",
    "xdmf": "xdmf",
    "xmf": "xdmf",
}
# One of each library of files.
VTK = {"vtk": "vtkUnstructuredGridWriter", "vtu": "vtkXMLUnstructuredGridWriter"}
LIBRARIES = {
    "3mf": "lib3mf",
    "dae": "collada",
    **dict.fromkeys(USD_FORMATS, "pxr"),
    **dict.fromkeys(MESHIO, "h5py"),
}
LIBRARIES |= {**dict.fromkeys(VTK, "vtk"), **dict.fromkeys(("xdmf", "xmf"), "lxml")}
READ = sorted(
    kind for kind, row in FORMATS.items() if row.reader and (kind in VTK or not row.apart)
)
LIMITS = Limits(vertices=10_000, faces=10_000)


def valid(kind: str, folder: Path) -> bytes:
    """A file of this format, as we or its library write it."""
    mesh = torus(6, 5)
    if kind in WRITTEN_FORMATS:
        return file_of(mesh, kind)
    if kind == "dae":
        data: bytes = (
            pytest.importorskip("trimesh")
            .Trimesh(mesh.positions, mesh.faces)
            .export(file_type="dae")
        )
        return data
    if kind == "gltf":
        document, numbers = unpack(file_of(mesh, "glb"))
        content = base64.b64encode(numbers).decode()
        document["buffers"][0]["uri"] = f"data:application/octet-stream;base64,{content}"
        return json.dumps(document).encode()
    path = folder / f"valid.{'usdc' if kind == 'usdz' else kind}"
    if kind in MESHIO:
        meshio = pytest.importorskip("meshio")
        meshio.write(
            path, meshio.Mesh(mesh.positions.round(3), {"triangle": mesh.faces}), MESHIO[kind]
        )
        return path.read_bytes()
    if kind in VTK:
        save_grid(path, mesh.positions, [(5, face) for face in mesh.faces])
        return path.read_bytes()
    save_frames(path, path.suffix[1:], *bending(2, 6, 5))
    if kind == "usdz":
        from pxr import UsdUtils

        UsdUtils.CreateNewUsdzPackage(str(path), str(path.with_suffix(".usdz")))
        path = path.with_suffix(".usdz")
    return path.read_bytes()


@pytest.mark.parametrize("kind", READ)
def test_no_reader_lets_another_error_out(kind: str, tmp_path: Path) -> None:
    if (library := LIBRARIES.get(kind)) is not None and importlib.util.find_spec(library) is None:
        pytest.skip(f"needs {library}")
    whole, noise = valid(kind, tmp_path), random.Random(kind)
    cuts = [whole[: len(whole) * part // 9] for part in range(1, 9)]
    counts = [
        whole[: m.start()] + b"999999999" + whole[m.end() :]
        for m in list(re.finditer(rb"\d+", whole))[:40:4]
    ]
    longs = [
        whole[:at] + b"\xff\xff\xff\x7f" + whole[at + 4 :]
        for at in range(0, min(len(whole) - 4, 400), 20)
    ]
    if kind in (
        "usd",
        "usdc",
        "xdmf",
        "xmf",
        *VTK,
    ):  # these libraries take memory for such counts, and only isolation bounds it
        counts = longs = []
    path = tmp_path / f"mesh.{kind}"
    path.write_bytes(whole)
    assert len(read_mesh(path).mesh.faces) > 50
    for data in (noise.randbytes(500), noise.randbytes(20), b"\0" * 100, *cuts, *counts, *longs):
        path.write_bytes(data)
        with suppress(BsmError):
            read_mesh(path, limits=LIMITS)
