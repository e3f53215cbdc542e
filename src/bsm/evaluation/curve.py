"""Rate against error: codecs run over meshes at several settings, written down as JSON, compared."""

import csv
import io
import json
import math
import re
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, fields
from itertools import cycle
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from bsm.bitstream.errors import CorruptError, FormatError, MeshError, imported
from bsm.bitstream.limits import NAMED_LIMITS
from bsm.codec.arrays import Positions
from bsm.codec.decoding import decode
from bsm.codec.geometry.graph import canonical
from bsm.codec.geometry.mesh import TriangleMesh, require_sizes
from bsm.codec.geometry.metrics import Reference
from bsm.codec.geometry.welding import degenerate
from bsm.codec.static.encoder import Encoder
from bsm.codec.static.options import PRESETS, EncodeOptions, changed
from bsm.codec.static.preamble_encoding import join
from bsm.codec.static.targets import Target
from bsm.evaluation.sample import knot
from bsm.files.inspection import inspect_stream
from bsm.files.output import open_output, write_output
from bsm.files.pipes import as_input
from bsm.ground.console import finite


def encode_draco(mesh: TriangleMesh, position_bits: int, level: int, **more: Any) -> bytes:
    draco, settings = (
        _draco(),
        {"quantization_bits": position_bits, "compression_level": level, **more},
    )
    # DracoPy ends the process on ranges that underflow in single precision, so they are refused here.
    require_sizes(mesh.positions, 1e-30, done="encoded by Draco")  # it crashes with smaller ones
    try:
        return bytes(draco.encode(mesh.positions.astype(np.float32), mesh.faces, **settings))
    except draco.EncodingFailedException as error:
        raise MeshError(f"Draco does not take this mesh: {error}") from error


def decode_draco(data: bytes) -> TriangleMesh:
    decoded = _draco().decode(data)
    return TriangleMesh(decoded.points, decoded.faces)


def positions_in_order(mesh: TriangleMesh, decoded: TriangleMesh, position_bits: int) -> Positions:
    """What Draco made of each vertex of `mesh`, given the mesh that it decoded."""
    # Draco reorders vertices and does not tell how. A number that travels with each of them does.
    numbers = np.arange(len(mesh.positions), dtype=np.uint32)[:, None]
    numbered = _draco().decode(
        encode_draco(mesh, position_bits, 10, generic_attributes={0: numbers})
    )
    original = numbered.get_attribute_by_unique_id(0)["data"].reshape(-1).astype(np.int64)
    points = np.asarray(numbered.points, dtype=np.float64)
    if len(np.unique(original)) != len(mesh.positions):
        raise MeshError("Draco dropped vertices; remove those that no face with area uses")
    if not np.array_equal(
        canonical(original[numbered.faces]), canonical(mesh.faces[~degenerate(mesh.faces)])
    ):
        raise MeshError("Draco's numbered faces are not those of the original")
    # The measured file has no numbers, which would cost bytes. Both are compared to be sure that the order is the same.
    _, identity = np.unique(
        np.concatenate([points, decoded.positions]), axis=0, return_inverse=True
    )
    first, second = identity[: len(points)], identity[len(points) :]
    if not np.array_equal(canonical(first[numbered.faces]), canonical(second[decoded.faces])):
        raise MeshError("Draco decodes to different triangles with and without numbered vertices")
    positions = np.empty_like(mesh.positions)
    positions[original] = points
    return positions


def _draco() -> Any:
    return imported("DracoPy", "Draco needs the package DracoPy", "eval")


Result = dict[str, Any]
Align = Callable[[TriangleMesh], Positions]
"""Maps a decoded mesh to positions in the vertex order of the original."""

SCHEMA = 1
# Small enough for a moment, and large enough for several blocks.
SAMPLE = 1000  # vertices of the mesh by which the time of a line is estimated
PARTS = ("connectivity", "partition", "order", "coefficients", "framing")


