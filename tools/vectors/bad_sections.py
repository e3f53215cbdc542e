"""Streams in sections that every decoder must refuse, each for one rule."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from bsm.bitstream.coefficients.packed import pack_coefficients
from bsm.bitstream.connectivity.faces import Cut, encode_connectivity
from bsm.bitstream.container.wire import FrameType, write_varint
from bsm.codec.sequence.encoder import encode_sequence
from bsm.codec.static.encoder import encode
from bsm.codec.static.options import EncodeOptions
from tools.sections import in_sections
from tools.surgery import Frames, frames_of, stream_of, with_header
from tools.vectors.bad import Bad
from tools.vectors.good import BASE
from tools.vectors.good_attributes import charts, worn
from tools.vectors.good_sections import small_sections, uneven
from tools.vectors.good_sequences import BASE as MOVING
from tools.vectors.meshes import patch, tangled, torus

CONNECTIVITY, BLOCK, ATTRIBUTE = FrameType.CONNECTIVITY, FrameType.BLOCK, FrameType.ATTRIBUTE
PARTITION, ORDER, GOP, METADATA = FrameType.PARTITION, FrameType.ORDER, FrameType.GOP, FrameType.METADATA
REFINEMENT, VALUES = FrameType.REFINEMENT, FrameType.VALUES
SECOND, THIRD = 4, 6
"""Where the second and the third CONNECTIVITY stand in `_three`."""


def _three(**fields: Any) -> Frames:
    """HEADER, and sections of 2, 1 and 2 blocks."""
    return small_sections(uneven(), [40, 100], [2, 1, 2], **{"block_size": 60, **fields})


def _framed(change: Callable[[Frames], object], **fields: Any) -> Callable[[], bytes]:
    def make() -> bytes:
        frames = list(_three(**fields))
        change(frames)
        return stream_of(frames)

    return make


def _header(**changes: Any) -> Callable[[], bytes]:
    return lambda: with_header(stream_of(_three()), **changes)


def _piece(which: int, edit: Callable[[bytes], bytes]) -> Callable[[Frames], None]:
    """Other data in a CONNECTIVITY."""

    def change(frames: Frames) -> None:
        place = [i for i, (kind, _) in enumerate(frames) if kind == CONNECTIVITY][which]
        frames[place] = (CONNECTIVITY, edit(frames[place][1]))

    return change


def _shifted(bytes_more: int) -> Callable[[Frames], None]:
    """The first piece longer by bytes of the second, which is as much shorter, or the other way round."""

    def change(frames: Frames) -> None:
        first, second = frames[1][1], frames[SECOND][1]
        whole, cut = first + second, len(first) + bytes_more
        frames[1], frames[SECOND] = (CONNECTIVITY, whole[:cut]), (CONNECTIVITY, whole[cut:])

    return change


def _swap(first: int, second: int) -> Callable[[Frames], None]:
    def change(frames: Frames) -> None:
        frames[first], frames[second] = frames[second], frames[first]

    return change


def _inserted(place: int, kind: int, payload: bytes = b"") -> Callable[[Frames], None]:
    return lambda frames: frames.insert(place, (kind, payload))


def _cut_off(which: int, rest: int) -> bytes:
    """The stream up to `rest` bytes of a frame."""
    frames = _three()
    head = len(stream_of(frames[:which])) - len(stream_of([])) + len(b"\x89BSM\0")
    return stream_of(frames)[: head + rest]


def _sewn_up() -> bytes:
    """A mesh with vertices where several fans meet, cut all the same."""
    coded = encode_connectivity(tangled().faces, 45)
    cut = replace(coded, cuts=(Cut(20, 20, len(coded.payload) // 2),))
    return stream_of(in_sections(cut, [1, 1], lambda section, number: b"\x01" + bytes(3), **_one_column(45)))


def _one_column(block_size: int) -> dict[str, Any]:
    return {"coding": 0, "bits": 8, "coefficients": 1, "block_size": block_size}


def _only_repeating_left() -> bytes:
    """A section that ends behind the last face that does not repeat a corner."""
    faces = np.concatenate([patch(6, 5).faces, [[0, 0, 1], [3, 3, 3]]]).astype(np.int32)
    coded = encode_connectivity(faces, 30)
    cut = replace(coded, cuts=(Cut(40, 30, len(coded.payload)),))
    return stream_of(in_sections(cut, [1, 1], lambda section, number: b"\x01" + bytes(3), **_one_column(30)))


def _claiming(columns: int = 1, **fields: Any) -> bytes:
    """A section that has come, of a mesh that the header says is large."""
    coded = encode_connectivity(torus(512, 512).faces, 1 << 18, [2400])
    size = coded.cuts[0].vertices
    block = write_varint(columns) + pack_coefficients(np.full(3 * columns, 128), 8)
    header = _one_column(size) | {"coefficients": columns, "blocks": 1025, **fields}
    frames = in_sections(coded, [1, 1], lambda section, number: block, **header)
    return stream_of(frames[:3])


def _overlapping() -> bytes:
    """Blocks that overlap as much as the whole mesh allows, on a section that has few vertices."""
    faces, (count, size) = torus(90, 90).faces, (190, 1000)
    coded = encode_connectivity(faces, 8100, [600])
    assert 16 * coded.cuts[0].vertices + 65536 < count * size <= 16 * 8100 + 65536
    frames = in_sections(coded, [count - 10, 10], lambda section, number: b"\x01" + bytes(3), **_one_column(size))
    return stream_of(frames[:3])


def _attributed(change: Callable[[Frames], object]) -> Callable[[], bytes]:
    """Three sections of a mesh with an attribute."""

    def make() -> bytes:
        frames = frames_of(encode(worn(torus(16, 12), charts), replace(BASE, sections=3)))
        change(frames)
        return stream_of(frames)

    return make


def _moved(kind: int, before: int, which: int) -> Callable[[Frames], None]:
    """A frame of a kind is taken before the frame number `which` of another kind."""

    def change(frames: Frames) -> None:
        moved = frames.pop(next(i for i, frame in enumerate(frames) if frame[0] == kind))
        places = [i for i, frame in enumerate(frames) if frame[0] == before]
        frames.insert(places[which], moved)

    return change


def _sequence() -> bytes:
    mesh = torus(10, 8)
    stream = encode_sequence([mesh.positions, 1.1 * mesh.positions], mesh.faces, MOVING)
    return with_header(stream, sections=[20, 1])


def _grid() -> bytes:
    return with_header(encode(patch(8, 7), EncodeOptions(grid=6)), sections=[20, 1])


def _renumbered(place: int, index: int) -> Callable[[Frames], None]:
    def change(frames: Frames) -> None:
        frames[place] = (BLOCK, write_varint(index) + frames[place][1][1:])

    return change


def _early_end(frames: Frames) -> None:
    del frames[SECOND:]


def _short_then_many(frames: Frames) -> None:
    _shifted(-8)(frames)
    frames.append((CONNECTIVITY, b"\x01"))


def _exchanged(frames: Frames) -> None:
    frames[1], frames[SECOND] = frames[SECOND], frames[1]


HEADERS: dict[str, Bad] = {
    "bad-sections-odd": Bad("sections of three numbers", "corrupt", _header(sections=[40, 2, 60])),
    "bad-sections-zero-faces": Bad("a section without faces", "corrupt", _header(sections=[40, 2, 0, 1])),
    "bad-sections-zero-blocks": Bad("a section without blocks", "corrupt", _header(sections=[40, 2, 60, 0])),
    "bad-sections-all-faces": Bad("no face for the last section", "corrupt", _header(sections=[40, 2, 136, 1])),
    "bad-sections-all-blocks": Bad("no block for the last section", "corrupt", _header(sections=[40, 2, 60, 3])),
    "bad-sections-huge": Bad(
        "numbers of faces whose sum is over 2^31", "corrupt", _header(sections=[2**31 - 1, 1, 2**31 - 1, 1])
    ),
    "bad-sections-nine": Bad("nine sections", "corrupt", _header(sections=[5, 1] * 8, blocks=9)),
    "bad-sections-floats": Bad("numbers of faces that are floats", "corrupt", _header(sections=[40.0, 2.0])),
    "bad-sections-default": Bad("no sections, and that is stored", "corrupt", _header(sections=[])),
    "bad-sections-grid": Bad("sections where there is a grid", "corrupt", _grid),
    "bad-sequence-sections": Bad("sections of a sequence", "corrupt", _sequence),
}

PLACES: dict[str, Bad] = {
    "bad-sections-early": Bad(
        "a CONNECTIVITY before the last block of the section before it", "corrupt", _framed(_swap(3, SECOND))
    ),
    "bad-sections-in-a-row": Bad("two CONNECTIVITYs in a row", "corrupt", _framed(_moved(CONNECTIVITY, BLOCK, -1))),
    "bad-sections-none": Bad("a section without CONNECTIVITY", "corrupt", _framed(lambda f: f.pop(SECOND))),
    "bad-sections-one-more": Bad(
        "one CONNECTIVITY more than sections", "corrupt", _framed(_inserted(9, CONNECTIVITY, b"\x01"))
    ),
    "bad-sections-end": Bad("END behind the first section", "corrupt", _framed(_early_end)),
    "bad-sections-later-block": Bad("a block of the next section", "corrupt", _framed(_renumbered(3, 2))),
    "bad-sections-earlier-block": Bad("a block of the section before", "corrupt", _framed(_renumbered(5, 1))),
    "bad-sections-gap": Bad("a block is missing in a section", "corrupt", _framed(lambda f: f.pop(2))),
    "bad-sections-no-last-block": Bad("the last block of a section is missing", "corrupt", _framed(lambda f: f.pop(3))),
    "bad-sections-last-block": Bad("the last block of all is missing", "corrupt", _framed(lambda f: f.pop())),
    "bad-sections-partition": Bad("PARTITION", "corrupt", _framed(_inserted(2, PARTITION, b"\0"))),
    "bad-sections-order": Bad("ORDER", "corrupt", _framed(_inserted(2, ORDER, b"\x01"))),
    "bad-sections-gop": Bad("a GOP", "corrupt", _framed(lambda f: f.append((GOP, bytes(9))))),
    "bad-sections-refinement-early": Bad(
        "REFINEMENT in the first section",
        "corrupt",
        _framed(_inserted(3, REFINEMENT, b"\0\0\x01"), refinements=[0.5, 0.0]),
    ),
    "bad-sections-attribute-early": Bad(
        "ATTRIBUTE in the first section", "corrupt", _attributed(_moved(ATTRIBUTE, BLOCK, 0))
    ),
    "bad-sections-attribute-between": Bad(
        "ATTRIBUTE before the last CONNECTIVITY", "corrupt", _attributed(_moved(ATTRIBUTE, CONNECTIVITY, -1))
    ),
    "bad-sections-attribute-late": Bad(
        "ATTRIBUTE behind a block of the last section", "corrupt", _attributed(_moved(ATTRIBUTE, BLOCK, -1))
    ),
    "bad-sections-values-early": Bad(
        "VALUES before the last section", "corrupt", _attributed(_moved(VALUES, CONNECTIVITY, -1))
    ),
}

PIECES: dict[str, Bad] = {
    "bad-sections-long": Bad("a piece that is a byte too long", "corrupt", _framed(_shifted(1))),
    "bad-sections-short": Bad("a piece that is a byte too short", "corrupt", _framed(_shifted(-1))),
    "bad-sections-four-short": Bad("a piece that is four bytes too short", "corrupt", _framed(_shifted(-4))),
    "bad-sections-eight-short": Bad("a piece that is eight bytes too short", "truncated", _framed(_shifted(-8))),
    "bad-sections-no-data": Bad("a first piece without data", "truncated", _framed(_piece(0, lambda data: b""))),
    "bad-sections-ones": Bad(
        "a first piece that begins with four bytes of 255",
        "corrupt",
        _framed(_piece(0, lambda data: b"\xff" * 4 + data[4:])),
    ),
    "bad-sections-trailing": Bad(
        "a last piece with bytes left over", "corrupt", _framed(_piece(2, lambda data: data + bytes(5)))
    ),
    "bad-sections-last-short": Bad(
        "a last piece that ends too early",
        "truncated",
        _framed(_piece(2, lambda data: data[:-6])),
    ),
    "bad-sections-whole": Bad(
        "all data in the first piece",
        "corrupt",
        _framed(
            lambda f: [
                f.__setitem__(1, (CONNECTIVITY, b"".join(p for kind, p in f if kind == CONNECTIVITY))),
                _piece(1, lambda data: b"")(f),
                _piece(2, lambda data: b"")(f),
            ]
        ),
    ),
    "bad-sections-exchanged": Bad("the second piece before the first", "corrupt", _framed(_exchanged)),
    "bad-sections-other-faces": Bad(
        "a section of one face more than its piece has", "corrupt", _header(sections=[44, 2, 56, 1])
    ),
    "bad-sections-truncated": Bad("the stream ends in the second CONNECTIVITY", "truncated", lambda: _cut_off(4, 2)),
    "bad-sections-truncated-between": Bad(
        "the stream ends behind the first section", "truncated", lambda: _cut_off(4, 0)
    ),
    "bad-sections-first-of-two": Bad(
        "a piece that ends too early, and then a CONNECTIVITY too many",
        "truncated",
        _framed(_short_then_many),
    ),
    "bad-sections-sewn": Bad("vertices that are several fans", "corrupt", _sewn_up),
    "bad-sections-repeating": Bad(
        "only faces that repeat a corner for the last section", "corrupt", _only_repeating_left
    ),
}

WORK: dict[str, Bad] = {
    "bad-sections-vertices": Bad(
        "a section of fewer vertices than blocks",
        "corrupt",
        lambda: stream_of(small_sections(patch(9, 8).faces, [2, 60], [5, 2, 2], columns=1, block_size=40)),
    ),
    "bad-sections-part": Bad(
        "a section whose only part is larger than a block",
        "corrupt",
        lambda: stream_of(small_sections(patch(12, 9).faces, [100], [1, 4], block_size=40)),
    ),
    "bad-sections-overlap": Bad("blocks that overlap too much in the first section", "corrupt", _overlapping),
    "bad-sections-limit-work": Bad(
        "more work than the vertices of the first section grant, whatever the header claims",
        "limit",
        lambda: _claiming(power=64, key_iterations=1024),
    ),
    "bad-sections-limit-memory": Bad(
        "a dictionary of more than the vertices of the first section grant, whatever the header claims",
        "limit",
        lambda: _claiming(columns=1200, power=1, key_iterations=1),
    ),
}

BAD_SECTIONS: dict[str, Bad] = {**HEADERS, **PLACES, **PIECES, **WORK}
