"""Experimental: try a dictionary, a predictor or a partition of your own in the codec, as arrays.

>>> import numpy as np
>>> from bsm import research
>>> from bsm.evaluation.sample import knot
>>> def eigenvectors(site, width):
...     return np.linalg.eigh(site.laplacian + np.diag(site.springs))[1][:, :width]
>>> idea = research.Idea(dictionary=eigenvectors)
>>> mesh = knot(300)
>>> encoded = research.encode(mesh, idea, step=0.01)
>>> encoded.mesh.faces.shape == mesh.faces.shape
True

The rest is that of the codec. `curves` compares ideas with it, `blocks` returns the arrays that it works on, and
`PartCoder` codes parts one by one, as in the paper. Names in this module may change with any release.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from types import SimpleNamespace
from typing import Any, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from bsm.bitstream.container.wire import FrameType, checksum_size
from bsm.bitstream.errors import ArgumentError, CorruptError, FormatError, MeshError, OptionError
from bsm.bitstream.limits import NAMED_LIMITS
from bsm.codec.arrays import Basis
from bsm.codec.blocks.overlap import (
    Blocks,
    Partition,
    derive_partition,
    grow_blocks,
    partition_of_labels,
)
from bsm.codec.decoding import Decoder
from bsm.codec.events import ConnectivityEvent
from bsm.codec.geometry.graph import Graph, graph_of_faces
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.signal import chain
from bsm.codec.signal.chain import Chain, ChainRules, Columns, Overrides
from bsm.codec.static.coding import Packed, rules_of
from bsm.codec.static.options import RANGES, EncodeOptions, changed
from bsm.codec.static.preamble_encoding import Draft, Parts, Prepared, join, prepare
from bsm.codec.static.units import Units, checksum_of
from bsm.codec.static.ways.block_coder import blended
from bsm.codec.static.ways.in_blocks import InBlocks
from bsm.files.inspection import Skimmer
from bsm.files.libraries import as_mesh
from bsm.ground.console import Console

Floats: TypeAlias = npt.NDArray[np.float64]
Integers: TypeAlias = npt.NDArray[np.int32]

MARK = b"BSM research\n"
"""Before streams that hold the dictionary or predictor of an idea, so that no decoder takes them for ordinary ones."""
__all__ = [*("BlockArrays", "Encoded", "Idea", "PartCoder", "Site", "blocks", "curves", "encode")]


@dataclass(frozen=True, eq=False)
class Site:
    """A block as both sides see it before it is coded: its `vertices` (n,), its graph, and what holds it.

    Neighbors of row r are `neighbors[offsets[r]:offsets[r + 1]]`; `springs` (n,) are the stiffnesses by which known
    vertices hold each row, `pulls` (n, 3) stiffness times known position, in units of the box's longest side, and
    `prediction` (n, 3) where the codec expects the block.
    """

    vertices: Integers
    offsets: Integers
    neighbors: Integers
    springs: Floats
    pulls: Floats
    prediction: Floats
    _columns: Columns | None = field(default=None, repr=False)

    def __repr__(self) -> str:
        return f"Site({self.size} vertices, {len(self.neighbors) // 2} edges)"

    @property
    def size(self) -> int:
        return len(self.vertices)

    @property
    def laplacian(self) -> Floats:
        """L = D - A of the block's graph, float64, shape (n, n), without springs."""
        dense = np.diag(np.diff(self.offsets).astype(np.float64))
        dense[np.repeat(np.arange(self.size), np.diff(self.offsets)), self.neighbors] = -1.0
        return dense

    def ours(self, width: int) -> Floats:
        """The codec's own U, float64, shape (n, width), low frequencies first; not for a predictor."""
        if self._columns is None:
            raise OptionError("the dictionary is not known where positions are predicted")
        return self._columns(width).astype(np.float64)


@dataclass(frozen=True)
class Idea:
    """Replacements for parts of the codec; None: the codec's own.

    `dictionary` is a function of a `Site` and a number of columns c: U, shape (n, c), orthonormal. `predictor` is one
    of a `Site`: positions, shape (n, 3); the codec codes the difference. `partition` is one of the mesh's graph
    (offsets, neighbors) and a number of parts: a part for each vertex, shape (n,), which is sent, so any decoder
    decodes it.
    """

    dictionary: Callable[[Site, int], npt.ArrayLike] | None = None
    predictor: Callable[[Site], npt.ArrayLike] | None = None
    partition: Callable[[Integers, Integers, int], npt.ArrayLike] | None = None


