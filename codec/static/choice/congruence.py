"""Rigid and mirrored transforms that take parts of a mesh to others: found, and as a grid codes them. Encoder only."""

import math

import numpy as np
import numpy.typing as npt

from bsm._core import codec as _kernels
from bsm._core.bitstream import constant
from bsm.codec.arrays import Faces, Levels, Matrix
from bsm.codec.geometry.mesh import extent_of, squares_of
from bsm.codec.geometry.turns import Turn, cross_of, quaternion_of, turned_by
from bsm.codec.static.preamble_encoding import Prepared
from bsm.codec.static.targets import SLACK
from bsm.codec.static.ways.grid import Raster

WORTH = 16.0  # vertices that a transform must explain
FINER = 0.5  # over the step of a grid: vertices that are not rounded are nearer to their images


def transforms_of(prepared: Prepared, grid: Raster) -> Levels:
    """The transforms of a mesh on a grid, shape (k, 8), as they are coded; sought once for like steps."""
    turns, shifts, _ = motions_of(prepared, grid.step, grid.turn)
    origin = np.array(grid.origin)
    shifts_in_cells = (turns @ origin + shifts - origin) / grid.step
    return coded_transforms(turns, shifts_in_cells, grid.largest)


def planes_of(positions: Matrix, faces: Faces) -> list[Matrix]:
    """Places on each axis of the longest edges at right angles to it, and their lengths over the extent: (k, 2)."""
    extent = float(extent_of(positions).max())
    noise = 1e-6 * extent
    begins = faces.reshape(-1)
    ends = np.roll(faces, 1, axis=1).reshape(-1)
    planes = []
    for axis in range(3):
        column = np.ascontiguousarray(positions[:, axis])
        values = column[begins]
        heights = np.abs(column[ends] - values)
        flat = np.flatnonzero(heights <= noise)
        values = values[flat]
        sides = positions[ends[flat]] - positions[begins[flat]]
        lengths = np.sqrt(squares_of(sides)) / extent
        planes.append(_longest_planes(values, lengths, noise))
    return planes


def _longest_planes(values: Matrix, lengths: Matrix, noise: float) -> Matrix:
    """Places of planes on an axis, shape (k, 2), with the sums of lengths of edges there, most first."""
    if not len(values):
        return np.empty((0, 2))
    order = np.argsort(values)
    values = values[order]
    distances = np.diff(values, prepend=-np.inf)
    starts = np.flatnonzero(distances > noise)
    sums = np.add.reduceat(lengths[order], starts)
    by_sum = np.argsort(-sums, kind="stable")
    longest = by_sum[:8]  # of axes with many, none fits well
    places = values[starts[longest]]
    return np.column_stack([places, sums[longest]])


def lattice(
    prepared: Prepared, origin: Matrix, step: float, least: float, turn: Turn, planes: list[Matrix]
) -> tuple[float, Matrix]:
    """The step of single precision near a wanted one, and the origin, at most a cell lower, for which transforms take
    most places to places, those that exchange axes or turn them back, all at once; and for which planes are at places:
    where a long edge moves, a row of samples changes, and a picture shows it."""
    nearness = np.linspace(-0.5, 0.5, 241)
    steps = np.maximum(step * np.exp(SLACK * nearness), least)
    steps = steps.astype(np.float32).astype(np.float64)
    origins = np.repeat(origin[None], len(steps), axis=0)
    score = -1e-6 * np.abs(nearness)
    rigid = _exchanges_of_axes(prepared, step, turn)
    is_open = _center(rigid, origins, steps)
    for axis, plane in enumerate(planes):
        if len(plane):
            score -= _off_planes(plane, axis, origins, steps, is_open=bool(is_open[axis]))
    for turned, shift, share in rigid:
        back = np.eye(3) - turned
        cells = (shift - origins @ back.T) / steps[:, None]
        off = off_whole(cells).max(axis=1)
        # What a vertex has moved by, other images see.
        loss = np.square(16.0 * off)
        score += share * np.maximum(0.0, 1.0 - loss)
    best = int(score.argmax())
    return float(steps[best]), origins[best]


