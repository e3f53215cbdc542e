"""Lengths with units: in the mesh's own, and never silently in another."""

import pytest

import bsm
from bsm.lengths import parse_length, refuse_other_units
from tests.bsm.program import bsm as program
from tests.shapes import torus


@pytest.mark.parametrize(
    ("given", "expected"),
    [("0.05mm", (0.05, True)), ("0.1%", (0.001, False)), (" 2e-3 ", (0.002, False)), (0.5, (0.5, False))],
)
def test_lengths(given, expected):
    assert parse_length("gap", given) == expected


@pytest.mark.parametrize("given", ["", "mm", ".mm", "1..2mm", "-1mm", "nan", True, None])
def test_what_is_no_length(given):
    with pytest.raises(bsm.ArgumentError, match="gap"):
        parse_length("gap", given)


@pytest.mark.parametrize("unit", ["mm", "millimeters", "Millimetre", "furlong"])
def test_the_same_unit_or_an_unknown_one(unit):
    refuse_other_units({"gap": "0.5mm", "other": 0.1, "none": None}, {"unit": unit})
    refuse_other_units({"gap": "0.5%"}, {"unit": unit})


@pytest.mark.parametrize("metadata", [{}, {"unit": ""}, {"unit": 7}, {"name": "mm"}])
def test_a_length_with_a_unit_needs_a_mesh_that_has_one(metadata):
    refuse_other_units({"gap": "0.5%", "other": 0.1, "plain": "0.1"}, metadata)
    with pytest.raises(bsm.OptionError, match=r"does not say what its unit is: add unit=mm .* such as 0\.1%"):
        refuse_other_units({"gap": "0.5mm"}, metadata)


def test_another_unit_is_refused(tmp_path):
    mesh = torus(8, 7)
    with pytest.raises(bsm.OptionError, match=r"in mm, .* is meters: give it as 0\.05meters"):
        bsm.encode(mesh, metadata={"unit": "meters"}, max_error="50mm")
    bsm.save(mesh, tmp_path / "a.ply")
    words = ("encode", tmp_path / "a.ply", "-q", "-o", tmp_path / "a.bsm", "--max-error", "0.1in")
    done = program(*words, "--meta", "unit=cm", text=True)
    assert done.returncode == 2 and "give it as 0.254cm" in done.stderr and not (tmp_path / "a.bsm").exists()
    assert program(*words, "--meta", "unit=inches").returncode == 0
