"""A decoder of one static mesh, written from the law alone: slow, plain, easy to compare with it.

The rules stand beside what follows them: F and M of the core here, C and V in reference_integers.py, the extensions
`base` in reference_base.py and `paper` in reference_paper.py. It is strict. It skips ORDER, ATTRIBUTE and VALUES, and
says that other extensions are unsupported (README.md). numpy adds and multiplies; nothing is shared with the product.

    python spec/reference_decoder.py IN.bsm OUT.npz

writes `positions` (float64, shape (n, 3)) and `faces` (int32, shape (m, 3)); exit codes are those of vectors/README.md.
"""

import binascii
import hashlib
import math
import sys
import zlib
from collections import Counter
from pathlib import Path

import msgpack
import numpy as np
from reference_integers import (
    ERRORS,
    CorruptError,
    FormatError,
    GridReader,
    LevelsReader,
    LimitError,
    Model,
    NumericError,
    RangeDecoder,
    TruncatedError,
    UnsupportedError,
    decode_connectivity,
    neighbors_of,
    place,
)

EXIT_CODES = dict(zip(ERRORS, (3, 4, 5, 6, 7, 12)))
# M 14.1.
LIMITS = {
    "vertices": 1 << 24,
    "faces": 1 << 25,
    "blocks": 1 << 17,
    "block_size": 8192,
    "coefficients": 4096,
}
MOST_FRAME_BYTES, MOST_METADATA_BYTES = 1 << 28, 1 << 23


def require(condition, problem):  # F 1: a violation is *corrupt* unless a rule says otherwise
    if not condition:
        raise CorruptError(problem)


def require_limit(value, most, what):
    if value > most:
        raise LimitError(f"{what} = {value} is over {most}")


# ---------------------------------------------------------------- F 1: varints and maps


def varint(data, start):  # F 1.2: value and offset behind it, None if the data ends inside
    value = 0
    for position in range(5):
        if start + position >= len(data):
            return None
        byte = data[start + position]
        value |= (byte & 0x7F) << (7 * position)
        if byte < 0x80:
            require(byte != 0 or position == 0, "varint is not in its shortest form")
            return value, start + position + 1
    raise CorruptError("varint is longer than five bytes")


def varints(data, count):  # `count` of them at the beginning of a payload, and what is behind them
    values, at = [], 0
    for _ in range(count):
        found = varint(data, at)
        require(found is not None, "payload ends inside a varint")
        values, at = [*values, found[0]], found[1]
    return *values, data[at:]


# F 1.5: one map has one encoding, so decode, check the types, encode again and compare.
def canonical_map(payload):
    try:
        pairs = msgpack.unpackb(payload, raw=False, strict_map_key=False, object_pairs_hook=tuple)
    except Exception as error:  # msgpack raises many kinds
        raise CorruptError(f"not a msgpack map: {error}") from None
    require(type(pairs) is tuple and len(pairs) <= 256, "not a map of at most 256 entries")
    require(
        sum(len(value) for _, value in pairs if type(value) is list) <= 256,
        "arrays of more than 256 entries",
    )
    require(
        {type(key) for key, _ in pairs} in (set(), {int}, {str}),
        "keys must be all integers or all strings",
    )
    keys = [key.encode() if type(key) is str else key for key, _ in pairs]
    require(keys == sorted(set(keys)), "keys must ascend")
    require(all(type(key) is bytes or key >= 0 for key in keys), "an integer key is negative")
    packed = msgpack.Packer().pack_map_header(len(pairs))
    for key, value in pairs:
        packed += msgpack.packb(key) + packed_value(value, nested=False)
    require(packed == payload, "map is not in its shortest form")
    return pairs


def packed_value(value, nested):
    if type(value) is list and not nested:
        return msgpack.Packer().pack_array_header(len(value)) + b"".join(
            packed_value(v, True) for v in value
        )
    require(type(value) in (int, float, str, bytes), "a map may not hold a value of this type")
    if type(value) is not float:
        return msgpack.packb(value)
    require(math.isfinite(value), "a number is not finite")
    with np.errstate(over="ignore"):
        return msgpack.packb(float(value), use_single_float=float(np.float32(value)) == value)


# ---------------------------------------------------------------- F 2 to F 5: frames

HEADER, METADATA, CONNECTIVITY, PARTITION, ORDER, BLOCK, GOP, GRID, REFINEMENT, END = (
    1,
    2,
    3,
    4,
    5,
    6,
    7,
    12,
    13,
    15,
)
ATTRIBUTE, VALUES = 14, 0
PLACES = (
    [HEADER],
    [CONNECTIVITY],
    [PARTITION],
    [ORDER],
    [ATTRIBUTE],
    [BLOCK, GRID],
    [REFINEMENT],
    [VALUES],
    [END],
)
RANKS = {kind: rank for rank, kinds in enumerate(PLACES) for kind in kinds}  # F 3.8
SKIPPED = {ORDER: "order", ATTRIBUTE: "attributes", VALUES: "attributes"}