def off_whole(numbers: Matrix) -> Matrix:
    """How far numbers are from whole ones."""
    return np.abs(numbers - np.rint(numbers))


def _up_to_whole(cells: Matrix) -> Matrix:
    """How far the next whole numbers are above."""
    return np.ceil(cells - 1e-6) - cells


Motion = tuple[Matrix, Matrix, float]
"""A turn, shape (3, 3), a shift, shape (3,), and the share of vertices that both take to others."""


def _exchanges_of_axes(prepared: Prepared, step: float, turn: Turn) -> list[Motion]:
    """Motions that only exchange axes or turn them back, of most vertices first."""
    turns, shifts, shares = motions_of(prepared, step, turn)
    extent = extent_of(prepared.mesh.positions).max()
    whole_turns = np.rint(turns)
    off = off_whole(turns).max(axis=(1, 2))
    is_exact = off * extent < step / 4.0
    order = np.argsort(-shares, kind="stable")
    return [(whole_turns[k], shifts[k], shares[k]) for k in order if is_exact[k]]


def _center(rigid: list[Motion], origins: Matrix, steps: Matrix) -> npt.NDArray[np.bool_]:
    """Move origins, shape (k, 3), so that axes which motions turn have their centers at places; return which axes are
    still open."""
    is_open = np.ones(3, bool)
    for turned, shift, _ in rigid:
        back = np.eye(3) - turned
        axes = back.any(axis=0)
        if axes.any() and is_open[axes].all():
            center = np.linalg.pinv(back) @ shift
            cells = (center - origins) / steps[:, None]
            moves = _up_to_whole(cells) * steps[:, None]
            origins[:, axes] -= moves[:, axes]
            is_open &= ~axes
    return is_open


def _off_planes(
    plane: Matrix, axis: int, origins: Matrix, steps: Matrix, *, is_open: bool
) -> Matrix:
    """How far the planes of an axis are from places, at each step; an open axis gets the origins at which that is
    least."""
    values, lengths = plane.T
    starts = origins[:, axis, None, None]
    if is_open:
        starts = values  # where plane j is at a place
    distances = values[:, None] - starts
    cells = distances / steps[:, None, None]
    off = np.einsum("i,sij->sj", lengths, off_whole(cells))
    if is_open:
        nearest = values[off.argmin(axis=1)]
        cells = (nearest - origins[:, axis]) / steps
        origins[:, axis] -= _up_to_whole(cells) * steps
    return np.asarray(off.min(axis=1))


def motions_of(prepared: Prepared, step: float, turn: Turn) -> tuple[Matrix, Matrix, Matrix]:
    """Turns, shape (k, 3, 3), and shifts, shape (k, 3), between parts, in turned axes, and the share of vertices that
    each takes to others; sought once for like steps, on a ladder from the first step on."""
    first = next(iter(prepared.motions), step)
    # For each step, bytes would jump from one to the next.
    quarters = round(math.log(step / first, 4.0))
    rung = first * 4.0**quarters
    if rung not in prepared.motions:
        cell = FINER * rung
        motions = motions_between(prepared.mesh.positions / cell, prepared.mesh.faces)
        motions[:, 9:12] *= cell
        prepared.motions[rung] = motions
    turns, shifts, shares = np.split(prepared.motions[rung], [9, 12], axis=1)
    axes = np.eye(3)
    if any(turn):
        axes = turned_by(axes, turn)
    turns = axes @ turns.reshape(-1, 3, 3) @ axes.T
    shifts = shifts @ axes.T
    return turns, shifts, shares[:, 0]


