"""A manifest of tiles, and the index at the end of each shard: every number is checked where it is read."""

import json
import posixpath
import re
import shlex
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NoReturn

from bsm.bitstream.container.wire import MAJOR
from bsm.bitstream.errors import (
    BsmError,
    CorruptError,
    FormatError,
    TruncatedError,
    UnsupportedError,
)
from bsm.bitstream.limits import Limits
from bsm.files.pipes import Input, place_of
from bsm.files.stream import MANIFEST
from bsm.ground.console import printable
from bsm.jobs.task import Facts
from bsm.tiles.cutting import Lattice, Root
from bsm.tiles.reading import ABOUT, CARRIED, Kinds

FOOT = 16  # bytes behind the index of a shard
NO_JSON = (ValueError, KeyError, TypeError, AttributeError, RecursionError)
# These keep sums and products of such numbers finite, and exact as 64-bit integers.
_MOST, _FARTHEST_PLACE, _LARGEST = 1 << 60, 1 << 31, 1e290
_KINDS = ("|u1", "<u2", "<f4")  # of numbers that vertices have
_SUM = re.compile(r"[0-9a-f]{64}")


@dataclass(frozen=True)
class Tile:
    """The entry of a tile in an index: its node, the place of its bytes, and their contents."""

    name: str
    offset: int
    size: int
    sha256: str
    vertices: int
    faces: int
    error: float
    low: tuple[int, ...]
    high: tuple[int, ...]

    @property
    def level(self) -> int:
        return len(self.name) - 1


def json_of(name: str, limits: Limits) -> Any:
    """Return the contents of a JSON file of at most `limits.metadata_bytes`."""
    source = Input(name)
    # One byte more than allowed tells a file that is too large without reading all of it.
    data = source.peek(int(min(limits.metadata_bytes, _MOST)) + 1)
    source.close()
    limits.check("metadata_bytes", len(data))
    return parsed(data)


def parsed(data: bytes) -> Any:
    """Return what JSON text means; numbers that JSON does not have are a `ValueError`."""
    # Python reads NaN and Infinity, which JSON does not have. They would pass every comparison that asks whether a
    # number is too large.
    return json.loads(data, parse_constant=_refuse)


def _refuse(word: str) -> NoReturn:
    raise ValueError(f"{word} is not a number")


def read_manifest(path: str, limits: Limits) -> tuple[Facts, Lattice, Root, Kinds]:
    """Read the manifest of a folder or URL, and the parts of it that are computed with."""
    name = posixpath.join(path, MANIFEST)
    try:
        facts = json_of(place_of(path, MANIFEST), limits)
        if facts["format"] != "bsm tiles":
            raise KeyError("format")
        if facts["version"] != 1:
            raise FormatError(
                f"{name}: these tiles are of version {facts['version']!r}; this program knows 1"
            )
        # Refused here: otherwise each tile is refused on its own, with an error about a stream.
        if (major := facts.get("stream", 0)) != MAJOR:  # version 0 had no such entry
            advice = "a later release reads it"
            if major < MAJOR:
                advice = "encode the source again, or decode it with the release that wrote it"
            message = f"{name}: these tiles are written by version {major} of the format, and this reads {MAJOR}: "
            raise UnsupportedError(message + advice)
        if facts.get("complete") is False:
            resume = shlex.join(("bsm", "tile", str(facts["source"]), "-o", path, "--resume"))
            message = f"these tiles are unfinished; with its other options, {resume} goes on"
            raise TruncatedError(f"{name}: {printable(message)}")
        return _checked(facts)
    except BsmError:
        raise
    # Whatever is missing or of a wrong type raises one of these. A list of checks for each would be longer, and would
    # forget some.
    except NO_JSON as error:
        raise FormatError(f"{name}: this is not a manifest of tiles: {error!r:.300}") from error


