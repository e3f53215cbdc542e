"""Options that several commands take: inputs and outputs, limits."""

import argparse
import math
from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Any, TypeVar

from bsm.bitstream.errors import OptionError
from bsm.bitstream.limits import NAMED_LIMITS, Limits
from bsm.codec.choices import suggestion
from bsm.files.output import refuse_terminal


@dataclass(frozen=True)
class Flag:
    """A keyword of `bsm.options` on the command line: `--field VALUE`, or `--set field=VALUE`."""

    field: str
    type: Callable[[str], Any]
    metavar: str
    help: str

    def add(self, group: argparse._ActionsContainer) -> None:
        """Add it as a flag. Without a value the namespace has no such name: defaults are elsewhere."""
        how: dict[str, Any] = {"action": argparse.BooleanOptionalAction} if self.type is bool else {"type": self.type}
        how |= {"choices": self.metavar.split("|")} if "|" in self.metavar else {}
        add = adder(group)
        add(f"--{self.field.replace('_', '-')}", self.metavar, self.help, default=argparse.SUPPRESS, **how)


def adder(parser: argparse._ActionsContainer) -> Callable[..., argparse.Action]:
    """Return a function that adds an argument: names, the name of its value or "" for a switch, help, and details."""

    def add(names: str, value: str, about: str, **more: Any) -> argparse.Action:
        plain = {"metavar": value} if value else {} if "choices" in more else {"action": "store_true"}
        return parser.add_argument(*names.split(), help=about, **{**plain, **more})

    return add


class HelpAll(argparse.Action):
    def __call__(self, parser: argparse.ArgumentParser, *_: Any) -> None:
        parser.print_help()
        print("\nsettings, --set NAME=VALUE:")
        width = max(len(f"{setting.field}={setting.metavar}") for setting in SETTINGS)
        for setting in SETTINGS:
            print(f"  {f'{setting.field}={setting.metavar}':{width}}  {setting.help}")
        parser.exit()


def within(least: int, most: float = math.inf) -> Callable[[str], int]:
    """A type of options that are whole numbers in a closed range."""

    def whole_number(text: str) -> int:
        number = int(text)
        if number < least:
            raise argparse.ArgumentTypeError(f"{number} is less than {least}")
        if number > most:
            raise argparse.ArgumentTypeError(f"{number} is more than {most}")
        return number

    return whole_number


def numbers(count: int) -> Callable[[str], tuple[float, ...]]:
    """A type of options that are numbers with commas between them."""

    def parsed(text: str) -> tuple[float, ...]:
        found = tuple(map(float, text.split(",")))
        if len(found) != count:
            raise ValueError(text)
        return found

    return parsed


def named_setting(text: str) -> tuple[str, Any]:
    """NAME=VALUE as a field of `EncodeOptions` and its value."""
    name, _, value = text.partition("=")
    known = {setting.field: setting for setting in SETTINGS}
    name = name.strip().replace("-", "_")
    if (setting := known.get(name)) is None:
        raise argparse.ArgumentTypeError(f"unknown setting {name!r}{suggestion(name, known)}; see --help-all")
    value, choices = value.strip(), setting.metavar.split("|")
    if len(choices) > 1 and value not in choices:
        wrong = f"unknown value {value!r} of {name}{suggestion(value, choices)} ({', '.join(choices)})"
        raise argparse.ArgumentTypeError(wrong)
    try:
        return name, setting.type(value)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{name}={setting.metavar} is expected, not {text!r}") from None


ENCODE_FLAGS = (
    Flag("grid", int, "BITS", "round positions to a grid of BITS bits per axis (1 to 20)"),
    Flag("grid_cell", float, "H", "round positions to a grid with cells of H. Parts on one grid fit exactly"),
    Flag("grid_origin", numbers(3), "X,Y,Z", "a point of the grid (default 0,0,0)"),
    Flag("effort", str, "quick|normal|best", "quick: faster, larger files; best: slower, smaller (default normal)"),
    Flag("keep_order", bool, "", "store the order of vertices and faces; PC2 and MDD keep that of vertices"),
    Flag("threads", int, "N", "threads to use (default: one per core)"),
)