@dataclass(frozen=True, eq=False)
class BlockArrays:
    """The data of one block: its site, U (n, c), and the original (n, 3) in the unit of `pulls`."""

    site: Site
    dictionary: Floats
    positions: Floats

    @property
    def coefficients(self) -> Floats:
        """What U makes of the difference from the prediction, before it is quantized: shape (c, 3)."""
        product: Floats = self.dictionary.T @ (self.positions - self.site.prediction)
        return product


class Encoded(NamedTuple):
    """A stream, and the mesh that decoding it gives."""

    data: bytes
    mesh: TriangleMesh


def encode(
    mesh: Any, idea: Idea | None = None, /, *, step: float = 0.004, **keywords: Any
) -> Encoded:
    """Encode the shape of a mesh, as `bsm.encode` takes it, in blocks; `keywords` are fields of `EncodeOptions`.

    With your own dictionary or predictor, no decoder can decode the stream: it begins with `MARK`. The returned mesh is
    the result of a decoder that knows the idea. ArgumentError: a function returns a wrong shape or values that are not
    finite; OptionError: it returns different values for the same site.
    """
    idea, options = idea or Idea(), changed(EncodeOptions(), **{"step": step, **keywords})
    prepared = _prepared(join(as_mesh(mesh).bare, keep=False).mesh, idea, options)
    draft = _draft(prepared, idea, options)
    stream = b"".join(draft.frames)
    if idea.dictionary is not None or idea.predictor is not None:
        # Asked twice for everything: a decoder computes the same arrays anew, and a function with a random start would
        # give it others.
        if b"".join(_draft(prepared, idea, options).frames) != stream:
            raise OptionError(
                "the dictionary or predictor returns different values for the same site"
            )
        # Without a dictionary or predictor of the idea, the stream is an ordinary one, as a partition is sent.
        stream = MARK + stream
    return Encoded(stream, _decoded(prepared, draft, options))


def blocks(
    mesh: Any, idea: Idea | None = None, /, *, step: float = 0.004, **keywords: Any
) -> list[BlockArrays]:
    """The arrays of all blocks, in the order of coding, as `encode` with the same arguments meets them."""
    idea, options = (
        idea or Idea(),
        changed(EncodeOptions(), **{"step": step, **keywords, "threads": 1}),
    )
    prepared = _prepared(join(as_mesh(mesh).bare, keep=False).mesh, idea, options)
    found: list[BlockArrays] = []

    def recorded(site: Site, width: int) -> npt.ArrayLike:
        columns = np.asarray((idea.dictionary or Site.ours)(site, width))
        found.append(BlockArrays(site, columns, prepared.positions[site.vertices]))
        return columns

    _draft(prepared, Idea(recorded, idea.predictor), options)
    return found


def curves(
    mesh: Any,
    ideas: Mapping[str, Idea],
    /,
    steps: Sequence[float] = (0.016, 0.008, 0.004, 0.002),
    **keywords: Any,
) -> dict[str, dict[str, Any]]:
    """Measure ideas by their names next to the codec, "ours", all on one thread (the extra `eval`).

    For each: its `points`, and `bytes_of_ours`, its bytes over ours at equal angle of normals, or None.
    """
    from bsm.evaluation.curve import Curve, compare_curves, run_curve

    if "ours" in ideas:
        raise OptionError('the name "ours" is reserved for the codec; choose another one')
    given, found = join(as_mesh(mesh).bare, keep=False).mesh, {}
    for name, idea in {"ours": Idea(), **ideas}.items():
        codecs = [
            _tried(idea, changed(EncodeOptions(), **{"threads": 1, **keywords, "step": step}))
            for step in steps
        ]
        with Console().progress(name) as progress:
            found[name] = run_curve(
                Curve(name, name, tuple(codecs)), given, "mesh", progress=progress
            )
        rate = compare_curves(found["ours"], found[name])["bd_rate_percent"]["theta_deg"]
        found[name]["bytes_of_ours"] = None if rate is None else 1.0 + rate / 100.0
    return found


PART_OPTIONS = (
    "keep",
    "coefficients",
    "doi",
    "bits",
    "power",
    "iterations",
    "key_seed",
    "limits",
    "threads",
)
"""The options of a `PartCoder`: all else is fixed, as one block is a part."""


