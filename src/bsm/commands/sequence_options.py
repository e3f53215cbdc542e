"""The options of `bsm encode` for sequences."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from bsm import options
from bsm.bitstream.errors import OptionError
from bsm.commands.encode_options import given_options, given_targets
from bsm.files.motion.frames import Wanted

if TYPE_CHECKING:
    from bsm.codec.sequence.options import SequenceOptions

_OWN = ("kg", "bpvf", "gop", "low_delay", "frame_rate")


def add_sequence_flags(parser: argparse.ArgumentParser) -> None:
    """Add what only sequences have."""
    group = parser.add_argument_group(
        "sequences",
        "a folder or pattern of mesh files, many of them with -o NAME.bsm, npz, PC2, MDD, GLB with --animation, USD, "
        "or npy arrays on a pipe (--frames: the faces, then the positions of each frame); a target is met by one step "
        "for all frames, which are kept in memory then",
    )
    group.add_argument("--kg", type=float, metavar="PERCENT", help="Karni and Gotsman's error at most PERCENT")
    group.add_argument("--bpvf", type=float, metavar="X", help="at most X bits per vertex and frame, the whole file")
    group.add_argument("--gop", type=int, metavar="N", help="frames that are coded together, at most (default 256)")
    group.add_argument(
        "--low-delay", action="store_true", default=None, help="send each frame as it comes; --gop: every N a key frame"
    )
    group.add_argument(
        "--frame-rate",
        type=float,
        metavar="FPS",
        help="frames per second, for information; where an animation is sampled (glTF, USD) the rate of that",
    )
    group.add_argument(
        "--animation",
        metavar="NAME",
        help="of a GLB or glTF this animation, by name or number (0), and not the mesh alone",
    )
    group.add_argument(
        "--mesh",
        dest="cache_mesh",
        metavar="FILE",
        help="the mesh of a PC2 or MDD (default: of the same name beside it)",
    )
    group.add_argument(
        "--frames", dest="piped_frames", action="store_true", help="a pipe holds frames: npy arrays, as --format npy"
    )


def refuse_sequence_flags(args: argparse.Namespace) -> None:
    """Raise `OptionError` if a flag of `add_sequence_flags` was given for a mesh."""
    given = [name for name in _OWN if getattr(args, name) is not None]
    given += ["animation"] if args.animation is not None else []
    given += ["mesh"] if args.cache_mesh is not None else []
    given += ["frames"] if args.piped_frames else []
    if given:
        raise OptionError(f"--{given[0].replace('_', '-')} is for sequences, and this is one mesh")


def wanted_of(args: argparse.Namespace) -> Wanted | None:
    """What is asked of the reader; None: nothing that only a sequence has."""
    if args.animation is None and args.cache_mesh is None and all(getattr(args, name) is None for name in _OWN):
        return None
    return Wanted(args.frame_rate or 0.0, args.animation or "", args.cache_mesh)


def sequence_options(args: argparse.Namespace, frame_rate: float = 0.0) -> SequenceOptions:
    """The options that the command line asks for; `frame_rate` is the input's own.

    Raises
    ------
    ArgumentError, OptionError
        If a flag does not go with sequences, or there are two targets.
    """
    own = {name: getattr(args, name) for name in _OWN if getattr(args, name) is not None}
    own.setdefault("frame_rate", frame_rate)
    return options.sequence_options(preset=args.preset, **given_options(args), **given_targets(args), **own)
