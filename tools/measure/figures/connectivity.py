"""Connectivity beside Draco's: bits per vertex, and time against Draco's whole encoding and decoding."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TypeVar

import numpy as np

from bsm.bitstream.connectivity.faces import decode_connectivity, encode_connectivity
from bsm.bitstream.errors import CorruptError
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.evaluation.draco import decode_draco, encode_draco

Result = TypeVar("Result")

REPEATS = 3


def connectivity_row(name: str, mesh: TriangleMesh) -> tuple[str, ...]:
    """One line of the table; the decoded faces are checked before a time is given.

    Draco does not code connectivity alone. Its file with one bit for a coordinate holds little else, so that it is an
    upper bound of its connectivity.
    """
    mesh = mesh.without_isolated_vertices()[0]
    vertices, faces = len(mesh.positions), len(mesh.faces)
    encode_seconds, coded = _fastest(lambda: encode_connectivity(mesh.faces, vertices))
    decode_seconds, decoded = _fastest(lambda: decode_connectivity(coded.payload, vertices, faces))
    if not np.array_equal(decoded, coded.faces):
        raise CorruptError(f"{name}: the connectivity does not come back")
    draco_encode, draco = _fastest(lambda: encode_draco(mesh, 11, 10))
    draco_decode, _ = _fastest(lambda: decode_draco(draco))
    return (
        name,
        f"{8 * len(coded.payload) / vertices:.3f}",
        f"{8 * len(encode_draco(mesh, 1, 10)) / vertices:.3f}",
        *(f"{faces / seconds / 1e6:.1f}" for seconds in (encode_seconds, decode_seconds, draco_encode, draco_decode)),
    )


HEADINGS = ("mesh", "bpv", "Draco, at most", "encode, Mtri/s", "decode", "Draco's whole encode", "decode")


def _fastest(work: Callable[[], Result]) -> tuple[float, Result]:
    """CPU seconds of the fastest of some runs behind one that does not count, and the result."""
    result = work()
    seconds = []
    for _ in range(REPEATS):
        begin = time.process_time()
        result = work()
        seconds.append(time.process_time() - begin)
    return min(seconds), result