# F 2 and F 3: yields (type, payload, offset of the tag) of every frame; skippable ones too.
def frames_of(stream):
    magic = b"\x89BSM"
    if not magic.startswith(stream[:4]):
        raise FormatError("not a BSM stream")  # F 2.1
    if len(stream) >= 5 and stream[4] >> 4 != 1:
        raise UnsupportedError(f"version {stream[4] >> 4}, and this reads 1")  # F 2.2
    offset, kind = 5, None
    while kind != END:
        tag = varint(stream, offset) if offset < len(stream) else None
        if tag is None:
            raise TruncatedError("the stream ends before END")  # F 2.4
        kind, length, start = tag[0] & 15, tag[0] >> 4, tag[1]
        require_limit(length, MOST_FRAME_BYTES, "frame length")  # F 3.2
        size = 2 if kind == BLOCK or length < 128 else 4
        end = start + length
        if end + size > len(stream):
            raise TruncatedError("the stream ends inside a frame")
        body = stream[offset:end]
        crc = binascii.crc_hqx(body, 0) if size == 2 else zlib.crc32(body)
        # F 3.3.
        require(
            crc == int.from_bytes(stream[end : end + size], "little"),
            "checksum of a frame is wrong",
        )
        yield kind, stream[start:end], offset
        if kind == HEADER and (entries := brief_entries(stream[start:end])):  # F 11.1
            yield from ((METADATA, notes, offset) for _, notes in entries[1:])
            kind = END
        offset = end + size
    require(offset == len(stream), "data after END")  # F 2.3


# F 4: name: (key, type, low, high, default); of an array the types are those of its entries, and lengths follow
COUNT = 2**31 - 1
FIELDS = {
    "vertices": (1, int, 1, COUNT, None),
    "faces": (2, int, 1, COUNT, None),
    "blocks": (3, int, 0, COUNT, 0),
    "block_size": (4, int, 0, COUNT, 0),
    "coefficients": (5, int, 0, COUNT, 0),
    "key_interval": (6, int, 0, COUNT, 0),
    "step": (7, float, 2.0**-40, 2.0**20, 2.0**-8),
    "center": (8, float, -1e300, 1e300, [0.0, 0.0, 0.0], 3, 3),
    "scale": (9, float, 1e-300, 1e300, 1.0),
    "smoothing": (10, float, 0.0, 1e6, 0.0),
    "refinement": (11, float, 0.0, 64.0, [], 0, 2),
    "attributes": (12, int, 0, 255, 0),
    "grid": (13, int, 0, 2**20 - 1, [], 0, 3),
    "lattice": (14, int, 1, COUNT, [], 0, 2),
    "corner": (15, int, -(2**31), COUNT, [], 0, 3),
    "turn": (24, float, -1.0, 1.0, [0.0, 0.0, 0.0], 3, 3),
    # F 10.1.
    "paper": (19, float, 0.0, 2.0**30, [0.0, 0.0, 0.0, 3.0, 1.0, 2.0, 2.0**-7, 1.0], 8, 8),
    "onorm": (21, int, 1, 64, 0),
    "base": (27, int, 1, COUNT, [], 0, 4),
    "swift": (28, int, 1, 2, 0),
    "repeats": (29, int, 1, 1, 0),
}
EXTENSIONS = {16: "extension light", 17: "extension sequence", 18: "extension sequence"}
EXTENSIONS[22] = "extension congruence"


def brief_entries(payload):  # F 11.1: the map of a brief header, nothing of another one
    if payload[1:2] not in (b"\x17", b"\x19"):
        return ()
    entries = canonical_map(payload)
    return entries if [key for key, _ in entries[1:]] in ([], [26]) else ()


# F 11.2: fields of the header, the payload of CONNECTIVITY, and positions.
def brief_fields(entries):
    key, value = entries[0]
    require(type(value) is bytes and type(entries[-1][1]) is bytes, "brief has a wrong type")
    n, m, *grid, congruence, rest = varints(value, 6)
    length = 16 if key == 23 else 28
    require(len(rest) >= length, "numbers are missing")
    scale, x, y, z, *turn = np.frombuffer(rest[:length], ">f4").astype(float).tolist()
    size, rest = varints(rest[length:], 1)
    require(size <= len(rest), "the faces end early")
    given = {
        "vertices": n,
        "faces": m,
        "grid": grid,
        "scale": scale,
        "center": [x, y, z],
        "turn": turn or [0.0] * 3,
    }
    for name, field in given.items():
        items = field if type(field) is list else [field]
        require(
            all(FIELDS[name][2] <= item <= FIELDS[name][3] for item in items),
            f"{name} is out of range",
        )
    require(congruence <= 68, "congruence is out of range")
    if congruence:
        raise UnsupportedError(EXTENSIONS[22])
    return given, rest[:size], rest[size:]


def parse_header(payload):
    require(len(payload) <= 65536, "a header of too many bytes")  # F 4.9
    if entries := brief_entries(payload):
        h = {name: field[4] for name, field in FIELDS.items()} | brief_fields(entries)[0]
        return agreeing(h, set())
    h, entries, names = (
        {},
        canonical_map(payload),
        {field[0]: name for name, field in FIELDS.items()},
    )
    require(all(type(key) is int for key, _ in entries), "a key is not an integer")  # F 4.1
    for key, _ in entries:  # F 4.2, F 4.8
        if key not in names:
            raise UnsupportedError(EXTENSIONS.get(key, f"key {key}"))
    for name in ("swift", "repeats"):
        method, most = dict(entries).get(FIELDS[name][0]), FIELDS[name][3]
        if type(method) is int and most < method <= 255:  # F 4.5
            raise UnsupportedError(f"{name} {method}")
    for key, value in entries:
        _, kind, low, high, default, *lengths = FIELDS[names[key]]
        items = value if lengths and type(value) is list else [value]
        require(bool(lengths) == (type(value) is list), f"{names[key]} has a wrong type")  # F 4.4
        require(all(type(item) is kind for item in items), f"{names[key]} has a wrong type")
        require(
            not lengths or lengths[0] <= len(items) <= lengths[1],
            f"{names[key]} has a wrong length",
        )
        require(value != default, f"{names[key]} is stored although it has its default")  # F 4.3
        # F 4.5.
        require(all(low <= item <= high for item in items), f"{names[key]} is out of range")
        h[names[key]] = value
    stored = set(h)
    require({"vertices", "faces"} <= stored, "vertices or faces are missing")
    return agreeing({name: field[4] for name, field in FIELDS.items()} | h, stored)


