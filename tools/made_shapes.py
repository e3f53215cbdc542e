"""Shapes made by formulas, as triangle meshes: to learn denoising from.

A shape is a function of space, negative inside: intersections of half-spaces, cylinders, cones, balls and tori, joined
and cut sharply, with fillets or with chamfers; sweeps along curves; blobs with fractal detail. Its surface is meshed by
dual contouring: one vertex in every cell of a grid that the surface passes, put where the planes through the crossings
meet, so that creases and corners are kept; then triangles are made more even where there is no crease.

References
----------
T. Ju, F. Losasso, S. Schaefer, J. Warren, "Dual contouring of Hermite data", ACM Transactions on Graphics 21, 2002.
"""

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from bsm.codec.arrays import Faces, Floats, Positions
from bsm.codec.geometry.graph import vertex_neighbors

Field = Callable[[Floats], Floats]
"""From places, shape (..., 3), to values that are negative inside, and about a distance."""

FIRM = 0.03
"""How much a vertex is drawn to the middle of its crossings, against the planes."""
FLAT = 0.06
"""Share of a second direction in the normals about a vertex from which on it is on a crease, and stays."""
EVENINGS = 6
HALVINGS = 16


def mesh_of(field: Field, cells: int, size: float = 1.0) -> tuple[Positions, Faces]:
    """Mesh the zero of a field inside the cube from -size to size, with `cells` cells a side."""
    step = 2.0 * size / cells
    ticks: Floats = np.asarray(-size + step * np.arange(cells + 1), dtype=np.float64)
    corners = np.stack(np.meshgrid(ticks, ticks, ticks, indexing="ij"), axis=-1)
    values = field(corners)
    # The cube's own sides are outside: what reaches them is cut off flat.
    sides = np.pad(np.zeros((cells - 1,) * 3, np.bool_), 1, constant_values=True)
    values[sides] = np.maximum(values[sides], 0.5 * step)
    inside = values < 0.0
    count = (cells,) * 3
    places, owners, quads = [], [], []
    for axis in range(3):
        low = np.take(inside, np.arange(cells), axis)
        high = np.take(inside, np.arange(1, cells + 1), axis)
        at = np.argwhere(low != high)
        others = [other for other in range(3) if other != axis]
        at = at[(at[:, others] > 0).all(axis=1) & (at[:, others] < cells).all(axis=1)]
        end = at.copy()
        end[:, axis] += 1
        place = _crossings(field, ticks[at], ticks[end], low[tuple(at.T)])
        around = []
        for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)):
            cell = at.copy()
            cell[:, others[0]] -= a
            cell[:, others[1]] -= b
            around.append(np.ravel_multi_index(tuple(cell.T), count))
            places.append(place)
            owners.append(around[-1])
        quad = np.stack(around, axis=1)
        turned = low[tuple(at.T)] ^ (axis == 1)
        quad[~turned] = quad[~turned][:, ::-1]
        quads.append(quad)
    used, owner = np.unique(np.concatenate(owners), return_inverse=True)
    positions, firm = _meet(field, np.concatenate(places), owner.ravel(), len(used), step)
    quad = np.searchsorted(used, np.concatenate(quads))
    faces = _triangles(positions, quad)
    return _evened(field, positions, faces, firm, step), faces


def _crossings(field: Field, first: Floats, last: Floats, inside: npt.NDArray[np.bool_]) -> Floats:
    """Where a field is zero between two places of which `inside` says whether the first is inside; by halving."""
    for _ in range(HALVINGS):
        middle = 0.5 * (first + last)
        same = ((field(middle) < 0.0) == inside)[:, None]
        first, last = np.where(same, middle, first), np.where(same, last, middle)
    return 0.5 * (first + last)


def gradient(field: Field, places: Floats, step: float) -> Floats:
    """Unit normals of the field, by differences."""
    offsets = step * np.eye(3)
    slope = np.stack(
        [field(places + offset) - field(places - offset) for offset in offsets], axis=-1
    )
    return np.asarray(slope / np.maximum(np.linalg.norm(slope, axis=-1, keepdims=True), 1e-12))


def _meet(
    field: Field, places: Floats, owner: npt.NDArray[np.int64], n: int, step: float
) -> tuple[Positions, npt.NDArray[np.bool_]]:
    """Where the tangent planes at the crossings of each cell meet; and whether on a crease."""
    normals = gradient(field, places, 0.02 * step)
    counts = np.bincount(owner, minlength=n)[:, None]
    middle = np.stack([np.bincount(owner, column, n) for column in places.T], axis=1) / counts
    offsets = np.einsum("ij,ij->i", places - middle[owner], normals)
    matrix = np.zeros((n, 3, 3))
    right = np.zeros((n, 3))
    for i in range(3):
        right[:, i] = np.bincount(owner, normals[:, i] * offsets, n)
        for j in range(3):
            matrix[:, i, j] = np.bincount(owner, normals[:, i] * normals[:, j], n)
    matrix = matrix / counts[:, :, None]
    right = right / counts
    spread = np.linalg.eigvalsh(matrix)
    move = np.linalg.solve(matrix + FIRM**2 * np.eye(3), right[:, :, None])[:, :, 0]
    length = np.linalg.norm(move, axis=1, keepdims=True)
    move *= np.minimum(1.0, 0.9 * step / np.maximum(length, 1e-12))
    return middle + move, spread[:, 1] > FLAT


