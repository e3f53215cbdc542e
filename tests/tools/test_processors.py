"""The same bits on another processor, and on one with the other order of bytes."""

from pathlib import Path

import pytest

from tools.amalgamate import ROOT
from tools.processors.__main__ import NotHere, complaint, lines, prepare, program


@pytest.mark.slow
@pytest.mark.parametrize("name", ["aarch64", "s390x"])
def test_another_processor_decodes_the_same(name: str) -> None:
    """A sample; `python -m tools.processors` takes all vectors and processors."""
    folder, streams = ROOT / ".cache/processors", sorted((ROOT / "spec/vectors").glob("*/*.bsm"))[::8]
    prepare(folder)
    here = program(folder, "here", ["cc", "-O1"])
    assert isinstance(here, Path)
    expected = lines([str(here)], folder, streams)
    assert len(expected) == len(streams)
    try:
        assert complaint(folder, name, expected, streams, "-O1") is None
    except NotHere as error:
        pytest.skip(str(error))
