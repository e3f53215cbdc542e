"""Frames to a stream: the encoder of sequences, which holds one GOP at most."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from hashlib import sha256
from types import MappingProxyType

import numpy as np
import numpy.typing as npt

from bsm.bitstream.connectivity.faces import AS_CORNERS, WHERE_SMALLER
from bsm.bitstream.container import packets
from bsm.bitstream.container.gop import write_gop_body
from bsm.bitstream.container.header import Header
from bsm.bitstream.container.packets import SectionWriter
from bsm.bitstream.errors import ArgumentError, MeshError, OptionError, public
from bsm.codec.arrays import Matrix, Order, Positions
from bsm.codec.choices import checked_metadata
from bsm.codec.geometry.attributes import Attribute, has
from bsm.codec.geometry.mesh import Metadata, TriangleMesh
from bsm.codec.progress import Progress, Stages, silent
from bsm.codec.sequence.attributes import Bound, MovingAttributeEncoder, with_fields
from bsm.codec.sequence.frames import Group, next_group
from bsm.codec.sequence.options import SequenceOptions
from bsm.codec.sequence.run_encoding import EncodedGops, FirstFrame, Kept, RunEncoder, finest_step
from bsm.codec.sequence.runs import Frame, JoinedRun, Run, RunSplitter, joined_runs, kind_of
from bsm.codec.sequence.targets import RISES, SequenceComparison, compare_sequences
from bsm.codec.sequence.verification import ExpectedFrame, Measured, SequenceVerifier
from bsm.codec.static.attributes.encoding import PreparedAttribute, carry, with_attributes
from bsm.codec.static.attributes.quality import qualities
from bsm.codec.static.encoder import PROMISED_SIZES
from bsm.codec.static.preamble_encoding import Draft, Parts, Prepared, prepare
from bsm.codec.static.targets import search_step
from bsm.codec.static.units import checksum_of
from bsm.codec.static.verification import AsGiven
from bsm.codec.static.ways.block_coder import as_of_decoders

# Volumetric capture comes back to the same topologies, and a decoder cannot keep all.
KEPT_MESHES = 8  # by decoders, of the meshes so far
# Seconds of preparing, coding and verifying, as shares of all, measured on sequences of 200 to 960 frames.
_SEARCHED = (0.2, 0.62, 0.18)  # with a promise
_CODED_ONCE = (0.25, 0.45, 0.3)  # with a step


@dataclass(frozen=True, eq=False)
class SequenceAttempt:
    """A whole stream, and what its decoder will make of it."""

    chunks: tuple[bytes, ...]
    samples: int
    comparison: SequenceComparison
    verifier: SequenceVerifier
    drawn: float

    @property
    def bpvf(self) -> float:
        return 8.0 * sum(map(len, self.chunks)) / self.samples


@public
class SequenceEncoder:
    """Encodes frames that share their faces, or runs of such frames.

    Parameters
    ----------
    faces : array_like of int, shape (m, 3)
        The encoder leaves out vertices that no face uses, and merges vertices at one position in all frames, with
        notes. If the options keep the order, the stream returns them.
    options : SequenceOptions
    frames : int
        Number of frames; 0 if unknown.
    metadata : mapping from str to str, int, float or bytes
        Metadata of the whole sequence.
    attributes : sequence of Attribute
        Attributes of the mesh, at the qualities of the options. Frames that are meshes bring their own: give none, or
        the same. Numbers of vertices may change from frame to frame; other attributes are those of the first frame of
        each run. Normals are left out, because they follow from positions.

    Attributes
    ----------
    vertex_order : int64 array, shape (n,)
        The decoder's vertex j is vertex `vertex_order[j]` of the frames of the present run; available once `chunks`
        has returned its first bytes.
    face_order : int64 array, shape (m,)
        The decoder's face i is face `face_order[i]`.
    notes : tuple of str
        Changes that the encoder made to its input.
    losses : tuple of str
        The notes about losses.
    run_starts : list of int
        The numbers of the first frames of all runs so far.
    samples : int
        Vertices times frames so far.
    max_error, max_error_relative : float
        The largest error of a vertex so far, in the unit of the mesh, and over the diagonal of the first frame.
    attribute_errors : mapping of str to float
        The largest error so far of each attribute that may move.
    kg : float
        The error of Karni and Gotsman so far, in percent, measured on decoded frames.
    worst_look : float or None
        The largest look distance so far of the frames that were drawn: the search for the step draws those that may be
        the worst, and the check the one with the largest normal error. None if this frame is invisible.

    Examples
    --------
    >>> import bsm
    >>> positions, faces = bsm.decode_sequence("dance.bsm")
    >>> encoder = bsm.SequenceEncoder(faces, bsm.SequenceOptions(step=0.005), frames=len(positions))
    >>> with open("again.bsm", "wb") as file:
    ...     for chunk in encoder.chunks(positions):
    ...         size = file.write(chunk)
    """

    def __init__(
        self,
        faces: npt.ArrayLike,
        options: SequenceOptions | None = None,
        frames: int = 0,
        metadata: Metadata = MappingProxyType({}),
        attributes: Sequence[Attribute] = (),
    ) -> None:
        self.options = options or SequenceOptions()
        self.vertex_order: Order = np.empty(0, np.int64)
        self.face_order: Order = np.empty(0, np.int64)
        self.notes: tuple[str, ...] = ()
        self.losses: tuple[str, ...] = ()
        self.run_starts: list[int] = []
        self.samples = 0
        self._faces = faces
        self._count = frames
        if not isinstance(attributes, Sequence) or not all(
            isinstance(a, Attribute) for a in attributes
        ):
            raise ArgumentError("the attributes of a sequence must be a list of Attribute")
        self._attributes = tuple(attributes)
        self._metadata = checked_metadata(metadata)
        if self.options.frame_rate:
            self._metadata = {**self._metadata, "frame_rate": float(self.options.frame_rate)}
        # At the beginning: with live frames, an error after an hour would be too late.
        packets.Metadata(self._metadata).require_readable()

    @property
    def kg(self) -> float:
        return self._verifier.kg

    @property
    def max_error(self) -> float:
        return self._verifier.farthest

    @property
    def max_error_relative(self) -> float:
        return self._verifier.farthest_relative

    @property
    def attribute_errors(self) -> Mapping[str, float]:
        return self._verifier.attribute_errors

    @property
    def worst_look(self) -> float | None:
        checked = self._verifier.worst_look
        return None if checked is None else max(checked, self._drawn)

    def chunks(self, frames: Iterable[Frame], progress: Progress | None = None) -> Iterator[bytes]:
        """Yield the stream, section by section; each GOP as soon as its frames have arrived.

        Parameters
        ----------
        frames : iterable of array_like, shape (n, 3), or TriangleMesh
            With `options.runs`, a mesh of other faces begins a run.
        progress : callable, optional
            Called with the finished work and the total; again for every attempt at a target.

        Raises
        ------
        MeshError
            If a frame is not finite or has another shape or other faces than the first, or the sequence is empty.
        """
        if self.options.target is None:
            yield from self._chunks(frames, self.options, progress)
        else:
            yield from self.search(frames, progress).chunks

    def search(self, frames: Iterable[Frame], progress: Progress | None = None) -> SequenceAttempt:
        """Search for the step with which `frames`, each of shape (n, 3), or meshes, reach the options' target.

        If there is none, `TargetError` names the best possible value.
        """
        target = self.options.target
        if target is None:
            raise OptionError("no target to search for")
        # A target is for the whole sequence, so it is coded several times, and an iterator gives its frames once.
        given_frames = list(frames)
        for run in RunSplitter(given_frames, self._faces, allowed=self.options.runs).runs():
            # The bits of runs depend on their meshes, of which no step is a function.
            if run.first:
                raise OptionError(
                    f"the faces change at frame {run.first}: a target is for frames that share them; "
                    "take a preset or a bound"
                )
            # The splitter moves on only when the frames of a run have been taken.
            deque(run.frames, maxlen=0)
        finest = finest_step([_positions(frame) for frame in given_frames], self.options)
        first, rise = self.options.step, RISES.get(target.kind, 1.0)
        best = search_step(
            lambda step: self.attempt(given_frames, step, progress), target, first, finest, rise
        )
        self._verifier, self._drawn = best.verifier, best.drawn
        return best

    def attempt(
        self, frames: Sequence[Frame], step: float, progress: Progress | None = None
    ) -> SequenceAttempt:
        """Encode frames, each of shape (n, 3), or meshes, with a given step, and compare the decoded ones."""
        pairs: list[Measured] = []
        chunks = tuple(self._chunks(frames, replace(self.options, step=step), progress, pairs))
        if len(self.run_starts) > 1:
            raise MeshError(
                f"joined vertices part at frame {self.run_starts[1]}: a target is for frames of one run"
            )
        original, decoded = (np.array([frame[side] for frame in pairs]) for side in (0, 1))
        compared = compare_sequences(original, decoded, pairs[0][2])
        return SequenceAttempt(chunks, self.samples, compared, self._verifier, self._drawn)

    def _chunks(
        self,
        frames: Iterable[Frame],
        options: SequenceOptions,
        progress: Progress | None,
        pairs: list[Measured] | None = None,
    ) -> Iterator[bytes]:
        steps: _Rounds | None = None
        self._verifier = verifier = SequenceVerifier(options, self._metadata, pairs)
        meshes = Meshes()
        writer = SectionWriter()
        number = 0
        self.run_starts, self.samples, self._checksum, self._drawn = [], 0, 0, 0.0
        splitter = RunSplitter(
            frames, self._faces, allowed=options.runs, attributes=self._attributes
        )
        runs = joined_runs(
            self._as_sent(splitter),
            options.together,
            keep_order=options.keep_order,
            allowed=options.runs,
        )
        for index, run in enumerate(runs):
            if not index:
                gops = -(-self._count // options.together(len(run.joined.first)))
                # Without the number of frames, progress cannot be given as a fraction.
                if gops and progress is not None:
                    searches = options.promise is not None
                    steps = _Rounds(progress, gops + (not searches), searches=searches)
                yield verifier.take(writer.start())
            for packet in self._run(run, index, meshes, options, steps or silent):
                # The verifier decodes with the limits of the target. What it refuses, the user's decoders would refuse.
                with as_of_decoders(options.limits):
                    chunk = verifier.take(writer.write(packet))
                yield chunk
            number = run.first + self._done
        if not self.run_starts:
            raise MeshError("a sequence needs at least one frame")
        # The header has announced them already, and decoders wait for them.
        if self._count and number != self._count:
            raise OptionError(f"{self._count} frames were announced and {number} came")
        changes = (
            f"{name} changes at frame {first}, but stays as before"
            for name, first in splitter.changed.items()
        )
        self.losses = (*self.losses, *changes)
        self.notes = tuple(dict.fromkeys((*self.notes, *self.losses)))
        end = verifier.take(writer.end(self._checksum), last=True)
        if steps is not None:
            steps.finish()
        yield end

    def _as_sent(self, splitter: RunSplitter) -> Iterator[Run]:
        """Runs with the attributes that each is sent with."""
        for run in splitter.runs():
            attributes = tuple(
                attribute for attribute in run.mesh.attributes if attribute.semantic != "normal"
            )
            # The caller's attributes belong to the first run; later meshes bring their own.
            current = attributes if run.first or not self._attributes else self._attributes
            yield replace(run, mesh=replace(run.mesh, attributes=current))

    def _run(
        self,
        run: JoinedRun,
        index: int,
        meshes: Meshes,
        options: SequenceOptions,
        progress: Progress,
    ) -> Iterator[packets.Packet]:
        """The packets of a run; `_done` grows by its frames."""
        self.run_starts.append(run.first)
        self._done, earlier = 0, meshes.find(run)
        prepared = earlier.prepared if earlier else _prepared(run, options)
        original = AsGiven(run.mesh, run.joined, prepared)
        self.vertex_order = original.vertex_order
        self.face_order = run.joined.coded_faces[prepared.face_order].astype(np.int64)
        frames = (frame[prepared.coding_order] for frame in run.frames)
        longest = options.together(len(prepared.positions))
        group = next_group(frames, longest, prepared, run.moving)
        encoder = RunEncoder(prepared, options, self._count, progress)
        if earlier is None:
            more = len(group) == longest and run.first + longest != self._count
            carried, coders = self._carried(run, prepared, options, group, more=more)
            resting = tuple(attribute for attribute in carried if not attribute.declaration.moves)
            gops = encoder.first(group, meshes.costs, [coder.start for coder in coders])
            mesh = OpenedMesh(index, prepared, gops, coders, resting)
            begun = self._opened(run, index, prepared, gops.first_frame, carried)
        else:
            mesh = replace(earlier, gops=encoder.again(group, earlier.gops))
            head, again = mesh.gops.first_frame.header, (index, earlier.run)
            begun = iter(
                [
                    Header(
                        vertices=head.vertices,
                        faces=head.faces,
                        sequence=(self._count, longest),
                        run=again,
                    )
                ]
            )
        self._verifier.expect_mesh(original, mesh.resting)
        yield from begun
        for track, coder in enumerate(mesh.coders, 1):
            coder.begin(mesh.gops.encoder, track)
        moving = {coder.name for coder in mesh.coders}
        still = {name: values[0] for name, values in group.moving.items() if name not in moving}
        while len(group):
            yield from self._coded(run, index, mesh, group)
            # A group is the largest thing in memory. Two of them would double it.
            del group  # before the next one is read
            group = next_group(frames, longest, prepared, run.moving)
            if len(group):
                mesh = replace(mesh, gops=encoder.next(group, self._done, mesh.gops))
                for name, values in still.items():
                    if (group.moving[name] != values).any():
                        # The first group stood still, so the values were sent exactly. Now it is too late to send them
                        # otherwise.
                        raise OptionError(
                            f"{name!r} moves, and floats that do cannot be exact; ask for a bound"
                        )
        self.notes = tuple(dict.fromkeys((*self.notes, *(coder.note for coder in mesh.coders))))
        meshes.keep(mesh, run)

    def _coded(
        self, run: JoinedRun, index: int, mesh: OpenedMesh, group: Group
    ) -> Iterator[packets.Gop]:
        """The GOPs of a group of frames, which the verifier then expects."""
        gops, coders, units = mesh.gops, mesh.coders, mesh.prepared.units
        self._drawn = max(self._drawn, gops.worst_look)
        bodies = with_fields(gops.bodies, coders, group.moving)
        for number, frame in enumerate(gops.decoded_frames()):
            positions = units.back(frame)
            self._checksum = checksum_of(positions, self._checksum)
            moving = tuple(coder.expected(group.moving[coder.name][number]) for coder in coders)
            self._verifier.expect_frame(ExpectedFrame(positions, group.positions[number], moving))
        for body in bodies:
            if 0 < self._count < run.first + self._done + body.frames:
                raise OptionError(f"{self._count} frames were announced and more came")
            # Decoders grant memory by the bytes that have arrived, so the encoder keeps the same account.
            gops.first_frame.costs.received += body.size
            yield packets.Gop(
                run.first + self._done,
                write_gop_body(body, index, [coder.number for coder in coders]),
            )
            self._done += body.frames
            self.samples += body.frames * len(self.vertex_order)

    def _carried(
        self,
        run: JoinedRun,
        prepared: Prepared,
        options: SequenceOptions,
        group: Group,
        *,
        more: bool,
    ) -> tuple[tuple[PreparedAttribute, ...], tuple[MovingAttributeEncoder, ...]]:
        """Return the attributes of a run with its own mesh, and encoders of those that move, or may if `more` comes."""
        mesh, chosen = run.mesh, dict(options.attributes)
        move = {name for name, values in group.moving.items() if (values != values[:1]).any()}
        # Whether an attribute ever moves is unknown while more frames may come. It is declared as moving, and costs
        # nothing while it rests.
        may = move | (set(group.moving) if more else set())
        bounds = {
            a.name: Bound(quality, a)
            for a, quality in qualities(mesh.attributes, chosen, "balanced", moving=may)
        }
        pairs = []
        for attribute, quality in qualities(mesh.attributes, chosen, "balanced", moving=move):
            if attribute.name in move:
                bounds[attribute.name] = bounds[attribute.name].over(group.moving[attribute.name])
                quality = bounds[attribute.name].of_first
            elif quality.way == "recompute":
                raise OptionError(
                    f"{attribute.name!r}: normals of a sequence cannot be recomputed; ask for 2deg or none"
                )
            elif attribute.name not in may or (
                quality.way == "exact" and attribute.values.dtype.kind == "f"
            ):
                del bounds[attribute.name]
            pairs.append((attribute, quality))
        carried = carry(run.joined.coding, prepared.mesh.faces, pairs, 0)
        carried = tuple(
            replace(a, declaration=replace(a.declaration, moves=1))
            if a.declaration.name in bounds
            else a
            for a in carried
        )
        coders = tuple(
            MovingAttributeEncoder(
                number,
                attribute,
                group.moving[attribute.declaration.name][0],
                bounds[attribute.declaration.name],
            )
            for number, attribute in enumerate(carried)
            if attribute.declaration.moves
        )
        return carried, coders

    def _opened(
        self,
        run: JoinedRun,
        index: int,
        prepared: Prepared,
        first: FirstFrame,
        carried: tuple[PreparedAttribute, ...],
    ) -> Iterator[packets.Packet]:
        """Return the sections before the GOPs of a run with its own mesh."""
        notes = (attribute.note for attribute in carried if not attribute.declaration.moves)
        order = (
            f"the order of vertices and faces takes {len(turn.data)} of the bytes"
            for turn in prepared.order
        )
        self.losses = tuple(dict.fromkeys((*self.losses, *run.joined.losses)))
        self.notes = tuple(dict.fromkeys((*self.notes, *run.joined.notes, *notes, *order)))
        body = (*prepared.before_blocks, *(block.packet for block in first.blocks))
        draft = Draft(
            replace(first.header, run=(index,) if index else ()), body, run.mesh.positions
        )
        draft = with_attributes(draft, carried, {} if index else self._metadata)
        yield from (draft.header, *draft.body)


@dataclass(frozen=True, eq=False)
class OpenedMesh:
    """A mesh of earlier runs: the run that brought it, its last coded state, and the encoder of its motion."""

    run: int
    prepared: Prepared
    gops: EncodedGops
    coders: tuple[MovingAttributeEncoder, ...]
    resting: tuple[PreparedAttribute, ...]


class Meshes:
    """The meshes that decoders keep, those that runs have had last: a run can have one of them again."""

    def __init__(self) -> None:
        self.costs = Kept()
        # By the run that brought them, the one used last at the end.
        self._opened: dict[int, OpenedMesh] = {}
        # The run that brought a mesh, and that, by its faces.
        self._known: dict[bytes, tuple[int, TriangleMesh]] = {}

    def find(self, begun: JoinedRun) -> OpenedMesh | None:
        """Return the kept mesh of a run that begins; None: the mesh must be sent."""
        run, before = self._known.get(_digest(begun), (-1, begun.mesh))
        opened = self._opened.get(run)
        if opened is not None:
            moving = {coder.name for coder in opened.coders}
            others = (attribute for attribute in before.attributes if attribute.name not in moving)
            if all(has(begun.mesh.attributes, attribute) for attribute in others):
                # The mesh comes back, but what decoders keep has changed since.
                opened.gops.first_frame.costs = replace(self.costs)
                return opened
        # The least recently used one goes, by the same rule as in decoders, to the mesh.
        if len(self._opened) == KEPT_MESHES:
            oldest = self._opened.pop(next(iter(self._opened))).gops.first_frame
            self.costs.vertices -= oldest.header.vertices
            self.costs.memory -= oldest.memory
        return None

    def keep(self, opened: OpenedMesh, ended: JoinedRun) -> None:
        """Take note that a run of this mesh has ended."""
        self.costs = replace(opened.gops.first_frame.costs)
        # Taken out and put in again: a dictionary keeps the order of insertion, and this one is by last use.
        self._opened.pop(opened.run, None)
        self._opened[opened.run] = opened
        bare = TriangleMesh(ended.mesh.positions, ended.mesh.faces, ended.mesh.attributes)
        self._known[_digest(ended)] = opened.run, bare


def _digest(run: JoinedRun) -> bytes:
    """Return a digest that runs of the same faces, joins and resting attributes share."""
    mesh, moving = run.mesh, {attribute.name for attribute in run.moving}
    # A digest, since comparing a mesh with all earlier ones would need all their faces.
    digest = sha256(
        len(mesh.positions).to_bytes(8, "little")
        + mesh.faces.tobytes()
        + run.joined.index.tobytes()
    )
    for attribute in mesh.attributes:
        digest.update(repr(kind_of(attribute)).encode())
        digest.update(b"" if attribute.name in moving else attribute.values.tobytes())
        if attribute.indices is not None:
            digest.update(attribute.indices.tobytes())
    return digest.digest()


def _prepared(run: JoinedRun, options: SequenceOptions) -> Prepared:
    run.joined.mesh.require_sizes(*PROMISED_SIZES)
    # Values of attributes follow the order of faces, and might lose more than faces gain on edges.
    repeats = AS_CORNERS if run.mesh.attributes else WHERE_SMALLER
    parts = Parts(options.block_size, options.overlap)
    return prepare(run.joined, parts, keep_order=options.keep_order, repeats=repeats)


def _positions(frame: Frame) -> Matrix:
    return np.asarray(frame.positions if isinstance(frame, TriangleMesh) else frame, np.float64)


class _Rounds:
    """Reports the rounds of the first frame and of all GOPs as the progress of one task."""

    def __init__(self, progress: Progress, rounds: int, *, searches: bool) -> None:
        preparing, coding, finishing = _SEARCHED if searches else _CODED_ONCE
        self._stages = Stages(
            progress, {"preparing": preparing, "coding": coding, "finishing": finishing}
        )
        self._rounds, self._done = rounds, 0

    def __call__(self, finished: int, blocks: int) -> None:
        # There may be more rounds than were foreseen, since GOPs can be cut.
        rounds = max(self._rounds, self._done + 1)
        share = finished / blocks
        self._stages.report("preparing", 1.0)
        self._stages.report("coding", (self._done + share) / rounds)
        self._done += finished == blocks

    def finish(self) -> None:
        """Report that all is done."""
        self._stages.report("coding", 1.0)
        self._stages.report("finishing", 1.0)


def _refuse_changing_sizes(positions: object) -> None:
    """Raise an error that names the first frame with another number of vertices, if there is one."""
    if not isinstance(positions, (list, tuple)):
        return
    sizes = [len(frame) for frame in positions if hasattr(frame, "__len__")]
    number = next((place for place, size in enumerate(sizes) if size != sizes[0]), None)
    if number is not None:
        raise MeshError(
            f"frame {number} has {sizes[number]} vertices, and frame 0 has {sizes[0]}; encode_frames takes frames of "
            "different meshes"
        )


def frames_of(positions: npt.ArrayLike) -> Positions:
    """Positions of frames, shape (T, n, 3), checked."""
    try:
        frames = np.asarray(positions, np.float64)
    except (TypeError, ValueError, OverflowError) as error:
        _refuse_changing_sizes(positions)
        raise MeshError(
            f"the positions of a sequence are not an array of numbers: {error}"
        ) from error
    if frames.ndim != 3 or frames.shape[2] != 3 or len(frames) == 0:
        raise MeshError(
            f"the positions of a sequence must have shape (T, n, 3), T > 0, not {frames.shape}"
        )
    return frames
