"""What a host may do wrong, frames from a start on, and programs of examples, compiled from the one file."""

import ctypes
import os
import re
import subprocess
from ctypes import byref
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bsm
from bsm.cli import main
from tests.library.conftest import linked
from tests.shapes import torus
from tools.amalgamate import ROOT
from tools.bsmdec import (
    BLOCK,
    CONNECTIVITY,
    END,
    END_OF_STREAM,
    ERROR,
    HEADER,
    WARNINGS,
    Entry,
    Event,
    Limits,
    Options,
    Shape,
    compiled,
    decode,
)

MISUSED = 2
VECTORS = ROOT / "spec/vectors/1.0"


@pytest.mark.parametrize(
    "name", ["good-chain", "good-grid-chunks", "good-attribute-colors", "good-layer-chunks"]
)
def test_pieces_make_no_difference(library: ctypes.CDLL, name: str) -> None:
    stream = (VECTORS / f"{name}.bsm").read_bytes()
    at_once, bytewise = decode(library, stream), decode(library, stream, pieces=1)
    assert at_once.status == bytewise.status == 0
    assert at_once.arrays.keys() == bytewise.arrays.keys()
    assert all(
        np.array_equal(values, bytewise.arrays[key]) for key, values in at_once.arrays.items()
    )


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


def test_calls_out_of_order_are_refused_and_touch_nothing(library: ctypes.CDLL) -> None:
    event, faces, entry, shape = Event(), np.full(3, 7, np.uint32), Entry(), Shape()
    decoder = library.bsmdec_open(None)

    def refused(call: str, *arguments: Any) -> str:
        assert getattr(library, f"bsmdec_{call}")(decoder, *arguments) == MISUSED
        assert faces.tolist() == [7, 7, 7]
        return str(library.bsmdec_last_misuse(decoder).decode())

    assert library.bsmdec_push(None, b"", 0) == library.bsmdec_next(None, byref(event)) == MISUSED
    assert library.bsmdec_last_misuse(None) == b"the decoder is NULL"
    assert library.bsmdec_last_misuse(decoder) == b""
    assert refused("next", None) == "event is NULL"
    assert refused("push", None, 3) == "bytes is NULL"
    assert refused("faces", faces.ctypes.data, faces.size) == "faces are known after CONNECTIVITY"
    assert refused("positions", faces.ctypes.data, 3) == "positions are known after the first BLOCK"
    assert refused("metadata_at", 0, byref(entry)) == "entry 0 of metadata, 0 are known"
    assert refused("attribute_at", 0, byref(shape)) == "attribute 0, 0 are known"
    stream = (VECTORS / "good-attribute-colors.bsm").read_bytes()
    library.bsmdec_push(decoder, stream, len(stream))
    while library.bsmdec_next(decoder, byref(event)) == 0 and event.type != CONNECTIVITY:
        pass
    assert refused("attribute_at", 0, byref(shape)) == "attribute 0 is known after its ATTRIBUTE"
    assert library.bsmdec_finish(decoder) == 0
    assert refused("push", b"x", 1) == "bytes are pushed after bsmdec_finish"
    while library.bsmdec_next(decoder, byref(event)) == 0 and event.type != END:
        pass
    assert refused("faces", faces.ctypes.data, 3) == f"size 3, expected {3 * event.faces}"
    assert refused("faces", None, 3 * event.faces) == "the array is NULL"
    assert refused("positions", faces.ctypes.data, 3) == f"size 3, expected {3 * event.vertices}"
    assert refused("attribute_values", 0, faces.ctypes.data, 1).startswith("size 1, expected ")
    assert (
        refused("attribute_indices", 0, faces.ctypes.data, 1)
        == "attribute 0 has no indices: it is not of corners"
    )
    library.bsmdec_close(decoder)
    library.bsmdec_close(None)


class LongerOptions(Options):
    """What a program fills that was compiled with a later header."""

    _fields_ = (("later", ctypes.c_int64),)


