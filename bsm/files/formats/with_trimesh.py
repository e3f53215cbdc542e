"""GLB, glTF, 3MF, DAE and whatever else trimesh reads: the parts of a scene, placed where it has them, as one mesh."""

from __future__ import annotations

import io
from typing import Any

import numpy as np

from bitstream.errors import BsmError, DependencyError, FormatError
from bitstream.limits import Limits
from bsm.files.formats.polygons import Polygons


def read_with_trimesh(data: bytes, path: str | None, kind: str, limits: Limits) -> Polygons:
    """Read a file with trimesh, which neither merges vertices nor splits them here.

    Parameters
    ----------
    data : bytes
    path : str, optional
        Where it came from, if that is a file: some formats keep their arrays in files beside it.
    kind : str
        The suffix that tells the format.
    limits : Limits
        Looked at before the parts are put together; what trimesh takes to read them is not bounded.

    Raises
    ------
    DependencyError
        If trimesh is missing.
    FormatError
        If trimesh cannot read it.
    """
    try:
        import trimesh
    except ImportError as error:
        raise DependencyError(
            f"{f'.{kind}' if kind else 'such'} files are read with trimesh; run: pip install 'bsm-codec[formats]'"
        ) from error
    if kind not in trimesh.available_formats():
        raise FormatError(
            f"{f'.{kind} is' if kind else 'this is'} no mesh format that is known here (trimesh reads more of them, "
            "3MF and DAE among them, after: pip install 'bsm-codec[formats]')"
        )
    try:
        scene = trimesh.load_scene(path or io.BytesIO(data), file_type=kind, process=False)
        return joined(scene, limits)
    except (BsmError, MemoryError):
        raise
    except Exception as error:  # it promises nothing about what damaged files raise
        raise FormatError(f"trimesh cannot read this file: {type(error).__name__}: {error}") from error


def joined(scene: Any, limits: Limits) -> Polygons:
    """The surfaces of a scene as one, each as often and where the scene has it."""
    places = [scene.graph[node] for node in scene.graph.nodes_geometry]
    parts = [(matrix, scene.geometry[name]) for matrix, name in places if hasattr(scene.geometry[name], "faces")]
    limits.check("vertices", sum(len(part.vertices) for _, part in parts))
    limits.check("faces", sum(len(part.faces) for _, part in parts))
    positions, faces, first = [np.empty((0, 3))], [np.empty((0, 3), np.int64)], 0
    for matrix, part in parts:
        positions.append(part.vertices @ matrix[:3, :3].T + matrix[:3, 3])
        mirrored = np.linalg.det(matrix[:3, :3]) < 0
        faces.append(first + (part.faces[:, ::-1] if mirrored else part.faces))
        first += len(part.vertices)
    triangles = np.concatenate(faces)
    notes = [f"{len(parts)} parts were joined to one mesh"] if len(parts) > 1 else []
    if len(parts) < len(places):
        notes.append(f"curves and point clouds were left out: {len(places) - len(parts)}")
    dropped = dict.fromkeys(name for _, part in parts for name in _attributes(part))
    return Polygons(
        np.concatenate(positions), np.full(len(triangles), 3), triangles.reshape(-1), tuple(notes), tuple(dropped)
    )


def _attributes(part: Any) -> list[str]:
    """What a part has beside positions and faces."""
    names = ["normals"] if "vertex_normals" in part._cache else []
    if part.visual.kind == "texture":
        names += ["materials"] if part.visual.uv is None else ["texture coordinates", "materials"]
    elif part.visual.kind is not None:
        names.append("colours")
    return [*names, *part.vertex_attributes, *part.face_attributes]
