"""The proof reports and keeps failing streams, and mutated streams have valid checksums."""

import random
from collections import Counter
from dataclasses import asdict

import pytest

from bsm import BsmError, CorruptError, FormatError, TruncatedError, read_mesh
from tests.shapes import file_of
from tests.streams import events_of, info_of
from tools.attack import shard as proof
from tools.attack.decoding import is_sequence, piecewise, whole
from tools.attack.mutate import mutate_stream
from tools.attack.places import environments, processors
from tools.attack.proof import Part, cuts, plan, run, table
from tools.attack.shard import SUITES, Shard
from tools.attack.tally import Tally
from tools.surgery import frames_of, stream_of
from tools.vectors.meshes import patch
from tools.vectors.store import FOLDER

CHAIN = (FOLDER / "good-chain.bsm").read_bytes()
TEXTURED = (FOLDER / "good-attribute-uv-blocks.bsm").read_bytes()
SEQUENCE = (FOLDER / "good-sequence-learnt.bsm").read_bytes()


@pytest.fixture
def shard(tmp_path):
    return Shard("test", tmp_path / "findings", careful=False, short=True)


def test_outcomes_are_held_against_each_other():
    tally, decoded = Tally(), whole(CHAIN)
    positions, faces, attributes = decoded
    assert tally.hold(CHAIN, decoded, decoded) is None
    assert "off by" in tally.hold(CHAIN, (positions + 1e-15, faces, attributes), decoded)
    assert "faces" in tally.hold(CHAIN, (positions, faces[::-1], attributes), decoded)
    assert "shape" in tally.hold(CHAIN, (positions[:-1], faces, attributes), decoded)
    assert "corrupt instead of decoded" in tally.hold(CHAIN, CorruptError("no"), decoded)
    assert "corrupt instead of truncated" in tally.hold(
        CHAIN, CorruptError("no"), TruncatedError("yes")
    )
    assert tally.hold(CHAIN, CorruptError("this"), CorruptError("that")) is None
    assert tally.differing == 5


@pytest.mark.parametrize("stream", [CHAIN, SEQUENCE, TEXTURED])
def test_pieces_and_tolerance_change_nothing(shard, stream):
    outcome = whole(stream)
    proof.agree(shard, stream, outcome)
    assert shard.tally.findings == [] and is_sequence(stream) == (stream is SEQUENCE)
    damaged = stream[:-30] + bytes(30)
    assert isinstance(piecewise(damaged, shard.random)[0], BsmError)


def test_findings_and_escapes_are_noted_and_kept(shard, tmp_path):
    with shard.watching(b"stream"):
        raise ZeroDivisionError
    shard.found(b"other", "wrong")
    shard.found(b"right", None)
    assert shard.tally.escapes == 1 and len(shard.tally.findings) == 2
    assert sorted(path.read_bytes() for path in (tmp_path / "findings").iterdir()) == [
        b"other",
        b"stream",
    ]


def test_a_wrong_decoder_is_found(shard, monkeypatch):
    def wrong(stream, *rest, **more):
        outcome = whole(stream, *rest, **more)
        return outcome if isinstance(outcome, BsmError) else (outcome[0] * 1.001, *outcome[1:])

    monkeypatch.setattr(proof, "whole", wrong)
    SUITES["differential"](shard, 0, 10)
    assert shard.tally.differing == shard.tally.decoded > 0 and "off by" in shard.tally.findings[0]


def test_places_are_there(tmp_path):
    assert len({place.name for place in environments()}) == len(environments()) > 25
    assert processors(short=True) == processors()[:1]
    done = environments()[0].run("tools.attack.encodes", "1", "1", str(tmp_path))
    assert done.returncode == 2 and "--streams" in done.stderr


def test_the_plan_has_everything(tmp_path):
    import argparse

    args = argparse.Namespace(short=False, seed="0")
    parts = plan(args)
    assert {part.suite for part in parts} == set(SUITES)
    assert sum(part.size for part in parts if part.suite == "mutants") == 1_000_000
    assert list(cuts(9, 4)) == [(0, 4), (1, 4), (2, 1)]
    tally = run(Part("mutants", 0, 20), args, tmp_path)
    lines = list(table({"mutants": tally}))
    assert len(lines) == 3 and "20" in lines[1] and asdict(tally)["inputs"] == 20


def change_a_byte(data, max_size):
    changed = bytearray(data or b"\0")
    changed[random.randrange(len(changed))] = random.randrange(256)
    return bytes(changed[:max_size])


def test_mutated_streams_get_past_the_checksums():
    random.seed(2)
    stream = (FOLDER / "good-chain.bsm").read_bytes()
    reached = Counter()
    for k in range(300):
        mutated = mutate_stream(stream, 1 << 16, k, change_a_byte)
        try:
            info_of(mutated)
            reached["whole"] += 1
        except BsmError as error:
            reached["checksum" if "checksum" in str(error) else "payload"] += 1
    assert reached["whole"] > 80 and reached["checksum"] < 60


# ------------------------------------------------------------------------------------------------- what it has found


def test_damage_that_looks_like_a_block_before_the_faces_is_refused():
    stream = (FOLDER / "good-chain.bsm").read_bytes()
    header = next(iter(frames_of(stream)))
    start = len(stream_of([header])) - 10
    kind_of_block = bytes([stream[start] & 0xF0 | 6]) + stream[start + 1 :]
    with pytest.raises(CorruptError):
        events_of(stream[:start] + kind_of_block, tolerant=True)


def test_an_npz_with_a_name_that_is_no_text_is_refused(tmp_path):
    whole = file_of(patch(3, 3), "npz")
    listed = whole.rindex(b"faces.npy")
    flags = listed - 46 + 8
    broken = bytearray(whole)
    broken[flags + 1] |= 0x08  # the name is UTF-8
    broken[listed] = 0x9B
    (tmp_path / "a.npz").write_bytes(broken)
    with pytest.raises(FormatError):
        read_mesh(tmp_path / "a.npz")
