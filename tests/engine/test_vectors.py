"""The decoder in C, compiled from one file, against all test vectors."""

from __future__ import annotations

import ctypes
from pathlib import Path

import pytest

from tests.engine.decoding import decode, of_sequence
from tools.vectors.store import Vector, read_manifest

STATUS = {"format": 3, "corrupt": 4, "unsupported": 5, "limit": 6, "numeric": 7, "truncated": 12}


@pytest.mark.parametrize("vector", read_manifest(), ids=lambda vector: vector.name)
def test_vector(library: ctypes.CDLL, vector: Vector) -> None:
    found = decode(library, Path(vector.stream).read_bytes())
    if found.status == STATUS["unsupported"] and vector.error != "unsupported":
        pytest.skip(found.message)
    assert found.status == STATUS.get(vector.error or "", 0), found.message
    if vector.error is None:
        arrays = of_sequence(found) if "-sequence" in vector.name else dict(found.arrays)
        complaint = vector.complaint(arrays.pop("positions"), arrays.pop("faces"), arrays)
        assert complaint is None, complaint
