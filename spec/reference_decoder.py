"""A decoder of BSM streams, written from the documents of this folder alone: slow, plain, easy to compare with them.

The rules that it follows are named as they are numbered: F for format.md, M for mathematics.md. numpy is used for
linear algebra alone, and nothing is shared with the product.

    python spec/reference_decoder.py IN.bsm OUT.npz

writes `positions` (float64, shape (n, 3)) and `faces` (int32, shape (m, 3)). Exit codes are those of
spec/vectors/README.md.
"""

import binascii
import hashlib
import math
import struct
import sys
import zlib
from pathlib import Path

import msgpack
import numpy as np
import zstandard


class Format(Exception):
    """Not a BSM stream."""

    code = 3


class Corrupt(Exception):
    """Contradicts the specification, itself or a checksum."""

    code = 4


class Truncated(Exception):
    """Ends too early."""

    code = 4


class Unsupported(Exception):
    """Of a version or method that is not in the specification."""

    code = 5


class Limit(Exception):
    """Asks for more than this decoder grants."""

    code = 6


class Numeric(Exception):
    """The mathematics broke down."""

    code = 7


MOST_VERTICES, MOST_FACES = 1 << 24, 1 << 25  # M 18
MOST_BLOCKS, MOST_ROWS, MOST_COLUMNS = 1 << 17, 8192, 4096
MOST_FRAMES, MOST_GOP_FRAMES = 1 << 20, 1024
MOST_FRAME_BYTES, MOST_METADATA_BYTES = 1 << 28, 1 << 16
MOST_WORK = 5e13


def require(condition, problem):
    """Every violation is *corrupt* unless a rule says otherwise."""
    if not condition:
        raise Corrupt(problem)


def require_limit(value, most, what):
    if value > most:
        raise Limit(f"{what} = {value} is over {most}")


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
    raise Corrupt("varint is longer than five bytes")


def payload_varint(data, start):
    found = varint(data, start)
    require(found is not None, "payload ends inside a varint")
    return found


def canonical_map(payload):
    """F 1.5: one map has one encoding, so decode, check the types, encode again and compare."""
    try:
        pairs = msgpack.unpackb(payload, raw=False, strict_map_key=False, object_pairs_hook=tuple)
    except Exception as error:  # msgpack raises many kinds
        raise Corrupt(f"not a msgpack map: {error}") from None
    require(type(pairs) is tuple and len(pairs) <= 256, "not a map of at most 256 entries")
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
        require(len(value) <= 256, "array of more than 256 entries")
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

HEADER, METADATA, CONNECTIVITY, PARTITION, ORDER, BLOCK, GOP, END = 1, 2, 3, 4, 5, 6, 7, 15


def frames_of(stream):
    """F 2 and F 3: yields (type, payload, offset of the tag) of every frame; skippable ones too."""
    magic = b"\x89BSM"
    if not magic.startswith(stream[:4]):
        raise Format("not a BSM stream")  # F 2.1
    if len(stream) >= 5 and stream[4] != 0:
        raise Unsupported("another version")  # F 2.2
    offset, number = 5, 0
    while True:
        tag = varint(stream, offset) if offset < len(stream) else None
        if tag is None:
            raise Truncated("the stream ends before END")  # F 2.4
        kind, length, start = tag[0] & 15, tag[0] >> 4, tag[1]
        require_limit(length, MOST_FRAME_BYTES, "frame length")  # F 3.2
        size = 2 if kind == BLOCK else 4
        end = start + length
        if end + size > len(stream):
            raise Truncated("the stream ends inside a frame")
        body = stream[offset:end]
        crc = binascii.crc_hqx(body, 0) if kind == BLOCK else zlib.crc32(body)
        require(crc == int.from_bytes(stream[end : end + size], "little"), "checksum of a frame is wrong")  # F 3.3
        if kind in (0, 12, 13, 14):
            raise Unsupported(f"frame type {kind}")  # F 3.6
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
    "blocks": (3, int, 1, COUNT, None),
    "block_size": (4, int, 1, COUNT, None),
    "coefficients": (5, int, 1, COUNT, None),
    "basis": (6, "method", 0, 1, 0),
    "seeding": (7, "method", 0, 1, 0),
    "key_interval": (8, int, 0, COUNT, 0),
    "power": (9, int, 1, 64, 2),
    "iterations": (10, int, 1, 1024, 1),
    "key_iterations": (11, int, 1, 1024, 8),
    "shift": (12, float, 2.0**-30, 2.0**30, 0.125),
    "blend": (13, "method", 0, 2, 0),
    "coding": (14, "method", 0, 1, 1),
    "bits": (15, int, 1, 32, 12),
    "step": (16, float, 2.0**-40, 2.0**20, 2.0**-8),
    "center": (17, (3, 3), -1e300, 1e300, [0.0, 0.0, 0.0]),
    "scale": (18, float, 1e-300, 1e300, 1.0),
    "prediction": (19, (0, 16), -1e30, 1e30, []),
    "smoothing": (20, float, 0.0, 1e6, 0.0),
    "frames": (21, int, 0, COUNT, 0),
    "frame_rate": (22, float, 0.0, 1e6, 0.0),
    "gop_frames": (23, int, 0, COUNT, 0),
    "weights": (24, "method", 0, 1, 0),
}