def _triangles(positions: Positions, quads: npt.NDArray[np.int64]) -> Faces:
    """Each quad along its shorter diagonal."""
    a, b, c, d = (quads[:, k] for k in range(4))
    short = np.linalg.norm(positions[a] - positions[c], axis=1) < np.linalg.norm(
        positions[b] - positions[d], axis=1
    )
    first = np.where(short[:, None], np.stack([a, b, c], axis=1), np.stack([a, b, d], axis=1))
    second = np.where(short[:, None], np.stack([a, c, d], axis=1), np.stack([b, c, d], axis=1))
    return np.concatenate([first, second]).astype(np.int32)


def _evened(
    field: Field, positions: Positions, faces: Faces, firm: npt.NDArray[np.bool_], step: float
) -> Positions:
    """Smooth vertices to the mean of their neighbors, back onto the surface; those on creases stay."""
    starts, members = vertex_neighbors(faces, len(positions))
    degrees = np.diff(starts)
    owners = np.repeat(np.arange(len(positions)), degrees)
    free = ~firm & (degrees > 0)
    for _ in range(EVENINGS):
        sums = np.stack(
            [np.bincount(owners, column[members], len(positions)) for column in positions.T], axis=1
        )
        mean = sums / np.maximum(degrees, 1)[:, None]
        moved = np.where(free[:, None], 0.5 * (positions + mean), positions)
        for _ in range(2):
            slope = np.stack(
                [
                    field(moved + offset) - field(moved - offset)
                    for offset in 0.02 * step * np.eye(3)
                ],
                axis=-1,
            ) / (0.04 * step)
            square = np.maximum((slope**2).sum(axis=1), 1e-6)
            shift = (field(moved) / square)[:, None] * slope
            length = np.linalg.norm(shift, axis=1, keepdims=True)
            shift *= np.minimum(1.0, 0.5 * step / np.maximum(length, 1e-12))
            moved = np.where(free[:, None], moved - shift, moved)
        positions = moved
    return positions


def made_shape(seed: int, cells: int) -> tuple[Positions, Faces]:
    """One shape of many kinds, the same for the same seed; its faces look outwards."""
    random = np.random.default_rng(seed)
    makers = (_machined, _machined, _polyhedron, _sweep, _organic, _organic)
    return mesh_of(_turned(makers[seed % len(makers)](random), random), cells)


Random = np.random.Generator


def _turned(field: Field, random: Random) -> Field:
    rotation = np.linalg.qr(random.normal(size=(3, 3)))[0]
    return lambda places: field(places @ rotation)


def _direction(random: Random) -> Floats:
    vector = random.normal(size=3)
    return np.asarray(vector / np.linalg.norm(vector))


def _joined(a: Floats, b: Floats, width: float, way: int) -> Floats:
    """The larger of two: sharply, with a fillet, with a chamfer."""
    if way == 0:
        return np.maximum(a, b)
    if way == 1:
        share = np.maximum(width - np.abs(a - b), 0.0) / width
        return np.asarray(np.maximum(a, b) + 0.25 * width * share**2)
    return np.asarray(np.maximum(np.maximum(a, b), (a + b) * np.sqrt(0.5) + 0.5 * width))


def _primitive(random: Random, size: float) -> Field:
    """A box, cylinder, cone, ball or ring anywhere."""
    center, axis = random.uniform(-0.5, 0.5, 3), np.eye(3)[random.integers(3)]
    if random.random() < 0.3:
        axis = _direction(random)
    rest = random.permutation(3)
    half = size * random.uniform(0.4, 1.0, 3)
    kind, tilt = random.integers(5), random.uniform(0.2, 0.7)

    def field(places: Floats) -> Floats:
        apart = places - center
        if kind == 0:
            return np.asarray((np.abs(apart[..., rest]) - half).max(axis=-1))
        along = apart @ axis
        across = np.sqrt(np.maximum((apart**2).sum(axis=-1) - along**2, 1e-12))
        if kind == 1:
            return np.asarray(np.maximum(across - half[0], np.abs(along) - 1.6 * half[1]))
        if kind == 2:
            return np.asarray(np.maximum(across + tilt * along - half[0], np.abs(along) - half[1]))
        if kind == 3:
            return np.asarray(np.sqrt(across**2 + along**2) - half[0])
        return np.asarray(np.sqrt((across - half[0]) ** 2 + along**2) - 0.4 * half[1])

    return field


