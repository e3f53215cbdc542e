"""Meshes on grids of any kind, put together without the encoder: for vectors, proof and bombs."""

from collections.abc import Iterable, Sequence
from random import Random
from typing import Any

import numpy as np
import numpy.typing as npt

from bsm.bitstream.connectivity.faces import (
    AS_CORNERS,
    ON_EDGES,
    EncodedConnectivity,
    encode_connectivity,
)
from bsm.bitstream.container.header import MOST_GRID
from bsm.bitstream.container.wire import FrameType, write_varint
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.static.ways.grid import Raster, grid_field
from tools.surgery import Frames, header_frame, stream_of

Ints = npt.NDArray[np.int32]
LARGEST = (0, 1, 2, 9, 100, 4095, 70_000, MOST_GRID)
"""Largest values of an axis that random grids have."""


def gridded(
    coded: EncodedConnectivity,
    values: Ints,
    counts: Iterable[int],
    transforms: Ints | None = None,
    whole: bool = False,
    **fields: Any,
) -> Frames:
    """Frames of a mesh on a grid, with `transforms`, shape (k, 8), of congruent parts."""
    fields = {"grid": values.max(axis=0).tolist()} | fields
    fields |= {} if transforms is None else {"congruence": 35 + len(transforms) + 17 * whole}
    announced = {"vertices": len(values), "faces": len(coded.faces), "repeats": coded.repeats}
    return [
        header_frame(**announced | fields),
        (FrameType.CONNECTIVITY, coded.payload),
        *grid_frames(
            coded.faces, values, counts, fields["grid"], fields.get("light", 0), transforms, whole
        ),
    ]


def grid_frames(
    faces: Ints,
    values: Ints,
    counts: Iterable[int],
    largest: Sequence[int],
    light: int,
    transforms: Ints | None = None,
    whole: bool = False,
) -> Frames:
    """Return GRID packets of this many vertices each."""
    frames, first = [], 0
    grid = Raster((0.0, 0.0, 0.0), 1.0, tuple(largest), transforms=transforms, whole=whole)
    field = grid_field(faces, largest, values, light, grid)
    for count in counts:
        frames.append(
            (int(FrameType.GRID), write_varint(first) + write_varint(count) + field.write(count)[0])
        )
        first += count
    return frames


def any_transforms(random: Random, count: int, largest: Sequence[int]) -> Ints:
    """Transforms of a grid of which nothing is known."""
    rows = np.zeros((count, 8), np.int32)
    most = max(*largest, 1)
    fine = 2 << min(most.bit_length() + 2, 19)
    for row in rows:
        row[0] = random.randrange(50)
        first, turn = divmod(int(row[0]) // 8, 2)
        second = (first + 1 + turn) % 3
        source = (first, second, 3 - first - second)
        if row[0] < 48:
            row[5:] = [random.randint(0, largest[j] + largest[source[j]]) for j in range(3)]
        else:
            row[1:5] = random.randrange(4), *(random.randint(0, fine) for _ in range(3))
            row[5:] = [random.randint(0, 24 * most) for _ in range(3)]
    return rows


def random_grid(random: Random, mesh: TriangleMesh) -> bytes:
    """A stream with the faces of a mesh, and its positions or any others on any grid."""
    used, corners = np.unique(mesh.faces, return_inverse=True)
    faces, size = corners.reshape(-1, 3).astype(np.int32), len(used)
    coded = encode_connectivity(faces, size, random.choice([AS_CORNERS, ON_EDGES]))
    largest = [random.choice(LARGEST) for _ in range(3)]
    values = _values(random, mesh.positions[used][coded.vertex_order], largest)
    counts, left = [], size
    while left:
        counts.append(random.randrange(1, left + 1) if random.random() < 0.5 else left)
        left -= counts[-1]
    fields = {"grid": largest} | _fields(random, max(largest))
    if random.random() < 0.75:
        fields["transforms"] = any_transforms(random, random.randrange(17), largest)
        fields["whole"] = random.random() < 0.5
    return stream_of(gridded(coded, values, counts, **fields))


def _values(random: Random, positions: npt.NDArray[np.float64], largest: list[int]) -> Ints:
    """From 0 to `largest`: rounded positions, noise, ends of the range, or one value."""
    numbers, shape = np.random.default_rng(random.randrange(1 << 30)), positions.shape
    low, extent = positions.min(axis=0), np.ptp(positions, axis=0).max() or 1.0
    kinds = [
        np.clip(np.rint((positions - low) / extent * max(largest)), 0, largest),
        numbers.integers(0, np.array(largest) + 1, shape),
        np.where(numbers.random(shape) < 0.5, 0, largest),
        np.broadcast_to(numbers.integers(0, np.array(largest) + 1), shape),
    ]
    return np.asarray(kinds[random.choice((0, 0, 0, 1, 2, 3))], np.int32)


def _fields(random: Random, most: int) -> dict[str, Any]:
    """Some fields of a header."""
    fields: dict[str, Any] = {
        "light": random.choice((0, 1, 1)),
        "scale": random.choice((1.0, 0.25, 3.0)),
    }
    if random.random() < 0.25:
        points = max(1, most) + random.randrange(3)
        fields["lattice"] = [points + random.randrange(1000), points]
    if random.random() < 0.25:
        fields["corner"] = [random.randrange(-(1 << 20), 1 << 20) for _ in range(3)]
    return fields
