"""Total generalized variation of normals, and folds that are mended."""

import numpy as np
import pytest

from bsm import DenoiseOptions, OptionError, TriangleMesh
from bsm.codec.denoise import denoise
from bsm.codec.denoise.noise.probe import Probe
from bsm.codec.denoise.surface import Topology, folds, mend_folds
from bsm.codec.denoise.variation import measure_jumps, smooth_normals, varied_little
from bsm.codec.geometry.metrics import face_geometry, face_normals, mean_edge_length
from tests.codec.denoise.denoise_shapes import cube, sphere
from tests.shapes import theta, torus
from tools.noise import gaussian_along_normals


def bent_plate(count: int = 24) -> TriangleMesh:
    """A strip of a cylinder of radius 1, of random triangles of one size."""
    random = np.random.default_rng(5)
    rows, columns = np.indices((count, count))
    places = np.stack([rows, columns], axis=-1).reshape(-1, 2) + random.uniform(
        -0.2, 0.2, (count * count, 2)
    )
    angles = places[:, 0] / (2.0 * count)
    positions = np.stack([np.sin(angles), places[:, 1] / (2.0 * count), np.cos(angles)], axis=1)
    number = np.arange(count * count).reshape(count, count)
    corners = [number[:-1, :-1], number[1:, :-1], number[:-1, 1:], number[1:, 1:]]
    a, b, c, d = (corner.ravel() for corner in corners)
    faces = np.concatenate([np.stack([a, b, c], axis=1), np.stack([b, d, c], axis=1)])
    return TriangleMesh(positions, faces.astype(np.int32))


def test_an_even_bend_has_a_gradient_without_jumps() -> None:
    """Normals of a cylinder, at the centroids, are a linear function of the way along the surface."""
    mesh = bent_plate()
    jumps = measure_jumps(mesh.positions, Topology(mesh.faces, len(mesh.positions)))
    geometry = face_geometry(mesh.positions, mesh.faces)
    side = mesh.positions[mesh.faces[:, 1]] - mesh.positions[mesh.faces[:, 0]]
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    axes = np.stack([side, np.cross(geometry.normals, side)], axis=1)
    # The normal of a cylinder of radius 1 changes by the part of the way that goes around.
    normals = geometry.centroids * [1.0, 0.0, 1.0]
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    around = np.cross([0.0, 1.0, 0.0], normals)
    gradients = (axes @ around[:, :, None]) * around[:, None, :]
    unknowns = np.concatenate([normals, gradients.reshape(-1, 3)])
    plain = np.concatenate([normals, np.zeros((2 * len(mesh.faces), 3))])
    assert np.abs(jumps.first @ unknowns).mean() < 0.2 * np.abs(jumps.first @ plain).mean()
    assert np.abs(jumps.second @ unknowns).mean() < 0.1 * np.abs(gradients).mean()


@pytest.mark.parametrize("shape", ["plate", "cube", "torus"])
def test_noise_goes_and_shapes_stay(shape: str) -> None:
    shapes = {
        "plate": bent_plate,
        "cube": lambda: TriangleMesh(*cube(12)),
        "torus": lambda: torus(36, 28),
    }
    mesh = shapes[shape]()
    noisy = gaussian_along_normals(mesh.positions, mesh.faces, 0.2, seed=1)
    topology = Topology(mesh.faces, len(noisy))
    smooth = varied_little(noisy, Probe(topology).average @ noisy, topology)
    assert theta(mesh.positions, smooth, mesh.faces) < 0.4 * theta(
        mesh.positions, noisy, mesh.faces
    )


def test_flat_meshes_and_meshes_without_pairs_of_faces_stay() -> None:
    for faces in ([[0, 1, 2]], [[0, 1, 2], [2, 1, 3]]):
        positions = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]])
        topology = Topology(np.array(faces, np.int32), 4)
        normals = face_normals(positions, topology.faces)
        assert smooth_normals(normals, positions, topology, 1.0) == pytest.approx(normals)


def test_a_turned_mesh_gets_the_turned_result() -> None:
    mesh = torus(20, 16)
    noisy = gaussian_along_normals(mesh.positions, mesh.faces, 0.2, seed=1)
    turn = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]
    turn *= np.linalg.det(turn)
    topology = Topology(mesh.faces, len(noisy))
    edge = mean_edge_length(noisy, mesh.faces)
    normals = face_normals(noisy, mesh.faces)
    still = smooth_normals(normals, noisy / edge, topology, 1.0)
    turned = smooth_normals(normals @ turn.T, noisy @ turn.T / edge, topology, 1.0)
    assert turned == pytest.approx(still @ turn.T, abs=1e-9)


def test_folds_are_mended_and_the_surface_stays() -> None:
    mesh = TriangleMesh(*cube(12))
    positions = np.array(mesh.positions, np.float64)
    topology = Topology(mesh.faces, len(positions))
    average = Probe(topology).average
    assert not folds(positions, topology).any()
    # A vertex is pushed along the surface across one of its neighbors, in the middle of a side.
    middle = int(np.argmax(positions[:, 2] - np.abs(positions[:, :2] - 6.0).max(axis=1)))
    neighbor = topology.neighbors.members[topology.neighbors.starts[middle]]
    positions[middle] += 2.5 * (positions[neighbor] - positions[middle])
    assert folds(positions, topology).any()
    mended = mend_folds(positions, topology, average)
    assert not folds(mended, topology).any()
    assert theta(mesh.positions, mended, mesh.faces) < 0.1


def test_shapes_that_are_folded_stay() -> None:
    positions, faces = sphere(16)
    topology = Topology(faces, len(positions))
    crumpled = positions + np.random.default_rng(3).normal(
        0.0, mean_edge_length(positions, faces), positions.shape
    )
    assert folds(crumpled, topology).mean() > 0.03
    assert np.array_equal(mend_folds(crumpled, topology, Probe(topology).average), crumpled)


@pytest.mark.parametrize("method", ["guided", "tgv", "learnt"])
def test_each_method_denoises_by_itself(method: str) -> None:
    mesh = torus(36, 28, bumps=0.02)
    noisy = mesh.moved(gaussian_along_normals(mesh.positions, mesh.faces, 0.2, seed=3))[0]
    result = denoise(noisy, DenoiseOptions(method=method), force=True)
    assert theta(mesh.positions, result.positions, mesh.faces) < 0.6 * theta(
        mesh.positions, noisy.positions, mesh.faces
    )


def test_options_of_steps_that_a_method_has_not_are_refused() -> None:
    with pytest.raises(
        OptionError, match="method tgv has no coarse step; leave out hand_over, keep and block_size"
    ):
        DenoiseOptions(method="tgv", keep=0.2)
    with pytest.raises(
        OptionError, match="method learnt has no fine step; leave out fine and iterations"
    ):
        DenoiseOptions(method="learnt", iterations=3)
    assert DenoiseOptions(method="guided", iterations=3).iterations == 3
