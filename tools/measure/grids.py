"""Meshes without two vertices at one position, and exact positions on Draco's grid."""

import time

import numpy as np
import numpy.typing as npt

from bsm.codec.decoding import decode
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.static.encoder import Encoder
from bsm.codec.static.options import EncodeOptions
from bsm.files.mesh import read_mesh

Faces = npt.NDArray[np.int32]
Positions = npt.NDArray[np.float32]


def welded(path: str) -> tuple[Positions, Faces]:
    """A mesh without two vertices at one position, in the order of the coded connectivity."""
    mesh = read_mesh(path).mesh
    positions, number = np.unique(mesh.positions.astype(np.float32), axis=0, return_inverse=True)
    faces = number.reshape(-1)[mesh.faces]
    proper = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
    used, faces = np.unique(faces[proper], return_inverse=True)
    return positions[used], faces.reshape(-1, 3).astype(np.int32)


def rounded(positions: Positions, bits: int) -> Faces:
    """Positions on Draco's grid: its arithmetic, in single precision."""
    low = positions.min(axis=0)
    inverse = np.float32((1 << bits) - 1) / np.float32((positions - low).max())
    placed: Faces = np.floor((positions - low) * inverse + np.float32(0.5)).astype(np.int32)
    return placed


def encode(positions: Positions, faces: Faces, bits: int) -> tuple[bytes, float]:
    """A whole stream, once it is found to be exact, and the processor time per vertex in microseconds."""
    start = time.process_time()
    encoder = Encoder(
        TriangleMesh(positions.astype(np.float64), faces), EncodeOptions(grid=bits, threads=1)
    )
    data = encoder.encode()
    spent = (time.process_time() - start) / len(positions) * 1e6
    cell = float((positions - positions.min(axis=0)).max()) / ((1 << bits) - 1)
    off = np.abs(decode(data).positions - positions[encoder.vertex_order]) / cell
    assert off.max() < 0.51, "a vertex is not at the nearest place"
    return data, spent
