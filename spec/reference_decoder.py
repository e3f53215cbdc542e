"""A decoder of BSM streams, written from the documents of this folder alone: slow, plain, easy to compare with them.

The rules that it follows are named as they are numbered (README.md); C is in reference_connectivity.py, too, V in
reference_fields.py, D in reference_attributes.py, A in reference_values.py. numpy is used for linear algebra alone, and
nothing is shared with the product.

    python spec/reference_decoder.py IN.bsm OUT.npz

writes `positions` (float64, shape (n, 3)), `faces` (int32, shape (m, 3)), and the arrays of attributes that
spec/vectors/README.md tells of. Exit codes are those of that file, too.
"""

import binascii
import hashlib
import math
import struct
import sys
import zlib
from itertools import pairwise
from pathlib import Path

import msgpack
import numpy as np
import zstandard
from reference_attributes import FIELDS as ATTRIBUTE_FIELDS
from reference_attributes import (
    KINDS,
    MOST_VALUES,
    RANGES,
    SEMANTICS,
    Attribute,
    Declaration,
    check_declarations,
    read_seams,
)
from reference_connectivity import (
    CorruptError,
    LimitError,
    Model,
    RangeDecoder,
    TruncatedError,
    arrange,
    decode_connectivity,
    decode_labels,
    neighbours_of,
    read_rotations,
    read_unsigned,
)
from reference_fields import ExactReader, GridReader, LevelsReader, LightReader, place
from reference_fields import Mesh as Corners


class FormatError(Exception):
    """Not a BSM stream."""


class UnsupportedError(Exception):
    """Of a version or method that is not in the documents."""


class NumericError(Exception):
    """The mathematics broke down."""


EXIT_CODES = {FormatError: 3, CorruptError: 4, TruncatedError: 12, UnsupportedError: 5, LimitError: 6, NumericError: 7}

MOST_VERTICES, MOST_FACES = 1 << 24, 1 << 25  # M 14
MOST_BLOCKS, MOST_ROWS, MOST_COLUMNS = 1 << 17, 8192, 4096
MOST_FRAMES, MOST_GOP_FRAMES = 1 << 20, 1024
MOST_FRAME_BYTES, MOST_METADATA_BYTES = 1 << 28, 1 << 23
MOST_WORK, MOST_MEMORY, MOST_ATTRIBUTES = 8e8, 2**26, 255


def require(condition, problem):
    """Every violation is *corrupt* unless a rule says otherwise."""
    if not condition:
        raise CorruptError(problem)


def require_limit(value, most, what):
    if value > most:
        raise LimitError(f"{what} = {value} is over {most}")


# ---------------------------------------------------------------- F 1: varints, checksums, maps


def varint(data, start):
    """F 1.2: value and offset behind it, None if the data ends inside."""
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


def payload_varint(data, start):
    found = varint(data, start)
    require(found is not None, "payload ends inside a varint")
    return found


def canonical_map(payload):
    """F 1.5: one map has one encoding, so decode, check the types, encode again and compare."""
    try:
        pairs = msgpack.unpackb(payload, raw=False, strict_map_key=False, object_pairs_hook=tuple)
    except Exception as error:  # msgpack raises many kinds
        raise CorruptError(f"not a msgpack map: {error}") from None
    require(type(pairs) is tuple and len(pairs) <= 256, "not a map of at most 256 entries")
    require(sum(len(value) for _, value in pairs if type(value) is list) <= 256, "arrays of more than 256 entries")
    kinds = {type(key) for key, _ in pairs}
    require(len(kinds) <= 1 and kinds <= {int, str}, "keys must be all integers or all strings")
    keys = [key.encode() if type(key) is str else key for key, _ in pairs]
    require(keys == sorted(set(keys)), "keys must ascend")
    require(all(key >= 0 for key in keys if type(key) is int), "an integer key is negative")
    packed = msgpack.Packer().pack_map_header(len(pairs))
    for key, value in pairs:
        packed += msgpack.packb(key) + packed_value(value, nested=False)
    require(packed == payload, "map is not in its shortest form")
    return pairs


def packed_value(value, nested):
    if type(value) is list and not nested:
        return msgpack.Packer().pack_array_header(len(value)) + b"".join(packed_value(v, True) for v in value)
    require(type(value) in (int, float, str, bytes), "a map may not hold a value of this type")
    if type(value) is float:
        require(math.isfinite(value), "a number is not finite")
        try:
            single = struct.pack(">f", value)
        except OverflowError:
            single = b""
        if single and struct.unpack(">f", single)[0] == value:
            return b"\xca" + single
        return b"\xcb" + struct.pack(">d", value)
    return msgpack.packb(value)


# ---------------------------------------------------------------- F 2, F 3: stream and frames

HEADER, METADATA, CONNECTIVITY, PARTITION, ORDER, BLOCK, GOP, GRID, REFINEMENT, END = 1, 2, 3, 4, 5, 6, 7, 12, 13, 15
ATTRIBUTE, VALUES = 14, 0
KNOWN = (HEADER, CONNECTIVITY, PARTITION, ORDER, ATTRIBUTE, BLOCK, GOP, GRID, REFINEMENT, VALUES)


def frames_of(stream):
    """F 2 and F 3: yields (type, payload, offset of the tag) of every frame; skippable ones too."""
    magic = b"\x89BSM"
    if not magic.startswith(stream[:4]):
        raise FormatError("not a BSM stream")  # F 2.1
    if len(stream) >= 5 and stream[4] != 0:
        raise UnsupportedError("another version")  # F 2.2
    offset, number = 5, 0
    while True:
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
        require(crc == int.from_bytes(stream[end : end + size], "little"), "checksum of a frame is wrong")  # F 3.3
        yield kind, stream[start:end], offset, number
        offset, number = end + size, number + 1
        if kind == END:
            require(offset == len(stream), "bytes behind END")  # F 2.3
            return


# name: (key, type, low, high, default); a method is an int whose legal range may grow to 255 (F 4.5)
COUNT = 2**31 - 1
FIELDS = {
    "vertices": (1, int, 1, COUNT, None),
    "faces": (2, int, 1, COUNT, None),
    "blocks": (3, int, 0, COUNT, 0),
    "block_size": (4, int, 0, COUNT, 0),
    "coefficients": (5, int, 0, COUNT, 0),
    "key_interval": (6, int, 0, COUNT, 0),
    "step": (7, float, 2.0**-40, 2.0**20, 2.0**-8),
    "center": (8, (3, 3), -1e300, 1e300, [0.0, 0.0, 0.0]),
    "scale": (9, float, 1e-300, 1e300, 1.0),
    "smoothing": (10, float, 0.0, 1e6, 0.0),
    "refinement": (11, (0, 2), 0.0, 64.0, []),  # a tuple: of floats
    "attributes": (12, int, 0, 255, 0),
    "grid": (13, [0, 3], 0, 2**20 - 1, []),  # a list: of ints
    "lattice": (14, [0, 2], 1, COUNT, []),
    "corner": (15, [0, 3], -(2**31), COUNT, []),
    "light": (16, "method", 0, 2, 0),
    "sequence": (17, [0, 2], 0, COUNT, []),
    "run": (18, [0, 2], 0, COUNT, []),
    "paper": (19, (0, 8), 0.0, 2.0**30, []),
}
PAPER = {  # F 4: name: (low, high, what holds where there is no `paper`); of a sequence S 1.1
    "bits": (0, 32, 0),
    "coarser": (0, 30, 0),
    "exact": (0, 1, 0),
    "power": (1, 64, 3),
    "iterations": (1, 1024, 1),
    "key_iterations": (1, 1024, 2),
    "shift": (2.0**-30, 2.0**30, 2.0**-7),
    "springs": (0, 1, 1),
}
OF_SEQUENCES = {"iterations": 2, "shift": 2.0**-5}
STIFFNESS = 8.0  # M 7.3


def parse_fields(payload, fields):
    """F 4.1 to F 4.5."""
    names = {field[0]: name for name, field in fields.items()}
    record, entries = {}, canonical_map(payload)
    for key, value in entries:  # F 4.8: what is unsupported comes first
        require(type(key) is int, "a key is not an integer")
        method = key in names and fields[names[key]][1] == "method"
        if key not in names or (method and type(value) is int and fields[names[key]][3] < value <= 255):
            raise UnsupportedError(f"key {key} = {value}")
    for key, value in entries:
        name = names[key]
        _, kind, low, high, default = fields[name]
        if type(kind) in (tuple, list):  # F 4.4
            item = float if type(kind) is tuple else int
            require(type(value) is list and all(type(v) is item for v in value), f"{name} has a wrong type")
            require(kind[0] <= len(value) <= kind[1], f"{name} has a wrong length")
            items = value
        elif kind is str:
            require(type(value) is kind, f"{name} has a wrong type")
            items = [len(value.encode())]
        else:
            require(type(value) is (float if kind is float else int), f"{name} has a wrong type")
            items = [value]
        require(value != default, f"{name} is stored although it has its default")  # F 4.3
        require(all(low <= v <= high for v in items), f"{name} is outside its legal range")  # F 4.5
        record[name] = value
    for name, field in fields.items():
        require(name in record or field[4] is not None, f"{name} is missing")
        record.setdefault(name, field[4])
    return record


