"""Rigid and mirrored transforms that take parts of a mesh to others: found, and as a grid codes them. Encoder only."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from bsm._core import codec as _kernels
from bsm.codec.arrays import Faces, Levels, Matrix
from bsm.codec.geometry.turns import Turn, quaternion_of, turned_by
from bsm.codec.static.preamble_encoding import Prepared
from bsm.codec.static.ways.grid import Grid

MOST_FINENESS, AXIS_KINDS = 19, 48
"""Bits of a component of a quaternion, and transforms that are parallel to the axes (V 17.2)."""
MOST = 16  # transforms of a grid
WORTH = 16.0  # vertices that a transform must explain
PARALLEL = 1e-4  # largest entry by which an axis is off
ROOM = 1 << 18  # numbers for votes
FINER = 0.5  # over the step of a grid: vertices that are not rounded are nearer to their images


def transforms_of(prepared: Prepared, grid: Grid, finer: float = 1.0) -> Levels:
    """The transforms of a mesh on a grid, shape (k, 8), as they are coded; sought once for like steps."""
    turns, shifts = _motions(prepared, grid.step / finer, grid.turn)
    origin = np.array(grid.origin)
    return coded_transforms(turns, (turns @ origin + shifts - origin) / grid.step, grid.largest)


def mirrored_origin(prepared: Prepared, origin: Matrix, step: float, turn: Turn) -> Matrix:
    """The origin of a grid, at most half a cell lower, for which mirrors take cells of the grid to cells."""
    turns, shifts = _motions(prepared, step, turn)
    moved = origin.copy()
    for axis in range(3):
        back = np.flatnonzero(np.abs(turns[:, axis] + np.eye(3)[axis]).max(axis=1) < PARALLEL)
        if len(back):
            halves = (shifts[back[0], axis] - 2.0 * origin[axis]) / step
            moved[axis] -= (math.ceil(halves) - halves) * step / 2.0
    return moved


def _motions(prepared: Prepared, step: float, turn: Turn) -> tuple[Matrix, Matrix]:
    """Turns, shape (k, 3, 3), and shifts, shape (k, 3), between parts, in turned axes; sought once for like steps."""
    octave = round(2.0 * math.log2(step))
    if octave not in prepared.motions:
        cell = FINER * 2.0 ** (octave / 2.0)
        prepared.motions[octave] = motions_between(prepared.mesh.positions / cell, prepared.mesh.faces)
        prepared.motions[octave][:, 9:] *= cell
    turns, shifts = np.split(prepared.motions[octave], [9], axis=1)
    axes = turned_by(np.eye(3), turn)
    return axes @ turns.reshape(-1, 3, 3) @ axes.T, shifts @ axes.T


def motions_between(positions: Matrix, faces: Faces) -> Matrix:
    """Turns and shifts, shape (k, 12), of positions in cells that take parts of a mesh to others."""
    count, found = len(positions), np.empty((MOST, 12))
    degrees = np.bincount(faces.reshape(-1), minlength=count).astype(np.int32)
    heads = np.empty(1 << max(count, len(faces), 2).bit_length(), np.int32)
    links, covered, room = np.empty(count + len(faces), np.int32), np.zeros(48 << 14, np.uint8), np.zeros(ROOM)
    middle = (positions.min(axis=0) + positions.max(axis=0)) / 2.0
    centered = np.ascontiguousarray(positions - middle)
    kept = _kernels.find_motions(centered, faces, degrees, WORTH, heads, links, covered, room, found)
    found[:kept, 9:] += middle - found[:kept, :9].reshape(-1, 3, 3) @ middle
    return found[:kept]


def coded_transforms(turns: Matrix, shifts: Matrix, largest: npt.ArrayLike) -> Levels:
    """The numbers of transforms x -> turn x + shift of places on a grid, shape (k, 8), of turns, shape (k, 3, 3)."""
    span = np.asarray(largest, np.int64)
    rows = [_coded(turn, shift, span) for turn, shift in zip(turns, shifts, strict=True)]
    return np.array([row for row in rows if row is not None], np.int32).reshape(-1, 8)


def _coded(turn: Matrix, shift: Matrix, span: npt.NDArray[np.int64]) -> list[int] | None:
    source = np.abs(turn).argmax(axis=1)
    sign = np.sign(turn[np.arange(3), source])
    parallel = np.eye(3)[source] * sign[:, None]
    if sorted(source) == [0, 1, 2] and (np.abs(turn - parallel) * span).max() < 1.0:
        middle = span[source] / 2.0
        moved = turn @ (span / 2.0) + shift
        given = np.rint(moved - sign * middle).astype(np.int64)
        numbers = given + np.where(sign > 0, span[source], 0)
        order = 2 * int(source[0]) + int((source[1] - source[0]) % 3 == 2)
        kind = 8 * order + sum(1 << j for j in range(3) if sign[j] < 0)
        return None if (numbers < 0).any() or (numbers > span + span[source]).any() else [kind, 0, 0, 0, 0, *numbers]
    mirrored = np.linalg.det(turn) < 0.0
    quaternion = quaternion_of(-turn if mirrored else turn)
    bits = min(int(max(span.max(), 1)).bit_length() + 2, MOST_FINENESS)
    which = int(np.abs(quaternion).argmax())
    unit = np.rint(quaternion / quaternion[which] * (1 << bits))
    a, v, (x, y, z) = unit[0], unit[1:], unit[1:]
    across = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    spun = (a * a - v @ v) * np.eye(3) + 2.0 * np.outer(v, v) + 2.0 * a * across
    coded = spun / (unit @ unit) * (-1.0 if mirrored else 1.0)
    middle = span / 2.0
    quarters = np.rint(4.0 * (turn @ middle + shift - coded @ middle)).astype(np.int64) + 12 * int(max(span.max(), 1))
    others = np.delete(unit, which).astype(np.int64) + (1 << bits)
    if (quarters < 0).any() or (quarters > 24 * max(span.max(), 1)).any():
        return None
    return [AXIS_KINDS + int(mirrored), which, *others, *quarters]
