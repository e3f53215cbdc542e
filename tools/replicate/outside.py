"""Bytes at equal SSIMULACRA2, Butteraugli and FLIP of photographs, and how steady these are at the default."""

import shutil
import subprocess
import tempfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from bsm.bitstream.errors import BsmError
from bsm.codec.arrays import Positions
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.look.measure import look
from tools.replicate.fetch import Source
from tools.replicate.pictures import SAMPLES, Gallery, Photograph
from tools.replicate.rates import DRACO_BITS, Row, codecs, ratios, spread

SCORES = {"SSIMULACRA2": "100 - SSIMULACRA2", "Butteraugli": "Butteraugli, 3-norm", "FLIP": "FLIP"}
BESIDE, MARGIN, DEGREE = 11, 16, 33.5
"""Draco's bits, beside which the default's spread stands; margin of a cut in pixels; pixels per degree for FLIP."""
SEEN = (500, 25_000)
"""Meshes of which photographs are taken, by how many vertices they have: fetched ones."""
PHOTOGRAPHED = "Three views of 1,080 pixels that our look does not use: three lights, gloss, creases of 30 degrees."
# The least distance of a default that its look limits; other promises limit smaller ones.
NEAR = 0.85
SPREAD = ("what", "by", "meshes", "mean", "median", "standard deviation", "worst", "its mesh")


def measure_outside(source: Source) -> Row:
    """The default, and Draco's files around it by every score."""
    mesh, every, points = source.mesh(), codecs(), {}
    facts = {
        "mesh": source.name,
        "group": source.group,
        "vertices": len(mesh.positions),
        "faces": len(mesh.faces),
    }
    try:
        viewer = Viewer(mesh)
        waiting = ["default", f"Draco {BESIDE}"]
        while waiting:
            data, align = every[name := waiting.pop(0)].encode(mesh)
            positions = align(every[name].decode(data))
            distance = look(mesh, TriangleMesh(positions, mesh.faces)).distance
            points[name] = {"bytes": len(data), "look": distance, **viewer.scores(positions)}
            waiting = waiting or missing(points)
    except BsmError as error:
        return {**facts, "points": {}, "failed": {"all": str(error)}}
    return {**facts, "points": points, "failed": {}}


def missing(points: dict[str, dict[str, float]]) -> list[str]:
    """Draco's next file, if the default is not yet between two of them by every score."""
    ours = points["default"]
    bits = sorted(count for count in DRACO_BITS if f"Draco {count}" in points)
    for step, at in ((1, bits[-1]), (-1, bits[0])):
        beyond = any(
            step * (points[f"Draco {at}"][score] - ours[score]) > 0.0
            for score in SCORES
            if score in ours
        )
        if beyond and at + step in DRACO_BITS:
            return [f"Draco {at + step}"]
    return []


class Viewer:
    """Photographs of an original, and what each score says of decoded versions; less is better."""

    def __init__(self, mesh: TriangleMesh) -> None:
        self._gallery = Gallery(mesh)
        whole = self._gallery.photographs(mesh.positions)
        self._frames = [frame(picture) for picture in whole]
        self._originals = [picture[at] for picture, at in zip(whole, self._frames, strict=True)]

    def scores(self, positions: Positions) -> dict[str, float]:
        """Means over the views, by the names of `SCORES`."""
        drawn = zip(
            self._originals, self._gallery.photographs(positions), self._frames, strict=True
        )
        found = [compare(original, decoded[at]) for original, decoded, at in drawn]
        return {name: float(np.mean([scores[name] for scores in found])) for name in found[0]}


def frame(picture: Photograph) -> tuple[slice, slice]:
    """Return the rows and columns that the mesh covers, with a margin."""
    shown = np.abs(picture.astype(int) - picture[0, 0]).sum(axis=2) > 6
    ends = [np.flatnonzero(shown.any(axis=axis))[[0, -1]] for axis in (1, 0)]
    rows, columns = (slice(max(0, low - MARGIN), high + MARGIN + 1) for low, high in ends)
    return rows, columns


def compare(first: Photograph, second: Photograph) -> dict[str, float]:
    """Scores of one pair; Butteraugli only where Debian's libjxl-devtools is installed."""
    import flip_evaluator
    from ssimulacra2 import compute_ssimulacra2

    with tempfile.TemporaryDirectory() as folder:
        paths = [str(Path(folder) / name) for name in ("first.ppm", "second.ppm")]
        for path, picture in zip(paths, (first, second), strict=True):
            head = b"P6 %d %d 255\n" % picture.shape[1::-1]
            Path(path).write_bytes(head + picture.tobytes())
        found = {"SSIMULACRA2": 100.0 - compute_ssimulacra2(*paths)}
        if shutil.which("butteraugli_main"):
            done = subprocess.run(
                ["butteraugli_main", *paths], check=True, capture_output=True, text=True
            )
            found["Butteraugli"] = float(done.stdout.split()[-1])
    flip = flip_evaluator.evaluate(
        halved(first), halved(second), "LDR", applyMagma=False, parameters={"ppd": DEGREE}
    )
    return found | {"FLIP": float(flip[1])}


def halved(picture: Photograph) -> np.ndarray[tuple[int, ...], np.dtype[np.float32]]:
    """Half as many pixels a side, 0 to 1."""
    rows, columns = (side // SAMPLES for side in picture.shape[:2])
    squares = picture[: rows * SAMPLES, : columns * SAMPLES].reshape(
        rows, SAMPLES, columns, SAMPLES, 3
    )
    return np.ascontiguousarray(squares.mean(axis=(1, 3), dtype=np.float32) / 255.0)


def outside_table(rows: Sequence[Row]) -> list[tuple[str, ...]]:
    """Bytes of the default over Draco's at equal scores, in the columns of rates."""
    found = []
    for score, label in SCORES.items():
        values = [
            (entry["default"], row["mesh"])
            for row in rows
            if "default" in (entry := ratios(row, score))
        ]
        if values:
            found.append(spread("default", label, values))
    return found


def steadiness_table(rows: Sequence[Row]) -> list[tuple[str, ...]]:
    """How much scores differ between meshes, in `SPREAD`."""
    found = []
    for what, least in (
        ("default", 0.0),
        (f"default, look of {NEAR} to 1", NEAR),
        (f"Draco {BESIDE}", 0.0),
    ):
        name = what.partition(",")[0]
        points = [(row["points"][name], row["mesh"]) for row in rows if name in row["points"]]
        for score, label in SCORES.items():
            pairs = [
                (point[score], mesh)
                for point, mesh in points
                if score in point and point["look"] >= least
            ]
            if pairs:
                values, digits = (
                    np.array([value for value, _ in pairs]),
                    4 if score == "FLIP" else 2,
                )
                numbers = values.mean(), np.median(values), values.std(), values.max()
                cells = (f"{number:.{digits}f}" for number in numbers)
                found.append((what, label, str(len(pairs)), *cells, max(pairs)[1]))
    return found
