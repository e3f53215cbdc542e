"""`python -m tools.attack manifests`: manifests and indexes of tiles, mutated by their grammar.

Each mutant is opened, verified, shown as `bsm info` shows it, joined to a mesh and written as a tileset. Whatever comes
out must be a result or an error of ours.
"""

import copy
import json
import signal
import tempfile
import traceback
from collections.abc import Iterator
from contextlib import suppress
from hashlib import sha256
from pathlib import Path
from random import Random
from typing import Any

import numpy as np

from bsm.api import save
from bsm.bitstream.errors import BsmError
from bsm.bitstream.limits import Limits
from bsm.cli import main as program
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.commands.info import _tile_lines
from bsm.files.stream import MANIFEST
from bsm.ground.console import Console, as_json
from bsm.tiles.joining import write_joined, write_tileset
from bsm.tiles.manifest import FOOT
from bsm.tiles.shards import open_tiles
from tools.command import parser_of
from tools.vectors.meshes import torus

VALUES: tuple[Any, ...] = (
    *(
        None,
        True,
        False,
        "",
        "r",
        "r0",
        "00000.tiles",
        "../a",
        "\0",
        "x" * 5000,
        [],
        {},
        [[]],
        [0],
        [0, 0, 0],
        {"a": 1},
    ),
    *(0, -1, 1, 2, 63, 64, 2**31, -(2**31), 2**53, 2**62, 2**63, 2**64, 2**70, -(2**70), 10**290, 10**299, 10**400),
    *(0.0, -0.0, 0.5, 1.0, 1.5, -1.5, 1e-300, 5e-324, 1e290, 1e299, 1e308, -1e308),
    *(float("nan"), float("inf"), -float("inf")),
)
MOST_SECONDS = 20
Path_ = tuple[Any, ...]


def paths(tree: Any, at: Path_ = ()) -> Iterator[Path_]:
    """The place of every value in a tree."""
    for key in tree if isinstance(tree, dict) else range(len(tree)) if isinstance(tree, list) else ():
        yield (*at, key)
        yield from paths(tree[key], (*at, key))


def changed(tree: Any, random: Random) -> Any:
    """The tree with a value replaced, moved, repeated or left out."""
    places = list(paths(tree))
    if not places:
        return random.choice(VALUES)
    *above, key = random.choice(places)
    inside = tree
    for step in above:
        inside = inside[step]
    match random.randrange(8):
        case 0:
            del inside[key]
        case 1 if isinstance(inside, list):
            inside.insert(key, copy.deepcopy(inside[random.randrange(len(inside))]))
        case 1:
            inside[str(random.choice(VALUES))[:10]] = random.choice(VALUES)
        case 2:
            other = random.choice(places)
            value = tree
            for step in other:
                value = value[step]
            inside[key] = copy.deepcopy(value)
        case 3 if type(inside[key]) in (int, float):
            with suppress(OverflowError):  # values beyond the range of a float
                inside[key] += random.choice((-1, 1, 0.5, 2**20, -(2**20)))
        case 4 if type(inside[key]) in (int, float):
            with suppress(OverflowError):
                inside[key] *= random.choice((-1, 2, 2.0, 10**6, 1e300))
        case _:
            inside[key] = copy.deepcopy(random.choice(VALUES))
    return tree


class Folder:
    """A folder of tiles that is made anew for each mutant."""

    def __init__(self, folder: Path) -> None:
        self.path, mesh = folder, torus(16, 12)
        colored = TriangleMesh(mesh.positions, mesh.faces)
        source = folder.with_suffix(".ply")
        save(colored, str(source))
        words = ["tile", str(source), "-o", str(folder), "--triangles", "100", "--grid-cell", "0.0009765625", "-q"]
        if program(words):
            raise AssertionError("the sample was not made")
        self.manifest = json.loads((folder / MANIFEST).read_text())
        (shard,) = self.manifest["shards"]
        data = (folder / shard["file"]).read_bytes()
        self.tiles, index = data[: -shard["index"] - FOOT], data[-shard["index"] - FOOT : -FOOT]
        self.index, self.end = json.loads(index), data[-FOOT + 8 :]

    def mutate(self, random: Random) -> None:
        """Write a mutant: its sums and sizes are right again, unless these are what is changed."""
        manifest, index = copy.deepcopy(self.manifest), copy.deepcopy(self.index)
        for _ in range(random.choice((0, 0, 1, 1, 2))):
            index = changed(index, random)
        text = json.dumps(index).encode()
        data = self.tiles + text + len(text).to_bytes(8, "little") + self.end
        shard = manifest["shards"][0]
        shard |= {"size": len(data), "index": len(text), "sha256": sha256(text).hexdigest()}
        if isinstance(index, list) and random.random() < 0.8:
            shard["tiles"] = len(index)
        for _ in range(random.choice((0, 1, 1, 2, 3))):
            manifest = changed(manifest, random)
        (self.path / self.manifest["shards"][0]["file"]).write_bytes(data)
        written = json.dumps(manifest).encode()
        if random.random() < 0.05:
            written = written[: random.randrange(len(written))]
        (self.path / MANIFEST).write_bytes(written)


def used(path: str) -> None:
    """Do with tiles whatever can be done."""
    console = Console(quiet=True)
    tiles = open_tiles(path, Limits.service())
    list(_tile_lines(dict(tiles.manifest)))
    as_json(tiles.manifest)
    for fault in tiles.faults(True):
        if not isinstance(fault, BsmError | OSError):
            raise AssertionError(fault)
    with tempfile.TemporaryDirectory() as folder:
        for work in (
            lambda: tiles.region((-9, -9, -9), (9, 9, 9)),
            lambda: tiles.region((0, 0, 0), (0.1, 0.1, 0.1), 0.5),
            lambda: write_joined(tiles, tiles.chosen(0.0), f"{folder}/a.ply", console, overwrite=True),
            lambda: write_joined(tiles, tiles.chosen(level=0), f"{folder}/a.ply", console, overwrite=True),
            lambda: write_tileset(tiles, folder, console, overwrite=True),
        ):
            with suppress(BsmError, OSError):
                work()


def escaped(folder: Folder, random: Random) -> str | None:
    """What came out of a mutant that is neither a result nor an error of ours."""
    folder.mutate(random)
    signal.setitimer(signal.ITIMER_PROF, MOST_SECONDS)  # processor time: a busy disk is not a finding
    try:
        with np.errstate(all="raise", under="ignore"):
            used(str(folder.path))
    except (BsmError, OSError):
        pass
    except Exception:
        return traceback.format_exc(limit=-3)
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
    return None


def _late(*_: object) -> None:
    raise AssertionError(f"not done after {MOST_SECONDS} s")


def walk(count: int, seed: str) -> Iterator[str]:
    """Return the unexpected errors of a number of mutants."""
    signal.signal(signal.SIGPROF, _late)
    with tempfile.TemporaryDirectory() as place:
        folder = Folder(Path(place, "tiles"))
        for number in range(count):
            if problem := escaped(folder, Random(f"{seed}/{number}")):
                kept = (folder.path / MANIFEST).read_text()[:300]
                yield f"{seed}/{number}: {problem}{kept}"


def main() -> int:
    """Run the command."""
    parser = parser_of(__doc__)
    parser.add_argument("--count", type=int, default=50_000, help="mutants (default: %(default)s)")
    parser.add_argument("--seed", default="0")
    args = parser.parse_args()
    found = 0
    for problem in walk(args.count, args.seed):
        found += 1
        print(problem, flush=True)
    print(f"{args.count} mutants of a manifest and an index, {found} findings")
    return 1 if found else 0
