"""One tile: of the finest level by its triangles, of any other by its eighths, simplified inside of their border."""

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
    is_leaf = name in plan.leaves
    error, joined = 0.0, 0
    if is_leaf:
        mesh, skin, joined = _leaf(plan, name, folder)
    else:
        mesh, skin, error = _coarser(plan, name, folder, job.most)
    places = np.asarray(mesh.positions, np.int32)
    written_mesh = mesh
    counts = dict[str, Any]()
    if plan.textures:
        atlas_file = folder / f"{name}.atlas"
        pictures, factor = sorted(folder.glob(f"{name}[0-7].atlas")), 2
        if is_leaf:
            pictures, factor = _pictures(plan, folder), 1
        skin, atlas = cut_out(skin, pictures, factor)
        with open_output(atlas_file, overwrite=True, follow=False) as file:
            atlas.save(file, "ppm")
        written_mesh = textured(mesh, skin, atlas, job.images)
        _, image = images_in(written_mesh.metadata)[0]
        psnr = compare_image(name, atlas_file.read_bytes(), image).psnr_db
        counts["psnr_db"] = None
        if psnr is not None:
            counts["psnr_db"] = finite(psnr)
        # A viewer chooses the level by this number. Where a texture is halved with each level, its texels are the
        # larger error.
        if not is_leaf:
            error = max(error, plan.lattice.cell * side_of_texel(mesh, skin))
    if not job.finest:
        values = [_of_vertices(attribute, mesh) for attribute in mesh.attributes]
        with open_output(folder / f"{name}.mesh", overwrite=True, follow=False) as file:
            for table in (np.array(error), places, mesh.faces, skin, *values):
                write_npy(file, table)
    written_mesh = replace(written_mesh, positions=plan.lattice.positions(places))
    # One thread: tiles are encoded side by side, in processes, and those have all cores already.
    part = given_part(
        written_mesh, grid_cell=plan.lattice.cell, grid_origin=tuple(plan.lattice.origin), threads=1
    )
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
        moved = slid(points, corners, _held(plan, name, folder, spots))
        spots = plan.lattice.places(moved)
    places, numbers, _ = welded(spots)
    inside = ~plan.outside(name, places)
    # Each vertex counts in the tile whose cube it is in, or shared vertices would count several times in the sum of all
    # tiles.
    inside_numbers = row_numbers(points)[inside[numbers]]
    joined = len(np.unique(inside_numbers)) - int(inside.sum())
    # Faces that have a place twice cannot be seen, and take more bits than others.
    following = spots[np.roll(corners, -1, axis=1)]
    has_area = (spots[corners] != following).any(axis=2).all(axis=1)
    # A tile without faces would not be a mesh. One face, though it has no area, keeps the tree whole.
    if not has_area.any():
        has_area[0] = True
    faces = faces[has_area]
    used_vertices, corners = np.unique(corners[has_area], return_inverse=True)
    used, corners = used[used_vertices], corners.reshape(-1, 3)
    places, numbers, distinct_rows = welded(spots[used_vertices])

    def carry(what: Any) -> Attribute:
        values = mapped(folder, what, plan.kinds)[used]
        distinct = values[distinct_rows]
        # Vertices that fall together may have different colors. These become values of corners, so that no color is
        # lost.
        if np.array_equal(distinct[numbers], values):
            return Attribute(what, distinct, "vertex", what)
        different, rows = np.unique(values, axis=0, return_inverse=True)
        indices = rows.reshape(-1)[corners].astype(np.int32)
        return Attribute(what, different, "corner", what, indices)

    skin: Skin = np.zeros((len(faces), 3, 0), np.float32)
    if plan.textures:
        texcoords = mapped(folder, "texcoord", plan.kinds)
        rows = faces[:, 3:6]
        rows = np.where(rows < len(texcoords), rows, 0)
        skin = skin_of(texcoords[rows], faces[:, 6], _pictures(plan, folder))
    attributes = tuple(map(carry, plan.carried))
    return TriangleMesh(places.astype(np.float64), numbers[corners], attributes), skin, joined


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
    if low is None:
        low = places.min(axis=0)
    shifted = places.astype(np.int64) - low
    # The code of a place has 21 bits for each axis. Long triangles reach far out of their cube and can exceed that.
    if shifted.max(initial=0) > MOST_GRID:
        raise TargetError(
            f"a tile is larger than {MOST_GRID} cells, for it has long triangles; choose a larger --grid-cell"
        )
    return along_curve(shifted)


