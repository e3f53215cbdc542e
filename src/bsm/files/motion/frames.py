"""The interface between readers and writers of sequences: frames, requests and shared metadata."""

import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from itertools import islice
from operator import lt
from typing import Protocol

import numpy as np

from bsm.bitstream.errors import MeshError, OptionError
from bsm.codec.arrays import Faces, Positions
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import Metadata, TriangleMesh
from bsm.files.conventions import TIME_VALUE, shares_of
from bsm.files.formats.appearance import as_numbers
from bsm.files.formats.metadata import CALLED, COMPONENTS
from bsm.files.table import RATE, START, STEP, TIMES

USUAL_RATE = 24.0  # frames per second of a sequence that does not say; pages play it as fast
LIKELY_RATES = (12, 15, 24, 25, 30, 48, 50, 60, 72, 90, 100, 120)
MOST_LISTED = 12  # runs that a note names


@dataclass(frozen=True, eq=False)
class Frames:
    """A sequence that is read as it is used."""

    faces: Faces
    count: int
    frames: Iterator[Positions]
    attributes: tuple[Attribute, ...] = ()
    notes: tuple[str, ...] = ()
    frame_rate: float = 0.0
    metadata: Metadata = field(default_factory=dict)
    meshes: Iterator[TriangleMesh] | None = None
    # Vertices of the mesh that plays them, whose number and order count, of a cache of points.
    rigged: int = 0

    def __post_init__(self) -> None:
        # Checked while they are read: a sequence may be larger than the memory, and most readers go through it once.
        object.__setattr__(
            self, "frames", self._checked(self.frames, int(self.faces.max(initial=0)))
        )

    def between(self, first: int, last: int) -> "Frames":
        """Return the frames from `first` on, up to `last`, which is not among them."""
        if self.meshes is not None:
            raise OptionError(
                "the faces of this sequence change; write its frames as files, and name those"
            )
        count = len(range(self.count)[first:last])
        return replace(self, frames=islice(self.frames, first, last), count=count)

    @staticmethod
    def _checked(frames: Iterator[Positions], last: int) -> Iterator[Positions]:
        vertices = 0
        for number, frame in enumerate(frames):
            vertices = vertices or len(frame)
            if last >= vertices:
                raise MeshError(
                    f"frame {number} has {vertices} of the {last + 1} vertices that faces need"
                )
            if len(frame) != vertices:
                raise MeshError(
                    f"frame {number} has {len(frame)} vertices, and the first one has {vertices}"
                )
            finite = np.isfinite(frame)
            if not finite.all():
                row = int(np.argmin(finite.all(axis=1)))
                raise MeshError(
                    f"vertex {row} of frame {number} has a coordinate that is not finite; repair it"
                )
            yield frame
        if not vertices:
            raise MeshError("a sequence needs at least one frame")

    # A cache of points is played on the mesh of a rig, by the numbers of its vertices. A face without area therefore
    # keeps each vertex that is in no other face.
    def on_sorted_faces(self) -> "Frames":
        """These frames where the order of faces costs nothing, and each vertex in no face has one without area."""
        loose = np.setdiff1d(np.arange(self.rigged), self.faces)
        faces = np.concatenate([self.faces, np.repeat(loose[:, None], 3, axis=1)]).astype(np.int32)
        # By the vertices of each face, sorted: files of one cache may list the same faces in any order, and equal faces
        # must come to the same place.
        order = np.lexsort(np.sort(faces, axis=1).T)
        first_corners = np.argmin(faces, axis=1)[order]
        corners = (first_corners[:, None] + np.arange(3)) % 3
        source_faces = np.where(order < len(self.faces), order, 0)
        attributes: list[Attribute] = []
        for attribute in self.attributes:
            moved = attribute.taken(np.arange(self.rigged), source_faces)
            if moved.indices is not None:
                moved = replace(moved, indices=np.take_along_axis(moved.indices, corners, axis=1))
            attributes.append(moved)
        turned = np.take_along_axis(faces[order], corners, axis=1)
        return replace(self, faces=turned, attributes=tuple(attributes))


@dataclass(frozen=True)
class Wanted:
    """A request to a reader of sequences."""

    rate: float = 0.0
    animation: str = ""
    mesh: str | os.PathLike[str] | None = None
    runs: bool = False
    times: Sequence[float] = ()  # of the files of frames
    parts: Sequence[int] = ()  # how many files there are for each time, if not one


class FrameWriter(Protocol):
    def __call__(self, frame: Positions, faces: Faces | None = None) -> None:
        """Take a frame, shape (n, 3), and its faces, shape (m, 3), where they are others than before."""


