"""How presets look to Butteraugli, which is not ours: `python -m tools.measure butteraugli FOLDER [NAME ...]`.

FOLDER takes the meshes that tools/replicate fetches; without names, every fourth unseen one of 1,500 to 25,000
vertices. Pictures have 1,024 pixels a side, drawn at twice that, in smooth shading; the worst of six sides counts, by
Butteraugli's 3-norm. 1 is what people just notice. Needs DracoPy and `butteraugli_main` (Debian: libjxl-devtools).
"""

from __future__ import annotations

import argparse
import subprocess
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

from bsm.codec.decoding import decode
from bsm.codec.geometry.mesh import TriangleMesh, box_around
from bsm.codec.look.pictures import SAMPLES, Canvas, Picture, Shape, cameras
from bsm.codec.static.encoder import encode
from bsm.codec.static.options import PRESETS
from tools.replicate.fetch import fetch_meshes

PIXELS = 1024
NAMED, EVERY = (1500, 25_000), 4
GOOD_ENOUGH = 3.3
BITS = 11


def drawn(mesh: TriangleMesh, original: TriangleMesh) -> list[Picture]:
    """Pictures that the original fills, from six sides."""
    low, high = box_around(original.positions)
    placed, filling = ((m.positions - (low + high) / 2) / np.linalg.norm(high - low) for m in (mesh, original))
    placed, faces = np.ascontiguousarray(placed), np.ascontiguousarray(mesh.faces, np.int32)
    normals, canvas = Shape.of(placed, faces).normals(placed), Canvas(PIXELS * SAMPLES)
    return [canvas.draw(placed, faces, normals, side) for side in cameras(filling, PIXELS * SAMPLES)]


def norm(first: Picture, second: Picture) -> float:
    """Butteraugli's 3-norm of two pictures."""
    with tempfile.TemporaryDirectory() as folder:
        paths = [Path(folder) / name for name in ("first.pgm", "second.pgm")]
        for path, picture in zip(paths, (first, second), strict=True):
            shades = np.rint(picture.clip(0.0, 1.0) * 255.0).astype(np.uint8)
            path.write_bytes(b"P5 %d %d 255\n" % shades.shape + shades.tobytes())
        done = subprocess.run(["butteraugli_main", *paths], check=True, capture_output=True, text=True)
    return float(done.stdout.split()[-1])


def draco(mesh: TriangleMesh) -> tuple[int, TriangleMesh]:
    import DracoPy

    data = DracoPy.encode(mesh.positions, mesh.faces, quantization_bits=BITS, compression_level=10)
    decoded = DracoPy.decode(data)
    return len(data), TriangleMesh(decoded.points.astype(np.float64), decoded.faces.reshape(-1, 3).astype(np.int32))


def measured(mesh: TriangleMesh, presets: list[str]) -> list[tuple[int, float]]:
    """Bytes and the worst side, of Draco and of each preset."""
    own = drawn(mesh, mesh)
    streams = [encode(mesh, PRESETS[preset]) for preset in presets]
    versions = [draco(mesh), *((len(data), decode(data)) for data in streams)]
    rows = []
    for size, version in versions:
        with ThreadPoolExecutor(2) as pool:
            rows.append((size, max(pool.map(norm, own, drawn(version, mesh)))))
    return rows


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("names", nargs="*")
    parser.add_argument("--presets", nargs="+", choices=PRESETS, default=["balanced", "fine"])
    args = parser.parse_args()
    sources = fetch_meshes(args.folder, print)
    unseen = [s for s in sources if s.group == "unseen" and NAMED[0] < s.vertices < NAMED[1]]
    chosen = [s for s in sources if s.name in args.names] if args.names else unseen[::EVERY]
    found = []
    for source in chosen:
        found.append(measured(source.mesh(), args.presets))
        texts = (f"{size:9,} {seen:6.2f}" for size, seen in found[-1])
        print(f"{source.name:28}", *texts, flush=True)
    table = np.array(found)
    theirs = table[:, 0]
    for at, name in enumerate(args.presets, 1):
        ours = table[:, at]
        above = ours[:, 1] > np.maximum(GOOD_ENOUGH, theirs[:, 1])
        print(
            f"{name}: mean {ours[:, 1].mean():.2f}, Draco's {theirs[:, 1].mean():.2f}; above both {GOOD_ENOUGH} and "
            f"Draco's: {above.sum()} of {len(ours)}; worst {ours[:, 1].max():.2f}; of Draco's bytes "
            f"{(ours[:, 0] / theirs[:, 0]).mean():.3f}"
        )


if __name__ == "__main__":
    main()
