"""Random meshes and attributes by bsmenc, compiled with sanitizers: each call succeeds, or says what was asked wrongly.

LD_PRELOAD="$(cc -print-file-name=libasan.so) $(cc -print-file-name=libubsan.so)" ASAN_OPTIONS=detect_leaks=0 \\
    python -m tools.attack meshes --seconds N [--seed S]
"""

import time
from collections import Counter
from typing import Any

import numpy as np

from bsm import Attribute, TriangleMesh
from tools.bsmenc import CELLS, LOSSLESS, QUALITIES, UNREACHABLE, encode, library
from tools.command import parser_of

SANITIZED = ("-g1", "-fsanitize=address,undefined", "-fno-sanitize-recover=all")
MISUSED = 2
KINDS = ("uint8", "int8", "uint16", "int16", "uint32", "int32", "float32", "float64")


def attribute(rng: np.random.Generator, name: str, rows: dict[str, int]) -> Attribute:
    """Few or many different values, of any size."""
    domain: Any = str(rng.choice(list(rows)))
    semantic: Any = str(rng.choice(["generic", "color", "normal", "texcoord"]))
    kind = np.dtype(str(rng.choice(KINDS)))
    shape = (
        rows[domain],
        int(rng.integers(1, 5))
        if rng.random() < 0.5
        else {"normal": 3, "texcoord": 2}.get(semantic, 4),
    )
    values: Any = rng.standard_normal(shape) * 10.0 ** rng.integers(-30, 30)
    if kind.kind != "f":
        info = np.iinfo(kind)
        values = rng.integers(info.min, info.max, shape, np.int64, endpoint=True)
    if rng.random() < 0.6:
        values = values[rng.integers(0, min(3, len(values)), len(values))]
    return Attribute(name, np.ascontiguousarray(values.astype(kind)), domain, semantic)


def mesh_of(rng: np.random.Generator) -> TriangleMesh:
    vertices, faces = int(rng.integers(3, 50)), int(rng.integers(1, 90))
    positions = rng.standard_normal((vertices, 3)) * 10.0 ** rng.integers(-20, 20)
    if rng.random() < 0.5:
        positions = rng.integers(0, 4, (vertices, 3)) / 4.0
    positions[rng.random(vertices) < 0.2] = positions[0]
    rows = {"vertex": vertices, "corner": 3 * faces, "face": faces}
    attributes = [attribute(rng, f"a{i}", rows) for i in range(int(rng.integers(0, 4)))]
    corners = rng.integers(0, vertices, (faces, 3)).astype(np.int32)
    return TriangleMesh(positions, corners, tuple(attributes))


def main(argv: list[str] | None = None) -> int:
    parser = parser_of(__doc__)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args(argv)
    encoder, counts, end, seed = (
        library(*SANITIZED),
        Counter[int](),
        time.monotonic() + args.seconds,
        args.seed,
    )
    while time.monotonic() < end:
        rng = np.random.default_rng(seed)
        mesh = mesh_of(rng)
        amount = float(rng.choice([1.0, 8.0, 12.0, 1e-3, 50.0]))
        qualities = {
            a.name: (str(rng.choice(QUALITIES)), amount)
            for a in mesh.attributes
            if rng.random() < 0.5
        }
        positions, keep = int(rng.choice([0, CELLS, LOSSLESS])), int(rng.integers(2))
        options = {"cell": 10.0 ** float(rng.integers(-3, 1))} if positions == CELLS else {}
        if positions == 0:
            options = {"bits": int(rng.integers(0, 21)), "quick": int(rng.integers(2))}
        result = encode(encoder, mesh, qualities, positions=positions, keep_order=keep, **options)
        counts[result.status] += 1
        has_requests = bool(qualities) or positions == CELLS  # what a mesh may not be able to keep
        if result.status not in (
            0,
            UNREACHABLE if positions or qualities else 0,
            MISUSED if has_requests else 0,
        ):
            print(f"seed {seed}: status {result.status}: {result.message}")
            return 1
        seed += 1
    print(
        f"{sum(counts.values())} meshes from seed {args.seed} on, without a finding: {dict(counts)}"
    )
    return 0