def _machined(random: Random) -> Field:
    """A body with holes, bosses, fillets and chamfers."""
    half = random.uniform(0.35, 0.75, 3)
    body = random.integers(2)
    parts = [
        (
            _primitive(random, random.uniform(0.2, 0.5)),
            random.random() < 0.6,
            int(random.integers(3)),
        )
        for _ in range(random.integers(3, 8))
    ]
    width = random.uniform(0.05, 0.25)
    rounding = random.uniform(0.0, 0.15) if random.random() < 0.5 else 0.0

    def field(places: Floats) -> Floats:
        if body == 0:
            apart = np.abs(places) - half + rounding
            outside = np.sqrt((np.maximum(apart, 0.0) ** 2).sum(axis=-1))
            value = outside + np.minimum(apart.max(axis=-1), 0.0) - rounding
        else:
            value = np.maximum(
                np.hypot(places[..., 0], places[..., 1]) - half[0], np.abs(places[..., 2]) - half[1]
            )
        for part, cut, way in parts:
            value = (
                _joined(value, -part(places), width, way)
                if cut
                else -_joined(-value, -part(places), width, way)
            )
        return np.asarray(value)

    return field


def _polyhedron(random: Random) -> Field:
    """Half-spaces, the edges sharp, round or cut off; often with another one taken away."""
    count = int(random.integers(4, 16))
    planes = np.stack([_direction(random) for _ in range(count)] + [*np.eye(3), *-np.eye(3)])
    reach = np.concatenate([random.uniform(0.3, 0.7, count), np.full(6, 0.8)])
    way, width = int(random.integers(3)), random.uniform(0.03, 0.15)
    notch = _primitive(random, 0.4) if random.random() < 0.5 else None

    def field(places: Floats) -> Floats:
        value = places @ planes[0] - reach[0]
        for plane, distance in zip(planes[1:], reach[1:], strict=True):
            value = _joined(value, places @ plane - distance, width, way)
        return np.asarray(value if notch is None else np.maximum(value, -notch(places)))

    return field


def _sweep(random: Random) -> Field:
    """A profile with straight or round sides along a ring or a wave, often twisted."""
    ring, twist = random.random() < 0.6, int(random.integers(-3, 4))
    sides = int(random.integers(3, 8))
    radius, thick = random.uniform(0.4, 0.6), random.uniform(0.15, 0.32)
    wave, turns, blend = (
        random.uniform(0.0, 0.35),
        random.uniform(2.0, 5.0),
        random.uniform(0.0, 0.08),
    )
    angles = 2.0 * np.pi * np.arange(sides) / sides
    flat = random.random() < 0.7

    def field(places: Floats) -> Floats:
        x, y, z = places[..., 0], places[..., 1], places[..., 2]
        if ring:
            u, v, turn = (
                np.hypot(x, y) - radius,
                z,
                twist * np.arctan2(y, x) / (1 if not flat else sides),
            )
        else:
            u, v, turn = x - wave * np.sin(turns * z), y - wave * np.cos(turns * z), twist * z
        profile = np.hypot(u, v) * 0.0 - 1.0
        if flat:
            a, b = u * np.cos(turn) - v * np.sin(turn), u * np.sin(turn) + v * np.cos(turn)
            for angle in angles:
                profile = _joined(
                    profile, a * np.cos(angle) + b * np.sin(angle) - thick, max(blend, 1e-3), 1
                )
        else:
            profile = np.hypot(u, v) - thick * (
                1.0 + 0.25 * np.cos(sides * np.arctan2(v, u) + turn)
            )
        return profile if ring else np.maximum(profile, np.abs(z) - 0.8)

    return field


def _organic(random: Random) -> Field:
    """Blobs and limbs that flow into each other, with detail of many sizes."""
    count = int(random.integers(3, 9))
    ends = random.uniform(-0.55, 0.55, (count, 2, 3))
    radii = random.uniform(0.1, 0.3, count)
    soft = random.uniform(0.05, 0.25)
    octaves = int(random.integers(0, 6))
    waves = [
        (
            np.stack([_direction(random) for _ in range(3)]) * 3.0 * 1.8**octave,
            random.uniform(0.0, 6.3, 3),
        )
        for octave in range(octaves)
    ]
    strength, fall = random.uniform(0.01, 0.05), random.uniform(0.45, 0.75)
    sharp = random.random() < 0.3

    def field(places: Floats) -> Floats:
        value = np.full(places.shape[:-1], np.inf)
        for (a, b), radius in zip(ends, radii, strict=True):
            along = np.clip(
                ((places - a) @ (b - a)) / max(float((b - a) @ (b - a)), 1e-6), 0.0, 1.0
            )
            limb = np.sqrt(((places - a - along[..., None] * (b - a)) ** 2).sum(axis=-1)) - radius
            value = limb if np.isinf(value).all() else -_joined(-value, -limb, soft, 1)
        for octave, (wave, phase) in enumerate(waves):
            bumps = np.sin(places @ wave.T + phase).prod(axis=-1)
            value = value + strength * fall**octave * 2.0 * (
                np.abs(bumps) - 0.3 if sharp else bumps
            )
        return value

    return field