def parse_header(payload):
    """F 4."""
    names = {field[0]: name for name, field in FIELDS.items()}
    header = {}
    for key, value in canonical_map(payload):
        require(type(key) is int, "a header key is not an integer")
        if key >= 64:
            continue  # F 4.2
        if key not in names:
            raise Unsupported(f"header key {key}")
        name = names[key]
        _, kind, low, high, default = FIELDS[name]
        if type(kind) is tuple:  # F 4.4
            require(type(value) is list and all(type(v) is float for v in value), f"{name} has a wrong type")
            require(kind[0] <= len(value) <= kind[1], f"{name} has a wrong length")
            items = value
        else:
            require(type(value) is (float if kind is float else int), f"{name} has a wrong type")
            items = [value]
        if kind == "method" and high < value <= 255:
            raise Unsupported(f"{name} {value}")
        require(value != default, f"{name} is stored although it has its default")  # F 4.3
        require(all(low <= v <= high for v in items), f"{name} is outside its legal range")  # F 4.5
        header[name] = value
    for name, field in FIELDS.items():
        require(name in header or field[4] is not None, f"{name} is missing")
        header.setdefault(name, field[4])
    h = header
    require(h["vertices"] <= 3 * h["faces"], "more vertices than corners")  # F 4.6
    require(h["blocks"] <= h["vertices"], "more blocks than vertices")
    require(h["block_size"] <= h["vertices"], "blocks larger than the mesh")
    require(h["blocks"] * h["block_size"] >= h["vertices"], "blocks too small")
    require(h["coefficients"] <= h["block_size"], "more coefficients than rows")
    require(h["frames"] == 0 or h["gop_frames"] > 0, "frames without GOPs")
    for name, most in (  # F 4.7
        ("vertices", MOST_VERTICES),
        ("faces", MOST_FACES),
        ("blocks", MOST_BLOCKS),
        ("block_size", MOST_ROWS),
        ("coefficients", MOST_COLUMNS),
        ("frames", MOST_FRAMES),
        ("gop_frames", MOST_GOP_FRAMES),
    ):
        require_limit(h[name], most, name)
    return header


def parse_stream(stream):
    """F 3.7 to F 3.10 and F 5: the header, and the payloads of each type behind it."""
    header, last, metadata_seen = None, None, False
    packets = {CONNECTIVITY: [], PARTITION: [], ORDER: [], BLOCK: [], GOP: []}
    order = {HEADER: 0, CONNECTIVITY: 1, PARTITION: 2, ORDER: 3, BLOCK: 4, GOP: 5, END: 6}
    for kind, payload, offset, number in frames_of(stream):
        if header is None:
            require(kind == HEADER, "the first frame must be HEADER")  # F 3.7
        if 8 <= kind <= 11:
            continue  # F 3.5
        if kind == METADATA:
            require_limit(len(payload), MOST_METADATA_BYTES, "metadata")
            entries = canonical_map(payload)  # F 5.1
            require(all(type(k) is str and type(v) is not list for k, v in entries), "metadata of a wrong type")
            require(not metadata_seen and last < order[BLOCK], "METADATA may not come here")  # F 3.9
            metadata_seen = True
            continue
        if kind == HEADER:
            parsed = parse_header(payload)
        elif kind in (CONNECTIVITY, PARTITION, ORDER):
            require(len(payload) >= 1, "no method")
            parsed = (payload[0], payload[1:])  # F 5.2
        elif kind == BLOCK:
            index, at = payload_varint(payload, 0)
            width, at = payload_varint(payload, at)
            parsed = (index, width, payload[at:])
        elif kind == GOP:
            index, at = payload_varint(payload, 0)
            parsed = (index, payload[at:])
        else:
            count, at = payload_varint(payload, 0)
            require(len(payload) == at + 4, "END has a wrong length")
        place = order[kind]
        # F 3.8: ascending, CONNECTIVITY is required, only BLOCK and GOP repeat.
        legal = kind == HEADER if last is None else place > last or (place == last and kind in (BLOCK, GOP))
        require(legal and (place <= 1 or last >= 1), f"frame type {kind} may not come here")
        if kind in (BLOCK, GOP):
            require(not packets[kind] or parsed[0] > packets[kind][-1][0], "indices must ascend")  # F 3.10
        if kind == BLOCK:
            require(parsed[0] < header["blocks"], "block index too large")  # F 5.3
            require(parsed[1] <= header["coefficients"], "too many coefficients")
        if kind == GOP:
            require(header["gop_frames"] > 0, "a GOP in a static stream")  # F 5.4
            require(header["frames"] == 0 or parsed[0] < header["frames"], "GOP index too large")
        last = place
        if kind == HEADER:
            header = parsed
        elif kind == END:  # F 5.5
            require(count == number, "END counts other frames")
            require(int.from_bytes(payload[at:], "little") == zlib.crc32(stream[:offset]), "CRC of the stream is wrong")
        else:
            packets[kind].append(parsed)
    return header, packets


# ---------------------------------------------------------------- M 2 to M 4: the entropy decoder

ONE = 65536
REACH = 2880


