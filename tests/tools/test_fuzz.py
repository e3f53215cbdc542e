"""The fuzzer's own parts: targets that find nothing in the vectors, and mutations that reach behind the checksums."""

import random
from collections import Counter

import pytest

from bsm import BsmError, CorruptError, FormatError
from bsm.files.inspection import inspect_stream
from bsm.files.mesh import read_mesh, written_mesh
from tests.streams import events_of
from tools.attack.mutate import mutate_stream
from tools.surgery import frames_of, stream_of, with_header
from tools.vectors.meshes import patch
from tools.vectors.store import FOLDER


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
            inspect_stream([mutated])
            reached["whole"] += 1
        except BsmError as error:
            reached["checksum" if "checksum" in str(error) else "payload"] += 1
    assert reached["whole"] > 80 and reached["checksum"] < 60


def test_headers_are_changed_by_name():
    stream = (FOLDER / "good-chain.bsm").read_bytes()
    assert inspect_stream([with_header(stream, smoothing=2.5)]).header.smoothing == 2.5
    with pytest.raises(CorruptError):
        inspect_stream([with_header(stream, vertices=None)])


# ------------------------------------------------------------------------------------------------- what it has found


def test_damage_that_looks_like_a_block_before_the_faces_is_refused():
    stream = (FOLDER / "good-chain.bsm").read_bytes()
    header = next(iter(frames_of(stream)))
    start = len(stream_of([header])) - 10
    kind_of_block = bytes([stream[start] & 0xF0 | 6]) + stream[start + 1 :]
    with pytest.raises(CorruptError):
        events_of(stream[:start] + kind_of_block, tolerant=True)


def test_an_npz_whose_compression_is_damaged_is_refused(tmp_path):
    whole = written_mesh(patch(6, 5), "npz").data
    for place in range(60, len(whole)):
        (tmp_path / "a.npz").write_bytes(whole[:place] + bytes([whole[place] ^ 0xFF]) + whole[place + 1 :])
        try:
            read_mesh(tmp_path / "a.npz")
        except BsmError:
            continue


def test_an_npz_with_a_name_that_is_no_text_is_refused(tmp_path):
    whole = written_mesh(patch(3, 3), "npz").data
    listed = whole.rindex(b"faces.npy")
    flags = listed - 46 + 8
    broken = bytearray(whole)
    broken[flags + 1] |= 0x08  # the name is UTF-8
    broken[listed] = 0x9B
    (tmp_path / "a.npz").write_bytes(broken)
    with pytest.raises(FormatError):
        read_mesh(tmp_path / "a.npz")