@dataclass(frozen=True)
class Spectral:
    """This project's codec; on one thread, so that times compare."""

    options: EncodeOptions

    @property
    def settings(self) -> dict[str, Any]:
        """The options that are not the defaults, and the step where it counts; not what decoders grant."""
        options, defaults = self.options, EncodeOptions()
        given = {
            item.name: getattr(mine, item.name)
            for mine, usual in ((options, defaults), (options.paper, defaults.paper))
            for item in fields(mine)
            if item.name not in ("limits", "paper")
            and getattr(mine, item.name) != getattr(usual, item.name)
        }
        # A target finds its own step, so the step of the options would mislead.
        if options.target is not None:
            return {**given, "target": asdict(options.target)}
        if options.paper.bits:
            return given
        return {"step": options.first_step, **given}

    def encode(self, mesh: TriangleMesh) -> tuple[bytes, Align]:
        """Return a whole file of a mesh all of whose vertices are in faces, and how to find their order again."""
        encoder = Encoder(mesh, self.options)
        data = encoder.encode()
        # A mesh that has kept its order needs no map.
        if self.options.keep_order:
            return data, lambda decoded: decoded.positions
        order = encoder.vertex_index
        return data, lambda decoded: decoded.positions[order]

    def decode(self, data: bytes) -> TriangleMesh:
        return decode(data, NAMED_LIMITS[self.options.limits](), self.options.threads)

    def parts(self, data: bytes) -> dict[str, Any]:
        """Return the bytes of each of `PARTS`, and `bpv_paper`, as far as the format tells."""
        info = inspect_stream(iter([data]))
        paper = None
        if self.options.paper.bits:
            paper = info.bpv_paper
        return {**{part: info.sizes[part] for part in PARTS}, "bpv_paper": paper}


@dataclass(frozen=True)
class Draco:
    """Draco's edgebreaker through DracoPy."""

    position_bits: int
    levels: tuple[int, ...] = (10,)

    @property
    def settings(self) -> dict[str, Any]:
        return {"position_bits": self.position_bits, "levels": list(self.levels)}

    def encode(self, mesh: TriangleMesh) -> tuple[bytes, Align]:
        # The rival gets its best setting, by trying.
        data = min(
            (encode_draco(mesh, self.position_bits, level) for level in self.levels), key=len
        )
        return data, lambda decoded: positions_in_order(mesh, decoded, self.position_bits)

    def decode(self, data: bytes) -> TriangleMesh:
        return decode_draco(data)

    def parts(self, data: bytes) -> dict[str, Any]:
        return dict.fromkeys((*PARTS, "bpv_paper"))


Codec: TypeAlias = Spectral | Draco


@dataclass(frozen=True)
class Curve:
    """A codec at several operating points: one line of a plot, one JSON file per mesh."""

    name: str
    label: str
    codecs: tuple[Codec, ...]


PAPER_KEEPS = (0.05, 0.10, 0.15, 0.20, 0.25)
# eps_h of dynamic orthogonal iterations; eps_l is a tenth less.
PAPER_THRESHOLDS = (0.6, 0.4, 0.3, 0.2, 0.15)
# Every block in its exact basis, as by SVD.
EXACT_BASES: dict[str, Any] = {"key_interval": 1, "key_seed": "svd"}
COLD_STARTS: dict[str, Any] = {"key_interval": 1, "key_seed": "cosines", "key_iterations": 1}
"""Every block by one orthogonal iteration from cosines."""
PAPER_LINES: tuple[tuple[str, str, dict[str, Any]], ...] = (
    ("oi-r1", "OI, R", {"power": 1}),
    ("oi-r1-t2", "OI, R, 2 iterations", {"power": 1, "iterations": 2}),
    ("oi-r1-t3", "OI, R, 3 iterations", {"power": 1, "iterations": 3}),
    ("oi-r2", "OI, R²", {"power": 2}),
    ("oi-r3", "OI, R³", {"power": 3}),
    ("oi-r4", "OI, R⁴", {"power": 4}),
    ("oi-r1-cold", "OI, R, no warm start", COLD_STARTS | {"power": 1}),
    ("oi-r2-cold", "OI, R², no warm start", COLD_STARTS | {"power": 2}),
)
DRACO = Curve(
    "draco",
    "Draco",
    (
        *(Draco(bits, (7, 10)) for bits in range(6, 9)),
        *(Draco(bits, (10,)) for bits in range(9, 15)),
    ),
)
"""Draco at 6 to 14 bits per coordinate; level 10, below nine bits level 7 where it is smaller."""
OUR_TARGETS = {
    "theta_deg": (15.0, 11.0, 8.0, 6.0, 4.0, 3.0, 2.0, 1.2, 0.7, 0.4, 0.2),
    "nmsve_db": (-40.0, -44.0, -48.0, -52.0, -56.0, -60.0, -64.0, -68.0),
}
"""Mean angles of normals in degrees, and NMSVE, that the codec is asked for where no rival has a point nearby."""
NEAR, FAR = 0.25, 2.0
"""Decibels: targets that lie nearer are one; a target of `OUR_TARGETS` is kept if it is farther from all rivals'."""


