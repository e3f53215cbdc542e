"""Options that several commands take: inputs and outputs, limits."""

import argparse
import csv
import math
from collections.abc import Callable
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, TypeVar

from bsm.bitstream.errors import OptionError
from bsm.codec.choices import suggestion
from bsm.codec.static.presets import DEFAULT, PRESET_ROWS
from bsm.files.output import refuse_terminal


# A row of a table and not a call, since tests and documents read the table, too: what an option is called and does is
# told once.
@dataclass(frozen=True)
class Flag:
    """A row of options.csv: an option, or the keyword of a setting. A row without a group is of that before."""

    group: str
    names: str
    kind: str
    value: str
    default: str
    help: str

    @property
    def field(self) -> str:
        return self.names.split()[-1].removeprefix("--").replace("-", "_")

    def parse(self, text: str) -> Any:
        return _TYPES.get(self.kind, str)(text)

    def add(self, group: argparse._ActionsContainer) -> None:
        how: dict[str, Any] = {}
        if self.kind in _ACTIONS:
            how |= _ACTIONS[self.kind]
        elif self.value:
            how["type"] = _TYPES.get(self.kind)
        if "|" in self.value:
            how["choices"] = self.value.split("|")
        if self.default == "required":
            how["required"] = True
        elif self.default:
            how["default"] = self.parse(self.default)
        elif self.group in UNSET:
            # Without a default in the namespace, an option that was not given differs from one that was given its
            # default. Presets need to know which.
            how["default"] = argparse.SUPPRESS
        adder(group)(self.names, self.value, self.help, **how)


def adder(parser: argparse._ActionsContainer) -> Callable[..., argparse.Action]:
    """Return a function that adds an argument: names, the name of its value or "" for a switch, help, and details."""

    def add(names: str, value: str, about: str, **more: Any) -> argparse.Action:
        # A switch has no value, and argparse refuses a metavar for it.
        how: dict[str, Any] = {}
        if value:
            how["metavar"] = value
        elif "choices" not in more:
            how["action"] = "store_true"
        return parser.add_argument(*names.split(), help=about, **{**how, **more})

    return add


# The usual help stays short enough to be read. Settings for researchers are listed here only.
class HelpAll(argparse.Action):
    def __call__(self, parser: argparse.ArgumentParser, *_: Any) -> None:
        parser.print_help()
        print("\nsettings, --set NAME=VALUE:")
        texts = [f"{setting.field}={setting.value}" for setting in FLAGS["settings"]]
        width = max(map(len, texts))
        for text, setting in zip(texts, FLAGS["settings"]):
            print(f"  {text:{width}}  {setting.help}")
        parser.exit()


def within(least: int, most: float = math.inf) -> Callable[[str], int]:
    """A type of options that are whole numbers in a closed range."""

    def whole_number(text: str) -> int:
        try:
            number = int(text)
        except ValueError:
            raise argparse.ArgumentTypeError(f"a whole number is expected, not {text!r}") from None
        if number < least:
            raise argparse.ArgumentTypeError(f"{number} is less than {least}")
        if number > most:
            raise argparse.ArgumentTypeError(f"{number} is more than {most}")
        return number

    return whole_number


def numbers(count: int) -> Callable[[str], tuple[float, ...]]:
    """A type of options that are finite numbers with commas between them."""

    def parsed(text: str) -> tuple[float, ...]:
        try:
            values = tuple(map(float, text.split(",")))
        except ValueError:
            values = ()
        # float() reads "nan" and "inf", which no coordinate may be.
        if len(values) != count or not all(map(math.isfinite, values)):
            raise argparse.ArgumentTypeError(
                f"{count} numbers with commas between them are expected, not {text!r}"
            )
        return values

    return parsed


def whole_number(text: str) -> int:
    return within(-(1 << 63), 1 << 63)(text)


def number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"a number is expected, not {text!r}") from None


