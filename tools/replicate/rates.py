"""Bytes at equal quality: ours, Draco and meshoptimizer on one mesh, and what tables say over all of them."""

import json
import math
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from bsm.bitstream.errors import BsmError
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.encoding.options import encode_options
from bsm.evaluation.curve import Draco, RateCurve, Spectral, bd_rate, rate_curve
from tools.replicate.fetch import Source
from tools.replicate.measures import MEASURES, Judge

PRESETS: dict[str, dict[str, Any]] = {
    "default": {},
    "fine": {"preset": "fine"},
    "near-lossless": {"preset": "near-lossless"},
    "small": {"preset": "small"},
    "grid14": {"preset": "grid14"},
    "quick": {"effort": "quick"},
}
CURVE = ("small", "default", "fine", "near-lossless")
"""The presets whose bytes and qualities are our line where lines are compared."""
DRACO_BITS = range(7, 15)
MESHOPT_BITS = (12, 14)
TIMED = ("default", "fine", "quick")
Row = dict[str, Any]


def codecs() -> dict[str, Any]:
    """Each of ours and of Draco's, by its name in tables."""
    ours = {name: Spectral(encode_options(threads=1, **words)) for name, words in PRESETS.items()}
    return ours | {f"Draco {bits}": Draco(bits) for bits in DRACO_BITS}


def measure_mesh(source: Source, meshopt: Path | None) -> Row:
    """Every point of one mesh; a codec that does not take it is named."""
    mesh, points, failed = source.mesh(), {}, {}
    facts = {
        "mesh": source.name,
        "group": source.group,
        "vertices": len(mesh.positions),
        "faces": len(mesh.faces),
    }
    try:
        judge = Judge(mesh)
    except BsmError as error:
        return {**facts, "points": {}, "failed": {"all": str(error)}}
    for name, codec in codecs().items():
        try:
            data, align = codec.encode(mesh)
            positions = align(codec.decode(data))
        except BsmError as error:
            failed[name] = str(error)
            continue
        points[name] = {"bytes": len(data), **judge.measures(positions)}
    for bits, (size, positions) in meshopt_points(mesh, meshopt).items() if meshopt else ():
        points[f"meshoptimizer {bits}"] = {
            "bytes": size["gzip"],
            **size,
            **judge.measures(positions),
        }
    return {**facts, "points": points, "failed": failed}


def meshopt_points(mesh: TriangleMesh, package: Path) -> dict[int, tuple[Row, Any]]:
    """Sizes and times of meshoptimizer's buffers, and positions, in cubes of 2^bits places: by `MESHOPT_BITS`."""
    low, extent = mesh.positions.min(axis=0), float(np.ptp(mesh.positions, axis=0).max())
    placed = {
        bits: np.rint((mesh.positions - low) / extent * (2**bits - 1)) for bits in MESHOPT_BITS
    }
    with tempfile.NamedTemporaryFile() as file:
        file.write(np.array([len(mesh.positions), len(mesh.faces)], np.uint32).tobytes())
        file.write(mesh.faces.astype(np.uint32).tobytes())
        for positions in placed.values():
            file.write(np.pad(positions, ((0, 0), (0, 1))).astype(np.uint16).tobytes())
        file.flush()
        script = str(Path(__file__).with_name("meshopt.mjs"))
        words = ["node", script, str(package), file.name, *map(str, MESHOPT_BITS)]
        sizes = json.loads(
            subprocess.run(words, check=True, capture_output=True, timeout=300).stdout
        )
    return {
        b: (size, low + placed[b] * extent / (2**b - 1))
        for b, size in zip(MESHOPT_BITS, sizes, strict=True)
    }


