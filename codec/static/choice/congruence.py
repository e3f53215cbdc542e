"""Rigid and mirrored transforms that take parts of a mesh to others: found, and as a grid codes them. Encoder only."""

import math

import numpy as np
import numpy.typing as npt

from bsm._core import codec as _kernels
from bsm._core.bitstream import constant
from bsm.codec.arrays import Faces, Levels, Matrix
from bsm.codec.geometry.mesh import extent_of
from bsm.codec.geometry.turns import Turn, cross_of, quaternion_of, turned_by
from bsm.codec.static.preamble_encoding import Prepared
from bsm.codec.static.ways.grid import Raster

WORTH = 16.0  # vertices that a transform must explain
FINER = 0.5  # over the step of a grid: vertices that are not rounded are nearer to their images


def transforms_of(prepared: Prepared, grid: Raster) -> Levels:
    """The transforms of a mesh on a grid, shape (k, 8), as they are coded; sought once for like steps."""
    (turns, shifts), origin = _motions(prepared, grid.step, grid.turn), np.array(grid.origin)
    return coded_transforms(turns, (turns @ origin + shifts - origin) / grid.step, grid.largest)


def mirrored_origin(prepared: Prepared, origin: Matrix, step: float, turn: Turn) -> Matrix:
    """The origin of a grid, at most half a cell lower, for which mirrors take cells of the grid to cells."""
    turns, shifts = _motions(prepared, step, turn)
    extent = extent_of(prepared.mesh.positions).max()
    moved, back = origin.copy(), np.abs(turns + np.eye(3)).max(axis=2) * extent < step / 8.0
    for axis in np.flatnonzero(back.any(axis=0)):
        halves = (shifts[back[:, axis].argmax(), axis] - 2.0 * origin[axis]) / step
        moved[axis] -= (math.ceil(halves) - halves) * step / 2.0
    return moved


def _motions(prepared: Prepared, step: float, turn: Turn) -> tuple[Matrix, Matrix]:
    """Turns, shape (k, 3, 3), and shifts, shape (k, 3), between parts, in turned axes; sought once for like steps."""
    octave = round(2.0 * math.log2(step))
    if octave not in prepared.motions:
        cell = FINER * 2.0 ** (octave / 2.0)
        prepared.motions[octave] = motions_between(prepared.mesh.positions / cell, prepared.mesh.faces)
        prepared.motions[octave][:, 9:] *= cell
    turns, shifts = prepared.motions[octave][:, :9].reshape(-1, 3, 3), prepared.motions[octave][:, 9:]
    if not any(turn):
        return turns, shifts
    axes = turned_by(np.eye(3), turn)
    return axes @ turns @ axes.T, shifts @ axes.T


def motions_between(positions: Matrix, faces: Faces) -> Matrix:
    """Turns and shifts, shape (k, 12), of positions in cells that take parts of a mesh to others."""
    count, found = len(positions), np.empty((constant("MOST_TRANSFORMS"), 12))
    degrees = np.bincount(faces.reshape(-1), minlength=count).astype(np.int32)
    heads = np.empty(1 << max(count, len(faces), 2).bit_length(), np.int32)
    links, covered, room = np.empty(count + len(faces), np.int32), np.zeros(48 << 14, np.uint8), np.zeros(1 << 18)
    middle = (positions.min(axis=0) + positions.max(axis=0)) / 2.0
    centered = np.ascontiguousarray(positions - middle)
    kept = _kernels.find_motions(centered, faces, degrees, WORTH, heads, links, covered, room, found)
    found[:kept, 9:] += middle - found[:kept, :9].reshape(-1, 3, 3) @ middle
    return found[:kept]


def coded_transforms(turns: Matrix, shifts: Matrix, largest: npt.ArrayLike) -> Levels:
    """The numbers of transforms x -> turn x + shift of places on a grid, shape (k, 8), of turns, shape (k, 3, 3)."""
    span = np.asarray(largest, np.int64)
    most, middle, moved = int(max(span.max(), 1)), span / 2.0, turns @ (span / 2.0) + shifts
    source = np.abs(turns).argmax(axis=2)
    sign = np.sign(np.take_along_axis(turns, source[..., None], axis=2)[..., 0])
    others = (np.abs(turns - np.eye(3)[source] * sign[..., None]) * span).max(axis=(1, 2)) >= 1.0
    others |= (np.sort(source, axis=1) != np.arange(3)).any(axis=1)
    kind = 8 * (2 * source[:, 0] + ((source[:, 1] - source[:, 0]) % 3 == 2)) + (sign < 0) @ np.array([1, 2, 4])
    given = np.rint(moved - sign * middle[source]) + np.where(sign > 0, span[source], 0)
    rows, ends = np.column_stack([kind, np.zeros((len(turns), 4)), given]), span + span[source]
    if others.any():
        rows[others], ends[others] = _turned(turns[others], moved[others], middle, most), 24 * most
    return np.asarray(rows[((rows[:, 5:] >= 0) & (rows[:, 5:] <= ends)).all(axis=1)], np.int32)


def _turned(turns: Matrix, moved: Matrix, middle: Matrix, most: int) -> Matrix:
    """The numbers of transforms that are not parallel to the axes, which move the middle so."""
    mirrored = np.linalg.det(turns) < 0.0
    side = np.where(mirrored, -1.0, 1.0)[:, None, None]
    quaternion = quaternion_of(side * turns)
    bits = min(most.bit_length() + 2, constant("MOST_FINENESS"))
    which = np.abs(quaternion).argmax(axis=1)[:, None]
    unit = np.rint(quaternion / np.take_along_axis(quaternion, which, axis=1) * (1 << bits))
    a, v = unit[:, :1, None], unit[:, 1:]
    spun = (
        (a * a - np.square(v).sum(axis=1)[:, None, None]) * np.eye(3)
        + 2.0 * v[:, :, None] * v[:, None]
        + 2.0 * a * cross_of(v[:, None], np.eye(3)).transpose(0, 2, 1)
    )
    turned = side * spun / np.square(unit).sum(axis=1)[:, None, None]
    quarters = np.rint(4.0 * (moved - turned @ middle)) + 12 * most
    others = unit[np.arange(4) != which].reshape(-1, 3) + (1 << bits)
    return np.column_stack([constant("AXIS_KINDS") + mirrored, which, others, quarters])