def number_of_blocks(text: str) -> int:
    if ":" in text:
        raise argparse.ArgumentTypeError(
            f"{text!r} is a range; blocks are decoded from the first on: give their number"
        )
    number = whole_number(text)
    if number < 1:
        raise argparse.ArgumentTypeError(
            f"at least one block is decoded: give 1 or more, not {number}"
        )
    return number


def frames_or_input(text: str) -> str:
    """Check a range of frames; return an input that stands after the flag as it is."""
    if ":" in text and "://" not in text:
        from bsm.files.motion.folder import frame_range  # which loads much of the codec

        try:
            frame_range(text)
        except OptionError as error:
            raise argparse.ArgumentTypeError(str(error)) from None
    return text


def named_setting(text: str) -> tuple[str, Any]:
    """NAME=VALUE as a field of `EncodeOptions` and its value."""
    name, _, value = text.partition("=")
    settings = {setting.field: setting for setting in FLAGS["settings"]}
    name = name.strip().replace("-", "_")
    if (setting := settings.get(name)) is None:
        raise argparse.ArgumentTypeError(
            f"unknown setting {name!r}{suggestion(name, settings)}; see --help-all"
        )
    value, choices = value.strip(), setting.value.split("|")
    if len(choices) > 1 and value not in choices:
        wrong = (
            f"unknown value {value!r} of {name}{suggestion(value, choices)} ({', '.join(choices)})"
        )
        raise argparse.ArgumentTypeError(wrong)
    try:
        return name, setting.parse(value)
    except (ValueError, argparse.ArgumentTypeError):
        raise argparse.ArgumentTypeError(
            f"{name}={setting.value} is expected, not {text!r}"
        ) from None


PROMISES = "The encoder checks the decoded result before it writes a file. All constraints apply together.\n\n"
PROMISES += "preset         look  vertex  (look distance; largest error, relative to the diagonal of its component)\n"
PROMISES += "\n".join(
    "{:14} {:5} {:7} {}".format(row.name, *row.bounds, row.use) for row in PRESET_ROWS
)
PRESETS = tuple(row.name for row in PRESET_ROWS)


