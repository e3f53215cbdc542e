"""Frames to a stream: the encoder of sequences, which holds one GOP at most."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import chain

import numpy as np
import numpy.typing as npt

from bitstream.connectivity.faces import encode_connectivity
from bitstream.connectivity.order import encode_arrangement
from bitstream.container import packets
from bitstream.container.gop import write_gop_body
from bitstream.container.header import Header
from bitstream.container.writer import Writer
from bitstream.errors import MeshError, OptionError
from codec.blocks.blend import Blend
from codec.blocks.overlap import block_size, grow_blocks
from codec.blocks.partition import derive_partition
from codec.geometry.graph import graph_of_faces
from codec.geometry.mesh import Faces, TriangleMesh
from codec.sequence.decoder import decode_sequence
from codec.sequence.gop_decoder import Setting, make_setting
from codec.sequence.gop_encoder import GopEncoder
from codec.sequence.options import SequenceOptions
from codec.sequence.row_prediction import LARGEST_LEVEL
from codec.sequence.targets import SequenceComparison, compare_sequences
from codec.signal.quantize import smallest_step
from codec.static.decoder import CONNECTIVITY_METHOD, ORDER_METHOD, chain_rules
from codec.static.encoder import STIFFNESS, ChainEncoder, CodedBlock, Progress
from codec.static.encoder import _frame_of_reference as frame_of_reference
from codec.static.options import EncodeOptions
from codec.static.targets import search_step

Matrix = npt.NDArray[np.float64]


FINEST_STEP = 2e-5
"""Below, a search for a target does not look."""


@dataclass(frozen=True, eq=False)
class SequenceAttempt:
    """A whole stream, and what its decoder will make of it.

    Parameters
    ----------
    chunks : tuple of bytes
        The stream.
    samples : int
        Vertices times frames.
    comparison : SequenceComparison
        The decoded frames against the original ones.
    """

    chunks: tuple[bytes, ...]
    samples: int
    comparison: SequenceComparison

    @property
    def bpvf(self) -> float:
        """Bits of the whole stream per vertex and frame."""
        return 8.0 * sum(map(len, self.chunks)) / self.samples


class SequenceEncoder:
    """Encodes frames that share their faces.

    Parameters
    ----------
    faces : array_like of int, shape (m, 3)
        Vertices that no face uses are left out.
    options : SequenceOptions
    frames : int
        Number of frames, 0 if it is not known.

    Attributes
    ----------
    vertex_order : int64 array, shape (n,)
        The decoder's vertex j is vertex `vertex_order[j]` of the frames; known once `chunks` has given its first bytes.
    face_order : int64 array, shape (m,)
        The decoder's face i is face `face_order[i]`.
    notes : tuple of str
        What was changed on the way in.
    """

    def __init__(self, faces: npt.ArrayLike, options: SequenceOptions | None = None, frames: int = 0) -> None:
        self.options = options or SequenceOptions()
        self.vertex_order: npt.NDArray[np.int64] = np.empty(0, np.int64)
        self.face_order: npt.NDArray[np.int64] = np.empty(0, np.int64)
        self.notes: tuple[str, ...] = ()
        self._faces = faces
        self._count = frames

    def chunks(self, frames: Iterable[npt.ArrayLike], progress: Progress | None = None) -> Iterator[bytes]:
        """The stream, stream frame by stream frame; each GOP is given as soon as its frames are there.

        Parameters
        ----------
        frames : iterable of array_like, shape (n, 3)
        progress : callable, optional
            Called with the number of blocks done and of all blocks of all GOPs, once for every attempt at a target.

        Raises
        ------
        MeshError
            If a frame is not finite or has another shape than the first, or there is no frame.
        """
        if self.options.target is None:
            yield from self._chunks(frames, self.options, progress)
        else:
            yield from self.search([np.asarray(frame, np.float64) for frame in frames], progress).chunks

    def search(self, frames: Sequence[Matrix], progress: Progress | None = None) -> SequenceAttempt:
        """Look for the step that meets the options' target; `TargetError` says what can be had where none does."""
        target = self.options.target
        if target is None:
            raise OptionError("there is no target to search for")
        finest = max(FINEST_STEP, self._finest_step(frames))
        return search_step(  # type: ignore[type-var]  # a sequence's target knows a sequence's outcome
            lambda step: self.attempt(frames, step, progress), target, self.options.step, finest
        )

    def _finest_step(self, frames: Sequence[Matrix]) -> float:
        """A step whose levels can be coded however the motion falls into one component."""
        scale = float(np.linalg.norm(np.ptp(frames[0], axis=0))) or 1.0
        reach = max(float(np.abs(frame - frames[0].mean(axis=0)).max()) for frame in frames) / scale
        values = 3 * min(self.options.gop, len(frames)) * 2 * self.options.block_size
        return 2.0 * reach * np.sqrt(values) / LARGEST_LEVEL

    def attempt(self, frames: Sequence[Matrix], step: float, progress: Progress | None = None) -> SequenceAttempt:
        """Encode with a given step, and see what the decoder will."""
        chunks = tuple(self._chunks(frames, replace(self.options, step=step), progress))
        decoded, faces = decode_sequence(b"".join(chunks), threads=self.options.threads)
        original = np.array([frame[self.vertex_order] for frame in frames])
        return SequenceAttempt(chunks, decoded.size // 3, compare_sequences(original, decoded, faces))

    def _chunks(
        self, frames: Iterable[npt.ArrayLike], options: SequenceOptions, progress: Progress | None
    ) -> Iterator[bytes]:
        source = iter(frames)
        first = next(source, None)
        if first is None:
            raise MeshError("a sequence needs at least one frame")
        gops = -(-self._count // (options.gop if options.mode == "gop" else 1))
        tell = _Rounds(progress if gops else None, 1 + gops)
        mesh = TriangleMesh(np.asarray(first), np.asarray(self._faces))
        opening = OpeningEncoder(mesh, options, self._count, tell)
        self.vertex_order, self.face_order = opening.vertex_order, opening.face_order
        writer = Writer()
        yield writer.start()
        yield writer.write(opening.header)
        yield writer.write(opening.connectivity)
        if opening.order is not None:
            yield writer.write(opening.order)
        for block in opening.coded:
            yield writer.write(block.packet)
        encoder = GopEncoder(opening.setting(), options)
        number = 0
        checked = self._checked(chain([first], source), np.shape(first), opening)
        while group := list(_taken(checked, opening.header.gop_frames)):
            body = encoder.encode(np.array(group), number, tell)
            yield writer.write(packets.Gop(number, write_gop_body(body)))
            number += len(group)
        if self._count and number != self._count:
            raise OptionError(f"{self._count} frames were announced and {number} came")
        yield writer.end()

    def _checked(
        self, frames: Iterable[npt.ArrayLike], shape: tuple[int, ...], opening: OpeningEncoder
    ) -> Iterator[Matrix]:
        """Frames in BSM units, in the decoder's order of vertices."""
        for number, frame in enumerate(frames):
            positions = np.asarray(frame, np.float64)
            if positions.shape != shape:
                raise MeshError(f"frame {number} has shape {positions.shape}, the first one {shape}")
            positions = positions[opening.coding_order]
            if not np.isfinite(positions).all():
                raise MeshError(f"frame {number} has a coordinate that is not finite; remove or repair it")
            yield opening.in_units(positions)


class OpeningEncoder:
    """Everything before the GOPs: connectivity, and the first frame, coded as a static mesh is."""

    def __init__(self, mesh: TriangleMesh, options: SequenceOptions, frames: int, progress: Progress) -> None:
        used, kept = mesh.without_isolated_vertices()
        connectivity = encode_connectivity(used.faces, len(kept))
        self.connectivity = packets.Connectivity(CONNECTIVITY_METHOD, connectivity.payload)
        self.coding_order: npt.NDArray[np.int64] = kept[connectivity.vertex_order]
        self.vertex_order = self.coding_order
        self.face_order: npt.NDArray[np.int64] = connectivity.face_order.astype(np.int64)
        self.order: packets.Order | None = None
        if options.keep_order:
            self.order = packets.Order(ORDER_METHOD, encode_arrangement(used.faces, connectivity))
            self.vertex_order, self.face_order = kept, np.arange(len(used.faces))
        self._faces: Faces = connectivity.faces
        self._options = options
        ordered = TriangleMesh(mesh.positions[self.coding_order], connectivity.faces)
        self._center, self._scale = frame_of_reference(ordered)
        graph = graph_of_faces(connectivity.faces, len(kept))
        partition = derive_partition(graph, max(1, round(len(kept) / options.block_size)))
        self._size = block_size(partition, options.overlap)
        self._blocks = grow_blocks(graph, partition, self._size)
        self.header = self._header(partition.parts, frames)
        coder = ChainEncoder(self.header, chain_rules(self.header), self._blocks, EncodeOptions())
        positions = self.in_units(ordered.positions)
        self.coded: list[CodedBlock] = []
        for index in range(self._blocks.count):
            self.coded.append(coder.encode(index, positions))
            progress(len(self.coded), self._blocks.count)

    def in_units(self, positions: Matrix) -> Matrix:
        """Positions in BSM units."""
        return (positions - self._center) / self._scale

    def setting(self) -> Setting:
        """What the decoder will have when the first frame is complete."""
        blend = Blend(self.header.vertices)
        for block in self.coded:
            blend.add(block.vertices, block.positions, block.weights)
        first = blend.positions(np.arange(self.header.vertices, dtype=np.int32))
        return make_setting(self.header, self._faces, self._blocks, first, self._options.threads)

    def _header(self, parts: int, frames: int) -> Header:
        options, finest = self._options, smallest_step(self._size)
        step = options.first_step or max(options.step / 2, finest)
        if step < finest:
            raise OptionError(f"first_step = {step:g} is too fine for blocks of {self._size}, try {finest:.1e}")
        return Header(
            vertices=len(self.vertex_order),
            faces=len(self._faces),
            blocks=parts,
            block_size=self._size,
            coefficients=max(1, round(options.keep * self._size)),
            basis=1,
            step=float(np.float32(step)),
            center=tuple(self._center),
            scale=self._scale,
            prediction=(STIFFNESS,),
            frames=frames,
            frame_rate=float(np.float32(options.frame_rate)),
            gop_frames=options.gop if options.mode == "gop" else 1,
            weights=("binary", "cotangent").index(options.weights),
        )


class _Rounds:
    """Tells of rounds over the same blocks, the first frame's and one for each GOP, as of one large piece of work."""

    def __init__(self, progress: Progress | None, rounds: int) -> None:
        self._progress = progress
        self._rounds = rounds
        self._done = 0

    def __call__(self, done: int, blocks: int) -> None:
        if self._progress is not None:
            self._progress(self._done * blocks + done, self._rounds * blocks)
        self._done += done == blocks


def encode_sequence(positions: npt.ArrayLike, faces: npt.ArrayLike, options: SequenceOptions | None = None) -> bytes:
    """Encode frames, `positions` of shape (T, n, 3), to a complete stream."""
    frames = np.asarray(positions, np.float64)
    if frames.ndim != 3 or frames.shape[2] != 3 or len(frames) == 0:
        raise MeshError(f"the positions of a sequence must have shape (T, n, 3), T > 0, not {frames.shape}")
    return b"".join(SequenceEncoder(faces, options, len(frames)).chunks(frames))


def _taken(frames: Iterator[Matrix], count: int) -> Iterator[Matrix]:
    for _ in range(count):
        frame = next(frames, None)
        if frame is None:
            return
        yield frame