def parse_header(payload):
    """F 4."""
    require(len(payload) <= 65536, "a header of too many bytes")  # F 4.9
    header = h = parse_fields(payload, FIELDS)
    unfold(h)
    require(h["vertices"] <= 3 * h["faces"], "more vertices than corners")  # F 4.6
    others = {name for name in FIELDS if h[name] != FIELDS[name][4]}
    if h["grid"]:
        allowed = {"vertices", "faces", "center", "scale", "grid", "lattice", "attributes", "corner", "light"}
        require(others <= allowed, "a grid, and something else")
        require(len(h["grid"]) == 3, "a grid of other than three axes")
        require(len(h["lattice"]) in (0, 2), "a lattice is not two numbers")
        require(h["light"] < 2 or not (h["lattice"] or h["corner"]), "floats on a lattice, or with a corner")
        require(len(h["corner"]) in (0, 3), "a corner is not three numbers")
        require(not h["corner"] or h["center"] == [0, 0, 0], "a corner and a center")
        require(not h["lattice"] or max(h["grid"]) <= h["lattice"][1] <= h["lattice"][0], "a lattice that is none")
    elif h["again"] is not None:
        require(others <= {"vertices", "faces", "sequence", "run"}, "a mesh again, and another")
    else:
        require(not h["lattice"] and not h["corner"], "a lattice or a corner without a grid")
        require(not h["light"], "light values without a grid")
        require(h["blocks"] and h["block_size"] and h["coefficients"], "no blocks, and no grid")
        require(h["blocks"] * h["block_size"] >= h["vertices"], "blocks too small")
    require(h["blocks"] <= h["vertices"], "more blocks than vertices")
    require(h["block_size"] <= h["vertices"], "blocks larger than the mesh")
    require(h["blocks"] * h["block_size"] <= 16 * h["vertices"] + 65536, "blocks overlap too much")
    require(h["coefficients"] <= h["block_size"], "more coefficients than rows")
    if h["refinement"]:
        require(len(h["refinement"]) == 2, "a refinement is not two numbers")
        require(2.0**-40 <= h["refinement"][0] <= 1, "the step of a refinement is out of range")
        require(h["refinement"][1] >= 1 / 16, "the ratio of a refinement is out of range")
        require(not h["sequence"], "a refinement of a sequence")
    for name, most in (  # F 4.7
        ("vertices", MOST_VERTICES),
        ("faces", MOST_FACES),
        ("blocks", MOST_BLOCKS),
        ("block_size", MOST_ROWS),
        ("coefficients", MOST_COLUMNS),
        ("frames", MOST_FRAMES),
        ("gop_frames", MOST_GOP_FRAMES),
        ("attributes", MOST_ATTRIBUTES),
    ):
        require_limit(h[name], most, name)
    return header


def unfold(h):
    """F 4.6: what the lists of a header say, by name."""
    require(len(h["sequence"]) in (0, 2), "a sequence is not two numbers")
    h["frames"], h["gop_frames"] = h["sequence"] or (0, 0)
    require(not h["sequence"] or h["gop_frames"] > 0, "GOPs of no frames")
    require(h["sequence"] or not h["run"], "a run of a static mesh")
    h["number"], h["again"] = ([*h["run"], None] if len(h["run"]) < 2 else h["run"]) if h["run"] else (0, None)
    require(h["run"] != [0], "run 0 is stored")
    require(h["again"] is None or h["again"] < h["number"], "the mesh of a run that has not been")
    require(len(h["paper"]) in (0, 8), "paper is not eight numbers")
    law = {name: default for name, (_, _, default) in PAPER.items()} | (OF_SEQUENCES if h["sequence"] else {})
    for (name, (low, high, _)), value in zip(PAPER.items(), h["paper"] or law.values()):
        require(low <= value <= high and (name == "shift" or value == int(value)), f"{name} is out of range")
        h[name] = value if name == "shift" else int(value)
    require(not h["paper"] or any(h[name] != law[name] for name in law), "paper is stored although it is the law's")


class Packets(dict):
    """Payloads by the type of their frames, up to the end of the stream or its first fault, which is kept (F 3.15)."""

    fault = None

    def require(self, condition, problem):
        """What is missing is missing because of the fault, if there is one."""
        if self.fault and not condition:
            raise self.fault
        require(condition, problem)


def parse_stream(stream):
    """F 3.7 to F 3.10 and F 5: for each run (S 9) the payloads of each type; a static mesh is one run."""
    runs = [Packets({kind: [] for kind in KNOWN})]
    try:
        read_frames(stream, runs)
    except tuple(EXIT_CODES) as fault:
        runs[-1].fault = fault
    runs[0].require(runs[0][HEADER], "there is no HEADER")
    return runs


def check_values(packets, header):
    """F 3.14."""
    for index in range(header["attributes"]):
        require(rows_read(packets, index) == packets[ATTRIBUTE][index].rows, "values are missing")


def read_frames(stream, runs):
    """Checks frame after frame, and puts what they hold into the last of `runs`."""
    packets = runs[-1]
    header, last, told, told_bytes = None, None, set(), 0
    order = {HEADER: 0, CONNECTIVITY: 1, PARTITION: 2, ORDER: 3, BLOCK: 4, GOP: 5, GRID: 5, REFINEMENT: 5, END: 6}
    order |= {ATTRIBUTE: 3.5, VALUES: 5.5}
    for kind, payload, offset, number in frames_of(stream):
        if header is None and kind == ATTRIBUTE:
            declaration_of(payload)  # F 3.15
        if header is None:
            require(kind == HEADER, "the first frame must be HEADER")  # F 3.7
        if 8 <= kind <= 11:
            continue  # F 3.5
        if header and ((kind == GRID and not header["grid"]) or (kind == REFINEMENT and not header["refinement"])):
            raise UnsupportedError(f"frame type {kind}")  # F 3.6
        if header and kind in (ATTRIBUTE, VALUES) and not header["attributes"]:
            raise UnsupportedError(f"frame type {kind}")  # F 3.6
        if kind == METADATA:
            require_limit(len(payload), MOST_METADATA_BYTES, "metadata")
            entries = canonical_map(payload)  # F 5.1
            require(all(type(k) is str and type(v) is not list for k, v in entries), "metadata of a wrong type")
            names, told_bytes = {k for k, _ in entries}, told_bytes + len(payload)
            require(not names & told, "METADATA speaks of a name again")  # F 3.9
            require_limit(told_bytes, MOST_METADATA_BYTES, "metadata")
            told |= names
            continue
        if kind == HEADER:
            parsed = parse_header(payload)
        elif kind in (CONNECTIVITY, PARTITION, ORDER):
            parsed = payload
        elif kind == BLOCK:
            index, at = payload_varint(payload, 0)
            width, at = payload_varint(payload, at)
            parsed = (index, width, payload[at:])
        elif kind == GOP:
            index, at = payload_varint(payload, 0)
            parsed = (index, payload[at:])
        elif kind in (GRID, REFINEMENT):  # F 5.6, F 5.7
            first, at = payload_varint(payload, 0)
            count, at = payload_varint(payload, at)
            parsed = (first, count, payload[at:])
            following = sum(packet[1] for packet in packets[kind])
            require(first == following and 0 < count <= header["vertices"] - first, "wrong vertices")  # F 3.11, F 3.12
        elif kind == ATTRIBUTE:
            parsed = parse_attribute(payload, packets, header)
        elif kind == VALUES:
            parsed = parse_values(payload, packets)
        else:
            count, at = payload_varint(payload, 0)
            require(len(payload) == at + 4, "END has a wrong length")
        place = order[kind]
        # F 3.8: ascending, CONNECTIVITY is required, and only what comes behind ORDER repeats.
        several = (ATTRIBUTE, BLOCK, GOP, GRID, REFINEMENT, VALUES)
        if header and kind == HEADER:  # S 9
            require(packets[GOP], "a HEADER may not come here")
            require(parsed["gop_frames"] > 0, "a static mesh behind a sequence")
            require(parsed["number"] == header["number"] + 1, "runs are numbered in their order")
            require(parsed["frames"] == header["frames"], "another number of frames")
            check_values(packets, header)
            packets = Packets({kind: [] for kind in KNOWN})
            runs.append(packets)
            last = None
        elif kind == HEADER:
            require(parsed["number"] == 0, "the stream begins within a sequence")
        if header and header["again"] is not None and not packets[GOP] and kind != HEADER:
            require(kind == GOP, "a run that has a mesh again is GOPs")
        legal = kind == HEADER if last is None else place > last or (place == last and kind in several)
        require(last != 5 or kind in (END, VALUES) or packets.get(kind), f"frame type {kind} may not come here")
        if header and header["grid"]:
            require(
                kind in (CONNECTIVITY, ORDER, ATTRIBUTE, GRID, VALUES, END), f"frame type {kind} where there is a grid"
            )
        require(legal and (place <= 1 or last >= 1), f"frame type {kind} may not come here")
        if kind in (BLOCK, GOP):
            before = packets[kind] or (runs[-2][GOP] if kind == GOP and len(runs) > 1 else [])
            require(not before or parsed[0] > before[-1][0], "indices must ascend")  # F 3.10
        if kind == BLOCK:
            require(parsed[0] < header["blocks"], "block index too large")  # F 5.3
            require(parsed[1] <= header["coefficients"], "too many coefficients")
        if kind == GOP:
            require(header["gop_frames"] > 0, "a GOP in a static stream")  # F 5.4
            require(header["frames"] == 0 or parsed[0] < header["frames"], "GOP index too large")
        last = order[BLOCK] if kind == HEADER and parsed["again"] is not None else place
        if header and kind in (BLOCK, GOP, GRID, VALUES, END):
            require(len(packets[ATTRIBUTE]) == header["attributes"], "attributes are missing")  # F 3.13
        if kind == HEADER:
            header = parsed
            order[VALUES] = 4.5 if header["gop_frames"] else 5.5  # F 3.14
            packets[HEADER].append(header)
        elif kind == END:  # F 5.5
            covered = sum(packet[1] for packet in packets[GRID])
            require(not header["grid"] or covered == header["vertices"], "positions are missing")  # F 3.11
            check_values(packets, header)
            require(count == number, "END counts other frames")
            require(int.from_bytes(payload[at:], "little") == zlib.crc32(stream[:offset]), "CRC of the stream is wrong")
        else:
            packets[kind].append(parsed)


def declaration_of(payload):
    index, at = payload_varint(payload, 0)
    size, at = payload_varint(payload, at)
    require(size <= len(payload) - at, "a declaration ends too early")
    require(size <= 65536, "a declaration of too many bytes")
    return index, Declaration(parse_fields(payload[at : at + size], ATTRIBUTE_FIELDS), payload[at + size :])


def parse_attribute(payload, packets, header):
    """F 5.8."""
    index, one = declaration_of(payload)
    every = [*packets[ATTRIBUTE], one]
    numbers = sum((x.rows if x.coding != 3 else 3 * header["faces"]) * max(x.words, x.components) for x in every)
    require_limit(numbers, MOST_VALUES, "values of attributes")
    require(index == len(packets[ATTRIBUTE]) and index < header["attributes"], "a wrong attribute")  # F 3.13
    check_declarations(every, header)
    return one


