"""Options that several commands take: inputs and outputs, limits, readers."""

import argparse
from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Any, TypeVar

from bsm.bitstream.errors import OptionError
from bsm.bitstream.limits import NAMED_LIMITS, Limits
from bsm.cli import suggestion
from bsm.files.mesh import READERS
from bsm.files.output import refuse_terminal


@dataclass(frozen=True)
class Setting:
    """A keyword of `bsm.options` on the command line: `--field VALUE`, or `--set field=VALUE`."""

    field: str
    type: Callable[[str], Any]
    metavar: str
    help: str

    def add(self, group: argparse._ActionsContainer) -> None:
        """Add it as a flag; a namespace has no such name where it is not given: defaults stand elsewhere."""
        typed = {"type": self.type, "metavar": self.metavar}
        how: dict[str, Any] = {"action": argparse.BooleanOptionalAction} if self.type is bool else typed
        how |= {"dest": self.field, "default": argparse.SUPPRESS, "help": self.help}
        group.add_argument(f"--{self.field.replace('_', '-')}", **how)


class HelpAll(argparse.Action):
    def __call__(self, parser: argparse.ArgumentParser, *_: Any) -> None:
        parser.print_help()
        print("\nsettings, --set NAME=VALUE:")
        width = max(len(f"{one.field}={one.metavar}") for one in SETTINGS)
        for one in SETTINGS:
            print(f"  {f'{one.field}={one.metavar}':{width}}  {one.help}")
        parser.exit()


def thresholds(text: str) -> tuple[float, float]:
    low, high = map(float, text.split(","))
    return low, high


def named_setting(text: str) -> tuple[str, Any]:
    """NAME=VALUE as a field of `EncodeOptions` and its value."""
    name, _, value = text.partition("=")
    known = {one.field: one for one in SETTINGS}
    name = name.strip().replace("-", "_")
    if (one := known.get(name)) is None:
        raise argparse.ArgumentTypeError(f"there is no setting {name!r}{suggestion(name, known)}; see --help-all")
    try:
        return name, one.type(value.strip())
    except ValueError:
        raise argparse.ArgumentTypeError(f"{name}={one.metavar} is expected, not {text!r}") from None


def point(text: str) -> tuple[float, ...]:
    numbers = tuple(map(float, text.split(",")))
    if len(numbers) != 3:
        raise ValueError(text)
    return numbers


ENCODE_FLAGS = (
    Setting("grid", int, "BITS", "exactly the positions that a grid of so many bits per axis has (1 to 20)"),
    Setting("grid_cell", float, "H", "exactly the positions of a grid of such cells: parts on one fit exactly"),
    Setting("grid_origin", point, "X,Y,Z", "a place of that grid (default 0,0,0)"),
    Setting(
        "effort",
        str,
        "quick|normal|best",
        "quick: grids without blocks, frames unsearched; best: try more (default normal)",
    ),
    Setting("quick", bool, "", "another name of --effort quick"),
    Setting("keep_order", bool, "", "store the order of vertices and faces; of a PC2 or MDD, by default, of vertices"),
    Setting("threads", int, "N", "threads to use (default: one per core)"),
)

SETTINGS = (
    Setting("limits", str, "default|service|wide", "what decoders may refuse is an error (default: default)"),
    Setting("keep", float, "FRACTION", "largest c_i, as a fraction of a block's vertices (default: as many as pay)"),
    Setting("coefficients", int, "C", "coefficients kept per block and coordinate, instead of keep"),
    Setting("step", float, "S", "quantisation step, relative to the bounding box's diagonal; instead of a promise"),
    Setting("bits", int, "Q", "as in the paper: every coefficient in Q bits, without prediction"),
    Setting("block_size", int, "N", "vertices of a block before overlap, about (default 550)"),
    Setting("partition", str, "derived|metis", "who cuts the mesh into blocks (default derived: both sides)"),
    Setting("key_seed", str, "cosines|svd", "where a chain begins (default cosines, with bits svd)"),
    Setting("key_interval", int, "K", "every K blocks one depends on none before it, 0: the first (default 8)"),
    Setting("power", int, "Z", "exponent of the iterated matrix (default 3)"),
    Setting("iterations", int, "T", "orthogonal iterations per block (default 1)"),
    Setting("doi", thresholds, "EPS_L,EPS_H", "coefficients of a block until its residual is between two thresholds"),
)
"""What few need, and the codec's inside for those who study it: `--set NAME=VALUE`."""


PRESETS = ("small", "balanced", "fine", "near-lossless", "grid14", "lossless", "none")
PROMISES = (
    "how far from the original a mesh may look (see --look), and a vertex be off, of the diagonal of its part: small 3 "
    "(a preview) and 2 %%; balanced, the default, 1 (the same at a glance) and 1 %%; fine 0.5 and 0.5 %%; "
    "near-lossless 0.25 and 0.05 %% (of the whole diagonal); grid14: exactly as on a grid of 14 bits; lossless: single "
    "precision, to the bit; none: nothing "
    "but what is asked for beside it"
)
"""Of the presets; written out, since importing what they are takes time."""


