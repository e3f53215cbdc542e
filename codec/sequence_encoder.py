"""Frames to a stream: the encoder of sequences, which holds one GOP at most."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import chain

import numpy as np
import numpy.typing as npt

from bitstream import packets
from bitstream.connectivity import encode_connectivity
from bitstream.errors import MeshError, OptionError
from bitstream.gops import MAX_EXPONENT, GopBody, GopMethod, write_gop_body
from bitstream.header import Header
from bitstream.sequence_coefficients import encode_levels, make_level_bank
from bitstream.writer import Writer
from codec.blend import Blend
from codec.blocks import block_size, grow_blocks
from codec.decoder import CONNECTIVITY_METHOD, chain_rules
from codec.encoder import STIFFNESS, ChainEncoder, CodedBlock
from codec.encoder import _frame_of_reference as frame_of_reference
from codec.graph import graph_of_faces
from codec.mesh import Faces, TriangleMesh
from codec.options import EncodeOptions
from codec.partition import derive_partition
from codec.quantize import smallest_step
from codec.sequence import Loop, cosine_basis, quantize_basis, trajectories
from codec.sequence_decoder import FrameHistory, Setting, decode_basis, level_references, make_setting
from codec.sequence_options import SequenceOptions
from codec.temporal import WORTH, bits_estimate, learn_basis, projection

Matrix = npt.NDArray[np.float64]


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
    """

    def __init__(self, faces: npt.ArrayLike, options: SequenceOptions | None = None, frames: int = 0) -> None:
        self.options = options or SequenceOptions()
        self.vertex_order: npt.NDArray[np.int64] = np.empty(0, np.int64)
        self.face_order: npt.NDArray[np.int64] = np.empty(0, np.int64)
        self._faces = faces
        self._count = frames

    def chunks(self, frames: Iterable[npt.ArrayLike]) -> Iterator[bytes]:
        """The stream, stream frame by stream frame; each GOP is given as soon as its frames are there.

        Parameters
        ----------
        frames : iterable of array_like, shape (n, 3)

        Raises
        ------
        MeshError
            If a frame is not finite or has another shape than the first, or there is no frame.
        """
        source = iter(frames)
        first = next(source, None)
        if first is None:
            raise MeshError("a sequence needs at least one frame")
        opening = OpeningEncoder(TriangleMesh(np.asarray(first), np.asarray(self._faces)), self.options, self._count)
        self.vertex_order, self.face_order = opening.vertex_order, opening.face_order
        writer = Writer()
        yield writer.start()
        yield writer.write(opening.header)
        yield writer.write(opening.connectivity)
        for block in opening.coded:
            yield writer.write(block.packet)
        encoder = GopEncoder(opening.setting(), self.options)
        number = 0
        checked = self._checked(chain([first], source), np.shape(first), opening)
        while group := list(_taken(checked, opening.header.gop_frames)):
            body = encoder.encode(np.array(group), number)
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
            positions = positions[opening.vertex_order]
            if not np.isfinite(positions).all():
                raise MeshError(f"frame {number} has a coordinate that is not finite; remove or repair it")
            yield opening.in_units(positions)


class OpeningEncoder:
    """Everything before the GOPs: connectivity, and the first frame, coded as a static mesh is."""

    def __init__(self, mesh: TriangleMesh, options: SequenceOptions, frames: int) -> None:
        used, kept = mesh.without_isolated_vertices()
        connectivity = encode_connectivity(used.faces, len(kept))
        self.connectivity = packets.Connectivity(CONNECTIVITY_METHOD, connectivity.payload)
        self.vertex_order: npt.NDArray[np.int64] = kept[connectivity.vertex_order]
        self.face_order: npt.NDArray[np.int64] = connectivity.face_order.astype(np.int64)
        self._faces: Faces = connectivity.faces
        self._options = options
        ordered = TriangleMesh(mesh.positions[self.vertex_order], connectivity.faces)
        self._center, self._scale = frame_of_reference(ordered)
        graph = graph_of_faces(connectivity.faces, len(kept))
        partition = derive_partition(graph, max(1, round(len(kept) / options.block_size)))
        self._size = block_size(partition, options.overlap)
        self._blocks = grow_blocks(graph, partition, self._size)
        self.header = self._header(partition.parts, frames)
        coder = ChainEncoder(
            self.header, chain_rules(self.header), self._blocks, EncodeOptions(rounding=options.rounding)
        )
        positions = self.in_units(ordered.positions)
        self.coded: list[CodedBlock] = [coder.encode(index, positions) for index in range(self._blocks.count)]

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


