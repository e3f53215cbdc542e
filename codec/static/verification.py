"""Checks that a stream decodes to what its encoder expects, by the decoder in C, before the stream is handed out."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from bsm.bitstream.container.header import FACE, RECOMPUTED
from bsm.bitstream.errors import BsmError, LimitError, VerificationError
from bsm.bitstream.limits import Limits
from bsm.codec.arrays import Faces, Order, Positions
from bsm.codec.decoding import decode
from bsm.codec.geometry.attributes import SEMANTICS, Attribute
from bsm.codec.geometry.mesh import Metadata, TriangleMesh
from bsm.codec.static.attributes.encoding import PreparedAttribute
from bsm.codec.static.preamble_encoding import Draft, JoinedMesh, Prepared

ROUNDING = 1e-6
"""How far a float of an attribute may be from the encoder's, relatively above 1: it may be rounded differently."""


@dataclass(frozen=True, eq=False)
class AsGiven:
    """The mesh that a stream must return: as given, joined, and in the order of coding."""

    source: TriangleMesh
    joined: JoinedMesh
    prepared: Prepared

    @property
    def vertex_order(self) -> Order:
        """The given vertex that each of the decoder's is, or that lies at its place."""
        if self.joined.splits is not None:
            return self.joined.splits
        return self.joined.first[self.prepared.vertex_order]

    @property
    def loose(self) -> Positions:
        """Positions of vertices that no face uses, where the stream has them, as it has all others."""
        return self.joined.original_positions[
            self.vertex_order[self.joined.index[self.vertex_order] < 0]
        ]

    def matched(self, faces: Faces, vertices: int) -> Order:
        """Return the coded vertex of each of the decoder's, -1 for loose ones, whose faces are `faces`."""
        coded = self.prepared.mesh.faces
        require(faces.shape == coded.shape, f"decoded {len(faces)} of {len(coded)} faces")
        require(
            vertices == len(self.vertex_order),
            f"decoded {vertices} of {len(self.vertex_order)} vertices",
        )
        ordered = self.in_coding_order(faces)
        coded_of = np.full(vertices, -1, np.int64)
        # If two faces disagreed about a vertex, the second would win; the next line finds that.
        coded_of[ordered] = coded
        require(bool((coded_of[ordered] == coded).all()), "the decoded faces differ")
        self._require_order(faces)
        return coded_of

    def in_coding_order(self, corners: Faces) -> Faces:
        """Values of the decoder's corners, shape (m, 3), in the order of coding."""
        if not self.prepared.order:
            return corners
        return self.prepared.of_coded(corners)

    def _require_order(self, faces: Faces) -> None:
        """Require that each face lies where the given one lies; turned, unless the order is kept."""
        expected: npt.NDArray[Any]
        actual: npt.NDArray[Any]
        if self.joined.splits is None:
            expected = self.joined.mesh.faces[self.prepared.face_order]
            actual = self.prepared.vertex_order[faces]
        else:  # copies of a vertex lie at its place
            corners = self.source.faces[self.joined.coded_faces][self.prepared.face_order]
            expected = self.source.positions[corners]
            actual = self.source.positions[self.vertex_order[faces]]
        turns = 3
        if self.prepared.order:
            turns = 1
        # Without a kept order, a face may begin with any of its corners, but never be turned over.
        for turn in range(turns):
            differs = (np.roll(actual, turn, axis=1) != expected).any(
                axis=tuple(range(1, actual.ndim))
            )
            expected = expected[differs]
            actual = actual[differs]
        require(not len(expected), "the decoded order of vertices or faces differs")


def verify(
    draft: Draft,
    original: AsGiven,
    carried: Sequence[PreparedAttribute],
    metadata: Metadata,
    limits: Limits,
    threads: int | None,
) -> TriangleMesh:
    """Decode a draft; `VerificationError` unless positions are equal bit for bit, and all else is as promised."""
    try:
        decoded = decode(b"".join(draft.frames), limits, threads)
    # What the user granted is too little for it: a fact about limits, and no fault of the program.
    except LimitError:
        raise
    except BsmError as error:
        raise VerificationError(f"the decoder refuses the encoded stream: {error}") from error
    matched = original.matched(decoded.faces, len(decoded.positions))
    # To the bit. The encoder has measured its promise on these positions, so equal ones keep it, and others may not.
    require_positions(decoded.positions, draft.decoded, matched, original.loose)
    # All else must come back as well: a stream that loses a unit is as wrong as one that loses a vertex.
    require(decoded.metadata == dict(metadata), "the decoded metadata differ")
    require_attributes(decoded.attributes, carried, decoded.faces, original)
    return decoded


def require_positions(
    decoded: Positions, expected: Positions, matched: Order, loose: Positions
) -> None:
    """Require positions of the closed loop, shape (n, 3), bit for bit, and those of vertices that no face uses."""
    in_order = expected[matched]
    unused = matched < 0
    require(int(unused.sum()) == len(loose), "the decoded vertices that no face uses differ")
    in_order[unused] = loose
    require(bool((decoded == in_order).all()), "the decoded positions differ")


def require_attributes(
    decoded: Sequence[Attribute],
    carried: Sequence[PreparedAttribute],
    faces: Faces,
    original: AsGiven,
) -> None:
    """Require attributes of the closed loop at corners and faces, except for rounding."""
    require(len(decoded) == len(carried), f"decoded {len(decoded)} of {len(carried)} attributes")
    for attribute, prepared_attribute in zip(decoded, carried, strict=True):
        _require_attribute(attribute, prepared_attribute, faces, original)


def _require_attribute(
    attribute: Attribute, carried: PreparedAttribute, faces: Faces, original: AsGiven
) -> None:
    declared = carried.declaration
    name = f"attribute {declared.name!r}"
    same = attribute.name == declared.name and attribute.semantic == SEMANTICS[declared.semantic]
    same = same and attribute.values.shape[1:] == (declared.components,)
    require(same, f"{name} was decoded with a different name or type")
    # Decoders compute these in their own ways, so that their last bits are open.
    if declared.coding == RECOMPUTED:
        is_finite = bool(np.isfinite(attribute.values).all())
        require(is_finite, f"{name} is not finite after decoding")
        return
    actual = attribute.values
    expected = carried.values
    if declared.domain != FACE:
        rows = attribute.indices if attribute.indices is not None else faces
        actual = actual[original.in_coding_order(rows)]
        expected = expected[carried.surface.faces]
    elif original.prepared.order:
        actual = actual[original.prepared.coding_faces]
    require(_alike(actual, expected), f"{name} has other values after decoding")


def _alike(actual: npt.NDArray[Any], expected: npt.NDArray[Any]) -> bool:
    if actual.shape != expected.shape or actual.dtype != expected.dtype:
        return False
    if actual.dtype.kind != "f":
        return bool((actual == expected).all())
    # Floats of attributes come from dequantization in double precision, where one rounding may differ.
    largest = float(np.abs(expected).max(initial=0.0))
    return bool(np.allclose(actual, expected, rtol=ROUNDING, atol=ROUNDING * largest))


def require(holds: bool, problem: str) -> None:
    """Raise a `VerificationError` that says what to do, unless `holds`."""
    if not holds:
        raise VerificationError(
            f"internal error: {problem}; nothing was written. Please report it, with the mesh and the options"
        )
