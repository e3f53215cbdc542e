"""Sequences as arrays: an npz with `positions` of shape (T, n, 3), `faces` and attributes, of shape (T, n) or (T, n, c)
where they change; and, for live pipes, npy arrays.

Those follow each other: the faces, then the positions of each frame as it comes.
"""

from __future__ import annotations

import io
import math
import os
from collections.abc import Iterator
from contextlib import ExitStack, closing
from dataclasses import dataclass

import numpy as np

from bsm.bitstream.errors import FormatError, MeshError
from bsm.bitstream.limits import Limits
from bsm.codec.arrays import Faces, Positions
from bsm.codec.geometry.attributes import MOST_COMPONENTS, Attribute
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.files.formats.npz import (
    MOST_NAMED,
    NpzArray,
    column_of,
    npz_frames,
    npz_shape,
    opened_archive,
    read_arrays,
    read_npy,
    shape_of,
)
from bsm.files.formats.polygons import Column, attributes_of, meaning_of
from bsm.files.motion.frames import Frames
from bsm.files.pipes import Input, about
from bsm.files.room import AS_NUMBERS, require_count, require_inflated


def read_archive(given: Input, limits: Limits) -> Frames | None:
    """The sequence of an npz; None if it holds a mesh. Shapes are looked at before numbers are read."""
    held = b"" if given.is_file else given.peek(1 << 32)
    archive = given.name if given.is_file else io.BytesIO(held)
    shape = npz_shape(archive)
    if len(shape) != 3:
        return None
    if 0 in shape or shape[2] != 3:
        raise MeshError(f"this npz file holds {shape[0]} frames of shape {shape[1:]}; (n, 3) numbers are a frame")
    of_faces, size = shape_of(archive, "faces")
    for name, count in (("frames", shape[0]), ("vertices", shape[1]), ("faces", of_faces[0] if of_faces else 0)):
        require_count(name, count, limits)
    compressed = os.path.getsize(given.name) if given.is_file else len(held)
    require_inflated(AS_NUMBERS * 3 * shape[1] + max(size, AS_NUMBERS * math.prod(of_faces)), compressed, limits)
    (faces,) = read_arrays(archive, "faces")
    mesh = TriangleMesh(next(npz_frames(archive)), faces)
    worn = _Worn.of(archive, shape[0], mesh, compressed, limits)
    left = [
        *worn.left[:MOST_NAMED],
        *([f"{len(worn.left) - MOST_NAMED} others"] if len(worn.left) > MOST_NAMED else []),
    ]
    notes = (f"left out: {', '.join(left)}",) if left else ()
    if not worn.moving:
        return Frames(mesh.faces, shape[0], npz_frames(archive), worn.still, notes)
    first = next(worn.meshes(archive, mesh.faces))
    return Frames(
        mesh.faces, shape[0], npz_frames(archive), first.attributes, notes, meshes=worn.meshes(archive, mesh.faces)
    )


_PER_MOVING_BYTE = 5
"""Bytes that one of a frame's values takes while it becomes an attribute, and the frame before it is still there."""


@dataclass(frozen=True, eq=False)
class _Worn:
    """The attributes of an npz: those of all frames, and the arrays, by name, that have values for each frame."""

    still: tuple[Attribute, ...]
    moving: dict[str, str]
    left: list[str]

    @staticmethod
    def of(archive: str | io.BytesIO, frames: int, mesh: TriangleMesh, compressed: int, limits: Limits) -> _Worn:
        """What beside positions and faces can be attributes; shapes are looked at before numbers are read."""
        columns: list[Column] = []
        moving: dict[str, str] = {}
        left: list[str] = []
        inflated = frame = 0
        with opened_archive(archive) as opened:
            every = [name.removesuffix(".npy") for name in opened.namelist()]
            for number, name in enumerate(every):
                if name in ("positions", "faces") or (name.endswith("/indices") and name.rpartition("/")[0] in every):
                    continue
                column = None
                try:
                    shape, size = shape_of(opened, name)
                    if shape[:2] == (frames, len(mesh.positions)) and math.prod(shape[2:]) <= MOST_COMPONENTS:
                        frame += _PER_MOVING_BYTE * size // frames
                        require_inflated(frame, compressed, limits, len(mesh.positions))
                        if len(moving) >= limits.attributes:
                            raise MeshError("too many")
                        moving[name.removeprefix("vertex/")] = name
                        continue
                    inflated += size
                    if number <= 2 * limits.attributes and name != "metadata":
                        require_inflated(inflated, compressed, limits)
                        (values,) = read_arrays(opened, name)
                        column = column_of(opened, name, values, mesh, f"{name}/indices" in every)
                except (MeshError, FormatError):  # no numbers
                    pass
                columns += [column] if column else []
                left += [] if column else [name]
        corners = np.arange(3 * len(mesh.faces)).reshape(-1, 3)
        attributes, refused = attributes_of(
            columns, len(mesh.positions), len(mesh.faces), corners, np.arange(len(mesh.faces))
        )
        return _Worn(attributes, moving, [*left, *refused])

    def meshes(self, archive: str | io.BytesIO, faces: Faces) -> Iterator[TriangleMesh]:
        """One frame after the other, with its attributes."""
        with ExitStack() as stack:
            arrays = [stack.enter_context(NpzArray(archive, name)).frames() for name in self.moving.values()]
            for number, (positions, *values) in enumerate(zip(npz_frames(archive), *arrays, strict=True)):
                with about(f"frame {number}"):
                    own = (
                        Attribute(name, one.astype(one.dtype.newbyteorder("=")), semantic=meaning_of(name))
                        for name, one in zip(self.moving, values, strict=True)
                    )
                    mesh = TriangleMesh(positions, faces, (*self.still, *own))
                yield mesh


def read_pipe(given: Input, limits: Limits) -> Frames:
    """npy arrays, one behind the other: faces, frame, frame, ..."""
    with ExitStack() as unread:
        unread.callback(given.close)
        faces = read_npy(given, "faces", limits)
        if faces is None or faces.dtype.kind not in "iu":
            raise FormatError("the first array must be the faces: integers of shape (m, 3)")
        if faces.size and not 0 <= int(faces.min()) <= int(faces.max()) < 1 << 31:
            raise MeshError(f"a face refers to vertex {faces.max() if faces.min() >= 0 else faces.min()}")
        unread.pop_all()

    def frames() -> Iterator[Positions]:
        with closing(given):
            while (frame := read_npy(given, "vertices", limits)) is not None:
                yield frame.astype(np.float64)

    return Frames(faces.astype(np.int32), 0, frames())
