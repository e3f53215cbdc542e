"""Constants are changed wherever they are used, and what that does is told at the same error."""

import importlib.util
import subprocess
import sys
from pathlib import Path

import pytest

import bsm
from tests.shapes import torus
from tools.constants.__main__ import CONSTANTS, Constant, measured, ratio
from tools.constants.changed import change, times
from tools.constants.figures import FIGURES


@pytest.mark.parametrize("constant", CONSTANTS, ids=lambda constant: constant.name)
def test_every_constant_is_there(constant):
    spec = importlib.util.find_spec(constant.module)
    assert spec is not None and spec.origin is not None
    assert Path(spec.origin).read_text().count(f"\n{constant.name} = ") == 1
    assert constant.figure in FIGURES


def test_a_changed_constant_is_seen_by_importers_and_defaults():
    script = """
import sys
from tools.constants.changed import change
change(*sys.argv[1:3], 2.0)
from bsm.codec.denoise import normals
from bsm.codec.static.choice import plan
print(normals.SIGMA_R, normals.GuidedFilter.step.__defaults__[1], plan.STIFFNESS)
"""

    def said(*constant):
        command = [sys.executable, "-c", script, *constant]
        return subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)

    assert said("bsm.codec.denoise.normals", "SIGMA_R").stdout.split() == ["0.7", "0.7", "8.0"]
    assert said("bsm.codec.static.rules", "STIFFNESS").stdout.split() == ["0.35", "0.35", "16.0"]
    assert "has no constant MISSING" in said("bsm.codec.static.rules", "MISSING").stderr


def test_what_is_imported_cannot_be_changed():
    with pytest.raises(RuntimeError, match="has been imported"):
        change("bsm", "X", 2.0)


def test_numbers():
    assert (times(0.5, 0.5), times(3, 0.5), times(1, 0.5), times((1.0, 4), 2.0)) == (0.25, 2, 1, (2.0, 8))


def test_ratios_are_at_the_same_error():
    usual = [(1.0, 400.0), (2.0, 200.0), (4.0, 100.0)]
    assert ratio(usual, usual) == pytest.approx(1.0)
    assert ratio([(1.5, 400.0), (3.0, 200.0), (6.0, 100.0)], usual) == pytest.approx(1.5)
    assert ratio([(3.0, 300.0), (4.0, 225.0)], usual) == pytest.approx(2.25)
    assert ratio([(1.0, 6.0)], [(1.0, 4.0)]) == 1.5


def test_a_constant_does_something(tmp_path):
    bsm.save(torus(60, 40), tmp_path / "a.ply")
    (usual,), (other,) = (
        measured(Constant("blocks", "bsm.codec.signal.bandwidth", "WORTHWHILE"), factor, [tmp_path / "a.ply"])
        for factor in (1.0, 4.0)
    )
    assert len(usual) == len(other) == 3 and usual != other
    assert usual == FIGURES["blocks"](tmp_path / "a.ply")
