"""Sequences as arrays: an npz with `positions` of shape (T, n, 3) and `faces`; and, for live pipes, npy arrays.

Those follow each other: the faces, then the positions of each frame as it comes.
"""

from __future__ import annotations

import io
from collections.abc import Iterator
from contextlib import ExitStack, closing

import numpy as np

from bsm.bitstream.errors import FormatError, MeshError
from bsm.codec.arrays import Positions
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.files.formats.npy import read_npy
from bsm.files.formats.npz import Archive, npz_frames, npz_shape, read_arrays
from bsm.files.motion.frames import Frames
from bsm.files.pipes import Input


def read_archive(given: Input) -> Frames | None:
    """The sequence of an npz; None if it holds a mesh."""
    archive: Archive = given.name if given.is_file else io.BytesIO(given.peek(1 << 32))
    shape = npz_shape(archive)
    if len(shape) != 3:
        return None
    if shape[0] == 0:
        raise MeshError("this npz file holds a sequence without frames")
    (faces,) = read_arrays(archive, "faces")
    mesh = TriangleMesh(next(npz_frames(archive)), faces)
    return Frames(mesh.faces, shape[0], npz_frames(archive))


def read_pipe(given: Input) -> Frames:
    """npy arrays, one behind the other: faces, frame, frame, ..."""
    with ExitStack() as unread:
        unread.callback(given.close)
        faces = read_npy(given)
        if faces is None or faces.ndim != 2 or faces.shape[1] != 3 or faces.dtype.kind not in "iu":
            raise FormatError("the first array must be the faces: integers of shape (m, 3)")
        unread.pop_all()

    def frames() -> Iterator[Positions]:
        with closing(given):
            while (frame := read_npy(given)) is not None:
                if frame.ndim != 2 or frame.shape[1] != 3:
                    raise FormatError(
                        f"an array of {frame.dtype} and shape {frame.shape} is no frame; (n, 3) numbers are"
                    )
                yield frame.astype(np.float64)

    return Frames(faces.astype(np.int32), 0, frames())
