"""The library, compiled once for all of its tests."""

import ctypes

import pytest

from tests.library.decoding import build


@pytest.fixture(scope="session")
def library() -> ctypes.CDLL:
    return build()
