"""Tiles in few files: shards with an index at their end, and a manifest; written once, read by ranges."""

import json
import os
import posixpath
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from hashlib import sha256
from pathlib import Path
from types import NoneType
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from bsm.bitstream.container.wire import MAJOR
from bsm.bitstream.errors import (
    ArgumentError,
    BsmError,
    CorruptError,
    FormatError,
    OptionError,
    public,
)
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import Metadata, TriangleMesh
from bsm.codec.geometry.welding import split_by_attributes
from bsm.files.libraries import as_decoded
from bsm.files.output import open_output, write_output
from bsm.files.pipes import about, is_pipe, named, place_of, read_range
from bsm.files.stream import MANIFEST, decode_whole
from bsm.jobs.task import Facts
from bsm.tiles.cutting import Lattice, Plan, Root
from bsm.tiles.making import Faces
from bsm.tiles.manifest import FOOT, NO_JSON, Tile, json_of, parse_index, read_manifest
from bsm.tiles.reading import ABOUT, Kinds

Table: TypeAlias = npt.NDArray[np.float64]
# Millions of small files are slow on every file system and in every object store. Servers answer ranges of large files,
# and 64 MB can still be sent again after an error.
SHARD, MOST_TILES = 64_000_000, 1 << 14  # bytes, and tiles, from which on a shard takes no more
_END = b"BSMTILES"  # behind the length of the index, the last bytes of a shard


# A killed run leaves this manifest. Readers then say that the tiles are unfinished, and not that they are damaged.
def write_unfinished(folder: str, source: str) -> None:
    """Write the manifest of a run that has not ended."""
    manifest = {
        "format": "bsm tiles",
        "version": 1,
        "stream": MAJOR,
        "source": source,
        "complete": False,
    }
    write_output(
        posixpath.join(folder, MANIFEST),
        json.dumps(manifest).encode(),
        overwrite=True,
        follow=False,
    )


def is_unfinished(folder: str) -> bool | None:
    """Whether a folder holds the manifest of a run that has not ended; None: none. One that is not ours stays."""
    name = posixpath.join(folder, MANIFEST)
    try:
        if is_pipe(name):
            raise KeyError(name)
        manifest = json_of(name, DEFAULT_LIMITS)
        if manifest["format"] != "bsm tiles":
            raise KeyError(manifest["format"])
        return manifest.get("complete") is False
    except FileNotFoundError:
        return None
    except NO_JSON as error:
        raise FormatError(
            f"{name} exists and is not a tile manifest; choose another folder or delete it"
        ) from error


def write_shards(
    folder: str, plan: Plan, shards_done: Sequence[Facts], source: str, *, overwrite: bool
) -> tuple[Facts, int]:
    """Write tiles in their order, and the manifest when all else is there; return it, and all bytes."""
    # Reversed, because `pop` takes from the end.
    shards, tiles, waiting = list[Facts](), list[Tile](), list(reversed(shards_done))
    while waiting:
        shard, tiles_written = _write_shard(folder, f"{len(shards):05}.tiles", waiting, overwrite)
        shards.append(shard)
        tiles += tiles_written
    levels: list[Facts] = []
    for number in sorted({tile.level for tile in tiles}):
        of_level = [tile for tile in tiles if tile.level == number]
        sums = {
            "faces": sum(tile.faces for tile in of_level),
            "bytes": sum(tile.size for tile in of_level),
        }
        error = max(tile.error for tile in of_level)
        levels.append({"level": number, "tiles": len(of_level), **sums, "error": error})
    manifest = {
        "format": "bsm tiles",
        "version": 1,
        "stream": MAJOR,
        "source": source,
        "cell": plan.lattice.cell,
        "origin": plan.lattice.origin,
        "root": {"low": plan.low, "bits": plan.bits},
        "attributes": {what: plan.kinds[what] for what in plan.carried},
        **plan.about,
        "vertices": plan.vertices,
        "faces": plan.faces,
        "levels": levels,
        "shards": shards,
    }
    # The manifest is written last. It names the digests of the indexes, and these those of the tiles: a reader
    # of it can check everything.
    text = json.dumps(manifest, indent=1).encode() + b"\n"
    write_output(posixpath.join(folder, MANIFEST), text, overwrite=True, follow=False)
    return manifest, sum(shard["size"] for shard in shards) + len(text)


