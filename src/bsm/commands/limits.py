"""The option `--limits` of all commands that decode."""

from __future__ import annotations

import argparse

from bsm.bitstream.limits import NAMED_LIMITS, Limits


def add_limits_flag(parser: argparse.ArgumentParser) -> None:
    """Add it; `limits_of` says what was asked for."""
    parser.add_argument(
        "--limits",
        choices=tuple(NAMED_LIMITS),
        default="default",
        help="what a stream may cost: service: at most 1 GiB and 10 s, for strangers' files of up to a million "
        "vertices; wide: what one has made oneself (default: by its vertices and bytes)",
    )


def limits_of(name: str) -> Limits:
    """The limits that the option names."""
    return NAMED_LIMITS[name]()
