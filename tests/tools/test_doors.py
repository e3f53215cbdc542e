"""Other readers, each in a process that may crash, against ours."""

from pathlib import Path

import pytest

from tools.attack.doors import Apart, attempt, compared

MOVING = Path(__file__).parents[1] / "bsm" / "files" / "moving"


def test_usd_core_reads_our_samples_as_we_do():
    pytest.importorskip("pxr")
    apart = Apart()
    try:
        for name in ("skinned.usdc", "morphing.usdc", "painted.usdz"):
            assert list(compared(MOVING / name, ["usd"], apart)) == [("usd", "same", "")]
        assert apart.read("usd", MOVING / "three.mjs") is None
    finally:
        apart.close()


def test_a_reader_that_is_missing_or_fails_reads_nothing(tmp_path):
    (tmp_path / "a.ply").write_bytes(b"no mesh")
    assert attempt("trimesh", tmp_path / "a.ply") is None
