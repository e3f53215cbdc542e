"""Decode streams that cost as much as they can, each in a process of its own, and hold what that took against the law.

    python -m tools.attack bombs [NAME...]     memory and time of every bomb, or of streams in files (.bsm)
    python -m tools.attack walk                the same of every frame type and field as large as its bytes allow
    python -m tools.attack charges [THING...]  time by what was charged: many small and few large of everything

A decoder may take 64 MiB and 1 s, 1 KiB and 40 microseconds for each vertex, 64 bytes and 20 microseconds for each
byte; with `--limits service` 1 GiB and 10 s; a browser what web/README.md says. A second charged may take 1.25,
four times as long in browsers; where the machine takes longer for dictionaries, which are what charges are set by, it
may take as much longer for all else. The exit code is 1 if anything takes more.
"""

import argparse
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import get_type_hints

from bsm.bitstream.container.gop import GopBody, GopField, GopMethod
from bsm.bitstream.container.wire import FrameType
from bsm.bitstream.limits import NAMED_LIMITS
from tools.attack.streams import BOMBS
from tools.attack.taken import (
    BROWSER,
    bounds,
    browser_bounds,
    decode_all,
    problems_of,
    report,
    taken_by,
    taken_by_browser,
    warm_up,
)
from tools.attack.walk import cases
from tools.command import parser_of

HOWS = ("events", "threads", "whole", "tolerant", "browser")
TIMES = 3
"""A stream is measured that has to take too much each time: others use the machine as well."""
RATIO = 1.25
"""Seconds that a second charged may take."""
YARDSTICK = "mesh-blocks"
"""Nearly all dictionaries."""
LIMITED = {
    "vertices",
    "faces",
    "blocks",
    "block_size",
    "coefficients",
    "frames",
    "gop_frames",
    "attributes",
}
"""Fields of the header that limits bound."""
LEAST_SECONDS = 0.05
"""Shorter CPU times are too noisy to judge."""

THINGS = {
    "HEADER": ("runs", "sequence-runs-kept"),
    "HEADER again": ("runs-again", "sequence-runs-again"),
    "METADATA": ("metadata-entries", "metadata-long"),
    "CONNECTIVITY": ("runs", "mesh"),
    "CONNECTIVITY on edges": ("edges-many", "edges"),
    "PARTITION": ("runs-parts", "scattered"),
    "ORDER": ("runs-order", "copies"),
    "ATTRIBUTE": ("runs-attributes", "seams"),
    "VALUES": ("values-chunks", "values-corners"),
    "VALUES of many": ("values-chunks-large", "values-faces"),
    "VALUES swift": ("swift-chunks", "swift"),
    "VALUES swift, plain": ("swift-small", "swift-plain"),
    "VALUES swift, numbers": ("swift-chunks", "swift-numbers"),
    "VALUES swift, normals": ("swift-small", "swift-normals"),
    "BLOCK": ("tiny", "wide-1024"),
    "GOP": ("gops", "gop-components"),
    "GRID": ("grid-chunks", "grid"),
    "GRID light": ("light-chunks", "light"),
    "GRID congruent": ("congruent-chunks", "congruent-apart"),
    "REFINEMENT": ("layers-chunks", "layers"),
    "cells": ("cells", "cells-far"),
    "SKIPPABLE": ("metadata", "skippable-long"),
    "LEARNT": ("gops-learned", "gop-300"),
    "LEARNT_NEXT": ("gops-following", "gops-following-large"),
    "KEY_FRAME": ("gops-keys", "sequence-again"),
    "NEXT_FRAME": ("gops-next", "gop-next"),
    "vertices": ("runs", "mesh-blocks"),
    "faces": ("runs", "pieces"),
    "blocks": ("tiny", "mesh-blocks"),
    "block_size": ("tiny", "hubs-small"),
    "coefficients": ("tiny", "wide-1024"),
    "frames": ("gops", "gop-still"),
    "gop_frames": ("gops", "gop-still"),
    "attributes": ("attributes-small", "values"),
    "fields": ("moving-gops", "moving-components"),
    "fields of parts": ("moving-parts", "moving-keys"),
    "shown": ("gops-stretches", "gop-still"),
    "exponents": ("gops-learned", "gop-part"),
    "basis": ("gops-learned", "gop-part"),
    "levels": ("gops-parts", "gop-300"),
    "parts": ("sequence-parts", "sequence"),
}
"""Of each thing of which there can be many: a stream of many small ones, and one of few large ones."""


def things() -> set[str]:
    """Return what there can be many of: frames of each type but END, methods of GOPs, counts, and lists in GOPs."""
    names = {kind.name for kind in FrameType if kind is not FrameType.END}
    lists = {
        name
        for r in (GopBody, GopField)
        for name, kind in get_type_hints(r).items()
        if kind not in _SINGLE
    }
    return (
        names | {"METADATA", "SKIPPABLE"} | {method.name for method in GopMethod} | LIMITED | lists
    )


_SINGLE = (int, float, bool, GopMethod)