def paper_options(**changes: Any) -> EncodeOptions:
    """The preset "paper", on one thread and with wide limits, for lines of the paper."""
    return changed(PRESETS["paper"], **{"threads": 1, "limits": "wide", **changes})


def paper_curves(block_size: int) -> tuple[Curve, ...]:
    """The lines of the paper's rate-distortion figure: orthogonal iterations of several kinds, DOI, and SVD last."""

    def line(name: str, label: str, settings: Sequence[dict[str, Any]]) -> Curve:
        return Curve(
            name,
            label,
            tuple(Spectral(paper_options(block_size=block_size, **c)) for c in settings),
        )

    dynamic = [{"power": 1, "doi": (0.9 * threshold, threshold)} for threshold in PAPER_THRESHOLDS]
    every = (*PAPER_LINES, ("svd", "SVD", EXACT_BASES))
    *fixed, svd = (
        line(name, label, [{"keep": keep, **own} for keep in PAPER_KEEPS])
        for name, label, own in every
    )
    return (*fixed, line("doi-r1", "DOI, R", dynamic), svd)


def our_curve(rivals: Iterable[Result] = ()) -> Curve:
    """The codec's choice for the error of each point of rivals, and for others far from these."""
    points = [point for rival in rivals for point in rival["points"]]
    targets = [
        Target(kind, value) for kind in OUR_TARGETS for value in targets_beside(points, kind)
    ]
    options = (EncodeOptions(threads=1, contract=None, target=target) for target in targets)
    return Curve("ours", "ours", tuple(map(Spectral, options)))


def targets_beside(points: Iterable[Result], measure: str) -> list[float]:
    """Errors of points by a measure, nearly equal ones once, and usual ones far from all of them; the largest first."""
    errors = {point[measure] for point in points if point.get(measure) is not None}
    beside = list[float]()
    for value in sorted(errors, reverse=True):
        if _distance(value, beside, measure) > NEAR:
            beside.append(value)
    usual = [value for value in OUR_TARGETS[measure] if _distance(value, beside, measure) > FAR]
    return sorted([*beside, *usual], reverse=True)


def _distance(value: float, others: Iterable[float], measure: str) -> float:
    """Decibels from an error to the nearest of others; 0 if an exact result has none."""
    height = scaled(value, measure)
    if height is None:
        return 0.0
    heights = [own for own in (scaled(other, measure) for other in others) if own is not None]
    return min((abs(height - own) for own in heights), default=math.inf)


# ------------------------------------------------------------------------------------------------------------- running


MEASURED = ("nmsve_db", "nmsve_paper_db", "theta_deg", "rms_relative", "max_error_relative")


def measure(codec: Codec, mesh: TriangleMesh, reference: Reference, repeats: int = 1) -> Result:
    """Encode and decode once or more, and return all measurements."""
    encode_seconds, (data, align) = timed(lambda: codec.encode(mesh), repeats)
    decode_seconds, decoded = timed(lambda: codec.decode(data), repeats)
    errors, parts = asdict(reference.compare(align(decoded))), codec.parts(data)
    bpv_paper, geometry = parts.pop("bpv_paper"), parts["coefficients"]
    vertices = len(mesh.positions)
    bpv_geometry = None
    if geometry is not None:
        bpv_geometry = 8 * geometry / vertices
    return {
        "settings": codec.settings,
        "bytes": {**parts, "total": len(data)},
        "bpv_total": 8 * len(data) / vertices,
        "bpv_geometry": bpv_geometry,
        "bpv_paper": bpv_paper,
        **{name: finite(errors[name]) for name in MEASURED},
        "encode_seconds": encode_seconds,
        "decode_seconds": decode_seconds,
    }


