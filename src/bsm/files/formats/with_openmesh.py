"""OBJ, OFF, PLY and STL as openmesh reads them: a second opinion on our own readers.

openmesh duplicates vertices at non-manifold edges, drops faces with repeated corners, and passes coordinates through
float32. It crashes over some damaged files and attributes: it is given what our readers have understood, and these are
ours, where the mesh is still the same.
"""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import numpy as np

from bsm.bitstream.errors import DependencyError, FormatError
from bsm.bitstream.extras import how_to_install
from bsm.bitstream.limits import Limits
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.files.formats.polygons import MeshFile, Polygons


def read_with_openmesh(data: bytes, kind: str, ours: TriangleMesh, limits: Limits) -> MeshFile:
    """Read a file with openmesh."""
    try:
        import openmesh
    except ImportError as error:
        raise DependencyError(f"openmesh is not installed; run: {how_to_install('openmesh')}") from error
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder, f"mesh.{kind}")
        copy.write_bytes(data)
        try:
            with _native_stderr_closed():
                mesh = openmesh.read_polymesh(str(copy))
        except RuntimeError:
            raise FormatError("openmesh cannot read this file; leave out --reader openmesh") from None
    points = mesh.points().astype(np.float64)
    table = mesh.fv_indices() if mesh.n_faces() else np.empty((0, 3), np.int64)
    present = table >= 0
    notes = []
    if len(points) != len(ours.positions) or (present.sum(axis=1) - 2).sum() != len(ours.faces):
        notes.append(f"openmesh has made {len(points)} vertices of the {len(ours.positions)} of the file")
    names = tuple(attribute.name for attribute in ours.attributes)
    if len(points) != len(ours.positions) or not np.array_equal(table, ours.faces):
        corners = table[present].astype(np.int64)
        theirs = Polygons(points, present.sum(axis=1), corners, tuple(notes), names, metadata=ours.metadata)
        return theirs.checked(limits)
    return MeshFile(replace(ours, positions=points), tuple(notes))


@contextmanager
def _native_stderr_closed() -> Iterator[None]:
    """Keep openmesh, which prints a line for each edge it dislikes, from writing to the terminal."""
    sys.stderr.flush()
    saved = os.dup(2)
    sink = os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(sink, 2)
        yield
    finally:
        os.dup2(saved, 2)
        os.close(saved)
        os.close(sink)
