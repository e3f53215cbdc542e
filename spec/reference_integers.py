"""The integers of a mesh, written from C and V of the law alone: the entropy coder, faces, grids, levels of refinement.

Slow, plain, easy to compare: the rules stand beside what follows them.
"""

import collections
import hashlib
import heapq
import math
import struct
from bisect import bisect_left
from collections import OrderedDict, namedtuple

# F 1: the errors that a decoder tells apart
ERRORS = (
    "FormatError",
    "CorruptError",
    "UnsupportedError",
    "LimitError",
    "NumericError",
    "TruncatedError",
)
ERRORS = [type(name, (Exception,), {}) for name in ERRORS]
FormatError, CorruptError, UnsupportedError, LimitError, NumericError, TruncatedError = ERRORS


def clamp(x, low, high):  # F 1.4
    return low if x < low else high if x > high else x


def rounded(a, n):  # F 1.4: round(a / n)
    return (a + n // 2) // n if a >= 0 else -((-a + n // 2) // n)


def div(a, b):  # F 1.4: towards zero
    return abs(a) // abs(b) * (1 if (a >= 0) == (b >= 0) else -1)


# ---------------------------------------------------------------- C 1 to C 3: the entropy coder


# C 2.1 for x = -2880 .. 2879, C 2.2 for j = 0 .. 4095
SQUASH = [
    clamp(math.floor(65536 / (1 + math.exp(-x / 256)) + 0.5), 1, 65535) for x in range(-2880, 2880)
]
UPPER = [bisect_left(SQUASH, 16 * j + 8) - 2880 for j in range(2048, 4096)]
STRETCH = [-x for x in reversed(UPPER)] + UPPER


class RangeDecoder:  # C 1: decisions out of a payload
    def __init__(self, payload):  # C 1.1
        self.payload, self.taken, self.range = payload, 4, 2**32 - 1
        self.low = int.from_bytes(payload[:4].ljust(4, b"\0"), "big")
        if self.low == self.range:
            raise CorruptError("a payload begins with four bytes of 255")

    def bit(self, probability):  # C 1.2: that of a one is out of 65536
        bound = self.range * probability // 65536
        bit = int(self.low < bound)
        if bit:
            self.range = bound
        else:
            self.low -= bound
            self.range -= bound
        self.renormalize()
        return bit

    def renormalize(self):  # C 1.3
        while self.range < 1 << 24:
            self.range *= 256
            self.low = 256 * self.low + (
                self.payload[self.taken] if self.taken < len(self.payload) else 0
            )
            self.taken += 1

    def uniform(self, count):  # C 1.4: a number below `count`
        if count <= 65536:
            return self.short_uniform(count)
        high = self.short_uniform((count - 1) // 65536 + 1)
        return min(65536 * high + self.short_uniform(65536), count - 1)

    def short_uniform(self, count):  # C 1.4, for a count of at most 65536
        unit = self.range // count
        value = min(self.low // unit, count - 1)
        self.low -= value * unit
        self.range = unit if value < count - 1 else self.range - value * unit
        self.renormalize()
        return value

    def overran(self):  # C 1.5: whether more was taken than a payload of this length can hold
        return self.taken > len(self.payload) + 4

    def finish(self):  # C 1.5: behind the last symbol
        if self.overran() or self.taken < len(self.payload):
            self.fail("bytes are left over")

    def fail(self, problem):  # C 1.6
        raise (
            TruncatedError("a payload ends too early") if self.overran() else CorruptError(problem)
        )


class Model:  # C 2.3: slots and weights, made when they are first used
    def __init__(self, inputs, limit=255, rate=14, first=(1 << 21, 0)):
        self.limit, self.rate, self.first, self.slots, self.weights = limit, rate, first, {}, {}
        self.first_weight = {1: 65536, 2: 32768, 3: 27306, 4: 20480, 5: 16384, 6: 13653, 14: 5851}[
            inputs
        ]

    # C 2.4 to C 2.6: predict a decision, decode it, learn from it.
    def bit(self, decoder, contexts, node):
        places = [(i, context, node) for i, context in enumerate(contexts)]
        # C 2.4.
        stretched = [STRETCH[self.slots.get(place, self.first)[0] >> 10] for place in places]
        weights = [self.weights.get((i, node), self.first_weight) for i in range(len(contexts))]
        total = sum(s * w for s, w in zip(stretched, weights)) >> 16
        probability = SQUASH[clamp(total, -2880, 2879) + 2880]
        bit = decoder.bit(probability)
        error = (65536 * bit - probability) * self.rate  # C 2.5
        for i, (s, w) in enumerate(zip(stretched, weights)):
            self.weights[i, node] = wrap(w + ((s * error + (1 << 19)) >> 20))
        for place in places:
            self.slots[place] = learn_slot(self.slots.get(place, self.first), bit, self.limit)
        return bit


def wrap(value):  # C 2.5: to 32 bits, two's complement
    return (value + (1 << 31)) % (1 << 32) - (1 << 31)


def learn_slot(slot, bit, limit):  # C 2.6
    value, count = slot
    target = (1 << 22) - 1 if bit else 0
    return value + (((target - value) * (131072 // (2 * count + 3))) >> 16), min(count + 1, limit)


def read_unsigned(decoder, model, contexts, unary, node):  # C 3.1
    for k in range(unary):
        if not model.bit(decoder, contexts, node + k):
            return k
    size = 0
    while size < 23 and model.bit(decoder, contexts, node + unary + size):
        size += 1
    rest = 2 + model.bit(decoder, contexts, node + unary + 24) if size > 0 else 1
    if size > 1:
        rest = (rest << (size - 1)) + decoder.uniform(1 << (size - 1))
    return unary + rest - 1


# ---------------------------------------------------------------- C 4 to C 8: faces

LOOP, VALENCE, DUMMY, NUMBERED, BACKWARD, SKIPPED, COUNTS = 0, 28, 56, 84, 85, 112, 140  # C 4.1


def decode_connectivity(payload, vertices, faces, most=1 << 24, repeats=0):
    """C 4: `faces` triangles of `vertices` vertices; `most` is the limit for vertices, `repeats` as in the header."""
    decoder, rare = RangeDecoder(payload), Model(inputs=1)
    # C 4.2.
    degenerate, lonely, surplus, dummies = (
        read_unsigned(decoder, rare, (0,), 2, COUNTS) for _ in range(4)
    )
    proper, regular = faces - degenerate, vertices - lonely
    fans = regular + surplus
    # C 4.3.
    if (
        proper < 0
        or regular < 0
        or lonely > 3 * degenerate
        or fans > 3 * proper
        or dummies > 3 * proper
    ):
        decoder.fail("the counts contradict each other")
    if fans + dummies > most:
        raise LimitError(f"{fans + dummies} vertices are over the limit")
    result = Conquest(decoder, rare, vertices, proper, fans, dummies).run()  # C 4.4
    if surplus > 0:
        vertex_of = read_seams(decoder, result, fans)
        if max(vertex_of) + 1 != regular:  # C 7.5
            decoder.fail("the fans do not make as many vertices as the counts say")
        result = [[vertex_of[fan] for fan in face] for face in result]
    if repeats:
        on_edges = read_on_edges(decoder, rare, result, degenerate)
        result, degenerate = result + on_edges, degenerate - len(on_edges)
    result += read_degenerate(decoder, degenerate, regular, vertices)
    decoder.finish()
    return result


class Vertex:  # C 5.1: a vertex of the closed surface; the rank of a dummy is -1
    def __init__(self, label, rank):
        self.label, self.rank, self.sum = label, rank, 0


class Node:  # C 5.2: a place on the front
    def __init__(self, number, vertex):
        self.number, self.vertex, self.apex, self.alive = number, vertex, vertex, True
        self.next = self.previous = self
        self.free = self.stamp = 0


class Conquest:  # C 5 and C 6: triangle by triangle over the closed surface
    def __init__(self, decoder, rare, vertices, faces, fans, dummies):
        self.decoder, self.rare = decoder, rare
        self.valence = Model(inputs=14, limit=1023, rate=16)
        self.event = Model(inputs=3, limit=1023, rate=16, first=(65405 << 6, 30))
        self.contexts = ()
        self.hash_bits = min(max(vertices.bit_length() - 2, 6), 12)  # C 6.10
        self.face_count, self.fan_count, self.dummies_left = faces, fans, dummies
        self.triangles_left, self.steps_left = 4 * faces, 65536 + 16 * faces  # C 6.2, C 6.8
        self.faces, self.fans, self.latest = [], 0, 0  # the label of the latest fan
        self.nodes, self.alive, self.stamps = [], 0, 0
        self.queue = []  # bucket, stamp and number of nodes, some of them outdated

    def run(self):  # C 6.1, C 6.2, C 6.12
        while self.alive > 0 or len(self.faces) < self.face_count:
            self.triangles_left -= 1
            if self.triangles_left < 0 or self.decoder.overran():
                self.decoder.fail("there are too many triangles")
            if self.alive == 0:
                self.start_component()
            elif (f := self.first_node()).free == 0:
                self.close_node(f)
            else:
                self.pass_gate(f)
        if self.fans < self.fan_count or self.dummies_left > 0:
            self.decoder.fail("there are too few vertices")
        return self.faces

    def add_node(self, vertex, free):  # C 5.2
        node = Node(len(self.nodes), vertex)
        self.nodes.append(node)
        self.alive += 1
        self.set_free(node, free)
        return node

    def remove_nodes(self, *nodes):  # C 5.2
        for node in nodes:
            node.alive = False
            self.alive -= 1

    def set_free(self, node, free):  # C 5.4: the stamp is how often any free degree was set before
        node.free, node.stamp = free, self.stamps
        self.stamps += 1
        heapq.heappush(self.queue, (min(free, 7), node.stamp, node.number))

    def first_node(self):  # C 5.4
        while True:
            _, stamp, number = self.queue[0]
            node = self.nodes[number]
            if node.alive and node.stamp == stamp:
                return node
            heapq.heappop(self.queue)

    def start_component(self):  # C 6.3
        self.contexts, nodes = (0,) * 14, []
        for _ in range(3):
            vertex, valence = self.add_fan()
            nodes.append(self.add_node(vertex, valence - 2))
        for k in range(3):
            link(nodes[k], nodes[(k + 1) % 3])
            nodes[k].apex = nodes[(k + 2) % 3].vertex
            meet(nodes[k].vertex, nodes[(k + 1) % 3].vertex)
        self.emit(*(node.vertex for node in nodes))

    def close_node(self, f):  # C 6.4
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

    def pass_gate(self, f):
        n = f.next
        usual = self.event.bit(self.decoder, self.look_around(f), 0)  # C 6.5
        dummy = not usual and self.dummies_left > 0 and self.rare.bit(self.decoder, (0,), DUMMY)
        if usual or dummy:  # C 6.6
            if dummy:  # it closes a boundary loop
                self.dummies_left -= 1
                vertex, valence = (
                    Vertex(0, -1),
                    2 + read_unsigned(self.decoder, self.rare, (0,), 2, LOOP),
                )
            else:
                vertex, valence = self.add_fan()
            node = other = self.add_node(vertex, valence - 2)
        else:  # C 6.7
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

    def find_node(self, f):  # C 6.8
        reach = min(4096, self.steps_left)
        if self.rare.bit(self.decoder, (0,), NUMBERED):
            self.steps_left -= reach
            return self.nodes[self.decoder.uniform(len(self.nodes))]
        backward = self.rare.bit(self.decoder, (0,), BACKWARD)
        skipped = read_unsigned(self.decoder, self.rare, (0,), 2, SKIPPED)
        node = f if backward else f.next
        for _ in range(reach):
            node = node.previous if backward else node.next
            self.steps_left -= 1
            if node.free >= 2:
                if skipped == 0:
                    return node
                skipped -= 1
        return self.decoder.fail("a third vertex is too far away")

    def add_fan(self):  # C 6.9: a vertex of the mesh and its valence
        if self.fans == self.fan_count:
            self.decoder.fail("there are too many vertices")
        valence = self.read_valence()
        self.latest = min(valence, 15)
        self.fans += 1
        return Vertex(self.latest, self.fans - 1), valence

    def read_valence(self):  # C 6.9
        if self.valence.bit(self.decoder, self.contexts, 0):
            return 6
        few = self.valence.bit(self.decoder, self.contexts, 1)
        for valence in (5, 4, 3) if few else range(7, 17):
            if self.valence.bit(self.decoder, self.contexts, 7 - valence if few else valence - 2):
                return valence
        return 2 if few else 17 + read_unsigned(self.decoder, self.rare, (0,), 2, VALENCE)

    def emit(self, a, b, c):  # C 5.5
        if a is b or b is c or c is a:
            self.decoder.fail("a triangle repeats a corner")
        if min(a.rank, b.rank, c.rank) >= 0:
            if len(self.faces) == self.face_count:
                self.decoder.fail("there are too many faces")
            self.faces.append([a.rank, b.rank, c.rank])

    def look_around(self, f):  # C 6.10: set the contexts of the valence, return those of the event
        n, p = f.next, f.previous
        nn, pp, nnn = n.next, p.previous, n.next.next
        lf, ln, lp, lnn, lpp, lnnn = (node.vertex.label for node in (f, n, p, nn, pp, nnn))
        af, an, ap = (node.apex.label for node in (f, n, p))
        ff, fn, fp, fnn, fpp = (clamp(node.free, 0, 15) for node in (f, n, p, nn, pp))
        sf, sn, sp = (clamp(node.vertex.sum + 7, 0, 15) for node in (f, n, p))
        kf, kn, kp = clamp(lf - ff, 0, 15), clamp(ln - fn, 0, 15), clamp(lp - fp, 0, 15)
        b = 4 * (lf == 0) + 2 * (ln == 0) + (lp == 0)
        digits = [
            (0,), (lf, ln, af), (lf, sf), (lf, ln, af, sf), (ln, af, sn), (lp, sp, ap, ff), (fp, fn, lp, fnn),
            (b, fnn, lnn), (b, fpp), (b, ap, kf, lp, fn), (ff, fp, lf, ln, lp), (lp, lnn, kp, kn, an, fpp, lpp),
            (ap, sn, self.latest, sf, ff, sp, fnn), (b, fnn, af, fp, fn, lnnn, kn),
        ]  # fmt: skip
        self.contexts = [self.hash(each) for each in digits]
        return 16 * ff + fn, 256 * ff + 16 * fp + fn, b

    def hash(self, digits):  # C 6.11
        number = 0
        for digit in digits:
            number = 16 * number + digit
        return ((number + 1) * 0x1E3779B97F4A7C15 % 2**64) >> (64 - self.hash_bits)


def link(node, following):  # C 5.3
    node.next, following.previous = following, node


def meet(a, b):  # C 5.6
    if a.label != 0:
        b.sum += a.label - 6
    if b.label != 0:
        a.sum += b.label - 6


def read_seams(decoder, faces, fans):  # C 7: the vertex of each fan
    edges, directions = [(face[k], face[(k + 1) % 3]) for face in faces for k in range(3)], {}
    for edge in edges:
        directions.setdefault(frozenset(edge), []).append(edge)
    after, before = [-1] * fans, [-1] * fans  # C 7.1: the fans along the boundary, -1 inside
    for a, b in edges:
        both = directions[frozenset((a, b))]
        if len(both) != 2 or both[0] == both[1]:
            after[a] = b
    for fan, following in enumerate(after):
        if following >= 0:
            before[following] = fan
    model, latest = Model(inputs=1), []  # the latest fan of each vertex
    # Earlier: the latest fan of the same vertex before this one.
    vertex, earlier = [-1] * fans, [-1] * fans

    def state(fan):  # C 7.2
        return 0 if fan < 0 or vertex[fan] < 0 else 1 if earlier[fan] < 0 else 2

    def candidates(fan):  # C 7.4
        found = []
        for neighbor, ways in ((after[fan], (before, after)), (before[fan], (after, before))):
            if neighbor < 0 or vertex[neighbor] < 0:
                continue
            other = latest[vertex[neighbor]]
            for _ in range(8):
                for way in ways:
                    u = vertex[way[other]] if way[other] >= 0 else -1
                    if u >= 0 and u != vertex[neighbor] and u not in found:
                        found.append(u)
                other = earlier[other]
                if other < 0:
                    break
        return found[:8]

    def read_vertex(fan):  # C 7.3
        found = candidates(fan)
        for k, u in enumerate(found):
            if model.bit(decoder, (16 + 2 * k + (len(found) > 1),), 0):
                return u
        return decoder.uniform(len(latest))

    for fan in range(fans):
        if decoder.overran():
            decoder.fail("")
        context = 1 + 3 * state(after[fan]) + state(before[fan]) if after[fan] >= 0 else 0
        if model.bit(decoder, (context,), 0) and latest:
            vertex[fan] = read_vertex(fan)
            earlier[fan] = latest[vertex[fan]]
            latest[vertex[fan]] = fan
        else:
            vertex[fan] = len(latest)
            latest.append(fan)
    return vertex


def read_on_edges(decoder, rare, faces, most):  # C 13: faces that repeat a corner, on edges
    count = read_unsigned(decoder, rare, (0,), 2, COUNTS)
    if count > most:
        decoder.fail("more faces are on edges than repeat a corner")
    edges = {
        (min(pair), max(pair))
        for a, b, c in faces
        for pair in ((a, b), (b, c), (c, a))
        if pair[0] != pair[1]
    }
    corners, met, twice = (collections.Counter() for _ in range(3))
    corners.update(v for face in faces for v in face)
    model, found, history = Model(inputs=3), [], 0
    for a, b in sorted(edges):
        if len(found) == count or decoder.overran():
            break
        known = 64 * min(met[a], 3) + 16 * min(met[b], 3) + 4 * min(twice[a], 3) + min(twice[b], 3)
        contexts = known, history, 16 * min(corners[a], 15) + min(corners[b], 15)
        k = 0
        while len(found) < count and model.bit(decoder, contexts, min(k, 3)):
            middle = b if model.bit(decoder, contexts, 4) else a
            found.append([a, middle, b])
            met.update((a, b))
            twice[middle] += 1
            k += 1
        history = (2 * history + (k > 0)) % 256
    if len(found) < count:
        decoder.fail("fewer faces are on edges than the payload says")
    return found


def read_degenerate(decoder, count, known, vertices):  # C 8: `count` faces that repeat a corner
    faces = []
    for _ in range(count):
        face = []
        for _ in range(3):
            face.append(decoder.uniform(known + 1))
            known += face[-1] == known
        if decoder.overran() or len(set(face)) == 3:
            decoder.fail("a degenerate face has three different corners")
        faces.append(face)
    if known != vertices:
        decoder.fail("the faces do not have the vertices that they should")
    return faces


def neighbors_of(faces, vertices):  # M 2.1: the neighbors of each vertex, ascending
    found = [set() for _ in range(vertices)]
    for face in faces:
        for a in face:
            found[a].update(b for b in face if b != a)
    return [sorted(row) for row in found]


# ---------------------------------------------------------------- V 1 to V 3: corners, order, neighborhood


class Mesh:  # What both sides know
    def __init__(self, faces, vertices, traverse):
        self.vertex = [v for face in faces for v in face]  # V 1.1
        self.next, self.previous = (
            [k - k % 3 + (k + i) % 3 for k in range(len(self.vertex))] for i in (1, 2)
        )
        self.vertices, self.corners, self.opposite = vertices, [[] for _ in range(vertices)], {}
        for k, v in enumerate(self.vertex):
            self.corners[v].append(k)
        self.degree = [len(corners) for corners in self.corners]
        self.pair()
        self.order = self.traverse() if traverse else list(range(vertices))
        self.rank = [0] * vertices
        for number, v in enumerate(self.order):
            self.rank[v] = number

    def pair(self):  # V 1.2
        for v in range(self.vertices):
            waits = {}
            for k in self.corners[v]:
                for end, facing in (
                    (self.next[k], self.previous[k]),
                    (self.previous[k], self.next[k]),
                ):
                    u = self.vertex[end]
                    if u > v and u in waits:
                        other = waits.pop(u)
                        self.opposite[facing], self.opposite[other] = other, facing
                    elif u > v:
                        waits[u] = facing

    def traverse(self):  # V 2.2 to V 2.4
        queues, waits, known = [OrderedDict() for _ in range(4)], {}, [False] * self.vertices
        order, fresh = [], 0

        def promote(w, i):  # V 2.4
            queue = min(waits.get(w, 0) + i, 3)
            if waits.get(w) == queue:
                return
            if w in waits:
                del queues[waits[w]][w]
            queues[queue][w] = None
            waits[w] = queue

        while len(order) < self.vertices:
            queue = next((q for q in (3, 2, 1, 0) if queues[q]), None)
            if queue is None:
                while known[fresh]:
                    fresh += 1
                v = fresh
            else:
                v, _ = queues[queue].popitem(last=False)
                del waits[v]
            known[v] = True
            order.append(v)
            for k in self.corners[v]:  # V 2.3
                a, b = self.next[k], self.previous[k]
                known_a, known_b = known[self.vertex[a]], known[self.vertex[b]]
                if known_a and known_b:
                    if k in self.opposite and not known[self.vertex[self.opposite[k]]]:
                        promote(self.vertex[self.opposite[k]], 1)
                elif known_a or known_b:
                    t = b if known_a else a
                    promote(
                        self.vertex[t],
                        int(t in self.opposite and known[self.vertex[self.opposite[t]]]),
                    )
        return order

    def neighbors(self, v):  # V 3.1
        found = []
        for k in self.corners[v]:
            for u in (self.vertex[self.next[k]], self.vertex[self.previous[k]]):
                if self.rank[u] < self.rank[v] and u not in found:
                    found.append(u)
        return found[:16]

    def flaps(self, v):  # V 3.2: a, b, c and the tip
        found = []
        for k in self.corners[v]:
            if k in self.opposite:
                tip = self.opposite[k]
                flap = (self.vertex[self.next[k]], self.vertex[self.previous[k]], self.vertex[tip])
                if all(self.rank[u] < self.rank[v] for u in flap):
                    found.append((*flap, tip))
        return found[:8]


# ---------------------------------------------------------------- V 14, V 4, V 5: values

TABLES_SHA256 = "55311cc8ec5fcbb0687028fd79e580ec8a33a972c60c8621a9d5c22a0ec5a1bc"


def make_survival(z):  # V 14.1
    terms = zip((1, 2, 4, 1, 1), (16, 4, 1.5, 1, 1 / 3))
    return round(
        -65536 * math.log(sum(factor / (1 + math.exp(rate * z)) for factor, rate in terms) / 9)
    )


def make_odds(i):  # V 14.2: ODDS(i), LESS(i)
    d = (max(i, 0.5) if i < 32 else (32 + i % 32 + 0.5) * 2.0 ** (i // 32 - 1)) / 65536
    more = d + math.log(-math.expm1(-d))
    return [
        clamp(round(256 * x), -4000, 4000)
        for x in (more, math.log(-math.expm1(-d)) if d < 30 else -math.exp(-d))
    ]


SURVIVAL = [make_survival(i / 32) for i in range(-512, 513)]
ODDS, LESS = (list(table) for table in zip(*map(make_odds, range(544))))
_BYTES = struct.pack("<2113i", *SURVIVAL, *ODDS, *LESS)
assert hashlib.sha256(_BYTES).hexdigest() == TABLES_SHA256, "the tables are not those of V 14.3"

# V 5.1.
Expectation = namedtuple("Expectation", "predictions size contexts scale_context hit_context set")


def whole(fine):
    return (fine + 8) >> 4


def survival(distance, inverse):  # V 4.1: A
    z = (distance * inverse) >> 20
    if z >= 16384:
        return SURVIVAL[1024] + (
            ((min(z, 1 << 20) - 16384) * (SURVIVAL[1024] - SURVIVAL[1023])) >> 5
        )
    z = max(z, -16384)
    i = (z >> 5) + 512
    return SURVIVAL[i] + (((SURVIVAL[i + 1] - SURVIVAL[i]) * (z & 31)) >> 5)


def odds(d, table=ODDS):  # V 4.2: G, or with LESS H
    e = max(d.bit_length() - 6, 0)
    return table[min(32 * e + (d >> e), 543) if d > 0 else 0]


class ValueModel:  # V 4.3
    def __init__(self):
        self.slots, self.node_weights, self.kind_weights, self.hits, self.scales = (
            {},
            {},
            {},
            {},
            {},
        )

    def bit(self, decoder, e, node, kind, given):  # V 4.4, V 4.5
        places = [(i, context, node) for i, context in enumerate(e.contexts)]
        slots = [self.slots.get(place, (1 << 21, 0)) for place in places]
        x = [clamp(o, -2047, 2047) for o in given] + [STRETCH[p >> 10] for p, _ in slots] + [256]
        u = self.node_weights.setdefault(node, [10532] * 7 + [6000] * 6 + [0])
        w = self.kind_weights.setdefault((e.set, kind), [0] * 14)
        p = SQUASH[clamp(sum(x[i] * (u[i] + w[i]) for i in range(14)) >> 16, -2880, 2879) + 2880]
        bit = decoder.bit(p)
        for i in range(14):
            change = (x[i] * (65536 * bit - p) * 9 + (1 << 19)) >> 20
            u[i], w[i] = wrap(u[i] + change), wrap(w[i] + change)
        for place, slot in zip(places, slots):
            self.slots[place] = learn_slot(slot, bit, 400)
        return bit

    def value(self, decoder, e):
        p, size, inverse, scale = e.predictions, max(e.size, 2), [], 0
        for j in range(7):  # V 5.3
            mean, count = self.scales.get((j, e.scale_context), (0, 0))
            scale = max((mean * count + 512 * size) // (count + 2), 256)
            inverse.append((1 << 38) // scale)
        k = max((scale >> 12).bit_length() - 1, 0)
        value, refuted = self.ask(decoder, e, inverse)
        if value is None:
            value = self.search(decoder, e, inverse, whole(p[6]), k, refuted)
        for j in range(7):  # V 5.9
            place = (j, e.hit_context)
            self.hits[place] = learn_slot(
                self.hits.get(place, (1 << 18, 0)), whole(p[j]) == value, 60
            )
            mean, count = self.scales.get((j, e.scale_context), (0, 0))
            usual = mean if count > 0 else 256 * size
            seen = min(256 * abs(16 * value - p[j]), 8 * usual + 4096, 1 << 30)
            mean += ((seen - mean) * (131072 // (2 * count + 3))) >> 16
            self.scales[j, e.scale_context] = mean, min(count + 1, 255)
        return value

    # V 5.4: the value, if a question finds it, and the refuted numbers.
    def ask(self, decoder, e, inverse):
        p, refuted, remaining = e.predictions, [], list(range(7))
        while remaining and len(refuted) < 3:
            rates = [self.hits.get((j, e.hit_context), (1 << 18, 0))[0] for j in remaining]
            if max(rates) < 699050:
                break
            best = remaining[rates.index(max(rates))]
            q = whole(p[best])
            remaining = [j for j in remaining if whole(p[j]) != q]
            given = []
            for j in range(7):
                d = abs(16 * q - p[j])
                a, b = survival(d - 8, inverse[j]), survival(d + 8, inverse[j])
                given.append(-odds(a - 256 * odds(b - a, LESS)))
            if self.bit(decoder, e, 2 * best + (1 if refuted else 0), 0, given):
                return q, refuted
            refuted.append(q)
        return None, refuted

    def search(self, decoder, e, inverse, center, k, refuted):
        p = e.predictions
        g = center + (center in refuted)  # V 5.5
        lean = sum(q > center for q in refuted) - sum(q < center for q in refuted)
        node = 14 if not refuted else 15 if lean < 0 else 16 if lean == 0 else 17
        away = [16 * g - 8 - p[j] for j in range(7)]
        up = self.bit(
            decoder,
            e,
            node,
            1,
            [(survival(-d, s) - survival(d, s)) >> 8 for d, s in zip(away, inverse)],
        )
        r, f = (1, g) if up else (-1, center - 1)
        m = 16 * f - 8 * r

        def beyond(distance, j):
            return survival(r * (m + 16 * r * distance - p[j]), inverse[j])

        first, i = 0, 0  # V 5.6
        while True:
            h = k if i < 4 else k + i // 2 - 1
            end = first + (1 << h)
            if end > 1 << 22:
                break
            if h > 0 or f + r * first not in refuted:
                given = [-odds(beyond(end, j) - beyond(first, j)) for j in range(7)]
                if not self.bit(decoder, e, 18 + 2 * min(i, 14) + up, 2 if i <= 2 else 3, given):
                    break
            first, i = end, i + 1
        distance = first
        for x in range(min(h, 2)):  # V 5.7
            h, given = h - 1, []
            for j in range(7):
                a = r * (m - p[j]) + 16 * distance
                t, b = a + (1 << (h + 4)), a + (2 << (h + 4))
                s = inverse[j]
                if t >= 0:
                    given.append(
                        odds(survival(b, s) - survival(t, s), LESS)
                        - odds(survival(t, s) - survival(a, s))
                    )
                else:
                    low = odds(survival(-a, s) - survival(-t, s), LESS)
                    given.append(odds(survival(-t, s) - survival(-b, s)) - low)
            if self.bit(decoder, e, 48 + 2 * min(i, 8) + x, 4 + x, given):
                distance += 1 << h
        if h > 0:  # V 5.8
            distance += decoder.uniform(1 << h)
        return f + r * distance


# ---------------------------------------------------------------- V 6: learnt sums


class Learner:
    def __init__(self, first):  # V 6.1
        self.first, self.weights, self.terms = first, list(first), range(len(first))
        self.squares, self.products = [[0] * len(first) for _ in first], [0] * len(first)

    def foretell(self, terms, bound):  # V 6.1
        return clamp(sum(w * x for w, x in zip(self.weights, limited(terms))) >> 16, -bound, bound)

    def learn(self, terms, target, size, turn=None):  # V 6.2, of all weights or, by V 6.3, of one
        x = limited(terms)
        h = (
            2 * (max(size, abs(target) >> 4, *(abs(value) >> 5 for value in x)) + 8).bit_length()
            - 8
        )
        for i in self.terms:
            for j in self.terms:
                self.squares[i][j] += ((256 * x[i] * x[j]) >> h) - (self.squares[i][j] >> 11)
            self.products[i] += ((256 * x[i] * target) >> h) - (self.products[i] >> 11)
        for i in self.terms if turn is None else [turn]:
            left = 65536 * self.products[i] - (1 << 19) * (self.weights[i] - self.first[i])
            left -= sum(s * w for s, w in zip(self.squares[i], self.weights))
            weight = self.weights[i] + div(left, self.squares[i][i] + (1 << 19))
            self.weights[i] = clamp(weight, -(1 << 18), 1 << 18)


def limited(terms):  # V 6.1
    return [clamp(x, -(1 << 26), 1 << 26) for x in terms]


# ---------------------------------------------------------------- V 7 to V 10, V 12: positions on a grid


class Field:  # V 7.1: vertices of an order, from frame to frame
    def __init__(self, mesh):
        self.mesh, self.next = mesh, 0
        self.x, self.gap = ([[0] * 3 for _ in range(mesh.vertices)] for _ in range(2))

    def read(self, payload, count):  # The next `count` vertices, decoded
        decoder = RangeDecoder(payload)
        vertices = self.mesh.order[self.next : self.next + count]
        for v in vertices:
            if decoder.overran():
                break
            self.vertex(decoder, v)
        decoder.finish()
        self.next += count
        return vertices


def size_class(x):  # V 10.2: size
    bits = x.bit_length()
    return x if x < 4 else min(2 * bits - 2 + ((x >> (bits - 2)) % 2), 31)


def sign_class(x, unit):  # V 10.2: sign
    size = abs(x)
    s = 0 if 2 * size < unit else 1 if size < unit + (unit >> 1) else 2 if size < 4 * unit else 3
    return 3 + s if x >= 0 else 3 - s


def three(x, y, z, first, unit):  # V 10.2
    return 49 * sign_class(x, first) + 7 * sign_class(y, unit) + sign_class(z, unit)


class Plane:
    def __init__(self, normal):  # V 8.5
        shift = 0
        while max(map(abs, normal)) >> shift >= 1 << 14:
            shift += 1
        self.n = [x >> shift for x in normal]
        self.square, self.dot, self.used = sum(x * x for x in self.n), 0, 0

    def tilt(self, j):  # V 8.6
        return clamp(
            div(-self.n[j] * self.dot, self.square - self.used + (self.square >> 6) + 1),
            -(1 << 26),
            1 << 26,
        )

    def pass_axis(self, j, error):  # V 8.6
        self.dot += self.n[j] * error
        self.used += self.n[j] ** 2


def normal(a, b, c):  # V 8.5
    s, t = ([end[j] - a[j] for j in range(3)] for end in (b, c))
    return [s[1] * t[2] - s[2] * t[1], s[2] * t[0] - s[0] * t[2], s[0] * t[1] - s[1] * t[0]]


class GridReader(Field):
    def __init__(self, faces, vertices, largest):
        super().__init__(Mesh(faces, vertices, traverse=True))
        self.model, self.largest, self.seen = ValueModel(), largest, [set(), set(), set()]
        self.count, self.sum = [0] * vertices, [[0] * 3 for _ in range(vertices)]  # V 8.4: C, X
        self.guesses, self.sizes = {}, {}

    def error(self, v):  # V 7.3: err
        return sum(map(abs, self.gap[v]))

    def vertex(self, decoder, v):
        mesh, x = self.mesh, self.x
        near = mesh.neighbors(v)
        # V 8.1.
        flaps = sorted(
            mesh.flaps(v), key=lambda f: 2 * self.error(f[2]) + self.error(f[0]) + self.error(f[1])
        )
        before = mesh.order[mesh.rank[v] - 1] if mesh.rank[v] > 0 else None
        across = [[16 * (x[a][j] + x[b][j] - x[c][j]) for j in range(3)] for a, b, c, _ in flaps]
        if near:  # V 8.2
            mean = [rounded(sum(16 * x[u][j] for u in near), len(near)) for j in range(3)]
            error = [rounded(sum(abs(self.gap[u][j]) for u in near), len(near)) for j in range(3)]
        elif before is not None:
            mean, error = [16 * value for value in x[before]], list(self.largest)
        else:
            mean, error = [0, 0, 0], [16 * most for most in self.largest]
        base = [rounded(sum(p[j] for p in across), len(flaps)) for j in range(3)] if flaps else mean
        shape, closing = self.shape(v, flaps), self.closing(near, base)
        normals = [normal(x[a], x[b], x[c]) for a, b, c, _ in flaps]  # V 8.5
        planes, main = (
            [Plane(n) for n in normals[:2]],
            Plane([sum(normal[j] for normal in normals) for j in range(3)]),
        )
        f, hits, first_gap = min(len(flaps), 3), 0, 0
        for step, j in enumerate(sorted(range(3), key=lambda j: (abs(main.n[j]), j))):
            far, tilt = 16 * self.largest[j], main.tilt(j)
            place = (f, step == 2, clamp(mesh.degree[v] - 3, 0, 5))  # V 9.1
            guess = self.guesses.setdefault(place, Learner([49152, 0, 0, 0, 0, 0, 0]))
            size = self.sizes.setdefault((f, step), Learner([49152, 8192, 0, 0]))
            terms = [tilt, mean[j] - base[j], closing[j], *(term[j] for term in shape)]  # V 9.2
            shift = guess.foretell(terms, far)
            apart = abs(across[0][j] - across[1][j]) if len(flaps) > 1 else 0
            hints = [error[j], apart, first_gap, abs(shift - tilt)]  # V 9.3
            h = limited(hints)[0]
            e = clamp(size.foretell(hints, far), h // 8 + 1, far) if flaps else h

            p1 = across[1][j] if len(flaps) > 1 else base[j]  # V 10.1
            in_first = across[0][j] + planes[0].tilt(j) if flaps else mean[j]
            predictions = [
                base[j] + tilt, across[0][j] if flaps else mean[j], p1,
                p1 + planes[1].tilt(j) if len(flaps) > 1 else mean[j],
                16 * self.near_value(j, clamp(whole(in_first), 0, self.largest[j])),
                16 * x[near[0]][j] if near else mean[j], base[j] + shift,
            ]  # fmt: skip
            predictions = [clamp(p, 0, far) for p in predictions]
            d = [p - predictions[6] for p in predictions]
            b, u = size_class(e >> 1), e // 2 + 4  # V 10.3
            contexts = [
                12 * b + 3 * f + step,
                three(d[0], d[1], d[2], 8, 8),
                three(d[1], d[2], mean[j] - predictions[6], u, u),
                three(d[4], closing[j] - shift, d[3], 8, u),
                three(*(self.gap[w][j] for w in flaps[0][:3]), u, u) if flaps else 0,
                hits + 128 * step if step else 0,
            ]
            hit_context = 8 * (0 if step == 0 else 1 + (hits > 0)) + 2 * f + (error[j] < 16)
            value = self.model.value(
                decoder, Expectation(predictions, e, contexts, b, hit_context, step)
            )
            if not 0 <= value <= self.largest[j]:  # V 7.2
                decoder.fail("a value is outside the grid")
            x[v][j] = value
            self.seen[j].add(value)
            self.gap[v][j] = 16 * value - base[j] - shift
            hits = sum(1 << i for i in range(7) if whole(predictions[i]) == value)
            first_gap = first_gap if step else abs(self.gap[v][j])
            for plane, p in zip([main, *planes], [base, *across]):
                plane.pass_axis(j, 16 * value - p[j])
            guess.learn(terms, 16 * value - base[j], e)
            size.learn(hints, min(abs(self.gap[v][j]), 8 * e + 64), e)
        for k in mesh.corners[v]:  # V 8.4
            w = mesh.vertex[mesh.next[k]]
            self.count[w] += 1
            self.sum[w] = [s + value for s, value in zip(self.sum[w], x[v])]

    def shape(self, v, flaps):  # V 8.3
        mesh, x, shape = self.mesh, self.x, [[0] * 3 for _ in range(4)]
        for a, b, c, tip in flaps:
            q = [x[b][j] - x[a][j] for j in range(3)]
            o = [8 * (x[a][j] + x[b][j]) - 16 * x[c][j] for j in range(3)]
            square = sum(value * value for value in q)
            skew = (
                clamp(div(-16 * sum(s * t for s, t in zip(o, q)), square), -384, 384)
                if square
                else 0
            )
            turn = clamp(mesh.degree[a] - mesh.degree[b], -8, 8)
            for j in range(3):
                shape[0][j] += o[j]
                shape[1][j] += (skew * q[j]) >> 4
                shape[2][j] += 4 * q[j] * turn
            for k in (mesh.previous[tip], mesh.next[tip]):
                if k in mesh.opposite and mesh.rank[mesh.vertex[mesh.opposite[k]]] < mesh.rank[v]:
                    z, e = mesh.vertex[mesh.opposite[k]], mesh.vertex[k]
                    other = b if e == a else a
                    for j in range(3):
                        shape[3][j] += 8 * (x[e][j] + x[z][j] - x[c][j] - x[other][j])
        return (
            [[rounded(value, len(flaps)) for value in term] for term in shape]
            if len(flaps) > 1
            else shape
        )

    def closing(self, near, base):  # V 8.4
        found, total = [u for u in near if self.mesh.degree[u] - self.count[u] <= 1], [0, 0, 0]
        for u in found:
            for j in range(3):
                balance = 16 * ((self.count[u] + 1) * self.x[u][j] - self.sum[u][j]) - base[j]
                total[j] += clamp(balance, -(1 << 26), 1 << 26)
        return [rounded(value, len(found)) for value in total] if len(found) > 1 else total

    def near_value(self, j, t):  # V 8.7
        block = 64 * (t // 64)
        below = max((s for s in range(block - 192, t + 1) if s in self.seen[j]), default=None)
        above = min((s for s in range(t, block + 256) if s in self.seen[j]), default=None)
        if above is not None and (below is None or above - t < t - below):
            return above
        return t if below is None else below


def place(values, header):  # V 12: the position of a vertex
    if header["lattice"]:
        m, k = header["lattice"]
        values = [(2 * value * m + k) // (2 * k) for value in values]
    if header["corner"]:
        values = [value + first for value, first in zip(values, header["corner"])]
    p, q = [c + header["scale"] * y for c, y in zip(header["center"], values)], header["turn"]
    once = cross(q, p)  # V 18
    s = 2.0 / (1.0 + q[0] * q[0] + q[1] * q[1] + q[2] * q[2])
    return [x + s * (t + u) for x, t, u in zip(p, once, cross(q, once))]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


# ---------------------------------------------------------------- V 11: levels of a refinement


class LevelsReader(Field):
    def __init__(self, faces, vertices):
        super().__init__(Mesh(faces, vertices, traverse=False))
        self.models, self.learners = [Model(5, rate=16) for _ in range(2)], {}
        self.ring = [[0] * 3 for _ in range(vertices)]

    def vertex(self, decoder, v):
        near, flaps, own = self.mesh.neighbors(v), self.mesh.flaps(v), 0
        # V 11.3.
        busy = (
            rounded(sum(16 * abs(level) for u in near for level in self.x[u]), len(near))
            if near
            else 64
        )
        for j in range(3):
            self.x[v][j] = level = self.level(decoder, v, j, near, flaps, busy, own)
            own = abs(level) + own // 2

    def level(self, decoder, v, j, near, flaps, busy, own):
        mean, typical, drift, error, ring, late, early = 0, 32, 0, 32, 0, 0, 0  # V 11.2
        x = {u: self.x[u][j] for u in (*near, *(w for flap in flaps for w in flap[:3]))}

        def average(term):
            return rounded(sum(term(u) for u in near), len(near))

        if near:
            mean, typical = average(lambda u: 16 * x[u]), average(lambda u: 16 * abs(x[u]))
            drift, error = average(lambda u: self.gap[u][j]), average(lambda u: abs(self.gap[u][j]))
            ring = average(lambda u: self.ring[u][j])
            late, early = x[max(near)], x[min(near)]
        flap = tip = mean
        if flaps:  # V 11.3
            flap = rounded(sum(16 * (x[a] + x[b] - x[c]) for a, b, c, _ in flaps), len(flaps))
            tip = rounded(sum(16 * x[c] for _, _, c, _ in flaps), len(flaps))
        f = min(len(flaps), 3)
        # V 11.4.
        learner = self.learners.setdefault((j, f), Learner([52000, 28000 if f else 0, 0, 0, 0, 0]))
        terms = [mean, flap - mean, tip - mean, 16 * early - mean, drift, ring - mean]
        quiet = bool(near) and typical == 0 and tip == 0
        guess = 0 if quiet else learner.foretell(terms, 1 << 24)

        c = whole(guess)  # V 11.5
        rest = guess - 16 * c
        w = sum(abs(rest) > bound for bound in (1, 3, 6))
        a, s = min(size_class(typical), 23), min(size_class(error), 23)
        b, o = min(size_class(busy), 23), min(size_class(4 * own), 11)
        degree = clamp(self.mesh.degree[v] - 3, 0, 7)

        def c3(value):
            return clamp(value - c, -3, 3) + 3

        contexts = [
            24 * min(a, 20) + s,
            16 * s + 4 * f + w,
            49 * c3(late) + 7 * c3(early) + c3(tip >> 4) if j == 0 else 12 * b + o,
            8 * (clamp(guess + 96, 0, 191) >> 2) + degree
            if j == 0
            else 3 * (12 * min(a, 11) + o) + min(w, 2),
            14 * (6 * min(len(near), 5) + min(degree, 5))
            + 2 * (3 - w if rest < 0 else 3 + w)
            + (s > 8),
        ]
        value = self.value(
            decoder,
            self.models[min(j, 1)],
            contexts,
            c,
            rest,
            max((error >> 4).bit_length() - 1, 0),
        )
        if abs(value) > 1 << 20:  # V 11.1
            decoder.fail("a level is out of range")
        self.gap[v][j] = 16 * value - guess
        self.ring[v][j] = rounded(16 * (value + sum(x[u] for u in near)), len(near) + 1)
        if not quiet:
            learner.learn(terms, 16 * value, error + 4, turn=v % 6)
        return value

    def value(self, decoder, model, contexts, c, rest, k):  # V 11.6
        if not model.bit(decoder, contexts, 0):
            return c
        r, d, i = 1 if model.bit(decoder, contexts, 1) else -1, 0, 0
        while True:
            h = k if i < 4 else k + i // 2 - 1
            if d + (1 << h) > 1 << 22 or not model.bit(
                decoder, contexts, 2 + 2 * min(i, 9) + (r * rest < 0)
            ):
                break
            d, i = d + (1 << h), i + 1
        if h > 0:
            h -= 1
            d += model.bit(decoder, contexts, 22 + min(i, 8)) << h
        if h > 0:
            d += decoder.uniform(1 << h)
        return c + r * (1 + d)
