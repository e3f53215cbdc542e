"""What an encoder holds while it works: arrays that are read-only for good are shared, and dropped ones are gone."""

import gc
from typing import Any

import numpy as np
import pytest

import bsm
from bsm.codec.arrays import sealed
from bsm.codec.static import encoder
from tests.shapes import curved, torus

SEARCHED = ("Measures", "Shaper", "LookMetric", "Canvas", "Gallery", "RefinementBase", "Trial")


def alive(names: tuple[str, ...]) -> list[str]:
    return sorted(
        type(thing).__name__ for thing in gc.get_objects() if type(thing).__name__ in names
    )


@pytest.mark.parametrize("effort", ["normal", "quick"])
def test_nothing_of_the_search_lies_beside_the_checking_decoder(
    monkeypatch: pytest.MonkeyPatch, effort: Any
) -> None:
    held: list[str] = []
    verify = encoder.verify

    def watched(*given: Any) -> bsm.TriangleMesh:
        held.extend(alive(SEARCHED))
        return verify(*given)

    monkeypatch.setattr(encoder, "verify", watched)
    mesh = curved(torus(40, 60))
    gc.collect()
    gc.disable()  # memory may not depend on when garbage is collected
    try:
        before = alive(SEARCHED)
        bsm.encode(mesh, effort=effort, threads=1)
    finally:
        gc.enable()
    assert held == before


def test_meshes_share_arrays_that_nobody_can_write_to() -> None:
    mesh = torus(8, 12)
    other = bsm.TriangleMesh(mesh.positions, mesh.faces)
    assert np.shares_memory(mesh.positions, other.positions) and np.shares_memory(
        mesh.faces, other.faces
    )
    for array in (mesh.positions, mesh.faces):
        with pytest.raises(ValueError, match="WRITEABLE"):
            array.setflags(write=True)


def test_arrays_that_are_read_only_for_now_are_copied() -> None:
    made = torus(8, 12)
    positions, faces = np.array(made.positions), np.array(made.faces)
    for array in (positions, faces):
        array.setflags(write=False)
    mesh = bsm.TriangleMesh(positions, faces)
    positions.setflags(write=True)
    positions[:] = 0.0
    assert mesh.positions.any() and not np.shares_memory(mesh.faces, faces)
    part = bsm.TriangleMesh(mesh.positions[::-1], mesh.faces)
    assert not np.shares_memory(part.positions, mesh.positions)


def test_an_array_that_is_handed_over_is_not_copied() -> None:
    made = torus(8, 12)
    own, faces = np.array(made.positions), made.faces
    assert np.shares_memory(bsm.TriangleMesh(sealed(own), faces).positions, own)
    turned = np.asfortranarray(own)
    assert not np.shares_memory(sealed(turned), turned), "kernels read rows"
    assert (sealed(turned) == own).all()
