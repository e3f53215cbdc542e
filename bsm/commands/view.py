"""bsm view: streams in a browser, as they arrive."""

from __future__ import annotations

import argparse
import itertools
import webbrowser
from pathlib import Path

from bsm.console import Console
from bsm.files.output import open_output
from bsm.files.pipes import read_chunks
from bsm.viewer.page import PageServer, page_with_streams


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what the command takes."""
    parser.add_argument("inputs", metavar="IN", nargs="+", help="stream, of a mesh or a sequence, or - for a pipe")
    parser.add_argument(
        "--save",
        metavar="PAGE.html",
        help="write one page with the streams in it; it needs no server and no network",
    )
    parser.add_argument("--port", type=int, default=0, metavar="N", help="of the server (default: any that is free)")
    parser.add_argument("--no-open", action="store_true", help="print the address, and leave the browser to you")


def run(args: argparse.Namespace, console: Console) -> int:
    """Write the page, or serve it until interrupted."""
    streams = _read_streams(args.inputs)
    if args.save:
        with open_output(args.save, overwrite=args.force) as file:
            file.write(page_with_streams(streams).encode())
        console.note(f"{args.save}: open it in a browser")
        return 0
    with PageServer(streams, args.port) as server:
        address = f"http://{server.host}/"
        print(address, flush=True)
        if not args.no_open:
            webbrowser.open(address)
        console.note("press Ctrl-C to stop")
        try:
            server.serve_forever()
        except KeyboardInterrupt:
            console.note("stopped")
    return 0


def _read_streams(inputs: list[str]) -> dict[str, bytes]:
    """Bytes of all inputs by their names; a damaged stream is for the page to tell."""
    streams: dict[str, bytes] = {}
    for path in inputs:
        streams[_free_name(Path(path).name, streams)] = b"".join(read_chunks(path))
    return streams


def _free_name(name: str, taken: dict[str, bytes]) -> str:
    if name not in taken:
        return name
    return next(other for n in itertools.count(2) if (other := f"{name} ({n})") not in taken)