def motions_between(positions: Matrix, faces: Faces) -> Matrix:
    """Turns, shifts and shares of vertices, shape (k, 13), that take parts of a mesh, in cells, to others."""
    count = len(positions)
    motions = np.empty((constant("MOST_TRANSFORMS"), 13))
    degrees = np.bincount(faces.reshape(-1), minlength=count).astype(np.int32)
    head_bits = max(count, len(faces), 2).bit_length()
    heads = np.empty(1 << head_bits, np.int32)
    links = np.empty(count + len(faces), np.int32)
    covered = np.zeros(48 << 14, np.uint8)
    room = np.zeros(1 << 18)
    middle = (positions.min(axis=0) + positions.max(axis=0)) / 2.0
    centered = np.ascontiguousarray(positions - middle)
    workspace = (heads, links, covered, room)
    number = _kernels.find_motions(centered, faces, degrees, WORTH, workspace, motions)
    motions = motions[:number]
    turns = motions[:, :9].reshape(-1, 3, 3)
    motions[:, 9:12] += middle - turns @ middle
    return motions


def coded_transforms(turns: Matrix, shifts: Matrix, largest: npt.ArrayLike) -> Levels:
    """The numbers of transforms x -> turn x + shift of places on a grid, shape (k, 8), of turns, shape (k, 3, 3)."""
    span = np.asarray(largest, np.int64)
    most = int(max(span.max(), 1))
    middle = span / 2.0
    moved = turns @ middle + shifts
    source = np.abs(turns).argmax(axis=2)
    largest_entries = np.take_along_axis(turns, source[..., None], axis=2)
    sign = np.sign(largest_entries[..., 0])
    whole_turns = np.eye(3)[source] * sign[..., None]
    off = np.abs(turns - whole_turns) * span
    others = off.max(axis=(1, 2)) >= 1.0
    axes = np.sort(source, axis=1)
    others |= (axes != np.arange(3)).any(axis=1)
    is_swapped = (source[:, 1] - source[:, 0]) % 3 == 2
    mirrors = (sign < 0) @ np.array([1, 2, 4])
    kind = 8 * (2 * source[:, 0] + is_swapped) + mirrors
    source_span = span[source]
    shifts_of_middle = np.rint(moved - sign * middle[source])
    origins = shifts_of_middle + np.where(sign > 0, source_span, 0)
    none = np.zeros((len(turns), 4))
    rows = np.column_stack([kind, none, origins])
    ends = span + source_span
    if others.any():
        rows[others] = _turned(turns[others], moved[others], middle, most)
        ends[others] = 24 * most
    numbers = rows[:, 5:]
    is_coded = ((numbers >= 0) & (numbers <= ends)).all(axis=1)
    return np.asarray(rows[is_coded], np.int32)


def _turned(turns: Matrix, moved: Matrix, middle: Matrix, most: int) -> Matrix:
    """The numbers of transforms that are not parallel to the axes, which move the middle so."""
    mirrored = np.linalg.det(turns) < 0.0
    side = np.where(mirrored, -1.0, 1.0)[:, None, None]
    quaternion = quaternion_of(side * turns)
    bits = min(most.bit_length() + 2, constant("MOST_FINENESS"))
    scale = 1 << bits
    which = np.abs(quaternion).argmax(axis=1)[:, None]
    largest = np.take_along_axis(quaternion, which, axis=1)
    unit = np.rint(quaternion / largest * scale)
    square = np.square(unit).sum(axis=1)[:, None, None]
    turned = side * _spun(unit) / square
    shifts = moved - turned @ middle
    quarters = np.rint(4.0 * shifts) + 12 * most
    is_other = np.arange(4) != which
    others = unit[is_other].reshape(-1, 3) + scale
    return np.column_stack([constant("AXIS_KINDS") + mirrored, which, others, quarters])


def _spun(quaternion: Matrix) -> Matrix:
    """The turns of quaternions, shape (k, 4), times the squares of their lengths."""
    a = quaternion[:, :1, None]
    v = quaternion[:, 1:]
    unit = np.eye(3)
    square = np.square(v).sum(axis=1)[:, None, None]
    outer = 2.0 * v[:, :, None] * v[:, None]
    crosses = cross_of(v[:, None], unit).transpose(0, 2, 1)
    return np.asarray((a * a - square) * unit + outer + 2.0 * a * crosses)
