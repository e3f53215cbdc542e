"""One tile: of the finest level by its triangles, of any other by its eighths, simplified inside of their border."""

import math
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from bsm.account.images import compare_image
from bsm.bitstream.container.header import MOST_GRID
from bsm.bitstream.errors import TargetError
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.metrics import farthest_from_surface
from bsm.codec.geometry.welding import degenerate, row_numbers
from bsm.encoding.given import given_part
from bsm.encoding.simplification import collapsed, compact
from bsm.files.formats.metadata import images_in
from bsm.files.formats.npz import write_npy
from bsm.files.images import ImageRule
from bsm.files.output import open_output, write_output
from bsm.ground.console import Console, Progress, finite
from bsm.jobs.task import Facts, Task
from bsm.tiles.atlas import Skin, cut_out, joined_skins, side_of_texel, skin_of, textured, wedges_of
from bsm.tiles.cutting import COARSEST, Ints, Places, Plan, along_curve, load_plan
from bsm.tiles.reading import mapped
from bsm.tiles.sliding import slid

Faces: TypeAlias = npt.NDArray[np.int32]
# Of a surface, an eighth of a cube has a quarter of the faces. With a quarter kept, tiles of all levels are about
# equal.
_KEPT = 4  # one of this many triangles stays from level to level


@dataclass(frozen=True, kw_only=True)
class TileJob(Task):
    """The input is the plan, or the tiles that a coarser one is made of; the output's name is that of the node."""

    most: int = 0
    finest: bool = False
    images: ImageRule = field(default_factory=lambda: ImageRule("webp"))


def tile_one(job: TileJob, console: Console) -> Facts:
    name, folder = Path(job.output).stem, Path(job.input).parent
    plan = load_plan(folder / "plan.json")
    if name in plan.leaves:
        (mesh, skin, joined), error = _leaf(plan, name, folder), 0.0
    else:
        (mesh, skin, error), joined = _coarser(plan, name, folder, job.most), 0
    places, mesh_sent, counts = np.asarray(mesh.positions, np.int32), mesh, dict[str, Any]()
    if plan.textures:
        finer = sorted(folder.glob(f"{name}[0-7].atlas"))
        skin, atlas = cut_out(skin, _pictures(plan, folder), 1) if name in plan.leaves else cut_out(skin, finer, 2)
        with open_output(folder / f"{name}.atlas", overwrite=True, follow=False) as file:
            atlas.save(file, "ppm")
        mesh_sent = textured(mesh, skin, atlas, job.images)
        written = compare_image(name, (folder / f"{name}.atlas").read_bytes(), images_in(mesh_sent.metadata)[0][1])
        counts["psnr_db"] = finite(math.inf if written.psnr_db is None else written.psnr_db)
        # A viewer chooses the level by this number. Where a texture is halved with each level, its texels are the
        # larger error.
        error = error if name in plan.leaves else max(error, plan.lattice.cell * side_of_texel(mesh, skin))
    if not job.finest:
        with open_output(folder / f"{name}.mesh", overwrite=True, follow=False) as file:
            for table in (np.array(error), places, mesh.faces, skin, *(_of_vertices(a, mesh) for a in mesh.attributes)):
                write_npy(file, table)
    mesh_sent, cells = replace(mesh_sent, positions=plan.lattice.positions(places)), plan.lattice
    # One thread: tiles are encoded side by side, in processes, and those have all cores already.
    part = given_part(mesh_sent, grid_cell=cells.cell, grid_origin=tuple(cells.origin), threads=1)
    data = b"".join(part.encode(Progress("")).attempt.frames)
    write_output(job.output, data, overwrite=True, follow=False)
    ends = {"low": places.min(axis=0).tolist(), "high": places.max(axis=0).tolist()}
    counts |= {"vertices": len(places), "faces": len(mesh.faces), "apart": error, "joined": joined}
    return {"input": job.input, "output": job.output, "output_bytes": len(data), **counts, **ends}


def _pictures(plan: Plan, folder: Path) -> list[Path]:
    return [folder / f"texture.{number}" for number in range(plan.textures)]