def run_curve(
    curve: Curve,
    mesh: TriangleMesh,
    name: str,
    repeats: int = 1,
    progress: Callable[[int, int], None] | None = None,
    note: Callable[[str], None] | None = None,
) -> Result:
    """Measure a curve; before that, note about how long it will take."""
    # The same mesh for all codecs, or the rates would be per different numbers of vertices.
    mesh = join(mesh, keep=False).mesh  # Draco drops faces without area
    reference = Reference(mesh.positions, mesh.faces)
    # Loads the compiled kernels, so that no time contains that.
    # The first call compiles and loads. It must not be part of any time.
    sample = knot(SAMPLE)
    timed_on = measure(curve.codecs[0], sample, Reference(sample.positions, sample.faces), 2)
    if note:
        seconds = timed_on["encode_seconds"] + timed_on["decode_seconds"]
        expected = seconds * repeats * len(curve.codecs) * max(1.0, len(mesh.positions) / SAMPLE)
        note(f"{name}, {curve.label}: about {max(expected, 1.0):.0f} s")
    points = []
    for codec in curve.codecs:
        points.append(measure(codec, mesh, reference, repeats))
        if progress:
            progress(len(points), len(curve.codecs))
    facts = mesh_facts(mesh, name)
    return {
        "schema": SCHEMA,
        "codec": curve.name,
        "label": curve.label,
        "mesh": facts,
        "points": points,
    }


def mesh_facts(mesh: TriangleMesh, name: str) -> Result:
    """What results say of a mesh; its faces without area are left out, as they are measured."""
    joined = join(mesh, keep=False).mesh
    return {"name": name, "vertices": len(joined.positions), "faces": len(joined.faces)}


