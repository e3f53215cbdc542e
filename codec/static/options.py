"""Options for encoding a mesh."""

from collections.abc import Mapping
from dataclasses import InitVar, dataclass, fields, replace
from typing import TYPE_CHECKING, Any

from bsm.bitstream.errors import ArgumentError, OptionError, public
from bsm.bitstream.limits import NAMED_LIMITS
from bsm.codec.choices import check_options, named, suggestion
from bsm.codec.static.attributes.quality import Grade, checked_qualities
from bsm.codec.static.coding import KEY_SEEDS
from bsm.codec.static.presets import DEFAULT, PRESET_ROWS
from bsm.codec.static.targets import TARGETS, Contract, Target

CHOICES = {
    "key_seed": KEY_SEEDS,
    "partition": ("derived", "metis"),
    "normals": ("look", "keep", "near", "recompute"),
    "effort": ("quick", "normal", "best"),
    "limits": tuple(NAMED_LIMITS),
}
RANGES: dict[str, tuple[float, float]] = {
    "keep": (1e-6, 1.0),
    "coefficients": (1, 1 << 20),
    "block_size": (8, 1 << 20),
    "overlap": (1.0, 8.0),
    "key_interval": (0, 1 << 30),
    "key_iterations": (1, 64),
    "power": (1, 16),
    "iterations": (1, 64),
    "shift": (1e-6, 1e3),
    "bits": (2, 16),
    "step": (1e-9, 1.0),
    "grid": (1, 20),
    "grid_cell": (1e-290, 1e290),
    "smoothing": (0.0, 64.0),
    "threads": (1, 256),
}


PROMISES = {
    row.name: Contract(row.farthest, look=row.look, by_part=row.by_part)
    for row in PRESET_ROWS
    if row.farthest
}
BALANCED = PROMISES[DEFAULT]  # the promise without options


@public
@dataclass(frozen=True, kw_only=True)
class Paper:
    """Options of blocks for readers of the paper; the defaults are the product's, preset "paper" has the paper's.

    Parameters
    ----------
    bits : int, optional
        q_c: bits of every coefficient, as in the paper, without prediction and smoothing. None: adaptive.
    partition : str
        "derived": both sides compute it; "metis": the paper's, its labels are sent.
    key_seed : str, optional
        Initial dictionary of a block that starts a chain: "cosines", or "svd", the exact lowest subspace, as in the
        paper. None: "svd" with `bits`, otherwise "cosines".
    power, iterations, key_iterations : int
        z, t_max and t_max of a key block.
    shift : float, optional
        delta of Algorithm 1; smaller ones converge faster, larger ones keep R^z better conditioned.
    predict : bool
        Predict coefficients from known vertices of overlapping blocks.
    doi : (float, float), optional
        eps_l and eps_h of dynamic orthogonal iterations (DOI), in mean edge lengths of the mesh: c_i follows the error
        of each block, the root mean square of its vertices. With `bits`, a target is reached by scaling both.

    Raises
    ------
    OptionError
        If a value is outside its legal range.

    Examples
    --------
    >>> import bsm
    >>> options = bsm.EncodeOptions(paper=bsm.Paper(power=2, iterations=2), key_interval=0)
    >>> bsm.encode("bunny.ply", options) == bsm.encode("bunny.ply", power=2, iterations=2, key_interval=0)
    True
    """

    bits: int | None = None
    partition: str = "derived"
    key_seed: str | None = None
    power: int = 3
    iterations: int = 1
    key_iterations: int = 2
    shift: float = 2.0**-7
    predict: bool = True
    doi: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        check_options(self, CHOICES, RANGES)
        if self.doi is not None and not 0.0 < self.doi[0] < self.doi[1]:
            raise OptionError(f"doi = {self.doi} must be two thresholds, 0 < eps_l < eps_h")

    @property
    def exact_keys(self) -> bool:
        """Whether chains begin with the exact basis."""
        return (self.key_seed or ("cosines" if self.bits is None else "svd")) == "svd"


