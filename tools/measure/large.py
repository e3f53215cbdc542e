"""A mesh of any size, written piece by piece: a scan whose triangles are cut small, displaced by a made field."""

from __future__ import annotations

import argparse
from typing import Any

import numpy as np

from bsm.codec.geometry.metrics import face_normals
from bsm.files.mesh import read_mesh

_PIECE = 1 << 12  # triangles of the scan at a time
_WAVES = ((31.0, 0.004), (113.0, 0.0012), (411.0, 0.0003))  # across the scan, and how high, in its size


def main() -> None:
    """Write a binary PLY."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("mesh", help="a scan")
    parser.add_argument("times", type=int, help="pieces of each edge; vertices and faces grow by its square")
    parser.add_argument("output", help=".ply")
    parser.add_argument("--colours", action="store_true", help="with colours and normals")
    args = parser.parse_args()
    mesh = read_mesh(args.mesh).mesh
    times, count = args.times, len(mesh.positions)
    sides = np.sort(mesh.faces[:, [[0, 1], [1, 2], [2, 0]]], axis=2).reshape(-1, 2)
    edges, edge_of = np.unique(sides, axis=0, return_inverse=True)
    edge_of = edge_of.reshape(-1, 3)
    grid = np.array([(i, j) for i in range(times + 1) for j in range(times + 1 - i)])
    weights = np.column_stack([times - grid.sum(axis=1), grid]) / times
    inner = np.flatnonzero((weights > 0).all(axis=1))
    total = count + len(edges) * (times - 1) + len(mesh.faces) * len(inner)
    index = np.full((times + 1, times + 1), -1)
    index[tuple(grid.T)] = np.arange(len(grid))
    up = [(index[i, j], index[i + 1, j], index[i, j + 1]) for i, j in grid if i + j < times]
    down = [(index[i + 1, j], index[i + 1, j + 1], index[i, j + 1]) for i, j in grid if i + j < times - 1]
    small = np.array(up + down)
    size = float(np.ptp(mesh.positions, axis=0).max())
    normals = np.zeros_like(mesh.positions)
    np.add.at(normals, mesh.faces, face_normals(mesh.positions, mesh.faces)[:, None])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
    low = mesh.positions.min(axis=0)

    def displaced(positions: Any, along: Any) -> Any:
        turns = 2 * np.pi * (positions - low) / size
        height = sum(high * np.sin(turns * often / 4 + often).sum(axis=1) for often, high in _WAVES) * size / 3
        return positions + along * height[:, None], height / size

    kinds = [(axis, "<f4") for axis in "xyz"]
    if args.colours:
        kinds += [(name, "<f4") for name in ("nx", "ny", "nz")] + [(name, "u1") for name in ("red", "green", "blue")]
    word = {"<f4": "float", "u1": "uchar"}
    with open(args.output, "wb") as file:
        lines = ["ply", "format binary_little_endian 1.0", f"element vertex {total}"]
        lines += [f"property {word[kind]} {name}" for name, kind in kinds]
        lines += [
            f"element face {len(mesh.faces) * len(small)}",
            "property list uchar int vertex_indices",
            "end_header",
        ]
        file.write(("\n".join(lines) + "\n").encode())

        def write(positions: Any, along: Any) -> None:
            moved, height = displaced(positions, along)
            rows = np.zeros(len(moved), kinds)
            for axis, values in zip("xyz", moved.T):
                rows[axis] = values
            if args.colours:
                for name, values in zip(("nx", "ny", "nz"), along.T):
                    rows[name] = values
                for name, values in zip(("red", "green", "blue"), moved.T):
                    rows[name] = np.clip(128 + 12_000 * height + 60 * np.sin(9 * values / size), 0, 255)
            rows.tofile(file)

        def mixed(corners: Any, shares: Any) -> tuple[Any, Any]:
            shape = "kv,nvc->nkc"
            return tuple(np.einsum(shape, shares, of[corners]).reshape(-1, 3) for of in (mesh.positions, normals))

        write(mesh.positions, normals)
        along = np.arange(1, times)[:, None] / times
        for first in range(0, len(edges), _PIECE):
            write(*mixed(edges[first : first + _PIECE], np.hstack([1 - along, along])))
        for first in range(0, len(mesh.faces), _PIECE):
            write(*mixed(mesh.faces[first : first + _PIECE], weights[inner]))
        rows = np.zeros(_PIECE * len(small), [("length", "u1"), ("corners", "<i4", 3)])
        rows["length"] = 3
        for first in range(0, len(mesh.faces), _PIECE):
            faces, ends = mesh.faces[first : first + _PIECE], edge_of[first : first + _PIECE]
            own = np.zeros((len(faces), len(grid)), np.int64)
            for side, (begin, end) in enumerate(((0, 1), (1, 2), (2, 0))):
                on = np.flatnonzero((weights[:, 3 - begin - end] == 0) & ((weights > 0).sum(axis=1) == 2))
                step = np.rint(weights[on, end] * times).astype(int)
                forward = faces[:, begin] < faces[:, end]
                step = np.where(forward[:, None], step, times - step) - 1
                own[:, on] = count + ends[:, side, None] * (times - 1) + step
            for corner in range(3):
                own[:, np.flatnonzero(weights[:, corner] == 1)[0]] = faces[:, corner]
            begin = count + len(edges) * (times - 1) + first * len(inner)
            own[:, inner] = begin + np.arange(len(faces) * len(inner)).reshape(len(faces), -1)
            made = own[:, small].reshape(-1, 3)
            rows["corners"][: len(made)] = made
            rows[: len(made)].tofile(file)
    print(f"{args.output}: {total} vertices, {len(mesh.faces) * len(small)} faces")
