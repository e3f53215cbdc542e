"""Looks that are foreseen without pictures, against those of pictures."""

import numpy as np
import pytest

from bsm import TriangleMesh
from bsm.codec.look.foreseen import Foresight
from bsm.codec.look.measure import LookMetric
from tests.motion import bending
from tests.shapes import torus


def test_foreseen_looks_follow_drawn_ones_from_frame_to_frame() -> None:
    positions, faces = bending(12, 24, 16)
    random = np.random.default_rng(0)
    decoded = positions + 0.002 * random.standard_normal(positions.shape)
    foresight = Foresight(faces)
    pairs = list(zip(positions, decoded, strict=True))
    drawn = np.array(
        [LookMetric(TriangleMesh(one, faces)).look(other).moving for one, other in pairs]
    )
    foreseen = np.array([foresight.look(*pair) for pair in pairs])
    ratios = np.log(drawn / foreseen)
    assert np.std(ratios) < 0.1 and abs(ratios.mean()) < 1.0


def test_the_size_and_the_place_of_a_mesh_change_nothing() -> None:
    mesh = torus(24, 16)
    moved = mesh.positions + 0.002 * np.random.default_rng(0).standard_normal(mesh.positions.shape)
    foresight = Foresight(mesh.faces)
    look = foresight.look(mesh.positions, moved)
    assert foresight.look(mesh.positions, mesh.positions) == 0.0
    assert foresight.look(8.0 * mesh.positions + 5.0, 8.0 * moved + 5.0) == pytest.approx(
        look, rel=1e-9
    )


def test_moved_outlines_count_where_shades_stay() -> None:
    mesh = torus(24, 16)
    foresight = Foresight(mesh.faces)
    looks = [
        foresight.look(mesh.positions, mesh.positions + shift) for shift in (0.0, 0.001, 0.002)
    ]
    assert looks[0] < looks[1] < looks[2]


def test_faces_without_area_are_foreseen_to_look_the_same() -> None:
    faces = np.array([[0, 1, 2], [0, 1, 2]], np.int32)
    assert Foresight(faces).look(np.zeros((3, 3)), np.zeros((3, 3))) == 0.0
