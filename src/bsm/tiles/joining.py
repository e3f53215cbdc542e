"""Tiles for others: as one mesh again, welded on the lattice, or as 3D Tiles; with the memory of a tile."""

import json
import os
import posixpath
import shutil
import tempfile
from collections.abc import Iterable, Mapping
from contextlib import ExitStack
from dataclasses import replace
from typing import Any

import numpy as np

from bsm.bitstream.errors import OptionError, counted
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.welding import row_numbers
from bsm.files.conventions import placement
from bsm.files.formats.metadata import remarks
from bsm.files.formats.ply import table_of
from bsm.files.output import by_its_own_name, open_output, write_output
from bsm.files.pipes import is_url
from bsm.gltf.compress import compress
from bsm.gltf.document import Document
from bsm.gltf.write import vertex_normals, write_glb
from bsm.ground.console import Console
from bsm.jobs.task import Facts
from bsm.tiles.cutting import Ints
from bsm.tiles.manifest import Tile
from bsm.tiles.reading import CARRIED
from bsm.tiles.shards import Table, Tiles

_COPIED = 1 << 24
TILESET, _CONTENT = "tileset.json", "glb"
_NORMALS = "6bits"  # near those that decoders predict, so that they take a bit or two
# 3D Tiles knows one error for a tile. Without this factor, a viewer would load a finer tile only when texels of the
# coarse one are 16 pixels wide.
# Times its error, of a tile with a texture: viewers let errors have 16 pixels by default, not texels.
_SEEN = 16.0
CONTENTS = ("bsm", "plain")
CONTENT_HELP = "GLBs of a tileset: bsm (default, small), or plain, for programs without our decoder"


def write_joined(
    tiles: Tiles,
    chosen: Iterable[tuple[Facts, Tile]],
    output: str,
    console: Console,
    *,
    overwrite: bool,
) -> dict[str, int]:
    """Write a binary PLY of tiles; vertices that they share are one."""
    # The tiles are walked twice, first to find shared vertices, and then to number them.
    chosen = list(chosen)
    if not chosen:
        raise OptionError("no tile is that close to the mesh: give a larger --error, or a level")
    with by_its_own_name(tempfile.gettempdir()), ExitStack() as opened:
        # A PLY file has all vertices before all faces, and their number in its header. So both are collected in files
        # of their own until their numbers are known.
        tables, points, corners = (opened.enter_context(tempfile.TemporaryFile()) for _ in range(3))
        outside = list[Table]()
        kind: Any = np.float32
        with console.progress("decoding") as progress:
            for number, (shard, tile) in enumerate(chosen, 1):
                table, triangles = tiles.decoded(shard, tile)
                np.save(tables, table)
                np.save(tables, triangles)
                places = table[:, :3]
                positions = tiles.lattice.positions(places)
                # Floats of 32 bits are written if they hold every position exactly; doubles would double the file for
                # nothing.
                if not np.array_equal(positions.astype(kind), positions):
                    kind = np.float64
                outside.append(table[tiles.root.outside(tile.name, places)])
                progress(number, len(chosen))
        # Of what two tiles share one at least reaches out of its cube for it.
        # Only vertices outside of the cube of a tile can be shared. They are few, so this table fits into memory, and
        # the mesh need not.
        shared = np.unique(np.concatenate(outside), axis=0)
        # Index -1 is the last entry: vertices that are not shared look there, and always find that they have no number
        # yet.
        numbers = np.full(len(shared) + 1, -1, np.int64)  # the last for those that are not shared
        vertices = faces = 0
        tables.seek(0)
        for _ in chosen:
            table, triangles = np.load(tables), np.load(tables)
            rows = _places_in(shared, table)
            table_numbers = numbers[rows]
            fresh = np.flatnonzero(table_numbers < 0)
            table_numbers[fresh] = vertices + np.arange(len(fresh))
            is_shared = rows >= 0
            numbers[rows[is_shared]] = table_numbers[is_shared]
            vertices += len(fresh)
            faces += len(triangles)
            positions = tiles.lattice.positions(table[fresh, :3])
            columns = [*zip("xyz", positions.astype(kind).T)]
            for what, values in tiles.values(table[fresh]).items():
                columns += zip(CARRIED[what], values.T)
            point_lines, point_rows = table_of(columns)
            points.write(point_rows.tobytes())
            indices = table_numbers[triangles].astype(np.uint32)
            face_lines, face_rows = table_of([("vertex_indices", indices)])
            corners.write(face_rows.tobytes())
        comments = [f"comment {line}" for line in remarks(tiles.about)[0]]
        lines = [
            "ply",
            "format binary_little_endian 1.0",
            *comments,
            f"element vertex {vertices}",
            *point_lines,
        ]
        lines += [f"element face {faces}", *face_lines, "end_header", ""]
        with open_output(output, overwrite=overwrite) as file, console.progress("writing"):
            file.write("\n".join(lines).encode())
            for part in (points, corners):
                part.seek(0)
                shutil.copyfileobj(part, file, _COPIED)
    return {"vertices": vertices, "faces": faces}


