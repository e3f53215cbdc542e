"""One tile: of the finest level by its triangles, of any other by its eighths, simplified inside of their border."""

from __future__ import annotations

import threading
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
from scipy.spatial import KDTree

from bsm.bitstream.errors import NumericError, TargetError, imported
from bsm.bitstream.fields.corners import MOST_LARGEST
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.metrics import farthest_from_surface
from bsm.codec.static.encoder import Encoder
from bsm.codec.static.options import EncodeOptions
from bsm.console import Console
from bsm.files.formats.npz import write_npy
from bsm.files.output import open_output, write_output
from bsm.jobs.run import Facts, Task
from bsm.tiles.cutting import COARSEST, Ints, Places, Plan, load_plan
from bsm.tiles.reading import mapped

Faces: TypeAlias = npt.NDArray[np.int32]
_KEPT = 4  # of so many triangles one stays from level to level
_SAMPLE = 10_000
_ONE_AT_A_TIME = threading.Lock()  # the library that simplifies keeps its mesh in one place


@dataclass(frozen=True, kw_only=True)
class TileJob(Task):
    """The input is the plan, or the tiles that a coarser one is made of; the output's name is that of the node."""

    most: int = 0
    cell: float = 0.0
    finest: bool = False


def tile_one(job: TileJob, console: Console) -> Facts:
    name, folder = Path(job.output).stem, Path(job.input).parent
    plan = load_plan(folder / "plan.json")
    if name in plan.leaves:
        mesh, error = _leaf(plan, name, folder), 0.0
    else:
        mesh, error = _coarser(plan, name, folder, job.most)
    places = np.asarray(mesh.positions, np.int32)
    if not job.finest:
        with open_output(folder / f"{name}.mesh", overwrite=True) as file:
            for table in (np.array(error), places, mesh.faces, *(_of_vertices(one, mesh) for one in mesh.attributes)):
                write_npy(file, table)
    options = EncodeOptions(grid_cell=plan.lattice.cell, grid_origin=plan.lattice.origin, threads=1)  # type: ignore[arg-type]
    data = Encoder(replace(mesh, positions=plan.lattice.positions(places)), options).encode()
    write_output(job.output, data, overwrite=True)
    ends = {"low": places.min(axis=0).tolist(), "high": places.max(axis=0).tolist()}
    counts = {"vertices": len(places), "faces": len(mesh.faces), "apart": error}
    return {"input": job.input, "output": job.output, "output_bytes": len(data), **counts, **ends}


def _leaf(plan: Plan, name: str, folder: Path) -> TriangleMesh:
    """A tile in cells of the lattice; where vertices at one place differ in colour or normal, so do corners."""
    begin, count = plan.leaves[name]
    used, corners = np.unique(mapped(folder, "cut", plan.kinds)[begin : begin + count], return_inverse=True)
    corners = corners.reshape(-1, 3)
    places, numbers = welded(mapped(folder, "places", plan.kinds)[used])
    some = np.empty(len(places), np.int64)
    some[numbers[::-1]] = np.arange(len(numbers))[::-1]

    def carried(what: Any) -> Attribute:
        values = mapped(folder, what, plan.kinds)[used]
        if np.array_equal(values[some][numbers], values):
            return Attribute(what, values[some], "vertex", what)
        different, rows = np.unique(values, axis=0, return_inverse=True)
        return Attribute(what, different, "corner", what, rows.reshape(-1)[corners].astype(np.int32))

    return TriangleMesh(places.astype(np.float64), numbers[corners], tuple(map(carried, plan.carried)))


def _of_vertices(one: Attribute, mesh: TriangleMesh) -> npt.NDArray[Any]:
    """One value for each vertex."""
    if one.indices is None:
        return one.values
    found = np.zeros((len(mesh.positions), one.components), one.values.dtype)
    found[mesh.faces[::-1]] = one.values[one.indices[::-1]]
    return found


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


def _coarser(plan: Plan, name: str, folder: Path, most: int) -> tuple[TriangleMesh, float]:
    """A node by those below it; what others use of it stays where it is."""
    children, before, first = [], 0.0, 0
    for path in sorted(folder.glob(f"{name}[0-7].mesh")):
        with path.open("rb") as file:
            before = max(before, float(np.load(file)))
            places, faces, *values = (np.load(file) for _ in range(2 + len(plan.carried)))
        children.append((places, faces + first, *values))
        first += len(places)
    together, corners, *tables = map(np.concatenate, zip(*children))
    del children, places, faces, values  # as large as all else
    places, numbers = welded(together)
    some = np.empty(len(places), np.int64)
    some[numbers[::-1]] = np.arange(len(numbers))[::-1]

    def carried(near: Ints) -> tuple[Attribute, ...]:
        return tuple(
            Attribute(what, table[some[near]], "vertex", what)  # type: ignore[arg-type]
            for what, table in zip(plan.carried, tables)
        )

    faces, one = solid(numbers[corners]), numbers[corners[:1]]
    del together, corners, numbers
    if not len(faces):
        return TriangleMesh(places.astype(np.float64), one, carried(np.arange(len(places)))), before
    locked = plan.outside(name, places)
    outside = mapped(folder, "outside", plan.kinds)
    begin, end = plan.ends(name)
    rows = np.array(outside[slice(*np.searchsorted(outside[:, 0], (begin, end)))])
    rows = rows[(rows[:, 4] < begin) | (rows[:, 4] >= end)]
    low = places.min(axis=0).astype(np.int64)
    inside = ((rows[:, 1:4] >= low) & (rows[:, 1:4] <= places.max(axis=0))).all(axis=1)
    locked |= np.isin(keys_of(places, low), keys_of(rows[inside, 1:4], low))
    new, smaller = simplified(places, faces, np.flatnonzero(locked), max(len(faces) // _KEPT, min(COARSEST, most) // 2))
    # In the order of a curve consecutive places are near each other.
    order = np.argsort(plan.codes(places), kind="stable")
    apart = farthest_from_surface(places[order].astype(np.float64), new.astype(np.float64), smaller)
    near = KDTree(places).query(new)[1] if tables else np.zeros(0, np.int64)
    return TriangleMesh(new.astype(np.float64), smaller, carried(near)), before + apart * plan.lattice.cell


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
    some = points[faces[:: 1 + len(faces) // _SAMPLE]]
    unit = 2.0 ** np.round(np.log2(np.median(np.ptp(some, axis=1).max(axis=1))))
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