class GopEncoder:
    """Encodes one GOP after the other."""

    def __init__(self, setting: Setting, options: SequenceOptions) -> None:
        self._setting = setting
        self._options = options
        self._step = float(np.float32(options.step))
        self._history: FrameHistory | None = None

    def encode(self, frames: Matrix, number: int) -> GopBody:
        """Encode frames, shape (T, n, 3), in BSM units, from frame `number` of the sequence on."""
        if self._options.mode == "low-delay":
            return self._single(frames[0], key=number % self._options.gop == 0)
        return self._transformed(trajectories(frames))

    def _single(self, wanted: Matrix, key: bool) -> GopBody:
        history = self._history
        if key or history is None:
            history = self._history = FrameHistory(self._setting.first)
        frame = np.zeros_like(wanted)
        levels, coefficients = [], []
        for k, part in enumerate(self._setting.parts):
            base = history.base(k)
            target = part.basis.T @ wanted[part.vertices] - part.extend(frame) - base
            coded, change = history.loops[k].encode(history.known(k), target, self._step, self._options.rounding)
            levels.append(coded)
            coefficients.append(base + change)
            part.place(frame, coefficients[k])
        payload = encode_levels(history.bank, levels, history.levels)
        history.commit(levels, coefficients)
        method = GopMethod.KEY_FRAME if key else GopMethod.NEXT_FRAME
        return GopBody(method, 1, self._step, 3, np.empty(0, np.int32), b"", payload)

    def _transformed(self, motion: Matrix) -> GopBody:
        """Encode trajectories, shape (n, 3T)."""
        candidates = []
        if self._options.transform != "cosine":
            candidates.append(self._learnt(motion))
        if self._options.transform != "learnt":
            candidates.append(self._cosines(motion))
        body = min(candidates, key=lambda candidate: self._cost(motion, candidate)) if candidates[1:] else candidates[0]
        return self._coded(motion, body)

    def _learnt(self, motion: Matrix) -> GopBody:
        basis = learn_basis(motion, self._step, MAX_EXPONENT)
        levels = quantize_basis(basis.columns, basis.exponents, self._options.rounding)
        columns = basis.columns.shape[1]
        coded = encode_levels(make_level_bank(), list(levels), level_references(list(levels), columns))
        return GopBody(GopMethod.LEARNT, levels.shape[1], self._step, columns, basis.exponents, coded, b"")

    def _cosines(self, motion: Matrix) -> GopBody:
        frames = motion.shape[1] // 3
        energies = np.square(motion @ cosine_basis(frames)).sum(axis=0)
        worth = np.flatnonzero(energies > WORTH * self._step**2)
        columns = int(np.max(worth, initial=0)) + 1
        return GopBody(GopMethod.COSINES, frames, self._step, columns, np.empty(0, np.int32), b"", b"")

    def _cost(self, motion: Matrix, body: GopBody) -> float:
        components = motion @ projection(decode_basis(body))
        return bits_estimate(components, self._step) + 8.0 * len(body.basis)

    def _coded(self, motion: Matrix, body: GopBody) -> GopBody:
        """The GOP with the levels of its blocks."""
        wanted = motion @ projection(decode_basis(body))
        field = np.zeros_like(wanted)
        levels = []
        for part, first in zip(self._setting.parts, self._setting.first):
            target = part.basis.T @ wanted[part.vertices] - part.extend(field)
            coded, decoded = Loop(3, body.components).encode(first, target, self._step, self._options.rounding)
            part.place(field, decoded)
            levels.append(coded)
        payload = encode_levels(make_level_bank(), levels, level_references(levels, body.components))
        return replace(body, levels=payload)


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
