"""Lengths with units: in the mesh's own, and never silently in another."""

import pytest

import bsm
from bsm.lengths import in_own_unit, parse_length
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
    assert in_own_unit({"max_error": "0.5mm", "size": "3kB"}, {"unit": unit}) == {}
    assert in_own_unit({"max_error": "0.5%"}, {"unit": unit}) == {}


@pytest.mark.parametrize("metadata", [{}, {"unit": ""}, {"unit": 7}, {"name": "mm"}])
def test_a_length_with_a_unit_needs_a_mesh_that_has_one(metadata):
    for plain in ("0.5%", 0.1, "0.1"):
        assert in_own_unit({"max_error": plain}, metadata) == {}
    with pytest.raises(bsm.OptionError, match=r"has no unit: add unit=mm .* such as 0\.1%"):
        in_own_unit({"max_error": "0.5mm"}, metadata)


def test_another_unit_is_converted(tmp_path):
    mesh, metadata = torus(8, 7), {"unit": "meters"}
    assert in_own_unit({"max_error": "0.05mm"}, metadata) == {"max_error": "5e-05meters"}
    own, other = (bsm.encode(mesh, metadata=metadata, max_error=text) for text in ("0.05meters", "50mm"))
    assert own == other
    bsm.save(mesh, tmp_path / "a.ply")
    words = ("encode", tmp_path / "a.ply", "-q", "-f", "-o", tmp_path / "a.bsm", "--meta", "unit=cm", "--max-error")
    assert program(*words, "0.01in").returncode == 0
    inches = (tmp_path / "a.bsm").read_bytes()
    assert program(*words, "0.0254cm").returncode == 0
    assert inches == (tmp_path / "a.bsm").read_bytes()
