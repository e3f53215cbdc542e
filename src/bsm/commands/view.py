"""bsm view: streams in a browser, as they arrive."""

import argparse
import json
import shlex
from contextlib import ExitStack, suppress
from pathlib import Path
from threading import Thread

from bsm.account.overview import load_mesh, write_page
from bsm.bitstream.errors import FormatError, OptionError
from bsm.bitstream.limits import as_limits
from bsm.codec.static.presets import DEFAULT, SEQUENCE_ROWS
from bsm.commands.flags import add_flags, adder
from bsm.files.inspection import inspect_stream
from bsm.files.output import write_output
from bsm.files.pipes import about, read_chunks
from bsm.files.stream import MANIFEST, is_tiles
from bsm.ground.console import Console, Progress
from bsm.jobs.plan import STREAM_SUFFIXES, files_in
from bsm.tiles.shards import open_tiles
from bsm.viewer.contents import NO_STREAM, Content, against, alone, encoded_scene, given_at, made
from bsm.viewer.page import (
    Arrival,
    PageServer,
    Ranged,
    Tiled,
    check_crease_angle,
    in_browser,
    page_with,
    site_with,
    written_to,
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = adder(parser)
    text = "stream, - for a pipe, folder of streams or of tiles. Meshes and sequences are encoded "
    text += "and compared. Without inputs, opens an empty page; drop a mesh on it"
    add("inputs", "IN", text, nargs="*")
    names = [row.name for row in SEQUENCE_ROWS]
    add(
        "--preset",
        "",
        f"preset for meshes and sequences (default: {DEFAULT})",
        choices=names,
        default=DEFAULT,
    )
    add_flags(parser, "view", "limits")


def run(args: argparse.Namespace, console: Console) -> int:
    needing_whole = [name for name in ("save", "static", "original") if getattr(args, name)]
    if args.follow and needing_whole:
        raise OptionError(f"--{needing_whole[0]} needs complete streams; leave out --follow")
    # Tiles are gigabytes. The page fetches those that it shows, and can neither hold nor compare all.
    if (args.follow or args.save or args.original) and any(map(is_tiles, args.inputs)):
        raise OptionError("tiles are loaded on demand; leave out --save, --original and --follow")
    check_crease_angle(args.crease_angle)
    if args.crease_angle is not None and any(map(is_tiles, args.inputs)):
        raise OptionError("tiles are drawn smooth; leave out --crease-angle")
    if args.original and len(args.inputs) != 1:
        raise OptionError("--original is for one input")
    if len(args.inputs) == 1 and _has_streams(args.inputs[0]):
        return _view_folder(args.inputs[0], args, console)
    with console.progress("reading and comparing") as progress:
        served = [
            _opened(name, path, args, console, progress)
            for name, path in _named(args.inputs).items()
        ]
    contents = [content for content in served if isinstance(content, Content)]
    if args.save:
        write_output(
            args.save, page_with(contents, args.crease_angle).encode(), overwrite=args.force
        )
        console.note(f"{args.save}: open it in a browser")
    if args.static:
        static = [content for content in served if not isinstance(content, Arrival)]
        for name, data in site_with(static, args.crease_angle).items():
            file = Path(args.static, name)
            file.parent.mkdir(parents=True, exist_ok=True)
            if not isinstance(data, bytes):
                data = data.whole()
            write_output(file, data, overwrite=args.force)
        advice = f", for example: python -m http.server -d {shlex.quote(args.static)}"
        if any(map(is_tiles, args.inputs)):
            advice = ", which must send ranges of files for tiles, as nginx does"
        console.note(f"{args.static}: a page for any web server{advice}")
    if args.save or args.static:
        return 0
    with PageServer(served, args.port, args.crease_angle) as server:
        _serve(server, args, console)
    return 0


def _has_streams(path: str) -> bool:
    """Return whether a path is a folder of streams, and not one of tiles or of the frames of a sequence."""
    return Path(path).is_dir() and not is_tiles(path) and any(Path(path).rglob("*.bsm"))


def _view_folder(folder: str, args: argparse.Namespace, console: Console) -> int:
    """Show a page with a picture of each stream of a folder."""
    wrong = [name for name in ("static", "original", "follow") if getattr(args, name)]
    # Pictures of an overview are flat everywhere.
    if args.crease_angle is not None:
        wrong.append("crease-angle")
    if wrong:
        raise OptionError(f"{folder} has streams of its own; leave out --{wrong[0]}")
    with console.progress("drawing"):
        names = [str(path) for _, path in files_in([folder], STREAM_SUFFIXES)]
        rows = [{"input": name, "output_bytes": Path(name).stat().st_size} for name in names]
        page = write_page(folder, rows, load_mesh)
    if args.save:
        write_output(args.save, page, overwrite=args.force)
        console.note(f"{args.save}: open it in a browser")
        return 0
    with PageServer((), args.port) as server:
        server.content["/"] = ("text/html; charset=utf-8", page)
        _serve(server, args, console)
    return 0


def _serve(server: PageServer, args: argparse.Namespace, console: Console) -> None:
    """Serve a page until Ctrl-C."""
    # To standard output and at once: scripts wait for this line before they open the page.
    print(server.address, flush=True)
    console.note("press Ctrl-C to stop")
    with suppress(KeyboardInterrupt), ExitStack() as browser:
        if not args.no_open:
            browser.enter_context(in_browser(server.address))
        server.serve_forever()
    console.note("stopped")


def _opened(
    name: str, path: str, args: argparse.Namespace, console: Console, progress: Progress
) -> Content | Arrival | Tiled:
    """Open an input. The page reports a damaged stream, unless it is compared or the page is saved."""
    if is_tiles(path):
        manifest = open_tiles(path, as_limits(args.limits)).manifest
        files: dict[str, bytes | Ranged] = {MANIFEST: json.dumps(manifest).encode()}
        for shard in manifest["shards"]:
            files[shard["file"]] = Ranged(path, shard["file"], shard["size"])
        return Tiled(name, files)
    if args.follow or (path == "-" and not (args.save or args.static or args.original)):
        return _growing(name, path)
    if args.original:
        with about(args.original):
            before = given_at(args.original)
        with about(path):
            content = against(before, given_at(path), as_limits(args.limits))
        for note in content.facts["notes"]:
            console.note(note)
        return content
    with about(path):
        scene = encoded_scene(name, path, as_limits(args.limits))
        if scene is not None:
            for note in scene.facts["notes"]:
                console.note(f"{path}: {note}")
            console.note(f"{path}: shown as it decodes; nothing was encoded")
            return scene
        source = given_at(path)
        if isinstance(source.source, bytes):
            # A page on a disk is opened by people who were not there. A damaged stream must be found now.
            if args.save or args.static:
                inspect_stream(iter([source.source]), as_limits(args.limits))
            return alone(name, source.source)
        content = made(name, source.size, source.source, args.preset, progress.stage)
    for note in content.facts["notes"]:
        console.note(f"{path}: {note}")
    console.note(
        f"{path}: {content.layers[content.main].size} bytes as a stream with preset {args.preset}"
    )
    return content


def _growing(name: str, path: str) -> Arrival:
    growing = Arrival(name)
    if path == "-":
        chunks = read_chunks(path)
        fault = NO_STREAM
    else:
        chunks = written_to(open(path, "rb"))  # noqa: SIM115
        fault = f"{path} is not a BSM stream; only streams can be followed"
    # A daemon, because a pipe may never end, and Ctrl-C must.
    Thread(target=growing.receive, args=(chunks,), daemon=True).start()
    if not growing.begins():
        raise FormatError(fault)
    return growing


def _named(paths: list[str]) -> dict[str, str]:
    """Return paths by unique names."""
    by_name: dict[str, str] = {}
    for path in paths:
        file_name = name = Path(path).name
        number = 1
        # Two files of one name from two folders are two entries of the page.
        while name in by_name:
            number += 1
            name = f"{file_name} ({number})"
        by_name[name] = path
    return by_name