def _leaf(plan: Plan, name: str, folder: Path) -> tuple[TriangleMesh, Skin, int]:
    """A tile in cells of the lattice, and how many positions share a place; corners there may differ."""
    begin, count = plan.leaves[name]
    faces = mapped(folder, "cut", plan.kinds)[begin : begin + count]
    used, corners = np.unique(faces[:, :3], return_inverse=True)
    # Fancy indices copy only the rows that the tile needs, so a process holds a tile and not the mesh.
    points = mapped(folder, "positions", plan.kinds)[used].astype(np.float64)
    corners = corners.reshape(-1, 3)
    spots = plan.lattice.places(points)
    # Vertices that other tiles use stay, since those tiles do not know how far they would slide here.
    if plan.slides:
        spots = plan.lattice.places(slid(points, corners, _held(plan, name, folder, spots)))
    places, numbers, _ = welded(spots)
    inside = ~plan.outside(name, places)
    # Each vertex counts in the tile whose cube it is in, or shared vertices would count several times in the sum of all
    # tiles.
    joined = len(np.unique(row_numbers(points)[inside[numbers]])) - int(inside.sum())
    # Faces that have a place twice cannot be seen, and take more bits than others.
    has_area = (spots[corners] != spots[corners[:, [1, 2, 0]]]).any(axis=2).all(axis=1)
    # A tile without faces would not be a mesh. One face, though it has no area, keeps the tree whole.
    faces, corners = (rows[has_area] if has_area.any() else rows[:1] for rows in (faces, corners))
    used_vertices, corners = np.unique(corners, return_inverse=True)
    used, corners = used[used_vertices], corners.reshape(-1, 3)
    places, numbers, distinct_rows = welded(spots[used_vertices])

    def carried(what: Any) -> Attribute:
        values = mapped(folder, what, plan.kinds)[used]
        # Vertices that fall together may have different colors. These become values of corners, so that no color is
        # lost.
        if np.array_equal(values[distinct_rows][numbers], values):
            return Attribute(what, values[distinct_rows], "vertex", what)
        different, rows = np.unique(values, axis=0, return_inverse=True)
        return Attribute(what, different, "corner", what, rows.reshape(-1)[corners].astype(np.int32))

    skin: Skin = np.zeros((len(faces), 3, 0), np.float32)
    if plan.textures:
        texcoords = mapped(folder, "texcoord", plan.kinds)
        rows = np.where(faces[:, 3:6] < len(texcoords), faces[:, 3:6], 0)
        skin = skin_of(texcoords[rows], faces[:, 6], _pictures(plan, folder))
    return TriangleMesh(places.astype(np.float64), numbers[corners], tuple(map(carried, plan.carried))), skin, joined


def _of_vertices(attribute: Attribute, mesh: TriangleMesh) -> npt.NDArray[Any]:
    """One value for each vertex."""
    if attribute.indices is None:
        return attribute.values
    sums = np.zeros((len(mesh.positions), attribute.components), attribute.values.dtype)
    sums[mesh.faces[::-1]] = attribute.values[attribute.indices[::-1]]
    return sums


def welded(places: npt.NDArray[np.int32]) -> tuple[Places, Faces, Ints]:
    """Different places, along a curve, which of them each of the given ones is, and which given one each is first."""
    first, keys = np.unique(keys_of(places), return_index=True, return_inverse=True)[1:]
    return places[first], keys.astype(np.int32), first


def keys_of(places: npt.NDArray[np.int32], low: Ints | None = None) -> Ints:
    """A number for each place of a tile, different for different places."""
    shifted = places.astype(np.int64) - (places.min(axis=0) if low is None else low)
    # The code of a place has 21 bits for each axis. Long triangles reach far out of their cube and can exceed that.
    if shifted.max(initial=0) > MOST_GRID:
        raise TargetError(
            f"a tile is larger than {MOST_GRID} cells, for it has long triangles; choose a larger --grid-cell"
        )
    return along_curve(shifted)


