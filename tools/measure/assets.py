"""Compare the decoding of whole assets, with normals and texture coordinates, with Draco's.

    python -m tools.measure assets GLB [GLB ...]

Both have positions of 14 bits, normals of 10 and texture coordinates of 12; Draco has level 10. Times are processor
times of one thread: the least of five turns, in each of which everything is decoded. Draco gets vertices that are split
where attributes differ, as files of glTF have them. Both results are checked before they are timed. Needs DracoPy.
"""

import argparse
import math
import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np

from bsm.codec.decoding import decode
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.welding import split_with_origin
from bsm.codec.static.encoder import encode
from bsm.codec.static.options import EncodeOptions
from bsm.files.mesh import read_mesh

POSITION_BITS = 14
BITS = {"normal": 10, "texcoord": 12}
TURNS = 5


def asset_of(path: str) -> TriangleMesh | None:
    """Return a mesh with its first normals and its first texture coordinates, or None if it has neither."""
    mesh = read_mesh(path).mesh
    attributes: dict[str, Attribute] = {}
    for attribute in mesh.attributes:
        if attribute.semantic in BITS:
            attributes.setdefault(attribute.semantic, attribute)
    if not attributes:
        return None
    return replace(mesh, attributes=tuple(attributes.values()), metadata={})


def stream_of(mesh: TriangleMesh, effort: str) -> bytes:
    """Return our stream, which the encoder has decoded and compared with the mesh."""
    qualities = {attribute.name: f"{BITS[attribute.semantic]}bits" for attribute in mesh.attributes}
    return encode(
        mesh, EncodeOptions(grid=POSITION_BITS, effort=effort, attributes=qualities, threads=1)
    )


def draco_of(mesh: TriangleMesh) -> bytes:
    """Return Draco's file, which is decoded and compared with the mesh."""
    import DracoPy

    vertices, _ = split_with_origin(mesh)
    values = {
        attribute.semantic: attribute.values.astype(np.float64) for attribute in vertices.attributes
    }
    data: bytes = DracoPy.encode(
        vertices.positions.astype(np.float32),
        vertices.faces.astype(np.uint32),
        quantization_bits=POSITION_BITS,
        compression_level=10,
        normals=values.get("normal"),
        normal_quantization_bits=BITS["normal"],
        tex_coord=values.get("texcoord"),
        tex_coord_quantization_bits=BITS["texcoord"],
    )
    used = mesh.positions[np.unique(mesh.faces)]
    points = DracoPy.decode(data).points
    cell = float(np.ptp(used, axis=0).max()) / (2**POSITION_BITS - 1)
    assert np.abs(points.min(axis=0) - used.min(axis=0)).max() <= cell, "Draco decodes another mesh"
    assert np.abs(points.max(axis=0) - used.max(axis=0)).max() <= cell, "Draco decodes another mesh"
    return data


def least_times(decoders: Sequence[Callable[[], object]]) -> list[float]:
    """Return the least processor time of each decoder, by turns."""
    least = [math.inf] * len(decoders)
    for _ in range(TURNS):
        for place, call in enumerate(decoders):
            begin = time.thread_time()
            call()
            least[place] = min(least[place], time.thread_time() - begin)
    return least


def ratios(mesh: TriangleMesh) -> list[float]:
    """Return times of the default and of `--quick` over Draco's, and their bytes."""
    import DracoPy

    streams = [stream_of(mesh, effort) for effort in ("normal", "quick")]
    draco = draco_of(mesh)
    decoders = [partial(decode, stream, threads=1) for stream in streams]
    usual, quick, rival = least_times([*decoders, partial(DracoPy.decode, draco)])
    sizes = [len(stream) / len(draco) for stream in streams]
    return [usual / rival, quick / rival, *sizes]


def main() -> None:
    """Run the command."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("assets", nargs="+", metavar="GLB")
    rows = []
    print(
        "| asset | triangles | time over Draco's | with --quick | bytes over Draco's | with --quick |"
    )
    print("|---|---:|---:|---:|---:|---:|")
    for path in parser.parse_args().assets:
        mesh = asset_of(path)
        if mesh is None:
            continue
        rows.append(ratios(mesh))
        figures = " | ".join(f"{ratio:.2f}" for ratio in rows[-1])
        print(f"| {Path(path).stem} | {len(mesh.faces):,} | {figures} |", flush=True)
    if rows:
        for name, figure in (
            ("median", np.median(rows, axis=0)),
            ("largest", np.max(rows, axis=0)),
        ):
            print(
                f"| {name} of {len(rows)} | | "
                + " | ".join(f"{ratio:.2f}" for ratio in figure)
                + " |"
            )