def number_or_length(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text


def named_quality(text: str) -> tuple[str, str]:
    name, separator, quality = text.rpartition("=")
    if not (name and separator):
        raise argparse.ArgumentTypeError(f"NAME=QUALITY is expected, such as texcoord=12bits, not {text!r}")
    return name, quality


BOUNDS = (
    Setting("look", number_or_length, "D", "at most D from the original in pictures: 1 is the default, 3 a preview"),
    Setting("max_error", number_or_length, "REL", "no vertex farther off than REL diagonals, or a length (0.05mm)"),
)
TARGETS = (
    Setting("nmsve_db", float, "X", "visual error, 10 log10 NMSVE, at most X"),
    Setting("theta", float, "DEG", "mean angle between the faces' normals before and after at most DEG"),
    Setting("bpv", float, "X", "at most X bits per vertex, the whole file counted"),
    Setting("size", number_or_length, "BYTES", "at most BYTES (20000, 20kB)"),
)
OF_SEQUENCES = (
    Setting("kg", float, "PERCENT", "Karni and Gotsman's error at most PERCENT"),
    Setting("bpvf", float, "X", "at most X bits per vertex and frame, the whole file"),
    Setting("runs", bool, "", "let the faces change from frame to frame"),
    Setting("gop", int, "N", "frames that are coded together, at most (default 256 to 512)"),
    Setting("low_delay", int, "N", "send N frames as they come (8: a quarter smaller than 1), keys every --gop frames"),
    Setting("frame_rate", float, "FPS", "frames per second, as metadata, and of samples of animations (glTF, USD)"),
)


def add_encode_flags(parser: argparse.ArgumentParser) -> None:
    add_preset_flags(parser)
    group = parser.add_argument_group("coding")
    for setting in ENCODE_FLAGS:
        setting.add(group)
    group.add_argument(
        "--attribute",
        dest="attributes",
        action="append",
        type=named_quality,
        metavar="NAME=QUALITY",
        default=argparse.SUPPRESS,
        help="how an attribute is kept: exact, 12bits, 0.01 (a bound), 1%%, 2deg, recompute or none; * is any other "
        "one (*=none: materials and images go, too); may be repeated",
    )
    group.add_argument(
        "--set",
        action="append",
        type=named_setting,
        metavar="NAME=VALUE",
        default=argparse.SUPPRESS,
        help="one of the settings that few need; --help-all lists them",
    )
    parser.add_argument("--help-all", nargs=0, action=HelpAll, default=argparse.SUPPRESS, help="also list the settings")
    group = parser.add_argument_group(
        "sequences",
        "a folder or pattern of meshes, several meshes with -o NAME.bsm, npz, PC2, MDD, USD, GLB with\n"
        "--animation, or npy arrays on a pipe (the faces, then the positions of each frame)",
    )
    for setting in OF_SEQUENCES:
        setting.add(group)
    add, beside = group.add_argument, "the mesh of a PC2 or MDD (default: of the same name beside it)"
    add(
        "--animation", metavar="NAME", help="this animation of a GLB or glTF, by name or number (0), not the mesh alone"
    )
    add("--mesh", dest="cache_mesh", metavar="FILE", help=beside)
    add("--frames", dest="piped_frames", action="store_true", help="a pipe holds frames, as --format npy")


def add_preset_flags(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("what to reach", "checked on what the decoder will see; all that is given holds")
    group.add_argument("--preset", choices=PRESETS, default=argparse.SUPPRESS, help=PROMISES)
    for setting in BOUNDS:
        setting.add(group)
    targets = group.add_mutually_exclusive_group()
    for setting in TARGETS:
        setting.add(targets)


_KEYWORDS = ("preset", *(setting.field for setting in (*BOUNDS, *TARGETS, *ENCODE_FLAGS, *OF_SEQUENCES)))


def options_of(args: argparse.Namespace) -> dict[str, Any]:
    given = {name: getattr(args, name) for name in _KEYWORDS if hasattr(args, name)}
    if hasattr(args, "attributes"):
        given["attributes"] = dict(args.attributes)
    return {**given, **dict(getattr(args, "set", ()))}


_Asked = TypeVar("_Asked")


def add_inputs(parser: argparse.ArgumentParser, about_them: str, output: str | None = None) -> None:
    """Declare inputs, how many are worked on at a time, and, where the command writes, its output."""
    add = parser.add_argument
    add("inputs", metavar="IN", nargs="+", help=f"{about_them}; URLs as well (s3://bucket/name)")
    if output:
        add("-o", "--output", metavar="OUT", help=output)
    add("-j", "--jobs", type=int, default=1, metavar="N", help="inputs to work on at a time, 0: one per core (1)")
    add("--json", action="store_true", help="print the result as JSON")
    many = parser.add_argument_group("many inputs")
    many.add_argument("--dask", metavar="ADDRESS", help="work on the Dask cluster of this scheduler")
    if output:
        many.add_argument("--report", metavar="FILE.json", help="write what came of each input, print a table")
        resumed = "go on from --report: leave what is whole and as it would be made"
        many.add_argument("--resume", action="store_true", help=resumed)
    else:
        parser.set_defaults(output=None, report=None, resume=False)


def refuse_two_on_one_pipe(args: argparse.Namespace, output: str) -> None:
    """Raise `OptionError` where a file and JSON would both go to standard output, or bytes to a terminal."""
    if output == "-" and args.json:
        raise OptionError("--json and -o - would both write to standard output")
    refuse_terminal(output)


def asked(kind: type[_Asked], args: argparse.Namespace, **more: Any) -> _Asked:
    """What a command line asks for: the flags that are named as the fields of a dataclass."""
    given = {field.name: getattr(args, field.name) for field in fields(kind) if hasattr(args, field.name)}  # type: ignore[arg-type]
    return kind(**{**given, **more})


def add_limits_flag(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--limits",
        choices=tuple(NAMED_LIMITS),
        default="default",
        help="what a stream may cost: service: at most 1 GiB and 10 s, for strangers' files of up to a million "
        "vertices; wide: what one has made oneself (default: by its vertices and bytes)",
    )


def limits_of(name: str) -> Limits:
    return NAMED_LIMITS[name]()


def add_reader_flag(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--reader",
        choices=READERS,
        help="who reads mesh files (default: bsm for OBJ, OFF, PLY, STL, VTP and npz, trimesh for GLB, 3MF, DAE, ...)",
    )