SETTINGS = (
    Flag("congruence", lambda text: text == "yes", "yes|no", "use congruent parts; no: format 1.0 (default yes)"),
    Flag("limits", str, "default|service|wide", "limits that decoders must accept (default: default)"),
    Flag("keep", float, "FRACTION", "largest c_i, as a fraction of a block's vertices (default: by rate)"),
    Flag("coefficients", int, "C", "coefficients kept per block and coordinate, instead of keep"),
    Flag("step", float, "S", "quantization step, relative to the diagonal; replaces the promise"),
    Flag("bits", int, "Q", "as in the paper: every coefficient in Q bits, without prediction"),
    Flag("block_size", int, "N", "approximate vertices of a block before overlap (default 450)"),
    Flag("partition", str, "derived|metis", "how to cut the mesh into blocks (default derived)"),
    Flag("key_seed", str, "cosines|svd", "first dictionary of a chain (default cosines; with bits, svd)"),
    Flag("key_interval", int, "K", "every K-th block starts a chain; 0: only the first (default 8)"),
    Flag("power", int, "Z", "exponent of the iterated matrix (default 3)"),
    Flag("iterations", int, "T", "orthogonal iterations per block (default 1)"),
    Flag("doi", numbers(2), "EPS_L,EPS_H", "choose coefficients so that each block is off by so many mean edges"),
)
"""Advanced settings of the codec: `--set NAME=VALUE`."""


IMAGES = "recompress images with Pillow: webp, jpeg, png; webp:85 sets the quality, webp:85@1024 also the longest side"
PRESETS = ("small", "balanced", "fine", "near-lossless", "grid14", "lossless", "none", "paper")
PROMISES = (
    "The encoder checks the decoded result before it writes a file. All constraints apply together.\n\n"
    "preset         look  vertex  (look distance; largest error, relative to the diagonal of its component)\n"
    "small          3     2 %     a preview: the shape is right, detail is lost\n"
    "balanced       1     1 %     the default: the same at a glance in smooth shading\n"
    "fine           0.5   0.5 %   closer; for flat shading\n"
    "near-lossless  0.25  0.05 %  a bound for measuring, of the diagonal of the whole mesh\n"
    "grid14                       exact positions on a grid of 14 bits per axis\n"
    "lossless                     exact positions in single precision, exact attributes\n"
    "none                         only the bounds and targets that you give\n"
    "paper                        no promise: the codec of the paper, for research"
)
"""A table of the presets; written out, because importing their definitions takes time."""


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
    Flag("look", number_or_length, "D", "largest look distance from the original: 1 is balanced, 3 a preview"),
    Flag("max_error", number_or_length, "REL", "largest vertex error: 0.1%% (of the diagonal), or a length (0.05mm)"),
)
TARGETS = (
    Flag("nmsve_db", float, "X", "largest normalized mean squared visual error, dB"),
    Flag("theta", float, "DEG", "largest mean angle between face normals before and after, degrees"),
    Flag("bpv", float, "X", "largest number of bits per vertex, of the whole file"),
    Flag("size", number_or_length, "BYTES", "largest file (20000, 20kB)"),
)
OF_SEQUENCES = (
    Flag("kg", float, "PERCENT", "largest error of Karni and Gotsman, percent"),
    Flag("bpvf", float, "X", "largest number of bits per vertex and frame, of the whole file"),
    Flag("runs", bool, "", "let the faces change from frame to frame"),
    Flag("gop", int, "N", "largest group of frames that are coded together (default 256 to 512)"),
    Flag("low_delay", int, "N", "send N frames at a time, and a key frame every --gop frames"),
    Flag("frame_rate", float, "FPS", "frames per second: metadata; sampling rate of glTF and USD animations"),
)