def write_result(result: Result, folder: Path) -> Path:
    """Write ``<mesh>.<codec>.json``."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{result['mesh']['name']}.{result['codec']}.json"
    write_output(
        path, json.dumps(result, indent=1, allow_nan=False).encode(), overwrite=True, follow=False
    )
    return path


def read_results(folder: Path) -> Iterator[Result]:
    """Read results of this program, or of others in the same form: `codec`, `label`, `mesh`, `points`."""
    for path in sorted(folder.glob("*.*.json")):
        try:
            result = json.loads(path.read_text())
            # Old results have other meanings for the same names.
            if result.get("schema") != SCHEMA:
                raise CorruptError(
                    f"{path}: schema {result.get('schema')} is not {SCHEMA}; run the evaluation again"
                )
            points = [_POINT | point for point in result["points"]]
            if any(not point["bpv_total"] > 0.0 for point in points):
                raise ValueError("a point without bpv_total")
            _ = title_of(result), result["codec"] + result["label"]
        except CorruptError:
            raise
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            raise FormatError(
                f"{path}: these are not points of a curve: {type(error).__name__}: {error}"
            ) from error
        yield {**result, "points": points}


PRINTED = "nmsve_paper_db"
_POINT: Result = {
    "settings": {},
    "bpv_total": 0.0,
    **dict.fromkeys(("nmsve_db", "theta_deg", PRINTED)),
}
"""The entries of every point; None: it was not measured, or is exact."""


def read_points(path: str, meshes: Mapping[str, Result]) -> list[Result]:
    """Read points of other codecs from CSV: label, bpv, theta_deg or nmsve_db, and mesh if there are several."""
    text = as_input(path).read_all().decode("utf-8-sig", "replace")
    rows = csv.DictReader(io.StringIO(text))
    named = rows.fieldnames or []
    measures = [name for name in MEASURES if name in named]
    if not {"label", "bpv"} <= {*named} or not measures:
        raise FormatError(f"{path}: {_fault_of_columns(text)}")
    usual_mesh = ""
    if len(meshes) == 1:
        (usual_mesh,) = meshes
    found: dict[tuple[str, str], Result] = {}
    for row in rows:
        where = f"{path}: line {rows.line_num}"
        mesh = row.get("mesh") or usual_mesh
        if mesh not in meshes:
            raise FormatError(
                f"{where}: the column mesh must be one of {', '.join(meshes)}, not {mesh!r}"
            )
        try:
            point = (
                _POINT
                | {"bpv_total": float(row["bpv"])}
                | {name: float(row[name]) for name in measures if row[name]}
            )
        except (TypeError, ValueError) as error:
            raise FormatError(
                f"{where}: a number is missing or wrong: {error}; it has a point: 3.5"
            ) from error
        if not point["bpv_total"] > 0.0 or not all(
            math.isfinite(point[name] or 0.0) for name in measures
        ):
            raise FormatError(f"{where}: bits per vertex must be above 0, and errors finite")
        _refuse_impossible_errors(point, where)
        # The name becomes a part of a file name.
        codec = re.sub(r"[^\w-]+", "-", row["label"] or "").strip("-").lower() or "rival"
        if codec in STYLES:
            raise FormatError(
                f"{where}: {row['label']} is a codec that is measured here; give another label"
            )
        begun: Result = {
            "schema": SCHEMA,
            "codec": codec,
            "label": row["label"],
            "mesh": meshes[mesh],
            "points": [],
        }
        found.setdefault((mesh, codec), begun)["points"].append(point)
    return list(found.values())


def _fault_of_columns(text: str) -> str:
    """Say why a text does not have the columns of points."""
    line = text.strip().partition("\n")[0].strip()
    if not line:
        return "the file is empty; its first line must name label, bpv, and theta_deg or nmsve_db"
    if line[0] in "{[<":
        return f"CSV is expected: a first line label,bpv,theta_deg and a line for each point; this begins {line[:40]!r}"
    separator = next((sign for sign in (";", "\t", "|") if sign in line and "," not in line), "")
    if separator:
        return f"its columns must be separated by commas, not by {separator!r}; and write numbers with a point: 3.5"
    return f"its first line must name label, bpv, and theta_deg or nmsve_db; it is {line[:80]!r}"


def _refuse_impossible_errors(point: Mapping[str, Any], where: str) -> None:
    """Refuse errors that no decoded mesh has, such as decibels without their sign."""
    decibels, angle = point["nmsve_db"], point["theta_deg"]
    # At 0 dB, the error is as large as the mesh itself.
    if decibels is not None and decibels > 0.0:
        raise FormatError(
            f"{where}: nmsve_db is {decibels:g}, an error larger than the mesh; lower is better, and meshes that are "
            f"alike are below 0: is it {-decibels:g}?"
        )
    if angle is not None and not 0.0 <= angle <= 180.0:
        raise FormatError(
            f"{where}: theta_deg is {angle:g}; an angle between normals is 0 to 180 degrees"
        )


def timed(
    work: Callable[[], Any], repeats: int, clock: Callable[[], float] = time.perf_counter
) -> tuple[float, Any]:
    """Return the seconds of the fastest of some runs, and the result."""
    runs = []
    for _ in range(max(1, repeats)):
        start, result = clock(), work()
        runs.append(clock() - start)
    # The least of several times: everything that disturbs a measurement makes it longer.
    return min(runs), result


# ----------------------------------------------------------------------------------------------------------- comparing


@dataclass(frozen=True, eq=False)
class RateCurve:
    """Logarithm of the rate as a function of a distortion, between the measured points."""

    distortions: Positions
    log_rates: Positions

    @property
    def interpolated(self) -> Any:
        # Monotone between points, as Bjontegaard's deltas are computed today: his cubic overshoots where points are far
        # apart.
        from scipy.interpolate import PchipInterpolator

        return PchipInterpolator(self.distortions, self.log_rates)

    def rate(self, distortion: float) -> float | None:
        """Bits per vertex; None outside the measured range, or with a single point."""
        if (
            len(self.distortions) < 2
            or not self.distortions[0] <= distortion <= self.distortions[-1]
        ):
            return None
        return float(np.exp(self.interpolated(distortion)))


def rate_curve(rates: Sequence[float], distortions: Sequence[float]) -> RateCurve:
    """Curve through the points that no other point beats in both rate and distortion."""
    kept: dict[float, float] = {}
    least = np.inf
    # From the least distortion up, a point is of use only if it costs less than all before it.
    # A point that costs more and is worse would make the curve fold back.
    for index in np.lexsort((rates, distortions)):
        if rates[index] < least:
            least = rates[index]
            kept.setdefault(distortions[index], math.log(least))
    return RateCurve(np.array(list(kept), np.float64), np.array(list(kept.values()), np.float64))


def rate_curve_of(points: Sequence[Result], measure: str) -> RateCurve:
    """Curve of a result's points: bits of the file against one of `MEASURES`; lossless points are left out."""
    usable = [
        (point["bpv_total"], scaled(point[measure], measure))
        for point in points_of(points, measure)
    ]
    pairs = [(bits, distortion) for bits, distortion in usable if distortion is not None]
    return rate_curve([bits for bits, _ in pairs], [distortion for _, distortion in pairs])


