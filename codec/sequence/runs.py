"""Sequences whose faces change: runs of frames that share their faces, and the meshes that are kept for later runs."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import chain
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import MeshError
from bsm.codec.arrays import Indices, Matrix, Order
from bsm.codec.geometry.attributes import Attribute, has
from bsm.codec.geometry.mesh import TriangleMesh, box_around, require_sizes
from bsm.codec.geometry.welding import first_of, group_rows
from bsm.codec.static.preamble_encoding import JoinedMesh, joined

Frame: TypeAlias = npt.ArrayLike | TriangleMesh
"""Positions, shape (n, 3), or a mesh, whose faces may be others than those of the frame before."""

SHOWN = ("material.", "image.")  # metadata of materials and images begin with these

# A vertex at infinity, for a frame, comes from tracking that failed. It would make all steps useless.
FARTHEST = 1e5
"""Diagonals of the first frame that a vertex may move away from it; levels of wider motion would overflow."""

EMPTY = "empty_frame"
"""The attribute of faces of a run that stands for frames without faces: its one triangle has no area."""


def empty_frame() -> TriangleMesh:
    """Return the mesh that stands for a frame without faces."""
    mark = Attribute(EMPTY, np.ones((1, 1), np.uint8), "face", "generic")
    # A mesh must have faces. This one has no area, so that it shows nothing wherever it is drawn.
    return TriangleMesh(np.array([(0, 0, 0), (1, 0, 0), (2, 0, 0)]), np.array([(0, 1, 2)]), (mark,))


def is_empty(attributes: Iterable[Attribute]) -> bool:
    """Whether attributes are those of a frame without faces."""
    return any(attribute.name == EMPTY for attribute in attributes)


@dataclass(frozen=True, eq=False)
class Run:
    """Frames that share their faces."""

    mesh: TriangleMesh
    frames: Iterator[npt.ArrayLike]
    first: int
    moving: tuple[Attribute, ...]


class RunSplitter:
    """Cuts frames into runs."""

    def __init__(
        self,
        frames: Iterable[Frame],
        faces: npt.ArrayLike,
        *,
        allowed: bool,
        attributes: Sequence[Attribute] = (),
    ) -> None:
        self._frames = iter(frames)
        self._faces = faces
        self._allowed = allowed
        self._names = {attribute.name for attribute in attributes}
        # One frame ahead, to know whether a run goes on.
        self._ahead: Frame | None = next(self._frames, None)
        self._number = 0
        # Materials and images of the first frame.
        self._shown: dict[str, str | int | float | bytes] | None = None
        self.changed: dict[str, int] = {}

    def runs(self) -> Iterator[Run]:
        """One run after the other."""
        while (ahead := self._ahead) is not None:
            mesh = (
                ahead
                if isinstance(ahead, TriangleMesh)
                else TriangleMesh(np.asarray(ahead), np.asarray(self._faces))
            )
            self._note_materials(mesh)
            moving = tuple(
                a for a in mesh.attributes if can_move(a) and a.name in (self._names or {a.name})
            )
            yield Run(mesh, self._of(mesh, moving), self._number, moving)

    def _of(self, mesh: TriangleMesh, moving: tuple[Attribute, ...]) -> Iterator[npt.ArrayLike]:
        while (ahead := self._ahead) is not None:
            if not isinstance(ahead, TriangleMesh):
                frame: npt.ArrayLike = ahead
            elif difference := other_faces(mesh, ahead):
                if not self._allowed:
                    raise MeshError(
                        f"frame {self._number} has other faces than the one before: {difference}; with runs = True "
                        "(--runs) they may change"
                    )
                return
            else:
                self._note_materials(ahead)
                frame = self._frame(mesh, moving, ahead)
            self._number += 1
            yield frame
            self._ahead = next(self._frames, None)  # no sooner, since frames may come live

    def _note_materials(self, mesh: TriangleMesh) -> None:
        """Take note of materials and images that differ from those of the first frame, which a stream has once."""
        now = {name: value for name, value in mesh.metadata.items() if name.startswith(SHOWN)}
        first = self._shown = now if self._shown is None else self._shown
        for name in sorted(now.keys() | first.keys()):
            if now.get(name) != first.get(name):
                self.changed.setdefault(name, self._number)

    def _frame(
        self, first: TriangleMesh, moving: tuple[Attribute, ...], mesh: TriangleMesh
    ) -> npt.ArrayLike:
        """A frame of the run that begins with `first`."""
        columns = [mesh.positions]
        for attribute in first.attributes:
            now = moved_to(attribute, mesh.attributes) if attribute in moving else None
            if attribute in moving:
                columns.append((now or attribute).values.astype(np.float64))
            if (
                attribute.semantic != "normal"
                and now is None
                and not has(mesh.attributes, attribute)
            ):
                self.changed.setdefault(attribute.name, self._number)
        # Attributes that move ride along as further columns, through joining and grouping.
        return np.hstack(columns) if moving else mesh.positions


def can_move(attribute: Attribute) -> bool:
    """Whether GOPs can tell how an attribute changes: colors and numbers of vertices."""
    return attribute.domain == "vertex" and attribute.semantic in ("color", "generic")


def moved_to(attribute: Attribute, others: Iterable[Attribute]) -> Attribute | None:
    """Return an attribute as it is in another frame; None if it is absent or differs in kind."""
    same = (other for other in others if kind_of(other) == kind_of(attribute))
    return next(same, None)


def kind_of(attribute: Attribute) -> tuple[object, ...]:
    return (
        attribute.name,
        attribute.domain,
        attribute.semantic,
        attribute.values.dtype,
        attribute.values.shape,
    )


def other_faces(mesh: TriangleMesh, following: TriangleMesh) -> str:
    """How the faces of two meshes differ; nothing if they do not."""
    for what, ours, others in (
        ("vertices", mesh.positions, following.positions),
        ("faces", mesh.faces, following.faces),
    ):
        if len(ours) != len(others):
            return f"{len(others)} {what} where there were {len(ours)}"
    if np.array_equal(mesh.faces, following.faces):
        return ""
    row = int(np.argmax((mesh.faces != following.faces).any(axis=1)))
    return f"face {row} is {following.faces[row].tolist()} where it was {mesh.faces[row].tolist()}"


@dataclass(frozen=True, eq=False)
class JoinedRun(Run):
    """Frames that share their faces, and in which the same vertices are one."""

    joined: JoinedMesh
    frames: Iterator[Matrix]


def joined_runs(
    runs: Iterable[Run], together: Callable[[int], int], *, keep_order: bool, allowed: bool
) -> Iterator[JoinedRun]:
    """Runs whose vertices are joined."""
    for run in runs:
        frames = _Frames(run)
        while (frame := next(frames, None)) is not None:
            first = frames.number - 1
            mesh = replace(run.mesh, positions=frame[:, :3])
            # Vertices are joined only if they are at one place in all frames of the first group: at rest, the hands of
            # a figure may touch its hips.
            index, begun = _begun(frame, frames, together)
            one = joined(mesh, index, keep=keep_order, keep_loose=False)
            later = frames.while_together(one, may_part=keep_order or allowed)
            yield JoinedRun(mesh, chain(_taken(begun, one.first), later), first, run.moving, one)


class _Frames:
    """The checked frames of a run, shape (n, 3 + d); `number` is that of the next one."""

    def __init__(self, run: Run) -> None:
        self.number = run.first
        self._frames = iter(run.frames)
        self._shape = (
            len(run.mesh.positions),
            3 + sum(attribute.components for attribute in run.moving),
        )
        self._ahead: Matrix | None = None
        self._box: tuple[Matrix, Matrix] | None = None

    def __iter__(self) -> _Frames:
        return self

    def __next__(self) -> Matrix:
        positions, self._ahead = self._ahead, None
        if positions is None:
            positions = self._checked(next(self._frames))
        self.number += 1
        return positions

    def while_together(self, mesh: JoinedMesh, *, may_part: bool) -> Iterator[Matrix]:
        """The vertices of `one.mesh`, shape (k, 3), frame by frame until some of those that it joins part."""
        used = np.flatnonzero(mesh.index >= 0)
        merged = len(used) > len(mesh.first)
        for positions in self:
            merged_positions = positions[mesh.first]
            # Joined vertices may part later. Then a run ends, and the next one has them apart.
            apart = (
                (positions[used] != merged_positions[mesh.index[used]]).any(axis=1)
                if merged
                else np.zeros(0, np.bool_)
            )
            if apart.any():
                if not may_part:
                    vertex = used[np.argmax(apart)]
                    raise MeshError(
                        f"vertices {mesh.first[mesh.index[vertex]]} and {vertex} part at frame {self.number - 1}; with "
                        "keep_order = True (--keep-order), or runs = True (--runs), they may"
                    )
                self.number -= 1
                # The frame that showed it is the first of the next run.
                self._ahead = positions
                return
            yield merged_positions

    def _checked(self, frame: npt.ArrayLike) -> Matrix:
        positions = np.asarray(frame, np.float64)
        if positions.shape != self._shape:
            raise MeshError(
                f"frame {self.number} has shape {positions.shape}, the first one {self._shape}"
            )
        if not np.isfinite(positions).all():
            vertex = int(np.argmin(np.isfinite(positions).all(axis=1)))
            raise MeshError(
                f"vertex {vertex} of frame {self.number} has a number that is not finite; repair it"
            )
        require_sizes(positions[:, :3])  # columns of attributes follow
        # The first frame is the measure: later ones may be the broken ones.
        low, high = self._box = self._box or box_around(positions[:, :3])
        apart, diagonal = (
            np.linalg.norm(positions[:, :3] - low, axis=1),
            float(np.linalg.norm(high - low)),
        )
        if apart[vertex := int(apart.argmax())] > FARTHEST * diagonal > 0.0:
            far = apart[vertex] / diagonal
            raise MeshError(
                f"vertex {vertex} of frame {self.number} is {far:.2g} diagonals from the first frame; repair it"
            )
        return positions


def _begun(
    first: Matrix, others: Iterator[Matrix], together: Callable[[int], int]
) -> tuple[Indices, deque[tuple[Matrix, Indices]]]:
    """Return what each vertex is if those at one position in all of the first frames are one, and these frames."""
    index, begun = group_rows(first), deque[tuple[Matrix, Indices]]()
    for frame in chain([first], others):
        if (frame != frame[first_of(index)][index]).any():
            index = group_rows(np.column_stack([index, frame]))
        vertices = first_of(index)
        begun.append((frame[vertices], index))
        if len(vertices) == len(index) or len(begun) >= together(len(vertices)):
            break
    return index, begun


def _taken(begun: deque[tuple[Matrix, Indices]], vertices: Order) -> Iterator[Matrix]:
    """Some vertices, shape (k,), in the first frames, each of shape (k, 3 + d); the frames are given up."""
    while begun:
        frame, index = begun.popleft()
        yield frame[index[vertices]]