def _write_shard(
    folder: str, name: str, waiting: list[Facts], overwrite: bool
) -> tuple[Facts, list[Tile]]:
    """Write as many of the last tiles as a shard holds; return its entry in the manifest, and these tiles."""
    tiles: list[Tile] = []
    with open_output(posixpath.join(folder, name), overwrite=overwrite, follow=False) as file:
        offset = 0
        while waiting and offset < SHARD and len(tiles) < MOST_TILES:
            facts = waiting.pop()
            data, node = Path(facts["output"]).read_bytes(), Path(facts["output"]).stem
            counts = facts["vertices"], facts["faces"], facts["apart"]
            ends = tuple(facts["low"]), tuple(facts["high"])
            tiles.append(Tile(node, offset, len(data), facts["output_sha256"], *counts, *ends))
            offset += file.write(data)
        # The index stands at the end, since sizes and digests of tiles are known only when they are written. A reader
        # gets it by one range, because the manifest has its size.
        index = json.dumps([asdict(tile) for tile in tiles], separators=(",", ":")).encode()
        file.write(index + len(index).to_bytes(8, "little") + _END)
    shard = {
        "file": name,
        "size": offset + len(index) + FOOT,
        "index": len(index),
        "tiles": len(tiles),
    }
    lows, highs = zip(*((tile.low, tile.high) for tile in tiles))
    ends_of = {"low": np.min(lows, axis=0).tolist(), "high": np.max(highs, axis=0).tolist()}
    return shard | {"sha256": sha256(index).hexdigest(), **ends_of}, tiles


def open_tiles(path: str | os.PathLike[str], limits: Limits = DEFAULT_LIMITS) -> "Tiles":
    """Open a folder of tiles that `bsm tile` wrote. Only its manifest is read.

    Parameters
    ----------
    path : path
        A folder, or a URL of one.
    limits : Limits
        Of each tile.

    Returns
    -------
    Tiles

    Raises
    ------
    FormatError, UnsupportedError, TruncatedError
        If the folder has no tile manifest, its version is unknown, or the run that wrote it is unfinished.
    OSError
        If it cannot be read.

    Examples
    --------
    >>> import bsm
    >>> part = bsm.open_tiles("scan").region((0, 0, 0), (1, 1, 1), error=0.01)
    """
    name = named(path)
    # Tiles may lie on a server. Opening them costs one request, and no index is fetched before it is needed.
    manifest, lattice, root, kinds = read_manifest(name, limits)
    return Tiles(name, manifest, lattice, root, limits, kinds)


