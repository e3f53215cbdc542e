"""An attribute's values: where they are, their levels, and the numbers that are coded, in one piece or two."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from bsm._engine import Field
from bsm.bitstream._kernels import constant
from bsm.bitstream.attributes import values as coders
from bsm.bitstream.attributes.seams import Joins
from bsm.bitstream.container.header import BITS, FACE, LEVELS, OCTAHEDRAL, RECOMPUTED, TEXCOORD, Declaration, entries_of
from bsm.bitstream.container.wire import with_lengths, write_map
from bsm.bitstream.errors import OptionError, TargetError
from bsm.codec.arrays import Faces, Indices, Levels, Matrix
from bsm.codec.geometry.attributes import KINDS
from bsm.codec.static.attributes.quality import LEAST_NORMAL_BITS, MOST_BITS, MOST_NORMAL_BITS, Quality

Values = npt.NDArray[Any]
Words = npt.NDArray[np.int64]
Reals = npt.NDArray[np.float64]

MOST_LEVEL = 2**32 - 1
_NEAR_ZERO = 1 << 20  # what is below costs less than an offset
_SLACK = 1.0 - 2.0**-20
_USUAL_STEPS = (1.0, 1.0 / 255.0, 1.0 / 65535.0)


@dataclass(frozen=True, eq=False)
class Surface:
    """The values of an attribute as vertices of a mesh of their own."""

    faces: Faces
    vertices: Indices


def surface_of(domain: int, faces: Faces, vertices: int, loose: int, joins: Joins | None) -> Surface:
    """The surface on which values of a domain lie."""
    if domain == FACE:
        return Surface(faces, np.zeros(0, np.int32))
    at = np.arange(vertices, dtype=np.int32) if joins is None else joins.vertices
    corners = faces if joins is None else joins.faces
    return Surface(corners, np.concatenate([at, np.full(loose, -1, np.int32)]).astype(np.int32))


def recomputed(surface: Surface, positions: Matrix) -> Matrix:
    """Normals of the values of a surface: those of the faces around, by area (A 7); shape (k, 3)."""
    places = positions[surface.vertices] if len(surface.vertices) else positions
    a, b, c = (places[surface.faces[:, corner]] for corner in range(3))
    across = np.cross(b - a, c - a)
    normals = np.zeros((len(surface.vertices), 3))
    for corner in range(3):
        for axis in range(3):
            normals[:, axis] += np.bincount(surface.faces[:, corner], weights=across[:, axis], minlength=len(normals))
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.where(lengths > 0.0, normals / np.where(lengths > 0.0, lengths, 1.0), [0.0, 0.0, 1.0])


@dataclass(frozen=True, eq=False)
class QuantizedValues:
    """Values as whole numbers."""

    fields: dict[str, Any]
    levels: Words
    note: str


def restored(declaration: Declaration, levels: Words) -> Values:
    """Values of levels, shape (k, words) (A 5)."""
    kind = np.dtype(KINDS[declaration.kind])
    if declaration.coding == OCTAHEDRAL:
        return coders.octahedral_normals(levels, declaration.largest[0] // 2).astype(kind)
    offset = np.array(declaration.offsets)
    if declaration.coding == BITS:
        return _of_bits(levels + offset.astype(np.int64), kind)
    values = offset + np.array(declaration.steps) * levels
    return values.astype(kind) if declaration.is_float else values.astype(np.int64).astype(kind)


def quantized(values: Values, semantic: str, quality: Quality, name: str) -> QuantizedValues:
    """Return values, shape (k, c), as integers that keep the requested quality."""
    is_float, normals = values.dtype.kind == "f", semantic == "normal" and values.shape[1] == 3
    if quality.way == "recompute":
        if not (is_float and normals):
            raise OptionError(f"{name!r}: only normals of three floats can be recomputed")
        return QuantizedValues({"coding": RECOMPUTED}, np.zeros((0, 0), np.int64), "recomputed from the decoded mesh")
    if quality.way == "angle" or (quality.way == "bits" and normals and is_float):
        if not (is_float and normals):
            raise OptionError(f"{name!r}: only normals of three floats can be kept to an angle")
        return _normals(values, quality, name)
    if not is_float:
        return _whole(values, quality)
    if quality.way == "exact" or (quality.way == "bits" and quality.amount > MOST_BITS):
        return _exact(values)
    return _rounded(values, semantic, quality, name)


def _whole(values: Values, quality: Quality) -> QuantizedValues:
    """Integers: exact, or in steps that are whole numbers, too."""
    wide = values.astype(np.int64)
    low = wide.min(axis=0)
    extent = int((wide - low).max())
    step = 1
    if quality.way == "bits":
        step = -(-extent // (2 ** int(quality.amount) - 1)) or 1
    elif quality.way in ("bound", "share"):
        bound = quality.amount if quality.way == "bound" else quality.amount / 100.0 * extent
        step = 2 * int(bound) + 1
    most = wide.max(axis=0)
    if step == 1 and low.min() >= 0 and most.max() < _NEAR_ZERO:
        low = np.zeros_like(low)
    # The last level may not lie beyond the range of the kind: where it would, begin so much lower.
    levels = (wide - low + step // 2) // step
    beyond = low + levels.max(axis=0) * step - most
    room = low - np.iinfo(values.dtype).min
    low = low - np.clip(beyond, 0, np.minimum(step // 2, room))
    levels = (wide - low + step // 2) // step
    while (low + levels.max(axis=0) * step > np.iinfo(values.dtype).max).any():
        levels = np.minimum(levels, (np.iinfo(values.dtype).max - low) // step)
    note = "exact" if step == 1 else f"in steps of {step}"
    return QuantizedValues(_affine(LEVELS, levels, low.astype(float), float(step)), levels, note)


def _exact(values: Values) -> QuantizedValues:
    """Floats, to the bit: as multiples of a usual step where they are, or as the whole numbers that their bits are."""
    for step in _USUAL_STEPS:
        low = np.floor(values.astype(np.float64).min(axis=0) / step)
        if not (np.abs(low).max() < 2.0**40):
            continue
        if low.min() >= 0.0 and values.max() / step < _NEAR_ZERO:
            low = np.zeros_like(low)
        levels = np.rint(values / step - low).astype(np.int64)
        if levels.max() <= MOST_LEVEL:
            offset = low * step
            back = (offset + step * levels).astype(values.dtype)
            if (back.view(np.uint8) == values.view(np.uint8)).all():
                return QuantizedValues(_affine(LEVELS, levels, offset, step), levels, "exact")
    words = _bits_of(values)
    low = words.min(axis=0)
    levels = words - low
    return QuantizedValues(_affine(BITS, levels, low.astype(float), 1.0), levels, "exact")


def _rounded(values: Values, semantic: str, quality: Quality, name: str) -> QuantizedValues:
    """Floats in steps."""
    wide = values.astype(np.float64)
    low, high = wide.min(axis=0), wide.max(axis=0)
    extent = float((high - low).max())
    if not np.isfinite(extent):
        raise OptionError(f"{name!r}: its range is beyond that of numbers; keep it exact")
    most = 2 ** int(quality.amount) - 1 if quality.way == "bits" else 0
    if quality.way == "bits":
        unit = semantic == "color" and low.min() >= 0.0 and high.max() <= 1.0
        step = 1.0 / most if unit else extent / most
        low = np.zeros_like(low) if unit else low
        bound = step / 2
    else:
        bound = quality.amount if quality.way == "bound" else quality.amount / 100.0 * extent
        step = 2.0 * bound * _SLACK
    if not step > 0.0:
        step = bound = 1.0
    counts = (high - low) / step
    if counts.max() > MOST_LEVEL:
        raise OptionError(f"{name!r}: a bound of {bound:g} is too fine for its range; keep it exact")
    levels = np.rint((wide - low) / step).astype(np.int64)
    fields = _affine(LEVELS, levels, low, step)
    kind = KINDS.index(values.dtype.name)
    sample = Declaration(name="x", kind=kind, components=values.shape[1], rows=1, **fields)
    back = restored(sample, levels).astype(np.float64)
    error = float(np.abs(back - wide).max())
    last = float(np.spacing(np.abs(values).max()))
    if error > (bound if quality.way != "bits" else bound * (1 + 1e-6) + last):
        raise TargetError(f"{name!r}: {values.dtype} cannot be kept within {bound:g}; the best is {error:g}")
    return QuantizedValues(fields, levels, f"within {error:.3g}" if error else "exact")


def _normals(values: Values, quality: Quality, name: str) -> QuantizedValues:
    """Normals as points of an octahedron, unfolded to a square; or of a cube, if some have no length and keep none."""
    wide = values.astype(np.float64)
    lengths = np.linalg.norm(wide, axis=1, keepdims=True)
    units = np.where(lengths > 0.0, wide / np.where(lengths > 0.0, lengths, 1.0), [0.0, 0.0, 1.0])
    tried = range(LEAST_NORMAL_BITS, MOST_NORMAL_BITS + 1)
    if quality.way == "bits":
        tried = range(max(LEAST_NORMAL_BITS, min(int(quality.amount), MOST_NORMAL_BITS)), MOST_NORMAL_BITS + 1)[:1]
    some = (lengths == 0.0).any()
    fields: dict[str, Any]
    for bits in tried:
        largest = 2**bits - 2
        if some:
            step = 2.0 ** (1 - bits)  # a power of two, so that 0 comes back as 0
            levels = np.rint((wide / np.where(lengths > 0.0, lengths, 1.0) + 1.0) / step).astype(np.int64)
            fields = _affine(LEVELS, levels, np.full(3, -1.0), step)
            back = np.where(lengths > 0.0, levels * step - 1.0, units)
        else:
            levels, fields = _places(units, largest), {"coding": OCTAHEDRAL, "largest": (largest, largest)}
            back = coders.octahedral_normals(levels, largest // 2).astype(values.dtype).astype(np.float64)
        across = np.linalg.norm(np.cross(back, units), axis=1)
        off = float(np.degrees(np.arctan2(across, (back * units).sum(axis=1))).max())
        if quality.way == "bits" or off <= quality.amount:
            break
    else:
        raise TargetError(f"{name!r}: normals can be kept within {off:.2g} degrees, not {quality.amount:g}")
    note = [f"{bits} bits, within {off:.2g} degrees"]
    if some:
        note.append(f"{int((lengths == 0.0).sum())} of no length")
    if np.abs(lengths - 1.0)[lengths > 0.0].max(initial=0.0) > 1e-3:
        note.append("all of length one now")
    return QuantizedValues(fields, levels, ", ".join(note))


def _affine(coding: int, levels: Words, offset: Reals, step: float) -> dict[str, Any]:
    """Return the fields of a declaration without defaults."""
    return {
        "coding": coding,
        "largest": tuple(int(value) for value in levels.max(axis=0)),
        "offset": tuple(float(value) + 0.0 for value in offset) if (offset != 0.0).any() else (),
        "step": (step,) if step != 1.0 else (),
    }


def _places(units: Reals, largest: int) -> Words:
    """The places nearest to unit vectors, on a square of 0 to `largest`."""
    middle = largest // 2
    flat = units / np.abs(units).sum(axis=1, keepdims=True)
    x, y, z = flat.T
    below = z < 0.0
    u = np.where(below, np.copysign(1.0 - np.abs(y), x), x) * middle + middle
    v = np.where(below, np.copysign(1.0 - np.abs(x), y), y) * middle + middle
    best = np.stack([np.floor(u), np.floor(v)], axis=1).clip(0, largest).astype(np.int64)
    closeness = (coders.octahedral_normals(best, middle) * units).sum(axis=1)
    for right in range(2):
        for up in range(2):
            place = np.stack([np.floor(u) + right, np.floor(v) + up], axis=1).clip(0, largest).astype(np.int64)
            close = (coders.octahedral_normals(place, middle) * units).sum(axis=1)
            better = close > closeness
            best[better], closeness[better] = place[better], close[better]
    return coders.canonical_levels(best, middle).astype(np.int64)


def _bits_of(values: Values) -> Words:
    """The bits of floats as whole numbers of 32 bits that ascend with them; of doubles two each, the higher first."""
    size = values.dtype.itemsize
    kind = np.dtype(f"u{size}")
    bits, top = values.view(kind), kind.type(1) << kind.type(8 * size - 1)
    ordered = np.where(bits & top, ~bits, bits | top)
    if size == 4:
        return np.asarray(ordered.astype(np.int64))
    pairs = np.stack([ordered >> np.uint64(32), ordered & np.uint64(MOST_LEVEL)], axis=2)
    return pairs.reshape(len(values), -1).astype(np.int64)


def _of_bits(words: Words, kind: np.dtype[Any]) -> Values:
    """Twin of `_bits_of`; values that are not finite become 0."""
    unsigned = np.dtype(f"u{kind.itemsize}")
    if kind.itemsize == 8:
        pairs = words.reshape(len(words), -1, 2).astype(np.uint64)
        ordered = pairs[:, :, 0] << np.uint64(32) | pairs[:, :, 1]
    else:
        ordered = words.astype(np.uint32)
    top = unsigned.type(1) << unsigned.type(8 * kind.itemsize - 1)
    bits = np.where(ordered & top, ordered ^ top, ~ordered)
    values = np.ascontiguousarray(bits.astype(unsigned)).view(kind)
    return np.where(np.isfinite(values), values, kind.type(0))


MOST_WHOLE, PIECE_BITS = constant("MOST_WHOLE"), constant("PIECE_BITS")  # larger levels are coded in two pieces


def to_pieces(declaration: Declaration, levels: Words) -> Levels:
    """Levels, shape (k, words), as numbers that are coded, shape (k, pieces)."""
    columns = []
    for largest, level in zip(declaration.largest, levels.T, strict=True):
        columns += [level] if largest <= MOST_WHOLE else [level >> PIECE_BITS, level & ((1 << PIECE_BITS) - 1)]
    return np.stack(columns, axis=1).astype(np.int32)


def leans(declaration: Declaration) -> bool:
    """Whether numbers are predicted from positions, should these be there."""
    small = declaration.coding == LEVELS and max(declaration.largest) <= MOST_WHOLE
    texcoords = small and declaration.semantic == TEXCOORD and declaration.words == 2
    return declaration.domain != FACE and (texcoords or declaration.coding == OCTAHEDRAL)


def field_of(declaration: Declaration, surface: Surface, pieces: Levels, places: Levels | None) -> Field:
    """The field of the numbers of an attribute, shape (k, pieces), predicted from `places`, shape (n, 3)."""
    declared = write_map(entries_of(replace(declaration, leans=int(places is not None))))
    vertices = 1 + int(max(surface.faces.max(initial=0), surface.vertices.max(initial=0)))
    field = Field(surface.faces, pieces)
    field.attribute(declared, vertices if places is None else len(places), surface.vertices, places)
    return field


def write_values(field: Field, count: int) -> bytes:
    """The next `count` values: where there are several payloads, each with its length before it."""
    payloads = field.write(count)
    return payloads[0] if len(payloads) == 1 else with_lengths([*payloads, b""])
