"""The library, compiled once for all of its tests."""

import ctypes

import pytest

from tools.bsmdec import build


@pytest.fixture(scope="session")
def library() -> ctypes.CDLL:
    return build()
