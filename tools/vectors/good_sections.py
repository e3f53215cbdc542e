"""Meshes that come in sections: as the encoder cuts them, and as it never would."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from bsm.bitstream.coefficients.packed import pack_coefficients
from bsm.bitstream.connectivity.faces import encode_connectivity
from bsm.bitstream.container.wire import FrameType, write_varint
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.static.encoder import encode
from bsm.codec.static.options import EncodeOptions
from tools.sections import BITS, in_sections
from tools.surgery import Frames, frames_of, stream_of
from tools.vectors.good import BASE, Good
from tools.vectors.good_attributes import charts, colors, creases, groups, worn
from tools.vectors.meshes import hub, patch, tetrahedron, together, torus, triangle

Faces = npt.NDArray[np.int32]


def _encoded(probes: str, mesh: Callable[[], TriangleMesh], sections: int, **options: object) -> Good:
    return Good(probes, lambda: encode(mesh(), replace(BASE, sections=sections, **options)))  # type: ignore[arg-type]


def _rings() -> TriangleMesh:
    return torus(16, 12)


def _repeating() -> TriangleMesh:
    """A patch, and faces that repeat a corner: of its vertices, of one of their own, and of both."""
    mesh = patch(9, 8)
    last = len(mesh.positions)
    positions = np.concatenate([mesh.positions, [[0.4, 0.5, 0.6], [0.9, 0.1, 0.2]]])
    return TriangleMesh(positions, np.concatenate([mesh.faces, [[0, 0, 1], [last] * 3, [last + 1, 5, last + 1]]]))


def _several() -> TriangleMesh:
    return together(torus(9, 8), patch(7, 6), tetrahedron(), torus(6, 5), triangle())


def uneven() -> Faces:
    """A patch whose diagonals run as they like, so that its connectivity takes bytes."""
    faces = patch(12, 9).faces
    first, second = faces[: len(faces) // 2].copy(), faces[len(faces) // 2 :].copy()
    place = np.arange(len(first))
    turned = (place * place * 7 + place * 3) % 11 < 5
    first[turned, 2] = second[turned, 2]
    second[turned, 0] = first[turned, 1]
    return np.concatenate([first, second])


def crowded() -> Faces:
    """All edges between 18 vertices, on a surface with one border that visits all of them.

    The complete graph of 19 vertices triangulates a surface, of which one vertex is left out (G. Ringel, Map Color
    Theorem, 1974): what is around vertex v, in this order, is what is around vertex 0, plus v.
    """
    around = np.array([9, 7, 8, 3, 13, 15, 14, 11, 18, 4, 17, 10, 16, 5, 1, 12, 2, 6])
    vertex = np.arange(19)[:, None]
    fans = np.stack([vertex + 0 * around, (vertex + around) % 19, (vertex + np.roll(around, -1)) % 19], -1)
    faces = fans.reshape(-1, 3)
    first = (faces[:, 0] < faces[:, 1]) & (faces[:, 0] < faces[:, 2])
    return np.unique(faces[first & (faces > 0).all(1)] - 1, axis=0).astype(np.int32)


def small_sections(faces: Faces, cuts: Sequence[int], counts: Sequence[int], columns: int = 4, **fields: Any) -> Frames:
    """A mesh whose sections end behind these faces and have so many blocks, of small packed levels."""
    coded = encode_connectivity(faces, int(faces.max()) + 1, cuts)

    def write(section: int, number: int) -> bytes:
        levels = (7 * np.arange(3 * columns) + 5 * section + 3 * number) % 15 - 7
        return write_varint(columns) + pack_coefficients(levels + (1 << (BITS - 1)), BITS)

    packed = {"coding": 0, "bits": BITS, "coefficients": columns, "stiffness": 2.0, "key_iterations": 4}
    return in_sections(coded, counts, write, **packed | fields)


def _sewn(faces: Faces, cuts: Sequence[int], counts: Sequence[int], **fields: Any) -> bytes:
    return stream_of(small_sections(faces, cuts, counts, **fields))


def _among_others() -> bytes:
    """Skippable frames everywhere, and METADATA behind the first CONNECTIVITY."""
    frames = frames_of(_sewn(uneven(), [40, 100], [2, 1, 2], block_size=60))
    return stream_of(
        [
            *frames[:2],
            (FrameType.METADATA, b"\x81\xa1a\x01"),
            *[one for frame in frames[2:] for one in (frame, (9, b"skip"))],
        ]
    )


SECTIONS: dict[str, Good] = {
    "good-sections": Good(
        "four sections, chains of two blocks, smoothed",
        lambda: encode(
            torus(24, 20),
            EncodeOptions(contract=None, block_size=60, keep=0.1, key_interval=2, smoothing=5.0, sections=4, threads=1),
        ),
    ),
    "good-sections-2": _encoded("two sections, a chain in each", _rings, 2, key_interval=0),
    "good-sections-8": _encoded("eight sections, as many as there may be", _rings, 8, block_size=16),
    "good-sections-keys": _encoded("key blocks within sections", _rings, 2, key_interval=2),
    "good-sections-independent": _encoded("blocks on their own in sections", _rings, 3, key_interval=1),
    "good-sections-exact": _encoded("chains that begin with an exact basis in sections", _rings, 3, key_seed="svd"),
    "good-sections-packed": _encoded("packed coefficients in sections", _rings, 3, bits=10),
    "good-sections-wide": _encoded("blocks that overlap far, in sections", _rings, 3, overlap=1.6),
    "good-sections-details": _encoded("details: normals by the faces so far", _rings, 3, detail=3.0, keep=0.15),
    "good-sections-smoothing": _encoded(
        "smoothing across sections, boundary included", lambda: patch(13, 12), 3, smoothing=2.0
    ),
    "good-sections-components": _encoded("components that end and begin in sections", _several, 3),
    "good-sections-repeating": _encoded(
        "faces that repeat a corner: of the last section", _repeating, 3, block_size=20
    ),
    "good-sections-refined": Good(
        "refinement of a mesh that came in sections",
        lambda: encode(torus(24, 16), replace(BASE, step=None, keep=None, detail=None, sections=3)),
    ),
    "good-sections-attributes": Good(
        "attributes of vertices, corners and faces, declared in the last section",
        lambda: encode(worn(torus(16, 12), charts, creases, colors, groups), replace(BASE, sections=3)),
    ),
    "good-sections-empty-piece": Good(
        "a section whose CONNECTIVITY has no data, and zeros where the payload ended before",
        lambda: _sewn(torus(12, 10).faces, [60, 140, 211], [1, 2, 1, 1], block_size=60),
    ),
    "good-sections-without-edges": Good(
        "vertices without neighbours: their faces come with the next section",
        lambda: _sewn(crowded(), [5, 11], [2, 2, 2], columns=1, block_size=12),
    ),
    "good-sections-among-others": Good("skippable frames between sections, METADATA in the first", _among_others),
    "good-sections-tiny": Good(
        "a section of one face, one of another, blocks of one vertex, and of sections before",
        lambda: _sewn(patch(9, 8).faces, [1, 2, 60], [3, 1, 2, 2], columns=1, block_size=40),
    ),
    "good-sections-cones": Good(
        "vertices with more neighbours than a block has rows, and with more in later sections",
        lambda: _sewn(hub().faces, [4, 20], [2, 2, 2], block_size=12),
    ),
}
