"""One tile: of the finest level by its triangles, of any other by its eighths, simplified inside of their border."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from bsm.bitstream.container.header import MOST_GRID
from bsm.bitstream.errors import TargetError
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.metrics import farthest_from_surface
from bsm.codec.geometry.welding import degenerate
from bsm.codec.static.encoder import Encoder
from bsm.codec.static.options import EncodeOptions
from bsm.console import Console
from bsm.files.formats.npz import write_npy
from bsm.files.output import open_output, write_output
from bsm.jobs.task import Facts, Task
from bsm.simplification import collapsed, compact
from bsm.tiles.cutting import COARSEST, Ints, Places, Plan, along_curve, load_plan
from bsm.tiles.reading import mapped

Faces: TypeAlias = npt.NDArray[np.int32]
_KEPT = 4  # one of this many triangles stays from level to level


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
        (mesh, joined), error = _leaf(plan, name, folder), 0.0
    else:
        (mesh, error), joined = _coarser(plan, name, folder, job.most), 0
    places = np.asarray(mesh.positions, np.int32)
    if not job.finest:
        with open_output(folder / f"{name}.mesh", overwrite=True, follow=False) as file:
            for table in (np.array(error), places, mesh.faces, *(_of_vertices(a, mesh) for a in mesh.attributes)):
                write_npy(file, table)
    options = EncodeOptions(grid_cell=plan.lattice.cell, grid_origin=plan.lattice.origin, threads=1)  # type: ignore[arg-type]
    data = Encoder(replace(mesh, positions=plan.lattice.positions(places)), options).encode()
    write_output(job.output, data, overwrite=True, follow=False)
    ends = {"low": places.min(axis=0).tolist(), "high": places.max(axis=0).tolist()}
    counts = {"vertices": len(places), "faces": len(mesh.faces), "apart": error, "joined": joined}
    return {"input": job.input, "output": job.output, "output_bytes": len(data), **counts, **ends}


def _leaf(plan: Plan, name: str, folder: Path) -> tuple[TriangleMesh, int]:
    """A tile in cells of the lattice, and how many positions share a place; corners there may differ."""
    begin, count = plan.leaves[name]
    used, corners = np.unique(mapped(folder, "cut", plan.kinds)[begin : begin + count], return_inverse=True)
    corners = corners.reshape(-1, 3)
    places, numbers, some = welded(mapped(folder, "places", plan.kinds)[used])
    inside = ~plan.outside(name, places)
    own = mapped(folder, "own", plan.kinds)[used, 0].astype(np.int64) | numbers.astype(np.int64) << 32
    joined = len(np.unique(own[inside[numbers]])) - int(inside.sum())

    def carried(what: Any) -> Attribute:
        values = mapped(folder, what, plan.kinds)[used]
        if np.array_equal(values[some][numbers], values):
            return Attribute(what, values[some], "vertex", what)
        different, rows = np.unique(values, axis=0, return_inverse=True)
        return Attribute(what, different, "corner", what, rows.reshape(-1)[corners].astype(np.int32))

    return TriangleMesh(places.astype(np.float64), numbers[corners], tuple(map(carried, plan.carried))), joined


def _of_vertices(attribute: Attribute, mesh: TriangleMesh) -> npt.NDArray[Any]:
    """One value for each vertex."""
    if attribute.indices is None:
        return attribute.values
    found = np.zeros((len(mesh.positions), attribute.components), attribute.values.dtype)
    found[mesh.faces[::-1]] = attribute.values[attribute.indices[::-1]]
    return found


def welded(places: npt.NDArray[np.int32]) -> tuple[Places, Faces, Ints]:
    """Different places, along a curve, which of them each of the given ones is, and which given one each is first."""
    first, keys = np.unique(keys_of(places), return_index=True, return_inverse=True)[1:]
    return places[first], keys.astype(np.int32), first


def keys_of(places: npt.NDArray[np.int32], low: Ints | None = None) -> Ints:
    """A number for each place of a tile, different for different places."""
    shifted = places.astype(np.int64) - (places.min(axis=0) if low is None else low)
    if shifted.max(initial=0) > MOST_GRID:
        raise TargetError(
            f"a tile is larger than {MOST_GRID} cells, for it has long triangles; choose a larger --grid-cell"
        )
    return along_curve(shifted)


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
    places, numbers, some = welded(together)

    def carried(near: Ints) -> tuple[Attribute, ...]:
        return tuple(
            Attribute(what, table[some[near]], "vertex", what)  # type: ignore[arg-type]
            for what, table in zip(plan.carried, tables)
        )

    faces = numbers[corners]
    del together, corners, numbers
    if (empty := degenerate(faces)).all():
        return TriangleMesh(places.astype(np.float64), faces[:1], carried(np.arange(len(places)))), before
    faces = faces[~empty]
    locked = plan.outside(name, places)
    outside = mapped(folder, "outside", plan.kinds)
    begin, end = plan.ends(name)
    rows = np.array(outside[slice(*np.searchsorted(outside[:, 0], (begin, end)))])
    rows = rows[(rows[:, 4] < begin) | (rows[:, 4] >= end)]
    low = places.min(axis=0).astype(np.int64)
    inside = ((rows[:, 1:4] >= low) & (rows[:, 1:4] <= places.max(axis=0))).all(axis=1)
    locked |= np.isin(keys_of(places, low), keys_of(rows[inside, 1:4], low))
    new, smaller = simplified(places, faces, locked, max(len(faces) // _KEPT, min(COARSEST, most) // 4))
    apart = farthest_from_surface(places.astype(np.float64), new.astype(np.float64), smaller)
    near = np.zeros(0, np.int64)
    if tables:
        from scipy.spatial import KDTree  # a third of what a process loads

        near = KDTree(places).query(new)[1]
    return TriangleMesh(new.astype(np.float64), smaller, carried(near)), before + apart * plan.lattice.cell


def simplified(places: Places, faces: Faces, locked: npt.NDArray[np.bool_], target: int) -> tuple[Places, Faces]:
    """Simplify to about `target` triangles; locked and border vertices stay."""
    low = places.min(axis=0).astype(np.float64)
    kept, corners, _ = collapsed(places - low, faces, locked, target)
    new, numbers, _ = welded(np.rint(kept + low).astype(np.int32))
    corners = numbers[corners]
    new, smaller, _ = compact(new, corners[~degenerate(corners)])
    return (new, smaller) if len(smaller) else (places, faces)
