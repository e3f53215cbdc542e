"""A mesh to a stream: prepare, plan, code the blocks, and write the header when all of it is known."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

from bitstream.container.header import Header
from bitstream.container.writer import Writer
from bitstream.errors import OptionError
from codec.arrays import Matrix, Order
from codec.geometry.mesh import TriangleMesh
from codec.geometry.metrics import Comparison, Reference
from codec.signal.quantize import smallest_step
from codec.signal.smooth import smooth
from codec.static.assembly import blended
from codec.static.block_coder import CodedBlock, Progress, encode_blocks
from codec.static.options import EncodeOptions
from codec.static.plan import Planner
from codec.static.preamble import Prepared, prepare
from codec.static.targets import search_step
from codec.static.units import single


@dataclass(frozen=True, eq=False)
class Coded:
    """A mesh, coded.

    Parameters
    ----------
    header : Header
    blocks : list of CodedBlock
    positions : float64 array, shape (n, 3)
        In BSM units, as the decoder has them before it smooths.
    """

    header: Header
    blocks: list[CodedBlock]
    positions: Matrix


@dataclass(frozen=True, eq=False)
class Attempt:
    """A whole stream, and what its decoder will make of it.

    Parameters
    ----------
    frames : tuple of bytes
        The stream, frame by frame.
    header : Header
    coefficients : tuple of int
        c_i of each block.
    comparison : Comparison
        The decoded mesh against the original.
    """

    frames: tuple[bytes, ...]
    header: Header
    coefficients: tuple[int, ...]
    comparison: Comparison

    @property
    def size(self) -> int:
        """Bytes of the whole stream."""
        return sum(map(len, self.frames))

    @property
    def bpv(self) -> float:
        """Bits of the whole stream per vertex."""
        return 8.0 * self.size / self.header.vertices


class Encoder:
    """Encodes one mesh; the work begins with the first thing asked for.

    Parameters
    ----------
    mesh : TriangleMesh
        Vertices that no face uses are left out, with a note.
    options : EncodeOptions
    """

    def __init__(self, mesh: TriangleMesh, options: EncodeOptions | None = None) -> None:
        self.options = options or EncodeOptions()
        self._given = mesh

    @property
    def notes(self) -> tuple[str, ...]:
        """What was changed on the way in."""
        return self._prepared.notes

    @property
    def mesh(self) -> TriangleMesh:
        """The mesh in the order of coding, without the vertices that no face uses."""
        return self._prepared.mesh

    @property
    def vertex_order(self) -> Order:
        """The decoder's vertex j is vertex `vertex_order[j]` of the given mesh; int64, shape (n,)."""
        return self._prepared.vertex_order

    @property
    def face_order(self) -> Order:
        """The decoder's face i is face `face_order[i]` of the given mesh; int64, shape (m,)."""
        return self._prepared.face_order

    def encode(self) -> bytes:
        """The whole stream."""
        return b"".join(self.chunks())

    def chunks(self, progress: Progress | None = None) -> Iterator[bytes]:
        """The stream, frame by frame.

        Parameters
        ----------
        progress : callable, optional
            Called with the number of blocks done and of all blocks, once for every attempt at a target.
        """
        if self.options.target is None:
            yield from self._frames(self._code(self.options.step, progress))
        else:
            yield from self.search(progress).frames

    def search(self, progress: Progress | None = None) -> Attempt:
        """Look for the step that meets the options' target; `TargetError` says what can be had where none does."""
        target = self.options.target
        if target is None:
            raise OptionError("there is no target to search for")
        finest = smallest_step(self._prepared.size)
        return search_step(lambda step: self.attempt(step, progress), target, self.options.step, finest)

    def attempt(self, step: float, progress: Progress | None = None) -> Attempt:
        """Encode with a given quantization step, and see what the decoder will."""
        coded = self._code(step, progress)
        decoded = smooth(self._prepared.graph, coded.positions, coded.header.smoothing)
        counts = tuple(block.packet.coefficients for block in coded.blocks)
        return Attempt(tuple(self._frames(coded)), coded.header, counts, self._reference.compare(decoded))

    @cached_property
    def _prepared(self) -> Prepared:
        options = self.options
        return prepare(
            self._given,
            part_size=options.block_size,
            overlap=options.overlap,
            keep_order=options.keep_order,
            metis=options.partition == "metis",
        )

    @cached_property
    def _planner(self) -> Planner:
        return Planner(self._prepared, self.options)

    @cached_property
    def _reference(self) -> Reference:
        """The original, in BSM units, prepared for comparing."""
        return Reference(self._prepared.positions, self.mesh.faces)

    def _code(self, step: float, progress: Progress | None) -> Coded:
        prepared, options = self._prepared, self.options
        scheme = self._planner.scheme(step)
        blocks = encode_blocks(scheme, prepared.positions, threads=options.threads, doi=options.doi, progress=progress)
        positions = blended(prepared.graph.size, (block.decoded for block in blocks))
        smoothing = options.fixed_smoothing
        header = Header(
            vertices=prepared.graph.size,
            faces=len(self.mesh.faces),
            block_size=prepared.size,
            coefficients=max(block.packet.coefficients for block in blocks),
            center=prepared.units.center,
            scale=prepared.units.scale,
            smoothing=self._planner.smoothing(positions) if smoothing is None else single(smoothing),
            **scheme.fields(),
        )
        return Coded(header, blocks, positions)

    def _frames(self, coded: Coded) -> Iterator[bytes]:
        writer = Writer()
        yield writer.start()
        for packet in (coded.header, *self._prepared.packets, *(block.packet for block in coded.blocks)):
            yield writer.write(packet)
        yield writer.end()


def encode(mesh: TriangleMesh, options: EncodeOptions | None = None) -> bytes:
    """Encode a mesh to a complete stream."""
    return Encoder(mesh, options).encode()
