"""Experimental: try a dictionary, a predictor or a partition of your own in the codec, as arrays.

>>> import numpy as np
>>> from bsm import research
>>> from bsm.evaluation.sample import knot
>>> def eigenvectors(site, width):
...     return np.linalg.eigh(site.laplacian + np.diag(site.springs))[1][:, :width]
>>> idea = research.Idea(dictionary=eigenvectors)
>>> mesh = knot(1000)
>>> data = research.encode(mesh, idea, step=0.01)
>>> research.decode(data, idea).faces.shape == mesh.faces.shape
True

All else stays as it is: connectivity, quantisation, entropy coding, the detail layer, smoothing. `curves` measures
ideas beside what the codec does, `blocks` gives what the codec itself works on. Names here may change with any release.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import ArgumentError, FormatError, OptionError
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits
from bsm.codec.blocks.partition import Partition, partition_of_labels
from bsm.codec.geometry.graph import Graph
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.signal.chain import Columns, Trial
from bsm.codec.signal.predict import Surroundings
from bsm.codec.static.choice.spectral import Spectral
from bsm.codec.static.decoder import Decoder
from bsm.codec.static.draft import Draft
from bsm.codec.static.joining import join
from bsm.codec.static.options import EncodeOptions
from bsm.codec.static.preamble_encoding import Parts, Prepared, prepare
from bsm.meshes import as_mesh

if TYPE_CHECKING:
    from bsm.evaluation.codecs import Breakdown, Coded

Floats: TypeAlias = npt.NDArray[np.float64]
Integers: TypeAlias = npt.NDArray[np.int32]

MARK = b"BSM research\n"
"""Before streams that only their own idea can decode, so that no decoder takes them for ordinary ones."""
__all__ = ["BlockArrays", "Curves", "Idea", "Site", "blocks", "curves", "decode", "encode"]
STEPS = (0.016, 0.008, 0.004, 0.002)
CLOSE = 1e-6
"""How far what is decoded may be from what the encoder expects, in diagonals."""


@dataclass(frozen=True, eq=False)
class Site:
    """A block as encoder and decoder both see it before it is coded; row r of all arrays is vertex `vertices[r]`.

    Parameters
    ----------
    vertices : int32 array, shape (n,)
        Numbers of the block's vertices in the mesh, in the stream's order.
    offsets, neighbours : int32 arrays
        The block's graph: the neighbours of row r are `neighbours[offsets[r]:offsets[r + 1]]`.
    springs : float64 array, shape (n,)
        How firmly each row is held by vertices that are known: the sum of stiffnesses.
    pulls : float64 array, shape (n, 3)
        Sum of stiffness times known position, in units of the bounding box (the longest side goes from -0.5 to 0.5).
    prediction : float64 array, shape (n, 3)
        Where the codec expects the block: the harmonic extension of what is known.

    Examples
    --------
    >>> from bsm import research
    >>> site = research.blocks("bunny.ply", step=0.01)[1].site
    >>> site.laplacian.shape == (site.size, site.size), site.ours(8).shape == (site.size, 8)
    (True, True)
    """

    vertices: Integers
    offsets: Integers
    neighbours: Integers
    springs: Floats
    pulls: Floats
    prediction: Floats
    _columns: Columns | None = field(default=None, repr=False)

    def __repr__(self) -> str:
        return f"Site({self.size} vertices, {len(self.neighbours) // 2} edges)"

    @property
    def size(self) -> int:
        """Number of rows n."""
        return len(self.vertices)

    @property
    def laplacian(self) -> Floats:
        """L = D - A of the block's graph, float64, shape (n, n), without springs."""
        rows = np.repeat(np.arange(self.size), np.diff(self.offsets))
        dense = np.zeros((self.size, self.size))
        dense[rows, self.neighbours] = -1.0
        np.fill_diagonal(dense, np.diff(self.offsets))
        return dense

    def ours(self, width: int) -> Floats:
        """The codec's own U, float64, shape (n, width); orthonormal columns, low frequencies first.

        Raises
        ------
        OptionError
            In a predictor, which comes before the dictionary.
        """
        if self._columns is None:
            raise OptionError("the dictionary is not known where positions are predicted")
        return self._columns(width)


OwnDictionary: TypeAlias = Callable[[Site, int], npt.ArrayLike]
OwnPredictor: TypeAlias = Callable[[Site], npt.ArrayLike]
OwnPartition: TypeAlias = Callable[[Integers, Integers, int], npt.ArrayLike]


