"""Tiles as one mesh again: welded on the lattice, with the memory of a tile."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Iterable
from contextlib import ExitStack
from typing import Any, BinaryIO

import numpy as np
import numpy.typing as npt

from bsm.console import Console
from bsm.files.output import open_output
from bsm.jobs.report import Facts
from bsm.tiles.making import keys_of
from bsm.tiles.reading import CARRIED
from bsm.tiles.shards import KINDS, Tile, Tiles

_COPIED = 1 << 24


def write_joined(
    tiles: Tiles, chosen: Iterable[tuple[Facts, Tile]], output: str, console: Console, *, overwrite: bool
) -> dict[str, int]:
    """Write a binary PLY of tiles; vertices that they share are one."""
    chosen = list(chosen)
    with ExitStack() as opened:
        tables, faces, points, corners = (opened.enter_context(tempfile.TemporaryFile()) for _ in range(4))
        counts: list[tuple[int, int]] = []
        outside, single = [tiles.decoded(*chosen[0])[0][:0]], True
        width = outside[0].shape[1]
        with console.progress("decoding", "tiles") as progress:
            for number, (shard, tile) in enumerate(chosen, 1):
                table, triangles = tiles.decoded(shard, tile)
                table.tofile(tables)
                triangles.tofile(faces)
                counts.append((len(table), len(triangles)))
                positions = tiles.lattice.positions(table[:, :3])
                single = single and bool((positions.astype(np.float32) == positions).all())
                outside.append(table[tiles.root.outside(tile.name, table[:, :3])])
                progress(number, len(chosen))
        # Of what two tiles share one at least reaches out of its cube for it.
        shared = np.unique(np.concatenate(outside), axis=0)
        numbers = np.full(len(shared), -1, np.int64)
        vertices, total = 0, sum(count for _, count in counts)
        index = "<i4" if total < 1 << 31 else "<u4"
        row = _row_of(tiles, single)
        tables.seek(0)
        faces.seek(0)
        for size, triangles_of in counts:
            table = _read(tables, np.int32, size, width)
            low, high = table[:, :3].min(axis=0).astype(np.int64), table[:, :3].max(axis=0)
            near = np.flatnonzero(((shared[:, :3] >= low) & (shared[:, :3] <= high)).all(axis=1))
            rows_of = np.flatnonzero(np.isin(keys_of(table[:, :3], low), keys_of(shared[near, :3], low)))
            different, which = np.unique(np.concatenate([shared[near], table[rows_of]]), axis=0, return_inverse=True)
            known = np.full(len(different), -1, np.int64)
            known[which.reshape(-1)[: len(near)]] = near
            own = known[which.reshape(-1)[len(near) :]]
            rows_of, own = rows_of[own >= 0], own[own >= 0]
            given = np.full(size, -1, np.int64)
            given[rows_of] = numbers[own]
            fresh = np.flatnonzero(given < 0)
            given[fresh] = vertices + np.arange(len(fresh))
            numbers[own] = given[rows_of]
            vertices += len(fresh)
            rows = np.empty(len(fresh), row)
            rows["places"] = tiles.lattice.positions(table[fresh, :3])
            for what, values in tiles.values(table[fresh]).items():
                rows[what] = values
            rows.tofile(points)
            ends = np.empty(triangles_of, [("length", "u1"), ("corners", index, (3,))])
            ends["length"], ends["corners"] = 3, given[_read(faces, np.int32, triangles_of, 3)]
            ends.tofile(corners)
        words = [("float" if single else "double", axis) for axis in "xyz"]
        for what, (kind, size) in tiles.kinds.items():
            words += [(KINDS[kind], name) for name in CARRIED[what][:size]]
        header = (
            f"ply\nformat binary_little_endian 1.0\nelement vertex {vertices}\n"
            + "".join(f"property {kind} {name}\n" for kind, name in words)
            + f"element face {total}\nproperty list uchar {'int' if index == '<i4' else 'uint'} vertex_indices\n"
            "end_header\n"
        )
        with open_output(output, overwrite=overwrite) as file, console.progress("writing"):
            file.write(header.encode())
            for part in (points, corners):
                part.seek(0)
                shutil.copyfileobj(part, file, _COPIED)
    return {"vertices": vertices, "faces": total}


def _row_of(tiles: Tiles, single: bool) -> np.dtype[Any]:
    """A vertex as it stands in the file."""
    carried = [(what, kind, (size,)) for what, (kind, size) in tiles.kinds.items()]
    return np.dtype([("places", "<f4" if single else "<f8", (3,)), *carried])


def _read(file: BinaryIO, kind: Any, rows: int, columns: int) -> npt.NDArray[Any]:
    return np.frombuffer(file.read(columns * rows * np.dtype(kind).itemsize), kind).reshape(-1, columns)
