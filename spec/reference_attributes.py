"""A decoder of attributes, written from extension-attributes.md (D) alone: slow, plain, easy to compare.

It shares no code with the product. Docstrings and comments name the rules that they implement.

    1  Declarations        (rules 1)
    2  Seams               (rules 2)
    3  Rows                (rules 3)
    4  Values              (rules 4)
    5  Geometry            (rules 5)
"""

from __future__ import annotations

import math
import struct
from collections.abc import Iterable, Sequence
from typing import Any

from reference_connectivity import CorruptError, Model, RangeDecoder
from reference_fields import Mesh as Corners
from reference_values import FaceReader, ValueReader

Face = Sequence[int]
KINDS = ("uint8", "int8", "uint16", "int16", "uint32", "int32", "float32", "float64")
SEMANTICS = ("generic", "color", "normal", "texcoord")
RANGES = (
    (0, 2**8 - 1),
    (-(2**7), 2**7 - 1),
    (0, 2**16 - 1),
    (-(2**15), 2**15 - 1),
    (0, 2**32 - 1),
    (-(2**31), 2**31 - 1),
)
MOST_VALUES = 1 << 28


def require(condition: object, problem: str) -> None:
    """What does not hold is corrupt."""
    if not condition:
        raise CorruptError(problem)


# ---------------------------------------------------------------------------------------------------------------------
# 1  Declarations
# ---------------------------------------------------------------------------------------------------------------------

# name: (key, type, low, high, default), as those of the header
FIELDS: dict[str, tuple[int, Any, float, float, Any]] = {
    "name": (1, str, 1, 255, None),
    "domain": (2, "method", 0, 2, 0),
    "origin": (3, "method", 0, 1, 0),
    "semantic": (4, "method", 0, 3, 0),
    "kind": (5, "method", 0, 7, 6),
    "components": (6, int, 1, 4, 1),
    "coding": (7, "method", 0, 3, 0),
    "rows": (8, int, 0, 2**31 - 1, 0),
    "largest": (9, [0, 8], 0, 2**32 - 1, []),
    "offset": (10, (0, 8), -1e300, 1e300, []),
    "step": (11, (0, 4), 1e-300, 1e300, []),
    "leans": (12, "method", 0, 1, 0),
    "moves": (13, "method", 0, 1, 0),
    "seams_of": (15, int, 0, 2**16 - 1, 0),
}


class Declaration:
    """D 1: the fields of an attribute, and its seams' bytes."""

    def __init__(self, fields: dict[str, Any], seams: bytes) -> None:
        self.fields, self.seams = fields, seams
        self.check()

    def __getattr__(self, name: str) -> Any:
        return self.fields[name]

    @property
    def words(self) -> int:
        """D 1.3."""
        return {1: 2, 2: self.components * (2 if self.kind == 7 else 1), 3: 0}.get(self.coding, self.components)

    @property
    def offsets(self) -> list[float]:
        """One for each word."""
        return self.offset or [0.0] * self.words

    @property
    def steps(self) -> list[float]:
        """One for each word."""
        return self.step * self.words if len(self.step) == 1 else self.step or [1.0] * self.words

    @property
    def by_vertex(self) -> bool:
        """Whether the user is given values of vertices (D 1.2)."""
        return (self.domain, self.origin) in ((0, 0), (1, 1))

    def check(self) -> None:
        """D 1.4, but for what depends on other attributes."""
        floats = self.kind >= 6
        require(self.origin == 0 or self.domain != 2, "faces given by something else")
        require(len(self.largest) == self.words, "a wrong number of largest levels")
        require((self.rows == 0) == (self.coding == 3), "a wrong number of rows")
        require(len(self.offset) in (0, self.words) and len(self.step) in (0, 1, self.words), "offsets or steps")
        if self.coding in (1, 3):
            require(self.components == 3 and floats and not self.offset and not self.step, "these are no normals")
        if self.coding == 1:
            first, second = self.largest
            require(first == second and first % 2 == 0 and 2 <= first <= 65534, "this is no octahedron")
        if self.coding == 3:
            require(self.domain != 2 and not self.leans, "recomputed values of faces, or ones that lean")
        if self.coding == 2:
            require(floats and not self.step, "bits of integers, or with steps")
            for offset, most in zip(self.offsets, self.largest):
                require(offset >= 0 and offset == int(offset) and offset + most <= 2**32 - 1, "more than 32 bits")
        if self.coding == 0:
            for offset, step, most in zip(self.offsets, self.steps, self.largest):
                last = offset + step * most
                if floats:
                    bound = float(2**128 - 2**104) if self.kind == 6 else 1e308
                    require(math.isfinite(last) and abs(offset) <= bound and abs(last) <= bound, "values out of range")
                else:
                    low, high = RANGES[self.kind]
                    require(offset == int(offset) and step == int(step), "offset or step is no whole number")
                    require(low <= offset and last <= high, "values out of range")
        still = self.domain or self.origin or self.coding
        require(not (self.moves and still), "what moves are levels of vertices")
        require(not self.leans or self.domain != 2, "values of faces that lean on positions")
        require(not self.seams_of or self.domain == 1, "seams where there are no corners")
        require(not self.seams or (self.domain == 1 and not self.seams_of), "seams that are none of its own")