@dataclass(frozen=True)
class Idea:
    """What is to be done in another way; None: as the codec does it.

    Parameters
    ----------
    dictionary : callable, optional
        Takes a `Site` and the number of columns c; gives U, shape (n, c), with orthonormal columns. Both sides call
        it, the decoder perhaps with a smaller c, for which it must give the first columns of the same U.
    predictor : callable, optional
        Takes a `Site`; gives positions, shape (n, 3). What is coded is the difference from them.
    partition : callable, optional
        Takes the graph of the mesh (offsets, neighbours, as in `Site`) and the number of parts that the options
        suggest; gives a part for each vertex, shape (n,). It is sent, so that any decoder can decode it.

    Examples
    --------
    >>> import bsm, numpy as np
    >>> from bsm import research
    >>> stripes = lambda offsets, neighbours, parts: np.arange(len(offsets) - 1) * parts // (len(offsets) - 1)
    >>> mesh = bsm.decode(research.encode("bunny.ply", research.Idea(partition=stripes)))
    """

    dictionary: OwnDictionary | None = None
    predictor: OwnPredictor | None = None
    partition: OwnPartition | None = None

    @property
    def needed_to_decode(self) -> bool:
        """Whether ordinary decoders cannot know what it does."""
        return self.dictionary is not None or self.predictor is not None


@dataclass(frozen=True, eq=False)
class BlockArrays:
    """What the codec works on in one block.

    Parameters
    ----------
    site : Site
        What both sides know of the block.
    dictionary : float64 array, shape (n, c)
        U.
    positions : float64 array, shape (n, 3)
        The original, in units of the bounding box.

    Examples
    --------
    >>> from bsm import research
    >>> block = research.blocks("bunny.ply", step=0.01)[0]
    >>> block.coefficients.shape == (block.dictionary.shape[1], 3)
    True
    """

    site: Site
    dictionary: Floats
    positions: Floats

    @property
    def coefficients(self) -> Floats:
        """What U makes of the difference from the prediction, before it is quantised: shape (c, 3)."""
        product: Floats = self.dictionary.T @ (self.positions - self.site.prediction)
        return product


def encode(mesh: Any, idea: Idea | None = None, /, *, step: float = 0.004, **keywords: Any) -> bytes:
    """Encode the shape of a mesh in blocks, with an idea.

    Parameters
    ----------
    mesh : mesh
        As `bsm.encode` takes it; attributes are left out.
    idea : Idea, optional
        None: as the codec does it.
    step : float
        Quantization step, relative to the diagonal.
    **keywords
        Fields of `EncodeOptions` (`block_size`, `overlap`, `detail`, `coefficients`, `predict`, ...).

    Returns
    -------
    bytes
        An ordinary stream, unless only this idea can decode it: then `decode` here, with the same idea.

    Raises
    ------
    ArgumentError
        If what a function of the idea returns has another shape, or is not finite.
    OptionError
        If decoding gives something else, so that the idea does other things on both sides.

    Examples
    --------
    >>> import numpy as np
    >>> from bsm import research
    >>> own = research.Idea(dictionary=lambda site, width: np.linalg.eigh(site.laplacian)[1][:, :width])
    >>> data = research.encode("bunny.ply", own, step=0.01)
    >>> mesh = research.decode(data, own)
    """
    idea = idea or Idea()
    stream = _stream(as_mesh(mesh).bare, idea, EncodeOptions(step=step, **keywords))
    return MARK + stream if idea.needed_to_decode else stream


def decode(data: bytes, idea: Idea | None = None, /, *, limits: Limits = DEFAULT_LIMITS) -> TriangleMesh:
    """Decode what `encode` gave, with the same idea.

    Parameters
    ----------
    data : bytes
        A stream of `encode`.
    idea : Idea, optional
        That with which it was encoded.
    limits : Limits
        What the stream may ask for.

    Returns
    -------
    TriangleMesh

    Raises
    ------
    FormatError
        If it was made by an idea and none is given.

    Examples
    --------
    >>> from bsm import research
    >>> short = research.Idea(predictor=lambda site: 0.99 * site.prediction)
    >>> mesh = research.decode(research.encode("bunny.ply", short, step=0.01), short)
    """
    idea = idea or Idea()
    if data.startswith(MARK) and not idea.needed_to_decode:
        raise FormatError("this stream was made with a dictionary or predictor of somebody's own, which is not given")
    return _decoded(data.removeprefix(MARK), idea, limits)


