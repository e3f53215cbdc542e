"""No option replaces an input or another output, under whatever name: all options of all commands that name files."""

import argparse
import os

import pytest

from bsm.cli import _WRITTEN, COMMANDS, FILES, command_parser, named_files
from bsm.files import output
from tests.bsm.program import bsm

NO_FILES = {
    *(
        "N",
        "K",
        "H",
        "S",
        "X,Y,Z",
        "X,Y,Z,X,Y,Z",
        "A:B",
        "NAME",
        "NAME=TEXT",
        "NAME=HOW",
        "NAME=VALUE",
        "FIELD=VALUE",
    ),
    "NAME=QUALITY",
    "quick|normal|best",
    *(
        "ADDRESS",
        "LIST",
        "RULE",
        "FRACTION",
        "SIZE",
        "DEGREES",
        "DB",
        "PERCENT",
        "FORMAT",
        "TEXT",
        "FPS",
        "UNIT",
    ),
}
OUTPUTS = ("{}", "./{}", "link", "hard", "file://{}")
SUFFIX = {
    "OUT.glb": ".glb",
    "FILE.png": ".png",
    "PAGE.html": ".html",
    "FILE.json": ".json",
    "FILE.npy": ".npy",
}


def files_of(command):
    """The actions that name files to be read, and to be written."""
    parser = command_parser(command)
    written = _WRITTEN | ({"permutation"} if command == "encode" else set())
    actions = [action for action in parser.file_arguments() if action.metavar != "FOLDER"]
    return [a for a in actions if a.dest not in written], [a for a in actions if a.dest in written]


def words(action, value):
    return [action.option_strings[-1], value] if action.option_strings else [value]


@pytest.mark.parametrize("command", COMMANDS)
def test_every_option_with_a_word_of_its_own_is_a_file_or_known_to_be_none(command):
    for action in command_parser(command)._actions:
        if action.nargs == 0 or action.choices or action.type not in (None, str):
            continue
        if (
            isinstance(action, argparse._StoreAction | argparse._AppendAction)
            and action.metavar not in FILES
        ):
            assert action.metavar in NO_FILES, (
                f"{command} {action.option_strings}: is {action.metavar} a file?"
            )


@pytest.mark.parametrize("form", OUTPUTS)
def test_an_output_never_replaces_an_input(tmp_path, monkeypatch, form):
    monkeypatch.chdir(tmp_path)
    tried = 0
    for command in COMMANDS:
        reads, writes = files_of(command)
        for writing in writes:
            for reading in reads:
                precious = tmp_path / f"precious{SUFFIX.get(writing.metavar, '.ply')}"
                for path in tmp_path.iterdir():
                    path.unlink()
                precious.write_bytes(b"precious")
                os.symlink(precious, tmp_path / "link")
                os.link(precious, tmp_path / "hard")
                named = form.format(precious if "file:" in form else precious.name)
                others = [
                    word
                    for path in reads
                    if path is not reading and path.required
                    for word in words(path, "other.ply")
                ]
                line = [
                    command,
                    "-f",
                    *words(reading, str(precious)),
                    *others,
                    *words(writing, named),
                ]
                done = bsm(*line, text=True)
                assert done.returncode == 2 and "would replace the input" in done.stderr, (
                    line,
                    done.stderr,
                )
                assert precious.read_bytes() == b"precious"
                tried += 1
    assert tried >= 15


def test_two_outputs_never_have_one_name(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    tried = 0
    for command in COMMANDS:
        reads, writes = files_of(command)
        for number, first in enumerate(writes):
            for second in writes[:number]:
                for names in (("same", "./same"), ("-", "/dev/stdout"), ("sub/../same", "same")):
                    (tmp_path / "sub").mkdir(exist_ok=True)
                    line = [
                        command,
                        "-f",
                        *(
                            word
                            for path in reads
                            if path.required
                            for word in words(path, "in.ply")
                        ),
                    ]
                    line += [*words(first, names[0]), *words(second, names[1])]
                    done = bsm(*line, text=True)
                    assert (
                        done.returncode == 2 and "two outputs would have the name" in done.stderr
                    ), (line, done.stderr)
                    tried += 1
    assert tried >= 9


def test_where_case_makes_no_difference_two_names_are_one(tmp_path, monkeypatch):
    monkeypatch.setattr(output, "_ignores_case", lambda folder: folder.endswith("any"))
    with pytest.raises(output.OptionError, match="two outputs"):
        output.refuse_collisions([], [str(tmp_path / "any/a.bsm"), str(tmp_path / "any/A.BSM")])
    output.refuse_collisions([], [str(tmp_path / "own/a.bsm"), str(tmp_path / "own/A.BSM")])
    output.refuse_collisions([], ["/dev/null", "/dev/null"])


def test_what_follows_from_an_input_is_no_report_either(tmp_path):
    (tmp_path / "a.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
    for option in ("--report", "--permutation"):
        done = bsm("encode", tmp_path / "a.off", "-f", option, tmp_path / "a.bsm", text=True)
        assert done.returncode == 2 and "two outputs would have the name" in done.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["a.off"]


def test_files_are_read_or_written():
    parser = command_parser("encode")
    args = parser.parse_command(
        ["a.ply", "b.ply", "-o", "out/", "--report", "r.json", "--mesh", "m.obj"]
    )
    reads, writes = named_files("encode", parser, args)
    assert reads == ["a.ply", "b.ply", "m.obj"] and writes == ["r.json"]