def number_or_length(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text


def named_quality(text: str) -> tuple[str, str]:
    # From the right, since names of attributes may hold the sign.
    name, separator, quality = text.rpartition("=")
    if not (name and separator):
        raise argparse.ArgumentTypeError(
            f"NAME=QUALITY is expected, such as texcoord=12bits, not {text!r}"
        )
    return name, quality


def unit(text: str) -> str:
    # numpy takes longer to load than the rest of a short command.
    from bsm.ground.lengths import UnitError, known_unit  # needs numpy

    try:
        known_unit(text, "unit")
    except UnitError as error:
        raise argparse.ArgumentTypeError(str(error)) from None
    return text


_TYPES: dict[str, Callable[[str], Any]] = {
    "2": numbers(2),
    "3": numbers(3),
    "6": numbers(6),
    "int": whole_number,
    "float": number,
    "blocks": number_of_blocks,
    "length": number_or_length,
    "yes": lambda text: text == "yes",
    "unit": unit,
    "count": within(0),
    "positive": within(1),
    "port": within(0, 65535),
}
_ACTIONS: dict[str, dict[str, Any]] = {
    "onoff": {"action": argparse.BooleanOptionalAction},
    "list": {"action": "append", "default": []},
}


def _read_flags() -> dict[str, list[Flag]]:
    """Read options.csv, in which a row without a group is of that before."""
    table = Path(__file__).with_name("options.csv").read_text("utf-8")
    flags: dict[str, list[Flag]] = {}
    group = ""
    for row in csv.DictReader(table.splitlines()):
        group = row["group"] or group
        flags.setdefault(group, []).append(Flag(**{**row, "group": group}))
    return flags


FLAGS = _read_flags()
"""The rows of options.csv, by group; those of the group settings are given by `--set NAME=VALUE`."""


UNSET = ("bounds", "targets", "coding", "sequences", "denoise method")
"""Groups whose options the namespace lacks unless they are given."""


def add_flags(parser: argparse._ActionsContainer, *groups: str) -> None:
    """Add the flags of groups of options.csv."""
    for group in groups:
        for flag in FLAGS[group]:
            flag.add(parser)


def add_encode_flags(parser: argparse.ArgumentParser) -> None:
    add_flags(parser, "encode")
    add_preset_flags(parser)
    group = parser.add_argument_group("coding")
    add_flags(group, "coding")
    add, unset = adder(group), {"default": argparse.SUPPRESS}
    repeated = {"action": "append", **unset}
    # Both are in use. Two names for one keyword, so that they cannot contradict each other.
    add(
        "--quick",
        "",
        "same as --effort quick",
        dest="effort",
        action="store_const",
        const="quick",
        **unset,
    )
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
    add_flags(group, "sequences")
    add = adder(group)
    add("--animation", "NAME", "encode this animation of a GLB or glTF, by name or number (0)")
    add(
        "--mesh",
        "FILE",
        "mesh of a PC2 or MDD (default: the file of the same name beside it)",
        dest="cache_mesh",
    )
    about = "encode frames A to B - 1 only, counted from 0. Without A:B, the pipe contains frames, as with --format npy"
    add("--frames", "A:B", about, nargs="?", const="", type=frames_or_input)


def add_preset_flags(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("quality and size", PROMISES)
    group.add_argument(
        "--preset",
        choices=PRESETS,
        default=argparse.SUPPRESS,
        help=f"a promise of the table (default: {DEFAULT})",
    )
    add_flags(group, "bounds")
    add_flags(group.add_mutually_exclusive_group(), "targets")


def options_of(args: argparse.Namespace, *groups: str) -> dict[str, Any]:
    """Return the options of groups that are given on a command line."""
    options = {}
    for group in groups:
        for flag in FLAGS[group]:
            if hasattr(args, flag.field):
                options[flag.field] = getattr(args, flag.field)
    return options


def keywords_of(args: argparse.Namespace) -> dict[str, Any]:
    """Return the keywords of `bsm.encoding.options` that a command line gives for encoding."""
    keywords = options_of(args, "bounds", "targets", "coding", "sequences")
    if hasattr(args, "preset"):
        keywords["preset"] = args.preset
    if hasattr(args, "attributes"):
        keywords["attributes"] = dict(args.attributes)
    return keywords | dict(getattr(args, "set", ()))


_Asked = TypeVar("_Asked")


def add_inputs(parser: argparse.ArgumentParser, about_them: str, output: str | None = None) -> None:
    """Declare the inputs, the number of jobs and, if the command writes, the output."""
    add, many = adder(parser), parser.add_argument_group("many inputs")
    add("inputs", "IN", f"{about_them}; or a URL (s3://bucket/name)", nargs="+")
    if output:
        add("-o --output", "OUT", output)
    add_flags(parser, "inputs")
    add_flags(many, "many inputs")
    if output:
        add_flags(many, "many outputs")
    else:
        parser.set_defaults(output=None, report=None, resume=False)


def refuse_two_on_one_pipe(args: argparse.Namespace, output: str) -> None:
    """Raise `OptionError` if a file and JSON would both go to standard output, or bytes to a terminal."""
    # Both would write to the same pipe, and no program could tell them apart.
    if output == "-" and args.json:
        raise OptionError("--json and -o - would both write to standard output")
    refuse_terminal(output)


def asked(kind: type[_Asked], args: argparse.Namespace, **more: Any) -> _Asked:
    """Return the flags of a command line as a dataclass with fields of the same names."""
    names = [field.name for field in fields(kind)]  # type: ignore[arg-type]
    values = {name: getattr(args, name) for name in names if hasattr(args, name)}
    return kind(**{**values, **more})
