"""Threads of the host change nothing but time."""

import ctypes
import subprocess
from collections.abc import Iterator
from ctypes import byref
from pathlib import Path
from time import process_time

import numpy as np
import pytest

from tools.amalgamate import ROOT, amalgamated, interface
from tools.attack.threads import decoded, difference, streams
from tools.bsmdec import Decoded, Event, Limits, Options, Parallel, decode

VECTORS = ROOT / "spec/vectors"
NAMES = (
    "good-refined-steep",
    "good-keys",
    "good-layer-chunks",
    "good-independent-predicted",
    "bad-refinement-short",
)


def same(first: Decoded, other: Decoded) -> bool:
    """Return whether two decoders reported the same."""
    assert first.arrays.keys() == other.arrays.keys()
    assert all(
        np.array_equal(first.arrays[key], other.arrays[key], equal_nan=True) for key in first.arrays
    )
    return (first.status, first.message, first.losses) == (
        other.status,
        other.message,
        other.losses,
    )


def damaged(stream: bytes, step: int) -> Iterator[bytes]:
    """Streams in which one bit is wrong, or some bytes are missing."""
    for place in range(8, len(stream), step):
        yield stream[:place] + bytes([stream[place] ^ 1 << place % 8]) + stream[place + 1 :]
        yield stream[:place] + stream[place + 3 :]


@pytest.mark.parametrize("name", NAMES)
def test_threads_give_the_same(library: ctypes.CDLL, name: str) -> None:
    stream = (VECTORS / "1.0" / f"{name}.bsm").read_bytes()
    parallel = Parallel(3)
    assert same(decode(library, stream), decode(library, stream, parallel=parallel))
    assert parallel.tasks > 1


@pytest.mark.parametrize("name", NAMES[:4])
def test_damage_is_the_same_in_threads(library: ctypes.CDLL, name: str) -> None:
    stream = (VECTORS / "1.0" / f"{name}.bsm").read_bytes()
    for mutant in damaged(stream, max(len(stream) // 24, 1)):
        ours = decode(library, mutant, tolerant=True)
        assert same(ours, decode(library, mutant, tolerant=True, parallel=Parallel(3)))


ACROSS = bytes.fromhex(
    "8942534d12f1088b01ccee02cd01a00301041e050307ca3f0000000893ca3f000000ca3f266666cabbac142709ca3fd3cfef"
    "0aca410000000b92cb3f70624dd2f1a9fcca412000001b941e020103a394c301a59f645f3bd5bd525da3666f0483a6010003"
    "fffffffea4fc8b13c9fc3d001dfcd34e3d1dea0105fb4d870205f9a453dd011e0534cda9a1d7f38cd820c21d43d85f078c32"
    "1c94af6e"
)
"""Levels of all cells but the last; of that one and vertices, which is refused; of the last vertices; of the first."""


def test_levels_that_are_refused_are_not_read_ahead() -> None:
    assert difference(ACROSS) == ""
    assert b"RefinementEvent" in decoded(ACROSS, 4, True)[-2]


@pytest.mark.slow
def test_damaged_streams_are_decoded_alike_by_one_thread_and_by_four() -> None:
    problems = list(filter(None, map(difference, streams(2000, seed=0))))
    assert problems == []


@pytest.mark.slow
def test_threads_touch_nothing_together(tmp_path: Path) -> None:
    """The example with POSIX threads under the thread sanitizer."""
    (tmp_path / "bsmdec.c").write_text(amalgamated())
    (tmp_path / "bsmdec.h").write_text(interface())
    program, example = tmp_path / "threads", ROOT / "library/examples/threads.c"
    flags = [
        "-fsanitize=thread",
        "-O1",
        "-g",
        "-DKERNEL_ONE_TARGET",
        "-ffp-contract=off",
        "-w",
        "-I.",
    ]
    command = ["cc", *flags, str(example), "bsmdec.c", "-lm", "-pthread", "-o", str(program)]
    subprocess.run(command, check=True, cwd=tmp_path)
    for name in NAMES[:4]:
        problems = []
        for threads in ("1", "3"):
            path = VECTORS / "1.0" / f"{name}.bsm"
            run = subprocess.run(
                [program, path, threads], capture_output=True, text=True, check=True
            )
            assert "WARNING" not in run.stderr
            problems.append(run.stdout)
        assert problems[0] == problems[1]


NEED_DATA, MOST_WORK, SECOND_BLOCK = 0, 16, 72
FEW_BYTES = bytes.fromhex(
    "8942534d10f1028501ce0002014e02ce0004029c03ce00020000040805019c7bb301a709b6b2f3bd670685dec1877c5f02dd9792d28e08"
)
"""131,406 vertices in 131,072 blocks, none of which comes."""


def test_many_losses_take_no_more_time_than_vertices_may(library: ctypes.CDLL) -> None:
    start = process_time()
    found = decode(library, FEW_BYTES, tolerant=True)
    assert found.losses == 131_072
    assert process_time() - start < 1 + 40e-6 * len(found.arrays["positions"])


def test_looking_at_a_place_again_costs_nothing(library: ctypes.CDLL) -> None:
    """Behind a damaged BLOCK of 1 byte stands a tag of one of 320, for whose rest the search waits."""
    stream = (ROOT / "spec/vectors/1.0/good-keys.bsm").read_bytes()[
        :SECOND_BLOCK
    ] + b"\x16\x86\x28\0\x80\0"
    limits, event = Limits(), Event()
    library.bsmdec_default_limits(byref(limits), ctypes.sizeof(limits))
    limits.bounds[MOST_WORK] = 1e9
    decoder = library.bsmdec_open(byref(Options(ctypes.addressof(limits), tolerant=True)))
    library.bsmdec_push(decoder, stream, len(stream))
    while library.bsmdec_next(decoder, byref(event)) == 0 and event.type != NEED_DATA:
        pass
    assert {library.bsmdec_next(decoder, byref(event)) for _ in range(1000)} == {0}
    assert event.type == NEED_DATA
    library.bsmdec_close(decoder)
