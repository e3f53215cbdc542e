"""Neighborhoods, filters of normals and updates of vertices: definitions, promises and published results."""

import numpy as np
import pytest

from bsm.codec.denoise.surface import (
    CROWDED,
    FINE_STEPS,
    FineStep,
    Topology,
    bilateral_normal_filtering,
    filter_normals,
    follow_normals,
    patch_guidance,
    surroundings,
)
from bsm.codec.geometry.metrics import face_geometry
from tests.codec.denoise.denoise_shapes import Partners, cube, grid, members, sphere
from tests.shapes import theta
from tools.noise import gaussian_along_normals

every_step = pytest.mark.parametrize("step", FINE_STEPS.values(), ids=FINE_STEPS.keys())


@every_step
@pytest.mark.parametrize(("shape", "most"), [(cube, 0.25), (sphere, 0.65)])
def test_noise_is_reduced(step: FineStep, shape, most: float) -> None:  # type: ignore[no-untyped-def]
    clean, faces = shape(10)
    noisy = gaussian_along_normals(clean, faces, 0.2, seed=5)
    assert theta(clean, step(noisy, faces), faces) < most * theta(clean, noisy, faces)


@every_step
def test_a_plane_stays_a_plane(step: FineStep) -> None:
    positions, faces = grid(6)
    turned = positions @ np.linalg.qr(np.random.default_rng(2).normal(size=(3, 3)))[0].T
    normal = np.cross(turned[1] - turned[0], turned[7] - turned[0])
    assert step(turned, faces) @ normal == pytest.approx(0, abs=1e-9)


@every_step
def test_size_place_and_attitude_of_the_mesh_do_not_matter(step: FineStep) -> None:
    clean, faces = cube(5)
    noisy = gaussian_along_normals(clean, faces, 0.2, seed=1)
    q, _ = np.linalg.qr(np.random.default_rng(4).normal(size=(3, 3)))
    rotation = q * np.linalg.det(q)
    moved = step(noisy @ rotation.T * 100 + 7, faces, 3)
    assert moved == pytest.approx(step(noisy, faces, 3) @ rotation.T * 100 + 7, rel=1e-6, abs=1e-6)


@every_step
@pytest.mark.parametrize("scale", [0.0, 1.0])
def test_degenerate_and_non_manifold_meshes_stay_finite(step: FineStep, scale: float) -> None:
    positions, faces = cube(2)
    positions = np.concatenate([positions, np.full((2, 3), 9.0)]) * scale
    extra = np.array([[0, 0, 1], [0, 0, 0], [0, 1, len(positions) - 1], [5, 6, 7]], dtype=np.int32)
    broken = np.concatenate([faces, faces[:3], extra])
    moved = step(positions, broken, 3)
    assert np.isfinite(moved).all()
    assert (moved[-2] == positions[-2]).all()


def test_crowds_are_thinned_out_evenly() -> None:
    flat, faces = grid(30)
    crowded = flat * [1.0, 0.02, 1.0]
    crowded[:, 0] = 30.0 * (flat[:, 0] / 30.0) ** 4
    near = surroundings(crowded, Topology(faces, len(flat)), 2.0)
    sizes, owners = np.diff(near.starts), np.repeat(np.arange(len(faces)), np.diff(near.starts))
    # Each face is near itself.
    assert (near.members[near.starts[:-1]] == np.arange(len(faces))).all()
    assert CROWDED * 4 / 2 < sizes.max() <= CROWDED * 4
    centroids = face_geometry(crowded, faces).centroids
    apart = np.linalg.norm(centroids[near.members] - centroids[owners], axis=1)
    crowd = owners == sizes.argmax()
    assert apart[crowd].max() > 0.8 * apart.max()  # not only the nearest ones
    assert len(np.unique(near.members[crowd])) == sizes.max()


