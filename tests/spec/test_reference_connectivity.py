"""The product and the decoder written from the law treat the same payloads alike, damaged ones too."""

from __future__ import annotations

import re
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bsm.bitstream._kernels import code_uniform
from bsm.bitstream.connectivity.faces import decode_connectivity, encode_connectivity
from bsm.bitstream.entropy.range_coder import code_unsigned, finish_writing, make_bank, start_writing, unsigned_span
from bsm.bitstream.errors import BsmError
from bsm.bitstream.limits import DEFAULT_LIMITS
from bsm.codec.geometry.graph import graph_of_faces
from spec import reference_integers as reference
from tests.bitstream.connectivity.test_faces import SOUPS, compact, read_ply
from tests.shapes import Faces, grid_faces

quick = settings(max_examples=30)
SPEC = Path(__file__).parents[2] / "spec"
DOCUMENT = (SPEC / "core-2-connectivity.md").read_text()
REFERENCE_ERRORS = (reference.CorruptError, reference.TruncatedError, reference.LimitError)


def outcome(decode: Callable[[], Any]) -> Any:
    """What a decoder gives, as lists, or the name of its error."""
    try:
        result = decode()
    except (BsmError, *REFERENCE_ERRORS) as error:
        return type(error).__name__
    return result.tolist() if isinstance(result, np.ndarray) else result


def check_faces(payload: bytes, vertices: int, faces: int) -> Any:
    """Decode a connectivity payload with both decoders; their common outcome."""
    expected = outcome(lambda: decode_connectivity(payload, vertices, faces))
    assert outcome(lambda: reference.decode_connectivity(payload, vertices, faces)) == expected
    return expected


def check_mesh(faces: Faces, vertices: int) -> None:
    """Encode faces; both decoders give them, and have the same neighbours."""
    encoded = encode_connectivity(faces, vertices)
    assert check_faces(encoded.payload, vertices, len(faces)) == encoded.faces.tolist()
    graph = graph_of_faces(encoded.faces, vertices)
    neighbours = reference.neighbours_of(encoded.faces.tolist(), vertices)
    assert neighbours == [list(row) for row in np.split(graph.neighbours, graph.offsets[1:-1])]


