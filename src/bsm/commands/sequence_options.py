"""The options of `bsm encode` for sequences."""

from __future__ import annotations

import argparse
from typing import Any

_OWN = ("kg", "bpvf", "gop", "low_delay", "frame_rate")


def add_sequence_flags(parser: argparse.ArgumentParser) -> None:
    """Add what only sequences have."""
    group = parser.add_argument_group(
        "sequences",
        "a folder or pattern of meshes, several meshes with -o NAME.bsm, npz, PC2, MDD, USD, GLB with\n"
        "--animation, or npy arrays on a pipe (the faces, then the positions of each frame)",
    )
    group.add_argument("--kg", type=float, metavar="PERCENT", help="Karni and Gotsman's error at most PERCENT")
    group.add_argument("--bpvf", type=float, metavar="X", help="at most X bits per vertex and frame, the whole file")
    group.add_argument(
        "--gop", type=int, metavar="N", help="frames that are coded together, at most (default 256 to 512)"
    )
    group.add_argument(
        "--low-delay",
        type=int,
        metavar="N",
        help="send N frames at a time as they come (8: a quarter smaller than 1); --gop: from key frame to key frame",
    )
    group.add_argument(
        "--frame-rate",
        type=float,
        metavar="FPS",
        help="frames per second, for the metadata; where an animation is sampled (glTF, USD) the rate of that",
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
        "--frames", dest="piped_frames", action="store_true", help="a pipe holds frames, as --format npy"
    )


def sequence_wishes(args: argparse.Namespace) -> dict[str, Any]:
    """What was asked for that only sequences have, as keywords of `bsm.options.sequence_options`."""
    return {name: getattr(args, name) for name in _OWN if getattr(args, name) is not None}