class PartCoder:
    """Codes the parts of a mesh as they arrive, by the preset "paper"; one encodes, another decodes in the same order.

    A part with as many vertices as the one before takes one orthogonal iteration from its basis, any other an exact
    basis. Nothing else is shared: vertices on a border are coded in each part, and not averaged. eps is in mean edge
    lengths of the part. `keywords` are among `PART_OPTIONS`; of `limits`, both sides need the same. A part has at most
    as many vertices as these allow in a block, by default 8,192.
    """

    def __init__(self, **keywords: Any) -> None:
        for name in sorted(keywords):
            if name not in PART_OPTIONS or (name == "bits" and not keywords[name]):
                raise OptionError(
                    f"a part cannot have {name}={keywords[name]!r}; options: {', '.join(PART_OPTIONS)}"
                )
        one_block: dict[str, Any] = {
            "block_size": int(RANGES["block_size"][1]),
            "partition": "derived",
        }
        self._options = EncodeOptions(preset="paper", **(one_block | keywords))
        self._limits, self._basis = (
            NAMED_LIMITS[self._options.limits](),
            np.empty((0, 0), np.float32),
        )

    def encode(self, part: Any) -> Encoded:
        """Encode a part, as `bsm.encode` takes a mesh: its bytes, and the mesh that they decode to."""
        mesh = join(as_mesh(part).bare, keep=False).mesh
        if len(mesh.positions) > (most := min(self._limits.block_size, self._options.block_size)):
            raise MeshError(
                f"a part has at most {most} vertices, not {len(mesh.positions)}; cut it into smaller parts"
            )
        prepared = _prepared(mesh, Idea(), self._options)
        _, columns = self._begun(prepared.blocks, InBlocks(prepared, self._options)._rules())
        draft = _draft(
            prepared,
            Overrides(lambda _, width, __: columns(width).astype(np.float64)),
            self._options,
        )
        data = MARK + b"".join(draft.frames)
        return Encoded(data, self.decode(data))

    def decode(self, data: bytes) -> TriangleMesh:
        """Decode the next part; `CorruptError` if it does not follow the one before."""
        stream, skimmer = data.removeprefix(MARK), Skimmer(self._limits)
        sections = {p.type: p for chunk in (stream, None) for p in skimmer.receive(chunk)}
        block, header, law = sections.get(FrameType.BLOCK), skimmer.header, skimmer.header.constants
        if (
            stream == data
            or header.blocks != 1
            or not law.bits
            or block is None
            or FrameType.ORDER in sections
        ):
            raise FormatError(
                "this is not a part: it needs a mark, one block with packed coefficients, and no order"
            )
        end = block.offset + block.length - checksum_size(block.type, block.payload)
        # The decoder checks each block's sum before it makes the basis, which is the dear part; here only its faces are
        # wanted.
        # So that its decoder makes no basis.
        spoiled = stream[:end] + bytes([stream[end] ^ 1]) + stream[end + 1 :]
        with Decoder(self._limits, 1, tolerant=True) as decoder:
            faces = next(
                found.faces
                for found in decoder.events([spoiled])
                if isinstance(found, ConnectivityEvent)
            )
        graph = graph_of_faces(faces, header.vertices)
        blocks = grow_blocks(graph, derive_partition(graph, 1), graph.size)
        (rows, prediction, weights), columns = self._begun(
            blocks, replace(rules_of(law), apart=header.onorm)
        )
        basis = columns(min(block.count, graph.size))
        coding = Packed(block.count, law.bits, header.step, law.coarser)
        levels = coding.read(stream[end - block.data : end], basis.shape[1])
        copy = rows, coding.positions(prediction, basis, levels), weights
        mesh = TriangleMesh(
            Units(header.center, header.scale).back(blended(graph.size, [copy])), faces
        )
        if checksum_of(mesh.positions) != sections[FrameType.END].positions:
            raise CorruptError(
                "the part does not follow the one before: decode all parts, in the order of encoding"
            )
        self._basis = basis
        return mesh

    def _begun(
        self, blocks: Blocks, rules: ChainRules
    ) -> tuple[tuple[Integers, Floats, Floats], Callable[[int], Basis]]:
        """What `Chain.begin` returns of a part, and its dictionary by width: that of a chain with the part before."""
        # The chain of blocks passes a basis on from block to block. So the part before and this one are two blocks,
        # with the same graph, of one chain.
        size, edges, members = (
            blocks.graph.size,
            np.tile(blocks.edges, 2),
            np.tile(blocks.members, 2),
        )
        chain = Chain(
            rules,
            Blocks(blocks.graph, np.tile(blocks.cores, 2), size * np.arange(3), edges, members),
        )
        begun = chain.begin(0)
        if len(self._basis) == size:
            chain.give(self._basis)
            chain.commit(self._basis.shape[1], begun[1])
            begun = chain.begin(1)

        def columns(width: int) -> Basis:
            *work, memory = chain.costs(width)
            self._limits.check_work(sum(work), size)
            self._limits.check_memory(memory, size)
            return chain.dictionary(width)

        return begun, columns


