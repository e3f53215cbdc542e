"""The product and the decoder written from the law treat the same payloads alike, damaged ones too."""

import ctypes
import hashlib
import re
import struct
import subprocess
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bsm import BsmError
from bsm.bitstream.connectivity.faces import encode_connectivity
from bsm.bitstream.container.header import MOST_GRID
from bsm.codec.geometry.graph import graph_of_faces
from spec import reference_integers as reference
from tests.bitstream.connectivity.test_faces import compact
from tests.bitstream.fields.fields import KINDS, SOUPS, encode, field_of, values
from tools.payloads import decode_connectivity

SPEC = Path(__file__).parents[2] / "spec"
CONNECTIVITY, FIELDS = (
    (SPEC / f"core-{name}.md").read_text() for name in ("2-connectivity", "4-fields")
)
REFERENCE_ERRORS = (reference.CorruptError, reference.TruncatedError, reference.LimitError)
CHUNKS = st.sampled_from([1, 7, 100])
SEEDS = st.integers(0, 2**32 - 1)
quick = settings(max_examples=40)


def outcome(decode: Callable[[], Any]) -> Any:
    """What a decoder gives, as lists, or the name of its error."""
    try:
        result = decode()
    except (BsmError, *REFERENCE_ERRORS) as error:
        return type(error).__name__
    return result.tolist() if isinstance(result, np.ndarray) else result


def damaged(payload: bytes, data: st.DataObject) -> bytes:
    """A payload cut, lengthened, at random, or with some bytes changed."""
    kind = data.draw(st.sampled_from(["cut", "longer", "changed", "random"]))
    if kind == "cut":
        return payload[: data.draw(st.integers(0, len(payload)))]
    if kind == "longer":
        return payload + data.draw(st.binary(min_size=1, max_size=9))
    if kind == "random":
        return data.draw(st.binary(max_size=60))
    changed = bytearray(payload)
    for _ in range(data.draw(st.integers(1, 3))):
        if changed:
            changed[data.draw(st.integers(0, len(changed) - 1))] = data.draw(st.integers(0, 255))
    return bytes(changed)


# -------------------------------------------------------------------------------------------------------- connectivity


def check_faces(payload: bytes, vertices: int, faces: int) -> Any:
    """Decode a connectivity payload with both decoders; their common outcome."""
    expected = outcome(lambda: decode_connectivity(payload, vertices, faces))
    assert outcome(lambda: reference.decode_connectivity(payload, vertices, faces)) == expected
    return expected


@settings(max_examples=80)
@given(SOUPS, st.data())
def test_faces(soup, data):
    if not len(soup[0]):
        return
    faces, vertices = compact(soup[0])
    encoded = encode_connectivity(faces, vertices)
    assert check_faces(encoded.payload, vertices, len(faces)) == encoded.faces.tolist()
    graph = graph_of_faces(encoded.faces, vertices)
    neighbors = reference.neighbors_of(encoded.faces.tolist(), vertices)
    assert neighbors == [list(row) for row in np.split(graph.neighbors, graph.offsets[1:-1])]
    check_faces(
        damaged(encoded.payload, data),
        vertices,
        len(faces) + data.draw(st.sampled_from([0, 0, 0, 1])),
    )


def test_the_tables_of_the_coder_are_those_of_the_document() -> None:
    squash, stretch = np.array(reference.SQUASH), np.array(reference.STRETCH)
    assert f"0x{zlib.crc32(squash.astype('<u2').tobytes()):X}" in CONNECTIVITY
    assert f"0x{zlib.crc32(stretch.astype('<i2').tobytes()):X}" in CONNECTIVITY
    exact = 65536 / (1 + np.exp(-np.arange(-2880, 2880) / 256))
    np.testing.assert_array_equal(squash, np.clip(np.floor(exact + 0.5), 1, 65535))
    assert np.abs(exact % 1 - 0.5).min() > 0.0003


TABLES = """#include "bitstream/entropy/tables.c"
#include "bitstream/fields/tables.c"
void *tables[] = {SQUASH, STRETCH, RECIPROCAL, SURVIVAL, ODDS, LESS};
"""