def agreeing(h, stored):
    require(h["vertices"] <= 3 * h["faces"], "more vertices than corners")  # F 4.6
    if h["grid"]:
        beside = {
            "vertices",
            "faces",
            "center",
            "scale",
            "grid",
            "lattice",
            "attributes",
            "corner",
            "turn",
            "swift",
        }
        require(
            stored <= beside | {"repeats"} and len(h["grid"]) == 3, "a grid, and something else"
        )
        require(
            len(h["lattice"]) in (0, 2) and len(h["corner"]) in (0, 3),
            "a lattice or a corner of another length",
        )
        require(not (h["corner"] and "center" in stored), "a corner and a center")
        require(
            not h["lattice"] or max(h["grid"]) <= h["lattice"][1] <= h["lattice"][0],
            "a lattice that is none",
        )
    else:
        require(
            not h["lattice"] and not h["corner"] and "turn" not in stored, "of a grid, without one"
        )
        if {"paper", "onorm"} & stored:
            extension_paper().settings_of(h)
        require(h["blocks"] and h["coefficients"], "no blocks, and no grid")
        if h["base"]:
            extension_base().check_base(h, stored)
        size = h["base"][0] if h["base"] else h["vertices"]  # M 18.1
        require(h["blocks"] <= size, "more blocks than vertices")
        require(
            h["coefficients"] <= h["block_size"] <= size,
            "too large blocks, or too many coefficients",
        )
        require(
            size <= h["blocks"] * h["block_size"] <= 16 * size + 65536, "blocks of a wrong size"
        )
    require(not h["swift"] or h["attributes"], "swift attributes, and none")
    if h["refinement"]:
        require(len(h["refinement"]) == 2, "a refinement is not two numbers")
        require(
            2.0**-40 <= h["refinement"][0] <= 1 and h["refinement"][1] >= 1 / 16,
            "a refinement out of range",
        )
    for name, most in LIMITS.items():  # F 4.7
        require_limit(h[name], most, name)
    return h


def read_frames(stream, packets):
    """F 3.5 to F 3.14, F 5: what frames hold, by their types, put into `packets` up to the first fault."""
    header, last, metadata_names, metadata_bytes, covered = None, None, set(), 0, 0
    for number, (kind, payload, offset) in enumerate(frames_of(stream)):
        if header is None:
            require(kind == HEADER, "the first frame must be HEADER")  # F 3.7
        if 8 <= kind <= 11:
            continue  # F 3.5
        wants = {
            GRID: "grid",
            REFINEMENT: "refinement",
            ATTRIBUTE: "attributes",
            VALUES: "attributes",
        }.get(kind)
        if wants and not header[wants]:
            raise UnsupportedError(f"frame type {kind}")  # F 3.6
        if kind == GOP:
            raise UnsupportedError("extension sequence")
        if kind == METADATA:  # F 5.1, F 3.9
            entries = canonical_map(payload)
            plain = len(payload) - sum(len(value) for _, value in entries if type(value) is bytes)
            require_limit(plain, MOST_METADATA_BYTES, "metadata")
            require(
                all(type(key) is str and type(v) is not list for key, v in entries),
                "metadata of a wrong type",
            )
            names, metadata_bytes = {key for key, _ in entries}, metadata_bytes + plain
            require(not names & metadata_names, "duplicate metadata name")
            require_limit(metadata_bytes, MOST_METADATA_BYTES, "metadata")
            metadata_names |= names
            continue
        parsed = payload
        if kind == HEADER:
            parsed = parse_header(payload)
        elif kind == BLOCK:  # F 5.3, F 3.10
            parsed = index, width, _ = varints(payload, 2)
            require(
                index == len(packets[BLOCK]) and index < header["blocks"],
                "blocks do not follow each other",
            )
            require(width <= header["coefficients"], "too many coefficients")
        elif kind in (GRID, REFINEMENT):  # F 5.6, F 5.7, F 3.11, F 3.12
            parsed = first, count, _ = varints(payload, 2)
            cells = sum(header["base"][:1])  # M 18.8
            end = cells if first < cells else cells + header["vertices"]
            require(
                first == covered and 0 < count <= end - first, "vertices do not follow each other"
            )
        elif kind == END:  # F 5.5
            count, crc = varints(payload, 1)
            require(len(crc) in (4, 8), "END has a wrong length")
            parsed = crc[4:]  # F 5.10
        # F 3.8: ascending; CONNECTIVITY is required; only what comes behind ORDER repeats.
        rank = RANKS[kind]
        legal = (
            kind == HEADER
            if last is None
            else rank > last or (rank == last and rank > RANKS[ORDER])
        )
        require(legal and (rank <= 1 or last >= 1), f"unexpected section type {kind}")
        require(
            kind not in (PARTITION, BLOCK) or not header["grid"],
            "parts or a block where there is a grid",
        )
        require(kind != PARTITION or not header["base"], "parts that follow from cells")  # M 18.1
        if header and rank > RANKS[BLOCK]:
            require(len(packets[BLOCK]) == header["blocks"], "blocks are missing")  # F 3.10
            # F 3.11.
            require(not header["grid"] or covered == header["vertices"], "positions are missing")
        if kind == END:
            require(count == number, "END counts other frames")
            require(
                int.from_bytes(crc[:4], "little") == zlib.crc32(stream[:offset]),
                "CRC of the stream is wrong",
            )
        last, header = rank, header or parsed
        if kind == HEADER and (entries := brief_entries(payload)):  # F 11.1
            _, faces, values = brief_fields(entries)
            packets |= {CONNECTIVITY: [faces], GRID: [(0, header["vertices"], values)], END: [b""]}
        covered += parsed[1] if kind in (GRID, REFINEMENT) else 0
        packets.setdefault(kind, []).append(parsed)


