"""bsm view: streams in a browser, as they arrive."""

import argparse
import itertools
import json
import webbrowser
from pathlib import Path
from threading import Thread

from bsm.api import encode
from bsm.bitstream.container.wire import MAGIC
from bsm.bitstream.errors import FormatError, OptionError
from bsm.commands.flags import add_limits_flag, add_reader_flag, limits_of
from bsm.console import Console
from bsm.files.mesh import read_mesh
from bsm.files.output import write_output
from bsm.files.pipes import about, inside, read_chunks
from bsm.tiles.shards import MANIFEST, is_tiles, open_tiles
from bsm.viewer.page import Content, Growing, PageServer, Ranged, Tiled, compared, page_with, written_to

_NO_STREAM = "what came through the pipe is no BSM stream; encode it on the way: bsm encode - -o - | ..."


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add(
        "inputs",
        metavar="IN",
        nargs="+",
        help="stream, of a mesh or a sequence, or - for a pipe; mesh file, encoded on the way; folder of tiles",
    )
    add("--original", metavar="MESH", help="mesh file that the stream was made of, to compare it with")
    add("--follow", action="store_true", help="the files are still being written: go on as they grow, as with a pipe")
    add_reader_flag(parser)
    add_limits_flag(parser)
    add("--save", metavar="PAGE.html", help="write one page with the streams in it; it needs no server and no network")
    add("--port", type=int, default=0, metavar="N", help="of the server (default: any that is free)")
    add("--no-open", action="store_true", help="print the address, and leave the browser to you")


def run(args: argparse.Namespace, console: Console) -> int:
    if args.follow and (args.save or args.original):
        raise OptionError(f"{'--save' if args.save else '--original'} needs streams that are written: no --follow")
    if (args.save or args.original or args.follow) and any(map(is_tiles, args.inputs)):
        raise OptionError("tiles come by ranges, as they are looked at: no --save, --original or --follow")
    reading = console.progress("reading and comparing" if args.original else "reading")
    if args.save:
        with reading:
            contents = _contents(args, console)
        write_output(args.save, page_with(contents).encode(), overwrite=args.force)
        console.note(f"{args.save}: open it in a browser")
        return 0
    with reading:
        served: list[Content | Growing | Tiled] = []
        for name, path in {} if args.original else _named(args.inputs).items():
            if is_tiles(path):
                manifest = open_tiles(path, limits_of(args.limits)).manifest
                shards = {one["file"]: Ranged(inside(path, one["file"]), one["size"]) for one in manifest["shards"]}
                served.append(Tiled(name, {MANIFEST: json.dumps(manifest).encode(), **shards}))
                continue
            growing = args.follow or path == "-"
            served.append(_growing(name, path) if growing else Content(name, _stream(path, args.reader, console)))
        served += _contents(args, console) if args.original else []
    with PageServer(served, args.port) as server:
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


def _contents(args: argparse.Namespace, console: Console) -> list[Content]:
    """All inputs, as wholes; a damaged stream is for the page to tell, unless it is to be compared."""
    streams = {name: _stream(path, args.reader, console) for name, path in _named(args.inputs).items()}
    if args.original is None:
        return [Content(name, data) for name, data in streams.items()]
    if len(streams) > 1:
        raise OptionError("--original is for one input")
    with about(args.original):
        mesh = read_mesh(args.original, reader=args.reader).mesh
    with about(args.inputs[0]):
        return [compared(name, data, mesh, limits_of(args.limits)) for name, data in streams.items()]


def _stream(path: str, reader: str | None, console: Console) -> bytes:
    """A stream as it is, a mesh file encoded as `bsm encode` does."""
    data = b"".join(read_chunks(path))
    if data.startswith(MAGIC[: len(data)]):
        return data
    if path == "-":
        raise FormatError(_NO_STREAM)
    with about(path):
        stream = encode(read_mesh(path, reader=reader).mesh)
    console.note(f"{path}: {len(stream)} bytes as a stream of the default preset")
    return stream


def _growing(name: str, path: str) -> Growing:
    growing = Growing(name)
    chunks = read_chunks(path) if path == "-" else written_to(open(path, "rb"))  # noqa: SIM115
    Thread(target=growing.receive, args=(chunks,), daemon=True).start()
    if not growing.begins():
        raise FormatError(_NO_STREAM if path == "-" else f"{path} is no BSM stream; only a stream can be followed")
    return growing


def _named(paths: list[str]) -> dict[str, str]:
    """Paths under names of their own."""
    named: dict[str, str] = {}
    for path in paths:
        name = Path(path).name
        others = (f"{name} ({number})" for number in itertools.count(2))
        named[next(one for one in itertools.chain([name], others) if one not in named)] = path
    return named
