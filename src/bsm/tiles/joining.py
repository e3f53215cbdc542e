"""The finest level as one mesh again: welded on the lattice, with the memory of a tile."""

from __future__ import annotations

import shutil
import tempfile
from contextlib import ExitStack
from typing import Any, BinaryIO

import numpy as np
import numpy.typing as npt

from bsm.console import Console
from bsm.files.output import open_output
from bsm.tiles.making import keys_of
from bsm.tiles.shards import Tiles

_COPIED = 1 << 24


def write_joined(tiles: Tiles, output: str, console: Console, *, overwrite: bool) -> dict[str, int]:
    """Write a binary PLY of the finest level; vertices that tiles share are one."""
    leaves = list(tiles.chosen(0.0))
    with ExitStack() as opened:
        places, faces, points, corners = (opened.enter_context(tempfile.TemporaryFile()) for _ in range(4))
        counts: list[tuple[int, int]] = []
        outside, single = [np.zeros((0, 3), np.int32)], True
        with console.progress("decoding", "tiles") as progress:
            for number, (shard, tile) in enumerate(leaves, 1):
                table, triangles = tiles.decoded(shard, tile)
                table.tofile(places)
                triangles.tofile(faces)
                counts.append((len(table), len(triangles)))
                positions = tiles.lattice.positions(table)
                single = single and bool((positions.astype(np.float32) == positions).all())
                outside.append(table[tiles.root.outside(tile.name, table)])
                progress(number, len(leaves))
        # Of what two tiles share one at least reaches out of its cube for it.
        shared = np.unique(np.concatenate(outside), axis=0)
        numbers = np.full(len(shared), -1, np.int64)
        vertices, kind = 0, "<f4" if single else "<f8"
        index = "<i4" if sum(count for count, _ in counts) < 1 << 31 else "<u4"
        places.seek(0)
        faces.seek(0)
        for size, triangles_of in counts:
            table = _read(places, np.int32, size)
            low = table.min(axis=0).astype(np.int64)
            near = np.flatnonzero(((shared >= low) & (shared <= table.max(axis=0))).all(axis=1))
            keys, known = keys_of(table, low), keys_of(shared[near], low)
            rows_of = np.flatnonzero(np.isin(keys, known))
            own = near[np.searchsorted(known, keys[rows_of])]
            given = np.full(size, -1, np.int64)
            given[rows_of] = numbers[own]
            fresh = np.flatnonzero(given < 0)
            given[fresh] = vertices + np.arange(len(fresh))
            numbers[own] = given[rows_of]
            vertices += len(fresh)
            tiles.lattice.positions(table[fresh]).astype(kind).tofile(points)
            rows = np.empty(triangles_of, [("length", "u1"), ("corners", index, (3,))])
            rows["length"], rows["corners"] = 3, given[_read(faces, np.int32, triangles_of)]
            rows.tofile(corners)
        total = sum(count for _, count in counts)
        header = (
            "ply\nformat binary_little_endian 1.0\n"
            f"element vertex {vertices}\n"
            + "".join(f"property {'float' if single else 'double'} {axis}\n" for axis in "xyz")
            + f"element face {total}\nproperty list uchar {'int' if index == '<i4' else 'uint'} vertex_indices\n"
            "end_header\n"
        )
        with open_output(output, overwrite=overwrite) as file, console.progress("writing"):
            file.write(header.encode())
            for part in (points, corners):
                part.seek(0)
                shutil.copyfileobj(part, file, _COPIED)
    return {"vertices": vertices, "faces": total}


def _read(file: BinaryIO, kind: Any, rows: int) -> npt.NDArray[Any]:
    return np.frombuffer(file.read(3 * rows * np.dtype(kind).itemsize), kind).reshape(-1, 3)