# ---------------------------------------------------------------- M 3 to M 6: blocks


def sweep(graph, segment, start):
    """M 3.3: distance of every vertex of the segment from `start`, and the order in which they were found."""
    distance, found, left = {start: 0}, [start], {*segment} - {start}
    for v in found:  # `found` grows meanwhile
        more = [w for w in graph[v] if w in left]
        if not more and v == found[-1] and left:
            more = [next(w for w in reversed(segment) if w in left)]
        left -= {*more}
        distance |= dict.fromkeys(more, distance[v] + 1)
        found += more
    return distance, found


def bisect(graph, parts):  # M 3: the vertices part after part, and where each part begins
    order, ends, distances = list(range(len(graph))), [len(graph)] * (parts + 1), [{}, {}]
    if len(order) > 8:  # M 3.2
        distances[0] = sweep(graph, order, sweep(graph, order, 0)[1][-1])[0]
    pending = [(0, len(order), 0, parts, 0)]
    while pending:
        first, last, part, count, kept = pending.pop()
        ends[part] = first
        if count == 1:
            continue
        segment = order[first:last]
        if len(segment) > 8:  # M 3.4
            far = max(segment, key=lambda v: distances[kept][v])  # the first of equals
            distance, found = sweep(graph, segment, far)
            distances[1 - kept].update(distance)
            order[first:last] = sorted(found, key=lambda v: distances[0][v] - distances[1][v])
        half = count // 2  # M 3.1, M 3.5
        cut = first + (last - first) * half // count
        pending += [(cut, last, part + half, count - half, 1), (first, cut, part, half, 0)]
    return order, ends


def derive_labels(graph, parts):  # M 4
    order, ends = bisect(graph, parts)
    labels = [0] * len(graph)
    for part in range(parts):
        for v in order[ends[part] : ends[part + 1]]:
            labels[v] = part
    sizes, room = (
        [labels.count(part) for part in range(parts)],
        len(graph) * 103 // (parts * 100) + 1,
    )
    for _ in range(2):
        for v, row in enumerate(graph):
            own = best = labels[v]
            around = [labels[w] for w in row]
            for part in around:
                if part in (own, best) or sizes[part] >= room:
                    continue
                more = around.count(part) - around.count(best)
                if more > 0 or (more == 0 and sizes[part] + (best == own) < sizes[best]):
                    best = part
            if best != own and sizes[own] > 1:
                labels[v] = best
                sizes[own] -= 1
                sizes[best] += 1
    return labels


def chain_of(graph, labels, parts):  # M 5.1: the parts in the order of the blocks
    edges = [Counter() for _ in range(parts)]
    for v, row in enumerate(graph):
        edges[labels[v]].update(labels[w] for w in row if labels[v] != labels[w])
    chain, shared = [0], Counter()
    while len(chain) < parts:
        shared.update(edges[chain[-1]])
        beside = [part for part in sorted(edges[chain[-1]]) if part not in chain]
        ways = (
            part for last in reversed(chain) for part in sorted(edges[last]) if part not in chain
        )
        if beside:
            chain.append(max(beside, key=lambda part: shared[part]))  # the first of equals
        else:
            chain.append(next(ways, min(set(range(parts)) - set(chain))))
    return chain


def grow(graph, core, size):  # M 5.2
    found, seen = list(core), set(core)
    for v in found:  # `found` grows meanwhile
        for w in graph[v]:
            if w not in seen and len(found) < size and len(graph[w]) <= size:
                seen.add(w)
                found.append(w)
    return found


class Block:  # M 6: vertices in row order, and the Laplacian (M 7.1) of the block's own graph
    def __init__(self, graph, found):
        number = {v: r for r, v in enumerate(found)}
        local = [[number[w] for w in graph[v] if w in number] for v in found]
        order = bisect(local, len(found))[0]
        row = {old: new for new, old in enumerate(order)}
        self.vertices, self.graph = (
            [found[old] for old in order],
            [[row[w] for w in local[old]] for old in order],
        )
        self.size, self.degrees = len(found), np.array([len(r) for r in self.graph], float)
        self.laplacian = np.diag(self.degrees)
        for r, neighbors in enumerate(self.graph):
            self.laplacian[r, neighbors] = -1.0

    def connected(self):  # M 8.3
        return len(grow(self.graph, [0], self.size)) == self.size


class Known:  # M 7.2: weighted sums of all copies that are decoded
    def __init__(self, vertices):
        self.sums, self.weights = np.zeros((vertices, 3)), np.zeros(vertices)

    def add(self, block, positions):
        weights = np.maximum(block.degrees, 1.0)
        self.sums[block.vertices] += weights[:, None] * positions
        self.weights[block.vertices] += weights


def surroundings(graph, block, known):  # M 7.3: springs and pulls of each row
    springs, pulls, inside = np.zeros(block.size), np.zeros((block.size, 3)), set(block.vertices)
    for r, v in enumerate(block.vertices):
        for w, k in [(v, 8.0)] + [(w, 1.0) for w in graph[v] if w not in inside]:  # M 1.1
            if known.weights[w] > 0:
                springs[r] += k
                pulls[r] += k * (known.sums[w] / known.weights[w])
    return springs, pulls


