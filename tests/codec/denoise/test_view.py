"""Scans of depth cameras: what the generator makes, where the camera is, and what is done along its rays."""

from pathlib import Path

import numpy as np
import pytest

from bsm import read_mesh
from bsm.codec.arrays import Floats, Positions
from bsm.codec.denoise.noise.causes import lattice_step
from bsm.codec.denoise.noise.view import View, find_view
from bsm.codec.denoise.surface import Topology
from tests.codec.denoise.denoise_shapes import cube, find, grid, probe_of, sphere
from tests.shapes import theta
from tools.noise import denoise_automatically
from tools.scans import CAMERAS, Scan, fused, isosurface, turning, view

AWAY = turning(5)


def scan(shape, camera: str, noisy: bool = True) -> Scan:  # type: ignore[no-untyped-def]
    model = CAMERAS[camera]._replace(pixels=100)
    return view(*shape(30), model if noisy else model._replace(noise=lambda depth, *_: depth), 3)


@pytest.mark.parametrize("camera", CAMERAS)
def test_noise_of_fused_views_is_taken_away(camera: str) -> None:
    pytest.importorskip("vtkmodules")
    made = fused(*cube(30), CAMERAS[camera], 3, cells=50)
    result, choice = denoise_automatically(made.positions, made.faces)
    assert choice.kind == "fused" and not choice.reliable
    assert made.angle(result) < 0.4 * made.angle(made.positions)
    assert made.rms(result) < 0.8 * made.rms(made.positions)


@pytest.mark.slow
@pytest.mark.real
def test_fused_views_of_a_real_camera_are_known(meshes: Path) -> None:
    """A cone of a public data set; total generalized variation leaves 7.2 of its 14.4 degrees."""
    noisy, clean = (
        read_mesh(meshes / "kinect" / f"cone_{name}.ply").mesh for name in ("noisy", "clean")
    )
    result, choice = denoise_automatically(noisy.positions, noisy.faces)
    assert choice.kind == "fused" and not choice.reliable
    assert theta(clean.positions, result, clean.faces) < 7.2


def test_noise_of_volumes_is_rehearsed() -> None:
    """It is even, and as fine as the cells: a filter for the broad noise of cameras leaves 5.5 of its 22 degrees."""
    pytest.importorskip("vtkmodules")

    def bumpy(places: Positions) -> Floats:
        return np.asarray(
            np.linalg.norm(places, axis=-1) - 0.8 - 0.04 * np.sin(9.0 * places).sum(axis=-1)
        )

    step = 2.2 / 43
    places = np.stack(np.meshgrid(*3 * [np.linspace(-1.1, 1.1, 44)], indexing="ij"), axis=-1)
    noise = 0.3 * step * np.random.default_rng(3).normal(size=places.shape[:3])
    corners, faces = isosurface(-bumpy(places) - noise, step, -1.1)
    middles = corners[faces].mean(axis=1)
    slopes = [bumpy(middles + 1e-4 * axis) - bumpy(middles - 1e-4 * axis) for axis in np.eye(3)]
    normals = np.stack(slopes, axis=1) / np.linalg.norm(slopes, axis=0)[:, None]
    made = Scan(corners, faces, normals, lambda moved: np.abs(bumpy(moved)))
    result, choice = denoise_automatically(corners, faces)
    assert choice.kind == "fused" and not choice.reliable
    assert made.angle(result) < 5.0 and made.rms(result) < 0.5 * made.rms(corners)


def test_surfaces_of_fields_without_noise_stay() -> None:
    pytest.importorskip("vtkmodules")
    places = np.stack(np.meshgrid(*3 * [np.linspace(-1.2, 1.2, 50)], indexing="ij"), axis=-1)
    for field in (np.linalg.norm(places, axis=-1) - 1.0, np.abs(places @ AWAY).max(axis=-1) - 0.6):
        corners, faces = isosurface(-field, 1.0, 0.0)
        assert lattice_step(corners) == pytest.approx(1.0, rel=1e-4)
        result, choice = denoise_automatically(corners, faces)
        assert choice.kind == "none" and (result == corners).all()