def beaten(points: Sequence[Result], measure: str) -> int:
    """How many points of a line another one beats in both, so that its curve leaves them out."""
    usable = [
        point for point in points_of(points, measure) if scaled(point[measure], measure) is not None
    ]
    return len(usable) - len(rate_curve_of(points, measure).distortions)


def scaled(value: float, measure: str) -> float | None:
    """A distortion on the scale that curves are interpolated over: theta becomes 10 log10(theta)."""
    if measure != "theta_deg":
        return value
    if not value > 0.0:
        return None
    return 10.0 * float(np.log10(value))


def bd_rate(reference: RateCurve, tested: RateCurve) -> float | None:
    """Bjontegaard's average difference of rate at equal distortion, percent, over the range that both curves cover."""
    curves = reference, tested
    if min(len(curve.distortions) for curve in curves) < 2:
        return None
    low, high = (
        max(curve.distortions[0] for curve in curves),
        min(curve.distortions[-1] for curve in curves),
    )
    if not low < high:
        return None
    # Over the logarithm of the rate, so that the mean difference is a ratio.
    areas = [curve.interpolated.integrate(low, high) for curve in curves]
    return float(100.0 * np.expm1((areas[1] - areas[0]) / (high - low)))


def rate_ratio(reference: RateCurve, tested: RateCurve, distortion: float) -> float | None:
    """Bits of `tested` over bits of `reference` at one distortion, None where one of them does not reach it."""
    first, second = reference.rate(distortion), tested.rate(distortion)
    if first is None or second is None:
        return None
    return second / first


def compare_curves(reference: Result, tested: Result) -> Result:
    """One row of a table: one codec against another on one mesh."""
    curves = {
        m: (rate_curve_of(reference["points"], m), rate_curve_of(tested["points"], m))
        for m in MEASURES
    }
    at_angles = {
        f"{a:g}": rate_ratio(*curves["theta_deg"], scaled(a, "theta_deg") or 0.0)
        for a in (7.0, 10.0)
    }
    return {
        "beaten": {m: beaten(tested["points"], m) for m in MEASURES},
        "mesh": tested["mesh"]["name"],
        "codec": tested["codec"],
        "reference": reference["codec"],
        "bd_rate_percent": {name: bd_rate(*pair) for name, pair in curves.items()},
        "bytes_at_theta": at_angles,
    }


def table(columns: Sequence[str], rows: Sequence[Sequence[str]], form: str = "pipe") -> str:
    """A table in a form of `tabulate`, by default Markdown; all columns but the first to the right."""
    sides = ("left", *["right"] * (len(columns) - 1))
    library = imported("tabulate", "tables need tabulate", "eval")
    return str(library.tabulate(rows, columns, form, colalign=sides, disable_numparse=True))


def number(value: float | None, digits: int) -> str:
    return "-" if value is None else f"{value:.{digits}f}"


# ------------------------------------------------------------------------------------------------------------- pictures


FORMATS = ("png", "svg")
PICTURES = (*FORMATS, "pdf")
PAPER_RATE = "bits per vertex of coefficients, 3 q c k / n"
MEASURES = {"nmsve_db": "NMSVE, dB", "theta_deg": "θ, degrees"}
UNITS = {"theta_deg": "°", "nmsve_db": " dB"}
TICKS = (0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50)
STYLES = {
    "ours": ("#d62728", "o"),
    "draco": ("#1f4e9c", "s"),
    "svd": ("#222222", "D"),
    "oi-r1": ("#2a9d55", "^"),
    "oi-r1-t2": ("#67b84b", "v"),
    "oi-r1-t3": ("#9fce63", "<"),
    "oi-r2": ("#e08a1e", "P"),
    "oi-r3": ("#b8860b", "X"),
    "oi-r4": ("#8c6d31", ">"),
    "oi-r1-cold": ("#7b5ea7", "h"),
    "oi-r2-cold": ("#b79bd6", "p"),
    "doi-r1": ("#17a2b8", "*"),
}
"""The color and the marker of each line, in every picture; others take turns."""
OTHERS = (("#e377c2", "d"), ("#7f7f7f", "H"), ("#bcbd22", "8"), ("#000000", "x"), ("#8c564b", "+"))
_LOOK: dict[Any, Any] = {
    **{
        "font.family": "serif",
        "mathtext.fontset": "dejavuserif",
        "font.size": 8,
        "axes.titlesize": 8,
    },
    **{
        "legend.fontsize": 7,
        "legend.frameon": False,
        "axes.spines.top": False,
        "axes.spines.right": False,
    },
    **{
        "axes.linewidth": 0.6,
        "xtick.major.width": 0.6,
        "ytick.major.width": 0.6,
        "grid.linewidth": 0.4,
    },
    **{"lines.linewidth": 1.1, "lines.markersize": 3.2, "pdf.fonttype": 42},
}