def check_declarations(attributes: list[Declaration], header: dict[str, Any]) -> None:
    """D 1.1, D 1.4: what attributes must be beside each other."""
    for index, one in enumerate(attributes):
        require(one.name not in {other.name for other in attributes[:index]}, "two attributes of one name")
        require(header["grid"] or not one.leans, "an attribute that leans on no grid")
        require(header["gop_frames"] or not one.moves, "an attribute of one mesh that moves")
        if one.seams_of:
            require(one.seams_of <= index, "seams of an attribute that does not come before")
            shared = attributes[one.seams_of - 1]
            require(shared.domain == 1 and not shared.seams_of, "seams of an attribute without any of its own")


# ---------------------------------------------------------------------------------------------------------------------
# 2  Seams
# ---------------------------------------------------------------------------------------------------------------------

NO_SEAM, SEAM, OPEN, UNKNOWN = range(4)


def read_seams(payload: bytes, corners: Corners, earlier: list[list[int]]) -> list[int]:
    """D 2.1 to D 2.5: NO_SEAM, SEAM or OPEN for each corner."""
    size, vertex, opposite = len(corners.vertex), corners.vertex, corners.opposite
    decoder = RangeDecoder(payload)
    models = [Model(4) for _ in range(9)]
    slots = models[0].slots
    for model in models:
        model.slots = slots
    known, left, border = ([0] * corners.vertices for _ in range(3))
    side = [UNKNOWN if k in opposite else OPEN for k in range(size)]
    for k in range(size):
        for end in (vertex[corners.next(k)], vertex[corners.previous(k)]):
            if k not in opposite:
                border[end] += 1
            elif k < opposite[k]:
                left[end] += 1

    def state(v: int) -> int:
        return 8 * min(known[v], 3) + 2 * min(left[v], 3) + (border[v] > 0)

    for k in range(size):
        if k not in opposite or opposite[k] < k:
            continue
        e = opposite[k]
        ends = vertex[corners.next(k)], vertex[corners.previous(k)]
        for end in ends:
            left[end] -= 1
        high, low = sorted(map(state, ends), reverse=True)
        o = sum(factor * (1 + (seams[k] == SEAM)) for factor, seams in zip((3, 1), earlier[::-1]))
        here = 4 * side[corners.next(k)] + side[corners.previous(k)]
        there = 4 * side[corners.next(e)] + side[corners.previous(e)]
        contexts = [
            32 * high + low,
            1024 + 16 * o + 4 * (high >> 3) + (low >> 3),
            1168 + 16 * here + there,
            1424 + o,
        ]
        seam = models[o].bit(decoder, contexts, 0)
        side[k] = side[e] = SEAM if seam else NO_SEAM
        for end in ends:
            known[end] += seam
    decoder.finish()
    return side


def groups_of(corners: Corners, side: list[int]) -> tuple[list[list[int]], list[int]]:
    """D 2.6: the group of each corner, by faces, and the vertex of each group."""
    vertex = corners.vertex
    beside: list[list[int]] = [[] for _ in vertex]
    for k, e in corners.opposite.items():
        if side[k] != NO_SEAM:
            continue
        a, b, c, d = corners.next(k), corners.previous(k), corners.next(e), corners.previous(e)
        pairs = ((a, d), (b, c)) if vertex[a] == vertex[d] else ((a, c), (b, d))
        for x, y in pairs:
            beside[x].append(y)
            beside[y].append(x)
    group, places = [-1] * len(vertex), []
    for k in range(len(vertex)):
        if group[k] >= 0:
            continue
        group[k], waiting = len(places), [k]
        while waiting:
            for near in beside[waiting.pop()]:
                if group[near] < 0:
                    group[near] = len(places)
                    waiting.append(near)
        places.append(vertex[k])
    return [group[k : k + 3] for k in range(0, len(group), 3)], places


# ---------------------------------------------------------------------------------------------------------------------
# 3  Rows
# ---------------------------------------------------------------------------------------------------------------------


