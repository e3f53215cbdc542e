"""A stream into Blender: a mesh, or a sequence as a Mesh Cache, which Blender plays, scrubs and renders by itself."""

from __future__ import annotations

import math
import os
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import bpy

from bsm.blender.meshes import data_of
from bsm.codec.arrays import Positions
from bsm.codec.geometry.mesh import Metadata, TriangleMesh
from bsm.files.motion.caches import write_cache
from bsm.files.output import open_output
from bsm.files.pipes import read_chunks
from bsm.files.sequence_stream import SequenceStream, peek_header
from bsm.files.stream import decode_whole

STREAM = "bsm_stream"
"""The property of an object that holds its stream, so that a project keeps it, packed or moved."""
MOST_STREAM_BYTES = 1 << 28
_MODIFIER = "BSM"
Progress = Callable[[int, int], None]


def import_file(
    path: str, *, frame_start: int = 1, set_scene: bool = True, progress: Progress | None = None
) -> list[Any]:
    """Import a stream; the objects that were made, selected, the first of them active."""
    header, chunks = peek_header(read_chunks(path))
    name = Path(path).stem
    if header is None or not header.gop_frames:
        mesh = decode_whole(chunks)
        made = _placed(bpy.data.objects.new(name, data_of(mesh, name)), mesh.metadata)
    else:
        data = b"".join(chunks)
        made = _sequence(name, data, path, frame_start, set_scene, progress)
    for other in bpy.context.selected_objects:
        other.select_set(False)
    bpy.context.collection.objects.link(made)
    made.select_set(True)
    bpy.context.view_layer.objects.active = made
    return [made]


def _placed(made: Any, metadata: Metadata) -> Any:
    """Stand an object up whose y axis points up, and keep what is said of it."""
    if str(metadata.get("up", "")).lower() == "y":
        made.rotation_euler = (math.pi / 2, 0.0, 0.0)
    for name, value in metadata.items():
        if not isinstance(value, bytes) and not name.startswith(("material.", "image.", "part.")):
            made[name] = value
    return made


def _sequence(name: str, data: bytes, source: str, frame_start: int, set_scene: bool, progress: Progress | None) -> Any:
    stream = SequenceStream(iter([data]))
    frames = stream.frames()
    first = next(frames)[1]
    mesh = TriangleMesh(first, stream.faces, stream.attributes, stream.metadata)
    made = _placed(bpy.data.objects.new(name, data_of(mesh, name)), mesh.metadata)
    path = _cache_path(made.name, source)
    count = _write(path, first, frames, stream.header.frames, progress)
    if len(data) <= MOST_STREAM_BYTES:
        made[STREAM] = data
    cache = made.modifiers.new(_MODIFIER, "MESH_CACHE")
    cache.cache_format, cache.filepath = "PC2", _relative(path)
    cache.frame_start = frame_start
    scene = bpy.context.scene
    if set_scene:
        rate = mesh.metadata.get("frame_rate")
        if isinstance(rate, int | float) and 0 < rate < 1e6:
            scene.render.fps = max(1, round(rate))
            scene.render.fps_base = scene.render.fps / rate
        scene.frame_start, scene.frame_end = frame_start, frame_start + count - 1
        scene.frame_set(frame_start)
    return made


def _write(
    path: str, first: Positions, others: Iterator[tuple[int, Positions]], count: int, progress: Progress | None
) -> int:
    """A PC2 of all frames; how many there are. The stream need not say that beforehand."""
    if not count:
        frames = [first, *(frame for _, frame in others)]
        count, others = len(frames), enumerate(frames[1:], 1)
    Path(path).parent.mkdir(parents=True, exist_ok=True)
    with open_output(path, overwrite=True) as file, write_cache(file, "pc2", count, lambda: 0.0) as write:
        write(first)
        for number, frame in others:
            write(frame)
            if progress:
                progress(number + 1, count)
    return count


def _cache_path(name: str, source: str) -> str:
    """Beside the project if it is saved, else beside the stream, else among temporary files."""
    file = f"{bpy.path.clean_name(name)}.pc2"
    if bpy.data.filepath:
        return os.path.join(os.path.dirname(bpy.data.filepath), "bsm_cache", file)
    folder = os.path.dirname(os.path.abspath(source))
    if source and os.access(folder, os.W_OK):
        return os.path.join(folder, "bsm_cache", file)
    return os.path.join(tempfile.gettempdir(), "bsm_cache", file)


def _relative(path: str) -> str:
    return str(bpy.path.relpath(path)) if bpy.data.filepath else path


def restore_caches() -> list[str]:
    """Write caches that are not there any more from the streams in the project; the names of their objects."""
    restored = []
    for moving in bpy.data.objects:
        cache = moving.modifiers.get(_MODIFIER)
        data = moving.get(STREAM)
        if (
            cache is None
            or cache.type != "MESH_CACHE"
            or data is None
            or os.path.isfile(bpy.path.abspath(cache.filepath))
        ):
            continue
        stream = SequenceStream(iter([bytes(data)]))
        frames = stream.frames()
        path = _cache_path(moving.name, "")
        _write(path, next(frames)[1], frames, stream.header.frames, None)
        cache.filepath = _relative(path)
        restored.append(moving.name)
    return restored