def holey(rows: int, columns: int, close: tuple[bool, bool], seed: int, flips: int) -> tuple[Faces, int]:
    """A grid, cylinder or torus with holes, turned and repeated faces, and shuffled numbers."""
    rng = np.random.default_rng(seed)
    faces = grid_faces(rows, columns, close_rows=close[0], close_columns=close[1])
    faces = faces[rng.random(len(faces)) < rng.choice([1.0, 0.9, 0.5])]
    if len(faces) == 0:
        faces = np.array([[0, 1, 2]], np.int32)
    turned = rng.integers(0, len(faces), flips)
    faces[turned] = faces[turned][:, ::-1]
    faces = np.concatenate([faces, faces[rng.integers(0, len(faces), flips // 3)]])
    return compact(rng.permutation(rows * columns)[faces][rng.permutation(len(faces))])


HOLEY = st.builds(
    holey,
    st.integers(3, 9),
    st.integers(3, 9),
    st.tuples(st.booleans(), st.booleans()),
    st.integers(0, 2**32 - 1),
    st.integers(0, 9),
)


@quick
@given(SOUPS.map(lambda soup: compact(np.array(soup))))
def test_any_triangles(mesh: tuple[Faces, int]) -> None:
    check_mesh(*mesh)


@quick
@given(HOLEY)
def test_grids_and_tori_with_holes_flips_and_repeats(mesh: tuple[Faces, int]) -> None:
    check_mesh(*mesh)


@pytest.mark.parametrize(
    "faces",
    [
        np.arange(300).reshape(-1, 3),
        [[0, 1 + k, 1 + (k + 1) % 40] for k in range(40)],
        [[0, 1, 2 + k] for k in range(40)],
        [[0, 0, 0], [0, 1, 1]],
        [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2], [0, 4, 5], [0, 6, 4], [4, 6, 5], [0, 5, 6]],
        np.concatenate([grid_faces(5, 5, close_rows=True, close_columns=True) + 25 * k for k in range(9)]),
        grid_faces(30, 35, close_rows=True, close_columns=True),
    ],
    ids=["triangles", "wheel", "book", "degenerate", "kissing", "tori", "torus"],
)
def test_special_meshes(faces: Any) -> None:
    check_mesh(np.array(faces, np.int32), int(np.max(faces)) + 1)


def damaged(payload: bytes, data: st.DataObject) -> bytes:
    """A payload cut, lengthened, or with some bytes changed."""
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


@settings(max_examples=60)
@given(st.one_of(HOLEY, SOUPS.map(lambda soup: compact(np.array(soup)))), st.data())
def test_damaged_connectivity(mesh: tuple[Faces, int], data: st.DataObject) -> None:
    faces, vertices = mesh
    payload = encode_connectivity(faces, vertices).payload
    check_faces(damaged(payload, data), vertices, len(faces) + data.draw(st.sampled_from([0, 0, 0, 1])))


@pytest.mark.slow
@pytest.mark.real
@pytest.mark.parametrize("name", ["twelve_dodecahedron", "c3d_spot"])
def test_real_meshes(meshes: Path, name: str) -> None:
    faces, vertices = read_ply(meshes / "static" / f"{name}.ply")
    check_mesh(faces, vertices)


def test_the_limit_is_the_same() -> None:
    assert reference.decode_connectivity.__defaults__ == (DEFAULT_LIMITS.vertices,)


def test_the_tables_are_those_of_the_document() -> None:
    squash, stretch = np.array(reference.SQUASH), np.array(reference.STRETCH)
    assert f"0x{zlib.crc32(squash.astype('<u2').tobytes()):X}" in DOCUMENT
    assert f"0x{zlib.crc32(stretch.astype('<i2').tobytes()):X}" in DOCUMENT
    exact = 65536 / (1 + np.exp(-np.arange(-2880, 2880) / 256))
    np.testing.assert_array_equal(squash, np.clip(np.floor(exact + 0.5), 1, 65535))
    assert np.abs(exact % 1 - 0.5).min() > 0.0003


@quick
@given(st.lists(st.tuples(st.integers(1, 1 << 32), st.integers(0, (1 << 24) - 1)), max_size=20))
def test_integers_of_any_size(items: list[tuple[int, int]]) -> None:
    """Also those that no small mesh needs."""
    coder, contexts = start_writing(10000), np.zeros(1, np.int64)
    bank = make_bank(2 * unsigned_span(3), unsigned_span(3), 1)
    for count, value in items:
        code_uniform(coder, value % count, count)
        code_unsigned(coder, bank, contexts, 0, 3, value)
    decoder, model = reference.RangeDecoder(finish_writing(coder)), reference.Model(inputs=1)
    for count, value in items:
        assert decoder.uniform(count) == value % count
        assert reference.read_unsigned(decoder, model, (0,), 3, 0) == value
    decoder.finish()


def lines(text: str) -> list[str]:
    """The indented lines of a text."""
    return [line.strip() for line in text.splitlines() if line.startswith("    ")]


def numbers(line: str) -> list[list[int]]:
    """A line of faces or other numbers."""
    return [[int(corner) for corner in face.split()] for face in line.split("/")]


EXAMPLES = lines(DOCUMENT[DOCUMENT.index("## C 11. ") :])


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
    rows = [re.findall(r"([0-9a-f]+) +([0-9a-f]+) +(\d+) ([01]) \S", line) for line in EXAMPLES[2:-2]]
    assert [row[0] for row in rows] + [row[1] for row in rows if len(row) > 1] == seen


def test_the_seam_of_the_document() -> None:
    assert check_faces(bytes.fromhex(EXAMPLES[-2]), 6, 3) == numbers(EXAMPLES[-1])
