"""Manifests and indexes of tiles, mutated by their grammar: each use ends in a result, or in an error of ours.

Fifty mutants are usual: `BSM_EXAMPLES=50000 pytest tests/bsm/test_mutated_tiles.py`.
"""

import copy
import json
import signal
from contextlib import contextmanager, suppress
from hashlib import sha256

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import bsm
from bsm import BsmError, Limits
from bsm.cli import main as program
from tests.shapes import torus

FOOT = 16  # bytes at the end of a file: the length of the index and a mark
MOST_SECONDS = 20
NAMES = st.sampled_from(["", "r", "r0", "00000.tiles", "../a", "\0", "x" * 5000])
NUMBERS = (
    st.integers(-(2**70), 2**70)
    | st.sampled_from([0, 1, 2**53, 2**63, 10**290, 10**400])
    | st.floats()
)
ODD = (
    st.none()
    | st.booleans()
    | NAMES
    | NUMBERS
    | st.sampled_from([[], {}, [[]], [0, 0, 0], {"a": 1}])
)


def paths(tree, at=()):
    """The place of every value in a tree."""
    for key in (
        tree if isinstance(tree, dict) else range(len(tree)) if isinstance(tree, list) else ()
    ):
        yield (*at, key)
        yield from paths(tree[key], (*at, key))


@st.composite
def mutated(draw, tree, most):
    """A tree with values replaced, moved, repeated or left out."""
    tree = copy.deepcopy(tree)
    for _ in range(draw(st.integers(0, most))):
        places = list(paths(tree))
        if not places:
            return draw(ODD)
        *above, key = draw(st.sampled_from(places))
        inside = tree
        for step in above:
            inside = inside[step]
        change = draw(st.sampled_from(["delete", "repeat", "move", "replace"]))
        if change == "delete":
            del inside[key]
        elif change == "repeat" and isinstance(inside, list):
            inside.insert(key, copy.deepcopy(inside[key]))
        elif change == "move":
            value = tree
            for step in draw(st.sampled_from(places)):
                value = value[step]
            inside[key] = copy.deepcopy(value)
        else:
            inside[key] = copy.deepcopy(draw(ODD))
    return tree


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Sound tiles in one shard."""
    path = tmp_path_factory.mktemp("mutated")
    bsm.save(torus(16, 12), path / "a.ply")
    words = [
        "tile",
        path / "a.ply",
        "-o",
        path / "tiles",
        "--triangles",
        100,
        "--grid-cell",
        2.0**-10,
        "-q",
    ]
    assert program([str(word) for word in words]) == 0
    return path / "tiles"


@pytest.fixture(scope="module")
def sound(folder):
    """The manifest, and the shard in three parts: its tiles, its index, and what ends it."""
    manifest = json.loads((folder / "manifest.json").read_text())
    (shard,) = manifest["shards"]
    data = (folder / shard["file"]).read_bytes()
    begin = len(data) - shard["index"] - FOOT
    return manifest, data[:begin], json.loads(data[begin:-FOOT]), data[-FOOT + 8 :]


@contextmanager
def in_time():
    """Fail after some seconds of processor time, so that a busy disk does not count."""

    def late(*_):
        raise AssertionError(f"not done after {MOST_SECONDS} s")

    before = signal.signal(signal.SIGPROF, late)
    signal.setitimer(signal.ITIMER_PROF, MOST_SECONDS)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)


def use(folder, output):
    """Do with tiles whatever can be done; errors of ours are results, too."""
    with suppress(BsmError, OSError):
        tiles = bsm.open_tiles(str(folder), limits=Limits.service())
        assert all(isinstance(fault, BsmError | OSError) for fault in tiles.faults(True))
        for region in (((-9, -9, -9), (9, 9, 9)), ((0, 0, 0), (0.1, 0.1, 0.1), 0.5)):
            with suppress(BsmError, OSError):
                tiles.region(*region)
    for words in (
        ["-o", output / "a.ply"],
        ["--level", 0, "-o", output / "a.ply"],
        ["-o", output / "tileset.json"],
    ):
        program([str(word) for word in ("untile", folder, "-f", "-q", *words)])
    program(["info", str(folder)])


@given(data=st.data())
def test_mutated_tiles_end_in_results_or_errors_of_ours(folder, sound, tmp_path_factory, data):
    manifest, tiles, index, end = sound
    changed_index = data.draw(mutated(index, 2))
    text = json.dumps(changed_index).encode()
    shard_data = tiles + text + len(text).to_bytes(8, "little") + end
    manifest = copy.deepcopy(manifest)
    (shard,) = manifest["shards"]
    name = shard["file"]
    # Checksums and sizes are corrected, unless the mutation is in them.
    shard |= {"size": len(shard_data), "index": len(text), "sha256": sha256(text).hexdigest()}
    if isinstance(changed_index, list):
        shard["tiles"] = len(changed_index)
    written = json.dumps(data.draw(mutated(manifest, 3))).encode()
    (folder / name).write_bytes(shard_data)
    (folder / "manifest.json").write_bytes(
        written[: data.draw(st.none() | st.integers(0, len(written)))]
    )
    with in_time(), np.errstate(all="raise", under="ignore"):
        use(folder, tmp_path_factory.mktemp("joined"))
