"""The options of `bsm encode` for sequences."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from bsm import options
from bsm.bitstream.errors import OptionError
from bsm.commands.encode_options import given_options, given_targets

if TYPE_CHECKING:
    from bsm.codec.sequence.options import SequenceOptions

_OWN = ("kg", "bpvf", "gop", "low_delay", "frame_rate")


def add_sequence_flags(parser: argparse.ArgumentParser) -> None:
    """Add what only sequences have."""
    group = parser.add_argument_group(
        "sequences",
        "an npz of frames, a folder or pattern of mesh files, or npy arrays on a pipe (--format npy: the faces, "
        "then the positions of each frame); a target is met by one step for all frames, which are kept in memory then",
    )
    group.add_argument("--kg", type=float, metavar="PERCENT", help="Karni and Gotsman's error at most PERCENT")
    group.add_argument("--bpvf", type=float, metavar="X", help="at most X bits per vertex and frame, the whole file")
    group.add_argument("--gop", type=int, metavar="N", help="frames that are coded together, at most (default 256)")
    group.add_argument(
        "--low-delay", action="store_true", default=None, help="send each frame as it comes; --gop: every N a key frame"
    )
    group.add_argument("--frame-rate", type=float, metavar="FPS", help="frames per second, for the metadata")


def refuse_sequence_flags(args: argparse.Namespace) -> None:
    """Raise `OptionError` if a flag of `add_sequence_flags` was given for a mesh."""
    given = [name for name in _OWN if getattr(args, name) is not None]
    if given:
        raise OptionError(f"--{given[0].replace('_', '-')} is for sequences, and this is one mesh")


def sequence_options(args: argparse.Namespace) -> SequenceOptions:
    """The options that the command line asks for.

    Raises
    ------
    ArgumentError, OptionError
        If a flag does not go with sequences, or there are two targets.
    """
    own = {name: getattr(args, name) for name in _OWN if getattr(args, name) is not None}
    return options.sequence_options(preset=args.preset, **given_options(args), **given_targets(args), **own)
