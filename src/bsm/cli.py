"""The command line `bsm`: its commands and its errors of usage."""

import argparse
import importlib
import os
import re
import shlex
import sys
from collections.abc import Iterator, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any, NoReturn

from bsm import __version__
from bsm.bitstream.errors import CorruptError, TruncatedError
from bsm.codec.choices import suggestion
from bsm.commands.synonyms import NUMBER, advice_on_command, refuse_misplaced
from bsm.files.output import refuse_collisions
from bsm.ground.console import Console
from bsm.ground.exits import EXITS, USAGE, Terminated, behind, exit_of, is_expected, report_error
from bsm.ground.synonyms import OPTIONS, advice_on_option

_SUMMARIES = Path(__file__).with_name("commands") / "commands.txt"
_EXAMPLES = [
    line.split(": ", 1)
    for line in (_SUMMARIES.parent / "examples.txt").read_text("utf-8").splitlines()
]
COMMANDS = dict(line.split(": ", 1) for line in _SUMMARIES.read_text("utf-8").splitlines())
FILES = (
    *("IN", "MESH", "SCENE", "A", "B", "FOLDER", "OUT", "OUT.glb"),
    *("FILE", "FILE.npy", "FILE.json", "FILE.png", "PAGE.html"),
)
"""What files and folders are called in the help."""
_WRITTEN = {"output", "report", "save", "picture", "map", "work"}
_USED = {
    "encode": "--output --preset --max-error --look --size --attribute --images --simplify --meta --recursive --jobs"
}
"""The options of a command that the help begins with."""
_LIKENESS = 0.75
"""How alike an option must be to be suggested; below, words of other meanings are."""
_WITHOUT_FILES = ("info", "compare", "verify", "curve")
"""Commands that write no file. They accept -f nevertheless, so that scripts can always pass it."""
_WITH_FORCE = {
    "denoise": "; also write results that lose detail",
    "encode": "; with --preset lossless, leave out contents that no stream holds",
}


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command and return an exit code of `bsm.ground.exits`."""
    words, as_json = list(sys.argv[1:] if arguments is None else arguments), False
    options: frozenset[str] | None = None
    try:
        if words[:1] == ["help"]:
            words = [*words[1:2], "--help"]
        if not words or words[0] not in COMMANDS:
            return _no_command(words)
        # The parser of one command: those of all would import all commands, and take longer than encoding a small mesh.
        parser = command_parser(words[0])
        args = parser.parse_command(words[1:])
        as_json = getattr(args, "json", False)
        named = named_files(words[0], parser, args)
        if isinstance(given := getattr(args, "inputs", None), list) and hasattr(args, "output"):
            refuse_misplaced(words[0], given, recursive=getattr(args, "recursive", False))
        refuse_collisions(*named)
        options = frozenset(parser._option_string_actions)
        code: int | None = args.run(args, Console(quiet=args.quiet, json=as_json, options=options))
        # Flushed here, where a closed pipe is an error with an exit code; at the end of Python it would print a
        # traceback.
        if sys.stdout is not None:  # closed by the shell
            sys.stdout.flush()
        return code or 0
    # Libraries wrap errors of ours and interrupts in their own: the one behind tells which exit code is meant.
    except (Exception, KeyboardInterrupt, Terminated) as raised:
        error = behind(raised)
        if not is_expected(error):
            raise
        report_error(
            error, as_json=as_json, options=options, advice=_advice_on_damage(words, error)
        )
        return exit_of(error).code


def _advice_on_damage(words: Sequence[str], error: BaseException) -> str:
    """Return the advice to decode the rest of a damaged stream, or say that no part is left."""
    if words[0] != "decode" or type(error) not in (CorruptError, TruncatedError):
        return ""
    if "--tolerant" in words:
        return "no other part can be decoded without it"
    return "--tolerant decodes what does not need the damaged part"


def named_files(
    command: str, parser: "Parser", args: argparse.Namespace
) -> tuple[list[str], list[str]]:
    """Return the files that a command line reads, and those that it writes."""
    named: tuple[list[str], list[str]] = [], []
    written = _WRITTEN | ({"permutation"} if command == "encode" else set())
    for action in parser.file_arguments():
        given = getattr(args, action.dest)
        names = [given] if isinstance(given, str) else given or []
        if "" in names:
            parser.error(
                f"the name given for {'/'.join(action.option_strings) or action.metavar} is empty; name a file"
            )
        named[action.dest in written].extend(names)
    # Of folders that are searched, the files that are found count.
    reads = [
        name
        for name in named[0]
        if not getattr(args, "recursive", False) or not os.path.isdir(name)
    ]
    return reads, [name for name in named[1] if not name.endswith("/") and not os.path.isdir(name)]


def command_parser(name: str) -> "Parser":
    return _complete(
        Parser(prog=f"bsm {name}", parents=[_common(name)], description=_sentence(name)), name
    )


def program_parser(*, complete: bool = True) -> "Parser":
    """The parser of the program; with `complete` it also knows what each command takes."""
    codes = "\n".join(
        f"  {row.code:>3}  {row.meaning}" for row in sorted(EXITS, key=lambda row: row.code)
    )
    parser = Parser(
        prog="bsm",
        description="Compress, decode and compare triangle meshes and moving meshes.",
        epilog=f"exit codes (for several inputs, that of the first failure):\n{codes}",
    )
    parser.add_argument("--version", action="store_true", help="show the version and exit")
    commands = parser.add_subparsers(metavar="COMMAND")
    for name, summary in COMMANDS.items():
        command = commands.add_parser(
            name, parents=[_common(name)], help=summary, description=_sentence(name)
        )
        if complete:
            _complete(command, name)
    return parser


def _no_command(words: list[str]) -> int:
    """Print help, the version, or an error that suggests a command."""
    parser = program_parser(complete=False)
    advice = advice_on_command(words) if words else ""
    if words and (advice or not words[0].startswith("-")):
        parser.error(f"unknown command {words[0]}{advice or suggestion(words[0], COMMANDS)}")
    if parser.parse_args(words).version:
        print(f"bsm {__version__}")
        return 0
    parser.print_help(sys.stderr)
    return USAGE.code


def _common(name: str) -> "Parser":
    common = Parser(add_help=False)
    harm = _WITH_FORCE.get(name, "")
    does = argparse.SUPPRESS if name in _WITHOUT_FILES else f"overwrite files{harm}"
    common.add_argument("-f", "--force", action="store_true", help=does)
    common.add_argument(
        "-q",
        "--quiet",
        action="store_true",
        help="print no notes, only errors and the results on standard output",
    )
    return common


def _sentence(name: str) -> str:
    """The purpose of a command, and examples."""
    examples = "".join(f"\n  {example}" for command, example in _EXAMPLES if command == name)
    return f"{COMMANDS[name][0].upper()}{COMMANDS[name][1:]}.{examples and f'{chr(10)}{chr(10)}examples:{examples}'}"


def _complete(parser: "Parser", name: str) -> "Parser":
    """Add the arguments of a command; import only its own module, since imports take most of the start."""
    module = importlib.import_module(f"bsm.commands.{name}")
    module.add_arguments(parser)
    parser.set_defaults(run=module.run)
    if name in _USED:
        parser.begin_with(_USED[name].split())
    return parser


class Formatter(argparse.RawDescriptionHelpFormatter):
    def __init__(self, prog: str) -> None:
        super().__init__(prog, max_help_position=27)

    def _format_action_invocation(self, action: argparse.Action) -> str:
        """The value is named once: `-o, --output OUT`."""
        if not action.option_strings or action.nargs == 0:
            return super()._format_action_invocation(action)
        value = self._format_args(action, action.dest.upper())
        return f"{', '.join(action.option_strings)} {value}"


class Parser(argparse.ArgumentParser):
    """An argument parser with short errors that accepts options between inputs."""

    def __init__(self, **keywords: Any) -> None:
        super().__init__(**{"formatter_class": Formatter, **keywords})
        # Points and boxes begin with numbers, too.
        self._negative_number_matcher = re.compile(r"-[\d.][\d.,e+-]*$")

    @property
    def settings(self) -> dict[str, str]:
        """The settings of --set, and how each is given."""
        from bsm.commands.flags import FLAGS  # which commands have loaded already

        return {setting.field: f"{setting.field}={setting.value}" for setting in FLAGS["settings"]}

    def begin_with(self, options: Sequence[str]) -> None:
        """Let the help begin with these options, and the rest follow in its groups."""
        positionals, usual, *groups = self._action_groups
        used = self.add_argument_group("options that are used most")
        moved = [self._option_string_actions[option] for option in options]
        for group in (usual, *groups):
            group._group_actions[:] = [
                action for action in group._group_actions if action not in moved
            ]
        used._group_actions[:], usual.title = moved, "all commands, inputs and outputs"
        with_presets = [
            group for group in groups if group.description and "preset" in group.description
        ]
        rest = [group for group in groups if group not in with_presets]
        self._action_groups[:] = [positionals, used, *with_presets, usual, *rest]

    def format_help(self) -> str:
        self.usage = f"{self.prog}{self._inputs()}"
        return super().format_help()

    def _inputs(self) -> str:
        inputs = [
            action
            for action in self._actions
            if not action.option_strings and action.nargs != argparse.PARSER
        ]
        names = "".join(
            f" {action.metavar}{'...' if action.nargs in ('+', '*') else ''}" for action in inputs
        )
        commands = any(action.nargs == argparse.PARSER for action in self._actions)
        return " COMMAND ..." if commands else f"{names} [options]"

    def parse_command(self, words: Sequence[str]) -> argparse.Namespace:
        words_before_dashes = words[: words.index("--") if "--" in words else None]
        for option, value in pairwise(words_before_dashes):
            action = self._option_string_actions.get(option)
            if (
                action is not None
                and action.nargs == 0
                and NUMBER.fullmatch(value)
                and not os.path.exists(value)
            ):
                self.error(f"{option} takes no value, and {value} is not a file")
        for word in words_before_dashes:
            known = {word[:2], word.partition("=")[0]} & self._option_string_actions.keys()
            # A glob such as *.ply may give a file that begins with a dash.
            if word.startswith("-") and not known and os.path.exists(word):
                self.error(
                    f"{word} looks like an option; name the file as {shlex.quote(f'./{word}')}"
                )
            name = word.partition("=")[0]
            if word in OPTIONS and word not in self._option_string_actions:
                self._refuse_option(word)
            # Said here, since argparse would first ask for arguments that are required.
            if name.startswith("--") and not any(
                option.startswith(name) for option in self._option_string_actions
            ):
                self._refuse_option(name)
        # argparse forgets a "--" between the two passes that mixed words take it.
        parse = self.parse_known_args if "--" in words else self.parse_known_intermixed_args
        args, unknown = parse(words)
        if unknown:
            word = next((word for word in unknown if word.startswith("-")), unknown[0])
            name = word.partition("=")[0]
            if not name.startswith("-"):
                self.error(f"{word}: one input too many")
            self._refuse_option(name)
        return args

    def _refuse_option(self, name: str) -> NoReturn:
        """End with an error that names an option of this command, if there is one for the word."""
        advice = advice_on_option(name, self._offered)
        self.error(
            f"unknown option {name}{f'; instead: {advice}' if advice else self._advice(name)}"
        )

    @property
    def _offered(self) -> list[str]:
        """The options that the help of this command names."""
        return [
            name
            for name, action in self._option_string_actions.items()
            if action.help != argparse.SUPPRESS
        ]

    def _advice(self, name: str) -> str:
        """Suggest an option of this command that is spelled alike, or the one for a word that is."""
        options = self._offered
        setting = name.lstrip("-").replace("-", "_")
        if "--set" in options and setting in self.settings:
            return f"; instead: --set {self.settings[setting]}"
        words = [word for word in OPTIONS if advice_on_option(word, options).startswith("-")]
        similar = suggestion(name, [*options, *words], likeness=_LIKENESS)
        if not similar:
            return ""
        word = similar.removeprefix("; did you mean ").removesuffix("?")
        return similar if word in options else f"; did you mean {advice_on_option(word, options)}?"

    # argparse writes choices with the quotes and words of Python, which differ between its versions.
    def _check_value(self, action: argparse.Action, value: Any) -> None:
        if action.choices is not None and value not in action.choices:
            known = [str(choice) for choice in action.choices]
            wrong = f"unknown value {value}{suggestion(str(value), known)} ({', '.join(known)})"
            raise argparse.ArgumentError(action, wrong)

    def error(self, message: str) -> NoReturn:
        """Print the error and one line of usage; exit with code 2."""
        if message.endswith("required: -o/--output"):
            message += ". The output is named with -o"
        self.exit(
            2,
            f"{self.prog}: {message}\nusage: {self.prog}{self._inputs()}; see {self.prog} --help\n",
        )

    def file_arguments(self) -> Iterator[argparse.Action]:
        for action in self._actions:
            if action.metavar in FILES:
                yield action