class Attribute:
    """One attribute of a mesh whose faces are known."""

    def __init__(
        self,
        declared: Declaration,
        faces: list[Face],
        vertices: int,
        loose: int,
        side: list[int] | None,
        corners: Corners,
    ) -> None:
        self.declared, self.side = declared, side
        self.faces, places = [list(face) for face in faces], list(range(vertices))
        if side is not None:
            self.faces, places = groups_of(corners, side)
        self.places = [*places, *(vertices + i for i in range(loose))] if declared.domain != 2 else []
        self.of_vertex = len(places)
        self.rows = len(faces) if declared.domain == 2 else len(self.places)

    def check_rows(self) -> None:
        """D 1.2, known when all declarations are (F 3.13)."""
        require(self.declared.coding == 3 or self.declared.rows == self.rows, "a wrong number of rows")

    def read(self, chunks: Iterable[tuple[int, bytes]], positions: Sequence[Sequence[int]]) -> list[list[float]]:
        """D 3: the values of all rows; `positions` are those of D 5."""
        declared = self.declared
        split = [most >= 1 << 20 for most in declared.largest]  # D 3.2
        largest = [x for most, two in zip(declared.largest, split) for x in ((most >> 16, 65535) if two else (most,))]
        groups = [largest[at : at + 4] for at in range(0, len(largest), 4)]  # D 3.3
        readers = [self.reader(group, positions) for group in groups]
        for count, payload in chunks:
            at = 0
            for reader in readers:
                if len(readers) == 1:
                    part, at = payload, len(payload)
                else:
                    size, at = read_varint(payload, at)
                    require(size <= len(payload) - at, "a group ends too early")
                    part, at = payload[at : at + size], at + size
                reader.read(part, count)
            require(at == len(payload), "bytes behind the last group")
        values = []
        for row in range(self.rows):
            pieces = iter([piece for reader in readers for piece in reader.x[row]])
            words = [next(pieces) << 16 | next(pieces) if two else next(pieces) for two in split]
            require(all(word <= most for word, most in zip(words, declared.largest)), "a word is too large")
            values.append(value_of(declared, words))
        return values

    def reader(self, largest: list[int], positions: Sequence[Sequence[int]]) -> ValueReader | FaceReader:
        """D 3.4."""
        declared = self.declared
        if declared.domain == 2:
            return FaceReader(self.faces, largest)
        kind = "plain"
        if declared.coding == 1:
            kind = "normal"
        elif declared.coding == 0 and all(most < 1 << 20 for most in declared.largest):
            if declared.semantic == 3 and declared.words == 2:
                kind = "texcoord"
            elif declared.semantic == 1:
                kind = "color"
        geometry = None
        if declared.leans:
            loose = [(0, 0, 0)] * (self.rows - self.of_vertex)
            geometry = [*(positions[v] for v in self.places[: self.of_vertex]), *loose]
        return ValueReader(self.faces, self.rows, largest, kind, geometry, self.places)

    def recomputed(self, positions: Sequence[Sequence[float]]) -> list[list[float]]:
        """D 4.4."""
        sums = [[0.0, 0.0, 0.0] for _ in range(self.rows)]
        for face in self.faces:
            a, b, c = (positions[self.places[row]] for row in face)
            u, v = ([y - x for x, y in zip(a, p)] for p in (b, c))
            cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
            for row in face:
                sums[row] = [x + y for x, y in zip(sums[row], cross)]
        lengths = [math.sqrt(sum(x * x for x in row)) for row in sums]
        return [[x / size for x in row] if size > 0 else [0.0, 0.0, 1.0] for row, size in zip(sums, lengths)]


def read_varint(data: bytes, at: int) -> tuple[int, int]:
    """F 1.2."""
    value = 0
    for shift in range(5):
        require(at + shift < len(data), "a number ends too early")
        byte = data[at + shift]
        value |= (byte & 127) << 7 * shift
        if byte < 128:
            require(byte or not shift, "a number is not in its shortest form")
            return value, at + shift + 1
    raise CorruptError("a number is too long")


# ---------------------------------------------------------------------------------------------------------------------
# 4  Values
# ---------------------------------------------------------------------------------------------------------------------


def value_of(declared: Declaration, words: list[int]) -> list[float]:
    """D 4.1 to D 4.3."""
    if declared.coding == 1:
        size = declared.largest[0] // 2
        u, v = words[0] - size, words[1] - size
        w = size - abs(u) - abs(v)
        if w < 0:
            u, v = (-1 if u < 0 else 1) * (size - abs(v)), (-1 if v < 0 else 1) * (size - abs(u))
        length = math.sqrt(u * u + v * v + w * w)
        return [u / length, v / length, w / length]
    if declared.coding == 2:
        whole = [word + int(offset) for word, offset in zip(words, declared.offsets)]
        width = 64 if declared.kind == 7 else 32
        if width == 64:
            whole = [high << 32 | low for high, low in zip(whole[::2], whole[1::2])]
        return [from_bits(bits, width) for bits in whole]
    return [offset + step * word for offset, step, word in zip(declared.offsets, declared.steps, words)]


def from_bits(bits: int, width: int) -> float:
    """D 4.3."""
    top = 1 << (width - 1)
    bits = bits ^ top if bits & top else bits ^ (2 * top - 1)
    value = struct.unpack(">f" if width == 32 else ">d", bits.to_bytes(width // 8, "big"))[0]
    return float(value) if math.isfinite(value) else 0.0
