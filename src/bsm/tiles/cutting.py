"""One integer lattice for a whole mesh, and an octree over it: which triangle is of which tile."""

import json
import math
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from bsm.bitstream.container.header import MOST_GRID
from bsm.bitstream.errors import MeshError, OptionError
from bsm.codec.geometry.mesh import TriangleMesh, require_sizes
from bsm.codec.look.measure import LookMetric
from bsm.codec.look.pictures import EDGE_PIXELS, LEAST_PIXELS
from bsm.codec.threads import ordered_map
from bsm.files.output import write_output
from bsm.tiles.reading import CARRIED, Kinds, Raw, mapped, table_file
from bsm.tiles.sliding import slid

Ints: TypeAlias = npt.NDArray[np.int64]
Places: TypeAlias = npt.NDArray[np.int32]
DEPTH = 10  # levels below the first that has to be cut
# A page shows the coarsest level first, and the user waits for it. The size of the whole mesh must not matter for that.
# Triangles of the coarsest level at most, about: ten kilobytes until a first picture.
COARSEST = 1 << 13
# Below a level that a table has room for, only nodes that must be cut again are counted one by one.
_COUNTED = 7  # levels all of whose nodes are counted: 8^7 entries are 16 MB
_SAMPLE = 40_000
# Sliding spends part of the promise, and rounding to the lattice the rest: half of a look distance of 1 is left for it.
_SLID = 0.5  # largest look distance of vertices that have slid
_NEARER = 1.25  # samples are so much larger than in a picture of the whole, since they are few
# Doubles hold all integers up to 2^53, but places are added and subtracted as 32-bit integers. This leaves a bit for
# that.
_FARTHEST = 1 << 30  # from the origin, in cells
_SPREAD = (
    0x1F00000000FFFF,
    0x1F0000FF0000FF,
    0x100F00F00F00F00F,
    0x10C30C30C30C30C3,
    0x1249249249249249,
)
"""How 21 bits come to stand three apart."""


def along_curve(places: Ints) -> Ints:
    """A number for each place, of 21 bits an axis; consecutive ones are near each other."""
    # Spreading the bits by masks takes five steps for a whole array. A loop over 21 bits would take four times as many.
    for halved, mask in enumerate(_SPREAD):
        places = (places | places << (32 >> halved)) & mask
    return np.asarray(places[:, 0] << 2 | places[:, 1] << 1 | places[:, 2])


@dataclass(frozen=True)
class Lattice:
    """Where places are in the mesh's unit."""

    cell: float
    origin: tuple[float, ...] = (0.0, 0.0, 0.0)

    def places(self, positions: npt.NDArray[Any]) -> Places:
        """Return the cells of positions, as the encoder rounds them."""
        return np.asarray(self.cells(positions), np.int32)

    def cells(self, positions: npt.NDArray[Any]) -> npt.NDArray[np.float64]:
        """Return the cells of positions as floats, which hold any number."""
        with np.errstate(over="ignore"):
            offsets = positions.astype(np.float64) - np.array(self.origin)
            # Not numpy's rint: it rounds halves to even numbers, and the encoder rounds them up. Both must find the
            # same cell, or the tile would be off by one along borders that it shares.
            return np.asarray(np.floor(offsets / self.cell + 0.5), np.float64)

    def positions(self, places: npt.NDArray[Any]) -> npt.NDArray[np.float64]:
        return np.asarray(places * self.cell + np.array(self.origin))


def chosen_lattice(
    raw: Raw, cell: float | None, origin: tuple[float, ...] | None, threads: int
) -> tuple[Lattice, bool]:
    """Return the requested lattice, or one by the look of samples, and whether vertices slide along the surface.

    The cells represent every position exactly."""
    ends = np.array([raw.low, raw.high])
    # Coordinates beyond 1e150 overflow when they are squared, so this comes before anything is measured.
    require_sizes(ends, done="cut")
    slides = False
    if cell is None:
        cell, slides = _by_look(raw, threads)
    lattice = Lattice(cell, origin or (0.0, 0.0, 0.0))
    # A cell whose mantissa has four bits times an integer below 2^30 is exact in a double. Then a place and its
    # position are one-to-one, and it does not matter which tile computes it.
    short = 16 * math.frexp(cell)[0] % 1 == 0
    if origin is None and short and np.abs(lattice.cells(ends)).max() >= _FARTHEST:
        point_of_grid = lattice.cells(ends[0]) * cell
        lattice = Lattice(cell, tuple(point_of_grid.tolist()))
    _require_reach(lattice, ends, short, origin is not None)
    return lattice, slides