class Line(NamedTuple):
    """A line of a plot: its label, and its points of rate and error."""

    label: str
    points: Sequence[tuple[float, float]]


class Picture(NamedTuple):
    """A picture by its name: what draws it on a figure, and its size in inches."""

    name: str
    draw: Callable[[Any], None]
    width: float
    height: float

    def save(
        self,
        folder: Path,
        formats: Sequence[str] = FORMATS,
        *,
        overwrite: bool = True,
        follow: bool = False,
    ) -> list[Path]:
        from matplotlib import rc_context

        folder.mkdir(parents=True, exist_ok=True)
        paths = [folder / f"{self.name}.{suffix}" for suffix in formats]
        with rc_context(_LOOK):
            figure = new_figure(self.width, self.height)
            self.draw(figure)
            for path in paths:
                with open_output(path, overwrite=overwrite, follow=follow) as file:
                    figure.savefig(file, dpi=300, format=path.suffix[1:].lower())
        return paths


def in_a_row(name: str, pictures: Sequence[Picture]) -> Picture:
    """Pictures as one, side by side."""

    def draw(figure: Any) -> None:
        parts = figure.subfigures(
            1, len(pictures), width_ratios=[picture.width for picture in pictures], squeeze=False
        )
        for part, picture in zip(parts.flat, pictures):
            picture.draw(part)

    return Picture(name, draw, sum(p.width for p in pictures), max(p.height for p in pictures))