def time_mesh(source: Source, rounds: int = 3) -> Row:
    """Processor seconds of one thread, the least of some rounds by turns."""
    mesh = source.mesh()
    chosen = {name: codec for name, codec in codecs().items() if name in (*TIMED, "Draco 11")}
    works: dict[str, Callable[[], Any]] = {}
    for name, codec in chosen.items():
        data = codec.encode(mesh)[0]
        works[f"{name}, encode"] = partial(codec.encode, mesh)
        works[f"{name}, decode"] = partial(codec.decode, data)
    seconds = by_turns(works, rounds)
    return {
        "mesh": source.name,
        "group": source.group,
        "vertices": len(mesh.positions),
        "seconds": seconds,
    }


def by_turns(works: dict[str, Callable[[], Any]], rounds: int = 3) -> dict[str, float]:
    """Processor seconds of each, the least of some rounds."""
    seconds = dict.fromkeys(works, math.inf)
    for _ in range(rounds):
        for name, work in works.items():
            begin, runs = time.process_time(), 0
            while runs == 0 or time.process_time() - begin < 0.02:
                work()
                runs += 1
            seconds[name] = min(seconds[name], (time.process_time() - begin) / runs)
    return seconds


def curve_of(row: Row, names: Iterable[str], measure: str) -> RateCurve:
    """Bytes over the logarithm of a measure, of the points that are there."""
    points = [row["points"][name] for name in names if name in row["points"]]
    pairs = [
        (p["bytes"], 10 * math.log10(p[measure])) for p in points if p.get(measure, 0.0) > 1e-12
    ]
    return rate_curve([size for size, _ in pairs], [value for _, value in pairs])


def ratios(row: Row, measure: str) -> dict[str, float]:
    """Bytes over Draco's at equal quality by one measure: of points between two of Draco's, and of our line."""
    draco = curve_of(row, (f"Draco {bits}" for bits in DRACO_BITS), measure)
    found = {}
    for name in (*PRESETS, *(f"meshoptimizer {bits}" for bits in MESHOPT_BITS)):
        point = row["points"].get(name)
        if point and point.get(measure, 0.0) > 1e-12:
            rival = draco.rate(10 * math.log10(point[measure]))
            if rival is not None:
                found[name] = point["bytes"] / rival
    rate = bd_rate(draco, curve_of(row, CURVE, measure))
    return found | ({} if rate is None else {"BD-rate": 1.0 + rate / 100.0})


COLUMNS = ("what", "by", "meshes", "mean", "quartile", "median", "quartile", "worst", "its mesh")


def summary(rows: Sequence[Row]) -> list[tuple[str, ...]]:
    """The lines of a table, in `COLUMNS`: for each of ours and meshoptimizer's, and each measure."""
    each = {measure: [(ratios(row, measure), row["mesh"]) for row in rows] for measure in MEASURES}
    what = ("BD-rate", *PRESETS, *(f"meshoptimizer {bits}" for bits in MESHOPT_BITS))
    found = []
    for name in what:
        for measure, label in MEASURES.items():
            values = [(result[name], mesh) for result, mesh in each[measure] if name in result]
            if values:
                found.append(spread(name, label, values))
    return found


def spread(name: str, label: str, values: Sequence[tuple[float, str]]) -> tuple[str, ...]:
    """A line: how many, mean, quartiles and median, and the largest with its mesh."""
    numbers = np.array([value for value, _ in values])
    low, middle, high = np.quantile(numbers, (0.25, 0.5, 0.75))
    cells = (f"{value:.3f}" for value in (numbers.mean(), low, middle, high, numbers.max()))
    return name, label, str(len(values)), *cells, max(values)[1]


def time_summary(rows: Sequence[Row]) -> list[tuple[str, ...]]:
    """Times over Draco's, 11 bits, in the same columns."""
    found = []
    for name in TIMED:
        for work in ("encode", "decode"):
            values = [
                (
                    row["seconds"][f"{name}, {work}"] / row["seconds"][f"Draco 11, {work}"],
                    row["mesh"],
                )
                for row in rows
            ]
            found.append(spread(name, f"time to {work}", values))
    return found