def _held(plan: Plan, name: str, folder: Path, places: Places) -> npt.NDArray[np.bool_]:
    """Which places other tiles use, too: those outside of a node, and those inside that faces of others reach."""
    outside = mapped(folder, "outside", plan.kinds)
    begin, end = plan.ends(name)
    # The table is sorted by codes, and a node is a range of codes: two binary searches find its part of a file of any
    # size.
    rows = np.array(outside[slice(*np.searchsorted(outside[:, 0], (begin, end)))])
    rows = rows[(rows[:, 4] < begin) | (rows[:, 4] >= end)]
    low = places.min(axis=0).astype(np.int64)
    inside = ((rows[:, 1:4] >= low) & (rows[:, 1:4] <= places.max(axis=0))).all(axis=1)
    return plan.outside(name, places) | np.isin(keys_of(places, low), keys_of(rows[inside, 1:4], low))


def _coarser(plan: Plan, name: str, folder: Path, most: int) -> tuple[TriangleMesh, Skin, float]:
    """A node by those below it; what others use of it stays where it is."""
    children, skins, before, first = [], list[Skin](), 0.0, 0
    for path in sorted(folder.glob(f"{name}[0-7].mesh")):
        with path.open("rb") as file:
            before = max(before, float(np.load(file)))
            places, faces, skin, *values = (np.load(file) for _ in range(3 + len(plan.carried)))
        skins.append(skin)
        children.append((places, faces + first, *values))
        first += len(places)
    together, corners, *tables = map(np.concatenate, zip(*children))
    # Coarse tiles of large meshes are made in many processes at a time. Each would otherwise hold its input twice.
    del children, places, faces, values  # as large as all else
    places, numbers, distinct_rows = welded(together)

    def carried(border_rows: Ints) -> tuple[Attribute, ...]:
        return tuple(
            Attribute(what, table[distinct_rows[border_rows]], "vertex", what)  # type: ignore[arg-type]
            for what, table in zip(plan.carried, tables)
        )

    faces, skin = numbers[corners], joined_skins(skins)
    del together, corners, numbers
    # Welding may leave nothing of flat or tiny children. See `_leaf`: one face keeps the tree whole.
    if (empty := degenerate(faces)).all():
        return TriangleMesh(places.astype(np.float64), faces[:1], carried(np.arange(len(places)))), skin[:1], before
    faces, skin = faces[~empty], skin[~empty]
    locked = _held(plan, name, folder, places)
    target = max(len(faces) // _KEPT, min(COARSEST, most) // 4)
    wedges = wedges_of(skin, faces) if plan.textures else None
    new, smaller, remaining = simplified(places, faces, locked, target, wedges)
    corner = None if wedges is None else np.unique(wedges, return_index=True)[1]  # of each wedge
    skin = skin[: len(smaller)] if corner is None else skin.reshape(-1, 4)[corner[remaining]]
    apart = farthest_from_surface(places.astype(np.float64), new.astype(np.float64), smaller)
    border_rows = np.zeros(0, np.int64)
    if tables:
        # Imported here, since a process of leaves never needs it, and there are many such processes.
        from scipy.spatial import KDTree  # a third of what a process loads

        border_rows = KDTree(places).query(new)[1]
    return TriangleMesh(new.astype(np.float64), smaller, carried(border_rows)), skin, before + apart * plan.lattice.cell


def simplified(
    places: Places, faces: Faces, locked: npt.NDArray[np.bool_], target: int, wedges: Faces | None = None
) -> tuple[Places, Faces, Faces]:
    """Simplify to about `target` triangles; locked and border vertices stay. Also return the wedges of the result."""
    low = places.min(axis=0).astype(np.float64)
    kept_vertices, corners, _, remaining, _ = collapsed(places - low, faces, locked, target, wedges)
    new, numbers, _ = welded(np.rint(kept_vertices + low).astype(np.int32))
    there = ~degenerate(corners := numbers[corners])
    new, smaller, _ = compact(new, corners[there])
    # Simplifying may end with nothing, where all vertices fall together. The input is then the better coarse tile.
    return (new, smaller, remaining[there]) if len(smaller) else (places, faces, faces if wedges is None else wedges)
