"""What other libraries call a mesh, as ours."""

import importlib
import os
import sys
import warnings
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from traceback import walk_stack
from typing import Any

import numpy as np

from bsm import __version__
from bsm.bitstream.errors import ArgumentError, BsmWarning, MeshError
from bsm.bitstream.limits import DEFAULT_LIMITS
from bsm.codec.arrays import as_array
from bsm.codec.geometry.attributes import Domain, Semantic
from bsm.codec.geometry.mesh import Metadata, TriangleMesh
from bsm.files.formats.metadata import plain_fields
from bsm.files.formats.polygons import Array, Column, MeshFile, Polygons, compact, named_column
from bsm.files.images import linked_images, with_linked_images
from bsm.files.mesh import read_mesh
from bsm.files.parsing import Ints, ranges
from bsm.files.pipes import Input, as_input
from bsm.files.stream import decode_whole, is_stream

_POINTS = ("vertices", "points", "positions")
_FACES = ("faces", "triangles")
_WITH_NOTES = ("bsm.cli", "bsm.commands.", "bsm.jobs.", "bsm.viewer.contents")


# The number of frames between here and the user's code differs from door to door, so it is counted in the stack.
def warn(notes: Iterable[str]) -> None:
    """Warn of changes and losses, in the line of the user's code that called `bsm`; commands print notes instead.

    The logger `bsm` gets each note, too."""
    modules = [
        str(frame.f_globals.get("__name__", "")) for frame, _ in walk_stack(sys._getframe(1))
    ]
    if any(name.startswith(_WITH_NOTES) for name in modules):
        return
    # Modules of Python count as ours: contextlib and functools stand between bsm and its caller.
    ours = {"bsm", *sys.stdlib_module_names} - {"__main__"}
    level = next(
        (level for level, name in enumerate(modules, 2) if name.partition(".")[0] not in ours), 2
    )
    for note in notes:
        _log(note)
        warnings.warn(note, BsmWarning, stacklevel=level)


def _log(note: str) -> None:
    """Send a note to the logger `bsm`, if the program logs at all."""
    # Not imported: loading it takes a program that does not log several milliseconds.
    logging = sys.modules.get("logging")
    if logging is None:
        return
    logger = logging.getLogger("bsm")
    # Without a handler, Python would print the note a second time.
    if logger.hasHandlers():
        logger.warning("%s", note)


def as_mesh(mesh: Any) -> TriangleMesh:
    if isinstance(mesh, TriangleMesh):
        return mesh
    if isinstance(mesh, MeshFile):
        return mesh.mesh
    if file := as_file(mesh):
        return read_any(file)
    converted = _of_library(mesh)
    warn(converted.notes)
    return converted.mesh


def as_file(mesh: Any) -> Input | None:
    """The input that a path, bytes or a file is; None: an object of a library, some of which have a `read`, too."""
    is_source = isinstance(mesh, (str, bytes, bytearray, memoryview, os.PathLike, Input))
    if is_source or (hasattr(mesh, "read") and _attribute(mesh, _POINTS) is None):
        return as_input(mesh)
    return None


def _of_library(mesh: Any) -> MeshFile:
    if isinstance(mesh, (tuple, list)) and len(mesh) == 2:
        return _of_arrays(*mesh)
    # By what the objects have and not by their classes: no library must be there to ask, and none is loaded for it.
    for first, second, read in _LIBRARIES:
        if hasattr(mesh, first) and hasattr(mesh, second):
            return read(mesh).checked(DEFAULT_LIMITS)
    points, faces = _attribute(mesh, _POINTS), _attribute(mesh, _FACES)
    if points is not None and faces is None and hasattr(mesh, "extract_surface"):
        raise MeshError("this is a mesh of cells: give its surface, mesh.extract_surface()")
    if points is not None and faces is not None:
        return _of_arrays(points, faces)
    raise ArgumentError(
        "a mesh is expected: an object with vertices (or points) and faces, a pair of arrays (positions, faces), a "
        f"path, or a file; not {type(mesh).__name__}"
    )


PROVENANCE = "provenance"
"""The entry of metadata that says how a stream was made."""


def as_decoded(metadata: Metadata) -> Metadata:
    """The metadata of a file whose mesh is not exact, so that encoding it says which generation it is."""
    return {PROVENANCE: f"bsm {__version__}", **metadata}


def read_any(source: Input, **reading: Any) -> TriangleMesh:
    """The mesh in a stream or a mesh file; `reading` are arguments of `read_mesh`."""
    if is_stream(source):
        mesh = decode_whole(source.chunks(), reading.get("limits", DEFAULT_LIMITS))
        if not source.name:
            return mesh
        warn(
            f"{source.name}: {image.note}"
            for image in linked_images(mesh.metadata, source.name)
            if image.fault
        )
        return with_linked_images(mesh, source.name)
    contents = read_mesh(source, **reading)
    prefix = ""
    if source.name:
        prefix = f"{source.name}: "
    warn(f"{prefix}{note}" for note in contents.notes)
    return contents.mesh


def _attribute(mesh: Any, names: tuple[str, ...]) -> Any:
    values = (getattr(mesh, name, None) for name in names)
    return next((value for value in values if value is not None and not callable(value)), None)


def _of_arrays(positions: Any, faces: Any) -> MeshFile:
    try:
        table = np.asarray(faces)
    except ValueError:  # lists of different lengths
        rows = [as_array(face, f"face {number}").reshape(-1) for number, face in enumerate(faces)]
        sizes, corners = np.array([len(row) for row in rows]), np.concatenate(rows)
    else:
        # As VTK and pyvista hold faces: a count before the corners of each.
        if table.ndim == 1 and table.size and table.dtype.kind in "iu":
            sizes, corners = _split(table.astype(np.int64))
        elif table.ndim == 2 and table.shape[1] > 3:
            sizes, corners = np.full(len(table), table.shape[1]), table.reshape(-1)
        else:
            return MeshFile(TriangleMesh(positions, table))
    return _of_polygons(positions, sizes, corners).checked(DEFAULT_LIMITS)