# ---------------------------------------------------------------- M 7, M 8: extensions and dictionaries


def ordered_sum(terms):  # M 1.3: one term after the other
    return np.add.accumulate(terms, axis=0)[-1] if len(terms) else np.zeros(terms.shape[1:])


def product(left, right):  # M 1.3: sums of products, one term after the other
    result = np.zeros((len(left), right.shape[1]), np.result_type(left, right))
    for k in range(left.shape[1]):
        result += left[:, k, None] * right[k]
    return result


def dot(a, b):  # M 1.3: scalar products of rows
    return a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1] + a[..., 2] * b[..., 2]


class Solver:  # M 7.5 to M 7.7: (L + S + shift I)^-1 in single precision
    def __init__(self, laplacian, springs, shift=2.0**-7):  # M 1.1
        size, matrix, self.alone = len(laplacian), laplacian.copy(), []
        farthest = [max(np.flatnonzero(row), default=0) for row in laplacian]
        self.order = elimination_order(list(range(size)), 0, size, farthest)
        self.springs = springs
        matrix[range(size), range(size)] += springs + shift
        self.c, self.d = (
            matrix[np.ix_(self.order, self.order)].astype(np.float32),
            np.zeros(size, np.float32),
        )
        operations = 0
        for k in range(size):  # M 7.6
            own = self.c[k, k + 1 :].copy()
            operations += 2 * np.count_nonzero(own) ** 2  # products and differences
            require_limit(operations, 65536 * size, "operations of a factorization")  # M 14.4
            self.d[k] = np.float32(1) / self.c[k, k]
            self.c[k, k + 1 :] = own * self.d[k]
            self.c[k + 1 :, k + 1 :] -= self.c[k, k + 1 :, None] * own

    def solve(self, columns):  # M 7.7, of rows in the order of elimination
        x = columns.astype(np.float32)
        for k in range(len(x)):
            x[k + 1 :] -= self.c[k, k + 1 :, None] * x[k]
        x *= self.d[:, None]
        for k in reversed(range(len(x))):
            x[:k] -= self.c[:k, k, None] * x[k]
        return x

    def extend(self, springs, pulls):  # M 7.4
        total, result = ordered_sum(springs), np.zeros_like(pulls)
        if total == 0.0:
            return result
        mean = ordered_sum(pulls) / total
        result[self.order] = self.solve((pulls - springs[:, None] * mean)[self.order])
        return result + mean

    def iterate(self, start, solutions):  # M 8.4
        columns, result = start[self.order], np.zeros_like(start)
        for _ in range(solutions):
            columns = onorm(self.solve(columns), self.order, self.alone)
        result[self.order] = onorm(columns, self.order, self.alone)
        return result


def elimination_order(rows, first, last, farthest):
    """M 7.5: the rows of a segment, of those that are in no separator yet."""
    if last - first <= 8:
        return rows
    cut = (first + last) // 2
    low, high = [r for r in rows if r < cut and farthest[r] < cut], [r for r in rows if r >= cut]
    before = elimination_order(low, first, cut, farthest) + elimination_order(
        high, cut, last, farthest
    )
    return before + [r for r in rows if r < cut <= farthest[r]]


# M 8.1; `alone` gets the columns that are made orthonormal one by one.
def onorm(columns, order, alone):
    x, lengths = columns.copy(), ordered_sum(columns * columns)
    for begin in range(0, x.shape[1], 64):
        panel = x[:, begin : begin + 64]
        width = panel.shape[1]
        c, e, good = product(panel.T, panel), np.zeros(width, np.float32), width
        for j in range(width):
            for i in range(j):
                c[j, j:] -= c[i, j] * c[i, j:]
            if not np.float32(2.0**-14) * lengths[begin + j] < c[j, j] < np.inf:
                good = j
                break
            e[j] = np.float32(1) / np.sqrt(c[j, j])
            c[j, j:] *= e[j]
        t = np.zeros((good, good), np.float32)
        for j in reversed(range(good)):
            for i in range(j + 1, good):
                t[j] -= c[j, i] * e[j] * t[i]
            t[j, j] = e[j]
        panel[:, :good] = product(panel[:, :good], t)
        alone += range(good, width)
        for j in range(good, width):
            panel[:, j] = cleaned(x[:, : begin + j], panel[:, j], order)
        behind = x[:, begin + 64 :]
        shares = product(panel.T, behind)
        for i in range(width):
            behind -= panel[:, i, None] * shares[i]
    return x


def cleaned(before, column, order):  # M 8.8
    v, times = column.copy(), 0
    while times < 8:
        square = ordered_sum(v * v)
        if times == 4 or (times < 4 and not 0 < square < np.inf):
            times, v = (
                4,
                np.array([hash_entry(row, before.shape[1]) for row in order]).astype(np.float32),
            )
            square = ordered_sum(v * v)
        if not 0 < square < np.inf:
            break
        v *= np.float32(1) / np.sqrt(square)
        shares = product(before.T, v[:, None])
        for i in range(before.shape[1]):
            v -= before[:, i] * shares[i]
        square, times = ordered_sum(v * v), times + 1
        if square > 0.25:
            return v * (np.float32(1) / np.sqrt(square))
    raise NumericError("columns cannot be made orthonormal")