def blocks(mesh: Any, idea: Idea | None = None, /, *, step: float = 0.004, **keywords: Any) -> list[BlockArrays]:
    """The arrays of all blocks, in the order of coding, as `encode` with the same arguments meets them.

    Parameters
    ----------
    mesh : mesh
        As `bsm.encode` takes it; attributes are left out.
    idea : Idea, optional
        None: as the codec does it.
    step : float
        Quantization step, relative to the diagonal.
    **keywords
        Fields of `EncodeOptions`.

    Returns
    -------
    list of BlockArrays

    Raises
    ------
    ArgumentError
        If what a function of the idea returns has another shape, or is not finite.

    Examples
    --------
    >>> from bsm import research
    >>> largest = max(research.blocks("bunny.ply", step=0.01), key=lambda block: block.site.size)
    """
    idea = idea or Idea()
    options = EncodeOptions(**{"step": step, **keywords, "threads": 1})
    prepared = _prepared(as_mesh(mesh).bare, idea, options)
    found: list[BlockArrays] = []

    def recorded(site: Site, width: int) -> npt.ArrayLike:
        columns = np.asarray((idea.dictionary or Site.ours)(site, width))
        found.append(BlockArrays(site, columns, prepared.positions[site.vertices]))
        return columns

    _ = Spectral(prepared, options, trial=_trial(Idea(recorded, idea.predictor))).base(step)
    return found


@dataclass(frozen=True, eq=False)
class Curves:
    """Rate against error of ideas, and of the codec as it is, "ours".

    Parameters
    ----------
    results : list of dict
        One for each, as `bsm.evaluation.run.run_curve` describes it.

    Examples
    --------
    >>> from bsm import research
    >>> found = research.curves("bunny.ply", {"none": research.Idea()}, steps=(0.01, 0.005, 0.0025))
    >>> found.bytes_of_ours
    {'none': 1.0}
    """

    results: list[dict[str, Any]]

    @property
    def bytes_of_ours(self) -> dict[str, float | None]:
        """For each idea, its bytes over ours at equal angle of normals: the mean over the range of both; None: none."""
        from bsm.evaluation.rates import compare_curves

        ours, *others = self.results
        rates = {other["codec"]: compare_curves(ours, other)["bd_rate_percent"]["theta_deg"] for other in others}
        return {name: None if rate is None else 1.0 + rate / 100.0 for name, rate in rates.items()}

    def draw(self, stem: str | Path) -> list[Path]:
        """Pictures of bits per vertex against the angle of normals; `stem` is a path without suffix."""
        from bsm.evaluation.plots import draw_rates

        return draw_rates(self.results, Path(stem), "theta_deg")

    def __str__(self) -> str:
        from bsm.evaluation.tables import number, table

        columns = ("", "step", "bytes", "bits per vertex", "theta", "encode, s", "decode, s")
        rows = [
            (
                result["label"],
                f"{point['settings']['step']:g}",
                str(point["bytes"]["total"]),
                *(number(point[name], 2) for name in ("bpv_total", "theta_deg", "encode_seconds", "decode_seconds")),
            )
            for result in self.results
            for point in result["points"]
        ]
        return table(columns, rows)


def curves(mesh: Any, ideas: Mapping[str, Idea], /, steps: Sequence[float] = STEPS, **keywords: Any) -> Curves:
    """Measure ideas, by their names, beside what the codec does, all on one thread (the extra `eval`).

    Parameters
    ----------
    mesh : mesh
        As `bsm.encode` takes it; attributes are left out.
    ideas : mapping from str to Idea
        What they do, by the names that they shall have.
    steps : sequence of float
        Operating points, as for `encode`.
    **keywords
        Fields of `EncodeOptions`, for all of them.

    Returns
    -------
    Curves
        Theirs, and "ours".

    Raises
    ------
    OptionError
        If one of them is called "ours".
    DependencyError
        If the extra `eval` is missing.

    Examples
    --------
    >>> from bsm import research
    >>> short = research.Idea(predictor=lambda site: 0.9 * site.prediction)
    >>> found = research.curves("bunny.ply", {"short": short}, steps=(0.01,))
    >>> [result["label"] for result in found.results]
    ['ours', 'short']
    """
    from bsm.evaluation.codecs import Curve
    from bsm.evaluation.run import run_curve

    if "ours" in ideas:
        raise OptionError('"ours" is what the codec does; call the idea something else')
    given = join(as_mesh(mesh).bare, keep=False).mesh
    made = {"ours": Idea(), **ideas}
    lines = (
        Curve(
            name, name, tuple(_Tried(idea, EncodeOptions(**{"threads": 1, **keywords, "step": step})) for step in steps)
        )
        for name, idea in made.items()
    )
    return Curves([run_curve(line, given, "mesh") for line in lines])


