"""The table of formats: a row has all that the other modules need to know of one. It imports nothing that takes time.

The numbers of a mesh are right-handed coordinates, in the unit and with the axis that its metadata name ("unit",
"up"), colors in sRGB with an opacity from 0 to 1, and texture coordinates from the bottom. Materials keep the words of
their file: colors are sRGB under the words of MTL, and linear under those of glTF and USD, which have the alphaMode as
well.
"""

import importlib
import os
import re
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

START, STEP, TIMES, RATE = "frame_start", "frame_step", "frame_times", "frame_rate"
"""Metadata of a sequence: the number of the first frame, at the frame rate; frames from one sample to the next, where
that is not one; uneven times in seconds, as text; and frames per second."""
_NUMBERED, _TIMED = frozenset((START, STEP)), frozenset((START, STEP, TIMES, RATE))


@dataclass(frozen=True)
class Format:
    """A format of meshes or frames; a unit or axis is that of all files, "named" by each, or "" (not said)."""

    # Of a mesh, in the first of the modules; that of a sequence is called so without _mesh.
    reader: str = ""
    writer: str = ""  # and its module
    own: bool = False  # read without the libraries of others
    # A file may hold all frames of a sequence, where it is read ("r") and written ("w").
    frames: str = ""
    beside: bool = False  # materials and images that its metadata name are read from its folder
    by_path: bool = False  # the reader is told the path
    apart: bool = False  # read in a process of its own, since its library may crash
    begins: bytes = b""  # what the first bytes of a file match, if they tell
    called: str = ""  # in errors, where a file has the suffix of another format
    # Files of other kinds have its suffix: .obj is also object code, .off a disk image.
    namesakes: bool = False
    unit: str = ""
    own_unit: bool = False  # only we read the unit in it
    up: str = ""
    # Metadata that frames say by their times, or by the numbers in their names.
    times: frozenset[str] = _NUMBERED
    empty: bytes | None = None  # a file of a frame without faces
    modules: tuple[str, ...] = ()  # loaded before such a file is read in a process of its own


def _own(kind: str, begins: bytes = b"", **more: Any) -> Format:
    module = f"bsm.files.formats.{kind}"
    return Format(
        f"read_{kind}", f"{module}:write_{kind}", True, begins=begins, modules=(module,), **more
    )


def _lines(kind: str) -> Format:
    return Format(f"read_{kind}", by_path=True, modules=(f"bsm.files.formats.{kind}",))


_EMPTY_PLY = b"ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\n"
_EMPTY_PLY += b"element face 0\nproperty list uchar int vertex_indices\nend_header\n"
_OBJ = rb"(?:[^\0]{0,65536}[\r\n])?[ \t]*v[ \t]+[-+\d.]"
_GLTF = Format(
    "read_gltf_mesh",
    frames="r",
    modules=("bsm.gltf.scene", "bsm.gltf.coding", "DracoPy", "PIL.Image"),
)
_GLB = replace(
    _GLTF,
    frames="rw",
    writer="bsm.gltf.write:write_glb",
    begins=b"glTF",
    called="a GLB",
    namesakes=True,
    unit="meters",
    up="y",
)
_PXR = ("bsm.files.motion.usd.reading", "pxr.Usd", "pxr.UsdGeom", "pxr.UsdShade", "pxr.UsdSkel")
_USD = Format("read_usd_mesh", frames="rw", unit="named", up="named", modules=_PXR)
_3MF = "bsm.files.formats.three_mf"
_LINES = {"inp": "abaqus", "bdf": "nastran", "nas": "nastran"}
_VTK = {
    "vtkIOLegacy": "vtk", "vtkIOXML": "vtu pvtu vtm vtpc pvtp vts pvts vtr pvtr vti pvti", "vtkIOHDF": "vtkhdf",
    "vtkIOEnSight": "case encas", "vtkIOExodus": "exo ex2 e", "vtkIOCGNSReader": "cgns", "vtkIOGeometry": "foam",
}  # fmt: skip
"""Suffixes of what modules of VTK read."""
XDMF = ("xdmf", "xmf")
OF_OTHERS = (*XDMF, "case", "encas", "foam", "pvtu", "pvtp", "pvts", "pvtr", "pvti", "vtm", "vtpc")
"""Suffixes of files that name others, which hold most of the data."""
_WITH_MANY_NAMESAKES: dict[str, Any] = {"beside": True, "namesakes": True, "own_unit": True}
USD_FORMATS = ("usd", "usda", "usdc", "usdz")