def squash_table():
    """M 3.2."""
    scale = 1 << 128
    step = term = scale
    for k in range(1, 20):
        term //= 256 * k
        step += term
    powers = [scale]
    for _ in range(REACH):
        powers.append(powers[-1] * step // scale)
    upper = [(2 * ONE * p + p + scale) // (2 * (p + scale)) for p in powers]
    table = [ONE - upper[x] for x in range(REACH, 0, -1)] + upper[:REACH]
    return [min(max(p, 1), ONE - 1) for p in table]


def stretch_table(squash):
    """M 3.3."""
    upper = []
    for cell in range(2048, 4096):
        centre = 16 * cell + 8
        upper.append(next((x - REACH for x, p in enumerate(squash) if p >= centre), REACH))
    return [-x for x in reversed(upper)] + upper


SQUASH = squash_table()
STRETCH = stretch_table(SQUASH)


class Bank:
    """M 3.1: adaptive probabilities and weights; what was never used has the initial value."""

    def __init__(self, inputs, limit=255, rate=14, probability=ONE // 2, trust=0):
        self.limit, self.rate, self.inputs = limit, rate, inputs
        self.first_slot = probability << 16 | trust
        self.first_weight = ONE // inputs if inputs < 3 else ONE * 5 // (4 * inputs)
        self.slots, self.weights = {}, {}


class Coder:
    """M 2."""

    def __init__(self, payload):
        self.data = payload
        self.low = int.from_bytes(payload[:4].ljust(4, b"\0"), "big")
        self.width = (1 << 32) - 1
        self.position = 4
        require(self.low < self.width, "a payload begins with ff ff ff ff")  # M 2.1

    def overran(self):
        return self.position > len(self.data) + 4  # M 2.6

    def finish(self):
        """M 2.6."""
        if self.overran():
            raise Truncated("an entropy-coded payload ends too early")
        require(self.position >= len(self.data), "bytes are left over in a payload")

    def check(self):
        """Nothing legal comes of reading on behind the end."""
        if self.overran():
            raise Truncated("an entropy-coded payload ends too early")

    def _renormalise(self):
        while self.width < 1 << 24:  # M 2.5
            self.width <<= 8
            byte = self.data[self.position] if self.position < len(self.data) else 0
            self.low = self.low << 8 | byte
            self.position += 1

    def bit(self, probability):
        """M 2.3: probability of a one, out of 65536."""
        bound = self.width * probability >> 16
        if self.low < bound:
            bit, self.width = 1, bound
        else:
            bit, self.width = 0, self.width - bound
            self.low -= bound
        self._renormalise()
        return bit

    def uniform(self, count):
        """M 2.4."""
        if count <= ONE:
            return self._uniform(count)
        high = self._uniform(((count - 1) >> 16) + 1)
        return min(high << 16 | self._uniform(ONE), count - 1)

    def _uniform(self, count):
        unit = self.width // count
        value = min(self.low // unit, count - 1)
        self.low -= value * unit
        self.width = unit if value < count - 1 else self.width - value * unit
        self._renormalise()
        return value

    def mixed(self, bank, contexts, node, weights):
        """M 3.4 to M 3.6: a decision; its slots are contexts + node, its weights the row `weights` + node."""
        self.check()
        row = bank.weights.setdefault(weights + node, [bank.first_weight] * bank.inputs)
        slots = [bank.slots.get(context + node, bank.first_slot) for context in contexts]
        odds = [STRETCH[slot >> 20] for slot in slots]
        total = sum(o * w for o, w in zip(odds, row)) >> 16
        probability = SQUASH[min(max(total, -REACH), REACH - 1) + REACH]
        bit = self.bit(probability)
        error = ((bit << 16) - probability) * bank.rate
        target = bit * ((1 << 22) - 1)
        for i, context in enumerate(contexts):
            row[i] += (odds[i] * error + (1 << 19)) >> 20
            slot = bank.slots.get(context + node, bank.first_slot)  # contexts may coincide: one after the other
            value, count = slot >> 10, slot & 1023
            value += (target - value) * (2 * ONE // (2 * count + 3)) >> 16
            bank.slots[context + node] = (
                value << 10 | min(count + 1, bank.limit) if count < bank.limit else value << 10 | count
            )
        return bit

    def unsigned(self, bank, contexts, unary, node=0):
        """M 4.1."""
        for k in range(unary):
            if not self.mixed(bank, contexts, node + k, 0):
                return k
        size = 0
        while size < 23 and self.mixed(bank, contexts, node + unary + size, 0):
            size += 1
        result = 1
        if size > 0:
            result = 2 | self.mixed(bank, contexts, node + unary + 24, 0)
            if size > 1:
                result = result << (size - 1) | self.uniform(1 << (size - 1))
        return unary + result - 1

    def signed(self, bank, contexts, unary):
        """M 4.2."""
        if not self.mixed(bank, contexts, 0, 0):
            return 0
        negative = self.mixed(bank, contexts, 1, 0)
        magnitude = 1 + self.unsigned(bank, contexts, unary, 2)
        return -magnitude if negative else magnitude


# ---------------------------------------------------------------- M 5: connectivity

LOOP, LONG, DUMMY, WAY, STEPS, COUNTS = (28 * k for k in range(6))  # M 5.3: first nodes of the rare symbols


class Node:
    """M 5.5: a visit of a vertex on the front."""

    def __init__(self, vertex, free):
        self.vertex, self.free, self.apex = vertex, free, vertex
        self.next = self.previous = None


class Conquest:
    """M 5."""

    def __init__(self, payload, vertices, faces):
        self.coder = Coder(payload)
        self.valences = Bank(14, 1023, 16)
        self.events = Bank(3, 1023, 16, ONE - ONE // 500, 30)
        self.rare = Bank(1)
        self.bits = min(max(vertices.bit_length() - 2, 6), 12)  # M 5.8
        degenerate, lonely, surplus, loops = (self.number(COUNTS) for _ in range(4))  # M 5.2
        self.wanted, self.regular = faces - degenerate, vertices - lonely
        self.fans, self.surplus = self.regular + surplus, surplus
        legal = self.wanted >= 0 and self.regular >= 0 and lonely <= 3 * degenerate
        legal = legal and self.fans <= 3 * self.wanted and loops <= 3 * self.wanted
        self.sane(legal, "the counts at its start contradict each other")
        require_limit(self.fans + loops, MOST_VERTICES, "fans")
        self.degenerate, self.dummies, self.total = degenerate, loops, self.fans + loops
        self.faces, self.label, self.sum, self.rank = [], [], [], []
        self.nodes, self.buckets, self.alive = [], [[] for _ in range(8)], 0
        self.turns, self.steps, self.latest = 4 * self.wanted, 65536 + 16 * self.wanted, 0

    def sane(self, condition, problem):
        self.coder.check()
        require(condition, f"a connectivity payload is damaged: {problem}")

    def number(self, kind):
        return self.coder.unsigned(self.rare, [0], 2, kind)

    def rare_bit(self, kind):
        return self.coder.mixed(self.rare, [0], kind, 0)

    # the front

    def make(self, vertex, free):
        node = Node(vertex, free)
        self.nodes.append(node)
        self.alive += 1
        self.buckets[min(free, 7)].append(node)
        return node

    def set_free(self, node, free):
        """M 5.6: a node whose free degree changes goes to the end of its bucket; None closes it."""
        self.buckets[min(node.free, 7)].remove(node)
        node.free = free
        if free is None:
            self.alive -= 1
        else:
            self.sane(free >= 0, "an edge too many at a vertex")
            self.buckets[min(free, 7)].append(node)

    @staticmethod
    def link(a, b):
        a.next, b.previous = b, a

    # the walk

    def run(self):
        while self.alive or len(self.faces) < self.wanted:
            self.turns -= 1
            self.sane(self.turns >= 0, "it does not come to an end")
            first = next((bucket[0] for bucket in self.buckets if bucket), None)
            if first is None:
                self.start()
            elif first.free == 0:
                self.close(first)
            else:
                self.pass_gate(first)
        self.sane(len(self.label) == self.total, "vertices are left over")
        return self.faces

    def start(self):
        """M 5.9."""
        first = len(self.label)
        self.sane(first + 3 <= self.total, "no vertices are left for a component")
        self.contexts = [(i << self.bits) * 16 for i in range(14)]
        corners = []
        for k in range(3):
            valence = self.add_vertex(False)
            corners.append(self.make(first + k, valence - 2))
        for k in range(3):
            self.link(corners[k], corners[(k + 1) % 3])
            self.meet(first + k, first + (k + 1) % 3)
            corners[k].apex = first + (k + 2) % 3
        self.emit(first, first + 1, first + 2)

    def close(self, f):
        """M 5.10."""
        p, n = f.previous, f.next
        self.sane(p is not n, "a polygon of two edges is closed")
        self.emit(n.vertex, f.vertex, p.vertex)
        self.set_free(f, None)
        if n.next is p and p.free == 0 and n.free == 0:
            self.set_free(n, None)
            self.set_free(p, None)
            return
        self.sane(p.free > 0 and n.free > 0, "a vertex is closed too early")
        self.link(p, n)
        p.apex = f.vertex
        self.meet(p.vertex, n.vertex)
        self.set_free(n, n.free - 1)
        self.set_free(p, p.free - 1)

    def pass_gate(self, f):
        """M 5.11."""
        n = f.next
        self.look_around(f)
        usual = self.coder.mixed(self.events, self.event_contexts, 0, 0)
        loop = 0
        if not usual and self.dummies > 0:
            loop = self.rare_bit(DUMMY)
        if not usual and not loop:
            node = self.find_node(f)
            self.sane(node.free is not None and node.free >= 2, "a split at a vertex without room")
            free = self.coder.uniform(node.free - 1)
            vertex, before = node.vertex, node.previous
            other = self.make(vertex, node.free - 2 - free)
            self.set_free(node, free)
            self.link(before, other)
        else:
            vertex = len(self.label)
            valence = self.add_vertex(bool(loop))
            other = node = self.make(vertex, valence - 2)
        self.emit(n.vertex, f.vertex, vertex)
        self.link(f, node)
        self.link(other, n)
        f.apex, other.apex = n.vertex, f.vertex
        self.meet(vertex, f.vertex)
        self.meet(vertex, n.vertex)
        self.set_free(n, n.free - 1)
        self.set_free(f, f.free - 1)

    def add_vertex(self, dummy):
        """M 5.12."""
        self.sane(len(self.label) < self.total, "too many vertices")
        if dummy:
            valence = 2 + self.number(LOOP)
            self.label.append(0)
            self.rank.append(-1)
            self.dummies -= 1
        else:
            self.sane(len(self.label) + self.dummies < self.total, "too many vertices")
            valence = self.valence()
            self.label.append(min(valence, 15))
            self.rank.append(sum(rank >= 0 for rank in self.rank))
            self.latest = self.label[-1]
        self.sum.append(0)
        return valence

    def valence(self):
        """M 5.13."""

        def decide(node):
            return self.coder.mixed(self.valences, self.contexts, node, 0)

        if decide(0):
            return 6
        if decide(1):
            for k in range(3):
                if decide(2 + k):
                    return 5 - k
            return 2
        for valence in range(7, 17):
            if decide(valence - 2):
                return valence
        return 17 + self.number(LONG)

    def find_node(self, f):
        """M 5.14."""
        reach = min(4096, self.steps)
        if self.rare_bit(WAY):
            self.steps -= reach
            return self.nodes[self.coder.uniform(len(self.nodes))]
        backward = self.rare_bit(WAY + 1)
        count = self.number(STEPS)
        a = f if backward else f.next
        for _ in range(reach):
            a = a.previous if backward else a.next
            self.steps -= 1
            if a.free >= 2:
                count -= 1
                if count < 0:
                    return a
        self.sane(False, "a split out of reach")

    def emit(self, a, b, c):
        """M 5.15."""
        self.sane(a != b and b != c and c != a, "a triangle repeats a corner")
        ranks = (self.rank[a], self.rank[b], self.rank[c])
        if min(ranks) >= 0:
            self.sane(len(self.faces) < self.wanted, "too many faces")
            self.faces.append(list(ranks))

    def meet(self, a, b):
        """M 5.7."""
        if self.label[a]:
            self.sum[b] += self.label[a] - 6
        if self.label[b]:
            self.sum[a] += self.label[b] - 6

    def look_around(self, f):
        """M 5.8."""

        def four(value):
            return min(max(value, 0), 15)

        def features(node):
            free = four(node.free)
            return self.label[node.vertex], self.label[node.apex], free, four(self.sum[node.vertex] + 7)

        p, n = f.previous, f.next
        pp, nn = p.previous, n.next
        label_f, apex_f, free_f, sum_f = features(f)
        label_n, apex_n, free_n, sum_n = features(n)
        label_p, apex_p, free_p, sum_p = features(p)
        label_nn, label_pp, label_nnn = (self.label[node.vertex] for node in (nn, pp, nn.next))
        free_nn, free_pp = four(nn.free), four(pp.free)
        known_f, known_n, known_p = four(label_f - free_f), four(label_n - free_n), four(label_p - free_p)
        loops = (label_f == 0) << 2 | (label_n == 0) << 1 | (label_p == 0)

        def packed(*digits):
            value = 0
            for digit in digits:
                value = value << 4 | digit
            return value

        features_of_contexts = [
            0,
            packed(label_f, label_n, apex_f),
            packed(label_f, sum_f),
            packed(label_f, label_n, apex_f, sum_f),
            packed(label_n, apex_f, sum_n),
            packed(label_p, sum_p, apex_p, free_f),
            packed(free_p, free_n, label_p, free_nn),
            packed(loops, free_nn, label_nn),
            packed(loops, free_pp),
            packed(loops, apex_p, known_f, label_p, free_n),
            packed(free_f, free_p, label_f, label_n, label_p),
            packed(label_p, label_nn, known_p, known_n, apex_n, free_pp, label_pp),
            packed(apex_p, sum_n, self.latest, sum_f, free_f, sum_p, free_nn),
            packed(loops, free_nn, apex_f, free_p, free_n, label_nnn, known_n),
        ]
        self.contexts = []
        for i, value in enumerate(features_of_contexts):
            hashed = ((value + 1) * 0x1E3779B97F4A7C15 & (1 << 64) - 1) >> (64 - self.bits)
            self.contexts.append(((i << self.bits) + hashed) * 16)
        self.event_contexts = [packed(free_f, free_n), 4096 + packed(free_f, free_p, free_n), 8192 + loops]


def decode_connectivity(payload, vertices, faces):
    """M 5.1: faces as lists of three vertices."""
    conquest = Conquest(payload, vertices, faces)
    made, count = conquest.run(), conquest.regular
    if conquest.surplus > 0:
        count, vertex = decode_seams(conquest.coder, made, conquest.fans)
        made = [[vertex[fan] for fan in face] for face in made]
    conquest.sane(count == conquest.regular, "a wrong number of vertices")
    for _ in range(conquest.degenerate):  # M 5.19
        corners = []
        for _ in range(3):
            corners.append(conquest.coder.uniform(count + 1))
            count += corners[-1] == count
        conquest.sane(len(set(corners)) < 3, "a degenerate face with three corners")
        made.append(corners)
    conquest.sane(count == vertices, "a wrong number of vertices")
    conquest.coder.finish()
    return made


def decode_seams(coder, faces, fans):
    """M 5.16 to M 5.18: number of vertices, and the vertex of each fan."""
    edges = {}
    for face in faces:
        for k in range(3):
            a, b = face[k], face[(k + 1) % 3]
            edges.setdefault((min(a, b), max(a, b)), []).append((a, b))
    after, before = [-1] * fans, [-1] * fans
    for face in faces:
        for k in range(3):
            a, b = face[k], face[(k + 1) % 3]
            runs = edges[min(a, b), max(a, b)]
            if not (len(runs) == 2 and runs[0] != runs[1]):
                after[a] = b
    for fan, following in enumerate(after):
        if following >= 0:
            before[following] = fan
    vertex, sibling, latest, count = [-1] * fans, [-1] * fans, [], 0
    bank = Bank(1)

    def state(fan):
        return 0 if vertex[fan] < 0 else 1 if sibling[fan] < 0 else 2

    for fan in range(fans):
        context = 0
        if after[fan] >= 0:
            context = 1 + 3 * state(after[fan]) + state(before[fan])
        if coder.mixed(bank, [context], 0, 0):
            found = candidates(fan, vertex, after, before, sibling, latest)
            u = None
            for k, candidate in enumerate(found):
                if coder.mixed(bank, [16 + 2 * k + (len(found) > 1)], 0, 0):
                    u = candidate
                    break
            if u is None:
                require(count > 0, "a repetition of no vertex")
                u = coder.uniform(count)
            sibling[fan] = latest[u]
            latest[u] = fan
        else:
            u = count
            count += 1
            latest.append(fan)
        vertex[fan] = u
    coder.check()
    return count, vertex


def candidates(fan, vertex, after, before, sibling, latest):
    """M 5.18."""
    found = []
    for side in range(2):
        neighbour = after[fan] if side == 0 else before[fan]
        if neighbour < 0 or vertex[neighbour] < 0:
            continue
        other = latest[vertex[neighbour]]
        for _ in range(8):
            for turn in range(2):
                beyond = before[other] if turn == side else after[other]
                if len(found) == 8 or beyond < 0 or vertex[beyond] < 0 or beyond == fan:
                    continue
                if vertex[beyond] != vertex[neighbour] and vertex[beyond] not in found:
                    found.append(vertex[beyond])
            other = sibling[other]
            if other < 0:
                break
    return found


# ---------------------------------------------------------------- M 6: the original order


def decode_order(payload, faces, vertices):
    """M 6.1: the original number of each vertex, and the original faces."""
    coder = Coder(payload)
    vertex_order = decode_permutation(coder, vertices)
    face_order = decode_permutation(coder, len(faces))
    rotations = decode_rotations(coder, len(faces))
    coder.finish()
    renumbered = [[vertex_order[v] for v in face] for face in faces]
    suggested = sorted(range(len(faces)), key=lambda i: sorted(renumbered[i], reverse=True))  # M 6.5
    original = [None] * len(faces)
    for place, i in enumerate(suggested):
        face = renumbered[i]
        first = face.index(min(face)) + rotations[face_order[place]]
        original[face_order[place]] = [face[(first + k) % 3] for k in range(3)]
    return vertex_order, original


def decode_permutation(coder, size):
    """M 6.2, M 6.3."""
    span, bank, left, values = 35, Bank(4), list(range(size)), []
    expected = repeated = last = older = oldest = 0

    def kind(step):
        return min(abs(step).bit_length(), 15) + (0 if step >= 0 else 16)

    for i in range(size):
        rank = sum(v < expected for v in left)
        contexts = [0, 1 + last, 33 + 32 * older + last, 33 + 1024 + 32 * oldest + older]
        contexts = [span * context for context in contexts]
        if coder.mixed(bank, contexts, span - 1, 0):
            step = repeated
        else:
            step = coder.signed(bank, contexts, 6)
        coder.check()
        require(0 <= rank + step < size - i, "not a permutation")
        values.append(left.pop(rank + step))
        expected = values[-1] + 1
        last, older, oldest, repeated = kind(step), last, older, step
    return values


def decode_rotations(coder, size):
    """M 6.4."""
    bank, history, values = Bank(2), 0, []
    for _ in range(size):
        contexts = [3 * (history % 9), 81 + 3 * (history % 27)]
        value = coder.mixed(bank, contexts, 0, 0)
        if value:
            value += coder.mixed(bank, contexts, 1, 0)
        values.append(value)
        history = (3 * history + value) % 81
    return values


# ---------------------------------------------------------------- M 7: graph and labels


def graph_of(faces, size):
    """M 7.1: the neighbours of each vertex, ascending."""
    neighbours = [set() for _ in range(size)]
    for face in faces:
        for k in range(3):
            a, b = face[k], face[(k + 1) % 3]
            if a != b:
                neighbours[a].add(b)
                neighbours[b].add(a)
    return [sorted(row) for row in neighbours]


def decode_labels(payload, graph, parts):
    """M 7.2, M 7.3."""
    coder, bank, labels, used = Coder(payload), Bank(3), [], 0
    for v, row in enumerate(graph):
        known, votes = 0, []  # pairs [label, votes]
        for w in reversed(row):
            if w >= v:
                continue
            known += 1
            pair = next((pair for pair in votes if pair[0] == labels[w]), None)
            if pair:
                pair[1] += 1
            elif len(votes) < 4:
                votes.append([labels[w], 1])
        votes.sort(key=lambda pair: -pair[1])  # stable: the later neighbour first on a draw
        label = None
        for k, (candidate, count) in enumerate(votes):
            contexts = [
                16 * k + min(known, 15),
                80 + 16 * k + min(count, 7) + (8 if len(votes) > k + 1 else 0),
                160 + 16 * k + min(3, known - count) + 4 * min(3, len(votes) - 1),
            ]
            if coder.mixed(bank, contexts, 0, k):
                label = candidate
                break
        if label is None:
            contexts = [64, 80 + 64 + min(len(votes), 4), 160 + 64 + (1 if used < parts else 0)]
            if coder.mixed(bank, contexts, 0, 4) or used == 0:
                label = used
                used += 1
                coder.check()
                require(used <= parts, "too many parts")
            else:
                label = coder.uniform(used)
        labels.append(label)
    coder.finish()
    require(used == parts, "too few parts")
    return labels


# ---------------------------------------------------------------- M 8 to M 11: blocks

LEAF = 16


def sweep(graph, segment, start):
    """M 8.3: distance of every vertex of the segment from `start`, and the order in which they were found."""
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
    """M 8: the vertices part after part, and where each part begins."""
    order, ends = list(range(len(graph))), [len(graph)] * (parts + 1)
    distances = [{}, {}]
    if len(order) > LEAF:  # M 8.2
        last = sweep(graph, order, 0)[1][-1]
        distances[0] = sweep(graph, order, last)[0]
    pending = [(0, len(order), 0, parts, 0)]
    while pending:
        first, last, part, count, kept = pending.pop()
        ends[part] = first
        if count == 1:
            continue
        segment = order[first:last]
        if len(segment) > LEAF:  # M 8.4
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
    """M 9."""
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
    """M 10.1: the parts in the order of the blocks."""
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
        unvisited = unvisited or [part for part in range(parts) if part not in chain]
        chain.append(max(unvisited, key=lambda part: shared[part]))  # the first of equals
    return chain


def grow(graph, core, size):
    """M 10.2."""
    found, seen = list(core), set(core)
    for v in found:  # `found` grows meanwhile
        for w in graph[v]:
            if w not in seen and len(found) < size:
                seen.add(w)
                found.append(w)
    return found


class Block:
    """M 11: vertices in row order, and the block's own graph in row numbers."""

    def __init__(self, graph, found):
        place = {v: r for r, v in enumerate(found)}
        local = [[place[w] for w in graph[v] if w in place] for v in found]
        order = bisect(local, len(found))[0]
        row = {old: new for new, old in enumerate(order)}
        self.vertices = [found[old] for old in order]
        self.graph = [[row[w] for w in local[old]] for old in order]
        self.degrees = np.array([len(r) for r in self.graph], float)
        self.size = len(found)
        self.laplacian = np.diag(self.degrees)  # M 12.1
        for r, neighbours in enumerate(self.graph):
            self.laplacian[r, neighbours] = -1.0


# ---------------------------------------------------------------- M 12, M 13: springs and dictionaries

TETHER = 2.0**-16


class Known:
    """M 12.2: weighted sums of all copies that a chain has decoded."""

    def __init__(self, vertices):
        self.sums, self.weights = np.zeros((vertices, 3)), np.zeros(vertices)

    def add(self, block, positions, weights):
        self.sums[block.vertices] += weights[:, None] * positions
        self.weights[block.vertices] += weights


def surroundings(graph, block, known, stiffness):
    """M 12.3: springs and pulls of each row."""
    springs, pulls, inside = np.zeros(block.size), np.zeros((block.size, 3)), set(block.vertices)
    for r, v in enumerate(block.vertices):
        hooks = [(v, stiffness)] + [(w, 1.0) for w in graph[v] if w not in inside]
        for w, k in hooks:
            if known.weights[w] > 0:
                springs[r] += k
                pulls[r] += k * known.sums[w] / known.weights[w]
    return springs, pulls


def extend(block, springs, pulls):
    """M 12.4."""
    if springs.sum() == 0.0:
        return np.zeros((block.size, 3))
    mean = pulls.sum(axis=0) / springs.sum()
    matrix = block.laplacian + np.diag(springs + TETHER)
    return mean + np.linalg.solve(matrix, pulls - springs[:, None] * mean)


def cosine_columns(rows, first, last):
    """M 13.2."""
    r, j = np.arange(rows)[:, None], np.arange(first, last)[None, :]
    return np.cos(np.pi / (2 * rows) * ((2 * r + 1) * j % (4 * rows)))


def onorm(columns):
    """M 13.1."""
    q, r = np.linalg.qr(columns)
    return q * np.where(np.diag(r) < 0, -1.0, 1.0)


def orthogonal_iterations(block, start, diagonal, power, iterations):
    """M 13.4."""
    matrix, subspace = block.laplacian + np.diag(diagonal), start
    for _ in range(iterations):
        for _ in range(power):
            subspace = np.linalg.solve(matrix, subspace)
        subspace = onorm(subspace)
    return subspace


def exact_basis(block, width, springs):
    """M 13.5."""
    values, vectors = np.linalg.eigh(block.laplacian + np.diag(springs))
    basis, first = [], 0
    while first < width:
        last = first + 1
        while last < block.size and values[last] - values[last - 1] <= 1e-6:
            last += 1
        cluster = vectors[:, first:last]
        basis.append(onorm(cluster @ (cluster.T @ hash_columns(block.size, last - first))))
        first = last
    return np.concatenate(basis, axis=1)[:, :width]


def hash_columns(rows, columns):
    """M 13.6."""

    def entry(row, column):
        z = ((row << 32) + column + 1) * 0x9E3779B97F4A7C15 % 2**64
        z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9 % 2**64
        z = (z ^ z >> 27) * 0x94D049BB133111EB % 2**64
        z ^= z >> 31
        return (z >> 11) * 2.0**-52 - 1.0

    return np.array([[entry(r, j) for j in range(columns)] for r in range(rows)])


# ---------------------------------------------------------------- M 14: coefficients

EXPERIENCE = Path(__file__).parent.parent / "bitstream" / "experience.bin"
EXPERIENCE_SHA256 = "5ca4ed1c21eb1441ecd9903d7e549a16e4c1aefa88b059e482d91b3ea418ea57"
NEIGHBOURS, BINS, NODES, EXPECTATIONS = 20, 48, 36, 3


class Experience:
    """M 14.1: the learnt numbers."""

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


class CoefficientModel:
    """M 14: one for each chain."""

    def __init__(self, width):
        self.experience = Experience()
        self.bank = Bank(EXPECTATIONS, 400, 4)
        slots = enumerate(self.experience.slots)
        self.bank.slots = {k: (s >> 4) << 20 | 1 << 19 | (s & 15) << 2 for k, s in slots}  # M 14.2
        self.bank.weights = {k: [w << 4 for w in row] for k, row in enumerate(self.experience.mixing)}
        self.width, self.blocks = width, 0
        self.now, self.before, self.usual = ([[0, 0, 0] for _ in range(width + 11)] for _ in range(3))  # M 14.3

    def decode(self, payload, count):
        coder = Coder(payload)
        levels = [[0, 0, 0] for _ in range(count)]
        for row in range(count):
            for d in range(3):
                levels[row][d] = self.level(coder, row, d)
                self.now[8 + row][d] = min(abs(levels[row][d]), 1 << 15)
        share = min(self.blocks + 1, 8)  # M 14.7
        for j in range(8, 8 + self.width):
            for d in range(3):
                self.before[j][d] = self.now[j][d]
                self.usual[j][d] += (16 * self.now[j][d] - self.usual[j][d]) // share
                self.now[j][d] = 0
        self.blocks += 1
        coder.finish()
        return levels

    def inputs(self, row, d):
        """M 14.4."""
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

    def level(self, coder, row, d):
        """M 14.5, M 14.6."""
        inputs = self.inputs(row, d)
        kind = d + (3 if self.blocks == 0 else 0)
        contexts = []
        for i in range(EXPECTATIONS):
            total = sum(w * x for w, x in zip(self.experience.expectations[i][kind], inputs)) >> 10
            place = 0
            if total >= 1:
                octave = total.bit_length() - 1
                place = min(3 * octave + ((3 * (total - (1 << octave))) >> octave), BINS - 1)
            contexts.append(NODES * (BINS * i + place))
        weights = 0 if self.blocks == 0 else NODES

        def decide(node):
            return coder.mixed(self.bank, contexts, node, weights)

        size = 0
        while size < 23 and decide(min(size, 13)):
            size += 1
        if size == 0:
            return 0
        result = 1
        if size > 1:
            first = decide(12 + min(size, 9))
            result = 2 | first
            if size > 2:
                result = 2 * result | decide(16 + 2 * min(size, 9) + first)
                if size > 3:
                    result = (result << (size - 3)) + coder.uniform(1 << (size - 3))
        return -result if coder.bit(ONE // 2) else result


def unpack(payload, count, bits):
    """F 6: `count` unsigned numbers."""
    size = (count * bits + 7) // 8
    require(len(payload) <= size, "too many bytes of coefficients")
    if len(payload) < size:
        frame = b"\x28\xb5\x2f\xfd" + payload
        try:
            parameters = zstandard.get_frame_parameters(frame)
            require(parameters.content_size == size and parameters.window_size <= 1 << 23, "zstd frame of another size")
            payload = zstandard.ZstdDecompressor().decompress(frame, max_output_size=size, allow_extra_data=False)
        except zstandard.ZstdError as error:
            raise Corrupt(f"zstd frame is damaged: {error}") from None
        require(len(payload) == size, "zstd frame of another size")
    number = int.from_bytes(payload, "big")
    spare = 8 * size - count * bits
    require(number & ((1 << spare) - 1) == 0, "the bits behind the last coefficient are not 0")
    number >>= spare
    return [number >> bits * (count - 1 - i) & ((1 << bits) - 1) for i in range(count)]


# ---------------------------------------------------------------- M 15, M 16: positions


def smoothing_powers(amount):
    """M 16.3: coefficients of x^2 to x^5, by solving for the values at the four nodes."""
    nodes = np.array([0.4, 0.9, 1.4, 1.8])
    matrix = nodes[:, None] ** np.arange(2, 6)
    return np.linalg.solve(matrix, 1 / (1 + amount * nodes**2) - 1)


def smooth(graph, positions, amount):
    """M 16.2, M 16.4."""
    if amount == 0.0:
        return positions
    walk = np.zeros((len(graph), len(graph)))
    for v, row in enumerate(graph):
        if row:
            walk[v, v] = 1.0
            walk[v, row] = -1.0 / len(row)
    current, result = walk @ positions, positions
    for coefficient in smoothing_powers(amount):
        current = walk @ current
        result = result + coefficient * current
    return result


def check_work(header):
    """M 18.3."""
    rows, columns, blocks = header["block_size"], header["coefficients"], header["blocks"]
    solves = header["power"] * max(header["iterations"], header["key_iterations"])
    if header["basis"] == 1:
        work = 30.0 * blocks * rows**3
    else:
        work = blocks * (200.0 * rows + solves * (40.0 * rows * columns + 8.0 * rows * columns**2))
    require_limit(work, MOST_WORK, "work")


def decode(stream):
    """A static stream: positions, shape (n, 3), and faces, shape (m, 3)."""
    header, packets = parse_stream(stream)
    if header["gop_frames"]:
        raise Unsupported("a sequence")
    check_work(header)
    prediction = header["prediction"]
    require(len(prediction) <= 1 and all(0 < k < 2.0**16 for k in prediction), "illegal prediction")  # M 12.5
    for kind, known in ((CONNECTIVITY, 1), (PARTITION, 0), (ORDER, 1)):
        if packets[kind] and packets[kind][0][0] != known:
            raise Unsupported(f"method {packets[kind][0][0]} in a frame of type {kind}")
    vertices, parts = header["vertices"], header["blocks"]
    faces = decode_connectivity(packets[CONNECTIVITY][0][1], vertices, header["faces"])
    graph = graph_of(faces, vertices)
    if packets[PARTITION]:
        labels = decode_labels(packets[PARTITION][0][1], graph, parts)
    else:
        labels = derive_labels(graph, parts)
    numbers = range(vertices)
    if packets[ORDER]:
        numbers, faces = decode_order(packets[ORDER][0][1], faces, vertices)
    cores = [[v for v in range(vertices) if labels[v] == part] for part in range(parts)]
    require(max(map(len, cores)) <= header["block_size"], "a part is larger than a block")  # M 10.2
    chain = chain_of(graph, labels, parts)
    indices = [index for index, _, _ in packets[BLOCK]]
    require(indices == list(range(parts)), "a block is missing")
    blended = Known(vertices)
    for index, width, payload in packets[BLOCK]:
        length = 1 if header["seeding"] == 1 else header["key_interval"] or parts  # M 15.1
        if index % length == 0:
            model, known, subspace = CoefficientModel(header["coefficients"]), Known(vertices), None
        block = Block(graph, grow(graph, cores[chain[index]], header["block_size"]))
        require(1 <= width <= block.size, "a wrong number of coefficients")  # M 14.8
        if header["coding"] == 0:
            values = unpack(payload, 3 * width, header["bits"])
            levels = np.array(values).reshape(width, 3) - (1 << (header["bits"] - 1))  # M 14.9
        else:
            levels = np.array(model.decode(payload, width))
        springs, pulls = np.zeros(block.size), np.zeros((block.size, 3))
        if prediction:
            springs, pulls = surroundings(graph, block, known, prediction[0])
        if header["basis"] == 1:
            subspace = exact_basis(block, width, springs)
        else:
            follows = subspace is not None and len(subspace) == block.size  # M 13.3
            iterations = header["iterations"] if follows or header["seeding"] == 1 else header["key_iterations"]
            had = subspace.shape[1] if follows else 0
            start = cosine_columns(block.size, had, max(had, width))
            if follows:
                start = np.concatenate([subspace, start], axis=1)[:, :width]
            subspace = orthogonal_iterations(block, start, springs + header["shift"], header["power"], iterations)
        positions = extend(block, springs, pulls) + subspace @ (levels * header["step"])  # M 15.2
        if not np.isfinite(positions).all():
            raise Numeric("positions are not finite")
        known.add(block, positions, np.maximum(block.degrees, 1.0))
        core = set(cores[chain[index]])
        weights = {  # M 16.1
            0: np.maximum(block.degrees, 1.0),
            1: np.ones(block.size),
            2: np.array([float(v in core) for v in block.vertices]),
        }[header["blend"]]
        blended.add(block, positions, weights)
    decoded = smooth(graph, blended.sums / blended.weights[:, None], header["smoothing"])
    decoded = decoded * header["scale"] + np.array(header["center"])  # M 16.5
    if not np.isfinite(decoded).all():
        raise Numeric("positions are not finite")
    arranged = np.empty_like(decoded)
    arranged[list(numbers)] = decoded  # M 6.1
    return arranged, np.array(faces, np.int32).reshape(-1, 3)


def main():
    stream = Path(sys.argv[1]).read_bytes()
    try:
        positions, faces = decode(stream)
    except (Format, Corrupt, Truncated, Unsupported, Limit, Numeric) as error:
        print(f"{type(error).__name__.lower()}: {error}", file=sys.stderr)
        return error.code
    np.savez_compressed(sys.argv[2], positions=positions, faces=faces)
    return 0


if __name__ == "__main__":
    sys.exit(main())
