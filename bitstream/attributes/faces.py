"""Values of attributes on faces to bytes and back, given the mesh: integers; exact."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from bsm.bitstream import _kernels
from bsm.bitstream.attributes.ranges import checked_largest, checked_values
from bsm.bitstream.entropy.range_coder import Coder
from bsm.bitstream.errors import MeshError
from bsm.bitstream.fields.chunks import Field, FieldDecoder, FieldEncoder
from bsm.bitstream.fields.corners import BYTES_PER_FACE, BYTES_PER_VERTEX, corners_of
from bsm.bitstream.fields.model import MODEL_BYTES, make_model
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits

Ints = npt.NDArray[np.int32]


class _FaceValues(NamedTuple):
    """State of values on faces; the struct `FaceValues` of `faces.h`."""

    largest: Ints
    values: Ints
    gaps: Ints
    memory: Ints


def face_values_charge(faces: int, components: int) -> int:
    """Bytes of memory that coding values of faces takes at most; its work is linear in `faces`."""
    return (3 * BYTES_PER_VERTEX + BYTES_PER_FACE + 8 * components) * faces + MODEL_BYTES + (1 << 17)


def _field_of(faces: npt.ArrayLike, largest: npt.ArrayLike) -> Field:
    """What encoder and decoder share."""
    top = checked_largest(largest)
    given = np.asarray(faces)
    corners = corners_of(given, int(given.max()) + 1 if given.size and given.dtype.kind in "iu" else 0)
    count, components = len(corners.faces), len(top)
    model = make_model()
    values = _FaceValues(
        top,
        np.zeros((count, components), np.int32),
        np.zeros((count, components), np.int32),
        np.zeros((components, 257), np.int32),
    )

    def code(coder: Coder, first: int, number: int) -> int:
        return _kernels.code_faces(coder, model, corners, values, first, number)

    return Field(code, np.arange(count, dtype=np.int32), values.values)


class FaceValueEncoder(FieldEncoder):
    """Codes values of faces, in the order of the faces: materials, groups, colours."""

    def __init__(self, faces: npt.ArrayLike, values: npt.ArrayLike, largest: npt.ArrayLike) -> None:
        given = checked_values(values, checked_largest(largest))
        field = _field_of(faces, largest)
        if len(given) != len(field.order):
            raise MeshError(f"{len(given)} values for {len(field.order)} faces")
        field.values[:] = given
        super().__init__(field)


class FaceValueDecoder(FieldDecoder):
    """Twin of `FaceValueEncoder`."""

    def __init__(self, faces: npt.ArrayLike, largest: npt.ArrayLike, limits: Limits = DEFAULT_LIMITS) -> None:
        limits.check("field_bytes", face_values_charge(len(np.asarray(faces)), len(checked_largest(largest))))
        super().__init__(_field_of(faces, largest))