@dataclass(frozen=True)
class _Tried:
    """An idea at one operating point, as a codec."""

    idea: Idea
    options: EncodeOptions

    @property
    def settings(self) -> dict[str, Any]:
        """The options that are not the defaults, and the step."""
        usual, chosen = EncodeOptions(), asdict(self.options)
        names = (item.name for item in fields(EncodeOptions) if item.name != "limits")
        return {name: chosen[name] for name in names if chosen[name] != getattr(usual, name)}

    def encode(self, mesh: TriangleMesh) -> Coded:
        from bsm.evaluation.codecs import Coded

        prepared = _prepared(mesh, self.idea, self.options)
        place = np.empty(len(mesh.positions), np.int64)
        place[prepared.vertex_order] = np.arange(len(place))
        draft = _draft(prepared, self.idea, self.options)
        return Coded(b"".join(draft.frames), lambda decoded: decoded.positions[place])

    def decode(self, data: bytes) -> TriangleMesh:
        return _decoded(data, self.idea, DEFAULT_LIMITS, self.options.threads)

    def breakdown(self, data: bytes) -> Breakdown:
        from bsm.evaluation.codecs import Spectral as Ours

        return Ours(self.options).breakdown(data)


def _stream(mesh: TriangleMesh, idea: Idea, options: EncodeOptions) -> bytes:
    """The stream of a mesh, of which it is known that it decodes to what was meant."""
    draft = _draft(_prepared(join(mesh, keep=False).mesh, idea, options), idea, options)
    stream = b"".join(draft.frames)
    decoded = _decoded(stream, idea, DEFAULT_LIMITS, options.threads).positions
    if not np.abs(decoded - draft.decoded).max() <= CLOSE * mesh.diagonal:
        raise OptionError(
            "decoding gives other positions: the dictionary or predictor is not a function of the site alone, or its "
            "first columns depend on how many are asked for"
        )
    return stream


def _draft(prepared: Prepared, idea: Idea, options: EncodeOptions) -> Draft:
    return Spectral(prepared, options, trial=_trial(idea)).base(options.first_step).draft


def _prepared(mesh: TriangleMesh, idea: Idea, options: EncodeOptions) -> Prepared:
    size, overlap = options.block_size, options.overlap
    parts = Parts(size, overlap, options.partition == "metis")
    if idea.partition is not None:
        parts = _OwnParts(size, overlap, metis=True, labelled=idea.partition)
    whole = idea.partition is not None or parts.metis
    return prepare(mesh, parts, keep_order=options.keep_order, sections=1 if whole else options.sections_wanted)


def _decoded(stream: bytes, idea: Idea, limits: Limits, threads: int | None = None) -> TriangleMesh:
    with Decoder(limits, threads, trial=_trial(idea)) as decoder:
        decoder.receive_data(stream)
        return decoder.finish()


def _trial(idea: Idea) -> Trial:
    """An idea as the codec takes it; what its functions give is looked at before it is used."""

    def dictionary(around: Surroundings, width: int, columns: Columns) -> Floats:
        site = _site(around, columns)
        assert idea.dictionary is not None
        return _checked("dictionary", idea.dictionary(site, width), (site.size, width))

    def predictor(around: Surroundings) -> Floats:
        site = _site(around, None)
        assert idea.predictor is not None
        return _checked("predictor", idea.predictor(site), (site.size, 3))

    own = None if idea.dictionary is None else dictionary
    return Trial(dictionary=own, predictor=None if idea.predictor is None else predictor)


def _site(around: Surroundings, columns: Columns | None) -> Site:
    block = around.laplacian.block
    return Site(
        block.vertices, block.offsets, block.neighbours, around.springs, around.pulls, around.continuation, columns
    )


def _checked(what: str, values: npt.ArrayLike, shape: tuple[int, ...]) -> Floats:
    """What an own function gives, as an array."""
    array = np.asarray(values, np.float64)
    if array.shape != shape or not np.isfinite(array).all():
        raise ArgumentError(f"the {what} must give finite numbers of shape {shape}, not {array.shape}")
    return array


@dataclass(frozen=True)
class _OwnParts(Parts):
    """Parts that somebody's own function finds."""

    labelled: OwnPartition | None = None

    def cut(self, graph: Graph) -> Partition:
        assert self.labelled is not None
        labels = np.asarray(self.labelled(graph.offsets, graph.neighbours, self.count(graph.size)))
        if labels.shape != (graph.size,) or labels.dtype.kind not in "iu":
            raise ArgumentError(f"the partition must give {graph.size} whole numbers, not {labels.dtype}{labels.shape}")
        return partition_of_labels(labels.astype(np.int32))
