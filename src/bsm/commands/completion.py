"""bsm completion: a script that makes a shell complete commands and options.

The script is written once and knows everything, so that completing starts no Python.
"""

import argparse

from bsm.bitstream.errors import imported
from bsm.console import Console

SHELLS = ("bash", "zsh", "fish")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "shell", metavar="SHELL", choices=SHELLS, help=f'{", ".join(SHELLS)}; for bash: eval "$(bsm completion bash)"'
    )


def run(args: argparse.Namespace, console: Console) -> None:
    shtab = imported("shtab", "completion scripts are made with shtab", "completion")
    from bsm.cli import program_parser

    parser = program_parser(complete=True)
    for action in parser.file_arguments():
        action.complete = shtab.FILE  # type: ignore[attr-defined]  # what shtab asks for
    print(shtab.complete(parser, args.shell))
