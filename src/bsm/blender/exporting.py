"""An object of Blender's to a stream: with its modifiers, and over the frames of the scene if it moves."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import bpy
import numpy as np

from bsm import options
from bsm.api import encode
from bsm.bitstream.errors import MeshError, OptionError
from bsm.blender.meshes import attributes_of, materials_of, triangles_of
from bsm.codec.arrays import Faces, Positions
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.files.output import open_output

Progress = Callable[[int, int], None]


def export_object(
    path: str, moving: Any = None, *, animation: bool = True, progress: Progress | None = None, **keywords: Any
) -> dict[str, int]:
    """Write an object to a stream; how many frames, vertices, faces and bytes that are."""
    moving = moving or bpy.context.view_layer.objects.active
    if moving is None:
        raise OptionError("no object is active: select the one to export")
    scene = bpy.context.scene
    numbers = (
        range(scene.frame_start, scene.frame_end + 1)
        if animation
        else range(scene.frame_current, scene.frame_current + 1)
    )
    before = scene.frame_current
    metadata: dict[str, Any] = {"name": moving.name, "up": "z", **materials_of(moving.material_slots)}
    if scene.unit_settings.system != "NONE" and abs(scene.unit_settings.scale_length - 1.0) < 1e-6:
        metadata["unit"] = "meters"
    try:
        faces, attributes, first = _first(scene, moving, numbers[0])
        if not animation:
            written = [encode(TriangleMesh(first, faces, attributes), metadata=metadata, **keywords)]
        else:
            from bsm.codec.sequence.encoder import SequenceEncoder

            metadata["frame_rate"] = scene.render.fps / scene.render.fps_base
            chosen = options.sequence_options(**keywords)
            encoder = SequenceEncoder(faces, chosen, len(numbers), metadata, attributes)
            frames = _frames(scene, moving, numbers, progress)
            written = encoder.chunks(frames)  # type: ignore[assignment]
        size = 0
        with open_output(path, overwrite=True) as file:
            for piece in written:
                size += file.write(piece)
    finally:
        scene.frame_set(before)
    return {"frames": len(numbers), "vertices": len(first), "faces": len(faces), "bytes": size}


def _first(scene: Any, moving: Any, number: int) -> tuple[Faces, tuple[Attribute, ...], Positions]:
    scene.frame_set(number)
    with _Evaluated(moving) as (data, place):
        faces, corners = triangles_of(data)
        if not len(faces):
            raise MeshError(f"{moving.name} has no faces")
        return faces, attributes_of(data, corners), _points(data, place)


def _frames(scene: Any, moving: Any, numbers: range, progress: Progress | None) -> Iterator[Positions]:
    known: tuple[int, ...] = ()
    for done, number in enumerate(numbers, 1):
        scene.frame_set(number)
        with _Evaluated(moving) as (data, place):
            # How polygons are cut into triangles may change when they bend; that is not another mesh.
            sizes = len(data.vertices), len(data.loops), len(data.polygons)
            known = known or sizes
            if sizes != known:
                raise MeshError(
                    f"{moving.name} has {sizes[0]} vertices and {sizes[2]} faces in frame {number} of the scene, and "
                    f"{known[0]} and {known[2]} in frame {numbers[0]}: the faces of a sequence stay"
                )
            points = _points(data, place)
        yield points
        if progress:
            progress(done, len(numbers))


def _points(data: Any, place: Any) -> Positions:
    points = np.empty(3 * len(data.vertices), np.float32)
    data.vertices.foreach_get("co", points)
    matrix = np.array(place, np.float64)
    found: Positions = points.reshape(-1, 3).astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
    return found


class _Evaluated:
    """An object's mesh as the scene shows it, and where it is."""

    def __init__(self, moving: Any) -> None:
        self._found = moving.evaluated_get(bpy.context.evaluated_depsgraph_get())

    def __enter__(self) -> tuple[Any, Any]:
        try:
            return self._found.to_mesh(), self._found.matrix_world
        except RuntimeError as error:
            raise MeshError(f"{self._found.name} has no surface: {error}") from error

    def __exit__(self, *_: object) -> None:
        self._found.to_mesh_clear()
