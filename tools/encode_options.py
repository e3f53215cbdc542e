"""The options of `bsm encode` that are fields of `EncodeOptions`: one table, flags derived from the fields' names."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class EncodeFlag:
    """One field of `EncodeOptions` on the command line.

    Parameters
    ----------
    field : str
        Name of the field; the flag is the same with dashes.
    type : callable
        Reads the value; `bool` makes a pair of flags, --x and --no-x.
    metavar : str
        What the value is called in the help.
    help : str
        What it does.
    """

    field: str
    type: Callable[[str], Any]
    metavar: str
    help: str

    def add(self, group: argparse._ArgumentGroup) -> None:
        """Add the flag; where it is not given the namespace has no such name, so `EncodeOptions` has the defaults."""
        name = f"--{self.field.replace('_', '-')}"
        if self.type is bool:
            group.add_argument(name, action=argparse.BooleanOptionalAction, default=argparse.SUPPRESS, help=self.help)
        else:
            group.add_argument(
                name, type=self.type, metavar=self.metavar, default=argparse.SUPPRESS, help=self.help, dest=self.field
            )


ENCODE_FLAGS = (
    EncodeFlag("keep", float, "FRACTION", "coefficients kept, as a fraction of a block's vertices (default 0.1)"),
    EncodeFlag("coefficients", int, "C", "coefficients kept per block and coordinate, instead of --keep"),
    EncodeFlag("step", float, "S", "quantisation step, relative to the bounding box's diagonal (default 0.004)"),
    EncodeFlag("bits", int, "Q", "as in the paper: every coefficient in Q bits, without prediction"),
    EncodeFlag("smoothing", float, "A", "smoothing in the decoder (default: chosen by trying)"),
    EncodeFlag("block_size", int, "N", "vertices of a block before overlap, about (default 500)"),
    EncodeFlag("overlap", float, "F", "size of the blocks with overlap, as a multiple of the largest (default 1.15)"),
    EncodeFlag("partition", str, "derived|metis", "who cuts the mesh into blocks (default derived: both sides)"),
    EncodeFlag("basis", str, "oi|svd", "orthogonal iterations, or the exact eigenbasis (default oi)"),
    EncodeFlag("seed", str, "previous|independent", "whether blocks build on the one before (default previous)"),
    EncodeFlag("key_interval", int, "K", "every K blocks one depends on none before it, 0: the first (default 16)"),
    EncodeFlag("power", int, "Z", "exponent of the iterated matrix (default 3)"),
    EncodeFlag("iterations", int, "T", "orthogonal iterations per block (default 1)"),
    EncodeFlag("key_iterations", int, "T", "orthogonal iterations of a block that depends on none (default 4)"),
    EncodeFlag("shift", float, "D", "what is added to the Laplacian's diagonal (default 0.125)"),
    EncodeFlag("blend", str, "degree|uniform|own", "weights of a vertex's copies in several blocks (default degree)"),
    EncodeFlag("predict", bool, "", "predict coefficients from blocks already coded (default: yes)"),
    EncodeFlag("keep_order", bool, "", "store the order of vertices and faces (default: no)"),
    EncodeFlag("threads", int, "N", "threads to use (default: one per core)"),
)


def add_encode_flags(parser: argparse.ArgumentParser) -> None:
    """Add all of `ENCODE_FLAGS`."""
    group = parser.add_argument_group("coding")
    for flag in ENCODE_FLAGS:
        flag.add(group)


def given_options(args: argparse.Namespace) -> dict[str, Any]:
    """The fields that were given on the command line."""
    return {flag.field: getattr(args, flag.field) for flag in ENCODE_FLAGS if hasattr(args, flag.field)}