def _require_reach(
    lattice: Lattice, ends: npt.NDArray[np.float64], short: bool, has_origin: bool
) -> None:
    """Raise `OptionError` for a lattice whose cells do not represent every position exactly."""
    reach = float(np.abs(ends - np.array(lattice.origin)).max())
    farthest = reach / lattice.cell
    exact = short and not any(coordinate % lattice.cell for coordinate in lattice.origin)
    most = MOST_GRID // 2
    if exact:
        most = _FARTHEST
    if farthest < most:
        return
    extent = np.ptp(ends, axis=0).max()
    if has_origin:
        extent = reach
    least = math.ceil(math.log2(2 * extent / _FARTHEST))
    better = 2.0 ** max(math.floor(math.log2(lattice.cell)), least)
    message = f"the mesh is {farthest:.3g} cells of {lattice.cell:g} from the origin of the grid, too far to tell "
    raise OptionError(
        f"{message}places exactly; a power of two does, such as --grid-cell {better!r}"
    )


def _by_look(raw: Raw, threads: int) -> tuple[float, bool]:
    """The largest cell of few bits that keeps the default's promise, and whether vertices may slide."""
    # Colors, normals and textures belong to places of the surface. Vertices that slide would take them along, so only
    # bare meshes slide.
    bare = not raw.kinds.keys() & {*CARRIED, "texcoord"}
    extent = np.ptp([raw.low, raw.high], axis=0).max() or 1.0

    def measure_sample(faces: Ints) -> tuple[float, bool]:
        used, corners = np.unique(faces, return_inverse=True)
        points = raw.table("positions")[used].astype(np.float64)
        sample = TriangleMesh(points, corners.reshape(-1, 3).astype(np.int32))
        return _by_look_of(sample, extent, bare)

    cells, slides = zip(*ordered_map(measure_sample, _samples(raw), threads))
    # One lattice serves all tiles. The most delicate of the three samples decides.
    return min(cells), all(slides)


def _by_look_of(sample: TriangleMesh, extent: float, bare: bool) -> tuple[float, bool]:
    """Return the largest cell for a part of a mesh of this extent, and whether its vertices may slide."""
    points = sample.positions
    edges = np.diff(points[sample.faces], axis=1)
    edge = np.linalg.norm(edges, axis=2).mean() or math.inf
    most = min(0.01 * sample.diagonal, edge / 2.0) or 1.0
    cell = 2.0 ** math.floor(math.log2(most))
    slides = False
    # The sample may be flat or tiny, and have no picture at all. The bound on the largest error holds nevertheless.
    with suppress(MeshError):  # there is nothing to see
        # The look of the whole mesh is measured in pictures of a certain size. A sample is drawn at the scale that
        # it would have in them, or else the look of a small part would be judged as if the part filled the screen.
        scale = _NEARER * max(LEAST_PIXELS / extent, EDGE_PIXELS / edge)
        pixels = scale * np.ptp(points, axis=0).max()
        metric = LookMetric(sample, threads=1, most_pixels=math.ceil(pixels))
        if bare:
            moved = slid(points, sample.faces)
            slides = metric.distance(moved) <= _SLID
            if slides:
                points = moved

        def rounded_distance(size: float) -> float:
            return metric.distance(np.rint(points / size) * size)

        # The look distance grows about in proportion to the cell, so the next power of two is computed rather than
        # searched for.
        while (distance := rounded_distance(cell)) > 1.0:
            cell *= 0.5 ** max(1, math.floor(math.log2(distance)))
        # Between two powers of two, cells of four bits are tried from the largest down: they are still exact.
        for share in range(15, 8, -1):
            larger = share * cell / 8
            if larger <= most and rounded_distance(larger) <= 1.0:
                return larger, slides
    return cell, slides