def _checked(facts: Facts) -> tuple[Facts, Lattice, Root, Kinds]:
    cell, origin = real(facts["cell"]), tuple(map(real, _listed(facts["origin"], 3)))
    root = Root(places(facts["root"]["low"]), whole(facts["root"]["bits"], 1, 59))
    if not cell >= 1.0 / _LARGEST:
        raise ValueError(f"the cell is {cell}")
    # A name of a numpy type comes from the file. Others than these three could take any amount of memory.
    kinds = {
        what: (str(kind), whole(size, 3, 4))
        for what, (kind, size) in facts.get("attributes", {}).items()
    }
    if any(what not in CARRIED or kind not in _KINDS for what, (kind, _) in kinds.items()):
        raise ValueError("attributes")
    if not all(
        isinstance(facts[key], str) for key in ("source", *ABOUT) if key in facts or key == "source"
    ):
        raise ValueError("source, unit or up")
    for key in ("vertices", "faces"):
        whole(facts[key], 1)
    for number, level in enumerate(_listed(facts["levels"])):
        [whole(level[key], 1) for key in ("tiles", "faces", "bytes")]
        # A cube has at most 2^59 places along a side, so there are no deeper levels.
        if whole(level["level"]) > 60 or (
            number and level["level"] <= facts["levels"][number - 1]["level"]
        ):
            raise ValueError("the order of levels")
        real(level["error"], 0.0)
    for shard in _listed(facts["shards"]):
        # The name becomes a part of a path or URL. A name like ../x would lead out of the folder.
        if not re.fullmatch(r"\d{5,9}\.tiles", shard["file"]) or not _SUM.fullmatch(
            shard["sha256"]
        ):
            raise ValueError(shard["file"])
        whole(shard["index"], 2, whole(shard["size"]) - FOOT)
        whole(shard["tiles"], 1)
        ends(shard)
    if len({shard["file"] for shard in facts["shards"]}) < len(facts["shards"]):
        raise ValueError("a shard is named twice")
    return facts, Lattice(cell, origin), root, kinds


def parse_index(name: str, data: bytes, shard: Mapping[str, Any], root: Root) -> list[Tile]:
    """Return the tiles that an index, of a shard as the manifest describes it, names."""
    try:
        tiles = [Tile(**{**row, **dict(zip(("low", "high"), ends(row)))}) for row in parsed(data)]
        if len(tiles) != shard["tiles"] or len({tile.name for tile in tiles}) < len(tiles):
            raise ValueError(f"{len(tiles)} tiles")
        for tile in tiles:
            if (
                not re.fullmatch("r[0-7]{0,59}", tile.name)
                or tile.level > root.bits
                or not _SUM.fullmatch(tile.sha256)
            ):
                raise ValueError(tile.name)
            # An offset that is too large would make a server send nothing, or another tile.
            whole(tile.offset, 0, shard["size"] - shard["index"] - FOOT - whole(tile.size, 1))
            [whole(count, 1) for count in (tile.vertices, tile.faces)]
            real(tile.error, 0.0)
    except NO_JSON as error:
        raise CorruptError(
            f"{name}: the index at the end of this shard is invalid: {error!r:.300}"
        ) from error
    return tiles


def whole(value: Any, least: int = 0, most: int = _MOST) -> int:
    """Return a whole number within bounds."""
    if type(value) is not int or not least <= value <= most:
        raise ValueError(f"{value!s:.40} is not a whole number from {least} to {most}")
    return value


def real(value: Any, least: float = -_LARGEST) -> float:
    """Return a finite number."""
    if type(value) not in (int, float) or not least <= value <= _LARGEST:
        raise ValueError(f"{value!s:.40} is not a number from {least} on")
    return float(value)


def places(value: Any) -> tuple[int, ...]:
    """Return a place on the lattice."""
    return tuple(whole(number, -_FARTHEST_PLACE, _FARTHEST_PLACE) for number in _listed(value, 3))


def ends(box: Mapping[str, Any]) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """Return the lowest and the highest place of a tile or a shard."""
    low, high = places(box["low"]), places(box["high"])
    if any(a > b for a, b in zip(low, high)):
        raise ValueError("bounds")
    return low, high


def _listed(value: Any, size: int | None = None) -> Sequence[Any]:
    """Return a list of a size, or of anything at all."""
    if not isinstance(value, list) or len(value) != (size or len(value) or 1):
        raise ValueError(f"a list of {size or 'one or more'} is expected")
    return value
