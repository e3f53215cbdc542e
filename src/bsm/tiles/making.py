"""One tile: of the finest level by its triangles, of any other by its eighths, simplified inside of their border."""

from __future__ import annotations

import threading
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import NumericError, TargetError
from bsm.bitstream.extras import imported
from bsm.bitstream.fields.corners import MOST_LARGEST
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.surface_distance import distances_to_surface
from bsm.codec.static.encoder import Encoder
from bsm.codec.static.options import EncodeOptions
from bsm.console import Console
from bsm.files.output import open_output, write_output
from bsm.jobs.report import Facts, Task
from bsm.tiles.cutting import COARSEST, Ints, Places, Plan, load_plan

Faces: TypeAlias = npt.NDArray[np.int32]
_KEPT = 4  # of so many triangles one stays from level to level
_ONE_AT_A_TIME = threading.Lock()  # the library that simplifies keeps its mesh in one place


@dataclass(frozen=True, kw_only=True)
class TileJob(Task):
    """The input is the plan, or the tiles that a coarser one is made of; the output's name is that of the node."""

    most: int = 0
    cell: float = 0.0


def tile_one(job: TileJob, console: Console) -> Facts:
    name, folder = Path(job.output).stem, Path(job.input).parent
    plan = load_plan(folder / "plan.json")
    if name in plan.leaves:
        places, faces, error = *_leaf(plan, name, folder), 0.0
    else:
        places, faces, error = _coarser(plan, name, folder, job.most)
    mesh = TriangleMesh(plan.lattice.positions(places), faces)
    options = EncodeOptions(grid_cell=plan.lattice.cell, grid_origin=plan.lattice.origin, threads=1)  # type: ignore[arg-type]
    data = b"".join(Encoder(mesh, options).result().frames)
    with open_output(folder / f"{name}.npz", overwrite=True) as file:
        np.savez(file, places=places, faces=faces, error=error)
    write_output(job.output, data, overwrite=True)
    ends = {"low": places.min(axis=0).tolist(), "high": places.max(axis=0).tolist()}
    counts = {"vertices": len(places), "faces": len(faces), "apart": error}
    return {"input": job.input, "output": job.output, "output_bytes": len(data), **counts, **ends}


def _leaf(plan: Plan, name: str, folder: Path) -> tuple[Places, Faces]:
    begin, count = plan.leaves[name]
    with (folder / "cut").open("rb") as file:
        file.seek(12 * begin)
        corners = np.fromfile(file, "<u4", 3 * count)
    used, corners = np.unique(corners, return_inverse=True)
    places, numbers = welded(np.memmap(folder / "places", np.int32, "r").reshape(-1, 3)[used])
    return places, numbers[corners].reshape(-1, 3)


def welded(places: npt.NDArray[np.int32]) -> tuple[Places, Faces]:
    """Different places, in order, and which of them each of the given ones is."""
    first, keys = np.unique(keys_of(places), return_index=True, return_inverse=True)[1:]
    return places[first], keys.astype(np.int32)


def keys_of(places: npt.NDArray[np.int32], low: Ints | None = None) -> Ints:
    """A number for each place of a tile, different for different places."""
    shifted = places.astype(np.int64) - (places.min(axis=0) if low is None else low)
    if shifted.max(initial=0) > MOST_LARGEST:
        raise TargetError(
            f"a tile is larger than {MOST_LARGEST} cells, for it has long triangles; choose a larger --grid-cell"
        )
    keys: Ints = (shifted[:, 0] << 40) | (shifted[:, 1] << 20) | shifted[:, 2]
    return keys


def _coarser(plan: Plan, name: str, folder: Path, most: int) -> tuple[Places, Faces, float]:
    """A node by those below it; what others use of it stays where it is."""
    tables, triangles, before, first = [], [], 0.0, 0
    for path in sorted(folder.glob(f"{name}[0-7].npz")):
        with np.load(path) as child:
            tables.append(child["places"])
            triangles.append(child["faces"] + first)
            first, before = first + len(tables[-1]), max(before, float(child["error"]))
    places, numbers = welded(np.concatenate(tables))
    faces = solid(numbers[np.concatenate(triangles)])
    if not len(faces):
        return places, numbers[triangles[0][:1]], before
    locked = plan.outside(name, places)
    outside = np.load(folder / "outside.npy", mmap_mode="r")
    begin, end = plan.ends(name)
    rows = np.array(outside[slice(*np.searchsorted(outside[:, 0], (begin, end)))])
    rows = rows[(rows[:, 4] < begin) | (rows[:, 4] >= end)]
    low = places.min(axis=0).astype(np.int64)
    inside = ((rows[:, 1:4] >= low) & (rows[:, 1:4] <= places.max(axis=0))).all(axis=1)
    locked |= np.isin(keys_of(places, low), keys_of(rows[inside, 1:4], low))
    new, smaller = simplified(places, faces, np.flatnonzero(locked), max(len(faces) // _KEPT, min(COARSEST, most) // 2))
    apart = distances_to_surface(places.astype(np.float64), new.astype(np.float64), smaller)
    return new, smaller, before + float(apart.max()) * plan.lattice.cell


def solid(faces: Faces) -> Faces:
    """Without triangles whose corners are not three."""
    a, b, c = faces.T
    return np.asarray(faces[(a != b) & (b != c) & (c != a)])


def simplifier() -> Any:
    why = "coarser levels need fast-simplification, and --finest goes without"
    return imported("fast_simplification", why, "tiles").simplify


def simplified(places: Places, faces: Faces, locked: Ints, target: int) -> tuple[Places, Faces]:
    """Fewer triangles, about so many; places that are locked, and open borders, stay."""
    if target >= len(faces):
        return places, faces
    # The library keeps borders: each locked vertex gets a triangle that nothing else touches, and so is of one.
    fins = len(places) + np.arange(2 * len(locked), dtype=np.int32).reshape(-1, 2)
    # In a unit that edges have about one of, as its thresholds expect, and that changes no digit.
    low = places.min(axis=0).astype(np.float64)
    points = places - low
    unit = 2.0 ** np.round(np.log2(np.median(np.ptp(points[faces], axis=1).max(axis=1))))
    points /= unit
    beside = np.stack([points[locked] + (1.0, 0.0, 0.0), points[locked] + (0.0, 1.0, 0.0)], axis=1).reshape(-1, 3)
    given = np.concatenate([faces, np.column_stack([locked, fins])]).astype(np.int32)
    with _ONE_AT_A_TIME:
        found, triangles = simplifier()(
            np.concatenate([points, beside]), given, target_count=target + len(locked), preserve_border=True
        )
    kept = triangles[len(triangles) - len(locked) :, 0]
    if not np.array_equal(found[kept], points[locked]):
        raise NumericError("a border has moved while a tile was simplified; please report it")
    triangles = triangles[: len(triangles) - len(locked)]
    new, numbers = welded(np.rint(found * unit + low).astype(np.int32))
    smaller = solid(numbers[triangles])
    used, corners = np.unique(smaller, return_inverse=True)
    return (new[used], corners.reshape(-1, 3).astype(np.int32)) if len(smaller) else (places, faces)
