"""Options that several commands take: inputs and outputs, limits, readers."""

from __future__ import annotations

import argparse
from dataclasses import fields
from typing import Any, TypeVar

from bsm.bitstream.limits import NAMED_LIMITS, Limits
from bsm.files.mesh import READERS
from bsm.jobs.task import Run

_Asked = TypeVar("_Asked")


def add_inputs(parser: argparse.ArgumentParser, about_them: str, output: str | None = None) -> None:
    """Declare inputs, how many are worked on at a time, and, where the command writes, its output."""
    parser.add_argument("inputs", metavar="IN", nargs="+", help=f"{about_them}; URLs as well (s3://bucket/name)")
    if output:
        parser.add_argument("-o", "--output", metavar="OUT", help=output)
    parser.add_argument(
        "-j", "--jobs", type=int, default=1, metavar="N", help="inputs to work on at a time, 0: one per core (1)"
    )
    parser.add_argument("--json", action="store_true", help="print the result as JSON")
    many = parser.add_argument_group("many inputs")
    many.add_argument("--dask", metavar="ADDRESS", help="work on the Dask cluster of this scheduler")
    if output:
        many.add_argument("--report", metavar="FILE.json", help="write what came of each input, print a table")
        many.add_argument(
            "--resume", action="store_true", help="go on from --report: leave what is whole and as it would be made"
        )
    else:
        parser.set_defaults(output=None, report=None, resume=False)


def run_of(args: argparse.Namespace) -> Run:
    """How many inputs are worked on, and where."""
    return asked(Run, args)


def asked(kind: type[_Asked], args: argparse.Namespace, **more: Any) -> _Asked:
    """What a command line asks for: the flags that are named as the fields of a dataclass."""
    given = {field.name: getattr(args, field.name) for field in fields(kind) if hasattr(args, field.name)}  # type: ignore[arg-type]
    return kind(**{**given, **more})


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


def add_reader_flag(parser: argparse.ArgumentParser) -> None:
    """Add it; `args.reader` goes to `read_mesh` and `open_sequence`."""
    parser.add_argument(
        "--reader",
        choices=READERS,
        help="who reads mesh files (default: bsm for OBJ, OFF, PLY, STL, VTP and npz, trimesh for GLB, 3MF, DAE, ...)",
    )