FORMATS: Mapping[str, Format] = {
    "obj": _own(
        "obj", _OBJ, called="an OBJ", empty=b"# a frame without faces\n", **_WITH_MANY_NAMESAKES
    ),
    "ply": _own("ply", rb"\s*ply\b", called="a PLY", empty=_EMPTY_PLY, **_WITH_MANY_NAMESAKES),
    "off": _own(
        "off", rb"(?s:.{0,5})OFF", called="an OFF", empty=b"OFF\n0 0 0\n", **_WITH_MANY_NAMESAKES
    ),
    "glb": replace(_GLB, times=_TIMED),
    "gltf": _GLTF,
    "stl": _own("stl", rb"\s*solid", called="an STL", beside=True, empty=bytes(84)),
    "npz": _own("npz", rb"(?s:PK\x03\x04.*positions\.npy)", frames="rw", times=frozenset()),
    "vtp": _own("vtp", rb"(?s:.{0,1000})<VTKFile[^>]*\bPolyData", times=_TIMED, own_unit=True),
    "3mf": Format("read_3mf", f"{_3MF}:write_3mf", unit="named", up="z", modules=(_3MF, "lib3mf")),
    "dae": Format(
        "read_dae",
        "bsm.files.formats.dae_writer:write_dae",
        by_path=True,
        unit="named",
        up="named",
        modules=("bsm.files.formats.dae", "collada", "lxml.etree"),
    ),
    **dict.fromkeys(USD_FORMATS, replace(_USD, times=_TIMED)),
    **{kind: _lines(name) for kind, name in _LINES.items()},
    "msh": Format("read_gmsh_mesh", frames="r", modules=("bsm.files.formats.gmsh",)),
    **{
        kind: Format(
            "read_vtk",
            frames="" if module in ("vtkIOLegacy", "vtkIOXML") else "r",
            apart=True,
            modules=("bsm.files.formats.with_vtk", f"vtkmodules.{module}"),
        )
        for module, kinds in _VTK.items()
        for kind in kinds.split()
    },
    **dict.fromkeys(
        XDMF,
        Format(
            "read_xdmf_mesh", frames="r", by_path=True, modules=("bsm.files.formats.xdmf", "h5py")
        ),
    ),
    "npy": Format(frames="rw", times=frozenset()),
    "pc2": Format(frames="rw"),
    "mdd": Format(frames="rw", times=_TIMED),
    "pvd": Format(frames="rw", times=_TIMED),
    "series": Format(frames="r"),
    "tileset": Format(unit="meters", up="z"),
}
_FOREIGN = {
    rb"(?i)\s*<(!doctype html|html)": "an HTML page", rb"\s*<\?xml": "XML", rb"PK\x03\x04": "a zip archive",
    rb"ISO-10303": "a STEP file", rb"Kaydara": "an FBX", rb"LASF": "a LAS", rb"\s*\{": "JSON",
}  # fmt: skip
"""Files of other kinds, by their first bytes."""
GLTF = ("glb", "gltf")
WITH_IMAGES_BESIDE = (*(kind for kind, row in FORMATS.items() if row.beside), "gltf", "dae")
# Read and written by ourselves.
MESH_FORMATS = tuple(kind for kind, row in FORMATS.items() if row.own and row.reader)
WRITTEN_FORMATS = tuple(sorted(kind for kind, row in FORMATS.items() if row.writer))
SEQUENCES_READ, ONE_FILE = (
    tuple(kind for kind, row in FORMATS.items() if how in row.frames) for how in "rw"
)
"""Formats whose files hold a whole sequence, in and out."""
SEQUENCE_FORMATS = (*ONE_FILE, *(name for name in WRITTEN_FORMATS if name not in ONE_FILE))
"""What `bsm decode` can make of a sequence; a form of a mesh is a file for each frame."""
MESH_SUFFIXES = tuple(
    f".{kind}" for kind, row in FORMATS.items() if row.reader and kind not in USD_FORMATS
)
"""Suffixes of the mesh files that are found in folders and by patterns."""


def is_mesh_name(path: str) -> bool:
    """Whether a file is called like a mesh that is read."""
    return Path(path).suffix[1:].lower() in FORMATS and bool(
        FORMATS[Path(path).suffix[1:].lower()].reader
    )


def format_of_bytes(data: bytes) -> str | None:
    """Return the format that the bytes of a file tell."""
    if len(data) == 84 + 50 * int.from_bytes(data[80:84], "little"):
        return "stl"
    return next(
        (kind for kind, row in FORMATS.items() if row.begins and re.match(row.begins, data)), None
    )


def other_kind(head: bytes, suffix: str) -> str:
    """Return the kind of a file whose first bytes are those of another format than its suffix; "" if they are not."""
    kinds = _FOREIGN | {
        row.begins: row.called for row in FORMATS.values() if row.begins and row.called
    }
    name = next(
        (kind_name for begins, kind_name in kinds.items() if re.match(begins, head[:1024])), ""
    )
    if name == FORMATS[suffix].called:
        return ""
    return name


def by_name(module: str, function: str) -> Any:
    """A reader or writer, imported when it is asked for."""
    return getattr(importlib.import_module(module), function)


@cache
def load_modules(kind: str) -> None:
    """Import the modules that read a format, as far as they are there."""
    if not kind:
        return
    for name in FORMATS[kind].modules:
        with suppress(ImportError):
            importlib.import_module(name)


def format_of_name(path: str | os.PathLike[str]) -> str | None:
    suffix = Path(path).suffix[1:].lower()
    if suffix not in WRITTEN_FORMATS:
        return None
    return suffix
