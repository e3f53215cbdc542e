"""Causes that the coordinates tell: binary volumes, depths in steps, noise along an axis; and their bounds."""

import numpy as np
import pytest

from bsm.codec.arrays import Faces, Floats, Positions
from bsm.codec.denoise.noise.causes import find_cells
from bsm.codec.denoise.surface import Topology
from tests.codec.denoise.denoise_shapes import cube, grid, sphere
from tests.shapes import theta
from tools.noise import denoise_automatically, gaussian_along_axis
from tools.sampled import THICK, ball, box, torus, voxelized
from tools.scans import turning


def volume(positions: Positions, faces: Faces) -> float:
    return float(np.linalg.det(positions[faces]).sum()) / 6.0


@pytest.mark.parametrize(
    ("field", "cells", "thick", "most"),
    [
        (ball, 40, 1.0, 2.5),
        (ball, 64, 1.0, 2.0),
        (torus, 60, 1.0, 3.0),
        (ball, 60, THICK, 6.0),
        (ball, 26, 4.0, 7.0),
    ],
)
def test_stairs_of_a_binary_volume_go_and_no_vertex_leaves_its_half_cell(
    field, cells, thick, most
) -> None:  # type: ignore[no-untyped-def]
    pytest.importorskip("vtkmodules")
    made = voxelized(field, cells, thick)
    step = 2.0 / (cells - 6)
    for goal in ("shading", "shape"):
        result, choice = denoise_automatically(made.positions, made.faces, goal)
        assert (
            choice.kind == "cells" and "along x, y and z" in choice.reason and not choice.reliable
        )
        assert (
            np.abs(result - made.positions)
            <= 0.5 * step * np.array([1.0, 1.0, thick]) * (1.0 + 1e-9)
        ).all()
        assert made.angle(made.positions) > 19.0 and made.angle(result) < most
        assert made.rms(result) < 0.6 * made.rms(made.positions)


def rods(places: Floats) -> Floats:
    """Crossing rods, five of them a side, whose gaps are narrower than a thick slice."""
    off = np.square(np.sin(7.0 * places @ turning(5)))
    inner = (
        np.sqrt(np.stack([off[..., 0] + off[..., 1], off[..., 1] + off[..., 2]], axis=-1)).min(
            axis=-1
        )
        - 0.5
    )
    return np.asarray(np.maximum(0.1 * inner, np.linalg.norm(places, axis=-1) - 1.0))


@pytest.mark.parametrize("thick", [1.0, 2.0, THICK, 10.0])
@pytest.mark.parametrize("field", [torus, rods, box(0.5, 0.4, 0.3), box(0.8, 0.5, 0.05)])
def test_slices_of_any_thickness_never_end_farther_from_the_truth(field, thick: float) -> None:  # type: ignore[no-untyped-def]
    pytest.importorskip("vtkmodules")
    made = voxelized(field, 70, thick)
    result, choice = denoise_automatically(made.positions, made.faces)
    assert choice.steps or (result == made.positions).all()
    assert made.angle(result) <= made.angle(made.positions) and made.rms(result) <= made.rms(
        made.positions
    )


@pytest.mark.parametrize("turned", [False, True])
def test_a_plate_of_five_cells_keeps_its_volume_and_its_edges(turned: bool) -> None:
    pytest.importorskip("vtkmodules")
    sides = np.array([24.5, 16.5, 2.5])
    flat = lambda places: (np.abs(places) - sides).max(axis=-1)  # noqa: E731
    made = voxelized(box(*sides) if turned else flat, 63, reach=28.5)
    result, choice = denoise_automatically(made.positions, made.faces)
    assert choice.kind == "cells"
    assert volume(result, made.faces) == pytest.approx(8.0 * sides.prod(), rel=0.03)
    assert made.angle(result) < 5.0


def test_cells_are_known_from_vertices_halfway_between_them_only() -> None:
    random = np.random.default_rng(4)
    halfway = random.integers(0, 20, (4000, 3)).astype(np.float64)
    halfway[np.arange(4000), random.integers(0, 3, 4000)] += 0.5
    alone = Topology(np.zeros((0, 3), np.int32), 4000)
    cells = find_cells(halfway * [0.3, 0.3, 1.2] + [1.0, 2.0, 3.0], alone)
    assert cells is not None and cells.steps == pytest.approx([0.3, 0.3, 1.2]) and cells.thick == 1
    assert find_cells(np.round(halfway), alone) is None
    assert find_cells(halfway + random.normal(0.0, 0.1, halfway.shape), alone) is None
    assert find_cells(np.round(2.0 * random.random((4000, 3)) * 20.0) / 2.0, alone) is None
    for clean, faces in (cube(30), sphere(20), grid(40)):
        assert find_cells(clean @ turning(2).T, Topology(faces, len(clean))) is None
        assert find_cells(clean, Topology(faces, len(clean))) is None


