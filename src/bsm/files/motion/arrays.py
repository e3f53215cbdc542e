"""Sequences as arrays: an npz with `positions` of shape (T, n, 3) and `faces`; and, for live pipes, npy arrays.

Those follow each other: the faces, then the positions of each frame as it comes.
"""

from __future__ import annotations

import io
import math
import os
from collections.abc import Iterator
from contextlib import ExitStack, closing

import numpy as np

from bsm.bitstream.errors import FormatError, MeshError
from bsm.bitstream.limits import Limits
from bsm.codec.arrays import Positions
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.files.formats.npy import read_npy
from bsm.files.formats.npz import MOST_NAMED, npz_frames, npz_shape, opened_archive, read_arrays, shape_of
from bsm.files.motion.frames import Frames
from bsm.files.pipes import Input
from bsm.files.room import AS_NUMBERS, require_inflated


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
        limits.check(name, count)
    compressed = os.path.getsize(given.name) if given.is_file else len(held)
    require_inflated(AS_NUMBERS * 3 * shape[1] + max(size, AS_NUMBERS * math.prod(of_faces)), compressed, limits)
    (faces,) = read_arrays(archive, "faces")
    mesh = TriangleMesh(next(npz_frames(archive)), faces)
    with opened_archive(archive) as opened:
        others = [name.removesuffix(".npy") for name in opened.namelist() if name not in ("positions.npy", "faces.npy")]
    others[MOST_NAMED:] = [f"{len(others) - MOST_NAMED} other arrays"] if len(others) > MOST_NAMED else []
    notes = (f"left out: {', '.join(others)}",) if others else ()
    return Frames(mesh.faces, shape[0], npz_frames(archive), notes=notes)


def read_pipe(given: Input, limits: Limits) -> Frames:
    """npy arrays, one behind the other: faces, frame, frame, ..."""
    with ExitStack() as unread:
        unread.callback(given.close)
        faces = read_npy(given, "faces", limits)
        if faces is None or faces.dtype.kind not in "iu":
            raise FormatError("the first array must be the faces: integers of shape (m, 3)")
        unread.pop_all()

    def frames() -> Iterator[Positions]:
        with closing(given):
            while (frame := read_npy(given, "vertices", limits)) is not None:
                yield frame.astype(np.float64)

    return Frames(faces.astype(np.int32), 0, frames())
