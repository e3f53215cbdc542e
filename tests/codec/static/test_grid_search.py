"""Grids: what tells which is smallest, and that it is found."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from bsm import PRESETS, EncodeOptions, Encoder, TriangleMesh, decode, encode, read_mesh
from bsm._core import Field
from bsm.account.comparison import in_order_of
from bsm.codec.geometry.metrics import Original, face_normals, folded_edges
from bsm.codec.static.choice.bounds import Bounds
from bsm.codec.static.choice.shaping import Shaper
from bsm.codec.static.choice.table import ways_of
from bsm.codec.static.preamble_encoding import join
from bsm.codec.static.ways.grid import grid_field
from tests.blocks import graph_of
from tests.codec.static.test_presets import PROMISING
from tests.shapes import curved, grid_faces, patch, together


def box(cells: int, lines: int, seed: int = 0) -> TriangleMesh:
    """The surface of a cube, cut by lines at whole multiples of a cell, more of them than fit a coarser grid."""
    random = np.random.default_rng(seed)
    at = (
        np.sort(
            np.concatenate([[0, cells], 1 + random.choice(cells - 1, lines - 2, replace=False)])
        )
        / cells
    )
    u, v = (axis.ravel() for axis in np.meshgrid(at, at, indexing="ij"))
    faces, count = grid_faces(lines, lines), lines * lines
    sides = [np.stack([u, v, np.full_like(u, side)], -1) for side in (0.0, 1.0)]
    positions = np.concatenate([np.roll(side, axis, axis=1) for axis in range(3) for side in sides])
    apart = TriangleMesh(positions, np.concatenate([faces + number * count for number in range(6)]))
    return join(apart, keep=False).mesh


@pytest.mark.parametrize("preset", PROMISING)
def test_the_grid_that_a_model_was_made_on_is_found(preset: str) -> None:
    mesh = box(255, 24)
    draft = Encoder(mesh, PRESETS[preset]).draft()
    assert draft.header.grid
    assert draft.size <= 1.2 * len(encode(mesh, EncodeOptions(grid=8)))
    flat = patch(29, 29)
    about = np.random.default_rng(1).uniform(-2e-4, 2e-4, flat.positions.shape) + flat.positions / (
        1,
        1.3,
        1,
    )
    assert len(encode(replace(flat, positions=about * (1, 1, 0)), PRESETS[preset])) < 100


@pytest.mark.real
def test_it_is_found_however_much_coarser_a_grid_would_do(meshes: Path) -> None:
    mesh = read_mesh(str(meshes / "static" / "twelve_dodecahedron.ply")).mesh
    sizes = [len(encode(mesh, PRESETS[preset])) for preset in ("balanced", "fine", "grid14")]
    assert sizes[0] <= 1.01 * sizes[1] < sizes[2]


def test_faces_that_rounding_turns_over_are_turned_back_within_reach() -> None:
    mesh = curved(patch(24, 24))
    random = np.random.default_rng(3)
    slivers = mesh.positions + random.uniform(-0.45, 0.45, mesh.positions.shape) * (1, 1, 0) / 24
    original, step = Original(slivers, mesh.faces), 1 / 30
    shaper = Shaper(original, graph_of(mesh))

    def over(places: np.ndarray) -> int:
        turned = face_normals(places * step, mesh.faces) * original.normals
        return int(np.count_nonzero(turned.sum(axis=1) < 0))

    rounded = np.rint(slivers / step).astype(np.int32)
    directions, reach = step * np.eye(3).reshape(1, 9), np.full(len(slivers), 1.5 * step)
    better = shaper.unfold(rounded * step, rounded, directions, reach)
    assert better is not None and over(better) < over(rounded) / 4
    assert np.linalg.norm(better * step - slivers, axis=1).max() <= 1.5 * step
    none = np.zeros(len(slivers))
    nearer = shaper.unfold(rounded * step, rounded, directions, none)
    away = np.linalg.norm(rounded * step - slivers, axis=1)
    assert nearer is None or (np.linalg.norm(nearer * step - slivers, axis=1) <= away + 1e-12).all()
    assert shaper.unfold(slivers, rounded, directions, reach) is None, "nothing is turned over"


def slivers(size: int) -> TriangleMesh:
    """A bent patch whose vertices are moved along it by almost half an edge."""
    mesh = curved(patch(size, size))
    moved = np.random.default_rng(4).uniform(-0.48, 0.48, mesh.positions.shape) * (1, 1, 0) / size
    return replace(mesh, positions=mesh.positions + moved)


def test_mending_of_folds_moves_vertices_by_few_steps() -> None:
    """Farther ones would stand out as spikes, also from sides that the measure of the look does not use."""
    mesh = slivers(40)
    off = np.linalg.norm(in_order_of(mesh, decode(encode(mesh))) - mesh.positions, axis=1)
    assert off.max() < 12 * np.median(off)


def lost(mesh: TriangleMesh) -> int:
    """How many faces have no area."""
    a, b, c = (mesh.positions[corner] for corner in mesh.faces.T)
    sides = np.stack([b - a, c - b, a - c])
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    return int(np.count_nonzero(areas <= 1e-9 * np.square(sides).sum(axis=2).max(axis=0)))


@pytest.mark.parametrize(
    "options", [EncodeOptions(), EncodeOptions(effort="quick"), PRESETS["small"]]
)
def test_faces_keep_their_areas(options: EncodeOptions) -> None:
    mesh = slivers(40)
    cells = (mesh.positions - mesh.positions.min(axis=0)) * 60.0
    assert lost(mesh) == 0 and lost(replace(mesh, positions=np.rint(cells))) > 5
    decoded = decode(encode(mesh, options))
    assert lost(decoded) == 0
    assert len(np.unique(decoded.positions, axis=0)) == len(mesh.positions)
    # Two come over 90 degrees, but not over 100.
    most = folded_edges(mesh.positions, mesh.faces) + 1 + 2
    assert folded_edges(decoded.positions, decoded.faces) <= most


def test_folds_are_mended_where_vertices_go_to_images() -> None:
    one = slivers(20)
    mesh = together(one, replace(one, positions=one.positions + np.array([1.5, 0.25, 0.0])))
    encoder = Encoder(mesh, EncodeOptions(threads=1))
    sent = encoder._input
    bounds = Bounds(sent.measures, encoder.options.promise)
    way = ways_of(sent.prepared, bounds, encoder.options)[0]
    assert way.name == "images"
    shaper, trial = sent.measures.shaper, way.at(4.0 * way.first)
    mended = way.mended(trial)
    assert mended is not None and mended.step == trial.step
    assert shaper.more_folds(trial.positions) > 0
    assert shaper.more_folds(mended.positions) <= 0
    assert mended.draft.size < 1.3 * trial.draft.size


@pytest.mark.real
@pytest.mark.parametrize("name", ["assets/robot_forearm.obj", "assets/ADIS16480.STL"])
def test_hardly_any_face_of_a_part_loses_its_area(meshes: Path, name: str) -> None:
    mesh = join(read_mesh(meshes / name).mesh.bare, keep=False).mesh
    decoded = decode(encode(mesh))
    assert lost(decoded) <= lost(mesh) + len(mesh.faces) // 200


def fan(positions: np.ndarray) -> tuple[Field, np.ndarray, np.ndarray]:
    """A begun field on a fan of triangles around the first vertex, rounded places, and what is wanted."""
    count = len(positions)
    around = np.arange(1, count)
    faces = np.column_stack([np.zeros(count - 1, np.int64), around, np.roll(around, -1)]).astype(
        np.int32
    )
    field = grid_field(faces, (9, 9, 9), np.zeros((count, 3), np.int32))
    return (
        field,
        np.rint(positions).astype(np.int32),
        np.column_stack([positions, np.full(count, 4.0)]),
    )


def test_the_nearest_cell_without_faults_is_taken() -> None:
    positions = np.array(
        [[4.4, 4.2, 0.0], [0.0, 4.0, 0.0], [4.0, 0.0, 0.0], [8.0, 4.0, 0.0], [4.4, 4.45, 0.0]]
    )
    field, places, wanted = fan(positions)
    assert (places[0] == [4, 4, 0]).all() and (places[4] == [4, 4, 0]).all(), (
        "two faces have no area there"
    )
    mended = field.mended(places, np.array([9, 9, 9], np.int32), wanted)
    a, b, c = (mended[np.array(corner)] for corner in ((0, 0, 0, 0), (1, 2, 3, 4), (2, 3, 4, 1)))
    assert (np.cross(b - a, c - a) != 0).any(axis=1).all()
    assert np.abs(mended - places).sum() == 1, "one vertex moved by a cell"
    tight = np.column_stack([positions, np.square(np.abs(positions - places)).sum(axis=1)])
    assert (field.mended(places, np.array([9, 9, 9], np.int32), tight) == places).all(), (
        "none may come farther"
    )
    flat = np.column_stack([places.astype(np.float64), np.full(5, 4.0)])
    assert (field.mended(places, np.array([9, 9, 9], np.int32), flat) == places).all(), (
        "there was no area before"
    )


@pytest.mark.real
@pytest.mark.parametrize(
    "name", ["assets/robot_link5.obj", "assets/cloth.obj", "assets/stirrer.obj"]
)
def test_few_edges_are_folded_over(meshes: Path, name: str) -> None:
    mesh = join(read_mesh(meshes / name).mesh.bare, keep=False).mesh
    decoded = in_order_of(mesh, decode(encode(mesh, EncodeOptions())))
    shaper = Shaper(Original(mesh.positions, mesh.faces), graph_of(mesh))
    assert shaper.more_folds(decoded) <= -(-len(mesh.faces) // 4_000)


@pytest.mark.parametrize(
    ("before", "after", "folded"),
    [
        (89, 95, 0),
        (95, 92, 0),
        (89, 105, 1),
        (0, 175, 1),
        (95, 80, 0),
        (105, 115, 0),
        (105, 125, 1),
        (125, 155, 1),
    ],
)
def test_folds_are_counted_from_100_120_and_150_degrees_on(
    before: float, after: float, folded: int
) -> None:
    faces = np.array([[0, 1, 2], [0, 2, 3]], np.int32)

    def bent(degrees: float) -> np.ndarray:
        up, across = np.sin(np.radians(degrees)), np.cos(np.radians(degrees))
        return np.array([[0, 0, 0], [1, -1, 0], [2, 0, 0], [1, across, up]], np.float64)

    shaper = Shaper(Original(bent(before), faces), graph_of(TriangleMesh(bent(before), faces)))
    assert shaper.more_folds(bent(after)) == folded
    assert len(shaper.over(bent(after))) == 4 * folded
    assert shaper.more_folds(bent(before)) == 0


FOLDED = np.cos(np.radians([100, 120, 150]))


def folds(mesh: TriangleMesh) -> np.ndarray:
    """Count the edges between two faces that are folded by more than 100, 120 and 150 degrees."""
    ends = np.sort(
        np.concatenate([mesh.faces[:, [0, 1]], mesh.faces[:, [1, 2]], mesh.faces[:, [2, 0]]]),
        axis=1,
    )
    owners = np.tile(np.arange(len(mesh.faces)), 3)
    order = np.lexsort(ends.T)
    starts = np.flatnonzero(np.diff(ends[order], axis=0, prepend=-1).any(axis=1))
    pairs = starts[np.diff(starts, append=len(order)) == 2]
    normals = face_normals(mesh.positions, mesh.faces)
    cosines = (normals[owners[order[pairs]]] * normals[owners[order[pairs + 1]]]).sum(axis=1)
    return np.asarray((cosines[:, None] < FOLDED).sum(axis=0))


@pytest.mark.real
@pytest.mark.parametrize("preset", ["small", "balanced", "fine", "near-lossless"])
@pytest.mark.parametrize("name", ["nicolo", "gargoyle_10002", "julius_36201"])
def test_scans_have_no_more_folds_than_before(meshes: Path, name: str, preset: str) -> None:
    mesh = join(read_mesh(meshes / "static" / f"{name}.ply").mesh.bare, keep=False).mesh
    more = folds(decode(encode(mesh, PRESETS[preset]))) - folds(mesh)
    assert more.max() <= 2e-5 * 1.5 * len(mesh.faces)
