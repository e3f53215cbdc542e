"""The guided filter against definitions written out, and against published results."""

import numpy as np
import pytest

from bsm.codec.denoise.normals import GuidedFilter, filter_normals, guided_normal_filtering, own_normals, patch_guidance
from bsm.codec.denoise.surface import Topology, face_geometry
from bsm.codec.geometry.metrics import theta
from tests.codec.denoise.denoise_shapes import Partners, cube, grid
from tools.noise import gaussian_along_normals


def noisy_cube() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    positions, faces = cube(6)
    return positions, gaussian_along_normals(positions, faces, 0.2, seed=3), faces


def members(rows, i: int) -> list[int]:  # type: ignore[no-untyped-def]
    return rows.members[rows.starts[i] : rows.starts[i + 1]].tolist()


def test_the_bilateral_sum_is_the_printed_one() -> None:
    _, noisy, faces = noisy_cube()
    topology, geometry = Topology(faces, len(noisy)), face_geometry(noisy, faces)
    guide = np.roll(geometry.normals, 1, axis=0)
    filtered = filter_normals(geometry, guide, topology.patches, 0.8, 0.4)
    for f in (0, 17, 200):
        total = np.zeros(3)
        for j in members(topology.patches, f):
            spatial = np.exp(-(np.linalg.norm(geometry.centroids[f] - geometry.centroids[j]) ** 2) / (2 * 0.8**2))
            likeness = np.exp(-(np.linalg.norm(guide[f] - guide[j]) ** 2) / (2 * 0.4**2))
            total += geometry.areas[j] * spatial * likeness * geometry.normals[j]
        assert filtered[f] == pytest.approx(total / np.linalg.norm(total))


def test_the_guide_is_the_mean_of_the_most_consistent_patch() -> None:
    _, noisy, faces = noisy_cube()
    topology, geometry = Topology(faces, len(noisy)), face_geometry(noisy, faces)
    guide = patch_guidance(geometry, topology)

    def score(patch: list[int]) -> float:
        normals = geometry.normals[patch]
        widest = np.linalg.norm(normals[:, None] - normals, axis=2).max()
        pairs = [(a, b) for a, b in topology.pairs.tolist() if a in patch and b in patch]
        steps = [np.linalg.norm(geometry.normals[a] - geometry.normals[b]) for a, b in pairs]
        return widest * max(steps) / (sum(steps) + 1e-9)

    for f in (0, 50, 333):
        best = min(members(topology.patches, f), key=lambda g: score(members(topology.patches, g)))
        patch = members(topology.patches, best)
        mean = geometry.areas[patch] @ geometry.normals[patch]
        assert guide[f] == pytest.approx(mean / np.linalg.norm(mean))


def test_normals_of_lost_faces_and_cancelled_sums_stay() -> None:
    positions, faces = grid(2)
    positions[:] = 0.0
    topology, geometry = Topology(faces, len(positions)), face_geometry(positions, faces)
    assert (filter_normals(geometry, geometry.normals, topology.patches, 1.0, 0.35) == geometry.normals).all()


def test_a_cube_regains_its_edges() -> None:
    clean, noisy, faces = noisy_cube()
    assert theta(clean, guided_normal_filtering(noisy, faces, 20), faces) < 0.2 * theta(clean, noisy, faces)


def test_the_own_normals_make_an_ordinary_bilateral_filter() -> None:
    clean, noisy, faces = noisy_cube()
    topology = Topology(faces, len(noisy))
    current = noisy
    for _ in range(20):
        current = GuidedFilter(current, topology).step(current, own_normals, 0.3)
    assert theta(clean, current, faces) < 0.2 * theta(clean, noisy, faces)


def test_one_filter_may_serve_many_steps() -> None:
    _, noisy, faces = noisy_cube()
    guided = GuidedFilter(noisy, Topology(faces, len(noisy)))
    assert (guided.step(guided.step(noisy)) == guided_normal_filtering(noisy, faces, 2)).all()


@pytest.mark.real
@pytest.mark.parametrize(
    ("clean", "noisy", "expected"),
    [
        ("fandisk_6475", "fandisk_0.3_noisy", 2.93),
        ("fandisk_6475", "fandisk_0.7_noisy", 8.41),
        ("twelve_dodecahedron", "twelve_dodecahedron_noisy", 3.84),
        ("julius_36201", "julius_36201_noisy", 7.97),
    ],
)
def test_theta_is_that_of_the_authors_own_program(partners: Partners, clean: str, noisy: str, expected: float) -> None:
    original, mesh = partners(clean, noisy)
    denoised = guided_normal_filtering(mesh.positions, mesh.faces, 20)
    assert theta(original.positions, denoised, mesh.faces) == pytest.approx(expected, rel=0.03)
