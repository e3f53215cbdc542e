"""Grids that are predicted from congruent parts: transforms are found, pay, and come back."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

import bsm
from bsm import (
    PRESETS,
    Contract,
    CorruptError,
    EncodeOptions,
    Encoder,
    Target,
    TriangleMesh,
    TruncatedError,
    decode,
    encode,
    look,
)
from bsm.codec.geometry.turns import UNTURNED
from bsm.codec.static.choice.bounds import Bounds, Measures
from bsm.codec.static.choice.congruence import coded_transforms, lattice, planes_of, transforms_of
from bsm.codec.static.choice.grids import (
    Frame,
    Gridded,
    _rounded,
    grid_draft,
    paying,
    repeating,
    rounded,
)
from bsm.codec.static.preamble_encoding import Draft, Prepared
from bsm.codec.static.ways.grid import SAMPLE, Raster, encode_grid, grid_of, sampled_size
from tests.refined import header_of
from tools.surgery import with_header
from tools.vectors.meshes import together, torus


def about(axis: int, parts: int) -> np.ndarray:
    """A turn about an axis by a part of the circle."""
    angle, (i, j) = 2.0 * np.pi / parts, ((1, 2), (2, 0), (0, 1))[axis]
    turn = np.eye(3)
    turn[i, i] = turn[j, j] = np.cos(angle)
    turn[j, i], turn[i, j] = np.sin(angle), -np.sin(angle)
    return turn


def mirrors() -> np.ndarray:
    """Mirrors along each axis."""
    return np.array(
        [np.diag([-1.0, 1.0, 1.0]), np.diag([1.0, -1.0, 1.0]), np.diag([1.0, 1.0, -1.0])]
    )


def bumpy(seed: int, rows: int = 24, columns: int = 18) -> TriangleMesh:
    """A torus with noise, which has no congruent parts."""
    mesh = torus(rows, columns)
    noise = np.random.default_rng(seed).normal(0.0, 0.05, mesh.positions.shape)
    return TriangleMesh(mesh.positions + noise, mesh.faces)


def copies(mesh: TriangleMesh, turns: np.ndarray, apart: float = 20.0) -> TriangleMesh:
    """A mesh, and its images by turns, apart from it."""
    moved = [
        TriangleMesh(mesh.positions @ turn.T + [apart * (k + 1), 0.0, 0.0], mesh.faces)
        for k, turn in enumerate(turns)
    ]
    return together(mesh, *moved)


def prepared_of(mesh: TriangleMesh, bits: int) -> Prepared:
    return Encoder(mesh, EncodeOptions(grid=bits, congruence=True))._input.prepared


def coded(prepared: Prepared, bits: int) -> tuple[Draft, Draft]:
    """A grid of so many bits, without and with congruent parts."""
    grid, places = _rounded(prepared, bits=bits)
    return rounded(prepared, bits), repeating(
        prepared, grid, places, grid_draft(prepared, grid, places, True)
    )


def version_of(data: bytes) -> int:
    return data[4]


@pytest.mark.parametrize(
    "turn", [mirrors()[0], about(2, 4), about(1, 7), about(0, 5) @ mirrors()[2]]
)
def test_copies_cost_little(turn):
    mesh = copies(bumpy(1), np.array([turn, turn @ turn]))
    plain, both = (b"".join(draft.frames) for draft in coded(prepared_of(mesh, 15), 15))
    assert len(both) < 0.75 * len(plain), "two of three parts are images of the first"
    assert version_of(both) == 17 and version_of(plain) == 16
    assert header_of(both).transforms > 0 and header_of(plain).congruence == 0
    assert (decode(both).positions == decode(plain).positions).all()
    assert (decode(both).faces == decode(plain).faces).all()


def test_a_mesh_without_congruent_parts_is_coded_as_by_1_0():
    plain, both = coded(prepared_of(bumpy(13), 14), 14)
    assert both.header == plain.header and both.body == plain.body


def test_transforms_that_do_not_pay_are_left_out():
    small = bumpy(7, 5, 4)
    few = copies(
        TriangleMesh(0.3 * small.positions + [0.0, 8.0, 0.0], small.faces),
        np.array([about(1, 7)]),
        6.0,
    )
    mesh = together(copies(bumpy(1), mirrors()[:1]), few)
    prepared = prepared_of(mesh, 8)
    _, both = coded(prepared, 8)
    some = paying(prepared, both)
    assert some.size < both.size and 0 < some.header.transforms < both.header.transforms
    assert (decode(b"".join(some.frames)).positions == both.decoded).all()


def test_quick_streams_are_also_predicted_from_congruent_parts():
    mesh = copies(bumpy(5), mirrors()[:1])
    less, more = (
        encode(mesh, EncodeOptions(effort="quick", congruence=both)) for both in (True, False)
    )
    assert header_of(less).light == header_of(more).light == 1 and header_of(less).transforms > 0
    assert len(less) < 0.7 * len(more)
    assert look(mesh, decode(less)).distance <= 1.0
    alone = EncodeOptions(effort="quick")
    assert version_of(encode(bumpy(5), alone)) == 16


def test_grids_that_are_asked_for_are_coded_as_by_1_0():
    mesh = copies(bumpy(5), mirrors()[:1])
    for options in (EncodeOptions(grid=12), EncodeOptions(exact=True)):
        assert encode(mesh, replace(options, congruence=True)) == encode(
            mesh, replace(options, congruence=False)
        )
    assert [version_of(encode(mesh, EncodeOptions(congruence=both))) for both in (True, False)] == [
        17,
        16,
    ]


def test_a_size_is_spent_on_what_congruent_parts_save():
    mesh = copies(bumpy(6), mirrors()[:1])
    target = EncodeOptions(target=Target("size", 2200.0), contract=None)
    less, more = (
        Encoder(mesh, replace(target, congruence=both)).result() for both in (False, True)
    )
    assert more.size <= 2200 and more.header.congruence > 0
    assert more.comparison.theta_deg < 0.9 * less.comparison.theta_deg


@pytest.mark.parametrize(
    "mesh", [copies(bumpy(6), mirrors()[:1]), bumpy(9, 40, 24)], ids=["two", "one"]
)
def test_the_best_stream_of_a_size_looks_as_good_as_the_promise_of_that_size(mesh):
    usual = encode(mesh)
    best = encode(mesh, replace(PRESETS["none"], target=Target("size", float(len(usual)))))
    assert len(best) <= len(usual)
    assert look(mesh, decode(best)).distance <= 1.2 * look(mesh, decode(usual)).distance


def test_the_search_finds_a_turn():
    prepared = Encoder(
        copies(bumpy(3), np.array([about(1, 7)])), EncodeOptions(grid=12)
    )._input.prepared
    positions = prepared.mesh.positions
    low, extent = positions.min(axis=0), np.ptp(positions, axis=0)
    step = float(extent.max()) / 4095
    rows = transforms_of(
        prepared, Raster(tuple(low), step, tuple(np.rint(extent / step).astype(int).tolist()))
    )
    ((*turn, x, y, z, _),) = next(iter(prepared.motions.values()))
    assert len(rows) == 1 and rows[0, 0] >= 48
    images = positions @ np.reshape(turn, (3, 3)).T + (x, y, z)
    assert (cKDTree(positions).query(images)[0] < 0.01 * step).mean() == 0.5


@given(st.integers(0, 2**32 - 1), st.integers(1, 2**20 - 1))
@settings(max_examples=50, deadline=None)
def test_transforms_are_coded_as_near_as_they_can_be(seed, cells):
    numbers = np.random.default_rng(seed)
    turn = np.linalg.qr(numbers.normal(size=(3, 3)))[0]
    middle = np.full(3, cells / 2.0)
    (row,) = coded_transforms(turn[None], (middle - turn @ middle)[None], [cells] * 3)
    assert (row >= 0).all()
    if row[0] < 48:
        return
    fine = 1 << min(cells.bit_length() + 2, 19)
    quaternion = np.insert((row[2:5] - fine).astype(float), row[1], fine)
    a, b, c, d = quaternion / np.linalg.norm(quaternion)
    coded = np.array([
        [a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)],
        [2 * (b * c + a * d), a * a - b * b + c * c - d * d, 2 * (c * d - a * b)],
        [2 * (b * d - a * c), 2 * (c * d + a * b), a * a - b * b - c * c + d * d],
    ]) * (-1.0 if row[0] == 49 else 1.0)  # fmt: skip
    shift = (row[5:] - 12.0 * cells) / 4.0
    assert np.abs(coded @ middle + shift - middle).max() <= 0.5
    assert np.abs(coded - turn).max() <= 4.0 / fine


def test_transforms_that_are_missing_are_refused():
    data = b"".join(coded(prepared_of(copies(bumpy(4), mirrors()[:1]), 11), 11)[1].frames)
    assert header_of(data).transforms == 1
    for count in {35, 37, 38, 51, 52, 54, 68}:
        with pytest.raises((CorruptError, TruncatedError)):
            decode(with_header(data, congruence=count))


def test_streams_and_their_estimates_have_whole_vertices():
    mesh = copies(bumpy(8, 48, 30), mirrors()[:1])
    draft = coded(prepared_of(mesh, 12), 12)[1]
    prepared = Encoder(mesh, EncodeOptions(grid=12))._input.prepared
    faces, places, grid = prepared.mesh.faces, draft.places, grid_of(draft.header)
    assert places is not None and len(places) > SAMPLE
    whole = replace(grid, transforms=transforms_of(prepared, grid))
    split = replace(whole, whole=False)
    assert whole.congruence == draft.header.congruence == split.congruence + 17
    assert next(encode_grid(faces, whole, places)) in draft.body
    assert {"congruence", "whole"} <= set(bsm.info(b"".join(draft.frames))["extensions"])
    less, more = (sampled_size(faces, either, places) for either in (whole, split))
    assert less < more


def test_vertices_are_split_where_that_takes_fewer_bytes():
    side = np.arange(33) / 16.0 - 1.0
    x, y = np.tile(side, 33), np.repeat(side[::-1], 33)
    corners = np.arange(33 * 33).reshape(33, 33)
    a, b, c, d = (
        part.ravel()
        for part in (corners[:-1, :-1], corners[1:, :-1], corners[1:, 1:], corners[:-1, 1:])
    )
    faces = np.stack([a, b, c, a, c, d], axis=1).reshape(-1, 3).astype(np.int32)
    prepared = prepared_of(
        TriangleMesh(np.stack([x, y, 0.3 * np.cos(2.0 * x) * np.cos(3.0 * y)], axis=1), faces), 8
    )
    whole = coded(prepared, 8)[1]
    split = paying(prepared, whole)
    assert whole.header.whole and split.header.transforms > 0 and not split.header.whole
    assert split.size < 0.9 * whole.size
    assert (decode(b"".join(split.frames)).positions == whole.decoded).all()


def test_vertices_go_to_images_that_are_near():
    """A decoder has the places to which they went; none went farther than it may, or away from its faces."""
    mesh = copies(bumpy(8), np.array([about(1, 7)]))
    prepared = prepared_of(mesh, 9)
    _, both = coded(prepared, 9)
    grid = replace(grid_of(both.header), transforms=transforms_of(prepared, grid_of(both.header)))
    where = (prepared.mesh.positions - grid.origin) / grid.step
    sizes = []
    for cells in (0.0, 4.0):
        wanted = np.column_stack([where, np.full(len(where), cells**2)])
        draft = grid_draft(prepared, grid, both.places, True, wanted)
        moved = (draft.places != both.places).any(axis=1)
        away = np.linalg.norm(draft.places - where, axis=1)
        assert (away[moved] <= cells).all() and moved.any() == (cells > 0.0)
        assert (decode(b"".join(draft.frames)).positions == draft.decoded).all()
        sizes.append(draft.size)
    assert sizes[0] == both.size and sizes[1] < 0.95 * sizes[0]


@pytest.mark.parametrize("sectors", [5, 6, 8])
def test_a_part_of_equal_sectors_costs_little_more_than_one(sectors):
    """Wherever the grid lies: its step and origin follow the turns that it can follow, vertices the others."""
    flat = bumpy(4, 12, 9)
    flat = TriangleMesh(0.2 * flat.positions + np.array([2.0, 0.0, 0.0]), flat.faces)
    turns = [np.linalg.matrix_power(about(2, sectors), k) for k in range(sectors)]
    positions = np.concatenate([flat.positions @ turn.T for turn in turns])
    faces = np.concatenate([flat.faces + k * len(flat.positions) for k in range(sectors)])
    for away in (0.0, 0.1234):
        sizes = [
            len(encode(TriangleMesh(part.positions + away, part.faces)))
            for part in (flat, TriangleMesh(positions, faces))
        ]
        assert sizes[1] < 2.0 * sizes[0]


def test_vertices_of_still_grids_do_not_go_to_images():
    prepared = Encoder(copies(bumpy(1), np.array([about(2, 7), about(2, 5)])))._input.prepared
    frame = Frame(prepared, Bounds(Measures(prepared, 1), Contract(0.01, look=1.0)))
    usual = Gridded("grid", frame).at(frame.first)
    moved = Gridded("images", frame, images=True, going=True).at(frame.first)
    still = Gridded("images, none moved", frame, images=True).at(frame.first)
    assert (still.positions == usual.positions).all() and (moved.positions != usual.positions).any()
    assert (
        moved.draft.size < still.draft.size < usual.draft.size and still.draft.header.transforms > 0
    )


def test_steps_divide_shifts_that_repeat():
    small = bumpy(2, 12, 9)
    row = copies(small, np.array([np.eye(3)] * 4), 7.77)
    prepared = prepared_of(row, 10)
    step = float(np.ptp(row.positions, axis=0).max()) / 1100
    found, origin = lattice(prepared, row.positions.min(axis=0), step, 0.0, UNTURNED, [])
    assert abs(math.log(found / step)) <= 0.016 and found == float(np.float32(found))
    cells = (row.positions[len(small.positions)] - row.positions[0])[0] / found
    assert abs(cells - round(cells)) < 0.05
    assert (origin <= row.positions.min(axis=0)).all()
    alone = prepared_of(bumpy(13), 10)
    low = alone.mesh.positions.min(axis=0)
    held, kept = lattice(alone, low, float(np.float32(0.01)), 0.0, UNTURNED, [])
    assert held == float(np.float32(0.01)) and (kept == low).all(), (
        "without symmetries nothing moves"
    )


def plates(at: tuple[float, ...]) -> TriangleMesh:
    """Bumpy sheets between planes at right angles to x, on which their long sides lie."""
    rng, rows = np.random.default_rng(5), 24
    positions, faces = [], []
    for number, x in enumerate(at):
        y, z = np.full(rows, 0.31 * number + 0.1234), np.linspace(0.0, 4.0, rows)
        ends = np.column_stack([np.full(rows, x), y, z])
        middle = np.column_stack([np.full(rows, x + 0.3), y + 0.2, z]) + rng.normal(
            0.0, 0.03, (rows, 3)
        )
        positions.append(np.concatenate([ends, middle]))
        first, second = (
            np.arange(rows - 1) + 2 * rows * number,
            np.arange(rows - 1) + 2 * rows * number + rows,
        )
        faces += [
            np.column_stack([first, second, first + 1]),
            np.column_stack([first + 1, second, second + 1]),
        ]
    return TriangleMesh(np.concatenate(positions), np.concatenate(faces).astype(np.int32))


def test_planes_are_where_the_longest_edges_lie():
    mesh = plates((0.0, 0.777, 2.345))
    along, across, up = planes_of(mesh.positions, mesh.faces)
    assert np.allclose(np.sort(along[:3, 0]), (0.0, 0.777, 2.345)) and np.allclose(
        along[:3, 1], 1.0, atol=0.02
    )
    assert np.allclose(np.sort(across[:3, 0]), 0.1234 + 0.31 * np.arange(3))
    assert np.allclose(across[:3, 1], 1.0, atol=0.02)
    assert up[:, 1].sum() < 0.2, "edges are level by chance alone"
    assert [len(found) for found in planes_of(bumpy(13).positions, bumpy(13).faces)] == [0, 0, 0]


@pytest.mark.parametrize("at", [(0.0, 0.777, 2.345), (0.1, 1.0, 1.9031), (0.0, 1.2347)])
def test_planes_come_to_lie_at_places(at: tuple[float, ...]):
    mesh = plates(at)
    prepared, low, step = prepared_of(mesh, 10), mesh.positions.min(axis=0), 0.0123
    planes = planes_of(mesh.positions, mesh.faces)

    def off(held: float, origin: np.ndarray) -> float:
        cells = (np.array(at) - origin[0]) / held
        return float(np.abs(cells - np.rint(cells)).max())

    found, origin = lattice(prepared, low, step, 0.0, UNTURNED, planes)
    assert off(found, origin) < 0.13 < off(*lattice(prepared, low, step, 0.0, UNTURNED, []))
    assert (
        abs(math.log(found / step)) <= 0.016
        and (origin <= low).all()
        and (origin > low - found).all()
    )
