"""Both decoders treat every vector alike, and as the manifest says."""

import importlib
import importlib.util
import json
import re
import shutil
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest

from bsm import AttributeEvent, Decoder, decode, decode_frames, decode_sequence
from bsm.bitstream import errors
from tests.streams import all_events, events_of
from tools.vectors.__main__ import try_product
from tools.vectors.made import BADS, GOODS
from tools.vectors.store import FOLDER, NEEDS, arrays_of, needs_of, read_manifest

VECTORS = read_manifest()
GOOD = [vector for vector in VECTORS if vector.error is None]
LONG = re.compile("good-(grid-(large|noise)$|large-|sequence-large)")
"""What takes the reference decoder seconds."""
OF_SKIPPED = re.compile("(bad|unsupported)-(attribute|values|swift-(short|long|range|mixed))")
LACKING = [f"extension {name}" for name in ("light", "sequence", "congruence")]
SPEC = Path(__file__).parents[2] / "spec"


def runner():
    """The runner that stands beside the vectors."""
    spec = importlib.util.spec_from_file_location("runner", FOLDER.parent / "run.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def named(vectors):
    return pytest.mark.parametrize("vector", vectors, ids=[vector.name for vector in vectors])


@pytest.fixture(scope="module")
def reference():
    sys.path.insert(0, str(SPEC))
    yield importlib.import_module("reference_decoder")
    sys.path.remove(str(SPEC))


@named(VECTORS)
def test_product(vector):
    assert try_product(vector) is None


def triangles(positions, faces):
    """What a mesh is whatever the order of its vertices and faces."""
    return sorted(
        min(np.roll(triangle, -k, 0).ravel().tolist() for k in range(3))
        for triangle in positions[faces]
    )


@pytest.mark.parametrize(
    "vector",
    [
        pytest.param(v, id=v.name, marks=[pytest.mark.slow] * bool(LONG.match(v.name)))
        for v in VECTORS
    ],
)
def test_reference_decoder(vector, reference):
    """All of the core as the manifest says; of extensions that it says it lacks, and shapes without what it skips."""
    try:
        positions, faces, skipped = reference.decode(vector.stream.read_bytes())
    except tuple(reference.EXIT_CODES) as error:
        lacks = str(error) in LACKING and isinstance(error, reference.UnsupportedError)
        right = str(vector.error).title() + "Error"
        assert lacks or OF_SKIPPED.match(vector.name) or type(error).__name__ == right, error
    else:
        if vector.error:
            assert skipped
            return
        with np.load(vector.expected) as right:
            if "order" in skipped:
                assert triangles(positions, faces) == triangles(right["positions"], right["faces"])
            else:
                assert np.array_equal(positions, right["positions"]) and np.array_equal(
                    faces, right["faces"]
                )


def test_every_vector_has_its_files_and_every_file_is_a_vector():
    names = {vector.name for vector in VECTORS}
    assert (
        names == {path.stem for path in FOLDER.parent.glob("*/*.bsm")} >= GOODS.keys() | BADS.keys()
    )
    assert {vector.name for vector in GOOD} == {path.stem for path in FOLDER.parent.glob("*/*.npz")}


def test_every_prefix_says_what_its_error_is():
    for vector in VECTORS:
        kind = (
            "good"
            if vector.error is None
            else "unsupported"
            if vector.error == "unsupported"
            else "bad"
        )
        assert vector.name.startswith(f"{kind}-")


@pytest.mark.parametrize("name", ["good-chain", "bad-block-missing", "unsupported-type-0"])
def test_command_lines(name):
    vector = next(vector for vector in VECTORS if vector.name == name)
    command = f"{sys.executable} {SPEC / 'reference_decoder.py'} {{in}} {{out}}"
    assert runner().complaint(vector.stream, vector.error, command) is None


def test_a_wrong_decoder_is_found_out():
    chain = next(vector for vector in VECTORS if vector.name == "good-chain")
    complaint = runner().complaint
    refusal = f"{sys.executable} -c 'raise SystemExit(1)' {{in}} {{out}}"
    assert "ended with code 1" in complaint(chain.stream, None, refusal)
    copy = f"{sys.executable} -c 'import shutil, sys; shutil.copy(\"{chain.expected}\", sys.argv[2])' {{in}} {{out}}"
    assert complaint(chain.stream, None, copy) is None
    other = next(vector for vector in GOOD if vector.name == "good-independent")
    assert "positions is off by" in complaint(other.stream, None, copy)


def test_the_runner_needs_nothing_of_the_project(tmp_path):
    """A copy of the folder, and a decoder of the core."""
    shutil.copytree(FOLDER.parent, tmp_path / "vectors")
    decoder = f"{sys.executable} {SPEC / 'reference_decoder.py'} {{in}} {{out}}"
    command = [sys.executable, "-I", "run.py", decoder, "--needs", "core", "--only", "good-one"]
    done = subprocess.run(command, cwd=tmp_path / "vectors", capture_output=True, text=True)
    assert done.stdout == "3 of 3 vectors are treated as they should be\n", (
        done.stdout + done.stderr
    )


def test_it_is_known_what_each_vector_needs():
    assert json.loads(NEEDS.read_text()) == {
        vector.name: needs_of(vector.stream.read_bytes()) for vector in VECTORS
    }


@named([vector for vector in GOOD if not vector.name.startswith("good-sequence")])
def test_threads_and_events_change_nothing(vector):
    data = vector.stream.read_bytes()
    whole = decode(data, threads=1)
    assert np.array_equal(decode(data, threads=2).positions, whole.positions)
    positions = np.full_like(whole.positions, np.nan)
    arrays, places = (
        arrays_of(whole.attributes),
        {attribute.name: i for i, attribute in enumerate(whole.attributes)},
    )
    for event in events_of(data, threads=2):
        if isinstance(event, AttributeEvent):
            name = f"attribute {places[event.name]} {event.semantic} {event.domain} {event.name}"
            assert (arrays[name][event.rows] == event.values).all()
        elif hasattr(event, "loose"):
            positions[event.loose.vertices] = event.loose.positions
        elif hasattr(event, "positions"):
            positions[event.vertices] = event.positions
    assert vector.complaint(positions, whole.faces, arrays) is None


@pytest.mark.slow
@named(GOOD)
def test_truncations_are_refused(vector):
    data = vector.stream.read_bytes()
    for length in range(0, len(data), max(1, len(data) // 8)):
        with pytest.raises(errors.TruncatedError):
            if vector.name.startswith("good-sequence"):
                list(decode_frames(data[:length], threads=1))
            else:
                decode(data[:length], threads=1)


@pytest.mark.parametrize(
    "name", ["good-tetrahedron", "good-chain", "good-sequence-one", "good-brief-plain"]
)
def test_every_changed_byte_is_refused(name):
    data = next(vector for vector in VECTORS if vector.name == name).stream.read_bytes()
    decoder = decode_sequence if name.startswith("good-sequence") else decode
    for place in range(len(data)):
        broken = bytearray(data)
        broken[place] ^= 1 << place % 8
        with pytest.raises(errors.BsmError):
            decoder(bytes(broken), threads=1)


@named([vector for vector in VECTORS if vector.error])
def test_errors_stay_and_no_thread_is_left_behind(vector):
    before = threading.active_count()
    with Decoder(threads=3) as decoder:
        with pytest.raises(errors.BsmError) as first:
            list(all_events(decoder, [vector.stream.read_bytes()]))
        with pytest.raises(errors.BsmError) as second:
            decoder.next_event()
        assert second.value is first.value
    assert threading.active_count() == before