def test_the_boundary_stays_where_the_method_says_so() -> None:
    flat, faces = grid(5)
    noisy = gaussian_along_normals(flat, faces, 0.2, seed=1)
    rim = (flat[:, :2] == 0).any(axis=1) | (flat[:, :2] == 5).any(axis=1)
    moved = bilateral_normal_filtering(noisy, faces)
    assert (moved[rim] == noisy[rim]).all()
    assert (moved[~rim] != noisy[~rim]).any()


def noisy_cube() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    positions, faces = cube(6)
    return positions, gaussian_along_normals(positions, faces, 0.2, seed=3), faces


def test_the_bilateral_sum_is_the_printed_one() -> None:
    _, noisy, faces = noisy_cube()
    topology, geometry = Topology(faces, len(noisy)), face_geometry(noisy, faces)
    guide = np.roll(geometry.normals, 1, axis=0)
    filtered = filter_normals(geometry, guide, topology.patches, 0.8, 0.4)
    for f in (0, 17, 200):
        total = np.zeros(3)
        for j in members(topology.patches, f):
            spatial = np.exp(
                -(np.linalg.norm(geometry.centroids[f] - geometry.centroids[j]) ** 2) / (2 * 0.8**2)
            )
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


@pytest.mark.real
@pytest.mark.parametrize(
    ("step", "clean", "noisy", "expected"),
    [
        ("guided", "fandisk_6475", "fandisk_0.3_noisy", 2.93),
        ("guided", "fandisk_6475", "fandisk_0.7_noisy", 8.41),
        ("guided", "twelve_dodecahedron", "twelve_dodecahedron_noisy", 3.84),
        ("guided", "julius_36201", "julius_36201_noisy", 7.97),
        ("bilateral-normal", "fandisk_6475", "fandisk_0.7_noisy", 30.5),
    ],
)
def test_theta_is_the_published_one(
    partners: Partners, step: str, clean: str, noisy: str, expected: float
) -> None:
    original, mesh = partners(clean, noisy)
    denoised = FINE_STEPS[step](mesh.positions, mesh.faces)
    assert theta(original.positions, denoised, mesh.faces) == pytest.approx(expected, rel=0.03)


def test_patches_hold_the_faces_that_share_a_vertex() -> None:
    positions, faces = cube(3)
    topology = Topology(faces, len(positions))
    sets = [set(face) for face in faces.tolist()]
    for f in range(0, len(faces), 7):
        around = members(topology.patches, f)
        assert sorted(around) == [g for g in range(len(faces)) if sets[f] & sets[g]]
    expected = [
        (f, g)
        for f in range(len(faces))
        for g in range(f + 1, len(faces))
        if len(sets[f] & sets[g]) == 2
    ]
    assert sorted(map(tuple, topology.pairs.tolist())) == expected


def test_the_hub_of_a_wheel_does_not_make_everybody_a_neighbor() -> None:
    spokes = np.arange(200)
    faces = np.stack([spokes, (spokes + 1) % 200, np.full(200, 200)], axis=1).astype(np.int32)
    topology = Topology(faces, 201)
    assert (np.diff(topology.patches.starts) == 3).all()
    assert sorted(members(topology.patches, 100)) == [99, 100, 101]


def test_vertices_follow_the_true_normals_to_the_plane() -> None:
    flat, faces = grid(10)
    noisy = flat + np.random.default_rng(0).normal(0, 0.2, flat.shape) * [0, 0, 1]
    topology = Topology(faces, len(flat))
    up = np.tile([0.0, 0.0, 1.0], (len(faces), 1))
    moved = follow_normals(noisy, topology, up, 200)
    assert np.ptp(moved[:, 2]) < 0.02 * np.ptp(noisy[:, 2])
    assert (moved[:, :2] == flat[:, :2]).all()
    # One update by hand: the mean height of the centroids around.
    once = follow_normals(noisy, topology, up, 1)
    heights = face_geometry(noisy, faces).centroids[members(topology.around, 60), 2]
    assert once[60, 2] == pytest.approx(heights.mean())
    free = ~topology.boundary
    held = follow_normals(noisy, topology, up, 3, free)
    assert (held[~free] == noisy[~free]).all() and (held[free] != noisy[free]).any(axis=1).all()