@public
@dataclass(frozen=True, kw_only=True)
class EncodeOptions:
    """Options for encoding a static mesh.

    Parameters
    ----------
    preset : str, optional
        Take the other options from this preset (`PRESETS`), except those that are given. "paper" is the codec of the
        paper: METIS parts, blocks 15 % larger, the exact basis of the first block, each other one by one orthogonal
        iteration of R^2 from the block before it, 12 bits for each coefficient, c_i by dynamic orthogonal iterations.
        A given `keep` or `coefficients` fixes c instead. A given `paper` replaces all of its options.
    keep : float, optional
        Largest size of the subspace, c, as a fraction of the block size n_d; None: as many
        as are worth coding at the step, measured on a few blocks (a tenth with `paper.bits`, as in the paper; any
        with `paper.doi`).
    coefficients : int, optional
        c itself; overrides `keep`.
    block_size : int
        Approximate vertices of a block before overlap. Smaller ones decode faster.
    overlap : float, optional
        n_d as a multiple of the largest part. None: 1, or with `paper.bits` 1.15, as in the paper.
    key_interval : int
        At least one of this many blocks is independent of earlier ones; 0: only the first; 1: every block is
        independent, with exact bases throughout if `paper.key_seed` is "svd".
    step : float, optional
        Finest quantization step of the adaptive coder, relative to the diagonal of the bounding box. None: the contract
        or the target chooses it.
    smoothing : float, optional
        Amount alpha of smoothing in the decoder; None: the encoder tries several.
    keep_order : bool
        Store the order of vertices and faces, and the first corner of each face.
    paper : Paper, optional
        Further options of blocks. As keywords, write its fields beside the others: ``bsm.encode(mesh, bits=12)``.
    target : Target, optional
        Quality or size to reach.
    contract : Contract, optional
        The promise, in addition to the target if there is one; the encoder finds the cheapest way to keep it. None:
        the target only. It has no effect with `grid`, `grid_cell` or any of `CODING`.
    effort : str
        "quick": only positions on a grid, coded by a small model, which decode fast; also with `grid` and
        `grid_cell`. "normal". "best": more steps, for the smallest file. It takes up to several times as long.
    exact : bool
        Keep every position exactly in single precision.
    congruence : bool
        Let the decoder also predict positions on a grid from congruent parts of the mesh, and turn the grid to its
        axes, where that makes the stream smaller; without effect with `exact`, `grid` and `grid_cell`. Such
        streams are of version 1.1; False writes what decoders of 1.0 read.
    grid : int, optional
        Round every position to a grid with this many bits along the longest side.
    attributes : mapping of str to str, or pairs
        Quality of attributes by name; "*" is any other: "exact"; "12bits" of each number, of normals on an octahedron;
        "0.01", a bound, or "1%" of the range; "2deg" or "recompute" for normals; "none". By default integers are
        exact, and floats get the bits that their kind and the promise of positions need; notes report them.
    normals : str
        Default quality of normals. "look": as few bits as the promised look needs. "keep": as many as the promise of
        positions needs. "near": the decoder computes them if all come within 1 degree of the given ones, otherwise as
        "keep"; a requested quality counts only otherwise. "recompute": the decoder computes them.
    grid_cell : float, optional
        Round every position to a grid with cells of this length, in the unit of the mesh. Parts that are encoded
        separately on the same grid fit bit for bit.
    grid_origin : (float, float, float), optional
        A point of this grid; None: the origin.
    limits : str
        Limits of the target decoder: "default", "service" or "wide". A stream that exceeds them is an error.
    threads : int, optional
        None: one per core.

    Raises
    ------
    OptionError
        If a value is outside its legal range, or options exclude each other.

    Examples
    --------
    >>> import bsm
    >>> options = bsm.EncodeOptions(step=0.002, keep_order=True)
    >>> data = bsm.encode("bunny.ply", options)
    >>> data = bsm.encode("bunny.ply", bsm.EncodeOptions(preset="paper", keep=0.1))
    """

    preset: InitVar[str | None] = None
    keep: float | None = None
    coefficients: int | None = None
    block_size: int = 450
    overlap: float | None = None
    key_interval: int = 8
    step: float | None = None
    smoothing: float | None = None
    keep_order: bool = False
    paper: Paper = Paper()
    target: Target | None = None
    contract: Contract | None = BALANCED
    effort: str = "normal"
    exact: bool = False
    congruence: bool = True
    grid: int | None = None
    attributes: Mapping[str, str] | tuple[tuple[str, str], ...] = ()
    normals: str = "look"
    grid_cell: float | None = None
    grid_origin: tuple[float, float, float] | None = None
    limits: str = "default"
    threads: int | None = None

    # Written out, since a field that is given counts more than the preset also where it is the default. Type checkers
    # see the one that the decorator would write, with the types of all fields.
    if not TYPE_CHECKING:

        def __init__(self, *, preset: str | None = None, **values: Any) -> None:
            if preset is not None:
                values = vars(changed(named("preset", PRESETS, preset), **values))
            defaults = {item.name: item.default for item in fields(self)}
            unknown = next((name for name in values if name not in defaults), None)
            if unknown is not None:
                advice = suggestion(unknown, defaults) or f"; its options are {', '.join(defaults)}"
                raise ArgumentError(f"EncodeOptions has no option {unknown}{advice}")
            for name, value in (defaults | values).items():
                object.__setattr__(self, name, value)
            self._check()

    def _check(self) -> None:
        check_options(self, CHOICES, RANGES)
        if self.target is not None:
            self.target._require_kind(TARGETS, "a mesh")
        object.__setattr__(self, "attributes", checked_qualities(self.attributes))
        if self.paper.bits is not None and self.paper.doi is None and self.target is not None:
            raise OptionError(
                "with bits, a target is reached by doi; it excludes keep and coefficients"
            )
        if self.exact and (
            self.grid is not None or self.grid_cell is not None or self.effort == "quick"
        ):
            raise OptionError("exact, grid and effort quick exclude each other")
        if self.grid is not None and self.grid_cell is not None:
            raise OptionError("give a grid by its bits or by the length of its cells, not both")
        if self.grid_origin is not None and self.grid_cell is None:
            raise OptionError(
                "a grid with a given origin needs the length of its cells, too: grid_cell"
            )
        if self.grid_origin is not None and not all(
            abs(number) <= 1e290 for number in self.grid_origin
        ):
            raise OptionError(f"the origin of a grid must be within 1e290, not {self.grid_origin}")
        if self.is_grid and (self.target is not None or self.sets_coding):
            raise OptionError("a grid excludes targets and options of blocks")
        if self.effort == "quick" and self.sets_coding:
            raise OptionError("effort quick uses a grid; it excludes options of blocks")

    @property
    def promise(self) -> Contract | None:
        """The contract, if the options use it."""
        if self.is_grid or self.sets_coding:
            return None
        return self.contract

    @property
    def grade(self) -> Grade:
        """Default attribute quality."""
        if self.is_grid:
            return "fine"
        farthest = (
            self.promise.farthest
            if self.promise is not None and not self.promise.absolute
            else BALANCED.farthest
        )
        return "fine" if farthest <= FINE else "small" if farthest >= SMALL else "balanced"

    @property
    def is_grid(self) -> bool:
        """Whether positions are kept exactly on a grid."""
        return self.exact or self.grid is not None or self.grid_cell is not None

    @property
    def first_step(self) -> float:
        """The step, or a usual one if it is None."""
        return STEP if self.step is None else self.step

    @property
    def sets_coding(self) -> bool:
        """Whether any option of `CODING` is given."""
        return any(
            getattr(self, name, getattr(self.paper, name, None)) is not None for name in CODING
        )

    @property
    def growth(self) -> float:
        """The overlap, or the usual one if it is None."""
        return self.overlap or (1.0 if self.paper.bits is None else PAPER_OVERLAP)

    @property
    def fixed_smoothing(self) -> float | None:
        """The amount of smoothing, or None if the encoder tries several."""
        return 0.0 if self.paper.bits is not None and self.smoothing is None else self.smoothing


