"""bsm glb: a scene of glTF with its geometry coded, or one of a sequence."""

import argparse
from functools import partial
from pathlib import Path

from bsm.api import encode
from bsm.bitstream.errors import OptionError
from bsm.console import Console
from bsm.files.output import write_output
from bsm.files.pipes import read_bytes
from bsm.files.stream import is_stream
from bsm.gltf.compress import ImageRule, compress, count_primitives
from bsm.gltf.document import read_document
from bsm.gltf.write import moving_scene

MANY = 16  # primitives from which on a page waits longer for decoding than for the bytes that it saves
PRESETS = ("balanced", "fine", "near-lossless", "grid14")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    scene = ".glb, .gltf with the files beside it, or the stream of a sequence, which is wrapped in a scene"
    add("input", metavar="SCENE", help=scene)
    add("-o", "--output", metavar="OUT.glb", required=True, help="the compressed scene")
    promised = "quality of each mesh (default: grid14, as exact as Draco with 14 bits)"
    add("--preset", choices=PRESETS, default=PRESETS[-1], help=promised)
    quick = "code grids only: pages decode them several times as fast, with a small decoder "
    quick += f"(default: for scenes of {MANY} primitives and more)"
    add("--quick", action=argparse.BooleanOptionalAction, help=quick)
    plain = "also write OUT.fallback.bin with plain arrays, for viewers without the extension"
    add("--fallback", action="store_true", help=plain)
    images = "recompress images with Pillow: webp, jpeg, png; webp:85 sets a quality, webp:85@1024 also a largest side"
    add("--images", metavar="RULE", help=images)


def run(args: argparse.Namespace, console: Console) -> None:
    rule = ImageRule.parse(args.images) if args.images else None
    if Path(args.output).suffix.lower() != ".glb":
        raise OptionError(f"the output is a .glb, not {args.output}")
    if is_stream(args.input):
        if args.fallback or args.images or args.quick is not None or args.preset != PRESETS[-1]:
            raise OptionError("a stream is wrapped unchanged: only -o, -f and -q apply")
        stream = read_bytes(args.input)
        scene = moving_scene(stream)
        write_output(args.output, scene, overwrite=args.force)
        console.note(f"{args.input} -> {args.output}: a mesh that moves, {len(stream)} -> {len(scene)} bytes")
        return
    document = read_document(args.input)
    quick = count_primitives(document) >= MANY if args.quick is None else args.quick
    coder = partial(encode, preset=args.preset, quick=quick)
    beside = Path(args.output).with_suffix(".fallback.bin") if args.fallback else None
    with console.progress("encoding") as progress:
        found = compress(document, coder, rule, beside.name if beside else None, progress)
    if beside and found.fallback:
        write_output(str(beside), found.fallback, overwrite=args.force, follow=False)
    write_output(args.output, found.data, overwrite=args.force)
    console.note(
        f"{args.input} -> {args.output}: {found.coded} of {found.coded + sum(found.left.values())} primitives coded, "
        f"{document.received} -> {len(found.data)} bytes"
    )
    images = sum(len(document.image(number)[1]) for number in range(len(document.items("images"))))
    if not rule and 2 * images > len(found.data):
        console.note(f"{args.input}: {images} bytes are images, as they were; --images webp:85 makes them smaller")
    for reason, count in found.left.items():
        console.note(f"{args.input}: {count} stayed as {'it was' if count == 1 else 'they were'}: {reason}")