@pytest.mark.parametrize(
    ("size", "later", "opens"),
    [
        (72, 1, True),
        (88, 1, True),
        (96, 0, True),
        (96, 1, False),
        (0, 0, False),
        (71, 0, False),
        (8192, 0, False),
    ],
)
def test_options_have_a_size(library: ctypes.CDLL, size: int, later: int, opens: bool) -> None:
    stream, event = (VECTORS / "good-tetrahedron.bsm").read_bytes(), Event()
    options = LongerOptions()
    options.size, options.later = size, later
    decoder = library.bsmdec_open(byref(options))
    expected = 0 if opens else MISUSED
    assert library.bsmdec_push(decoder, stream, len(stream)) == expected
    assert library.bsmdec_next(decoder, byref(event)) == expected
    assert event.type == (HEADER if opens else ERROR)
    assert (b"options.size" in library.bsmdec_last_error(decoder).contents.message) is not opens
    library.bsmdec_close(decoder)


def test_limits_have_a_size_and_are_numbers(library: ctypes.CDLL) -> None:
    known, larger = ctypes.sizeof(Limits) - 8, ctypes.sizeof(Limits)
    limits = Limits(5, (7.0,) * 22, 7.0)
    for size in (0, known - 1, 8192):
        assert library.bsmdec_default_limits(byref(limits), size) == MISUSED
    assert limits.size == 5 and limits.bounds[0] == limits.later == 7.0
    assert library.bsmdec_default_limits(byref(limits), known) == 0
    assert limits.size == known and limits.bounds[0] == 1 << 24 and limits.later == 7.0
    assert library.bsmdec_default_limits(byref(limits), larger) == 0
    assert limits.size == larger and limits.later == 0.0
    for place, bound, expected in ((0, 1e9, 0), (0, -1.0, MISUSED), (21, float("nan"), MISUSED)):
        assert library.bsmdec_default_limits(byref(limits), larger) == 0
        limits.bounds[place] = bound
        decoder = library.bsmdec_open(byref(Options(ctypes.addressof(limits), None, False, 0)))
        assert (
            library.bsmdec_push(decoder, b"\x89", 1) == library.bsmdec_finish(decoder) == expected
        )
        message = f"field {place + 1} of the limits is negative or not a number" if expected else ""
        assert library.bsmdec_last_error(decoder).contents.message.decode() == message
        library.bsmdec_close(decoder)


def test_an_error_names_the_limit_and_what_the_stream_needs(library: ctypes.CDLL) -> None:
    stream, limits, event = (VECTORS / "good-keys.bsm").read_bytes(), Limits(), Event()
    library.bsmdec_default_limits(byref(limits), ctypes.sizeof(limits))
    vertices = len(bsm.decode(stream).positions)
    for bound, data, named in (
        (vertices - 1.0, stream, (b"vertices", vertices)),
        (1e9, stream[:-1], (None, 0.0)),
    ):
        limits.bounds[0] = bound
        decoder = library.bsmdec_open(byref(Options(ctypes.addressof(limits), None, False, 0)))
        library.bsmdec_push(decoder, data, len(data))
        library.bsmdec_finish(decoder)
        while library.bsmdec_next(decoder, byref(event)) == 0 and event.type != END_OF_STREAM:
            pass
        error = library.bsmdec_last_error(decoder).contents
        assert error.status and (error.limit, error.value) == named
        library.bsmdec_close(decoder)


@pytest.mark.parametrize(
    ("name", "start"), [("end-positions", 0), ("end-positions", 5), ("sequence-end-positions", -1)]
)
def test_positions_are_checked_from_whatever_start(
    library: ctypes.CDLL, name: str, start: int
) -> None:
    found = decode(library, (VECTORS / f"bad-{name}.bsm").read_bytes(), start=start)
    assert "the checksum of decoded positions is wrong" in found.message


def test_the_example_writes_what_python_decodes(tmp_path: Path) -> None:
    program = linked(compiled(), ROOT / "library/examples/dec.c", tmp_path / "bsmdec", *WARNINGS)
    subprocess.run([program, VECTORS / "good-chain.bsm", tmp_path / "mesh.obj"], check=True)
    mesh, expected = bsm.load(tmp_path / "mesh.obj"), bsm.decode(VECTORS / "good-chain.bsm")
    assert np.array_equal(mesh.faces, expected.faces)
    assert np.allclose(mesh.positions, expected.positions, atol=1e-6)
    words = [program, VECTORS / "bad-block-index.bsm", tmp_path / "mesh.obj"]
    refused = subprocess.run(words, capture_output=True, text=True, check=False)
    assert refused.returncode == 4
    assert "block" in refused.stderr