def _places_in(shared: Table, table: Table) -> Ints:
    """Which of the `shared` vertices each one of a table is; -1: none."""
    places, shared_places = table[:, :3], shared[:, :3]
    # Comparing with the whole table would take quadratic time over all tiles.
    is_near = ((shared_places >= places.min(axis=0)) & (shared_places <= places.max(axis=0))).all(
        axis=1
    )
    near_rows = np.flatnonzero(is_near)
    numbers = row_numbers(np.concatenate([shared[near_rows], table]))
    near_numbers, table_numbers = np.split(numbers, [len(near_rows)])
    row_of_number = np.full(len(numbers), -1, np.int64)
    row_of_number[near_numbers] = near_rows
    return row_of_number[table_numbers]


def write_tileset(
    tiles: Tiles, folder: str, console: Console, *, content: str = CONTENTS[0], overwrite: bool
) -> int:
    """Write tileset.json of 3D Tiles 1.1, and beside it each tile as a GLB with normals; return their bytes."""
    tiles_by_name = {tile.name: (shard, tile) for shard, tile in tiles.all()}
    size, share = 0, 1.0
    ends = _ends(tile for _, tile in tiles_by_name.values())
    if not is_url(folder):
        contents = os.path.join(folder, _CONTENT)
        os.makedirs(contents, exist_ok=True)
        if os.path.islink(contents):
            raise OptionError(f"{contents} is a symbolic link; remove it")
    needs_normals = "normal" not in tiles.kinds
    codings = {}
    if needs_normals:
        codings["NORMAL"] = _NORMALS
    options = {"grid_cell": tiles.lattice.cell, "effort": "quick", "attributes": codings}
    with console.progress("writing") as progress:
        for number, (name, (shard, tile)) in enumerate(tiles_by_name.items(), 1):
            mesh = tiles.mesh(shard, tile)
            # glTF holds single precision. Positions from the corner of the tile are small integers times the cell, and
            # keep all bits.
            places = tiles.lattice.cells(mesh.positions) - ends[name][0]
            moved = (places * tiles.lattice.cell).astype(np.float32).astype(np.float64)
            # Viewers of 3D Tiles draw a mesh without normals flat, or not at all.
            attributes = [*mesh.attributes]
            if needs_normals:
                normals = vertex_normals(moved, mesh.faces).astype(np.float32)
                attributes.append(Attribute("normal", normals, "vertex", "normal"))
            metadata = {**mesh.metadata, "up": "z"}
            mesh = replace(mesh, positions=moved, attributes=tuple(attributes), metadata=metadata)
            if metadata.get("image.0.data"):
                share = _SEEN
            data = write_glb(mesh, name).data
            if content == "bsm":
                data = compress(Document(data), options).data
            write_output(
                posixpath.join(folder, f"{_CONTENT}/{name}.glb"),
                data,
                overwrite=overwrite,
                follow=False,
            )
            size += len(data)
            progress(number, len(tiles_by_name))
    errors = {name: share * tile.error for name, (_, tile) in tiles_by_name.items()}
    data = json.dumps(_tree(tiles, errors, ends)).encode() + b"\n"
    path = posixpath.join(folder, TILESET)
    write_output(path, data, overwrite=overwrite, follow=False)
    console.note(f"{path}: {counted(tiles=len(tiles_by_name))} as {content} GLB, {size} bytes")
    return size + len(data)


def _ends(tiles: Iterable[Tile]) -> dict[str, Ints]:
    """The lowest and the highest place of each node and all below it."""
    ends: dict[str, Ints] = {}
    for tile in tiles:
        own_box = np.array([tile.low, tile.high], np.int64)
        for size in range(1, len(tile.name) + 1):
            name = tile.name[:size]
            low, high = ends.get(name, own_box)
            ends[name] = np.array([np.minimum(low, own_box[0]), np.maximum(high, own_box[1])])
    return ends


def _tree(tiles: Tiles, errors: Mapping[str, float], ends: Mapping[str, Ints]) -> Facts:
    """The nodes of a tileset, of which those with an error have contents."""
    placed = placement(tiles.about, "tileset")
    cell = tiles.lattice.cell
    diagonal = cell * float(np.linalg.norm(np.ptp(ends["r"], axis=0)))

    def node(name: str, around: Ints) -> Facts:
        """A node of the octree, where `around` is the lowest place of the one above."""
        low, high = ends[name]
        half = (high - low) * cell / 2
        moved = (low - around) * cell
        # A node without a tile of its own has the largest error there is, so that viewers go on to its children at
        # once.
        facts: Facts = {"geometricError": errors.get(name, diagonal), "refine": "REPLACE"}
        facts["boundingVolume"] = {"box": [*half.tolist(), *np.diag(half).ravel().tolist()]}
        facts["transform"] = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, *moved.tolist(), 1]
        if name in errors:
            facts["content"] = {"uri": f"{_CONTENT}/{name}.glb"}
        children = [name + eighth for eighth in "01234567"]
        facts["children"] = [node(child, low) for child in children if child in ends]
        if not facts["children"]:
            del facts["children"]
        return facts

    low = ends["r"][0]
    root = node("r", low)
    moved = np.eye(4)  # from the mesh to meters with z up
    # 3D Tiles has meters and z up. One matrix at the root turns and scales everything, and no position changes.
    moved[:3, :3] = placed.matrix
    moved[:3, 3] = placed.matrix @ tiles.lattice.positions(low)
    root["transform"] = moved.T.ravel().tolist()
    return {
        "asset": {"version": "1.1", "generator": "bsm"},
        "geometricError": diagonal * placed.scale,
        "root": root,
    }