def test_kernels_compute_the_tables_of_the_document(tmp_path: Path) -> None:
    (tmp_path / "tables.c").write_text(TABLES)
    flags = ["-std=gnu11", "-O2", "-fPIC", "-shared", "-I", str(SPEC.parent)]
    subprocess.run(
        ["cc", *flags, tmp_path / "tables.c", "-lm", "-o", tmp_path / "tables.so"], check=True
    )
    library = ctypes.CDLL(str(tmp_path / "tables.so"))
    library.make_tables()
    places = (ctypes.c_void_p * 6).in_dll(library, "tables")
    expected = {
        "squash": (reference.SQUASH, ctypes.c_uint16),
        "stretch": (reference.STRETCH, ctypes.c_int16),
        "reciprocal": ([131072 // (2 * n + 3) for n in range(1024)], ctypes.c_uint16),
        "survival": (reference.SURVIVAL, ctypes.c_int32),
        "odds": (reference.ODDS, ctypes.c_int16),
        "less": (reference.LESS, ctypes.c_int16),
    }
    for place, (name, (table, kind)) in zip(places, expected.items(), strict=True):
        assert list((kind * len(table)).from_address(place)) == table, name


def lines(text: str) -> list[str]:
    """The indented lines of a text."""
    return [line.strip() for line in text.splitlines() if line.startswith("    ")]


def numbers(line: str) -> list[list[int]]:
    """A line of faces or other numbers."""
    return [[int(corner) for corner in face.split()] for face in line.split("/")]


EXAMPLES = lines(
    (SPEC / "vectors" / "README.md").read_text().partition("(C 11)")[2].partition("\n## ")[0]
)


def test_the_tetrahedron_of_the_document() -> None:
    faces = numbers(EXAMPLES[1])
    assert check_faces(bytes.fromhex(EXAMPLES[0]), 4, 4) == faces


def test_the_decisions_of_the_tetrahedron(monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[tuple[str, ...]] = []
    decide = reference.RangeDecoder.bit

    def record(decoder: reference.RangeDecoder, probability: int) -> int:
        before = f"{decoder.range:x}", f"{decoder.low:x}", str(probability)
        bit = decide(decoder, probability)
        seen.append((*before, str(bit)))
        return bit

    monkeypatch.setattr(reference.RangeDecoder, "bit", record)
    reference.decode_connectivity(bytes.fromhex(EXAMPLES[0]), 4, 4)
    rows = [
        re.findall(r"([0-9a-f]+) +([0-9a-f]+) +(\d+) ([01]) \S", line) for line in EXAMPLES[2:-3]
    ]
    assert [row[0] for row in rows] + [row[1] for row in rows if len(row) > 1] == seen


def test_the_seam_of_the_document() -> None:
    assert check_faces(bytes.fromhex(EXAMPLES[-3]), 6, 3) == numbers(EXAMPLES[-2])


# -------------------------------------------------------------------------------------------------------------- fields


def read(chunk: Callable[[bytes, int], Any], chunks: list[tuple[bytes, int]]) -> list[Any]:
    """Return the result of each payload up to the first error, and the name of the error."""
    found: list[Any] = []
    for payload, count in chunks:
        found.append(outcome(lambda payload=payload, count=count: chunk(payload, count)))
        if isinstance(found[-1], str):
            break
    return found


def product(field) -> Callable[[bytes, int], Any]:
    read = field.reader()
    return lambda payload, count: [array.tolist() for array in read(payload, count)]


def plain(reader: Any) -> Callable[[bytes, int], Any]:
    def chunk(payload: bytes, count: int) -> Any:
        vertices = reader.read(payload, count)
        return [vertices, [list(reader.x[v]) for v in vertices]]

    return chunk


def check_field(field, given, chunk, data, reader):
    """Both decoders on the payloads, and with one of them damaged."""
    chunks = encode(field, given, chunk)
    which = data.draw(st.integers(0, len(chunks) - 1))
    broken = [
        *chunks[:which],
        (damaged(chunks[which][0], data), chunks[which][1]),
        *chunks[which + 1 :],
    ]
    for payloads in (chunks, broken):
        assert read(plain(reader()), payloads) == read(product(field), payloads)


@quick
@given(
    SOUPS,
    st.tuples(*[st.sampled_from([0, 1, 100, MOST_GRID])] * 3),
    KINDS,
    SEEDS,
    CHUNKS,
    st.data(),
)
def test_grids(mesh, largest, kind, seed, chunk, data):
    faces, vertices = mesh
    if not vertices:
        return
    field = field_of("grid", faces, vertices, largest)
    assert reference.Mesh(faces.tolist(), vertices, True).order == field.order().tolist()
    positions = values(vertices, (0, 0, 0), largest, kind, seed)
    check_field(
        field,
        positions,
        chunk,
        data,
        lambda: reference.GridReader(faces.tolist(), vertices, list(largest)),
    )


@quick
@given(SOUPS, st.sampled_from([1, 9, 1 << 20]), KINDS, SEEDS, CHUNKS, st.data())
def test_levels(mesh, most, kind, seed, chunk, data):
    faces, vertices = mesh
    if not vertices:
        return
    given = values(vertices, [-most] * 3, [most] * 3, kind, seed)
    field = field_of("levels", faces, vertices)
    check_field(field, given, chunk, data, lambda: reference.LevelsReader(faces.tolist(), vertices))


def test_positions_of_a_lattice():
    points = np.arange(30, dtype=np.int32).reshape(10, 3)
    header = {
        "lattice": [4095, 29],
        "center": [0.5, -1.0, 2.0],
        "scale": 0.25,
        "corner": [],
        "turn": [0.0] * 3,
    }
    expected = [reference.place(row, header) for row in points.tolist()]
    cells = (2 * points * 4095 + 29) // (2 * 29)
    assert expected == (np.array([0.5, -1.0, 2.0]) + 0.25 * cells).tolist()
    header = {
        "lattice": [],
        "center": [0.0, 0.0, 0.0],
        "scale": 0.1,
        "corner": [],
        "turn": [0.0] * 3,
    }
    assert reference.place([1, 2, 3], header) == [0.1, 0.2, 0.1 * 3]
    assert reference.place([1, 2, 3], header | {"corner": [-3, 5, 70000]}) == [
        0.1 * -2,
        0.1 * 7,
        0.1 * 70003,
    ]


def test_the_tables_of_fields_are_those_of_the_document():
    table = reference.SURVIVAL + reference.ODDS + reference.LESS
    digest = hashlib.sha256(struct.pack(f"<{len(table)}i", *table)).hexdigest()
    assert digest in FIELDS
