"""What to type instead of a word that is not a command, or that stands in a wrong place."""

import os
import re
import shlex
from collections.abc import Sequence
from pathlib import Path

from bsm.bitstream.errors import OptionError
from bsm.files.table import MESH_FORMATS, MESH_SUFFIXES
from bsm.ground.synonyms import COMMANDS

NUMBER = re.compile(r"[-+]?[\d.]+(?:e[-+]?\d+)?%?")
# A word like mm among the inputs comes from a space inside of a value.
_UNIT = re.compile(r"mm|cm|m|in|inch|%|[kMG]i?B|KB|bytes|dB|deg(?:rees)?|bpv", re.IGNORECASE)


def advice_on_command(words: Sequence[str]) -> str:
    """Return what to type instead of a command that does not exist; empty if that is not known."""
    word = words[0]
    advice = COMMANDS.get(word.lower(), "")
    if advice:
        is_sentence = advice[0].isupper()
        if is_sentence:
            return f". {advice}"
        return f"; it is: bsm {advice}"
    file_name = next(
        (name for name in words if Path(name).suffix.lower() in (*MESH_SUFFIXES, ".bsm")), None
    )
    if file_name is None or not (word.startswith("-") or file_name == word):
        return ""
    command = "encode"
    if Path(file_name).suffix.lower() == ".bsm":
        command = "decode"
    return f"; a command comes first: bsm {command} {shlex.quote(file_name)}"


def refuse_misplaced(command: str, inputs: Sequence[str], *, recursive: bool) -> None:
    """Raise an error that says what to type, if a word is an output, a unit or a value instead of an input."""
    # A folder is a sequence to encode, but decode would find no stream in it.
    if (
        command == "decode"
        and not recursive
        and (folder := next(filter(os.path.isdir, inputs), None))
    ):
        command = f"bsm decode -r {shlex.quote(folder)} -o OUT/"
        raise OptionError(
            f"{folder} is a folder. To decode each stream in it, run: {command}; tiles: bsm untile"
        )
    missing = [
        name for name in inputs if "://" not in name and name != "-" and not os.path.exists(name)
    ]
    for name in missing:
        if _UNIT.fullmatch(name) and not os.path.dirname(name):
            example = "0.1"
            if name.lower().endswith(("b", "bytes")) and name != "dB":
                example = "20"
            raise OptionError(
                f"{name}: no such file; if it is a unit, write it without a space: {example}{name}"
            )
    if len(inputs) != 2 or inputs[0] in missing:
        return
    outputs = {"encode": (".bsm",), "decode": tuple(f".{kind}" for kind in MESH_FORMATS)}
    if inputs[1] in missing or Path(inputs[1]).suffix.lower() in outputs.get(command, ()):
        first, output = map(shlex.quote, inputs)
        raise OptionError(
            f"{inputs[1]}: the output is named with -o. Run: bsm {command} {first} -o {output}"
        )