def _held(plan: Plan, name: str, folder: Path, places: Places) -> npt.NDArray[np.bool_]:
    """Which places other tiles use, too: those outside of a node, and those inside that faces of others reach."""
    outside = mapped(folder, "outside", plan.kinds)
    codes = plan.ends(name)
    # The table is sorted by codes, and a node is a range of codes: two binary searches find its part of a file of any
    # size.
    first, last = np.searchsorted(outside[:, 0], codes)
    rows = np.array(outside[first:last])
    begin, end = codes
    is_of_others = (rows[:, 4] < begin) | (rows[:, 4] >= end)
    reached = rows[is_of_others, 1:4]
    low = places.min(axis=0).astype(np.int64)
    inside = ((reached >= low) & (reached <= places.max(axis=0))).all(axis=1)
    is_reached = np.isin(keys_of(places, low), keys_of(reached[inside], low))
    return plan.outside(name, places) | is_reached


def _coarser(plan: Plan, name: str, folder: Path, most: int) -> tuple[TriangleMesh, Skin, float]:
    """A node by those below it; what others use of it stays where it is."""
    tables = 3 + len(plan.carried)
    children, skins = [], list[Skin]()
    error, first = 0.0, 0
    for path in sorted(folder.glob(f"{name}[0-7].mesh")):
        with path.open("rb") as file:
            error = max(error, float(np.load(file)))
            places, faces, skin, *values = (np.load(file) for _ in range(tables))
        skins.append(skin)
        children.append((places, faces + first, *values))
        first += len(places)
    together, corners, *columns = map(np.concatenate, zip(*children))
    # Coarse tiles of large meshes are made in many processes at a time. Each would otherwise hold its input twice.
    del children, places, faces, values  # as large as all else
    places, numbers, distinct_rows = welded(together)

    def build(points: Places, triangles: Faces, rows: Ints) -> TriangleMesh:
        attributes: list[Attribute] = []
        for what, column in zip(plan.carried, columns):
            attributes.append(Attribute(what, column[distinct_rows[rows]], "vertex", what))  # type: ignore[arg-type]
        return TriangleMesh(points.astype(np.float64), triangles, tuple(attributes))

    faces, skin = numbers[corners], joined_skins(skins)
    del together, corners, numbers
    # Welding may leave nothing of flat or tiny children. See `_leaf`: one face keeps the tree whole.
    empty = degenerate(faces)
    if empty.all():
        return build(places, faces[:1], np.arange(len(places))), skin[:1], error
    faces, skin = faces[~empty], skin[~empty]
    locked = _held(plan, name, folder, places)
    target = max(len(faces) // _KEPT, min(COARSEST, most) // 4)
    wedges = None
    if plan.textures:
        wedges = wedges_of(skin, faces)
    new, smaller, remaining = simplified(places, faces, locked, target, wedges)
    if wedges is None:
        skin = skin[: len(smaller)]
    else:
        corner_of_wedge = np.unique(wedges, return_index=True)[1]
        skin = skin.reshape(-1, 4)[corner_of_wedge[remaining]]
    apart = farthest_from_surface(places.astype(np.float64), new.astype(np.float64), smaller)
    nearest_rows = np.zeros(0, np.int64)
    if columns:
        # Imported here, since a process of leaves never needs it, and there are many such processes.
        from scipy.spatial import KDTree  # a third of what a process loads

        nearest_rows = KDTree(places).query(new)[1]
    return build(new, smaller, nearest_rows), skin, error + apart * plan.lattice.cell


def simplified(
    places: Places,
    faces: Faces,
    locked: npt.NDArray[np.bool_],
    target: int,
    wedges: Faces | None = None,
) -> tuple[Places, Faces, Faces]:
    """Simplify to about `target` triangles; locked and border vertices stay. Also return the wedges of the result."""
    low = places.min(axis=0).astype(np.float64)
    positions, corners, _, remaining, _ = collapsed(places - low, faces, locked, target, wedges)
    new, numbers, _ = welded(np.rint(positions + low).astype(np.int32))
    corners = numbers[corners]
    has_area = ~degenerate(corners)
    new, smaller, _ = compact(new, corners[has_area])
    if len(smaller):
        return new, smaller, remaining[has_area]
    # Simplifying may end with nothing, where all vertices fall together. The input is then the better coarse tile.
    if wedges is None:
        wedges = faces
    return places, faces, wedges
