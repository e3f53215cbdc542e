"""Caches of points beside a mesh: PC2 (3ds Max, Blender's Mesh Cache) and MDD (LightWave).

PC2 is little-endian: "POINTCACHE2\\0", the version 1, the number of points, the first frame and the step of samples
as float32, the number of samples; then float32 coordinates, sample by sample. MDD is big-endian: numbers of frames and
of points, the time of each frame in seconds as float32, then float32 coordinates.
"""

import os
import struct
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

import numpy as np

from bsm.bitstream.errors import FormatError, MeshError, TruncatedError
from bsm.bitstream.limits import Limits
from bsm.codec.arrays import Positions
from bsm.files.mesh import read_mesh
from bsm.files.motion.frames import USUAL_RATE, Frames, Wanted, timing_of
from bsm.files.parsing import Doubles, require_counts
from bsm.files.pipes import about
from bsm.files.table import MESH_SUFFIXES, START, STEP

CACHES = ("pc2", "mdd")
_PC2 = struct.Struct("<12siiffi")
_SIGNATURE = b"POINTCACHE2\0"
_MDD = struct.Struct(">ii")


@dataclass(frozen=True)
class Cache:
    points: int
    frames: int
    start: int
    kind: str
    rate: float = 0.0
    # As metadata; None: the times in the file are invalid.
    timing: dict[str, float | str] | None = None


def read_cache(path: str, kind: str, request: Wanted, limits: Limits) -> Frames:
    """The frames of a cache, each read when it is asked for, and the faces of the mesh that it moves."""
    size = os.path.getsize(path)
    with open(path, "rb") as file:
        if kind == "pc2":
            cache = _head_of_pc2(file)
        else:
            cache = _head_of_mdd(file, size, request.rate)
    what = f"the {kind.upper()} file claims {cache.frames} frames of {cache.points} points"
    if cache.frames < 1 or cache.points < 1:
        raise FormatError(what)
    needed = cache.start + 12 * cache.points * cache.frames
    if size < needed:
        raise TruncatedError(f"{what}, which take {needed} bytes; it has {size}")
    require_counts(limits, vertices=cache.points, frames=cache.frames)
    # A cache only holds points. Animators keep the mesh beside it under the same name.
    beside = mesh_beside(path) if request.mesh is None else os.fspath(request.mesh)
    with about(beside):
        mesh = read_mesh(beside, limits=limits, isolated=False).mesh
    if len(mesh.positions) != cache.points:
        raise MeshError(
            f"the cache has {cache.points} points and the mesh {beside} has {len(mesh.positions)} vertices; name the "
            "mesh that it was made for with --mesh"
        )
    # Asked with the same positions, only to learn which attributes a motion would make wrong.
    kept_mesh, normals = mesh.moved(mesh.positions)
    notes = [f"faces and attributes are those of {beside}"]
    if normals:
        notes.append(f"left out, for they move: {', '.join(normals)}")
    if cache.timing is None:
        notes.append("the times of frames are not numbers that grow, and are left out")
    metadata = {**mesh.metadata, **(cache.timing or {})}
    shared = kept_mesh.attributes, tuple(notes), cache.rate, metadata
    return Frames(mesh.faces, cache.frames, _samples(path, cache), *shared, rigged=cache.points)


def _head_of_pc2(file: BinaryIO) -> Cache:
    head = file.read(_PC2.size)
    if len(head) < _PC2.size or not head.startswith(_SIGNATURE):
        raise FormatError('this is not a PC2 file: it does not begin with "POINTCACHE2"')
    _, version, points, start, step, frames = _PC2.unpack(head)
    if version != 1:
        raise FormatError(f"PC2 of version {version} is not known; 1 is")
    if not np.isfinite([start, step]).all() or step <= 0.0:
        return Cache(points, frames, _PC2.size, "<f4", timing=None)
    timing: dict[str, float | str] = {}
    if start:
        timing[START] = start
    if step != 1.0:
        timing[STEP] = step
    return Cache(points, frames, _PC2.size, "<f4", timing=timing)


def _head_of_mdd(file: BinaryIO, size: int, rate: float) -> Cache:
    head = file.read(_MDD.size)
    if len(head) < _MDD.size:
        raise TruncatedError(f"an MDD file begins with {_MDD.size} bytes; this one has {len(head)}")
    frames, points = _MDD.unpack(head)
    start = _MDD.size + 4 * max(frames, 0)
    if size < start:
        raise TruncatedError(
            f"the MDD file claims {frames} frames, whose times take {start} bytes; it has {size}"
        )
    times = _doubles(file.read(start - _MDD.size), ">f4")
    return Cache(points, frames, start, ">f4", *timing_of(times, rate))


def _samples(path: str, cache: Cache) -> Iterator[Positions]:
    with open(path, "rb") as file:
        file.seek(cache.start)
        for number in range(cache.frames):
            data = file.read(12 * cache.points)
            if len(data) < 12 * cache.points:
                raise TruncatedError(f"the file ends in frame {number} of {cache.frames}")
            yield _doubles(data, cache.kind).reshape(-1, 3)


def _doubles(data: bytes, kind: str) -> Doubles:
    with np.errstate(invalid="ignore"):  # a later check refuses NaN
        return np.frombuffer(data, kind).astype(np.float64)


def mesh_beside(path: str) -> str:
    for suffix in MESH_SUFFIXES:
        name = str(Path(path).with_suffix(suffix))
        if os.path.isfile(name):
            return name
    usual_name = Path(mesh_of(path)).name
    raise MeshError(
        f"a cache holds points and no faces: put the mesh beside it ({usual_name}), or name it with --mesh"
    )


def write_cache(
    file: BinaryIO,
    kind: str,
    codes: Sequence[float],
    frames: Iterable[Positions],
    rate: float = 0.0,
) -> None:
    """Write a cache of frames with these time codes, at a frame rate."""
    single, count = ">f4", len(codes)
    if kind == "pc2":
        single = "<f4"
    for number, frame in enumerate(frames):
        if number == 0 and kind == "pc2":
            step = 1.0
            if count > 1:
                step = codes[1] - codes[0]
            file.write(_PC2.pack(_SIGNATURE, 1, len(frame), codes[0], step, count))
        elif number == 0:
            times = np.array(codes) / (rate or USUAL_RATE)
            file.write(_MDD.pack(count, len(frame)) + times.astype(">f4").tobytes())
        # Beyond it a coordinate would become infinite without a word.
        if np.abs(frame).max() > np.finfo(np.float32).max:
            raise MeshError(
                f"a coordinate of frame {number} is beyond single precision, which {kind.upper()} has"
            )
        file.write(np.ascontiguousarray(frame, single).tobytes())


def mesh_of(path: str) -> str:
    return str(Path(path).with_suffix(".obj"))
