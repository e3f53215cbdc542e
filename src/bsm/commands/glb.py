"""bsm glb: a scene of glTF with its geometry coded, or one of a sequence."""

import argparse
import shlex
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from bsm.account.images import changed
from bsm.bitstream.errors import HarmError, OptionError
from bsm.codec.static.presets import PRESET_ROWS
from bsm.commands.flags import add_flags, adder
from bsm.files.images import ImageRule, with_linked_images
from bsm.files.mesh import read_mesh, size_with_parts, written_mesh
from bsm.files.output import refuse_collisions, write_output
from bsm.files.pipes import about, as_input, read_chunks
from bsm.files.sequence import open_sequence
from bsm.files.stream import decode_whole, is_stream, peek_header
from bsm.files.table import GLTF
from bsm.gltf.compress import Compressed, compress, count_primitives
from bsm.gltf.document import Document, read_document
from bsm.gltf.write import moving_scene
from bsm.ground.console import Console, print_json

# Primitives from which on a page waits longer for decoding than for the bytes that it saves.
MANY = 16
_NO_PROMISE, _USUAL = ("none", "paper"), "grid14"
VISIBLE = 0.01  # of the diagonal of a component: an error that is worth a note


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = adder(parser)
    quality = f"quality of each mesh (default: {_USUAL}, as exact as Draco with 14 bits)"
    names = [row.name for row in PRESET_ROWS if row.name not in _NO_PROMISE]
    add("--preset", "", quality, choices=names, default=_USUAL)
    quick = "code only grids: pages decode them several times as fast, with a small decoder "
    quick += f"(default: for scenes of {MANY} primitives and more)"
    add("--quick", "", quick, action=argparse.BooleanOptionalAction)
    add_flags(parser, "glb")


def run(args: argparse.Namespace, console: Console) -> None:
    rule = None
    if args.images:
        rule = ImageRule.parse(args.images)
    if Path(args.output).suffix.lower() != ".glb":
        raise OptionError(f"{args.output}: the output must be a .glb")
    streamed = not Path(args.input).is_dir() and is_stream(args.input)
    # A moving mesh is one stream already, which the scene only wraps.
    if streamed and (header := peek_header(read_chunks(args.input))[0]) and header.gop_frames:
        _wrap_sequence(args, console)
        return
    with about(args.input):
        document, received = _document(args.input, console)
    # Chosen by the scene unless the user says so: few primitives are better small, and many are better fast.
    quick = args.quick
    if quick is None:
        quick = count_primitives(document) >= MANY
    if args.preset == "lossless" and args.quick:
        raise OptionError("--quick rounds positions to a grid; leave out --preset lossless")
    if args.one_grid and args.preset != _USUAL:
        raise OptionError(f"--one-grid shares the grid of --preset {_USUAL}; leave out the preset")
    options = {"preset": args.preset, "attributes": _qualities(args)}
    if quick and args.preset != "lossless":
        options["effort"] = "quick"
    beside = name = None
    if args.fallback:
        beside = Path(args.output).with_suffix(".fallback.bin")
        name = beside.name
    refuse_collisions((args.input, *document.files), filter(None, (args.output, str(beside or ""))))
    with console.progress("encoding") as progress:
        result = compress(
            document, options, rule, name, progress, jobs=args.jobs, one_grid=args.one_grid
        )
    # A scene that came back as it was would look like success.
    if not (result.coded or received or rule or args.force):
        why = "; ".join(result.unchanged) or "the scene has no primitives"
        raise HarmError(f"{args.input}: nothing was coded: {why}; --force writes the scene anyway")
    if beside and result.fallback:
        write_output(str(beside), result.fallback, overwrite=args.force, follow=False)
    write_output(args.output, result.data, overwrite=args.force)
    count, before = result.coded + sum(result.unchanged.values()), received or document.received
    words = f"{result.coded} of {count} primitives coded, {before} -> {len(result.data)} bytes; largest vertex error "
    words += f"{result.error[0]:.3g}, at most {100 * result.error[1]:.3g} % of the diagonal of its component"
    notes = list(_notes_on(result, document, before, shrinks=rule is not None))
    more = {
        "primitives": count,
        "coded": result.coded,
        "unchanged": result.unchanged,
        "notes": notes,
    }
    more |= {"max_error": result.error[0], "max_error_of_component": result.error[1]}
    more["images"] = [image.facts() for image in result.images]
    _finish(args, console, words, before, result.data, more)
    for note in notes:
        console.note(f"{args.input}: {note}")