def add_encode_flags(parser: argparse.ArgumentParser) -> None:
    add_preset_flags(parser)
    group = parser.add_argument_group("coding")
    for setting in ENCODE_FLAGS:
        setting.add(group)
    add, unset = adder(group), {"default": argparse.SUPPRESS}
    repeated = {"action": "append", **unset}
    add("--quick", "", "same as --effort quick", dest="effort", action="store_const", const="quick", **unset)
    quality = "quality of an attribute: exact, 12bits, 0.01 (a bound), 1%%, 2deg, recompute or none. The name * means "
    quality += "all others; *=none also drops materials and images. May be repeated"
    add("--attribute", "NAME=QUALITY", quality, dest="attributes", type=named_quality, **repeated)
    advanced = "an advanced setting; --help-all lists them. May be repeated"
    add("--set", "NAME=VALUE", advanced, type=named_setting, **repeated)
    show = {"action": HelpAll, "nargs": 0, **unset}
    adder(parser)("--help-all", "", "show this help with all settings", **show)
    group = parser.add_argument_group(
        "sequences",
        "Inputs: a folder or a pattern of meshes; several meshes with -o NAME.bsm; npz, PC2, MDD, USD; GLB with\n"
        "--animation; npy arrays on a pipe (the faces, then the positions of each frame).",
    )
    for setting in OF_SEQUENCES:
        setting.add(group)
    add = adder(group)
    add("--animation", "NAME", "encode this animation of a GLB or glTF, by name or number (0)")
    add("--mesh", "FILE", "mesh of a PC2 or MDD (default: the file of the same name beside it)", dest="cache_mesh")
    add("--frames", "", "the pipe contains frames, as with --format npy", dest="piped_frames")


def add_preset_flags(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("quality and size", PROMISES)
    group.add_argument("--preset", choices=PRESETS, default=argparse.SUPPRESS, help="see above (default: balanced)")
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
    """Declare the inputs, the number of jobs and, if the command writes, the output."""
    add, many = adder(parser), adder(parser.add_argument_group("many inputs"))
    add("inputs", "IN", f"{about_them}; or a URL (s3://bucket/name)", nargs="+")
    if output:
        add("-o --output", "OUT", output)
    add("-j --jobs", "N", "work on N inputs at a time; 0: one per core (default 1)", type=within(0), default=1)
    add("--json", "", "print the result as JSON")
    many("--dask", "ADDRESS", "run on the Dask cluster of this scheduler")
    if output:
        many("--report", "FILE.json", "write the result of each input to a file, print a table")
        many("--resume", "", "continue the run of --report: skip inputs whose output is complete and up to date")
    else:
        parser.set_defaults(output=None, report=None, resume=False)


def refuse_two_on_one_pipe(args: argparse.Namespace, output: str) -> None:
    """Raise `OptionError` if a file and JSON would both go to standard output, or bytes to a terminal."""
    if output == "-" and args.json:
        raise OptionError("--json and -o - would both write to standard output")
    refuse_terminal(output)


def asked(kind: type[_Asked], args: argparse.Namespace, **more: Any) -> _Asked:
    """Return the flags of a command line as a dataclass with fields of the same names."""
    given = {field.name: getattr(args, field.name) for field in fields(kind) if hasattr(args, field.name)}  # type: ignore[arg-type]
    return kind(**{**given, **more})


def add_limits_flag(parser: argparse.ArgumentParser) -> None:
    granted = "memory and time that a stream may take. default: in proportion to its vertices and bytes. service: at "
    granted += "most 1 GiB and 10 s, for untrusted files of up to a million vertices. wide: for your own files only"
    parser.add_argument("--limits", choices=tuple(NAMED_LIMITS), default="default", help=granted)


def limits_of(name: str) -> Limits:
    return NAMED_LIMITS[name]()
