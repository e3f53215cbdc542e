"""A decoder of connectivity, order and partition, written from C alone: slow, plain, easy to compare.

It shares no code with the product. Docstrings and comments name the rules that they implement.

    1  Errors
    2  The entropy decoder          (rules 1 to 3)
    3  Connectivity, method 1       (rules 4 to 8)
    4  Order, method 1              (rules 9)
    5  Partition, method 0          (rules 10)
"""

from __future__ import annotations

import heapq
from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NoReturn

Face = list[int]


# ---------------------------------------------------------------------------------------------------------------------
# 1  Errors
# ---------------------------------------------------------------------------------------------------------------------


class CorruptError(Exception):
    """Contradicts the documents or itself."""


class TruncatedError(Exception):
    """The data ends too early."""


class LimitError(Exception):
    """Asks for more than the caller granted."""


# ---------------------------------------------------------------------------------------------------------------------
# 2  The entropy decoder
# ---------------------------------------------------------------------------------------------------------------------


def make_squash() -> list[int]:
    """2.1: squash(x) for x = -2880 .. 2879."""
    one = 1 << 128
    term = step = one
    for k in range(1, 20):
        term //= 256 * k
        step += term
    upper, power = [], one
    for _ in range(2881):
        upper.append((2 * 65536 * power + power + one) // (2 * (power + one)))
        power = power * step // one
    table = [65536 - upper[-x] if x < 0 else upper[x] for x in range(-2880, 2880)]
    return [min(max(value, 1), 65535) for value in table]


SQUASH = make_squash()


def make_stretch() -> list[int]:
    """2.2: stretch(j) for j = 0 .. 4095."""
    upper, x = [], -2880
    for j in range(2048, 4096):
        while SQUASH[x + 2880] < 16 * j + 8:
            x += 1
        upper.append(x)
    return [-value for value in reversed(upper)] + upper


STRETCH = make_stretch()


class RangeDecoder:
    """1: decisions out of a payload."""

    def __init__(self, payload: bytes) -> None:
        """1.1."""
        self.payload = payload
        self.taken = 4
        self.low = int.from_bytes(payload[:4].ljust(4, b"\0"), "big")
        self.range = 2**32 - 1
        if self.low == self.range:
            raise CorruptError("a payload begins with four bytes of 255")

    def bit(self, probability: int) -> int:
        """1.2: one decision; the probability of a one is out of 65536."""
        bound = self.range * probability // 65536
        bit = 1 if self.low < bound else 0
        if bit == 1:
            self.range = bound
        else:
            self.low -= bound
            self.range -= bound
        self.renormalise()
        return bit

    def renormalise(self) -> None:
        """1.3."""
        while self.range < 1 << 24:
            self.range *= 256
            self.low = 256 * self.low + (self.payload[self.taken] if self.taken < len(self.payload) else 0)
            self.taken += 1

    def uniform(self, count: int) -> int:
        """1.4: a number below `count`."""
        if count <= 65536:
            return self.short_uniform(count)
        high = self.short_uniform((count - 1) // 65536 + 1)
        return min(65536 * high + self.short_uniform(65536), count - 1)

    def short_uniform(self, count: int) -> int:
        """1.4, for a count of at most 65536."""
        unit = self.range // count
        value = min(self.low // unit, count - 1)
        self.low -= value * unit
        self.range = unit if value < count - 1 else self.range - value * unit
        self.renormalise()
        return value

    def overran(self) -> bool:
        """1.5: whether more was taken than a payload of this length can hold."""
        return self.taken > len(self.payload) + 4

    def finish(self) -> None:
        """1.5: to be called behind the last symbol."""
        if self.overran() or self.taken < len(self.payload):
            self.fail("bytes are left over")

    def fail(self, problem: str) -> NoReturn:
        """1.6."""
        if self.overran():
            raise TruncatedError("a payload ends too early")
        raise CorruptError(problem)


class Model:
    """2.3: slots and weights, made when they are first used."""

    def __init__(self, inputs: int, limit: int = 255, rate: int = 14, first: tuple[int, int] = (1 << 21, 0)) -> None:
        self.limit, self.rate, self.first = limit, rate, first
        self.first_weight = {1: 65536, 2: 32768, 3: 27306, 4: 20480, 5: 16384, 6: 13653, 14: 5851}[inputs]
        self.slots: dict[tuple[int, int, int], tuple[int, int]] = {}
        self.weights: dict[tuple[int, int], int] = {}

    def bit(self, decoder: RangeDecoder, contexts: Sequence[int], node: int) -> int:
        """2.4 to 2.6: predict a decision, decode it, learn from it."""
        places = [(i, context, node) for i, context in enumerate(contexts)]
        slots = [self.slots.get(place, self.first) for place in places]
        stretched = [STRETCH[value >> 10] for value, _ in slots]  # 2.4
        weights = [self.weights.get((i, node), self.first_weight) for i in range(len(contexts))]
        total = sum(s * w for s, w in zip(stretched, weights)) >> 16
        probability = SQUASH[min(max(total, -2880), 2879) + 2880]
        bit = decoder.bit(probability)
        error = (65536 * bit - probability) * self.rate  # 2.5
        for i, (s, w) in enumerate(zip(stretched, weights)):
            self.weights[i, node] = wrap(w + ((s * error + (1 << 19)) >> 20))
        target = (1 << 22) - 1 if bit == 1 else 0  # 2.6
        for place, (value, count) in zip(places, slots):
            value += ((target - value) * (131072 // (2 * count + 3))) >> 16
            self.slots[place] = value, min(count + 1, self.limit)
        return bit


def wrap(value: int) -> int:
    """2.5: to 32 bits, two's complement."""
    return (value + (1 << 31)) % (1 << 32) - (1 << 31)


def read_unsigned(decoder: RangeDecoder, model: Model, contexts: Sequence[int], unary: int, node: int) -> int:
    """3.1."""
    for k in range(unary):
        if model.bit(decoder, contexts, node + k) == 0:
            return k
    size = 0
    while size < 23 and model.bit(decoder, contexts, node + unary + size) == 1:
        size += 1
    rest = 1
    if size > 0:
        rest = 2 + model.bit(decoder, contexts, node + unary + 24)
    if size > 1:
        rest = (rest << (size - 1)) + decoder.uniform(1 << (size - 1))
    return unary + rest - 1


def read_signed(decoder: RangeDecoder, model: Model, contexts: Sequence[int], unary: int) -> int:
    """3.2."""
    if model.bit(decoder, contexts, 0) == 0:
        return 0
    negative = model.bit(decoder, contexts, 1)
    magnitude = 1 + read_unsigned(decoder, model, contexts, unary, 2)
    return -magnitude if negative == 1 else magnitude


# ---------------------------------------------------------------------------------------------------------------------
# 3  Connectivity, method 1
# ---------------------------------------------------------------------------------------------------------------------

LOOP, VALENCE, DUMMY, NUMBERED, BACKWARD, SKIPPED, COUNTS = 0, 28, 56, 84, 85, 112, 140
"""4.1: first node of each kind of rare symbol."""


def decode_connectivity(payload: bytes, vertices: int, faces: int, most: int = 1 << 24) -> list[Face]:
    """4: `faces` triangles of `vertices` vertices; `most` is the limit for vertices."""
    decoder, rare = RangeDecoder(payload), Model(inputs=1)
    degenerate, lonely, surplus, dummies = (read_unsigned(decoder, rare, (0,), 2, COUNTS) for _ in range(4))  # 4.2
    proper, regular = faces - degenerate, vertices - lonely
    fans = regular + surplus
    if proper < 0 or regular < 0 or lonely > 3 * degenerate or fans > 3 * proper or dummies > 3 * proper:  # 4.3
        decoder.fail("the counts contradict each other")
    if fans + dummies > most:  # 4.3
        raise LimitError(f"{fans + dummies} vertices are over the limit")
    result = Conquest(decoder, rare, vertices, proper, fans, dummies).run()  # 4.4
    if surplus > 0:
        vertex_of = read_seams(decoder, result, fans)
        if max(vertex_of) + 1 != regular:  # 7.5
            decoder.fail("the fans do not make as many vertices as the counts say")
        result = [[vertex_of[fan] for fan in face] for face in result]
    result += read_degenerate(decoder, degenerate, regular, vertices)
    decoder.finish()
    return result


@dataclass(eq=False)
class Vertex:
    """5.1: a vertex of the closed surface; the rank of a dummy is -1."""

    label: int
    rank: int
    sum: int = 0


class Node:
    """5.2: a place on the front."""

    next: Node
    previous: Node

    def __init__(self, number: int, vertex: Vertex) -> None:
        self.number, self.vertex, self.apex = number, vertex, vertex
        self.free = self.stamp = 0
        self.alive = True


class Conquest:
    """5 and 6: triangle by triangle over the closed surface."""

    def __init__(self, decoder: RangeDecoder, rare: Model, vertices: int, faces: int, fans: int, dummies: int) -> None:
        self.decoder, self.rare = decoder, rare
        self.valence = Model(inputs=14, limit=1023, rate=16)
        self.event = Model(inputs=3, limit=1023, rate=16, first=(65405 << 6, 30))
        self.contexts: Sequence[int] = ()
        self.hash_bits = min(max(vertices.bit_length() - 2, 6), 12)  # 6.10
        self.face_count, self.fan_count, self.dummies_left = faces, fans, dummies
        self.triangles_left = 4 * faces  # 6.2
        self.steps_left = 65536 + 16 * faces  # 6.8
        self.faces: list[Face] = []
        self.fans = 0
        self.latest = 0  # label of the latest fan
        self.nodes: list[Node] = []
        self.alive = 0
        self.stamps = 0
        self.queue: list[tuple[int, int, int]] = []  # bucket, stamp and number of nodes, some of them outdated

    def run(self) -> list[Face]:
        """6.1 to the end, and 6.12."""
        while self.alive > 0 or len(self.faces) < self.face_count:
            self.repeat()
        if self.fans < self.fan_count or self.dummies_left > 0:
            self.decoder.fail("there are too few vertices")
        return self.faces

    def repeat(self) -> None:
        """6.1 and 6.2, once."""
        self.triangles_left -= 1
        if self.triangles_left < 0 or self.decoder.overran():
            self.decoder.fail("there are too many triangles")
        if self.alive == 0:
            self.start_component()
        elif (f := self.first_node()).free == 0:
            self.close_node(f)
        else:
            self.pass_gate(f)

    # The front

    def add_node(self, vertex: Vertex, free: int) -> Node:
        """5.2."""
        node = Node(len(self.nodes), vertex)
        self.nodes.append(node)
        self.alive += 1
        self.set_free(node, free)
        return node

    def set_free(self, node: Node, free: int) -> None:
        """5.4: the stamp is the number of times that any free degree was set before."""
        node.free, node.stamp = free, self.stamps
        self.stamps += 1
        heapq.heappush(self.queue, (min(free, 7), node.stamp, node.number))

    def remove_nodes(self, *nodes: Node) -> None:
        """5.2."""
        for node in nodes:
            node.alive = False
            self.alive -= 1

    def first_node(self) -> Node:
        """5.4."""
        while True:
            _, stamp, number = self.queue[0]
            node = self.nodes[number]
            if node.alive and node.stamp == stamp:
                return node
            heapq.heappop(self.queue)

    # Triangles

    def start_component(self) -> None:
        """6.3."""
        self.contexts = (0,) * 14
        nodes = []
        for _ in range(3):
            vertex, valence = self.add_fan()
            nodes.append(self.add_node(vertex, valence - 2))
        for k in range(3):
            link(nodes[k], nodes[(k + 1) % 3])
            nodes[k].apex = nodes[(k + 2) % 3].vertex
            meet(nodes[k].vertex, nodes[(k + 1) % 3].vertex)
        self.emit(*(node.vertex for node in nodes))

    def close_node(self, f: Node) -> None:
        """6.4."""
        p, n = f.previous, f.next
        if p is n:
            self.decoder.fail("a polygon of two nodes cannot be closed")
        self.emit(n.vertex, f.vertex, p.vertex)
        if n.next is p and p.free == 0 and n.free == 0:
            self.remove_nodes(f, n, p)
            return
        if p.free == 0 or n.free == 0:
            self.decoder.fail("a vertex has more edges than its valence")
        self.remove_nodes(f)
        link(p, n)
        p.apex = f.vertex
        meet(p.vertex, n.vertex)
        self.set_free(n, n.free - 1)
        self.set_free(p, p.free - 1)

    def pass_gate(self, f: Node) -> None:
        """6.5 to 6.7."""
        n = f.next
        usual = self.event.bit(self.decoder, self.look_around(f), 0)  # 6.5
        dummy = usual == 0 and self.dummies_left > 0 and self.rare.bit(self.decoder, (0,), DUMMY) == 1
        if usual == 1 or dummy:  # 6.6
            vertex, valence = self.add_dummy() if dummy else self.add_fan()
            node = other = self.add_node(vertex, valence - 2)
        else:  # 6.7
            node = self.find_node(f)
            vertex = node.vertex
            if not node.alive or node.free < 2:
                self.decoder.fail("a triangle does not fit between the edges of a vertex")
            free = self.decoder.uniform(node.free - 1)
            other = self.add_node(vertex, node.free - 2 - free)
            self.set_free(node, free)
            link(node.previous, other)
        self.emit(n.vertex, f.vertex, vertex)
        link(f, node)
        link(other, n)
        f.apex, other.apex = n.vertex, f.vertex
        meet(vertex, f.vertex)
        meet(vertex, n.vertex)
        self.set_free(n, n.free - 1)
        self.set_free(f, f.free - 1)

    def find_node(self, f: Node) -> Node:
        """6.8."""
        reach = min(4096, self.steps_left)
        if self.rare.bit(self.decoder, (0,), NUMBERED) == 1:
            self.steps_left -= reach
            return self.nodes[self.decoder.uniform(len(self.nodes))]
        backward = self.rare.bit(self.decoder, (0,), BACKWARD) == 1
        skipped = read_unsigned(self.decoder, self.rare, (0,), 2, SKIPPED)
        node = f if backward else f.next
        for _ in range(reach):
            node = node.previous if backward else node.next
            self.steps_left -= 1
            if node.free >= 2:
                if skipped == 0:
                    return node
                skipped -= 1
        self.decoder.fail("a third vertex is too far away")

    def add_fan(self) -> tuple[Vertex, int]:
        """6.9: a vertex of the mesh and its valence."""
        if self.fans == self.fan_count:
            self.decoder.fail("there are too many vertices")
        valence = self.read_valence()
        self.latest = min(valence, 15)
        self.fans += 1
        return Vertex(self.latest, self.fans - 1), valence

    def add_dummy(self) -> tuple[Vertex, int]:
        """6.6: the vertex that closes a boundary loop, and its valence."""
        self.dummies_left -= 1
        return Vertex(0, -1), 2 + read_unsigned(self.decoder, self.rare, (0,), 2, LOOP)

    def read_valence(self) -> int:
        """6.9."""
        if self.valence.bit(self.decoder, self.contexts, 0) == 1:
            return 6
        if self.valence.bit(self.decoder, self.contexts, 1) == 1:
            for valence in (5, 4, 3):
                if self.valence.bit(self.decoder, self.contexts, 7 - valence) == 1:
                    return valence
            return 2
        for valence in range(7, 17):
            if self.valence.bit(self.decoder, self.contexts, valence - 2) == 1:
                return valence
        return 17 + read_unsigned(self.decoder, self.rare, (0,), 2, VALENCE)

    def emit(self, a: Vertex, b: Vertex, c: Vertex) -> None:
        """5.5."""
        if a is b or b is c or c is a:
            self.decoder.fail("a triangle repeats a corner")
        if min(a.rank, b.rank, c.rank) >= 0:
            if len(self.faces) == self.face_count:
                self.decoder.fail("there are too many faces")
            self.faces.append([a.rank, b.rank, c.rank])

    def look_around(self, f: Node) -> tuple[int, int, int]:
        """6.10: set the contexts of the valence, return those of the event."""
        n, p = f.next, f.previous
        nn, pp, nnn = n.next, p.previous, n.next.next
        lf, ln, lp, lnn, lpp, lnnn = (node.vertex.label for node in (f, n, p, nn, pp, nnn))
        af, an, ap = (node.apex.label for node in (f, n, p))
        ff, fn, fp, fnn, fpp = (nibble(node.free) for node in (f, n, p, nn, pp))
        sf, sn, sp = (nibble(node.vertex.sum + 7) for node in (f, n, p))
        kf, kn, kp = nibble(lf - ff), nibble(ln - fn), nibble(lp - fp)
        b = 4 * (lf == 0) + 2 * (ln == 0) + (lp == 0)
        self.contexts = [
            self.hash(0),
            self.hash(lf, ln, af),
            self.hash(lf, sf),
            self.hash(lf, ln, af, sf),
            self.hash(ln, af, sn),
            self.hash(lp, sp, ap, ff),
            self.hash(fp, fn, lp, fnn),
            self.hash(b, fnn, lnn),
            self.hash(b, fpp),
            self.hash(b, ap, kf, lp, fn),
            self.hash(ff, fp, lf, ln, lp),
            self.hash(lp, lnn, kp, kn, an, fpp, lpp),
            self.hash(ap, sn, self.latest, sf, ff, sp, fnn),
            self.hash(b, fnn, af, fp, fn, lnnn, kn),
        ]
        return 16 * ff + fn, 256 * ff + 16 * fp + fn, b

    def hash(self, *digits: int) -> int:
        """6.11."""
        number = 0
        for digit in digits:
            number = 16 * number + digit
        return ((number + 1) * 0x1E3779B97F4A7C15 % 2**64) >> (64 - self.hash_bits)


def nibble(value: int) -> int:
    """6.10: the nearest of 0 .. 15."""
    return min(max(value, 0), 15)


def link(node: Node, following: Node) -> None:
    """5.3."""
    node.next, following.previous = following, node


def meet(a: Vertex, b: Vertex) -> None:
    """5.6."""
    if a.label != 0:
        b.sum += a.label - 6
    if b.label != 0:
        a.sum += b.label - 6


def read_seams(decoder: RangeDecoder, faces: list[Face], fans: int) -> list[int]:
    """7: the vertex of each fan."""
    after, before = find_borders(faces, fans)
    model = Model(inputs=1)
    vertex, earlier = [-1] * fans, [-1] * fans  # earlier: the latest fan of the same vertex before this one
    latest: list[int] = []  # the latest fan of each vertex

    def state(fan: int) -> int:
        """7.2."""
        if fan < 0 or vertex[fan] < 0:
            return 0
        return 1 if earlier[fan] < 0 else 2

    def candidates(fan: int) -> list[int]:
        """7.4."""
        found: list[int] = []
        for neighbour, ways in ((after[fan], (before, after)), (before[fan], (after, before))):
            if neighbour < 0 or vertex[neighbour] < 0:
                continue
            other = latest[vertex[neighbour]]
            for _ in range(8):
                for way in ways:
                    u = vertex[way[other]] if way[other] >= 0 else -1
                    if u >= 0 and u != vertex[neighbour] and u not in found:
                        found.append(u)
                other = earlier[other]
                if other < 0:
                    break
        return found[:8]

    def read_vertex(fan: int) -> int:
        """7.3."""
        found = candidates(fan)
        for k, u in enumerate(found):
            if model.bit(decoder, (16 + 2 * k + (len(found) > 1),), 0) == 1:
                return u
        return decoder.uniform(len(latest))

    for fan in range(fans):
        if decoder.overran():
            decoder.fail("")
        context = 1 + 3 * state(after[fan]) + state(before[fan]) if after[fan] >= 0 else 0
        if model.bit(decoder, (context,), 0) == 1 and latest:
            vertex[fan] = read_vertex(fan)
            earlier[fan] = latest[vertex[fan]]
            latest[vertex[fan]] = fan
        else:
            vertex[fan] = len(latest)
            latest.append(fan)
    return vertex


def find_borders(faces: list[Face], fans: int) -> tuple[list[int], list[int]]:
    """7.1: the fans after and before each fan along the boundary, -1 inside."""
    edges = [(face[k], face[(k + 1) % 3]) for face in faces for k in range(3)]
    directions: dict[frozenset[int], list[tuple[int, int]]] = {}
    for edge in edges:
        directions.setdefault(frozenset(edge), []).append(edge)
    after, before = [-1] * fans, [-1] * fans
    for a, b in edges:
        both = directions[frozenset((a, b))]
        if len(both) != 2 or both[0] == both[1]:
            after[a] = b
    for fan, following in enumerate(after):
        if following >= 0:
            before[following] = fan
    return after, before


def read_degenerate(decoder: RangeDecoder, count: int, known: int, vertices: int) -> list[Face]:
    """8.1 to 8.3: `count` faces that repeat a corner."""
    faces = []
    for _ in range(count):
        face = []
        for _ in range(3):
            face.append(decoder.uniform(known + 1))
            known += 1 if face[-1] == known else 0
        if decoder.overran() or len(set(face)) == 3:
            decoder.fail("a degenerate face has three different corners")
        faces.append(face)
    if known != vertices:
        decoder.fail("the faces do not have the vertices that they should")
    return faces


# ---------------------------------------------------------------------------------------------------------------------
# 4  Order
# ---------------------------------------------------------------------------------------------------------------------


def decode_arrangement(payload: bytes, faces: list[Face], vertices: int) -> tuple[list[int], list[Face]]:
    """9: the original number of each vertex, and the original faces; of a payload that ends there."""
    decoder = RangeDecoder(payload)
    numbers, original, _ = arrange(decoder, faces, vertices)
    decoder.finish()
    return numbers, original


def arrange(decoder: RangeDecoder, faces: list[Face], vertices: int) -> tuple[list[int], list[Face], list[Face]]:
    """9: the same, and which decoded corner each original one is; corner k of face f is 3 f + k."""
    numbers = read_permutation(decoder, vertices)  # 9.1
    places = read_permutation(decoder, len(faces))
    rotations = read_rotations(decoder, len(faces))
    renumbered = [[numbers[corner] for corner in face] for face in faces]  # 9.5
    suggested = sorted(range(len(faces)), key=lambda f: sorted(renumbered[f], reverse=True))
    original: list[Face] = [[]] * len(faces)
    corners: list[Face] = [[]] * len(faces)
    for place, f in zip(places, suggested):  # 9.6
        face = renumbered[f]
        first = (face.index(min(face)) + rotations[place]) % 3
        original[place] = face[first:] + face[:first]
        corners[place] = [3 * f + (first + i) % 3 for i in range(3)]
    return numbers, original, corners


def read_permutation(decoder: RangeDecoder, size: int) -> list[int]:
    """9.2 and 9.3."""
    model = Model(inputs=4)
    unused = list(range(size))
    result: list[int] = []
    expected = step = 0
    a = b = c = 0  # classes of the last step, of the one before it, of the one before that
    for _ in range(size):
        if decoder.overran():
            decoder.fail("")
        rank = bisect_left(unused, expected)
        contexts = (0, a, 32 * b + a, 32 * c + b)
        if model.bit(decoder, contexts, 34) == 0:
            step = read_signed(decoder, model, contexts, 6)
        if not 0 <= rank + step < len(unused):
            decoder.fail("a permutation steps out of what is left")
        result.append(unused.pop(rank + step))
        expected = result[-1] + 1
        a, b, c = min(abs(step).bit_length(), 15) + (16 if step < 0 else 0), a, b
    return result


def read_rotations(decoder: RangeDecoder, size: int) -> list[int]:
    """9.4."""
    model = Model(inputs=2)
    result: list[int] = []
    a = b = c = 0  # the last value, the one before it, the one before that
    for _ in range(size):
        if decoder.overran():
            decoder.fail("")
        contexts = (3 * b + a, 9 * c + 3 * b + a)
        value = model.bit(decoder, contexts, 0)
        if value == 1:
            value += model.bit(decoder, contexts, 1)
        result.append(value)
        a, b, c = value, a, b
    return result


# ---------------------------------------------------------------------------------------------------------------------
# 5  Partition, method 0
# ---------------------------------------------------------------------------------------------------------------------


def neighbours_of(faces: list[Face], vertices: int) -> list[list[int]]:
    """10.1: the neighbours of each vertex, ascending."""
    found: list[set[int]] = [set() for _ in range(vertices)]
    for face in faces:
        for a in face:
            found[a].update(b for b in face if b != a)
    return [sorted(row) for row in found]


def decode_labels(payload: bytes, neighbours: list[list[int]], parts: int) -> list[int]:
    """10: the part of each vertex."""
    decoder, model = RangeDecoder(payload), Model(inputs=3)
    labels: list[int] = []
    used = 0
    for v, row in enumerate(neighbours):
        if decoder.overran():
            decoder.fail("")
        near = [labels[w] for w in reversed(row) if w < v]
        label = read_label(decoder, model, near, used, parts)
        if label == used:
            used += 1
            if used > parts:  # 10.6
                decoder.fail("there are more parts than the header says")
        labels.append(label)
    decoder.finish()
    if used != parts:  # 10.6
        raise CorruptError("there are fewer parts than the header says")
    return labels


def read_label(decoder: RangeDecoder, model: Model, near: list[int], used: int, parts: int) -> int:
    """10.2 to 10.5: one label, from those `near`, the largest neighbour's first."""
    first = list(dict.fromkeys(near))[:4]  # 10.2
    candidates = sorted(first, key=lambda label: -near.count(label))
    found = len(candidates)
    for k, label in enumerate(candidates):  # 10.3
        votes = near.count(label)
        contexts = (
            min(len(near), 15),
            min(votes, 7) + (8 if found > k + 1 else 0),
            min(len(near) - votes, 3) + 4 * (found - 1),
        )
        if model.bit(decoder, contexts, k) == 1:
            return label
    if model.bit(decoder, (0, found, 1 if used < parts else 0), 4) == 1 or used == 0:  # 10.4
        return used
    return decoder.uniform(used)  # 10.5
