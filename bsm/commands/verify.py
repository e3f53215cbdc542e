"""bsm verify: whether streams are whole and can be decoded."""

from __future__ import annotations

import argparse

from bsm.console import Console, print_json
from bsm.files.pipes import read_chunks
from bsm.files.sequence_stream import decode_through
from bsm.files.stream import decode_whole, inspect_stream


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what the command takes."""
    parser.add_argument("input", metavar="FILE", help="stream, or - for standard input")
    parser.add_argument("--quick", action="store_true", help="check structure and checksums only, do not decode")
    parser.add_argument("--json", action="store_true", help="print the result as JSON")


def run(args: argparse.Namespace, console: Console) -> None:
    """Check one stream; what is wrong is raised."""
    chunks = list(read_chunks(args.input))
    info = inspect_stream(iter(chunks))
    if not args.quick:
        decode_through(iter(chunks)) if info.header.gop_frames else decode_whole(iter(chunks))
    if args.json:
        print_json({"input": args.input, "ok": True, "decoded": not args.quick, "bytes": info.total})
    else:
        console.note(f"{args.input}: whole, {info.header.blocks} blocks, {info.total} bytes")
