"""bsm demo: the whole road of a mesh, on a sample made by formula."""

import argparse
import time
from pathlib import Path

import numpy as np

from bsm.bitstream.errors import DependencyError
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.commands.flags import add_preset_flags, options_of, within
from bsm.console import Console, print_json
from bsm.files.output import refuse_to_overwrite, write_output
from bsm.options import encode_options
from bsm.pictures import bounds_of, colors_of, png, render, with_titles


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("-o", "--output", metavar="FOLDER", default=".", help="folder for the results (default: the current one)")
    size = "number of vertices of the sample (default 20000)"
    add("--vertices", type=within(1), default=20_000, metavar="N", help=size)
    add("--json", action="store_true", help="print the result as JSON")
    add_preset_flags(parser)


def run(args: argparse.Namespace, console: Console) -> None:
    stream_path, picture_path = Path(args.output, "bsm_demo.bsm"), Path(args.output, "bsm_demo.png")
    for path in (stream_path, picture_path):
        refuse_to_overwrite(path, args.force)
    Path(args.output).mkdir(parents=True, exist_ok=True)

    from bsm.codec.decoding import decode
    from bsm.codec.geometry.metrics import compare
    from bsm.codec.static.encoder import Encoder
    from bsm.evaluation.sample import knot

    sample = knot(args.vertices)
    vertices, faces = len(sample.positions), len(sample.faces)
    plain = 12 * (vertices + faces)  # as float32 and int32
    console.note(f"sample     a knotted rope: {vertices} vertices, {faces} faces, {plain} bytes as plain arrays")

    begin = time.perf_counter()
    encoder = Encoder(sample, encode_options(**options_of(args)))
    with console.progress("encoding") as progress:
        stream = b"".join(encoder.chunks(progress))
    encoding = time.perf_counter() - begin
    console.note(
        f"encoded    {len(stream)} bytes, {plain / len(stream):.1f} times smaller, "
        f"{8 * len(stream) / vertices:.2f} bits per vertex, {encoding:.2f} s"
    )

    begin = time.perf_counter()
    with console.progress("decoding"):
        received = decode(stream)
    decoding = time.perf_counter() - begin
    positions = np.empty_like(received.positions)
    positions[encoder.vertex_order] = received.positions
    decoded = TriangleMesh(positions, sample.faces)
    error = compare(sample.positions, decoded.positions, sample.faces)
    console.note(
        f"decoded    in {decoding:.2f} s: largest error {100 * error.max_error_relative:.3f} % of the size, "
        f"{error.nmsve_db:.2f} dB, normals {error.theta_deg:.2f} degrees off on average"
    )

    write_output(stream_path, stream, overwrite=args.force, follow=False)
    with console.progress("drawing"):
        bounds, far = bounds_of(sample.positions), np.linalg.norm(decoded.positions - sample.positions, axis=1)
        top = float(np.percentile(far, 99)) or 1.0
        heat = colors_of(far / top)[sample.faces].mean(axis=1) / 255.0
        looks = ((sample, None), (decoded, None), (sample, heat))
        pictures = [render(mesh.positions, mesh.faces, bounds=bounds, colors=colors) for mesh, colors in looks]
        titles = (f"original, {plain / 1000:,.0f} kB", f"decoded, {len(stream) / 1000:,.1f} kB", "error")
        try:
            drawn = with_titles(pictures, titles, 100.0 * top * error.max_error_relative / (error.max_error or 1.0))
        except DependencyError as problem:
            console.note(f"no titles: {problem}")
            drawn = png(np.hstack(pictures))
        write_output(picture_path, drawn, overwrite=args.force, follow=False)
    written = [str(stream_path), str(picture_path)]
    console.note(f"written    {', '.join(written)}")
    if args.json:
        sizes = {"vertices": vertices, "faces": faces, "bytes": len(stream), "bpv_total": 8 * len(stream) / vertices}
        errors = {name: getattr(error, name) for name in ("nmsve_db", "theta_deg", "max_error_relative")}
        print_json(sizes | {"encode_seconds": encoding, "decode_seconds": decoding} | errors | {"written": written})
