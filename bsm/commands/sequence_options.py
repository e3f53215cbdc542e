"""The options of `bsm encode` for sequences."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from bitstream.errors import OptionError
from bsm.commands.encode_options import TARGET_FLAGS, given_options

if TYPE_CHECKING:
    from codec import SequenceOptions

SHARED_FIELDS = ("step", "keep", "block_size", "keep_order", "threads")
"""Fields of `EncodeOptions` that mean the same for sequences."""
SHARED_TARGETS = ("theta_deg", "nmsve_db")
PRESET_STEPS = {"small": 0.006, "balanced": 0.002, "fine": 0.0007}
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
    group.add_argument("--frame-rate", type=float, metavar="FPS", help="frames per second, for information")


def refuse_sequence_flags(args: argparse.Namespace) -> None:
    """Raise `OptionError` if a flag of `add_sequence_flags` was given for a mesh."""
    given = [name for name in _OWN if getattr(args, name) is not None]
    if given:
        raise OptionError(f"--{given[0].replace('_', '-')} is for sequences, and this is one mesh")


def sequence_options(args: argparse.Namespace) -> SequenceOptions:
    """The options that the command line asks for.

    Raises
    ------
    OptionError
        If a flag does not go with sequences, or there are two targets.
    """
    from codec import SequenceOptions
    from codec.sequence.targets import SequenceTarget

    given: dict[str, Any] = {"step": PRESET_STEPS[args.preset], **given_options(args)}
    foreign = [name for name in given if name not in SHARED_FIELDS]
    foreign += [name for _, name, _, _ in TARGET_FLAGS if name not in SHARED_TARGETS and _target(args, name)]
    if foreign:
        raise OptionError(f"{foreign[0].replace('_', ' ')} cannot be chosen for a sequence")
    wanted = {kind: _target(args, kind) for kind in SHARED_TARGETS} | {"kg": args.kg, "bpvf": args.bpvf}
    targets = [SequenceTarget(kind, value) for kind, value in wanted.items() if value is not None]
    if len(targets) > 1:
        raise OptionError("one target at a time")
    given["target"] = targets[0] if targets else None
    given["mode"] = "low-delay" if args.low_delay else "gop"
    given |= {name: getattr(args, name) for name in ("gop", "frame_rate") if getattr(args, name) is not None}
    return SequenceOptions(**given)


def _target(args: argparse.Namespace, kind: str) -> float | None:
    value: float | None = getattr(args, f"target_{kind}")
    return value