def cosine_columns(rows, first, last):  # M 8.2, before they are rounded
    k, unit = np.arange(rows + 1), 3.141592653589793 / (2 * rows)
    low, high = k * unit, (rows - k) * unit
    value, slope = np.ones(rows + 1), np.ones(rows + 1)
    for n in range(20, 0, -2):
        value = 1.0 - value * low * low / (n * (n - 1))
        slope = 1.0 - slope * high * high / (n * (n + 1))
    table = np.where(k <= rows // 2, value, slope * high)
    angle = (2 * np.arange(rows)[:, None] + 1) * np.arange(first, last)[None, :] % (4 * rows)
    fold = np.minimum(angle, 4 * rows - angle)
    return table[np.minimum(fold, 2 * rows - fold)] * np.where(fold <= rows, 1.0, -1.0)


def hash_entry(row, column):  # M 8.6
    z = ((row << 32) + column + 1) * 0x9E3779B97F4A7C15 % 2**64
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9 % 2**64
    z = (z ^ z >> 27) * 0x94D049BB133111EB % 2**64
    z ^= z >> 31
    return (z >> 11) * 2.0**-52 - 1.0


# ---------------------------------------------------------------- M 9: coefficients

EXPERIENCE_SHA256 = "2a093067f31fc03a6ec865ebc6193347d2b21ff18e6f4903e80cfc3af97c39d0"


class CoefficientModel:  # One for each chain
    def __init__(self, width):
        data = (Path(__file__).parent / "priors.bin").read_bytes()  # M 9.1
        assert hashlib.sha256(data).hexdigest() == EXPERIENCE_SHA256, (
            "priors.bin is not that of the law"
        )
        numbers = np.frombuffer(data, "<u2").astype(int)
        self.expectations, slots = numbers[:360].reshape(3, 6, 20).tolist(), numbers[588:].tolist()
        mixing = np.frombuffer(data, "<i2").astype(int)[360:588].reshape(76, 3).tolist()
        self.models = [Model(3, 400, 4) for _ in range(2)]  # M 9.2: the first block, and later ones
        self.models[1].slots = self.models[0].slots
        for number, p in enumerate(slots):
            slot = (1024 * (p >> 4) + 512, 4 * (p % 16))
            self.models[0].slots[number // (48 * 38), number // 38 % 48, number % 38] = slot
        for number, row in enumerate(mixing):
            for i, weight in enumerate(row):
                self.models[number // 38].weights[i, number % 38] = 16 * weight
        self.width, self.blocks = width, 0
        # M 9.3.
        self.now, self.before, self.usual = (
            [[0, 0, 0] for _ in range(width + 11)] for _ in range(3)
        )

    def block(self, decoder, count):  # `count` rows of points, in half steps
        points, last = [[0, 0, 0] for _ in range(count)], [0, 0, 0]
        for row in range(count):
            for d in range(3):
                level = self.level(decoder, row, d, last[2])
                points[row][d] = 2 * level - last[2] * ((level > 0) - (level < 0))  # M 9.11
                last = [*last[1:], (level + sum(last)) % 2]
                self.now[8 + row][d] = min(abs(level), 1 << 15)
            if decoder.overran():
                decoder.fail("levels are missing")
        for j in range(8, 8 + self.width):  # M 9.7
            for d in range(3):
                self.before[j][d] = self.now[j][d]
                self.usual[j][d] += (16 * self.now[j][d] - self.usual[j][d]) // min(
                    self.blocks + 1, 8
                )
                self.now[j][d] = 0
        self.blocks += 1
        return points

    def inputs(self, row, d):  # M 9.4
        n, b, u, j, e, f = self.now, self.before, self.usual, 8 + row, (d + 1) % 3, (d + 2) % 3
        return [
            *(16 * n[j - i][d] for i in (1, 2, 3)), 8 * (n[j - 4][d] + n[j - 5][d]),
            4 * (n[j - 6][d] + n[j - 7][d] + 2 * n[j - 8][d]),
            16 * n[j][d - 1] if d > 0 else 0, 16 * n[j][d - 2] if d > 1 else 0,
            8 * (n[j - 1][e] + n[j - 1][f]), 4 * (n[j - 2][e] + n[j - 2][f] + n[j - 3][e] + n[j - 3][f]),
            16 * b[j][d], 8 * (b[j - 1][d] + b[j + 1][d]),
            4 * (b[j - 2][d] + b[j + 2][d] + b[j - 3][d] + b[j + 3][d]),
            8 * (b[j][e] + b[j][f]), 4 * (b[j - 1][e] + b[j - 1][f] + b[j + 1][e] + b[j + 1][f]),
            u[j][d], (u[j - 1][d] + u[j + 1][d]) >> 1, (u[j][e] + u[j][f]) >> 1,
            16, 256 // (row + 1), 1024 // (row + 1) ** 2,
        ]  # fmt: skip

    def level(self, decoder, row, d, grid):
        inputs, contexts = self.inputs(row, d), []
        for i in range(3):  # M 9.5
            x = (
                sum(w * k for w, k in zip(self.expectations[i][d + 3 * (self.blocks == 0)], inputs))
                >> 10
            )
            g = x.bit_length() - 1
            contexts.append(min(3 * g + ((3 * (x - (1 << g))) >> g), 47) if x >= 1 else 0)

        def decide(node):
            return self.models[min(self.blocks, 1)].bit(decoder, contexts, node)

        g = 0  # M 9.6
        while g < 23 and decide(14 + g if grid == 1 and g < 2 else min(g, 13)):
            g += 1
        if g == 0:
            return 0
        result = 1
        if g > 1:
            b = decide(14 + min(g, 9))
            result = 2 | b
        if g > 2:
            result = 2 * result | decide(18 + 2 * min(g, 9) + b)
        if g > 3:
            result = (result << (g - 3)) + decoder.uniform(1 << (g - 3))
        return -result if decoder.bit(32768) else result


# ---------------------------------------------------------------- M 10, M 12, M 17: positions


class Chain:  # M 10.1: what blocks learn from those before them
    def __init__(self, header, graph):
        self.header, self.graph, self.model = (
            header,
            graph,
            CoefficientModel(header["coefficients"]),
        )
        self.known, self.dictionary, self.alone = Known(len(graph)), None, 0

    shift, power, iterations, key_iterations = 2.0**-7, 3, 1, 2  # M 1.1

    def decode(self, block, width, payload):  # M 10.2: positions of the next block
        coefficients, (springs, pulls) = self.coefficients(width, payload), self.around(block)
        solver = Solver(block.laplacian, springs, self.shift)
        self.dictionary = self.improved(block, solver, self.start(block, width))
        self.alone = len(solver.alone)
        positions = product(self.dictionary, coefficients) + solver.extend(springs, pulls)
        if not np.isfinite(positions).all():
            raise NumericError("positions are not finite")
        self.known.add(block, positions)
        return positions

    def coefficients(self, width, payload):
        decoder = RangeDecoder(payload)
        points = np.array(self.model.block(decoder, width)) * (self.header["step"] / 2)
        decoder.finish()
        return points

    def around(self, block):
        return surroundings(self.graph, block, self.known)

    def start(self, block, width):  # M 8.3
        start = cosine_columns(block.size, 0, width).astype(np.float32)
        if self.follows(block):
            start = np.hstack([self.dictionary, start[:, self.dictionary.shape[1] :]])[:, :width]
        if self.hashes(block):
            hashes = np.array([[hash_entry(r, j) for j in range(width)] for r in range(block.size)])
            start = start + ((2.0**-8 if self.follows(block) else 0.25) * hashes).astype(np.float32)
        return start

    def follows(self, block):  # M 8.3
        return self.dictionary is not None and len(self.dictionary) == block.size

    def hashes(self, block):  # M 8.3
        return not block.connected()

    def solutions(self, block):  # M 8.4: z and t
        return self.power, self.iterations if self.follows(block) else self.key_iterations

    def improved(self, block, solver, start):
        return solver.iterate(start, math.prod(self.solutions(block)))

    def onorms(self, block):  # M 14.3
        return math.prod(self.solutions(block)) + 1

    def charge(self, block, width):  # M 14.2, M 14.3: what the dictionary of the next block works
        n, rows, c = self.header["vertices"], block.size, -(-width // 16) * 16
        require_limit(8 * (6 * rows * c + 2 * c**2), 2**26 + 1024 * n, "memory")
        solution = 40 * rows * (0.3 * -(-width // 64) + 0.02 * c)
        norms = self.onorms(block) * rows * (3 + 0.4 * c + c**2 / 80)
        return 5 * rows * c + math.prod(self.solutions(block)) * solution + norms


def extension_paper():
    """Loaded only for streams that need it."""
    import reference_paper

    return reference_paper


def extension_base():
    """Loaded only for streams that need it, too."""
    import reference_base

    return reference_base


def decode_blocks(header, graph, blocks, partition):  # M 4 to M 12.1: positions in BSM units
    parts, work, blended = header["blocks"], 0.0, Known(len(graph))
    most = 8e8 + 3.2e4 * header["vertices"]  # M 14.9
    labels = (
        extension_paper().labels_of(partition, graph, parts)
        if partition
        else derive_labels(graph, parts)
    )
    cores = [[v for v, label in enumerate(labels) if label == part] for part in range(parts)]
    require(max(map(len, cores)) <= header["block_size"], "a part is larger than a block")  # M 5.2
    kind = (
        Chain
        if header["paper"] == FIELDS["paper"][4] and not header["onorm"]
        else extension_paper().Chain
    )
    for part, (index, width, payload) in zip(chain_of(graph, labels, parts), blocks):
        if index % (header["key_interval"] or parts) == 0:  # M 10.1
            chain = kind(header, graph)
        block = Block(graph, grow(graph, cores[part], header["block_size"]))
        require(1 <= width <= block.size, "a wrong number of coefficients")  # M 9.9
        own = chain.charge(block, width)
        require_limit(work := work + own, most, "work")
        blended.add(block, chain.decode(block, width, payload))
        if chain.alone:  # M 14.3
            work += own + 6 * block.size * width * 4 ** max(2, math.ceil(math.log(chain.alone, 4)))
            require_limit(work, most, "work")
    return blended.sums / blended.weights[:, None]


def smooth(graph, positions, amount):  # M 12.2
    if amount == 0.0:
        return positions
    current, result = positions, positions
    for k, power in enumerate([0.0, *smoothing_powers(amount)]):
        around = [
            ordered_sum(current[row]) * (1.0 / len(row)) if row else own
            for row, own in zip(graph, current)
        ]
        current = current - around
        result = result + power * current if k else result
    return result


def smoothing_powers(amount):  # M 12.3: p_2 to p_5
    nodes = [0.4, 0.9, 1.4, 1.8]
    table, powers = [-amount / (1.0 + amount * x * x) for x in nodes], [0.0] * 4
    for level in range(1, 4):
        for i in range(3, level - 1, -1):
            table[i] = (table[i] - table[i - 1]) / (nodes[i] - nodes[i - level])
    for node, value in zip(reversed(nodes), reversed(table)):
        powers = [before - node * own for before, own in zip([value, *powers], powers)]
    return powers


# M 17: base positions and what the layer adds to them.
def refine(step, ratio, faces, positions, refinements):
    count, coded = len(positions), 0
    sums = np.zeros((count, 3))
    for a, b, c in faces:  # M 17.1
        normal = np.cross(positions[b] - positions[a], positions[c] - positions[a])
        for v in (a, b, c):
            sums[v] += normal
    pole, axes = np.array([0.48, 0.6, 0.64]), np.array([[-0.8, 0.0, 0.6], [0.36, -0.8, 0.48]])
    tilted = sums + (math.sqrt(ordered_sum(dot(sums, sums)) / count) * 2.0**-10 + 2.0**-33) * pole
    normals = tilted / np.sqrt(dot(tilted, tilted) + 2.0**-200)[:, None]  # M 17.2
    along = np.maximum(1.0 + dot(pole, normals), 2.0**-20)
    reader = LevelsReader(faces, count)
    for _, size, payload in refinements:
        reader.read(payload, size)
        coded += size
    levels = np.array(reader.x, float).reshape(count, 3)
    refined = raised = positions + (step * levels[:, 0])[:, None] * normals  # M 17.3
    if coded == count:  # M 17.5
        wide = step * tangent_ratios(faces, raised, ratio)
        for j, axis in enumerate(axes):
            tangent = axis - (dot(axis, normals) / along)[:, None] * (pole + normals)
            refined = refined + (wide * levels[:, 1 + j])[:, None] * tangent
    return refined


def tangent_ratios(faces, places, ratio):  # M 17.4: t of each vertex
    if ratio <= 1:
        return np.full(len(places), ratio)
    sums, rims = np.zeros((len(places), 3)), np.zeros((len(places), 3))
    areas, lengths, bends, corners = (np.zeros(len(places)) for _ in range(4))
    for a, b, c in faces:
        normal = np.cross(places[b] - places[a], places[c] - places[a])
        for v, start, end in ((a, b, c), (b, c, a), (c, a, b)):
            rim = places[end] - places[start]
            sums[v] += normal
            areas[v] += math.sqrt(dot(normal, normal))
            rims[v] += rim
            lengths[v] += math.sqrt(dot(rim, rim))
    open_ = np.sqrt(dot(rims, rims)) / (lengths + 2.0**-200)
    own = 1.0 - np.sqrt(dot(sums, sums)) / (areas + 2.0**-200) + open_
    for a, b, c in faces:
        for v in (a, b, c):
            bends[v] += own[v] + (own[a] + own[b] + own[c])
            corners[v] += 4.0
    bends = np.divide(bends, corners, out=np.ones(len(places)), where=corners > 0)
    return np.maximum(1, ratio * np.sqrt(np.sqrt(2.0**-12 / (2.0**-12 + bends))))


def decode_packets(packets, fault):
    """Positions in the unit of the mesh, and faces. What comes before a fault is judged before it (F 3.15)."""
    if CONNECTIVITY not in packets:
        raise fault
    header, vertices = packets[HEADER][0], packets[HEADER][0]["vertices"]
    counts = vertices, header["faces"], LIMITS["vertices"], header["repeats"]
    faces = decode_connectivity(packets[CONNECTIVITY][0], *counts)
    if header["grid"]:
        reader = GridReader(faces, vertices, header["grid"])
        for _, count, payload in packets[GRID]:
            reader.read(payload, count)
        positions = np.array([place(values, header) for values in reader.x])
    elif packets[BLOCK] or not fault:
        graph = ground = neighbors_of(faces, vertices)
        if header["base"]:
            cells = extension_base().Cells(graph, faces, header["base"])
            ground = cells.graph
        positions = decode_blocks(header, ground, packets[BLOCK], *packets.get(PARTITION, [None]))
        if fault and not packets[REFINEMENT]:
            raise fault
        positions, layer = smooth(ground, positions, header["smoothing"]), packets[REFINEMENT]
        if header["base"]:  # M 18.6, M 18.7
            of_cells = [levels for levels in layer if levels[0] < len(ground)]
            positions, layer = (
                refine(0.5**cells.halvings, 3, cells.faces, positions, of_cells),
                layer[len(of_cells) :],
            )
            positions = cells.prolonged(positions)
        if header["refinement"]:
            positions = refine(*header["refinement"], faces, positions, layer)
        positions = positions * header["scale"] + np.array(header["center"])  # M 12.5
    if fault:
        raise fault
    if not np.isfinite(positions).all():
        raise NumericError("positions are not finite")
    (checksum,) = packets[END]
    require(
        not checksum
        or int.from_bytes(checksum, "little") == zlib.crc32((positions + 0.0).astype("<f8")),
        "F 5.10",
    )
    return positions, np.array(faces, np.int32).reshape(-1, 3)


def decode(stream):
    """Positions, shape (n, 3), faces, shape (m, 3), and the names of the extensions that were skipped."""
    packets, fault = {BLOCK: [], GRID: [], REFINEMENT: []}, None
    try:
        read_frames(stream, packets)
    except tuple(EXIT_CODES) as found:
        fault = found
    with np.errstate(all="ignore"):  # what is not finite is looked for afterwards
        decoded = decode_packets(packets, fault)
    return *decoded, {SKIPPED[kind] for kind in SKIPPED if kind in packets}


def main():
    try:
        positions, faces, _ = decode(Path(sys.argv[1]).read_bytes())
    except tuple(EXIT_CODES) as error:
        print(f"{type(error).__name__}: {error}", file=sys.stderr)
        return EXIT_CODES[type(error)]
    np.savez_compressed(sys.argv[2], positions=positions, faces=faces)
    return 0


if __name__ == "__main__":
    sys.exit(main())
