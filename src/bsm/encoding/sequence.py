"""Sequences to streams: a job of `bsm encode` whose input is one."""

from __future__ import annotations

import math
import time
from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from bsm import options
from bsm.batch import Facts, came_to, size_of
from bsm.bitstream.errors import OptionError
from bsm.codec.arrays import Positions
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.console import Console, Progress, finite
from bsm.encoding.job import EncodeJob
from bsm.files.motion.frames import Frames, Wanted
from bsm.files.output import open_output
from bsm.files.permutation import write_permutation
from bsm.files.sequence import open_frames, open_sequence
from bsm.files.sequence_stream import said_of_runs
from bsm.loops import Loops

if TYPE_CHECKING:
    from bsm.codec.sequence.options import SequenceOptions

_OF_SEQUENCES = ("kg", "bpvf", "gop", "low_delay", "frame_rate", "runs")
"""Wishes that only a sequence can fulfil: a GLB is then one."""


def sequence_of(job: EncodeJob) -> Frames | None:
    """The sequence that a job's input is; None: it is perhaps a mesh."""
    if job.members:
        return open_frames(job.members, job.format, job.reader, runs=bool(job.wishes.get("runs")))
    asked = (job.animation, job.cache_mesh, *(job.wishes.get(name) for name in _OF_SEQUENCES))
    if all(one is None for one in asked):
        return open_sequence(job.input, job.format, job.reader)
    runs = bool(job.wishes.get("runs"))
    wanted = Wanted(job.wishes.get("frame_rate") or 0.0, job.animation or "", job.cache_mesh, runs)
    return open_sequence(job.input, job.format, job.reader, wanted)


def encode_sequence(job: EncodeJob, console: Console, source: Frames) -> Facts:
    """Encode one sequence; every GOP is written as soon as its frames are there."""
    from bsm.codec.sequence.encoder import SequenceEncoder

    begin = time.perf_counter()
    chosen = options.sequence_options(**job.wishes, threads=job.threads)
    if job.permutation and chosen.runs:
        raise OptionError("--permutation is the order of one mesh, and runs=yes lets the faces change")
    rate = {"frame_rate": source.frame_rate} if source.frame_rate else {}
    metadata = {**source.metadata, **rate, **job.metadata}
    encoder = SequenceEncoder(source.faces, chosen, source.count, metadata, source.attributes)
    heard = Echo()
    size = 0
    replace = job.may_replace(job.output)
    with open_output(job.output, overwrite=replace) as file, console.progress("encoding") as progress:
        taken = source.frames if source.meshes is None else source.meshes
        given = _staged(heard.taken(taken, job.compared), source.count, chosen, progress)
        for chunk in encoder.chunks(given, progress):
            size += file.write(chunk)
            file.flush()
            if job.compared:
                heard.compare(chunk, encoder.vertex_order)
    seconds = time.perf_counter() - begin
    runs = encoder.run_starts[1:]
    notes = (
        *source.notes,
        *encoder.notes,
        *([said_of_runs(runs)] if runs else heard.loops.said()),
    )
    for note in notes:
        console.note(f"{job.input}: {note}")
    if job.permutation:
        write_permutation(job.permutation, encoder.vertex_order, overwrite=job.force)
    vertices, faces, frames = len(encoder.vertex_order), len(encoder.face_order), heard.frames
    bpvf = 8 * size / encoder.samples
    sizes = [size_of(name) or 0 for name in job.members]
    read = sum(sizes) if sizes else size_of(job.input)
    console.note(
        f"{job.input} -> {job.output}: {frames} frames of {vertices} vertices, {faces} faces"
        f"{' at the end' if runs else ''}, "
        f"{came_to(read, size)}, {bpvf:.3f} bits per vertex and frame; KG error {heard.kg:.3g} %, {seconds:.2f} s"
    )
    return {
        "input": job.input,
        "output": job.output,
        "frames": frames,
        "vertices": vertices,
        "faces": faces,
        "input_bytes": read,
        "output_bytes": size,
        "bytes": size,
        "bpvf_total": bpvf,
        "kg": finite(heard.kg),
        "seconds": seconds,
        "notes": list(notes),
    }


def _staged(
    frames: Iterator[Positions | TriangleMesh], count: int, chosen: SequenceOptions, progress: Progress
) -> Iterator[Positions | TriangleMesh]:
    """The frames, which begin a stage with each GOP."""
    for number, frame in enumerate(frames):
        longest = chosen.longest(len(frame.positions if isinstance(frame, TriangleMesh) else frame))
        if not chosen.low_delay and number and number % longest == 0:
            gops = f" of {-(-count // longest)}" if count else ""
            progress.stage(f"encoding GOP {1 + number // longest}{gops}")
        yield frame


@dataclass(frozen=True, eq=False)
class Kept:
    """A frame in half its memory: in single precision within its box, which is finer than any error that is told."""

    middle: Positions
    size: float
    offsets: npt.NDArray[np.float32]

    @classmethod
    def of(cls, positions: Positions) -> Kept:
        """Keep positions, shape (n, 3); of such as are not finite anything, since the encoder refuses them."""
        with np.errstate(all="ignore"):
            low, high = positions.min(axis=0), positions.max(axis=0)
            middle, size = low / 2 + high / 2, float((high / 2 - low / 2).max()) or 1.0
            return cls(middle, size, ((positions - middle) / size).astype(np.float32))

    def rows(self, order: np.ndarray) -> Positions:
        """The positions of some vertices, shape (n, 3)."""
        return np.asarray(self.offsets[order].astype(np.float64) * self.size + self.middle)


@dataclass
class Echo:
    """Hears what a decoder makes of a stream while it is written, and holds only the frames that are not out yet."""

    frames: int = 0
    loops: Loops = field(default_factory=Loops)
    _waiting: deque[Kept] = field(default_factory=deque)
    _squares: float = 0.0
    _extent: float = 0.0

    def __post_init__(self) -> None:
        from bsm.codec.sequence.decoder import SequenceDecoder

        self._decoder = SequenceDecoder()

    def taken(
        self, frames: Iterator[Positions] | Iterator[TriangleMesh], kept: bool
    ) -> Iterator[Positions | TriangleMesh]:
        """The frames, which are also kept until they have been compared."""
        for frame in frames:
            positions = frame.positions if isinstance(frame, TriangleMesh) else frame
            self.frames += 1
            self.loops.take(positions)
            if kept:
                self._waiting.append(Kept.of(positions))
            yield frame

    def compare(self, chunk: bytes, order: np.ndarray) -> None:
        """Decode a piece of the stream and add up the error of its frames; vertex j of a decoded one is `order[j]`."""
        from bsm.bitstream.container.reader import Signal
        from bsm.codec.sequence.events import FrameEvent

        self._decoder.receive_data(chunk)
        while not isinstance(event := self._decoder.next_event(), Signal):
            if isinstance(event, FrameEvent):
                frame = self._waiting.popleft().rows(order)
                self._squares += float(np.square(event.positions - frame).sum())
                self._extent += float(np.square(frame - frame.mean(axis=0)).sum())

    @property
    def kg(self) -> float:
        """Karni and Gotsman's error so far, in percent, see `codec.geometry.metrics.kg_error`."""
        if self._squares == 0.0:
            return 0.0
        return 100.0 * math.sqrt(self._squares / self._extent) if self._extent else math.inf