def draw_rates(
    panels: Mapping[str, Mapping[str, Line]], rate: str, measure: str, name: str, scale: str = "log"
) -> Picture:
    """A panel for each title, with lines by their codecs; `rate` and `measure` label the axes."""
    across = min(len(panels), 3)
    down = -(-len(panels) // across)

    def draw(figure: Any) -> None:
        shown: dict[str, Any] = {}
        grid = figure.subplots(down, across, squeeze=False)
        for axes in grid.flat[len(panels) :]:
            axes.remove()
        for axes, (title, lines) in zip(grid.flat, panels.items()):
            others = cycle(OTHERS)
            for codec, (label, points) in lines.items():
                color, marker = STYLES.get(codec) or next(others)
                shown[label] = axes.plot(*zip(*sorted(points)), marker=marker, color=color)[0]
            rates = [x for _, points in lines.values() for x, _ in points]
            axes.set(xscale=scale, xlabel=rate, title=title)
            if scale == "log":
                axes.set_xticks(TICKS, [f"{tick:g}" for tick in TICKS])
                axes.minorticks_off()
                axes.set_xlim(min(rates) * 0.9, max(rates) * 1.1)
            if "dB" not in measure:
                axes.set_yscale("log")
                axes.yaxis.set_major_formatter("{x:g}")
            axes.grid(alpha=0.3)
        for row in grid:
            row[0].set_ylabel(measure)
        figure.legend(
            shown.values(), shown, loc="outside lower center", ncols=min(len(shown), abreast)
        )

    labels = {line.label for lines in panels.values() for line in lines.values()}
    abreast = across + (max(map(len, labels)) < 40)
    width = 4.2
    if across > 1:
        width = 3.2 * across
    return Picture(name, draw, width, 2.7 * down + 0.13 * (len(labels) // abreast + 2))


def frame_errors(frames: Sequence[Mapping[str, float]], title: str) -> bytes:
    figure = new_figure(7.0, 4.0)
    axes = figure.subplots()
    axes.grid(alpha=0.3)
    for name, label in (
        ("max_error_relative", "largest vertex error"),
        ("rms_relative", "root mean square"),
    ):
        axes.plot([100.0 * frame[name] for frame in frames], lw=1.2, label=label)
    axes.set_ylim(bottom=0.0)
    axes.set(xlabel="frame", ylabel="% of the diagonal", title=title)
    axes.legend(fontsize=8)
    file = io.BytesIO()
    figure.savefig(file, format="png", dpi=150)
    return file.getvalue()


def draw_all(results: Iterable[Result], named: Iterable[str] = ()) -> Iterator[Picture]:
    """Every picture that results allow: the paper's mesh by mesh, of whole files all in one, with lines by name."""
    # A picture of whole files with all lines of the paper would be unreadable.
    chosen = {"svd", "oi-r2", *named}
    by_mesh: dict[str, list[Result]] = {}
    for result in results:
        by_mesh.setdefault(result["mesh"]["name"], []).append(result)
    shown: dict[str, list[Result]] = {}
    for mesh, group in by_mesh.items():
        paper = [r for r in group if r["points"] and "bits" in r["points"][0]["settings"]]
        rest = [r for r in group if r not in paper]
        usable = {r["codec"]: (r["label"], points_of(r["points"], PRINTED)) for r in paper}
        pairs = {
            codec: Line(label + seconds_of(each), [(p["bpv_paper"], p[PRINTED]) for p in each])
            for codec, (label, each) in usable.items()
            if each
        }
        if lines := distinct(pairs):  # as Figure 11 of the paper
            axes = PAPER_RATE, "NMSVE as printed, dB"
            yield draw_rates({title_of(group[0]): lines}, *axes, f"{mesh}.paper", "linear")
        if rest:  # SVD in the paper's mode represents the paper among whole files.
            shown[mesh] = [*rest, *(r for r in paper if r["codec"] in chosen)]
    if shown:
        yield from _draw_whole_files(shown)


def _draw_whole_files(shown: Mapping[str, Sequence[Result]]) -> Iterator[Picture]:
    """A picture of each measure, with all meshes beside each other."""
    stem = "meshes"
    if len(shown) == 1:
        (stem,) = shown
    for measure, label in MEASURES.items():
        every = {title_of(group[0]): lines_of(group, measure) for group in shown.values()}
        if panels := {title: lines for title, lines in every.items() if lines}:
            yield draw_rates(
                panels, "bits per vertex, whole file", label, f"{stem}.{measure.split('_')[0]}"
            )


SAME = 0.02
"""Decibels and bits per vertex within which points count as equal."""


def distinct(lines: Mapping[str, Line]) -> dict[str, Line]:
    """The lines without those that lie on an earlier one, which takes their labels."""
    kept: dict[str, Line] = {}
    for codec, line in lines.items():
        for name, (label, points) in kept.items():
            if (
                len(points) == len(line.points)
                and np.abs(np.subtract(points, line.points)).max() <= SAME
            ):
                kept[name] = Line(f"{label} = {line.label}", points)
                break
        else:
            kept[codec] = line
    return kept


def lines_of(results: Sequence[Result], measure: str) -> dict[str, Line]:
    """The lines of one mesh for one of `MEASURES`, by codec; labels tell the range of targets, where there are any."""
    lines = {}
    for result in sorted(
        results, key=lambda result: [*STYLES, result["codec"]].index(result["codec"])
    ):
        points = points_of(result["points"], measure)
        targets = [p["settings"]["target"]["value"] for p in points if "target" in p["settings"]]
        asked = ""
        if targets:
            asked = f", asked for {targets[0]:.4g} to {targets[-1]:.4g}{UNITS[measure]}"
        if points:
            pairs = [(point["bpv_total"], point[measure]) for point in points]
            lines[result["codec"]] = Line(result["label"] + asked, pairs)
    return lines


def points_of(points: Sequence[Result], measure: str) -> list[Result]:
    """The points of a line of one of `MEASURES`: not those that were chosen for another, nor lossless ones."""
    kinds = [point.get("settings", {}).get("target", {}).get("kind", measure) for point in points]
    return [
        p
        for p, kind in zip(points, kinds, strict=True)
        if kind == measure and p[measure] is not None
    ]


def seconds_of(points: Sequence[Result]) -> str:
    """The times that encoding took, in words."""
    times = sorted(
        {f"{point['encode_seconds']:.2g}" for point in points if point.get("encode_seconds")},
        key=float,
    )
    if not times:
        return ""
    return f" ({' to '.join(times[:: max(1, len(times) - 1)])} s)"


def title_of(result: Result) -> str:
    return "{name}, {vertices:,} vertices".format_map(result["mesh"])


def new_figure(width: float, height: float) -> Any:
    imported("matplotlib", "pictures need matplotlib", "eval")
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained")