@public
@dataclass(frozen=True, eq=False)
class Tiles:
    """A mesh in tiles, made by `open_tiles`.

    Parameters
    ----------
    path : str
        The folder or URL.
    manifest : mapping
        Contents of its manifest: `cell` and `origin` of the grid, `levels`, `shards`.
    lattice : Lattice
        The grid of the positions.
    root : Root
        The cube that is divided into eighths.
    limits : Limits
        Of each tile.
    kinds : mapping
        Attributes of vertices by name: the type of the numbers, and the number of components.

    Raises
    ------
    CorruptError
        Raised by methods that read tiles, if bytes of a shard are missing or changed.

    Examples
    --------
    >>> import bsm
    >>> tiles = bsm.open_tiles("scan")
    >>> [level["tiles"] for level in tiles.manifest["levels"]]
    [1]
    """

    path: str
    manifest: Mapping[str, Any]
    lattice: Lattice
    root: Root
    limits: Limits = DEFAULT_LIMITS
    kinds: Kinds = field(default_factory=dict)
    _held: dict[str, list[Tile]] = field(default_factory=dict, init=False, repr=False)

    @property
    def about(self) -> Metadata:
        return as_decoded({name: self.manifest[name] for name in ABOUT if name in self.manifest})

    def region(
        self,
        low: Sequence[float],
        high: Sequence[float],
        error: float = 0.0,
        *,
        level: int | None = None,
    ) -> TriangleMesh:
        """Join the triangles whose bounding boxes meet a box: of the coarsest tiles within `error`, or of a `level`.

        An error of 0 is the finest level. Level 0 is the coarsest; where a level has no tile, the finest is used.
        """
        try:
            ends = np.array([low, high], np.float64)
        except (TypeError, ValueError, OverflowError):
            ends = np.empty(0)
        if ends.shape != (2, 3) or not np.isfinite(ends).all():
            raise ArgumentError("a box has a low and a high corner of three numbers each")
        if not isinstance(error, (int, float, np.number)) or not isinstance(
            level, (int, np.integer, NoneType)
        ):
            raise ArgumentError(
                f"error must be a number, and level a whole one, not {error!r} and {level!r}"
            )
        # The box is moved to the lattice, and not the vertices to the box: those are exact integers there.
        box = (ends - np.array(self.lattice.origin)) / self.lattice.cell
        tables, triangles, first = [], [], 0
        for shard, tile in self.chosen(error, box, level):
            table, faces = self.decoded(shard, tile)
            corners = table[faces, :3]
            faces = faces[
                ((corners.max(axis=1) >= box[0]) & (corners.min(axis=1) <= box[1])).all(axis=1)
            ]
            tables.append(table)
            triangles.append(faces + first)
            first += len(table)
        if not sum(map(len, triangles)):
            raise OptionError("no part of the mesh is in this box")
        used, rows = np.unique(np.concatenate(triangles), return_inverse=True)
        # Vertices on borders come with each tile. They are equal to the last bit, so equal rows are one vertex.
        different, numbers = np.unique(np.concatenate(tables)[used], axis=0, return_inverse=True)
        joined = numbers.reshape(-1)[rows].reshape(-1, 3).astype(np.int32)
        return TriangleMesh(
            self.lattice.positions(different[:, :3]), joined, self.attributes(different), self.about
        )

    def attributes(self, table: Table) -> tuple[Attribute, ...]:
        """Return the attributes of vertices, shape (n, 3 and more), as those of a mesh."""
        return tuple(
            Attribute(what, values, "vertex", what)  # type: ignore[arg-type]
            for what, values in self.values(table).items()
        )

    def values(self, table: Table) -> dict[str, npt.NDArray[Any]]:
        """Return the attribute values of vertices, shape (n, 3 and more), by name; shape (n, c)."""
        tables, column = {}, 3
        for what, (kind, size) in self.kinds.items():
            tables[what] = table[:, column : column + size].astype(kind)
            column += size
        return tables

    def chosen(
        self, error: float = 0.0, box: Any = None, level: int | None = None
    ) -> Iterator[tuple[Facts, Tile]]:
        """Return the coarsest tiles of at most this error, or those of a level, that meet a box."""
        tiles_by_name = {tile.name: (shard, tile) for shard, tile in self.all(box)}
        names_taken: set[str] = set()
        # A leaf is known by having no child among the tiles that meet the box. An error of 0 does not tell it.
        inner = {name[:-1] for name in tiles_by_name}
        for name in sorted(tiles_by_name, key=lambda name: (len(name), name)):
            tile = tiles_by_name[name][1]
            leaf = name not in inner  # others may have an error of 0, too, as where all is flat
            if level is None:
                fits = tile.error <= error and (leaf or error > 0.0)
            else:
                fits = tile.level == level or leaf
            if name[:-1] in names_taken:
                names_taken.add(name)
            elif fits:
                names_taken.add(name)
                if box is None or _meet(box, tile.low, tile.high):
                    yield tiles_by_name[name]

    def all(self, box: Any = None) -> Iterator[tuple[Facts, Tile]]:
        """Return the tiles of all shards, or of those that meet a box."""
        for shard in self.manifest["shards"]:
            if box is None or _meet(box, shard["low"], shard["high"]):
                yield from ((shard, tile) for tile in self.index(shard))

    def index(self, shard: Facts) -> list[Tile]:
        """Return the index of a shard."""
        if shard["file"] in self._held:
            return self._held[shard["file"]]
        name, size = place_of(self.path, shard["file"]), shard["index"] + FOOT
        self.limits.check("metadata_bytes", size)
        data = read_range(name, shard["size"] - size, size)
        index = data[: shard["index"]]
        # The digest alone would do; the length and the mark tell people, and other programs, where the index begins.
        if (
            data[-FOOT:] != len(index).to_bytes(8, "little") + _END
            or sha256(index).hexdigest() != shard["sha256"]
        ):
            raise CorruptError(
                f"{name}: the index at the end of this shard differs from the manifest"
            )
        tiles = parse_index(name, index, shard, self.root)
        # Copied, since another thread may add to the dictionary while this one walks over it.
        others = [
            kept_file for file, kept_file in [*self._held.items()] if file != shard["file"]
        ]  # a thread may have been here
        if twice := {tile.name for tile in tiles} & {
            tile.name for kept_file in others for tile in kept_file
        }:
            raise CorruptError(f"{name}: tile {min(twice)} is in another shard, too")
        self._held[shard["file"]] = tiles
        return tiles

    def data(self, shard: Facts, tile: Tile) -> bytes:
        """The stream of a tile."""
        name = place_of(self.path, shard["file"])
        data = read_range(name, tile.offset, tile.size)
        if sha256(data).hexdigest() != tile.sha256:
            raise CorruptError(
                f"{name}: tile {tile.name} differs from the index", offset=tile.offset
            )
        return data

    def mesh(self, shard: Facts, tile: Tile) -> TriangleMesh:
        """A tile, whose vertices are where the index says."""
        name = f"{posixpath.join(self.path, shard['file'])}, tile {tile.name}"
        with about(name):
            mesh = decode_whole(iter([self.data(shard, tile)]), self.limits)
        cells = self.lattice.cells(mesh.positions)
        # A viewer trusts the box of the index. A tile outside of it would be missing from pictures without any error.
        if not ((cells >= tile.low) & (cells <= tile.high)).all():
            raise CorruptError(f"{name} is not where the index says that it is")
        return mesh

    def decoded(self, shard: Facts, tile: Tile) -> tuple[Table, Faces]:
        """The vertices on the grid, shape (n, 3 and more), with what else they have; and faces, (m, 3)."""
        mesh = self.mesh(shard, tile)
        mesh = split_by_attributes(
            replace(mesh, attributes=tuple(a for a in mesh.attributes if a.name in self.kinds))
        )
        columns = [self.lattice.cells(mesh.positions)]
        carried = {attribute.name: attribute.values for attribute in mesh.attributes}
        for what, (kind, size) in self.kinds.items():
            values = carried.get(what)
            if values is None or values.shape[1] != size or values.dtype != np.dtype(kind):
                raise CorruptError(
                    f"{self.path}, tile {tile.name} has no {what} as the manifest says"
                )
            columns.append(values)
        return np.column_stack(columns).astype(np.float64), mesh.faces

    def faults(self, decode: bool) -> Iterator[BsmError | OSError]:
        """Yield all faults, shard by shard and tile by tile."""
        for shard in self.manifest["shards"]:
            try:
                tiles = self.index(shard)
            except (BsmError, OSError) as error:
                yield error
                continue
            for tile in tiles:
                try:
                    # One fault does not end the check, so that a user sees at once which tiles to fetch or make again.
                    if decode:
                        self.decoded(shard, tile)
                    else:
                        self.data(shard, tile)
                except (BsmError, OSError) as error:
                    yield error


def _meet(box: Any, low: Sequence[float], high: Sequence[float]) -> bool:
    return bool((box[0] <= np.array(high)).all() and (box[1] >= np.array(low)).all())
