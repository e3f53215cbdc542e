"""Make manual pages, files by which shells complete commands, and tables of presets: `python -m tools.manuals`."""

import re
from pathlib import Path
from typing import Any

import shtab
from argparse_manpage.manpage import Manpage

from bsm.cli import COMMANDS, Parser, command_parser, program_parser
from tools.preset_tables import write_tables

SHARE = Path(__file__).parents[1] / "share"
_TABLE = re.compile(r"(?:^[^.\n].*\S {2,}\S.*\n)+", re.MULTILINE)
"""Lines with columns, which are not to be filled."""
_OF_COMMANDS = re.compile(r"^\.SH COMMAND .*?(?=^\.SH OPTIONS$)", re.MULTILINE | re.DOTALL)
"""What the page of the program repeats of those of the commands."""


def main() -> None:
    """Write all files."""
    pages = {
        "bsm": _OF_COMMANDS.sub(
            "", _manual(program_parser(complete=False), "compress triangle meshes")
        )
    }
    pages |= {
        f"bsm-{name}": _manual(command_parser(name), summary) for name, summary in COMMANDS.items()
    }
    for name, page in pages.items():
        (SHARE / f"man/man1/{name}.1").write_text(page, encoding="utf-8")
    program: Any = program_parser()
    (commands,) = program._subparsers._group_actions
    for command in commands.choices.values():
        for action in command.file_arguments():
            action.complete = shtab.FILE
    for shell, path in (
        ("bash", "bash-completion/completions/bsm"),
        ("zsh", "zsh/site-functions/_bsm"),
    ):
        (SHARE / path).write_text(shtab.complete(program, shell), encoding="utf-8")
    write_tables()


def _manual(parser: Parser, summary: str) -> str:
    parser.format_help()  # which makes the usage
    page = Manpage(parser)
    page.synopsis = [parser.prog, *page.synopsis[len(parser.prog.split()) :]]
    page.prog, page.description = parser.prog.replace(" ", "-"), summary
    page.date, page.source, page.manual = "", "BSM", "Commands of BSM"
    return _TABLE.sub(r".nf\n\g<0>.fi\n", str(page))


if __name__ == "__main__":
    main()