@pytest.mark.parametrize(
    ("thick", "most"), [(2.3, 6.0), (3.0, 6.0), (4.0, 6.0), (4.75, 8.0), (6.0, 8.0)]
)
def test_slices_that_were_stored_as_several_thin_ones_are_known(thick: float, most: float) -> None:
    pytest.importorskip("vtkmodules")
    made = voxelized(ball, 46, thick, copies=thick)
    cells = find_cells(made.positions, Topology(made.faces, len(made.positions)))
    assert cells is not None and cells.thick == pytest.approx(thick, rel=0.04)
    assert cells.flatness == pytest.approx(cells.thick)
    result, choice = denoise_automatically(made.positions, made.faces)
    assert f"slices, {cells.thick:.3g} cells thick" in choice.reason and not choice.reliable
    assert made.angle(result) < most and made.rms(result) < 0.5 * made.rms(made.positions)


def tray(places: Floats) -> Floats:
    """A wavy sheet, about one slice thick, with a thick rim on one side."""
    x, y, z = np.moveaxis(places, -1, 0)
    sheet = np.abs(z - 0.25 * np.sin(3.0 * x) - 0.2 * np.cos(4.0 * y)) - 0.07
    rim = np.maximum(np.abs(z) - 0.5, 0.6 - x)
    return np.asarray(
        np.maximum(np.minimum(sheet, rim), np.abs(places[..., :2]).max(axis=-1) - 0.9)
    )


def test_walls_of_one_slice_are_filtered_without_a_coarse_step_as_well() -> None:
    pytest.importorskip("vtkmodules")
    made = voxelized(tray, 60, 4.0)
    result, choice = denoise_automatically(made.positions, made.faces)
    assert {step.filter.hand_over for step in choice.steps} == {"bends", "positions", "none"}
    # Without that step it would be 1.12 times.
    assert made.angle(result) < 1.09 * made.angle(made.positions) and made.rms(result) < made.rms(
        made.positions
    )


def stairs(places: Floats) -> Floats:
    """A cube whose upper side rises in treads."""
    heights = np.floor(places[..., 0] / 0.3) * 0.3
    return np.asarray(np.maximum(np.abs(places).max(axis=-1) - 0.9, places[..., 2] - heights))


def terraces(places: Floats) -> Floats:
    """A cube with a round hill of terraces."""
    heights = -np.floor(np.linalg.norm(places[..., :2], axis=-1) / 0.25) * 0.3
    return np.asarray(np.maximum(np.abs(places).max(axis=-1) - 0.9, places[..., 2] - heights))


def test_stairs_and_terraces_that_somebody_built_are_not_slices() -> None:
    pytest.importorskip("vtkmodules")
    for field in (stairs, terraces):
        made = voxelized(field, 66)
        cells = find_cells(made.positions, Topology(made.faces, len(made.positions)))
        assert cells is not None and cells.thick == 1
        result, _ = denoise_automatically(made.positions, made.faces)
        assert np.abs(result - made.positions).max() <= 0.5 * 2.0 / 60 * (1.0 + 1e-9)


@pytest.mark.parametrize(("thick", "most"), [(1.0, 2.5), (6.0, 9.0)])
def test_volumes_are_known_whichever_way_they_are_turned(thick: float, most: float) -> None:
    pytest.importorskip("vtkmodules")
    made, turn = voxelized(ball, 42, thick), turning(11)
    for turned in (
        made.positions @ turn.T + 3.0,
        (made.positions @ turn.T).astype(np.float32).astype(np.float64),
    ):
        result, choice = denoise_automatically(turned, made.faces)
        assert choice.kind == "cells" and "along axes of its own" in choice.reason
        moves = np.abs((result - turned) @ turn)
        assert (moves <= 0.5 * 2.0 / 36 * np.array([1.0, 1.0, thick]) * (1.0 + 1e-4)).all()
        assert made.angle((result - turned) @ turn + made.positions) < most


@pytest.mark.parametrize("shape", [cube, sphere])
def test_noise_along_an_axis_goes_along_it(shape) -> None:  # type: ignore[no-untyped-def]
    clean, faces = shape(20)
    axis = np.array([0.0, 1.0, 0.0])
    noisy = gaussian_along_axis(clean, faces, 0.3, 5, tuple(axis))
    result, choice = denoise_automatically(noisy, faces)
    assert choice.kind == "axis" and "(0.00, 1.00, 0.00)" in choice.reason
    assert np.abs((result - noisy)[:, [0, 2]]).max() < 1e-12
    assert theta(clean, result, faces) < (0.15 if shape is cube else 0.3) * theta(
        clean, noisy, faces
    )
