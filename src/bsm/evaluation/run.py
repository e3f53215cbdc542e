"""Run codecs over meshes and write down every operating point: one JSON file per codec and mesh."""

from __future__ import annotations

import json
import math
import time
from collections.abc import Callable, Iterator
from dataclasses import asdict
from pathlib import Path
from typing import Any

from bsm.bitstream.errors import CorruptError
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.metrics import Reference
from bsm.evaluation.codecs import Codec, Curve
from bsm.evaluation.sample import knot
from bsm.files.output import open_output

SCHEMA = 1
Result = dict[str, Any]
Progress = Callable[[int, int], None]


def measure(codec: Codec, mesh: TriangleMesh, reference: Reference, repeats: int = 1) -> Result:
    """Encode and decode once or more, and say everything that is to be said about it."""
    encode_seconds, coded = _timed(lambda: codec.encode(mesh), repeats)
    decode_seconds, decoded = _timed(lambda: codec.decode(coded.data), repeats)
    comparison = reference.compare(coded.align(decoded))
    parts = asdict(codec.breakdown(coded.data))
    bpv_paper = parts.pop("bpv_paper")
    vertices = len(mesh.positions)
    geometry = parts["coefficients"]
    return {
        "settings": codec.settings,
        "bytes": {**parts, "total": len(coded.data)},
        "bpv_total": 8 * len(coded.data) / vertices,
        "bpv_geometry": None if geometry is None else 8 * geometry / vertices,
        "bpv_paper": bpv_paper,
        # JSON has no infinity; what is lossless has no decibels.
        "nmsve_db": comparison.nmsve_db if math.isfinite(comparison.nmsve_db) else None,
        "theta_deg": comparison.theta_deg,
        "rms_relative": comparison.rms_relative,
        "max_error_relative": comparison.max_error_relative,
        "encode_seconds": encode_seconds,
        "decode_seconds": decode_seconds,
    }


def run_curve(
    curve: Curve, mesh: TriangleMesh, mesh_name: str, repeats: int = 1, progress: Progress | None = None
) -> Result:
    """All operating points of one codec on one mesh."""
    mesh = mesh.without_isolated_vertices()[0]
    reference = Reference(mesh.positions, mesh.faces)
    points = []
    # Loads the compiled kernels, so that no time contains that.
    sample = knot(1_000)
    measure(curve.codecs[0], sample, Reference(sample.positions, sample.faces))
    for number, codec in enumerate(curve.codecs):
        points.append(measure(codec, mesh, reference, repeats))
        if progress:
            progress(number + 1, len(curve.codecs))
    return {
        "schema": SCHEMA,
        "codec": curve.name,
        "label": curve.label,
        "mesh": {"name": mesh_name, "vertices": len(mesh.positions), "faces": len(mesh.faces)},
        "points": points,
    }


def write_result(result: Result, folder: Path, overwrite: bool = True) -> Path:
    """Write one result as ``<mesh>.<codec>.json``."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{result['mesh']['name']}.{result['codec']}.json"
    with open_output(path, overwrite=overwrite) as file:
        file.write(json.dumps(result, indent=1, allow_nan=False).encode())
    return path


def read_results(folder: Path) -> Iterator[Result]:
    """All results in a folder, by mesh and codec."""
    for path in sorted(folder.glob("*.*.json")):
        result = json.loads(path.read_text())
        if result.get("schema") != SCHEMA:
            raise CorruptError(f"{path}: schema {result.get('schema')} is not {SCHEMA}; run the evaluation again")
        yield result


def _timed(work: Callable[[], Any], repeats: int) -> tuple[float, Any]:
    least, result = math.inf, None
    for _ in range(max(1, repeats)):
        start = time.perf_counter()
        result = work()
        least = min(least, time.perf_counter() - start)
    return least, result
