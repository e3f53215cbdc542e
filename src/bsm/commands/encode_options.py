"""The options of `bsm encode` that are fields of `EncodeOptions`: one table, flags derived from the fields' names."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from bsm import options

if TYPE_CHECKING:
    from bsm.codec.static.options import EncodeOptions


@dataclass(frozen=True)
class EncodeFlag:
    """One field of `EncodeOptions` on the command line.

    Parameters
    ----------
    field : str
        Name of the field; the flag is the same with dashes.
    type : callable
        Reads the value; `bool` makes a pair of flags, --x and --no-x.
    metavar : str
        What the value is called in the help.
    help : str
        What it does.
    """

    field: str
    type: Callable[[str], Any]
    metavar: str
    help: str

    def add(self, group: argparse._ArgumentGroup) -> None:
        """Add the flag; where it is not given the namespace has no such name, so `EncodeOptions` has the defaults."""
        name = f"--{self.field.replace('_', '-')}"
        if self.type is bool:
            group.add_argument(name, action=argparse.BooleanOptionalAction, default=argparse.SUPPRESS, help=self.help)
        else:
            group.add_argument(
                name, type=self.type, metavar=self.metavar, default=argparse.SUPPRESS, help=self.help, dest=self.field
            )


def point(text: str) -> tuple[float, ...]:
    """Three numbers with commas between them."""
    numbers = tuple(map(float, text.split(",")))
    if len(numbers) != 3:
        raise ValueError(text)
    return numbers


ENCODE_FLAGS = (
    EncodeFlag("grid", int, "BITS", "exactly the positions that a grid of so many bits per axis has (1 to 20)"),
    EncodeFlag("grid_cell", float, "H", "exactly the positions of a grid of such cells: parts on one fit exactly"),
    EncodeFlag("grid_origin", point, "X,Y,Z", "a place of that grid (default 0,0,0); =X,Y,Z where X is negative"),
    EncodeFlag("quick", bool, "", "only what is quick to decode: grids, by a small model, no blocks (default: no)"),
    EncodeFlag("keep", float, "FRACTION", "largest c_i, as a fraction of a block's vertices (default: as many as pay)"),
    EncodeFlag("coefficients", int, "C", "coefficients kept per block and coordinate, instead of --keep"),
    EncodeFlag("step", float, "S", "quantisation step, relative to the bounding box's diagonal; instead of a promise"),
    EncodeFlag("detail", float, "R", "how much coarser x, y, z are than detail along normals, 0: none (default 3)"),
    EncodeFlag("bits", int, "Q", "as in the paper: every coefficient in Q bits, without prediction"),
    EncodeFlag("smoothing", float, "A", "smoothing in the decoder (default: chosen by trying)"),
    EncodeFlag("block_size", int, "N", "vertices of a block before overlap, about (default 750)"),
    EncodeFlag("overlap", float, "F", "size of the blocks with overlap, as a multiple of the largest (default 1.15)"),
    EncodeFlag("partition", str, "derived|metis", "who cuts the mesh into blocks (default derived: both sides)"),
    EncodeFlag("key_seed", str, "cosines|svd", "where a chain begins (default cosines, with --bits svd)"),
    EncodeFlag("key_interval", int, "K", "every K blocks one depends on none before it, 0: the first (default 32)"),
    EncodeFlag("power", int, "Z", "exponent of the iterated matrix (default 3)"),
    EncodeFlag("iterations", int, "T", "orthogonal iterations per block (default 1)"),
    EncodeFlag("key_iterations", int, "T", "orthogonal iterations of a block that depends on none (default 4)"),
    EncodeFlag("shift", float, "D", "what is added to the Laplacian's diagonal (default 0.0078125)"),
    EncodeFlag("predict", bool, "", "predict coefficients from blocks already coded (default: yes)"),
    EncodeFlag("keep_order", bool, "", "store the order of vertices and faces (default: no)"),
    EncodeFlag("normals", str, "keep|recompute", "recompute: send none, the decoder makes them (default keep)"),
    EncodeFlag(
        "sections", int, "N", "come in so many turns of faces and blocks, to be drawn sooner (default: 2 if large)"
    ),
    EncodeFlag("limits", str, "default|service|wide", "what decoders may refuse is an error (default: default)"),
    EncodeFlag("threads", int, "N", "threads to use (default: one per core)"),
)


PRESETS = ("small", "balanced", "fine", "near-lossless", "grid14")
PROMISES = (
    "how far a vertex may be off, of the diagonal, and normals on average: small 2 %% and 12 degrees, balanced 1 %% "
    "and 8 (default), fine 0.5 %% and 3, near-lossless 0.05 %%; grid14: exactly as on a grid of 14 bits"
)
"""Of the presets; written out, since importing what they are takes time."""

TARGET_FLAGS = (
    ("nmsve-db", "nmsve_db", "X", "visual error, 10 log10 NMSVE, at most X"),
    ("theta", "theta_deg", "DEG", "mean angle between the faces' normals before and after at most DEG"),
    (
        "max-error",
        "max_error",
        "REL",
        "no vertex farther off than REL diagonals of the bounding box; with a unit (0.05mm), in the mesh's own",
    ),
    ("bpv", "bpv", "X", "at most X bits per vertex, the whole file counted"),
    ("size", "size", "BYTES", "at most BYTES"),
)
"""Flag, kind of target, metavar and help."""


def number_or_length(text: str) -> float | str:
    """A number, or what has a unit behind it."""
    try:
        return float(text)
    except ValueError:
        return text


def named_quality(text: str) -> tuple[str, str]:
    """NAME=QUALITY taken apart."""
    name, separator, quality = text.rpartition("=")
    if not (name and separator):
        raise argparse.ArgumentTypeError(f"NAME=QUALITY is expected, such as texcoord=12bits, not {text!r}")
    return name, quality


def add_encode_flags(parser: argparse.ArgumentParser) -> None:
    """Add presets, targets and the flags of `add_coding_flags`."""
    wishes = parser.add_argument_group("what to reach", "a target is met in closed loop, on what the decoder will see")
    wishes.add_argument("--preset", choices=PRESETS, default="balanced", help=PROMISES)
    targets = wishes.add_mutually_exclusive_group()
    for name, kind, metavar, text in TARGET_FLAGS:
        reads = number_or_length if name == "max-error" else float
        targets.add_argument(f"--{name}", dest=f"target_{kind}", type=reads, metavar=metavar, help=text)
    wishes.add_argument(
        "--lock-borders",
        nargs="?",
        const=True,
        default=argparse.SUPPRESS,
        metavar="GAP",
        help="parts that are encoded apart gape by at most GAP where they were one: relative (default 0.0001), or "
        "with a unit (0.05mm)",
    )
    add_coding_flags(parser)


def add_coding_flags(parser: argparse.ArgumentParser) -> None:
    """Add all of `ENCODE_FLAGS`, and the thresholds of dynamic subspaces."""
    group = parser.add_argument_group("coding")
    for flag in ENCODE_FLAGS:
        flag.add(group)
    group.add_argument(
        "--attribute",
        dest="attributes",
        action="append",
        type=named_quality,
        metavar="NAME=QUALITY",
        default=argparse.SUPPRESS,
        help="how an attribute is kept: exact, 12bits, 0.01 (a bound), 1%%, 2deg, recompute or none; the name * is "
        "any other one; may be repeated",
    )
    group.add_argument(
        "--no-attributes",
        dest="attributes",
        action="append_const",
        const=("*", "none"),
        default=argparse.SUPPRESS,
        help="leave out all attributes that --attribute does not name; where none is left, materials and images, too",
    )
    group.add_argument(
        "--doi",
        nargs=2,
        type=float,
        metavar=("EPS_L", "EPS_H"),
        default=argparse.SUPPRESS,
        help="dynamic subspaces: as many coefficients per block as keep its residual between the two thresholds",
    )


def given_options(args: argparse.Namespace) -> dict[str, Any]:
    """The fields of `EncodeOptions` that were given on the command line, presets and targets left aside."""
    given = {flag.field: getattr(args, flag.field) for flag in ENCODE_FLAGS if hasattr(args, flag.field)}
    if getattr(args, "attributes", None):
        given["attributes"] = dict(args.attributes)
    if hasattr(args, "lock_borders"):
        given["lock_borders"] = args.lock_borders
    if hasattr(args, "doi"):
        given["doi"] = tuple(args.doi)
    return given


def given_targets(args: argparse.Namespace) -> dict[str, Any]:
    """The targets that were given on the command line, by their keywords."""
    values = {name.replace("-", "_"): getattr(args, f"target_{kind}") for name, kind, _, _ in TARGET_FLAGS}
    return {keyword: value for keyword, value in values.items() if value is not None}


def encode_options(args: argparse.Namespace) -> EncodeOptions:
    """The options that the command line asks for: a preset, what was given on top of it, and a target."""
    return options.encode_options(preset=args.preset, **given_options(args), **given_targets(args))
