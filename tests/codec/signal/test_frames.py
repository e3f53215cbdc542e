"""Local frames: orthonormal whatever the surface, smooth in the positions, and inverse to what they add."""

import numpy as np
import scipy.sparse as sp
from hypothesis import given
from hypothesis import strategies as st

from bsm import TriangleMesh
from bsm.codec.geometry.graph import graph_of_faces
from bsm.codec.signal.smooth import Spectrum, local_frames, smooth, smoothing_spectrum, tangent_steps
from tests.shapes import torus


def test_frames_of_a_torus_are_orthonormal_and_stand_on_it() -> None:
    mesh = torus()
    frames = local_frames(mesh.positions, mesh.faces).reshape(-1, 3, 3)
    assert np.abs(frames @ frames.transpose(0, 2, 1) - np.eye(3)).max() < 1e-12
    a, b, c = (mesh.positions[mesh.faces[:, k]] for k in range(3))
    across = np.cross(b - a, c - a)
    assert ((frames[mesh.faces[:, 0], 0] * across).sum(axis=1) > 0).all()


@given(st.integers(0, 2**32 - 1))
def test_a_base_off_by_rounding_turns_frames_by_little(seed: int) -> None:
    mesh = torus(12, 8)
    noise = np.random.default_rng(seed).normal(size=mesh.positions.shape)
    moved = local_frames(mesh.positions + 1e-9 * noise, mesh.faces)
    assert np.abs(moved - local_frames(mesh.positions, mesh.faces)).max() < 1e-5


def folded(angle: float) -> TriangleMesh:
    """A strip of squares, folded along the line x = 0."""
    x, y = (values.ravel() for values in np.meshgrid(np.arange(-6.0, 7.0), np.arange(5.0)))
    right = np.maximum(x, 0.0)
    positions = np.column_stack([np.minimum(x, 0.0) + np.cos(angle) * right, y, np.sin(angle) * right])
    corner = (np.arange(12) + 13 * np.arange(4)[:, None]).ravel()[:, None]
    faces = np.concatenate([corner + np.array(face) for face in ((0, 1, 13), (1, 14, 13))]).astype(np.int32)
    return TriangleMesh(positions, faces)


def test_steps_along_the_surface_are_wide_where_it_is_flat_and_one_at_creases() -> None:
    mesh = folded(np.pi / 2)
    steps = tangent_steps(mesh.positions, mesh.faces, 0.5, 4.0)
    across = np.where(np.arange(65) // 13 == 2, np.abs(np.arange(65) % 13 - 6), -1)  # those far from borders
    crease, beside = across == 0, across == 1
    assert (steps[crease] < 0.75).all()
    assert (steps >= 0.5).all()
    assert np.allclose(steps[(across > 1) & (across < 5)], 2.0)
    assert (steps[np.arange(65) < 13] < 0.75).all()  # of a border
    assert (steps[beside] < 0.75).all()
    sharper = tangent_steps(folded(0.3).positions, mesh.faces, 0.5, 4.0)
    assert (sharper[crease] > steps[crease]).all()


@given(st.integers(0, 2**32 - 1))
def test_places_off_by_rounding_change_steps_by_little(seed: int) -> None:
    mesh = torus(12, 8)
    noise = np.random.default_rng(seed).normal(size=mesh.positions.shape)
    steps = tangent_steps(mesh.positions, mesh.faces, 1.0, 8.0)
    assert np.abs(tangent_steps(mesh.positions + 1e-9 * noise, mesh.faces, 1.0, 8.0) - steps).max() < 1e-5


def random_walk_laplacian(graph):
    adjacency = sp.csr_matrix((np.ones(len(graph.neighbors)), graph.neighbors, graph.offsets))
    return sp.eye(graph.size) - sp.diags(1 / np.diff(graph.offsets)) @ adjacency


def filter_polynomial(amount):
    """Coefficients p_2 to p_5: of terms that are 1 one at a time."""
    terms = np.zeros((4, 4, 3))
    terms[range(4), range(4)] = 1.0
    return Spectrum(np.zeros((4, 3)), terms).smoothed(amount)[:, 0]


@given(st.floats(0.0, 64.0))
def test_the_polynomial_meets_the_low_pass_at_its_nodes(amount):
    powers = filter_polynomial(amount)
    for x in (0.4, 0.9, 1.4, 1.8):
        assert np.isclose(1 + sum(p * x**k for k, p in enumerate(powers, 2)), 1 / (1 + amount * x * x), atol=1e-12)


def test_smoothing_is_the_polynomial_of_the_sparse_matrix():
    mesh = torus()
    graph = graph_of_faces(mesh.faces, len(mesh.positions))
    laplacian = random_walk_laplacian(graph)
    expected, term = mesh.positions.copy(), laplacian @ mesh.positions
    for p in filter_polynomial(4.0):
        term = laplacian @ term
        expected += p * term
    assert np.allclose(smooth(graph, mesh.positions, 4.0), expected, atol=1e-13)
    spectrum = smoothing_spectrum(graph, mesh.positions)
    assert np.array_equal(spectrum.smoothed(4.0), smooth(graph, mesh.positions, 4.0))
