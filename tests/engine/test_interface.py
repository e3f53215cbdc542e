"""What a host may do wrong, and a program of its own, compiled from the one file."""

import ctypes
import subprocess
from ctypes import byref
from pathlib import Path

import numpy as np
import pytest

import bsm
from tests.engine.decoding import BLOCK, END, END_OF_STREAM, NO_MEMORY, Allocator, Entry, Event, compiled, decode
from tools.amalgamate import ROOT

MISUSED = 2
VECTORS = ROOT / "spec/vectors/1.0"


@pytest.mark.parametrize("name", ["good-chain", "good-grid-chunks", "good-attribute-colors", "good-layer-chunks"])
def test_pieces_make_no_difference(library: ctypes.CDLL, name: str) -> None:
    stream = (VECTORS / f"{name}.bsm").read_bytes()
    at_once, bytewise = decode(library, stream), decode(library, stream, pieces=1)
    assert at_once.status == bytewise.status == 0
    assert at_once.arrays.keys() == bytewise.arrays.keys()
    assert all(np.array_equal(values, bytewise.arrays[key]) for key, values in at_once.arrays.items())


def test_positions_are_known_as_far_as_they_have_come(library: ctypes.CDLL) -> None:
    stream = (VECTORS / "good-keys.bsm").read_bytes()
    decoder, event, known = library.bsmdec_open(None), Event(), []
    library.bsmdec_push(decoder, stream, len(stream))
    library.bsmdec_finish(decoder)
    while library.bsmdec_next(decoder, byref(event)) == 0 and event.type != END_OF_STREAM:
        if event.type in (BLOCK, END):
            positions = np.zeros((event.vertices, 3))
            assert library.bsmdec_positions(decoder, positions.ctypes.data, positions.size) == 0
            known.append(int(np.isfinite(positions).all(axis=1).sum()))
    library.bsmdec_close(decoder)
    assert known == sorted(known)
    assert 0 < known[0] < known[-1] == len(bsm.decode(stream).positions)


def test_what_authors_say_comes_back(library: ctypes.CDLL) -> None:
    said = {"bytes": b"\x00\x01", "float": 0.5, "int": -7, "text": "ä"}
    stream = bsm.encode(bsm.load(VECTORS / "good-tetrahedron.bsm"), metadata=said)
    decoder, event, entry = library.bsmdec_open(None), Event(), Entry()
    library.bsmdec_push(decoder, stream, len(stream))
    library.bsmdec_finish(decoder)
    while library.bsmdec_next(decoder, byref(event)) == 0 and event.type != END_OF_STREAM:
        pass
    found = {}
    for index in range(len(said)):
        assert library.bsmdec_metadata_at(decoder, index, byref(entry)) == 0
        found[entry.name.decode()] = entry.value
    assert library.bsmdec_metadata_at(decoder, len(said), byref(entry)) == MISUSED
    library.bsmdec_close(decoder)
    assert found == said


def test_calls_out_of_order_are_refused_and_touch_nothing(library: ctypes.CDLL) -> None:
    event, faces = Event(), np.full(3, 7, np.uint32)
    assert library.bsmdec_push(None, b"", 0) == MISUSED
    assert library.bsmdec_next(None, byref(event)) == MISUSED
    decoder = library.bsmdec_open(None)
    assert library.bsmdec_next(decoder, None) == MISUSED
    assert library.bsmdec_push(decoder, None, 3) == MISUSED
    assert library.bsmdec_faces(decoder, faces.ctypes.data, faces.size) == MISUSED
    assert library.bsmdec_positions(decoder, faces.ctypes.data, 3) == MISUSED
    assert library.bsmdec_finish(decoder) == 0
    assert library.bsmdec_push(decoder, b"x", 1) == MISUSED
    assert faces.tolist() == [7, 7, 7]
    library.bsmdec_close(decoder)
    library.bsmdec_close(None)


def test_a_host_without_memory_gets_an_error_wherever_that_is(library: ctypes.CDLL) -> None:
    stream, statuses = (VECTORS / "good-attribute-colors.bsm").read_bytes(), set()
    for most in range(200):
        allocator = Allocator(most)
        statuses.add(decode(library, stream, allocator=allocator).status)
        assert not allocator.held
    assert statuses == {0, NO_MEMORY}


def test_the_example_writes_what_python_decodes(tmp_path: Path) -> None:
    made = compiled()
    program, example = tmp_path / "obj", ROOT / "engine/examples/obj.c"
    subprocess.run(
        ["cc", "-w", f"-I{made}", example, made / "bsmdec.so", f"-Wl,-rpath,{made}", "-o", program], check=True
    )
    written = subprocess.run([program, VECTORS / "good-chain.bsm"], check=True, capture_output=True, text=True).stdout
    (tmp_path / "mesh.obj").write_text(written)
    mesh, expected = bsm.load(tmp_path / "mesh.obj"), bsm.decode(VECTORS / "good-chain.bsm")
    assert np.array_equal(mesh.faces, expected.faces)
    assert np.allclose(mesh.positions, expected.positions, atol=1e-6)
    refused = subprocess.run([program, VECTORS / "bad-block-index.bsm"], capture_output=True, text=True, check=False)
    assert refused.returncode == 4
    assert "block" in refused.stderr