def bombs() -> int:
    """`python -m tools.attack bombs`."""
    parser = _parser(f"bombs, or streams (.bsm); all: {', '.join(BOMBS)}", HOWS[0], HOWS[2])
    parser.add_argument("--limits", choices=("default", "service"), default="default")
    args = parser.parse_args()
    names = args.names or list(BOMBS)
    failed = [
        name for name in names if not min([_holds(name, how, args.limits) for how in args.how])
    ]
    print(
        f"{len(names)} bombs, {len(failed)} take more than they may: {' '.join(failed) or 'none'}"
    )
    return 1 if failed else 0


def _holds(name: str, how: str, limits: str) -> bool:
    """Measure one stream, again where it takes more than it may, print what it took, and say whether it may."""
    stream = _stream(name)
    for _ in range(TIMES):
        cost = taken_by(stream, how, limits)
        memory, seconds = browser_bounds(cost, stream) if how == "browser" else bounds(limits, cost)
        if not (problem := cost.problem(memory, seconds)):
            break
    print(
        f"{Path(name).stem:22} {how:8} {cost.size:9} bytes {cost.vertices:9} vertices {cost.memory / 2**20:8.1f} of "
        f"{memory / 2**20:8.1f} MiB {cost.seconds:7.2f} of {seconds:7.2f} s  {'FAILED' if problem else 'holds':7} "
        f"{cost.outcome[:90]}",
        flush=True,
    )
    return problem is None


def _stream(name: str) -> bytes:
    return Path(name).read_bytes() if name.endswith(".bsm") else BOMBS[name]()


def walk() -> int:
    """`python -m tools.attack walk`."""
    parser = _parser("cases whose name begins so", "whole", "tolerant")
    parser.add_argument(
        "--bytes", type=int, default=1 << 20, help="of a case (default: %(default)s)"
    )
    parser.add_argument("--every", type=int, default=1, metavar="N", help="take one case in N")
    args = parser.parse_args()
    every = [case for case in cases(args.bytes) if case.name.startswith(tuple(args.names or [""]))][
        :: args.every
    ]
    return report(
        walk_problems({case.name: case.make() for case in every}, args.how), f"{len(every)} streams"
    )


def walk_problems(streams: Mapping[str, bytes], hows: Sequence[str]) -> Iterator[str]:
    """Where streams take more than they may, by each way and limits."""
    warm_up()
    for how in hows:
        if how == "browser":
            for (name, stream), cost in zip(
                streams.items(), taken_by_browser(list(streams.values())), strict=True
            ):
                if problem := cost.problem(*browser_bounds(cost, stream)):
                    yield f"{name} ({how}): {problem}"
            continue
        for limits in ("default", "service"):
            decodes = [
                partial(partial, decode_all, stream, how, NAMED_LIMITS[limits]())
                for stream in streams.values()
            ]
            yield from problems_of([f"{name} ({how})" for name in streams], decodes, limits)


def charges() -> int:
    """`python -m tools.attack charges`."""
    parser = _parser(
        f"of {', '.join(THINGS)}; all, if none is named", "events", "threads", "browser"
    )
    parser.add_argument(
        "--times", type=int, default=3, help="the least counts (default: %(default)s)"
    )
    parser.add_argument("--small", action="store_true", help="streams of many small ones alone")
    parser.add_argument(
        "--most", type=float, default=RATIO, help="seconds for one charged (default: %(default)s)"
    )
    args = parser.parse_args()
    pairs = [THINGS[name] for name in args.names or THINGS]
    names = list(
        dict.fromkeys(name for pair in pairs for name in (pair[:1] if args.small else pair))
    )
    streams = {name: BOMBS[name]() for name in [YARDSTICK, *names]}
    warm_up()
    failed = []
    for how in args.how:
        slowness = 1.0
        for name, stream in streams.items():
            cost = min(
                (taken_by(stream, how, "wide") for _ in range(args.times)),
                key=lambda cost: cost.seconds,
            )
            ratio = (
                cost.seconds / max(cost.work / 1e9, 1e-9) / (BROWSER if how == "browser" else 1.0)
            )
            slowness = max(slowness, ratio) if name == YARDSTICK else slowness
            unsound = cost.escaped or (args.small and cost.outcome != "decoded")
            wrong = unsound or (ratio > args.most * slowness and cost.seconds > LEAST_SECONDS)
            failed += [f"{name} ({how})"] * wrong
            print(
                f"{name:22} {how:8} {cost.work / 1e9:8.3f} s charged, {cost.seconds:8.3f} s taken, ratio "
                f"{ratio:5.2f} of {args.most * slowness:.2f}{' FAILED' * wrong} {cost.outcome[:60]}",
                flush=True,
            )
    print(
        f"{len(streams)} streams, {len(failed)} take more than is charged: {', '.join(failed) or 'none'}"
    )
    return 1 if failed else 0


def _parser(names: str, *hows: str) -> argparse.ArgumentParser:
    parser = parser_of(__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help=names)
    parser.add_argument("--how", choices=HOWS, nargs="+", default=hows, help="default: %(default)s")
    return parser