def parse_values(payload, packets):
    """F 5.9, F 3.14."""
    attribute, at = payload_varint(payload, 0)
    first, at = payload_varint(payload, at)
    count, at = payload_varint(payload, at)
    declared = packets[ATTRIBUTE]
    require(attribute < len(declared), "values of no attribute")
    require(first == rows_read(packets, attribute), "values do not follow")
    require(0 < count <= declared[attribute].rows - first, "a wrong number of values")
    for before in range(attribute):
        require(rows_read(packets, before) == declared[before].rows, "values are missing")
    require(not packets[VALUES] or packets[VALUES][-1][0] <= attribute, "attributes must ascend")
    return attribute, count, payload[at:]


def rows_read(packets, attribute):
    return sum(count for index, count, _ in packets[VALUES] if index == attribute)


# ---------------------------------------------------------------- M 3 to M 6: blocks

LEAF = 8


def sweep(graph, segment, start):
    """M 3.3: distance of every vertex of the segment from `start`, and the order in which they were found."""
    inside, distance, found = set(segment), {start: 0}, [start]
    level, frontier = 0, [start]
    while len(found) < len(segment) or frontier:
        level, behind, frontier = level + 1, frontier, []
        for v in behind:
            for w in graph[v]:
                if w in inside and w not in distance:
                    distance[w] = level
                    frontier.append(w)
                    found.append(w)
        if not frontier and len(found) < len(segment):
            rest = next(v for v in reversed(segment) if v not in distance)
            distance[rest] = level
            frontier.append(rest)
            found.append(rest)
    return distance, found


def bisect(graph, parts):
    """M 3: the vertices part after part, and where each part begins."""
    order, ends = list(range(len(graph))), [len(graph)] * (parts + 1)
    distances = [{}, {}]
    if len(order) > LEAF:  # M 3.2
        last = sweep(graph, order, 0)[1][-1]
        distances[0] = sweep(graph, order, last)[0]
    pending = [(0, len(order), 0, parts, 0)]
    while pending:
        first, last, part, count, kept = pending.pop()
        ends[part] = first
        if count == 1:
            continue
        segment = order[first:last]
        if len(segment) > LEAF:  # M 3.4
            near = distances[kept]
            far = next(v for v in segment if near[v] == max(near[w] for w in segment))
            distance, found = sweep(graph, segment, far)
            distances[1 - kept].update(distance)
            found.sort(key=lambda v: distances[0][v] - distances[1][v])
            order[first:last] = found
        half = count // 2
        cut = first + (last - first) * half // count
        pending.append((cut, last, part + half, count - half, 1))
        pending.append((first, cut, part, half, 0))
    return order, ends


def derive_labels(graph, parts):
    """M 4."""
    order, ends = bisect(graph, parts)
    labels = [0] * len(graph)
    for part in range(parts):
        for v in order[ends[part] : ends[part + 1]]:
            labels[v] = part
    sizes = [labels.count(part) for part in range(parts)]
    room = len(graph) * 103 // (parts * 100) + 1
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


def chain_of(graph, labels, parts):
    """M 5.1: the parts in the order of the blocks."""
    edges = [{} for _ in range(parts)]
    for v, row in enumerate(graph):
        for w in row:
            if labels[v] != labels[w]:
                edges[labels[v]][labels[w]] = edges[labels[v]].get(labels[w], 0) + 1
    chain, shared = [0], [0] * parts
    while len(chain) < parts:
        beside = edges[chain[-1]]
        for part, count in beside.items():
            shared[part] += count
        unvisited = [part for part in sorted(beside) if part not in chain]
        if unvisited:
            chain.append(max(unvisited, key=lambda part: shared[part]))  # the first of equals
            continue
        ways = (part for last in reversed(chain) for part in sorted(edges[last]) if part not in chain)
        chain.append(next(ways, min(set(range(parts)) - set(chain))))
    return chain


def grow(graph, core, size):
    """M 5.2."""
    found, seen = list(core), set(core)
    for v in found:  # `found` grows meanwhile
        for w in graph[v]:
            if w not in seen and len(found) < size and len(graph[w]) <= size:
                seen.add(w)
                found.append(w)
    return found


class Block:
    """M 6: vertices in row order, and the block's own graph in row numbers."""

    def __init__(self, graph, found):
        place = {v: r for r, v in enumerate(found)}
        local = [[place[w] for w in graph[v] if w in place] for v in found]
        order = bisect(local, len(found))[0]
        row = {old: new for new, old in enumerate(order)}
        self.vertices = [found[old] for old in order]
        self.graph = [[row[w] for w in local[old]] for old in order]
        self.degrees = np.array([len(r) for r in self.graph], float)
        self.size = len(found)
        self.laplacian = np.diag(self.degrees)  # M 7.1
        for r, neighbours in enumerate(self.graph):
            self.laplacian[r, neighbours] = -1.0


# ---------------------------------------------------------------- M 7, M 8: springs and dictionaries


class Known:
    """M 7.2: weighted sums of all copies that a chain has decoded."""

    def __init__(self, vertices):
        self.sums, self.weights = np.zeros((vertices, 3)), np.zeros(vertices)

    def add(self, block, positions, weights):
        self.sums[block.vertices] += weights[:, None] * positions
        self.weights[block.vertices] += weights


def surroundings(graph, block, known):
    """M 7.3: springs and pulls of each row."""
    springs, pulls, inside = np.zeros(block.size), np.zeros((block.size, 3)), set(block.vertices)
    for r, v in enumerate(block.vertices):
        hooks = [(v, STIFFNESS)] + [(w, 1.0) for w in graph[v] if w not in inside]
        for w, k in hooks:
            if known.weights[w] > 0:
                springs[r] += k
                pulls[r] += k * (known.sums[w] / known.weights[w])
    return springs, pulls


def ordered_sum(terms):
    """M 1.3: one term after the other."""
    return np.add.accumulate(terms, axis=0)[-1] if len(terms) else np.zeros(terms.shape[1:])


def product(left, right):
    """M 1.3: sums of products, one term after the other."""
    result = np.zeros((len(left), right.shape[1]), np.result_type(left, right))
    for k in range(left.shape[1]):
        result += left[:, k, None] * right[k]
    return result


class Solver:
    """M 7.5 to M 7.7: (L + S + shift I)^-1 in single precision."""

    def __init__(self, laplacian, springs, shift):
        size = len(laplacian)
        farthest = [max(np.flatnonzero(row), default=0) for row in laplacian]
        self.order = elimination_order(list(range(size)), 0, size, farthest)
        matrix = laplacian.copy()
        matrix[range(size), range(size)] += springs + shift
        self.c, self.d = matrix[np.ix_(self.order, self.order)].astype(np.float32), np.zeros(size, np.float32)
        for k in range(size):
            own = self.c[k, k + 1 :].copy()
            self.d[k] = np.float32(1) / self.c[k, k]
            self.c[k, k + 1 :] = own * self.d[k]
            self.c[k + 1 :, k + 1 :] -= self.c[k, k + 1 :, None] * own

    def solve(self, columns):
        """M 7.7, of rows in the order of elimination."""
        x = columns.astype(np.float32)
        for k in range(len(x)):
            x[k + 1 :] -= self.c[k, k + 1 :, None] * x[k]
        x *= self.d[:, None]
        for k in reversed(range(len(x))):
            x[:k] -= self.c[:k, k, None] * x[k]
        return x

    def extend(self, springs, pulls):
        """M 7.4."""
        total = ordered_sum(springs)
        if total == 0.0:
            return np.zeros_like(pulls)
        mean, result = ordered_sum(pulls) / total, np.zeros_like(pulls)
        result[self.order] = self.solve((pulls - springs[:, None] * mean)[self.order])
        return result + mean

    def iterate(self, start, solutions):
        """M 8.4."""
        columns = start[self.order]
        for _ in range(solutions):
            columns = onorm(self.solve(columns), self.order)
        result = np.zeros_like(start)
        result[self.order] = onorm(columns, self.order)
        return result


def elimination_order(rows, first, last, farthest):
    """M 7.5: the rows of a segment, of those that are in no separator yet."""
    if last - first <= LEAF:
        return rows
    cut = (first + last) // 2
    separator = [r for r in rows if r < cut <= farthest[r]]
    halves = [r for r in rows if r < cut and farthest[r] < cut], [r for r in rows if r >= cut]
    before = elimination_order(halves[0], first, cut, farthest) + elimination_order(halves[1], cut, last, farthest)
    return before + separator


def onorm(columns, order):
    """M 8.1."""
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
        for j in range(good, width):
            panel[:, j] = cleaned(x[:, : begin + j], panel[:, j], order)
        behind = x[:, begin + 64 :]
        shares = product(panel.T, behind)
        for i in range(width):
            behind -= panel[:, i, None] * shares[i]
    return x


def cleaned(before, column, order):
    """M 8.8."""
    v, times = column.copy(), 0
    while times < 8:
        square = ordered_sum(v * v)
        if times == 4 or (times < 4 and not 0 < square < np.inf):
            j, times = before.shape[1], 4
            v = np.array([hash_entry(row, j) for row in order]).astype(np.float32)
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


def cosine_columns(rows, first, last):
    """M 8.2, before they are rounded."""
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


def start_columns(previous, rows, columns, noise):
    """M 8.3: of a predecessor's columns, and cosines where it has fewer."""
    had = previous.shape[1]
    start = np.hstack([previous, cosine_columns(rows, had, max(had, columns)).astype(np.float32)])[:, :columns]
    return start + (noise * hash_columns(rows, columns)).astype(np.float32) if noise else start


def connected(laplacian):
    """M 8.3: whether the graph is in one piece."""
    found, waiting = {0}, [0]
    while waiting:
        for row in np.flatnonzero(laplacian[waiting.pop()]).tolist():
            if row not in found:
                found.add(row)
                waiting.append(row)
    return len(found) == len(laplacian)