def _finish(
    args: argparse.Namespace,
    console: Console,
    words: str,
    received: int,
    data: bytes,
    more: Mapping[str, Any],
) -> None:
    console.note(f"{args.input} -> {args.output}: {words}")
    if args.json:
        sizes = {"input_bytes": received, "output_bytes": len(data)}
        print_json({"input": args.input, "output": args.output, **sizes, **more})


def _wrap_sequence(args: argparse.Namespace, console: Console) -> None:
    changes = (
        args.fallback,
        args.images,
        args.quick is not None,
        args.attribute,
        args.one_grid,
        args.jobs != 1,
    )
    if any(changes) or args.preset != _USUAL:
        raise OptionError("a stream is wrapped unchanged; only -o, -f, -q and --json apply")
    stream = as_input(args.input).read_all()
    scene = moving_scene(stream)
    write_output(args.output, scene, overwrite=args.force)
    words = f"a sequence, {len(stream)} -> {len(scene)} bytes"
    _finish(args, console, words, len(stream), scene, {"notes": []})


def _notes_on(
    result: Compressed, document: Document, before: int, *, shrinks: bool
) -> Iterator[str]:
    """Say what else is to be known of a result; `before`: the bytes of the input, `shrinks`: images become smaller."""
    if len(result.data) > before:
        note = "the result is larger than the input"
        for name in document.compressed[:1]:
            note += f", as {name} had made that small: keep it"
        yield note
    if result.error[1] > VISIBLE:
        yield "small components are coarse; use --preset fine or near-lossless"
    yield from changed(list(result.images))
    for note, count in result.notes.items():
        if count > 1:
            yield f"{note} ({count} times)"
        else:
            yield note
    # Often most of the bytes are images, and someone who compares sizes should know it.
    images = 0
    for number in range(len(document.items("images"))):
        images += len(document.image(number)[1] or b"")
    if not shrinks and 2 * images > len(result.data):
        yield f"{images} bytes are unchanged images; --images webp:85 makes them smaller"
    for reason, count in result.unchanged.items():
        yield f"{count} unchanged: {reason}"


def _document(path: str, console: Console) -> tuple[Document, int | None]:
    """Return a scene, or a mesh as one; and the bytes of the mesh file."""
    if not Path(path).is_dir() and is_stream(path):
        mesh = with_linked_images(decode_whole(read_chunks(path)), path)
        console.note(f"{path}: compressed already: errors add up")
    elif Path(path).suffix[1:].lower() in GLTF:
        document = read_document(path)
        for name in document.compressed:
            console.note(f"{path}: compressed already, by {name}: errors add up")
        return document, None
    else:
        # The way from a sequence to a scene has two steps, and the message gives both.
        if open_sequence(path) is not None:
            stream = shlex.quote(f"{Path(path).stem}.bsm")
            advice = f"bsm encode {shlex.quote(path)} -o {stream}; bsm glb {stream} -o {Path(path).stem}.glb"
            raise OptionError(f"{path} is a sequence. Run: {advice}")
        source = read_mesh(path)
        mesh = source.mesh
        for note in source.notes:
            console.note(f"{path}: {note}")
    written = written_mesh(mesh, "glb", path)
    if written.left_out:
        console.note(f"{path}: glb cannot hold {', '.join(written.left_out)}")
    return Document(written.data), size_with_parts(path, mesh.metadata)[0]


def _qualities(args: argparse.Namespace) -> dict[str, str]:
    """Qualities by the names of attributes."""
    qualities = dict(entry.partition("=")[::2] for entry in args.attribute)
    for name, quality in qualities.items():
        if not name or not quality or quality == "recompute":
            raise OptionError(
                f"--attribute {name}={quality}: give NAME=QUALITY; recompute is not for scenes"
            )
        if quality == "none" and not name.startswith(
            ("NORMAL", "TANGENT", "TEXCOORD_", "COLOR_", "_")
        ):
            raise OptionError(f"--attribute {name}=none: a scene needs {name}")
    return qualities