@pytest.mark.parametrize("name", ["long", "low-delay-long", "runs", "moving-low-delay"])
@pytest.mark.parametrize("start", [1, 5])
def test_frames_from_a_start_on_are_those_of_the_whole(
    library: ctypes.CDLL, name: str, start: int
) -> None:
    stream = (VECTORS / f"good-sequence-{name}.bsm").read_bytes()
    whole = decode(library, stream)
    expected, shown = whole.frames[start:], whole.shown
    found = decode(library, stream, start=start, pieces=101)
    assert [index for index, _ in found.frames] == [index for index, _ in expected]
    for (_, frame), (_, other) in zip(found.frames, expected, strict=True):
        assert np.array_equal(frame, other)
    for frame, other in zip(found.shown[::-1], shown[::-1], strict=False):
        assert all(np.array_equal(frame[key], other[key]) for key in other)


def test_the_example_reads_a_scene(tmp_path: Path) -> None:
    """With cgltf, where the compiler finds it: its folder is in C_INCLUDE_PATH."""
    look = ["cc", "-E", "-include", "cgltf.h", "-x", "c", os.devnull]
    if subprocess.run(look, capture_output=True, check=False).returncode:
        pytest.skip("no cgltf.h: put it into a folder of C_INCLUDE_PATH")
    program = linked(compiled(), ROOT / "library/examples/gltf.c", tmp_path / "gltf", "-std=c11")
    mesh = torus(24, 16)
    bsm.save(mesh, tmp_path / "ring.glb")
    assert main(["glb", str(tmp_path / "ring.glb"), "-o", str(tmp_path / "small.glb"), "-q"]) == 0
    told = subprocess.run(
        [program, tmp_path / "small.glb"], check=True, capture_output=True, text=True
    ).stdout
    name, counts, place = re.fullmatch(
        r"(.*): (\d+ vertices, \d+ triangles), the first at (.*)\n", told
    ).groups()
    assert (name, counts) == (
        "ring",
        f"{len(mesh.positions)} vertices, {len(mesh.faces)} triangles",
    )
    far = np.linalg.norm(mesh.positions - np.array(place.split(), float), axis=1).min()
    assert far < 1e-3 * mesh.diagonal
    scene = (tmp_path / "small.glb").read_bytes()
    place = scene.index(b"\x89BSM") + 40
    (tmp_path / "bad.glb").write_bytes(
        scene[:place] + bytes([scene[place] ^ 255]) + scene[place + 1 :]
    )
    refused = subprocess.run(
        [program, tmp_path / "bad.glb"], capture_output=True, text=True, check=False
    )
    assert refused.returncode == 1 and "checksum" in refused.stderr


def test_the_example_goes_through_all_frames(tmp_path: Path) -> None:
    flags, example = (
        ("-std=c++17", "-Wall", "-Wextra", "-Werror"),
        ROOT / "library/examples/frames.cpp",
    )
    frames = linked(compiled(), example, tmp_path / "frames", *flags, compiler="c++")
    vector = VECTORS / "good-sequence-long.bsm"
    lines = subprocess.run(
        [frames, vector, "2"], check=True, capture_output=True, text=True
    ).stdout.splitlines()
    positions, faces = bsm.decode_sequence(vector.read_bytes())
    expected = [
        f"frame {index} of {len(positions)}: {len(faces)} faces, x from {x.min():.6g} to {x.max():.6g}"
        for index, x in enumerate(positions[:, :, 0].astype(np.float32))
    ]
    assert lines == expected[2:]
    refused = subprocess.run(
        [frames, VECTORS / "bad-sequence-beyond.bsm"], capture_output=True, text=True, check=False
    )
    assert refused.returncode == 1
    assert "frame" in refused.stderr
