"""The library, compiled once for all of its tests."""

import ctypes

import pytest

from tests.engine.decoding import build


@pytest.fixture(scope="session")
def library(tmp_path_factory: pytest.TempPathFactory) -> ctypes.CDLL:
    return build(tmp_path_factory.mktemp("bsmdec"), "-w")