def _samples(raw: Raw) -> list[Ints]:
    """The faces around three vertices, in any order of the faces."""
    # Every k-th face is enough to find how far a part with as many faces as wanted reaches.
    faces = raw.rows["faces"]
    firsts = raw.table("faces")[:: max(1, faces // _SAMPLE), 0]
    points = raw.table("positions")[firsts].astype(np.float64)
    share = min(1.0, _SAMPLE / max(1, faces))
    count = len(points)
    places = [0]
    if share < 1:
        places = [count // 4, count // 2, count * 3 // 4]
    samples: list[list[Ints]] = [[] for _ in places]
    middles = points[places]
    reach = [np.quantile(np.abs(points - middle).max(axis=1), share) for middle in middles]
    for piece in raw.pieces("faces"):
        # Mapped anew for each piece, so that no more of it is in memory than the piece needs.
        firsts = raw.table("positions")[piece[:, 0]]
        for middle, far, sample in zip(middles, reach, samples):
            is_near = (np.abs(firsts - middle) <= far).all(axis=1)
            sample.append(piece[is_near, :3])
    return list(map(np.concatenate, samples))


# --------------------------------------------------------------------------------------------------------------- octree


@dataclass(frozen=True)
class Root:
    """The cube of the whole mesh; a node is named "r" and the eighths on the way to it."""

    low: tuple[int, ...]
    bits: int

    def cube(self, name: str) -> tuple[Ints, int]:
        """The lowest place of a node, and how many places it has along each side."""
        corner = np.array(self.low, np.int64)
        side = 1 << self.bits
        for eighth in name[1:]:
            side >>= 1
            is_upper = np.array([4, 2, 1]) & int(eighth) > 0
            corner[is_upper] += side
        return corner, side

    def outside(self, name: str, places: npt.NDArray[Any]) -> npt.NDArray[np.bool_]:
        """Which places are not in the cube of a node."""
        corner, side = self.cube(name)
        beyond = (places < corner) | (places >= corner + side)
        return np.asarray(beyond.any(axis=1))


@dataclass(frozen=True)
class Plan(Root):
    """How a mesh is cut: where in the file `cut` the faces of each leaf begin, how many; `kinds` of the tables."""

    lattice: Lattice
    depth: int
    vertices: int
    faces: int
    kinds: Kinds
    leaves: dict[str, tuple[int, int]]
    slides: bool  # whether vertices slide along the surface
    about: Mapping[str, str] = field(default_factory=dict)
    textures: int = 0  # pictures of materials, beside the plan

    def codes(self, places: npt.NDArray[Any]) -> Ints:
        """The node of the deepest level that holds each place, in their order along the octree's curve."""
        shifted = places.astype(np.int64) - np.array(self.low)
        return along_curve(shifted >> (self.bits - self.depth))

    @property
    def carried(self) -> tuple[str, ...]:
        """What vertices have beside their place."""
        return tuple(what for what in CARRIED if what in self.kinds)

    def ends(self, name: str) -> tuple[int, int]:
        """The codes of a node: from the first on, before the second."""
        below = 3 * (self.depth - len(name) + 1)
        code = int(name[1:] or "0", 8)
        return code << below, (code + 1) << below

    def nodes(self) -> list[str]:
        """Return the names of all nodes, children before parents."""
        nodes = {leaf[:size] for leaf in self.leaves for size in range(1, 1 + len(leaf))}
        return sorted(nodes, key=lambda name: (-len(name), name))

    def save(self, path: Path) -> None:
        write_output(path, json.dumps(asdict(self)).encode(), overwrite=True, follow=False)


def load_plan(path: Path) -> Plan:
    facts = json.loads(path.read_bytes())
    lattice = facts["lattice"]
    facts["lattice"] = Lattice(lattice["cell"], tuple(lattice["origin"]))
    facts["low"] = tuple(facts["low"])
    return Plan(**facts)


def cut(raw: Raw, lattice: Lattice, slides: bool, most: int) -> Plan:
    """Write faces by the leaf of their first corner, and which places are used from outside of it."""
    low, high = lattice.places(np.array([raw.low, raw.high])).astype(np.int64)
    vertices, faces = raw.rows["positions"], raw.rows["faces"]
    # Above the first level that is cut there is one node a level, down to a mesh that is there at once.
    above = max(0, math.ceil(math.log(min(most, faces) / COARSEST, 4)))
    bits = max(1, int((high - low).max()).bit_length()) + above
    depth = min(DEPTH + above, bits)
    kinds = {what: kind for what, kind in raw.kinds.items() if what != "faces"}
    columns = 3
    if raw.textures:
        columns = 7
    kinds |= {"codes": ("<i8", 1), "outside": ("<i8", 5), "cut": ("<u4", columns)}
    corner = tuple(low.tolist())
    plan = Plan(
        corner, bits, lattice, depth, vertices, faces, kinds, {}, slides, raw.about, raw.textures
    )
    with table_file(raw.folder / "codes") as file:
        for piece in raw.pieces("positions"):
            file.write(plan.codes(lattice.places(piece)).data)
    codes, counts = _count_faces(plan, raw, most, max(above, _COUNTED))
    ends = np.concatenate([[0], np.cumsum(counts)])

    def leaves(name: str) -> Iterator[tuple[str, tuple[int, int]]]:
        first, last = np.searchsorted(codes, plan.ends(name))
        begin = int(ends[first])
        count = int(ends[last]) - begin
        if count and len(name) > above and (count <= most or len(name) > depth):
            yield name, (begin, count)
        elif count:
            # A face belongs to the leaf of its first corner. Cutting faces at the borders of cubes would add vertices
            # that the mesh does not have, and cracks where two tiles round them.
            for eighth in "01234567":
                yield from leaves(name + eighth)

    plan = replace(plan, leaves=dict(leaves("r")))
    _sort_faces(plan, raw)
    return plan


def _count_faces(plan: Plan, raw: Raw, most: int, level: int) -> tuple[Ints, Ints]:
    """Return the codes of nodes and the counts of their faces: nodes of a level, and below it where they are cut."""
    coarse = 3 * max(0, plan.depth - level)
    # Faces are counted twice rather than kept: a pass over the file is cheap, and one number for each face might not
    # fit.
    number = np.zeros(1 << (3 * plan.depth - coarse), np.int64)
    for face_codes in _first_codes(raw, plan.kinds):
        number += np.bincount(face_codes >> coarse, minlength=len(number))
    deep = (number > most) & (coarse > 0)
    codes = np.flatnonzero(number * ~deep) << coarse
    counts = number[codes >> coarse]
    if not deep.any():
        return codes, counts
    for face_codes in _first_codes(raw, plan.kinds):
        is_deep = deep[face_codes >> coarse]
        deep_codes, deep_counts = np.unique(face_codes[is_deep], return_counts=True)
        codes, inverse = np.unique(np.concatenate([codes, deep_codes]), return_inverse=True)
        sums = np.bincount(inverse, np.concatenate([counts, deep_counts]))
        counts = sums.astype(np.int64)
    return codes, counts


def _first_codes(raw: Raw, kinds: Kinds) -> Iterator[Ints]:
    """The node of each face, of its first corner."""
    for faces in raw.pieces("faces"):
        # Mapped anew for each piece, as in `_samples`.
        codes = mapped(raw.folder, "codes", kinds)
        yield codes[faces[:, 0], 0]


def _sort_faces(plan: Plan, raw: Raw) -> None:
    """Faces by their leaves, in the order of the file inside each; and the places that tiles reach out to."""
    first_codes, end_codes = np.array([plan.ends(name) for name in plan.leaves]).T
    following = np.array([begin for begin, _ in plan.leaves.values()])
    number_type = np.min_scalar_type(len(plan.leaves))
    outside = [np.zeros((0, 5), np.int64)]
    with table_file(raw.folder / "cut") as file:
        for rows in raw.pieces("faces"):
            faces = np.ascontiguousarray(rows[:, : plan.kinds["cut"][1]])
            codes = mapped(raw.folder, "codes", plan.kinds)[:, 0][faces[:, :3]]
            leaf = np.searchsorted(first_codes, codes[:, 0], "right") - 1
            # Stable, so that the faces of a leaf keep the order of the file: the result does not depend on the size of
            # pieces.
            order = np.argsort(leaf.astype(number_type), kind="stable")
            numbers, first, count = np.unique(leaf[order], return_index=True, return_counts=True)
            for number, begin, size in zip(numbers.tolist(), first.tolist(), count.tolist()):
                file.seek(faces[0].nbytes * int(following[number]))
                file.write(faces[order[begin : begin + size]].data)
            following[numbers] += count
            # Corners outside of the cube belong to another tile, too. Both must leave such a place where it is, or a
            # crack opens; so the table `outside` tells each tile about them.
            begins, ends = first_codes[leaf, None], end_codes[leaf, None]
            row, corner = np.nonzero((codes < begins) | (codes >= ends))
            positions = raw.table("positions")[faces[row, corner]]
            corner_rows = np.column_stack(
                [codes[row, corner], plan.lattice.places(positions), begins[row]]
            )
            outside.append(np.unique(corner_rows, axis=0))
    with table_file(raw.folder / "outside") as file:
        file.write(np.unique(np.concatenate(outside), axis=0).tobytes())
    # These two are as large as the mesh, and all that is needed of them is in `cut` and `outside` now.
    for name in ("faces", "codes"):
        (raw.folder / name).unlink()