def key_dictionary(header, laplacian, columns, springs):
    """M 8: of a block that follows none."""
    first, rows = min(columns, iterated(header, len(laplacian))), len(laplacian)
    exact, nothing = header["exact"] == 1, np.zeros((rows, 0), np.float32)
    start = start_columns(nothing, rows, first, 0.25 if exact or not connected(laplacian) else 0.0)
    if exact:  # M 8.5
        return completed(Solver(laplacian, springs, 2.0**-5).iterate(start, 256), columns)
    solver = Solver(laplacian, springs, header["shift"])
    return completed(solver.iterate(start, header["power"] * header["key_iterations"]), columns)


def iterated(header, rows):
    """M 8.7: h."""
    return -(-rows // 3) if header["gop_frames"] and rows <= header["coefficients"] else rows


def completed(found, columns):
    """M 8.7."""
    rows, h = found.shape
    if columns == h:
        return found
    both = found + np.eye(rows, h, dtype=np.float32)
    upper, z = both[:h].T.copy(), found[h:].T.copy()
    for k in range(h):
        if not upper[k, k] >= 2.0**-20:
            raise NumericError("a dictionary cannot be completed")
        share = upper[k + 1 :, k] * (np.float32(1) / upper[k, k])
        upper[k + 1 :] -= share[:, None] * upper[k]
        z[k + 1 :] -= share[:, None] * z[k]
    for k in reversed(range(h)):
        for j in range(h - 1, k, -1):
            z[k] -= upper[k, j] * z[j]
        z[k] *= np.float32(1) / upper[k, k]
    others = np.eye(rows, dtype=np.float32)[:, h:]
    for k in range(h):
        others = others - both[:, k, None] * z[k]
    return np.concatenate([found, others], axis=1)[:, :columns]


def hash_entry(row, column):
    """M 8.6."""
    z = ((row << 32) + column + 1) * 0x9E3779B97F4A7C15 % 2**64
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9 % 2**64
    z = (z ^ z >> 27) * 0x94D049BB133111EB % 2**64
    z ^= z >> 31
    return (z >> 11) * 2.0**-52 - 1.0


def hash_columns(rows, columns):
    """M 8.6."""
    return np.array([[hash_entry(r, j) for j in range(columns)] for r in range(rows)]).reshape(rows, columns)


# ---------------------------------------------------------------- M 9: coefficients

EXPERIENCE = Path(__file__).parent / "priors.bin"
EXPERIENCE_SHA256 = "2a093067f31fc03a6ec865ebc6193347d2b21ff18e6f4903e80cfc3af97c39d0"
NEIGHBOURS, BINS, NODES, EXPECTATIONS = 20, 48, 38, 3


class Experience:
    """M 9.1: the learnt numbers."""

    def __init__(self):
        data = EXPERIENCE.read_bytes()
        if hashlib.sha256(data).hexdigest() != EXPERIENCE_SHA256:
            raise SystemExit(f"{EXPERIENCE} is not the file of the specification")
        numbers = np.frombuffer(data, "<u2").astype(int)
        first = EXPECTATIONS * 6 * NEIGHBOURS
        second = first + 2 * NODES * EXPECTATIONS
        self.expectations = numbers[:first].reshape(EXPECTATIONS, 6, NEIGHBOURS).tolist()
        self.mixing = np.frombuffer(data, "<i2").astype(int)[first:second].reshape(2 * NODES, EXPECTATIONS).tolist()
        self.slots = numbers[second:].tolist()


class Grids:
    """M 9.11: which of two grids the next level is on."""

    def __init__(self):
        self.last = [0, 0, 0]

    @property
    def grid(self):
        return self.last[-1]

    def point(self, level):
        """What the next level stands for, in half steps."""
        point = 2 * level - self.grid * ((level > 0) - (level < 0))
        self.last = [*self.last[1:], (level + sum(self.last)) % 2]
        return point


class CoefficientModel:
    """M 9: one for each chain."""

    def __init__(self, width):
        self.experience = Experience()
        self.model = [Model(EXPECTATIONS, 400, 4) for _ in range(2)]  # M 9.2: the first block, and later ones
        self.model[1].slots = self.model[0].slots
        for number, stored in enumerate(self.experience.slots):
            slot = ((stored >> 4) << 10 | 1 << 9, (stored & 15) << 2)
            self.model[0].slots[number // (BINS * NODES), number // NODES % BINS, number % NODES] = slot
        for number, row in enumerate(self.experience.mixing):
            for i, weight in enumerate(row):
                self.model[number // NODES].weights[i, number % NODES] = weight << 4
        self.width, self.blocks = width, 0
        self.now, self.before, self.usual = ([[0, 0, 0] for _ in range(width + 11)] for _ in range(3))  # M 9.3

    def block(self, decoder, count):
        """M 9.4 to M 9.7: `count` rows in half steps."""
        points = [[0, 0, 0] for _ in range(count)]
        grids = Grids()
        for row in range(count):
            for d in range(3):
                level = self.level(decoder, row, d, grids.grid)
                points[row][d] = grids.point(level)
                self.now[8 + row][d] = min(abs(level), 1 << 15)
            if decoder.overran():
                decoder.fail("levels are missing")
        share = min(self.blocks + 1, 8)  # M 9.7
        for j in range(8, 8 + self.width):
            for d in range(3):
                self.before[j][d] = self.now[j][d]
                self.usual[j][d] += (16 * self.now[j][d] - self.usual[j][d]) // share
                self.now[j][d] = 0
        self.blocks += 1
        return points

    def inputs(self, row, d):
        """M 9.4."""
        now, before, usual = self.now, self.before, self.usual
        j, e, f = 8 + row, (d + 1) % 3, (d + 2) % 3
        return [
            16 * now[j - 1][d],
            16 * now[j - 2][d],
            16 * now[j - 3][d],
            8 * (now[j - 4][d] + now[j - 5][d]),
            4 * (now[j - 6][d] + now[j - 7][d] + 2 * now[j - 8][d]),
            16 * now[j][d - 1] if d > 0 else 0,
            16 * now[j][d - 2] if d > 1 else 0,
            8 * (now[j - 1][e] + now[j - 1][f]),
            4 * (now[j - 2][e] + now[j - 2][f] + now[j - 3][e] + now[j - 3][f]),
            16 * before[j][d],
            8 * (before[j - 1][d] + before[j + 1][d]),
            4 * (before[j - 2][d] + before[j + 2][d] + before[j - 3][d] + before[j + 3][d]),
            8 * (before[j][e] + before[j][f]),
            4 * (before[j - 1][e] + before[j - 1][f] + before[j + 1][e] + before[j + 1][f]),
            usual[j][d],
            (usual[j - 1][d] + usual[j + 1][d]) >> 1,
            (usual[j][e] + usual[j][f]) >> 1,
            16,
            256 // (row + 1),
            1024 // (row + 1) ** 2,
        ]

    def level(self, decoder, row, d, grid):
        """M 9.5, M 9.6."""
        inputs = self.inputs(row, d)
        kind = d + (3 if self.blocks == 0 else 0)
        contexts = []
        for i in range(EXPECTATIONS):
            total = sum(w * x for w, x in zip(self.experience.expectations[i][kind], inputs)) >> 10
            place = 0
            if total >= 1:
                octave = total.bit_length() - 1
                place = min(3 * octave + ((3 * (total - (1 << octave))) >> octave), BINS - 1)
            contexts.append(place)
        model = self.model[0 if self.blocks == 0 else 1]

        def decide(node):
            return model.bit(decoder, contexts, node)

        size = 0
        while size < 23 and decide(14 + size if grid == 1 and size < 2 else min(size, 13)):
            size += 1
        if size == 0:
            return 0
        result = 1
        if size > 1:
            first = decide(14 + min(size, 9))
            result = 2 | first
            if size > 2:
                result = 2 * result | decide(18 + 2 * min(size, 9) + first)
                if size > 3:
                    result = (result << (size - 3)) + decoder.uniform(1 << (size - 3))
        return -result if decoder.bit(32768) else result


def unpack(payload, count, bits):
    """F 6: `count` unsigned numbers."""
    size = (count * bits + 7) // 8
    payload = unzipped(payload, size)
    number = int.from_bytes(payload, "big")
    spare = 8 * size - count * bits
    require(number & ((1 << spare) - 1) == 0, "the bits behind the last coefficient are not 0")
    number >>= spare
    return [number >> bits * (count - 1 - i) & ((1 << bits) - 1) for i in range(count)]


def unzipped(data, size):
    """F 6.2: `size` bytes, which may be a zstd frame."""
    require(len(data) <= size, "too many bytes")
    if len(data) == size:
        return data
    frame = b"\x28\xb5\x2f\xfd" + data
    try:
        parameters = zstandard.get_frame_parameters(frame)
        require(parameters.content_size == size and parameters.window_size <= 1 << 23, "zstd frame of another size")
        require(not parameters.has_checksum, "a zstd frame with a checksum")
        content = zstandard.ZstdDecompressor().decompress(frame, max_output_size=size, allow_extra_data=False)
    except zstandard.ZstdError as error:
        raise CorruptError(f"zstd frame is damaged: {error}") from None
    require(len(content) == size, "zstd frame of another size")
    return content


# ---------------------------------------------------------------- M 10, M 12, M 17: positions


def smoothing_powers(amount):
    """M 12.3: coefficients of x^2 to x^5."""
    nodes = [0.4, 0.9, 1.4, 1.8]
    table = [-amount / (1.0 + amount * x * x) for x in nodes]
    for level in range(1, 4):
        for i in range(3, level - 1, -1):
            table[i] = (table[i] - table[i - 1]) / (nodes[i] - nodes[i - level])
    powers = [0.0] * 4
    for node, value in zip(reversed(nodes), reversed(table)):
        powers = [before - node * own for before, own in zip([value, *powers], powers)]
    return powers


def smooth(graph, positions, amount):
    """M 12.2, M 12.4."""
    if amount == 0.0:
        return positions
    current, result = positions, positions
    for k, power in enumerate([0.0, *smoothing_powers(amount)]):
        around = [ordered_sum(current[row]) * (1.0 / len(row)) if row else own for row, own in zip(graph, current)]
        current = current - around
        result = result + power * current if k else result
    return result


class Allowance:
    """M 14.2, M 14.3: what dictionaries may take."""

    def __init__(self):
        self.before = 0  # vertices of the runs before (S 9.6)
        self.vertices = 0  # that the faces have so far (M 14.8)
        self.shown = 0  # vertices of frames of a sequence
        self.work = 0.0

    def spend(self, header, rows, columns, follows):
        """Take note of a dictionary to come, on a surface."""
        power, iterations = header["power"], header["iterations" if follows else "key_iterations"]
        if header["exact"] == 1 and not follows:
            power, iterations = 2, 128
        h = min(columns, iterated(header, rows))
        whole, all_columns = -(-h // 16) * 16, -(-columns // 16) * 16
        require_limit(8 * (6 * rows * all_columns + 2 * all_columns**2), MOST_MEMORY + 1024 * self.vertices, "memory")
        solution = 40 * rows * (0.3 * -(-h // 64) + 0.02 * whole)
        rounding = rows * (3 + 0.4 * whole + whole**2 / 80)
        self.work += 5 * rows * whole + iterations * power * solution + (iterations * power + 1) * rounding
        if columns > h:  # M 8.7
            self.work += (h**3 / 3 + (columns - h) * h * (h + rows)) / 15 + 2 * rows * columns
        require_limit(self.work, MOST_WORK + 3.2e4 * (self.before + self.vertices + self.shown), "work")


def read_column(decoder, count):
    """F 9.3: whole numbers, as a matrix of one column (S 4)."""
    return LevelModel().matrix(decoder, count, 1, np.zeros((0, 1), int), (0, 0))[:, 0].tolist()


class Mesh:
    """What a stream says beside its blocks: header, faces, graph, and the cores of the blocks."""

    def __init__(self, packets, allowance):
        self.header, self.packets = packets[HEADER][0], packets
        header = self.header
        self.allowance = allowance
        packets.require(packets[CONNECTIVITY], "there is no CONNECTIVITY")
        vertices = header["vertices"]
        self.faces = decode_connectivity(packets[CONNECTIVITY][0], vertices, header["faces"], MOST_VERTICES)
        self.allowance.vertices = vertices
        self.graph = neighbours_of(self.faces, vertices)

    def read_order(self):
        """PARTITION and ORDER, where all faces are known."""
        packets, vertices = self.packets, self.header["vertices"]
        self.numbers, self.arranged, self.loose = [[v] for v in range(vertices)], self.faces, {}
        self.user_corners = [[3 * f + i for i in range(3)] for f in range(len(self.faces))]
        self.splits, self.labels = False, None
        if packets[PARTITION]:
            self.labels = decode_labels(packets[PARTITION][0], self.graph, self.header["blocks"])
        if packets[ORDER]:
            self.arrange(packets[ORDER][0])

    def cut(self):
        """M 4, M 5.1: the cores of the blocks, in their order."""
        parts = self.header["blocks"]
        labels = derive_labels(self.graph, parts) if self.labels is None else self.labels
        cores = [[v for v, label in enumerate(labels) if label == part] for part in range(parts)]
        require(max(map(len, cores)) <= self.header["block_size"], "a part is larger than a block")  # M 5.2
        self.cores = [cores[part] for part in chain_of(self.graph, labels, parts)]

    def result(self, positions):
        """M 12.5: positions of n vertices in the unit of the mesh, each under its numbers."""
        return self.numbered(positions * self.header["scale"] + np.array(self.header["center"]))

    def numbered(self, positions):
        """C 9.5, F 9: positions in the unit of the mesh, each under its numbers."""
        if not np.isfinite(positions).all():
            raise NumericError("positions are not finite")
        arranged = np.empty((sum(map(len, self.numbers)) + len(self.loose), 3))
        for given, position in zip(self.numbers, positions):
            arranged[given] = position
        for given, position in self.loose.items():
            arranged[given] = position
        return arranged

    def arrange(self, data):
        """C 9, F 9: the numbers that each vertex has, the faces, and vertices in none of them."""
        vertices = self.header["vertices"]
        copies, at = payload_varint(data, 0)  # F 9.1
        loose, at = payload_varint(data, at)
        given = vertices + copies + loose
        require_limit(given, MOST_VERTICES, "given vertices")
        require(vertices + copies <= 3 * len(self.faces) and given < 1 << 24, "too many copies of vertices")
        require(24 * loose <= len(data) - at, "positions of loose vertices are missing")
        values = struct.unpack(f"<{3 * loose}d", data[at : at + 24 * loose])
        require(all(map(math.isfinite, values)), "a loose vertex is not finite")
        decoder = RangeDecoder(data[at + 24 * loose :])
        numbers, faces, self.user_corners = arrange(decoder, self.faces, vertices)
        self.arranged, self.numbers = faces, [[number] for number in numbers]
        self.splits = copies + loose > 0
        if self.splits:
            self.split(decoder, numbers, given, copies, values)
        decoder.finish()
        require(not (loose and self.header["gop_frames"]), "loose vertices in a sequence")  # F 9.1

    def split(self, decoder, numbers, given, copies, values):
        """F 9.2 to F 9.5."""
        vertices, faces = self.header["vertices"], self.arranged
        kinds = read_rotations(decoder, given)  # F 9.2
        require([kinds.count(0), kinds.count(1)] == [vertices, copies], "other vertices than were announced")
        back = read_column(decoder, copies)
        places, last, waiting = [[] for _ in range(vertices)], -1, iter(back)
        for number, kind in enumerate(kinds):
            if kind == 0:
                last += 1
                places[last].append(number)
            elif kind == 1:  # F 9.3
                vertex = last - next(waiting)
                require(0 <= vertex <= last, "a copy of no vertex")
                places[vertex].append(number)
        steps = [0] * (3 * len(faces))
        if copies:
            steps = read_column(decoder, 3 * len(faces))
        seen, self.arranged, corner = [0] * vertices, [], iter(steps)
        for face in faces:  # F 9.4
            turned = []
            for v in face:
                step = next(corner)
                require(0 <= step < len(places[v]), "a copy that there is not")
                turned.append(places[v][(seen[v] + step) % len(places[v])])
                seen[v] += 1
            self.arranged.append(tuple(turned))
        alone = [number for number, kind in enumerate(kinds) if kind == 2]
        self.loose = {number: values[3 * i : 3 * i + 3] for i, number in enumerate(alone)}
        self.numbers = [places[number] for number in numbers]


def decode_grid(mesh, grids):
    """V 12: positions in the unit of the mesh, shape (n, 3), and their coded values."""
    header = mesh.header
    if header["light"] == 2:
        exact = ExactReader(mesh.faces, header["vertices"], header)
        for _, count, payload in grids:
            size, at = payload_varint(payload, 0)
            require(size <= len(payload) - at, "a frame ends inside its values")
            exact.read(payload[at : at + size], payload[at + size :], count)
        if not np.isfinite(exact.positions).all():
            raise NumericError("positions are not finite")  # V 16.4
        return np.array(exact.positions), exact.x
    reader = (LightReader if header["light"] else GridReader)(mesh.faces, header["vertices"], header["grid"])
    for _, count, payload in grids:
        reader.read(payload, count)
    positions = [place(x, header) for x in reader.x]
    return np.array(positions), reader.x


def dot(a, b):
    """M 1.3: scalar products of rows."""
    return a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1] + a[..., 2] * b[..., 2]


def refine(mesh, positions, refinements):
    """M 17: base positions and what the layer adds to them."""
    (step, ratio), count = mesh.header["refinement"], len(positions)
    sums = np.zeros((count, 3))
    for a, b, c in mesh.faces:  # M 17.1
        normal = np.cross(positions[b] - positions[a], positions[c] - positions[a])
        for v in (a, b, c):
            sums[v] += normal
    pole, axes = np.array([0.48, 0.6, 0.64]), np.array([[-0.8, 0.0, 0.6], [0.36, -0.8, 0.48]])
    tilted = sums + (math.sqrt(ordered_sum(dot(sums, sums)) / count) * 2.0**-10 + 2.0**-33) * pole
    normals = tilted / np.sqrt(dot(tilted, tilted) + 2.0**-200)[:, None]  # M 17.2
    along = np.maximum(1.0 + dot(pole, normals), 2.0**-20)
    frames = [normals, *(axis - (dot(axis, normals) / along)[:, None] * (pole + normals) for axis in axes)]
    reader, coded = LevelsReader(mesh.faces, count), 0  # M 17.3
    for _, size, payload in refinements:
        reader.read(payload, size)
        coded += size
    levels = np.array(reader.x, float).reshape(count, 3)
    refined = raised = positions + (step * levels[:, 0])[:, None] * frames[0]
    if coded == count:  # M 17.5
        wide = step * tangent_ratios(mesh.faces, raised, ratio)
        for j in (1, 2):
            refined = refined + (wide * levels[:, j])[:, None] * frames[j]
    return refined


def tangent_ratios(faces, places, ratio):
    """M 17.4: t of each vertex."""
    if ratio <= 1:
        return np.full(len(places), ratio)
    sums, areas = np.zeros((len(places), 3)), np.zeros(len(places))
    rims, lengths = np.zeros((len(places), 3)), np.zeros(len(places))
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
    bends, corners = np.zeros(len(places)), np.zeros(len(places))
    for face in faces:
        whole = own[face[0]] + own[face[1]] + own[face[2]]
        for v in face:
            bends[v] += own[v] + whole
            corners[v] += 4.0
    bends = np.divide(bends, corners, out=np.ones(len(places)), where=corners > 0)
    return np.maximum(1, ratio * np.sqrt(np.sqrt(2.0**-12 / (2.0**-12 + bends))))


class Chain:
    """M 10.1: what blocks learn from those before them."""

    def __init__(self, mesh):
        self.mesh, header = mesh, mesh.header
        self.model = CoefficientModel(header["coefficients"])
        self.known, self.subspace = Known(header["vertices"]), None

    def decode(self, block, width, payload):
        """Positions of the next block."""
        header = self.mesh.header
        points = self.points(width, payload)
        springs, pulls = np.zeros(block.size), np.zeros((block.size, 3))
        if header["springs"]:
            springs, pulls = surroundings(self.mesh.graph, block, self.known)
        solver = Solver(block.laplacian, springs, header["shift"])
        subspace = self.subspace = self.dictionary(block, width, springs, solver)
        positions = solver.extend(springs, pulls)  # M 10.2
        positions = product(subspace, points * (header["step"] / 2)) + positions
        if not np.isfinite(positions).all():
            raise NumericError("positions are not finite")
        self.known.add(block, positions, np.maximum(block.degrees, 1.0))
        return positions

    def points(self, width, payload):
        """M 9.10, M 9.11: in half steps."""
        header = self.mesh.header
        if header["bits"]:
            levels = np.array(unpack(payload, 3 * width, header["bits"])).reshape(width, 3) - (
                1 << (header["bits"] - 1)
            )
            levels[0] <<= header["coarser"]
            return 2 * levels
        decoder = RangeDecoder(payload)
        points = np.array(self.model.block(decoder, width))
        decoder.finish()
        return points

    def dictionary(self, block, columns, springs, solver):
        header = self.mesh.header
        follows = self.subspace is not None and len(self.subspace) == block.size  # M 8.3
        self.mesh.allowance.spend(header, block.size, columns, follows)
        if not follows:
            return key_dictionary(header, block.laplacian, columns, springs)
        first, noise = min(columns, iterated(header, block.size)), 0.0 if connected(block.laplacian) else 2.0**-8
        start = start_columns(self.subspace, block.size, first, noise)
        return completed(solver.iterate(start, header["power"] * header["iterations"]), columns)


def decode_blocks(mesh, blended):
    """M 5 to M 12.1: the blocks; their copies are added to `blended`, in BSM units."""
    header, packets = mesh.header, mesh.packets
    blocks = packets[BLOCK]
    if not (blocks or packets[GOP] or packets[REFINEMENT]):
        packets.require(False, "a block is missing")  # M 10.3
    mesh.cut()
    length = header["key_interval"] or header["blocks"]
    for expected, (index, width, payload) in enumerate(blocks):
        require(index == expected, "a block is missing")  # M 10.3
        if expected % length == 0:  # M 10.1
            chain = Chain(mesh)
        core = mesh.cores[expected]
        block = Block(mesh.graph, grow(mesh.graph, core, header["block_size"]))
        require(1 <= width <= block.size, "a wrong number of coefficients")  # M 9.9
        positions = chain.decode(block, width, payload)
        blended.add(block, positions, np.maximum(block.degrees, 1.0))  # M 12.1
    packets.require(len(blocks) == header["blocks"], "a block is missing")  # M 10.3


# ---------------------------------------------------------------- S: sequences


KEPT_MESHES = 8


class Gop:
    """S 2."""

    def __init__(self, data, header, declared):
        require(len(data) >= 1, "a GOP without method")
        run, kind = divmod(data[0], 8)
        counted, self.method = divmod(kind, 4)
        require(run == header["number"] % 32, "a GOP of another run")  # S 9.2
        longest = header["gop_frames"]
        self.frames, at = payload_varint(data, 1)
        require(1 <= self.frames <= longest, "a wrong number of frames")  # S 2.3
        self.shown = list(range(self.frames))
        if self.method in (0, 3):
            at = self.read_stretches(data, at)
        own = max(self.shown) + 1
        told, widths = {}, {number: one.components for number, one in enumerate(declared) if one.moves}
        if counted:  # S 10.2
            count, at = payload_varint(data, at)
            require(count > 0, "a GOP that tells of no attribute")
            for _ in range(count):
                number, at = payload_varint(data, at)
                size, at = payload_varint(data, at)
                require(number in widths and all(before < number for before in told), "no attribute that moves")
                require(at + size <= len(data), "a GOP ends inside a field")
                told[number], at = Field(data[at : at + size], self.method, own, widths[number]), at + size
        self.fields = [Field(data[at:], self.method, own, 3), *(told.get(number) for number in widths)]

    def read_stretches(self, data, at):
        """S 2.5."""
        count, at = payload_varint(data, at)
        shown = []
        for _ in range(count):
            code, at = payload_varint(data, at)
            length, at = payload_varint(data, at)
            require(1 <= length <= self.frames - len(shown), "a stretch of a wrong length")
            z, way = code // 3, (1, 0, -1)[code % 3]
            first = (shown[-1] + 1 if shown else 0) + (z // 2 if z % 2 == 0 else -(z + 1) // 2)
            require(0 <= first < self.frames and 0 <= first + way * (length - 1) < self.frames, "no frame of a GOP")
            shown += [first + way * i for i in range(length)]
        require(count == 0 or len(shown) == self.frames, "stretches of too few frames")
        self.shown = shown or self.shown
        return at


class Field:
    """S 2: of positions, or of an attribute (S 10)."""

    def __init__(self, data, method, frames, width):
        self.width, self.columns, self.exponents, self.basis, at = width, width * frames, [], b"", 4
        require(len(data) >= 4, "a GOP ends inside its step")
        self.step = struct.unpack("<f", data[:4])[0]
        require(0.0 < self.step < math.inf, "a step that is not finite and above 0")  # S 2.1
        if method in (0, 3):
            self.columns, at = payload_varint(data, at)
            require(self.columns <= width * frames, "too many components")
            for _ in range(self.columns):  # S 2.4
                code, at = payload_varint(data, at)
                before = self.exponents[-1] if self.exponents else 0
                self.exponents.append(before + (code // 2 if code % 2 == 0 else -(code + 1) // 2))
            require(all(0 <= exponent <= 400 for exponent in self.exponents), "an exponent out of range")
            length, at = payload_varint(data, at)
            require(at + length <= len(data), "a GOP ends inside its basis")
            self.basis, at = data[at : at + length], at + length
        self.back = self.brief = 0
        if method == 2:
            refers, at = payload_varint(data, at)
            self.back, self.brief = divmod(refers, 2)
            require(self.back == 0 or self.back >= frames, "frames that start from themselves")  # S 2.6
        self.levels = data[at:]


class LevelModel:
    """S 4: what is learnt from the levels of a sequence."""

    def __init__(self):
        self.sets = [Model(6, 400, 10) for _ in range(3)]
        for model in self.sets:
            model.slots = self.sets[0].slots

    def decode(self, payload, shapes, references, leads=None):
        """Matrices of the shapes given; a reference of None is the matrix before. `leads` are of a basis."""
        decoder, matrices = RangeDecoder(payload), []
        for (rows, columns), reference, lead in zip(shapes, references, leads or [None] * len(shapes)):
            if reference is None:
                reference = matrices[-1] if matrices else np.zeros((0, columns), int)
            matrices.append(self.matrix(decoder, rows, columns, reference, lead))
        decoder.finish()
        return matrices

    def matrix(self, decoder, rows, columns, reference, lead=None):
        """S 4.1 to S 4.3."""
        levels, slow, grids = np.zeros((rows, columns), int), [0] * columns, Grids()

        def a(j, i):
            return abs(int(levels[j, i])) if j >= 0 and 0 <= i < columns else 0

        def b(j, i):
            return abs(int(reference[j, i])) if 0 <= j < len(reference) else 0

        turn, few = -(-rows // 3), columns
        for j in range(rows):
            if j % 8 == 0 and not self.more(decoder, levels, reference, j):
                break
            if lead is None and j == turn:
                few = decoder.uniform(columns + 1)
            mean = 0
            if lead is None:
                coded = few
            else:
                coded = min(columns, lead[1] * j + lead[0] + 1)
            for i in range(coded):
                above = 2 * a(j - 1, i) + a(j - 2, i) + a(j - 3, i)
                left = 2 * a(j, i - 1) + a(j, i - 2)
                around = a(j - 1, i + 1) + a(j - 1, i - 1)
                before = 2 * b(j, i) + b(j - 1, i) + b(j + 1, i)
                place = j if j < 20 else min(39, 20 + (j - 20) // 8)
                contexts = [
                    12 * octave(j) + size_class(slow[i] >> 4),
                    12 * octave(i) + size_class(above),
                    12 * size_class(before) + size_class(slow[i] >> 4),
                    12 * size_class(above) + size_class(left),
                    12 * size_class(mean >> 5) + size_class((above + left + around + before) >> 1),
                    40 * size_class(left + around) + place,
                ]
                model = self.sets[0 if j == 0 else 1 if j < 12 else 2]
                levels[j, i] = self.level(decoder, model, contexts, grids.grid)
                grids.point(int(levels[j, i]))
                magnitude = min(abs(int(levels[j, i])), 4096)
                slow[i] += (64 * magnitude - slow[i]) >> 2
                mean += (128 * magnitude - mean) >> 2
            for _ in range(coded, columns):
                grids.point(0)
            if decoder.overran():
                decoder.fail("levels are missing")
        return levels

    def more(self, decoder, levels, reference, j):
        """S 4.2: whether there are levels from row j on."""
        lately = size_class(int(np.abs(levels[max(0, j - 8) : j]).sum()))
        left, soon = (size_class(int(np.abs(rows).sum())) for rows in (reference[j:], reference[j : j + 8]))
        contexts = [
            12 * octave(j) + lately,
            12 * octave(j) + left,
            12 * left + lately,
            12 * left + soon,
            12 * soon + lately,
            40 * left + (j if j < 20 else min(39, 20 + (j - 20) // 8)),
        ]
        return self.sets[0 if j == 0 else 1 if j < 12 else 2].bit(decoder, contexts, 43)

    def level(self, decoder, model, contexts, grid):
        """S 4.2: one level."""
        if not model.bit(decoder, contexts, 41 if grid else 0):
            return 0
        negative = model.bit(decoder, contexts, 1)
        magnitude = 1
        if model.bit(decoder, contexts, 42 if grid else 2):
            magnitude = 2 + read_unsigned(decoder, model, contexts, 13, 3)
        return -magnitude if negative else magnitude


def points_of(levels):
    """S 4.4."""
    grids = Grids()
    return np.array([grids.point(int(level)) for level in levels.flat]).reshape(levels.shape) / 2


def octave(value):
    return min(value.bit_length(), 11)


def size_class(value):
    if value < 5:
        return value
    return next((5 + k for k, bound in enumerate((7, 10, 15, 25, 50, 150)) if value < bound), 11)


def cosines_over_time(frames):
    """S 5.1: row t, column f."""
    columns = cosine_columns(frames, 0, frames) * math.sqrt(2.0 / frames)
    columns[:, 0] = math.sqrt(1.0 / frames)
    return columns


def temporal_basis(field, frames):
    """S 5: d T rows, r columns."""
    cosines, d = cosines_over_time(frames), field.width
    leads = [(c, d) for c in range(d)]
    matrices = LevelModel().decode(field.basis, [(frames, field.columns)] * d, [None] * d, leads)
    steps = np.array([QUARTERS[exponent % 4] * 2.0 ** -(exponent // 4) for exponent in field.exponents])
    free = np.array([points_of(matrix) * steps for matrix in matrices]).transpose(1, 0, 2)
    columns = right_angles(free.reshape(d * frames, field.columns)).reshape(free.shape)
    return np.concatenate([product(cosines, columns[:, c]) for c in range(d)])


QUARTERS = 1.0, 0.8408964152537145, 0.7071067811865476, 0.5946035575013605


def right_angles(free):
    """S 5.3: the x_i of the y_i."""
    columns = free.copy()
    for k in reversed(range(free.shape[1])):
        vector = free[:, k].copy()
        square = ordered_sum(vector * vector)
        if square > 0:
            vector[k] += -math.sqrt(square) if vector[k] < 0 else math.sqrt(square)
            behind = columns[:, k + 1 :]
            shares = product(vector[None], behind)[0] * (2.0 / ordered_sum(vector * vector))
            behind -= vector[:, None] * shares
    return columns


class Loop:
    """S 6."""

    def __init__(self, known, coded):
        self.moments = np.zeros((known + min(coded, 24), known + coded))  # S 6.1

    def begin(self, known, field, step):
        """S 6.6."""
        if len(known):
            z = np.concatenate([known, field], axis=1)
            z = z - ordered_sum(z) / len(z)
            weight = 30.0 / (len(z) * 30.0 * step * step + ordered_sum((z * z).ravel()))
            self.moments = product(z[:, : len(self.moments)].T, z) * weight
        return self

    def decode(self, known, levels, step):
        k, width = known.shape[1], self.moments.shape[1]
        result, points = np.zeros((len(known), width - k)), points_of(levels)
        for j in range(len(known)):
            if j < 16 or j % 8 == 0:
                factor = self.factor()
            p, z = np.zeros(width), np.zeros(width)
            for b in range(width):  # S 6.3
                z[b] = known[j, b] if b < k else p[b] + points[j, b - k] * step
                if b < len(factor):
                    p[b + 1 :] += factor[b, b + 1 :] * ((z[b] - p[b]) / factor[b, b])
            result[j] = z[k:]
            if j > 0:  # S 6.4
                w = 1.0 / ordered_sum(np.array([30.0 * step * step, *(z * z)]))
                self.moments = 0.985 * self.moments + (w * z[: len(self.moments)])[:, None] * z
        if not np.isfinite(result).all():
            raise NumericError("coefficients are not finite")  # S 6.5
        return result

    def factor(self):
        """S 6.2."""
        factor = np.zeros_like(self.moments)
        for a in range(len(factor)):
            g = self.moments[a].copy()
            g[:a] = 0.0
            g[a] += 0.004
            for e in range(a):
                g[a:] -= factor[e, a] * factor[e, a:]
            factor[a] = g / math.sqrt(g[a])
        return factor


class Part:
    """S 3: the core of a block, its dictionary, and its edges to parts before it."""

    def __init__(self, mesh, weight, vertices, rank):
        self.block = Block(mesh.graph, sorted(vertices))
        self.laplacian, self.edges = np.zeros((self.block.size, self.block.size)), []  # S 3.2
        for r, neighbours in enumerate(self.block.graph):
            for q in neighbours:
                stiffness = weight[self.block.vertices[r], self.block.vertices[q]]
                self.laplacian[r, r] += stiffness
                self.laplacian[r, q] -= stiffness
        self.springs = np.zeros(self.block.size)
        for r, v in enumerate(self.block.vertices):
            for w in mesh.graph[v]:
                if rank[w] < rank[v]:
                    self.edges.append((r, w, weight[v, w]))
                    self.springs[r] += weight[v, w]
        columns = min(mesh.header["coefficients"], self.block.size)
        mesh.allowance.spend(mesh.header, self.block.size, columns, False)
        self.basis = key_dictionary(mesh.header, self.laplacian, columns, self.springs)  # S 3.3
        self.tether = Solver(self.laplacian, self.springs, 2.0**-16)

    def known(self, field, bent):
        """S 3.7, S 10.3: the known columns here, and those at the vertices around."""
        self.around = sorted({w for _, w, _ in self.edges})
        columns = self.bends(field) if bent else field
        return self.difference(columns), columns[self.around]

    def bends(self, positions):
        """S 3.7: where they are needed."""
        own = positions[self.block.vertices]
        centre = ordered_sum(own) / len(own)
        radius = math.sqrt(ordered_sum(dot(own - centre, own - centre)) / len(own) + 2.0**-24)
        y = (positions[[*self.block.vertices, *self.around]] - centre) / radius
        columns = np.zeros((len(positions), 19))
        columns[:, :3] = positions
        axes = [(a, b) for a in range(3) for b in range(a, 3)]
        squares = [0.5 * radius * y[:, a] * y[:, b] for a, b in axes]
        cubes = [0.3 * radius * y[:, a] * y[:, b] * y[:, c] for a, b in axes for c in range(b, 3)]
        columns[[*self.block.vertices, *self.around], 3:] = np.stack([*squares, *cubes], axis=1)
        return columns

    def extension(self, field):
        """S 3.4."""
        pulls = np.zeros((self.block.size, field.shape[1]))
        for r, w, stiffness in self.edges:
            pulls[r] += stiffness * field[w]
        return self.tether.extend(self.springs, pulls)

    def difference(self, field):
        """S 3.5."""
        return product(self.basis.T, field[self.block.vertices] - self.extension(field))

    def place(self, field, difference):
        field[self.block.vertices] = product(self.basis, difference) + self.extension(field)


def edge_weights(mesh, positions):
    """S 3.1: of both directions of every edge."""
    sums = {(v, w): 0.0 for v, row in enumerate(mesh.graph) for w in row}
    for face in mesh.faces:
        if len(set(face)) < 3:
            continue
        for k in range(3):
            a, b, c = face[k], face[(k + 1) % 3], face[(k + 2) % 3]
            u, v = positions[b] - positions[a], positions[c] - positions[a]
            across, along = np.cross(u, v), dot(u, v)
            u, v = u * u, v * v
            m = 2.0 * (u[0] + u[1] + u[2] + v[0] + v[1] + v[2] - along)
            half = 0.5 * (along / math.sqrt(dot(across, across) + 2.0**-12 * m * m + 2.0**-48))
            sums[b, c] += half
            sums[c, b] += half
    if not np.isfinite(list(sums.values())).all():
        raise NumericError("weights are not finite")
    positive = {edge: (t + math.sqrt(t * t + 2.0**-6)) / 2 for edge, t in sums.items()}
    return {edge: 2.0**-5 + 8 * p / (8 + p) for edge, p in positive.items()}


class Track:
    """S 3.6, S 10.3: what is known of positions, or of an attribute that moves, before the first GOP."""

    def __init__(self, parts, first_frame, base):
        self.width, self.base, self.history, self.inherited = first_frame.shape[1], base, None, None
        self.shape = first_frame.shape
        self.kept = min(64, max(2, 2**19 // len(first_frame))) if base is None else 2  # S 7.3
        bends = [part.known(first_frame, bent=base is None) for part in parts]
        self.bends, self.first = bends, [np.vstack((around, known))[:, : self.width] for known, around in bends]
        self.start = self.first if base is None else [np.zeros_like(one) for one in self.first]

    def learnt(self, parts, field, gop):
        """S 7.1: fields of all frames, as they are shown."""
        before = self.inherited if gop.method == 3 else [(known[:, :0], around[:, :0]) for known, around in self.bends]
        require(before is not None, "a GOP refers to one that is not there")
        if field is None:  # S 10.4
            self.inherited = [(known[:, :0], around[:, :0]) for known, around in self.bends]
            return [np.zeros(self.shape)] * gop.frames
        self.inherited, frames = [], max(gop.shown) + 1
        basis, placed = temporal_basis(field, frames), np.zeros((self.shape[0], field.columns))
        shapes = [(part.basis.shape[1], field.columns) for part in parts]
        matrices = LevelModel().decode(field.levels, shapes, [None] * len(parts))
        for part, matrix, bends, earlier in zip(parts, matrices, self.bends, before):
            known, around = (np.hstack(pair) for pair in zip(bends, earlier))
            ends = placed[part.around]
            loop = Loop(known.shape[1], field.columns).begin(around, ends, field.step)
            difference = loop.decode(known, matrix, field.step)
            part.place(placed, difference)
            self.inherited.append((difference[:, :24], ends[:, :24]))
        wide = product(placed, basis.T).reshape(len(placed), self.width, frames)
        return [wide[:, :, t] for t in gop.shown]

    def following(self, parts, field, gop):
        """S 7.2: fields of frames that are told without a basis."""
        d, columns, self.inherited = self.width, self.width * gop.frames, None
        shapes = [(part.basis.shape[1], columns) for part in parts]
        if gop.method == 1:
            self.history = [LevelModel(), [], [self.start]]
        require(self.history is not None, "a frame refers to one that is not there")
        model, references, kept = self.history
        back = field.back if field else 0
        require(back <= len(kept), "a frame refers to one that is not kept")
        if not references or references[0].shape[1] != columns:  # S 7.4
            references = [np.zeros(shape, int) for shape in shapes]
        matrices = [np.zeros(shape, int) for shape in shapes]
        if field is not None:
            matrices = model.decode(field.levels, shapes, references)
        cosines, placed = cosines_over_time(gop.frames), np.zeros((self.shape[0], columns))
        reach = (0, 1) if field and field.brief else (0, 1, 2, 3, 5, 8, 13, 21, 34)
        ages = [min(age, len(kept) - 1) for age in reach if age < self.kept]
        starts = [kept[back - 1 - t if back else 0] for t in range(gop.frames)]
        told = []
        for k, part in enumerate(parts):
            ends, count = placed[part.around], len(part.around)
            base = np.hstack([sum(cosines[t, f] * starts[t][k] for t in range(gop.frames)) for f in range(gop.frames)])
            own = base[count:]
            if field is not None:
                changes = [kept[late][k] - kept[early][k] for late, early in pairwise(ages)]
                away = [kept[back - 1][k] - kept[0][k]] if back else []
                known = np.hstack([self.first[k], kept[0][k], *changes, *away])
                loop = Loop(known.shape[1], columns).begin(known[:count], ends - base[:count], field.step)
                own = own + loop.decode(known[count:], matrices[k], field.step)
            told.append(np.vstack((ends, own)))
            part.place(placed, own)
        frames = [[over_time(cosines[t], own, d) for own in told] for t in range(gop.frames)]
        self.history = [model, matrices, (frames[::-1] + kept)[: self.kept]]
        return [over_time(cosines[t], placed, d) for t in range(gop.frames)]

    def values(self, declared, change):
        """S 10.4, S 10.5: values of a frame, in the order of coding."""
        values, kind = self.base + change, KINDS[declared.kind]
        with np.errstate(over="ignore"):
            values = values.astype(kind) if declared.kind >= 6 else values
        if not np.isfinite(values).all():
            raise NumericError("values are not finite")
        if declared.kind < 6:
            values = np.clip(np.rint(values), *RANGES[declared.kind]).astype(kind)
        return values


def decode_frames(mesh, header, gops, first_frame, begin):
    """S 7: all frames of a run, in the unit of the mesh, from number `begin` on, and values that move (S 10)."""
    values = [[] for _ in mesh.moving]
    if not gops:
        return [], values  # S 8.3
    declared = mesh.packets[ATTRIBUTE]
    require(gops[0][0] == begin, "the first GOP is missing")  # S 1.2
    mesh.allowance.shown += mesh.header["vertices"] * Gop(gops[0][1], header, declared).frames
    rank = {v: index for index, core in enumerate(mesh.cores) for v in core}
    weight = edge_weights(mesh, first_frame)
    parts = [Part(mesh, weight, core, rank) for core in mesh.cores]
    tracks = [Track(parts, first_frame, None), *(Track(parts, base - base[0], base) for _, _, base in mesh.moving)]
    frames = []
    for index, data in gops:
        require(index == begin + len(frames), "a GOP is missing or repeated")  # S 1.2
        gop = Gop(data, header, declared)
        require(not 0 < header["frames"] < index + gop.frames, "more frames than announced")
        if gop.method in (0, 3):
            fields = [track.learnt(parts, field, gop) for track, field in zip(tracks, gop.fields)]
            for track in tracks:
                track.history = None
        else:
            fields = [track.following(parts, field, gop) for track, field in zip(tracks, gop.fields)]
        frames += [mesh.result(field) for field in fields[0]]
        for track, changes, (_, one, _), own in zip(tracks[1:], fields[1:], mesh.moving, values):
            own += [arranged_values(mesh, one, track.values(one.declared, change))[0] for change in changes]
    return frames, values


def over_time(cosines, columns, d):
    """S 7.2: the numbers of a frame, of cosine after cosine."""
    return sum(value * columns[:, d * f : d * f + d] for f, value in enumerate(cosines))


def declared_attributes(mesh, packets):
    """D 1 to D 3.1: the attributes before their values."""
    header, declared = mesh.header, packets[ATTRIBUTE]
    require(
        not (header["gop_frames"] and any(one.coding == 3 for one in declared)), "recomputed in a sequence"
    )  # D 4.4
    corners = Corners(mesh.faces, header["vertices"], traverse=False)
    attributes, earlier = [], []
    for one in declared:
        side = None
        if one.domain == 1 and one.seams_of:
            side = attributes[one.seams_of - 1].side
        elif one.domain == 1:
            side = read_seams(one.seams, corners, earlier)
            earlier.append(side)
        loose = len(mesh.loose) if one.by_vertex else 0
        attributes.append(Attribute(one, mesh.faces, header["vertices"], loose, side, corners))
    return attributes


def decode_attributes(mesh, packets, attributes, positions, places):
    """D 3 to D 5: for each attribute its arrays, as spec/vectors/README.md tells; positions are in BSM units."""
    mesh.moving = []
    if packets.fault and not packets[VALUES]:
        return {}  # the stream ends before them
    arrays = {}
    for index, one in enumerate(attributes):
        declared = one.declared
        chunks = [(count, data) for attribute, count, data in packets[VALUES] if attribute == index]
        values = one.recomputed(positions) if declared.coding == 3 else one.read(chunks, places)
        raw = values
        values, indices, domain = arranged_values(mesh, one, values)
        name = f"attribute {index} {SEMANTICS[declared.semantic]} {domain} {declared.name}"
        arrays[name] = np.array(values, KINDS[declared.kind]).reshape(-1, declared.components)
        if declared.moves:
            require(declared.rows == mesh.header["vertices"], "values of what no face uses that move")  # S 10.1
            base = np.array(raw, KINDS[declared.kind]).reshape(-1, declared.components)
            mesh.moving.append((name, one, base.astype(float)))
        if indices is not None:
            arrays[f"indices {index}"] = np.array(indices, np.int32).reshape(-1, 3)
    return arrays


def arranged_values(mesh, one, values):
    """D 4.5: values as they are given to the user, the indices of corners, and what has them."""
    declared, corners = one.declared, mesh.user_corners
    if declared.domain == 2:
        return [values[face[0] // 3] for face in corners], None, "face"
    indices = [[one.faces[k // 3][k % 3] for k in face] for face in corners]
    if not declared.by_vertex or (declared.domain == 1 and not mesh.splits):
        return values, indices, "corner"
    given = [values[0]] * (sum(map(len, mesh.numbers)) + len(mesh.loose))
    if declared.domain == 0:
        for numbers, value in zip(mesh.numbers, values):
            for number in numbers:
                given[number] = value
    else:
        for face, rows in zip(reversed(mesh.arranged), reversed(indices)):
            for number, row in zip(reversed(face), reversed(rows)):
                given[number] = values[row]
    for number, value in zip(sorted(mesh.loose), values[one.of_vertex :]):
        given[number] = value
    return given, None, "vertex"


def decode(stream):
    """Positions, shape (n, 3) or for a sequence (T, n, 3), and faces, shape (m, 3); see `decode_all`."""
    return decode_all(stream)[:2]


def decode_all(stream):
    """The same, and the arrays of attributes; of a sequence in several runs as spec/vectors/README.md tells."""
    runs = parse_stream(stream)
    if runs[0][HEADER][0]["gop_frames"]:
        return decode_sequence(runs)
    mesh, positions, _, arrays = decode_mesh(runs[0], Allowance())
    decoded = mesh.numbered(positions) if mesh.header["grid"] else mesh.result(positions)
    return decoded, faces_of(mesh), arrays


def faces_of(mesh):
    return np.array(mesh.arranged, np.int32).reshape(-1, 3)


def decode_mesh(packets, allowance):
    """The mesh of a stream or of a run, its positions or those of the first frame, its places, and attributes."""
    header = packets[HEADER][0]
    if header["sequence"] and header["smoothing"]:
        raise UnsupportedError("smoothing in a sequence")  # S 1.1
    mesh, blended = Mesh(packets, allowance), Known(header["vertices"])
    mesh.read_order()
    attributes = declared_attributes(mesh, packets)
    if not any(packets[kind] for kind in (BLOCK, GOP, GRID, REFINEMENT)):
        packets.require(not packets.fault, "")
    for attribute in attributes:
        attribute.check_rows()
    if header["grid"]:
        positions, places = decode_grid(mesh, packets[GRID])
        arrays = decode_attributes(mesh, packets, attributes, positions, places)
        packets.require(not packets.fault, "")
        return mesh, positions, places, arrays
    decode_blocks(mesh, blended)
    positions = blended.sums / blended.weights[:, None]
    if header["gop_frames"]:
        return mesh, positions, None, decode_attributes(mesh, packets, attributes, None, None)
    positions = smooth(mesh.graph, positions, header["smoothing"])
    if header["refinement"]:
        positions = refine(mesh, positions, packets[REFINEMENT])
    arrays = decode_attributes(mesh, packets, attributes, positions, None)
    packets.require(not packets.fault, "")
    return mesh, positions, None, arrays


def decode_sequence(runs):
    """S 1, S 9: the frames of all runs."""
    allowance, kept, frames, faces, table = Allowance(), {}, [], [], []
    for packets in runs:
        header = packets[HEADER][0]
        again = header["again"] is not None
        number = header["again"] if again else header["number"]
        if again:  # S 9.3
            require(number in kept, "the mesh of a run that is not kept")
            kept[number] = opened = kept.pop(number)
        else:
            while len(kept) >= KEPT_MESHES:
                kept.pop(next(iter(kept)))
            allowance.before, allowance.vertices = allowance.before + allowance.vertices, 0
            kept[number] = opened = decode_mesh(packets, allowance)
        mesh, first_frame, _, arrays = opened
        own = {name: mesh.header[name] for name in ("vertices", "faces")}
        require(own.items() <= header.items(), "another mesh than the run has that is named")  # S 9.3
        table.append([len(frames), sum(map(len, mesh.numbers)), header["faces"]])
        faces.append(faces_of(mesh))
        own, values = decode_frames(mesh, header, packets[GOP], first_frame, len(frames))
        frames += own
        for (name, one, _), each in zip(mesh.moving, values):
            shape = len(each), -1, one.declared.components
            arrays = arrays | ({name: np.array(each, KINDS[one.declared.kind]).reshape(shape)} if each else {})
    packets.require(not packets.fault and header["frames"] in (0, len(frames)), "frames are missing")  # S 1.2
    if len(runs) == 1:
        return np.array(frames).reshape(len(frames), table[0][1], 3), faces[0], arrays
    return np.concatenate(frames), np.concatenate(faces), arrays | {"runs": np.array(table, np.int32)}


def main():
    stream = Path(sys.argv[1]).read_bytes()
    try:
        positions, faces, attributes = decode_all(stream)
    except tuple(EXIT_CODES) as error:
        print(f"{type(error).__name__}: {error}", file=sys.stderr)
        return EXIT_CODES[type(error)]
    np.savez_compressed(sys.argv[2], positions=positions, faces=faces, **attributes)
    return 0


if __name__ == "__main__":
    sys.exit(main())