def _of_polygons(
    positions: Any, sizes: Ints, corners: Array, columns: Sequence[Column] = ()
) -> Polygons:
    points = as_array(positions, "positions", np.float64)
    if points.ndim != 2 or points.shape[1] != 3:
        raise MeshError(f"positions must have shape (n, 3), not {points.shape}")
    if corners.dtype.kind not in "iu":
        raise MeshError(f"faces must be integers, not {corners.dtype}")
    return Polygons(
        points, sizes.astype(np.int64), corners.astype(np.int64), columns=tuple(columns)
    )


def _split(flat: Ints) -> tuple[Ints, Ints]:
    """Return the sizes and corners of polygons in a flat list, where the number of corners precedes each polygon."""
    starts, at = list[int](), 0
    while 0 <= at < len(flat):
        starts.append(at)
        at += 1 + max(int(flat[at]), 0)
    sizes = flat[np.array(starts, np.int64)]
    if (sizes < 0).any() or at != len(flat):
        raise MeshError("flat faces must be a count followed by as many vertices, for each face")
    return sizes, flat[ranges(np.array(starts, np.int64) + 1, sizes)]


def _of_pyvista(mesh: Any) -> Polygons:
    from bsm.files.formats.cells import columns_of

    losses = {name: None for name in ("verts", "lines", "strips") if getattr(mesh, f"n_{name}")}
    # Cells are points and lines, too.
    first, last = mesh.n_verts + mesh.n_lines, mesh.n_cells - mesh.n_strips
    cells = {name: values[first:last] for name, values in mesh.cell_data.items()}
    normals, texcoords = (
        mesh.point_data.active_normals_name,
        mesh.point_data.active_texture_coordinates_name,
    )
    active: dict[str, Semantic] = {normals: "normal", texcoords: "texcoord"}
    columns = [
        *columns_of(mesh.point_data, "vertex", losses, active),
        *columns_of(cells, "face", losses),
    ]
    metadata, others = plain_fields(mesh.field_data)
    polygons = _of_polygons(mesh.points, *_split(np.array(mesh.faces, np.int64)), columns)
    return replace(
        polygons, dropped=(*losses, *(f"field data {name}" for name in others)), metadata=metadata
    )


def _of_open3d(mesh: Any) -> Polygons:
    columns = _shown(
        ("normal", "vertex", mesh.vertex_normals),
        ("color", "vertex", mesh.vertex_colors),
        ("texcoord", "corner", mesh.triangle_uvs),
    )
    if (materials := np.asarray(mesh.triangle_material_ids)).size:
        columns.append(Column("material", materials.reshape(-1, 1), "face"))
    losses: tuple[str, ...] = ()
    if len(getattr(mesh, "textures", ())):
        losses = ("textures",)
    faces = np.asarray(mesh.triangles)
    polygons = _of_polygons(mesh.vertices, np.full(len(faces), 3), faces.reshape(-1), columns)
    return replace(polygons, dropped=losses)


def _of_openmesh(mesh: Any) -> Polygons:
    """A `TriMesh` or `PolyMesh`: a face has a halfedge to each of its corners, and then -1."""
    try:
        table, ends = (
            np.atleast_2d(mesh.fh_indices()),
            np.asarray(mesh.halfedge_to_vertex_indices()),
        )
    except RuntimeError as error:  # deleted elements leave gaps
        raise MeshError(f"{str(error).rstrip('.')}: mesh.garbage_collection()") from error
    halfedges = table[table >= 0]

    def held(name: str) -> Any:
        has_values = getattr(mesh, f"has_{name}")
        if not has_values():
            return ()
        values = getattr(mesh, name)
        return values()

    texcoords: tuple[Semantic, Domain, Any]
    texcoords_of_halfedges = held("halfedge_texcoords2D")
    if len(texcoords_of_halfedges):
        texcoords = "texcoord", "corner", texcoords_of_halfedges[halfedges]
    else:
        texcoords = "texcoord", "vertex", held("vertex_texcoords2D")
    columns = _shown(
        ("normal", "vertex", held("vertex_normals")),
        ("color", "vertex", held("vertex_colors")),
        ("color", "face", held("face_colors")),
        texcoords,
    )
    return _of_polygons(mesh.points(), (table >= 0).sum(axis=1), ends[halfedges], columns)


def _shown(*given: tuple[Semantic, Domain, Any]) -> list[Column]:
    """Columns of the values that there are."""
    tables = [(meaning, domain, np.array(values)) for meaning, domain, values in given]
    return [
        named_column(meaning, compact(table), domain, meaning)
        for meaning, domain, table in tables
        if table.size
    ]


def _by(module: str, name: str) -> Callable[[Any], Polygons]:
    """A reader of a module of formats, which is loaded when a mesh needs it."""
    return lambda mesh: getattr(importlib.import_module(f"bsm.files.formats.{module}"), name)(mesh)


_LIBRARIES: tuple[tuple[str, str, Callable[[Any], Polygons]], ...] = (
    ("visual", "vertex_attributes", _by("with_trimesh", "polygons_of")),
    ("fv_indices", "halfedge_to_vertex_indices", _of_openmesh),
    ("graph", "geometry", _by("with_trimesh", "joined")),
    ("cells", "cell_sets", _by("cells", "of_meshio")),
    ("point_data", "n_lines", _of_pyvista),
    ("triangle_uvs", "vertex_colors", _of_open3d),
)
"""Two attributes that the meshes of a library have, and how they are read."""