def test_a_lattice_is_known_by_its_lines_and_not_when_it_is_turned() -> None:
    random = np.random.default_rng(4)
    on = random.integers(0, 20, (4000, 3)).astype(np.float64)
    on[np.arange(4000), random.integers(0, 3, 4000)] += random.random(4000)
    assert lattice_step(0.3 * on + [1.0, 2.0, 3.0]) == pytest.approx(0.3, rel=1e-4)
    assert not lattice_step(on @ AWAY.T)
    assert not lattice_step(on + 0.1 * random.random((4000, 3)))
    assert not lattice_step(grid(60)[0])


@pytest.mark.parametrize("camera", CAMERAS)
@pytest.mark.parametrize("shape", [cube, sphere])
def test_the_eye_is_found_wherever_the_scan_is_put(shape, camera: str) -> None:  # type: ignore[no-untyped-def]
    made = scan(shape, camera)
    found = find_view(
        7.0 * made.positions @ AWAY.T + [3.0, 4.0, 5.0], probe_of(made.positions, made.faces)
    )
    assert (
        found is not None
        and np.linalg.norm(found.eye - [3.0, 4.0, 5.0]) < 7.0 * 0.03 * CAMERAS[camera].far
    )


@pytest.mark.parametrize(
    ("camera", "stepped"), [("structured light", True), ("time of flight", False)]
)
def test_depths_in_steps_are_known_in_the_frame_of_the_camera(camera: str, stepped: bool) -> None:
    made = scan(cube, camera)
    found = find_view(made.positions, probe_of(made.positions, made.faces))
    assert found is not None and found.stepped == stepped
    turned = find_view(made.positions @ AWAY.T, probe_of(made.positions, made.faces))
    assert turned is not None and not turned.stepped


def test_rounded_depths_are_known_as_steps() -> None:
    """Millimeters are steps of the depth itself, not of its inverse."""
    made = scan(sphere, "time of flight")
    depth = made.positions[:, 2:]
    rounded = made.positions * np.round(depth, 3) / depth
    found = find_view(rounded, probe_of(rounded, made.faces))
    assert found is not None and found.stepped


def test_closed_meshes_and_grids_that_fold_are_no_views() -> None:
    for shape in (cube, sphere):
        clean, faces = shape(20)
        assert find_view(clean, probe_of(clean, faces)) is None
    sheet, faces = grid(30)
    sheet[:, 0] = np.abs(sheet[:, 0] - sheet[:, 0].mean())
    assert find_view(sheet, probe_of(sheet, faces)) is None


def test_flattening_moves_along_the_rays_and_keeps_creases() -> None:
    roof, faces = grid(40)
    roof[:, :2] -= roof[:, :2].mean(axis=0)
    roof[:, 2] = 200.0 - 0.7 * np.abs(roof[:, 0])
    topology = Topology(faces, len(roof))
    camera = View(np.zeros(3), np.array([0.0, 0.0, 1.0]), 0.3)
    noisy = roof * (1.0 + np.random.default_rng(0).normal(0.0, 0.3 / 200.0, (len(roof), 1)))
    flat = camera.flattened(noisy, topology, 1.0)
    assert np.abs(np.cross(flat, noisy)).max() < 1e-6 * 200.0**2
    assert np.linalg.norm(flat - roof) < 0.35 * np.linalg.norm(noisy - roof)
    ridge = np.abs(roof[:, 0]) < 1.0
    assert np.linalg.norm((flat - roof)[ridge]) < 0.6 * np.linalg.norm((noisy - roof)[ridge])


@pytest.mark.parametrize(
    ("shape", "camera"),
    [
        *((cube, camera) for camera in CAMERAS),
        pytest.param(sphere, "structured light", marks=pytest.mark.slow),
    ],
)
def test_noise_of_a_camera_is_taken_away_and_what_it_saw_without_noise_stays(
    shape, camera: str
) -> None:  # type: ignore[no-untyped-def]
    made = scan(shape, camera)
    result, choice = denoise_automatically(made.positions, made.faces)
    assert choice.kind == "view"
    assert made.angle(result) < 0.35 * made.angle(made.positions)
    assert made.rms(result) < 0.9 * made.rms(made.positions)
    clean = scan(shape, camera, noisy=False)
    assert not find(clean.positions, clean.faces).noisy
    assert (denoise_automatically(clean.positions, clean.faces)[0] == clean.positions).all()