def _tried(idea: Idea, options: EncodeOptions) -> Any:
    """An idea at one operating point, as a codec of `bsm.evaluation.curve`."""
    from bsm.evaluation.curve import Spectral as Ours

    meshes: dict[bytes, TriangleMesh] = {}

    def encode(mesh: TriangleMesh) -> tuple[bytes, Any]:
        prepared = _prepared(mesh, idea, options)
        draft, place = _draft(prepared, idea, options), np.argsort(prepared.vertex_order)
        stream = b"".join(draft.frames)
        # Decoding would need the idea, so what it gives is kept by its stream.
        meshes[stream] = _decoded(prepared, draft, options)
        return stream, lambda decoded: decoded.positions[place]

    parts = Ours(options).parts
    return SimpleNamespace(
        settings={"step": options.step}, encode=encode, decode=meshes.__getitem__, parts=parts
    )


def _draft(prepared: Prepared, idea: Idea | Overrides, options: EncodeOptions) -> Draft:
    spectral = InBlocks(
        prepared, options, overrides=_overrides(idea) if isinstance(idea, Idea) else idea
    )
    return spectral.base(spectral.first_step).draft


def _prepared(mesh: TriangleMesh, idea: Idea, options: EncodeOptions) -> Prepared:
    parts = Parts.of(options.block_size, options.growth, options.paper.partition)
    if idea.partition is not None:
        parts = _OwnParts(parts.size, parts.overlap, metis=True, labeled=idea.partition)
    return prepare(join(mesh, keep=options.keep_order), parts, keep_order=options.keep_order)


def _decoded(prepared: Prepared, draft: Draft, options: EncodeOptions) -> TriangleMesh:
    """The mesh that a decoder gives, with vertices in the order of the stream."""
    if not options.keep_order:
        return TriangleMesh(draft.decoded, prepared.mesh.faces)
    positions = np.empty_like(draft.decoded)
    positions[np.argsort(np.argsort(prepared.coding_order))] = draft.decoded
    return TriangleMesh(positions, prepared.joined_faces)


def _overrides(idea: Idea) -> Overrides:
    """Return an idea as overrides of the codec, which check the results of its functions."""

    def dictionary(known: chain.Around, width: int, columns: Columns) -> Floats:
        site = Site(*known, columns)
        return _checked(
            "dictionary", (idea.dictionary or Site.ours)(site, width), (site.size, width)
        )

    def predictor(known: chain.Around) -> Floats:
        site = Site(*known)
        return _checked(
            "predictor", idea.predictor(site) if idea.predictor else site.prediction, (site.size, 3)
        )

    return Overrides(
        dictionary=dictionary if idea.dictionary else None,
        predictor=predictor if idea.predictor else None,
    )


def _checked(what: str, values: npt.ArrayLike, shape: tuple[int, ...]) -> Floats:
    array = np.asarray(values, np.float64)
    if array.shape != shape or not np.isfinite(array).all():
        raise ArgumentError(
            f"the {what} must return finite numbers of shape {shape}, not {array.shape}"
        )
    return array


@dataclass(frozen=True)
class _OwnParts(Parts):
    labeled: Callable[[Integers, Integers, int], npt.ArrayLike] = field(kw_only=True)

    def cut(self, graph: Graph) -> Partition:
        labels = np.asarray(self.labeled(graph.offsets, graph.neighbors, self.count(graph.size)))
        if labels.shape != (graph.size,) or labels.dtype.kind not in "iu":
            raise ArgumentError(
                f"the partition must return {graph.size} integers, not {labels.dtype}{labels.shape}"
            )
        return partition_of_labels(labels.astype(np.int32))
