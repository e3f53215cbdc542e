"""Runs as their geometry is: vertices that are at one position in every frame are one."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import chain

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import MeshError
from bsm.codec.arrays import Indices, Matrix, Order
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.welding import first_of, group_rows
from bsm.codec.sequence.runs import Run
from bsm.codec.static.joining import JoinedMesh, joined


@dataclass(frozen=True, eq=False)
class JoinedRun:
    """Frames that share their faces, and in which the same vertices are one."""

    given: TriangleMesh
    joined: JoinedMesh
    frames: Iterator[Matrix]
    first: int
    moving: tuple[Attribute, ...]


def joined_runs(
    runs: Iterable[Run], together: Callable[[int], int], *, keep_order: bool, allowed: bool
) -> Iterator[JoinedRun]:
    """Runs whose vertices are joined."""
    for run in runs:
        frames = _Frames(run)
        while (frame := next(frames, None)) is not None:
            first = frames.number - 1
            mesh = replace(run.mesh, positions=frame[:, :3])
            beginning = _Beginning(frame)
            while beginning.merges and len(beginning) < together(beginning.vertices):
                if (frame := next(frames, None)) is None:
                    break
                beginning.add(frame)
            one = joined(mesh, beginning.index, keep=keep_order, keep_loose=False)
            later = frames.while_together(one, may_part=keep_order or allowed)
            yield JoinedRun(mesh, one, chain(beginning.taken(one.first), later), first, run.moving)


class _Frames:
    """The checked frames of a run, shape (n, 3 + d); `number` is that of the next one."""

    def __init__(self, run: Run) -> None:
        self.number = run.first
        self._frames = iter(run.frames)
        self._shape = len(run.mesh.positions), 3 + sum(one.components for one in run.moving)
        self._ahead: Matrix | None = None

    def __iter__(self) -> _Frames:
        return self

    def __next__(self) -> Matrix:
        positions, self._ahead = self._ahead, None
        if positions is None:
            positions = self._checked(next(self._frames))
        self.number += 1
        return positions

    def while_together(self, one: JoinedMesh, *, may_part: bool) -> Iterator[Matrix]:
        """The vertices of `one.mesh`, shape (k, 3), frame by frame until some of those that it joins part."""
        used = np.flatnonzero(one.index >= 0)
        merged = len(used) > len(one.first)
        for positions in self:
            found = positions[one.first]
            apart = (positions[used] != found[one.index[used]]).any(axis=1) if merged else np.zeros(0, np.bool_)
            if apart.any():
                if not may_part:
                    vertex = used[np.argmax(apart)]
                    raise MeshError(
                        f"vertices {one.first[one.index[vertex]]} and {vertex} part at frame {self.number - 1}; with "
                        "keep_order = True (--keep-order), or runs = True (--set runs=yes), they may"
                    )
                self.number -= 1
                self._ahead = positions
                return
            yield found

    def _checked(self, frame: npt.ArrayLike) -> Matrix:
        positions = np.asarray(frame, np.float64)
        if positions.shape != self._shape:
            raise MeshError(f"frame {self.number} has shape {positions.shape}, the first one {self._shape}")
        if not np.isfinite(positions).all():
            raise MeshError(f"frame {self.number} has a coordinate that is not finite; remove or repair it")
        return positions


class _Beginning:
    """The first frames of a run, and what each vertex is if those at one position in all of them are one."""

    def __init__(self, frame: Matrix) -> None:
        self.index = group_rows(frame)
        self._frames: deque[tuple[Matrix, Indices]] = deque()  # of each vertex that was another one then
        self._note(frame)

    def __len__(self) -> int:
        return len(self._frames)

    @property
    def vertices(self) -> int:
        """How many vertices there are."""
        return len(self._frames[-1][0])

    @property
    def merges(self) -> bool:
        """Whether any are one."""
        return self.vertices < len(self.index)

    def add(self, frame: Matrix) -> None:
        """Take note of another frame, shape (n, 3)."""
        if (frame != frame[first_of(self.index)][self.index]).any():
            self.index = group_rows(np.column_stack([self.index, frame]))
        self._note(frame)

    def taken(self, vertices: Order) -> Iterator[Matrix]:
        """Some vertices, shape (k,), in all frames, each of shape (k, 3); the frames are given up."""
        while self._frames:
            frame, index = self._frames.popleft()
            yield frame[index[vertices]]

    def _note(self, frame: Matrix) -> None:
        self._frames.append((frame[first_of(self.index)], self.index))