def changed(options: EncodeOptions, **changes: Any) -> EncodeOptions:
    """The options with fields changed, those of `Paper` among them; a given c replaces one that follows the error."""
    if "doi" not in changes and (
        changes.get("keep") is not None or changes.get("coefficients") is not None
    ):
        changes["doi"] = None
    of_paper = {
        field.name: changes.pop(field.name) for field in fields(Paper) if field.name in changes
    }
    if of_paper:
        changes["paper"] = replace(changes.get("paper", options.paper), **of_paper)
    return replace(options, **changes)


EPS_H = 0.3
"""eps_h of preset "paper", in mean edge lengths; eps_l is a tenth less."""


CODING = ("step", "keep", "coefficients", "bits", "doi", "smoothing")
"""Options that say how blocks are coded, and not what shall come of it."""
# Promises of positions, from which on attributes are kept better, or less well.
FINE, SMALL = 0.001, 0.02
STEP = 0.004  # of blocks alone
PAPER_OVERLAP = 1.15

_WITHOUT_PROMISE = {
    "grid14": EncodeOptions(grid=14),
    "lossless": EncodeOptions(exact=True, attributes={"*": "exact"}),
    "none": EncodeOptions(block_size=1500, contract=None),
    "paper": EncodeOptions(
        paper=Paper(bits=12, partition="metis", power=2, doi=(0.9 * EPS_H, EPS_H)),
        key_interval=0,
        contract=None,
    ),
}
PRESETS: dict[str, EncodeOptions] = {
    row.name: _WITHOUT_PROMISE.get(row.name) or EncodeOptions(contract=PROMISES[row.name])
    for row in PRESET_ROWS
}
"""Names for what most users want, each a promise; "balanced" is the default, "none" promises nothing but what is
asked for beside it, and "paper" is the codec of the paper. Larger blocks are smaller files and slower to decode."""
