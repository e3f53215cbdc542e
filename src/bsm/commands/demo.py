"""bsm demo: encode, decode, compare and draw a generated sample."""

import argparse
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

from bsm.account.drawing import Panel, drawing
from bsm.codec.arrays import Positions
from bsm.codec.decoding import decode
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.static.encoder import Encoder
from bsm.commands.flags import add_flags, add_preset_flags, keywords_of
from bsm.encoding.options import encode_options
from bsm.evaluation.sample import knot
from bsm.files.output import refuse_to_overwrite, write_output
from bsm.ground.console import Console, print_json
from bsm.ground.pictures import DEFAULT_VIEW


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_flags(parser, "demo")
    add_preset_flags(parser)


def run(args: argparse.Namespace, console: Console) -> None:
    stream_path, picture_path = Path(args.output, "bsm_demo.bsm"), Path(args.output, "bsm_demo.png")
    for path in (stream_path, picture_path):
        refuse_to_overwrite(path, args.force)
    Path(args.output).mkdir(parents=True, exist_ok=True)

    sample = knot(args.vertices)
    vertices, faces = len(sample.positions), len(sample.faces)
    # The arrays that a program would hold, since a sample has no file to compare with.
    plain = 12 * (vertices + faces)  # as float32 and int32
    console.note(
        f"sample     a knotted rope: {vertices} vertices, {faces} faces, {plain} bytes as plain arrays"
    )
    encoder, begin = Encoder(sample, encode_options(**keywords_of(args))), time.perf_counter()
    with console.progress("encoding") as progress:
        result = encoder.result(progress)
    stream, error, encoding = (
        b"".join(result.frames),
        result.comparison,
        time.perf_counter() - begin,
    )
    console.note(
        f"encoded    {len(stream)} bytes, {plain / len(stream):.1f} times smaller, "
        f"{8 * len(stream) / vertices:.2f} bits per vertex, {encoding:.2f} s"
    )
    begin = time.perf_counter()
    with console.progress("decoding"):
        received = decode(stream)
    decoding = time.perf_counter() - begin
    positions = np.empty_like(received.positions)
    # The decoder has its own order of vertices. The picture compares vertex by vertex.
    positions[encoder.vertex_order] = received.positions
    words = ""
    if encoder.look is not None:
        words = f"look {encoder.look:.2f}, "
    console.note(
        f"decoded    {words}largest vertex error {100 * error.max_error_relative:.3g} % of the diagonal, mean normal "
        f"error {error.angle_deg:.2f} degrees, {decoding:.2f} s"
    )
    write_output(stream_path, stream, overwrite=args.force, follow=False)
    with console.progress("drawing"):
        titles = (
            f"original, {plain / 1000:,.0f} kB",
            f"decoded, {len(stream) / 1000:,.1f} kB",
            "error",
        )
        write_output(
            picture_path,
            _drawn(sample, positions, titles, console),
            overwrite=args.force,
            follow=False,
        )
    written = [str(stream_path), str(picture_path)]
    console.note(f"written    {', '.join(written)}")
    if args.json:
        sizes = {
            "vertices": vertices,
            "faces": faces,
            "bytes": len(stream),
            "bpv_total": 8 * len(stream) / vertices,
        }
        errors = {
            name: getattr(error, name) for name in ("nmsve_db", "theta_deg", "max_error_relative")
        }
        print_json(
            sizes
            | {"encode_seconds": encoding, "decode_seconds": decoding}
            | errors
            | {"written": written}
        )


def _drawn(
    sample: TriangleMesh, positions: Positions, titles: tuple[str, ...], console: Console
) -> bytes:
    """A picture of the sample, of its decoded mesh, and of the error."""
    errors = Panel(sample, titles[-1], np.linalg.norm(positions - sample.positions, axis=1))
    meshes = (Panel(sample, titles[0]), Panel(replace(sample, positions=positions), titles[1]))
    return drawing((*meshes, errors), sample, console, DEFAULT_VIEW)