@dataclass(frozen=True, eq=False)
class Shared:
    """Return the metadata of a sequence that is written from frame `first` on, and notes on its losses."""

    attributes: Callable[[], tuple[Attribute, ...]] = tuple
    metadata: Callable[[], Metadata] = dict
    left_out: list[str] = field(default_factory=list)
    first: int = 0
    # Metadata that the times of frames say, or the numbers in their names.
    held: frozenset[str] = frozenset()
    _begun: dict[str, Attribute] = field(default_factory=dict)

    @property
    def frame_rate(self) -> float:
        rate = self.metadata().get(RATE)
        if isinstance(rate, int | float) and 0 < rate < float("inf"):
            return float(rate)
        return 0.0

    def code(self, number: int) -> float:
        """When a frame, of those that are written, is shown: in frames at the rate."""
        number += self.first
        metadata = self.metadata()
        times = _times_in(str(metadata.get(TIMES, "")))
        if number < len(times):
            return times[number] * (self.frame_rate or USUAL_RATE)
        return _finite(metadata.get(START), 0.0) + number * _finite(metadata.get(STEP), 1.0)

    @property
    def numbered(self) -> bool:
        """Whether frames are shown at whole numbers of frames, which names can have."""
        return (
            TIMES not in self.metadata() and self.code(0).is_integer() and self.code(1).is_integer()
        )

    def timed(self, mesh: TriangleMesh, number: int) -> TriangleMesh:
        """Return a frame with its time, if that is known."""
        if self.metadata().keys().isdisjoint((TIMES, RATE)):
            return mesh
        time = self.code(number) / (self.frame_rate or USUAL_RATE)
        return replace(mesh, metadata={**mesh.metadata, TIME_VALUE: time})

    def mesh(
        self, positions: Positions, faces: Faces, *, with_metadata: bool = True
    ) -> TriangleMesh:
        metadata: dict[str, str | int | float | bytes] = {}
        for name, value in self.metadata().items():
            # The names of properties are those of every file.
            is_of_file = with_metadata or name.startswith((CALLED, COMPONENTS))
            if is_of_file and name not in self.held:
                metadata[name] = value
        return TriangleMesh(positions, faces, self.attributes(), metadata)

    def moved(self, *, anew: bool = False) -> tuple[Attribute, ...]:
        """Attributes that are others now than they were when this was asked first, or anew."""
        if anew:
            self._begun.clear()
        return tuple(a for a in self.attributes() if self._begun.setdefault(a.name, a) is not a)

    def loses(self, names: Iterable[str]) -> None:
        self.left_out.extend(name for name in dict.fromkeys(names) if name not in self.left_out)


def painted_like(first: TriangleMesh, mesh: TriangleMesh) -> TriangleMesh:
    """A frame whose colors are of the kind of the first one's: bytes, or floats from 0 to 1."""
    kinds = {
        attribute.name: attribute.values.dtype
        for attribute in first.attributes
        if attribute.semantic == "color"
    }
    attributes: list[Attribute] = []
    for attribute in mesh.attributes:
        kind = kinds.get(attribute.name, attribute.values.dtype)
        if kind != attribute.values.dtype and attribute.semantic == "color":
            shades = shares_of(attribute.values)
            if kind == np.uint8:
                shades = np.rint(255.0 * shades)
            attribute = replace(attribute, values=shades.astype(kind))
        attributes.append(attribute)
    return replace(mesh, attributes=tuple(attributes))


def timing_of(times: Positions, rate: float = 0.0) -> tuple[float, dict[str, float | str] | None]:
    """Frames per second of times, shape (T,), 0 if uneven, and metadata of the rest; None: they do not grow."""
    if not len(times):
        return rate, {}
    steps = np.diff(times)
    if not np.isfinite(times).all() or (steps <= 0.0).any():
        return rate, None
    own_rate = rate_of_times(times)
    even = times[:1] + np.arange(len(times)) / (own_rate or rate or USUAL_RATE)
    # Times of files are often floats of 32 bits: at an hour they are only known to about 0.2 ms.
    spacing = float(np.finfo(np.float32).eps * np.abs(times).max())
    tolerance = 4.0 * spacing + 1e-3 * float(steps[:1].sum())
    if np.abs(even - times).max() > tolerance:
        return own_rate, {TIMES: " ".join(f"{time:.9g}" for time in times.tolist())}
    start = round(float(times[0]) * (rate or own_rate or USUAL_RATE), 6)
    metadata: dict[str, float | str] = {}
    if start:
        metadata[START] = start
    return rate or own_rate, metadata


def between(name: str, codes: Positions, rate: float) -> list[str]:
    """A note on samples at codes, shape (k,), counted in frames from the first one, that lie between the frames."""
    counts: list[int] = []
    for factor in range(1, 9):
        distances = np.abs(factor * codes - np.rint(factor * codes))
        counts.append(int((distances > 0.02).sum()))
    if not counts[0]:
        return []
    note = f"{counts[0]} of {len(codes)} {name} lie between the frames and are not read"
    if 0 in counts:
        note += f"; --frame-rate {rate * (1 + counts.index(0)):g} reads them"
    return [note]


def rate_of_times(times: Positions) -> float:
    """Frames per second of equally spaced times in seconds, shape (T,); 0: they are not equally spaced."""
    if len(times) < 2 or not np.isfinite(times).all():
        return 0.0
    step = float(times[-1] - times[0]) / (len(times) - 1)
    # 2 %, since many programs write times with three or four digits: 0.033, 0.067, 0.1.
    if step <= 0 or float(np.abs(np.diff(times) - step).max()) > 0.02 * step:
        return 0.0
    rate = 1.0 / step
    whole_rate = float(round(rate))
    # 23.976 stays as it is, while 29.9999 from rounded times becomes 30.
    if abs(rate - whole_rate) < 1e-3 * rate:
        return whole_rate
    return rate


@lru_cache(1)
def _times_in(text: str) -> list[float]:
    """Times in seconds; none unless they are numbers that grow."""
    times = as_numbers(text)
    if not all(map(lt, times, times[1:])):
        return []
    return times


def _finite(value: object, usual: float) -> float:
    if isinstance(value, int | float) and np.isfinite(value):
        return float(value)
    return usual


def describe_runs(starts: Sequence[int]) -> str:
    """In words, the frames before which faces change."""
    words = ", ".join(map(str, starts[:MOST_LISTED]))
    if len(starts) > MOST_LISTED:
        words += f" and {len(starts) - MOST_LISTED} more"
    if len(starts) > 1:
        return f"connectivity changes at frames {words}"
    return f"connectivity changes at frame {words}"
