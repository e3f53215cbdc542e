"""A decoder of grids and refinement levels, written from V alone: slow, plain, easy to compare.

It shares no code with the product. Docstrings and comments name the rules that they implement.

    1  Tables                   (V 14)
    2  Corners, order           (V 1 to V 3)
    3  Values                   (V 4, V 5)
    4  Learnt sums              (V 6)
    5  Chunks                   (V 7.1)
    6  Positions on a grid      (V 7 to V 10, V 12)
    7  Levels                   (V 11)
    8  Light values             (V 15)
"""

from __future__ import annotations

import hashlib
import struct
from collections import OrderedDict
from collections.abc import Callable, Iterable
from decimal import Decimal, getcontext

from reference_connectivity import SQUASH, STRETCH, RangeDecoder, wrap
from reference_connectivity import Model as MixedModel

Triple = list[int]

# ---------------------------------------------------------------------------------------------------------------------
# 1  Tables
# ---------------------------------------------------------------------------------------------------------------------

getcontext().prec = 50
SHA256 = "55311cc8ec5fcbb0687028fd79e580ec8a33a972c60c8621a9d5c22a0ec5a1bc"


def make_survival() -> list[int]:
    """V 14.1."""

    def logistic(z: Decimal) -> Decimal:
        return 1 / (1 + z.exp())

    table = []
    for i in range(-512, 513):
        z = Decimal(i) / 32
        tail = logistic(16 * z) + 2 * logistic(4 * z) + 4 * logistic(3 * z / 2) + logistic(z) + logistic(z / 3)
        table.append(round(-65536 * (tail / 9).ln()))
    return table


def make_odds() -> tuple[list[int], list[int]]:
    """V 14.2."""
    odds, less = [], []
    for i in range(544):
        units = Decimal(max(2 * i, 1)) / 2 if i < 32 else (32 + i % 32 + Decimal("0.5")) * 2 ** (i // 32 - 1)
        d = units / 65536
        odds.append(clamp(round(256 * (d.exp() - 1).ln()), -4000, 4000))
        less.append(clamp(round(256 * (1 - (-d).exp()).ln()), -4000, 4000))
    return odds, less


def clamp(x: int, low: int, high: int) -> int:
    """clamp(x, a, b)."""
    return low if x < low else high if x > high else x


def rounded(a: int, n: int) -> int:
    """round(a / n)."""
    return (a + n // 2) // n if a >= 0 else -((-a + n // 2) // n)


def div(a: int, b: int) -> int:
    """A div b, towards zero."""
    return abs(a) // abs(b) * (1 if (a >= 0) == (b >= 0) else -1)


def whole(fine: int) -> int:
    """whole(p)."""
    return (fine + 8) >> 4


SURVIVAL = make_survival()
ODDS, LESS = make_odds()
_BYTES = struct.pack("<2113i", *SURVIVAL, *ODDS, *LESS)
assert hashlib.sha256(_BYTES).hexdigest() == SHA256, "the tables are not those of V 14.3"


# ---------------------------------------------------------------------------------------------------------------------
# 2  Corners, order
# ---------------------------------------------------------------------------------------------------------------------


class Mesh:
    """V 1 to V 3: what both sides know."""

    def __init__(self, faces: Iterable[Iterable[int]], vertices: int, traverse: bool) -> None:
        self.vertex = [v for face in faces for v in face]
        self.vertices = vertices
        self.corners: list[list[int]] = [[] for _ in range(vertices)]
        for k, v in enumerate(self.vertex):
            self.corners[v].append(k)
        self.opposite: dict[int, int] = {}
        self.pair()
        self.order = list(range(vertices))
        if traverse:
            self.order = self.traverse()
        self.rank = [0] * vertices
        for number, v in enumerate(self.order):
            self.rank[v] = number

    @staticmethod
    def next(k: int) -> int:
        """V 1.1."""
        return k - 2 if k % 3 == 2 else k + 1

    @staticmethod
    def previous(k: int) -> int:
        """V 1.1."""
        return k + 2 if k % 3 == 0 else k - 1

    def pair(self) -> None:
        """V 1.2."""
        for v in range(self.vertices):
            stacks: dict[int, list[int]] = {}
            for k in self.corners[v]:
                for end, facing in ((self.next(k), self.previous(k)), (self.previous(k), self.next(k))):
                    u = self.vertex[end]
                    if u <= v:
                        continue
                    stack = stacks.setdefault(u, [])
                    if stack:
                        other = stack.pop()
                        self.opposite[facing], self.opposite[other] = other, facing
                    else:
                        stack.append(facing)

    def traverse(self) -> list[int]:
        """V 2.2 to V 2.4."""
        queues: list[OrderedDict[int, None]] = [OrderedDict() for _ in range(4)]
        waits: dict[int, int] = {}
        known = [False] * self.vertices
        order, fresh = [], 0

        def promote(w: int, i: int) -> None:
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
                a, b = self.next(k), self.previous(k)
                known_a, known_b = known[self.vertex[a]], known[self.vertex[b]]
                if known_a and known_b:
                    if k in self.opposite and not known[self.vertex[self.opposite[k]]]:
                        promote(self.vertex[self.opposite[k]], 1)
                elif known_a or known_b:
                    t = b if known_a else a
                    flap = t in self.opposite and known[self.vertex[self.opposite[t]]]
                    promote(self.vertex[t], 1 if flap else 0)
        return order

    def degree(self, v: int) -> int:
        """deg(v)."""
        return len(self.corners[v])

    def neighbours(self, v: int) -> list[int]:
        """V 3.1."""
        found: list[int] = []
        for k in self.corners[v]:
            for u in (self.vertex[self.next(k)], self.vertex[self.previous(k)]):
                if self.rank[u] < self.rank[v] and u not in found:
                    found.append(u)
        return found[:16]

    def flaps(self, v: int) -> list[tuple[int, int, int, int]]:
        """V 3.2: a, b, c and the tip."""
        found = []
        for k in self.corners[v]:
            if k in self.opposite:
                tip = self.opposite[k]
                flap = (self.vertex[self.next(k)], self.vertex[self.previous(k)], self.vertex[tip])
                if all(self.rank[u] < self.rank[v] for u in flap):
                    found.append((*flap, tip))
        return found[:8]


# ---------------------------------------------------------------------------------------------------------------------
# 3  Values
# ---------------------------------------------------------------------------------------------------------------------


class Expectation:
    """V 5.1."""

    def __init__(
        self,
        predictions: list[int],
        size: int,
        contexts: list[int],
        scale_context: int,
        hit_context: int,
        set_: int,
        questions: int,
    ) -> None:
        self.predictions, self.size, self.contexts = predictions, max(size, 2), contexts
        self.scale_context, self.hit_context, self.set, self.questions = scale_context, hit_context, set_, questions


def survival(distance: int, inverse: int) -> int:
    """V 4.1: A."""
    z = (distance * inverse) >> 20
    if z >= 16384:
        return SURVIVAL[1024] + (((min(z, 1 << 20) - 16384) * (SURVIVAL[1024] - SURVIVAL[1023])) >> 5)
    z = max(z, -16384)
    i = (z >> 5) + 512
    return SURVIVAL[i] + (((SURVIVAL[i + 1] - SURVIVAL[i]) * (z & 31)) >> 5)


def entry(d: int) -> int:
    """V 4.2: i."""
    if d < 32:
        return max(d, 0)
    e = d.bit_length() - 6
    return min(32 * e + (d >> e), 543)


def odds(d: int) -> int:
    """V 4.2: G."""
    return ODDS[entry(d)]


def less(d: int) -> int:
    """V 4.2: H."""
    return LESS[entry(d)]


def learn_slot(slot: tuple[int, int], bit: int, limit: int) -> tuple[int, int]:
    """C 2.6."""
    value, count = slot
    target = (1 << 22) - 1 if bit else 0
    return value + (((target - value) * (131072 // (2 * count + 3))) >> 16), min(count + 1, limit)


class Model:
    """V 4.3, V 4.4, V 4.5, V 5."""

    def __init__(self) -> None:
        self.slots: dict[tuple[int, int, int], tuple[int, int]] = {}
        self.node_weights: dict[int, list[int]] = {}
        self.kind_weights: dict[tuple[int, int], list[int]] = {}
        self.hits: dict[tuple[int, int], tuple[int, int]] = {}
        self.scales: dict[tuple[int, int], tuple[int, int]] = {}

    def bit(self, decoder: RangeDecoder, e: Expectation, node: int, kind: int, given: list[int]) -> int:
        """V 4.4, V 4.5."""
        places = [(i, context, node) for i, context in enumerate(e.contexts)]
        slots = [self.slots.get(place, (1 << 21, 0)) for place in places]
        x = [clamp(o, -2047, 2047) for o in given] + [STRETCH[p >> 10] for p, _ in slots] + [256]
        u = self.node_weights.setdefault(node, [10532] * 7 + [6000] * 6 + [0])
        w = self.kind_weights.setdefault((e.set, kind), [0] * 14)
        total = sum(x[i] * (u[i] + w[i]) for i in range(14)) >> 16
        p = SQUASH[clamp(total, -2880, 2879) + 2880]
        bit = decoder.bit(p)
        for i in range(14):
            change = (x[i] * (65536 * bit - p) * 9 + (1 << 19)) >> 20
            u[i], w[i] = wrap(u[i] + change), wrap(w[i] + change)
        for place, slot in zip(places, slots):
            self.slots[place] = learn_slot(slot, bit, 400)
        return bit

    def value(self, decoder: RangeDecoder, e: Expectation) -> int:
        """V 5.3 to V 5.9."""
        p, inverse, scale = e.predictions, [], 0
        for j in range(7):  # V 5.3
            mean, count = self.scales.get((j, e.scale_context), (0, 0))
            scale = max((mean * count + 512 * e.size) // (count + 2), 256)
            inverse.append((1 << 38) // scale)
        centre = whole(p[6])
        k = max((scale >> 12).bit_length() - 1, 0)
        value, refuted = self.ask(decoder, e, inverse)
        if value is None:
            value = self.search(decoder, e, inverse, centre, k, refuted)
        for j in range(7):  # V 5.9
            place = (j, e.hit_context)
            self.hits[place] = learn_slot(self.hits.get(place, (1 << 18, 0)), int(whole(p[j]) == value), 60)
            mean, count = self.scales.get((j, e.scale_context), (0, 0))
            usual = mean if count > 0 else 256 * e.size
            seen = min(256 * abs(16 * value - p[j]), 8 * usual + 4096, 1 << 30)
            mean += ((seen - mean) * (131072 // (2 * count + 3))) >> 16
            self.scales[j, e.scale_context] = mean, min(count + 1, 255)
        return value

    def ask(self, decoder: RangeDecoder, e: Expectation, inverse: list[int]) -> tuple[int | None, list[int]]:
        """V 5.4: the value, if a question finds it, and the refuted numbers."""
        p = e.predictions
        refuted: list[int] = []
        remaining = list(range(7))
        while remaining and len(refuted) < e.questions:
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
                given.append(-odds(a - 256 * less(b - a)))
            if self.bit(decoder, e, 2 * best + (1 if refuted else 0), 0, given):
                return q, refuted
            refuted.append(q)
        return None, refuted

    def search(
        self, decoder: RangeDecoder, e: Expectation, inverse: list[int], centre: int, k: int, refuted: list[int]
    ) -> int:
        """V 5.5 to V 5.8."""
        p = e.predictions
        g = centre + 1 if centre in refuted else centre
        lean = sum(q > centre for q in refuted) - sum(q < centre for q in refuted)
        node = 14 if not refuted else 15 if lean < 0 else 16 if lean == 0 else 17
        away = [16 * g - 8 - p[j] for j in range(7)]
        given = [(survival(-d, s) - survival(d, s)) >> 8 for d, s in zip(away, inverse)]
        up = self.bit(decoder, e, node, 1, given)
        r, f = (1, g) if up else (-1, centre - 1)
        m = 16 * f - 8 * r

        def beyond(distance: int, j: int) -> int:
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
        for x in range(2):  # V 5.7
            if h == 0:
                break
            h -= 1
            given = []
            for j in range(7):
                a = r * (m - p[j]) + 16 * distance
                t, b = a + (1 << (h + 4)), a + (2 << (h + 4))
                s = inverse[j]
                if t >= 0:
                    given.append(less(survival(b, s) - survival(t, s)) - odds(survival(t, s) - survival(a, s)))
                else:
                    given.append(odds(survival(-t, s) - survival(-b, s)) - less(survival(-a, s) - survival(-t, s)))
            if self.bit(decoder, e, 48 + 2 * min(i, 8) + x, 4 + x, given):
                distance += 1 << h
        if h > 0:  # V 5.8
            distance += decoder.uniform(1 << h)
        return f + r * distance


# ---------------------------------------------------------------------------------------------------------------------
# 4  Learnt sums
# ---------------------------------------------------------------------------------------------------------------------


class Learner:
    """V 6."""

    def __init__(self, first: list[int]) -> None:
        self.first, self.weights, self.terms = first, list(first), len(first)
        self.squares = [[0] * self.terms for _ in first]
        self.products = [0] * self.terms

    def foretell(self, terms: list[int], bound: int) -> int:
        """V 6.1."""
        return clamp(sum(w * x for w, x in zip(self.weights, limited(terms))) >> 16, -bound, bound)

    def learn(self, terms: list[int], target: int, size: int, turn: int | None = None) -> None:
        """V 6.2, of all weights or, by V 6.3, of one."""
        x = limited(terms)
        h = 2 * (max(size, abs(target) >> 4, *(abs(value) >> 5 for value in x)) + 8).bit_length() - 8
        for i in range(self.terms):
            for j in range(self.terms):
                self.squares[i][j] += ((256 * x[i] * x[j]) >> h) - (self.squares[i][j] >> 11)
            self.products[i] += ((256 * x[i] * target) >> h) - (self.products[i] >> 11)
        for i in range(self.terms) if turn is None else [turn]:
            left = 65536 * self.products[i] - (1 << 19) * (self.weights[i] - self.first[i])
            left -= sum(s * w for s, w in zip(self.squares[i], self.weights))
            weight = self.weights[i] + div(left, self.squares[i][i] + (1 << 19))
            self.weights[i] = clamp(weight, -(1 << 18), 1 << 18)


def limited(terms: list[int]) -> list[int]:
    """V 6.1."""
    return [clamp(x, -(1 << 26), 1 << 26) for x in terms]


# ---------------------------------------------------------------------------------------------------------------------
# 5  Chunks
# ---------------------------------------------------------------------------------------------------------------------


class Field:
    """V 7.1: vertices of an order, from frame to frame."""

    def __init__(self, mesh: Mesh) -> None:
        self.mesh, self.next = mesh, 0

    def vertex(self, decoder: RangeDecoder, v: int) -> None:
        """Decode a vertex."""
        raise NotImplementedError

    def read(self, payload: bytes, count: int) -> list[int]:
        """The next `count` vertices, decoded."""
        decoder = RangeDecoder(payload)
        vertices = self.mesh.order[self.next : self.next + count]
        for v in vertices:
            if decoder.overran():
                break
            self.vertex(decoder, v)
        decoder.finish()
        self.next += count
        return vertices


def size_class(x: int) -> int:
    """V 10.2: size."""
    bits = x.bit_length()
    return x if x < 4 else min(2 * bits - 2 + ((x >> (bits - 2)) % 2), 31)


def sign_class(x: int, unit: int) -> int:
    """V 10.2: sign."""
    size = abs(x)
    s = 0 if 2 * size < unit else 1 if size < unit + (unit >> 1) else 2 if size < 4 * unit else 3
    return 3 + s if x >= 0 else 3 - s


def three(x: int, y: int, z: int, first: int, unit: int) -> int:
    """V 10.2."""
    return 49 * sign_class(x, first) + 7 * sign_class(y, unit) + sign_class(z, unit)


# ---------------------------------------------------------------------------------------------------------------------
# 6  Positions on a grid
# ---------------------------------------------------------------------------------------------------------------------


class Plane:
    """V 8.5, V 8.6."""

    def __init__(self, normal: Triple) -> None:
        shift = 0
        while max(map(abs, normal)) >> shift >= 1 << 14:
            shift += 1
        self.n = [x >> shift for x in normal]
        self.square = sum(x * x for x in self.n)
        self.dot = self.used = 0

    def axes(self) -> list[int]:
        """V 8.5."""
        return sorted(range(3), key=lambda j: (abs(self.n[j]), j))

    def tilt(self, j: int) -> int:
        """V 8.6."""
        return clamp(div(-self.n[j] * self.dot, self.square - self.used + (self.square >> 6) + 1), -(1 << 26), 1 << 26)

    def pass_axis(self, j: int, error: int) -> None:
        """V 8.6."""
        self.dot += self.n[j] * error
        self.used += self.n[j] ** 2


def normal(a: Triple, b: Triple, c: Triple) -> Triple:
    """V 8.5."""
    s = [b[j] - a[j] for j in range(3)]
    t = [c[j] - a[j] for j in range(3)]
    return [s[1] * t[2] - s[2] * t[1], s[2] * t[0] - s[0] * t[2], s[0] * t[1] - s[1] * t[0]]


class GridReader(Field):
    """V 7 to V 10."""

    def __init__(self, faces: Iterable[Iterable[int]], vertices: int, largest: list[int]) -> None:
        super().__init__(Mesh(faces, vertices, traverse=True))
        self.model, self.largest = Model(), largest
        self.x: list[Triple] = [[0] * 3 for _ in range(vertices)]
        self.gap: list[Triple] = [[0] * 3 for _ in range(vertices)]
        self.seen: list[set[int]] = [set(), set(), set()]
        self.count = [0] * vertices  # V 8.4: C
        self.sum: list[Triple] = [[0] * 3 for _ in range(vertices)]  # V 8.4: X
        self.guesses: dict[tuple[int, bool, int], Learner] = {}
        self.sizes: dict[tuple[int, int], Learner] = {}

    def error(self, v: int) -> int:
        """V 7.3: err."""
        return sum(map(abs, self.gap[v]))

    def vertex(self, decoder: RangeDecoder, v: int) -> None:
        """V 8."""
        mesh, x = self.mesh, self.x
        near = mesh.neighbours(v)
        flaps = sorted(mesh.flaps(v), key=lambda f: 2 * self.error(f[2]) + self.error(f[0]) + self.error(f[1]))
        before = mesh.order[mesh.rank[v] - 1] if mesh.rank[v] > 0 else None
        across = [[16 * (x[a][j] + x[b][j] - x[c][j]) for j in range(3)] for a, b, c, _ in flaps]
        if near:  # V 8.2
            mean = [rounded(sum(16 * x[u][j] for u in near), len(near)) for j in range(3)]
            error = [rounded(sum(abs(self.gap[u][j]) for u in near), len(near)) for j in range(3)]
        elif before is not None:
            mean, error = [16 * value for value in x[before]], list(self.largest)
        else:
            mean, error = [0, 0, 0], [16 * most for most in self.largest]
        base = mean
        if flaps:
            base = [rounded(sum(p[j] for p in across), len(flaps)) for j in range(3)]
        shape = self.shape(v, flaps)
        closing = self.closing(near, base)
        normals = [normal(x[a], x[b], x[c]) for a, b, c, _ in flaps]  # V 8.5
        planes = [Plane(one) for one in normals[:2]]
        whole_plane = Plane([sum(one[j] for one in normals) for j in range(3)])
        hits, first_gap = 0, 0
        for step, j in enumerate(whole_plane.axes()):
            far = 16 * self.largest[j]
            f = min(len(flaps), 3)
            tilt = whole_plane.tilt(j)
            place = (f, step == 2, clamp(mesh.degree(v) - 3, 0, 5))  # V 9.1
            guess = self.guesses.setdefault(place, Learner([49152, 0, 0, 0, 0, 0, 0]))
            size = self.sizes.setdefault((f, step), Learner([49152, 8192, 0, 0]))
            terms = [tilt, mean[j] - base[j], closing[j], *(term[j] for term in shape)]  # V 9.2
            shift = guess.foretell(terms, far)
            apart = abs(across[0][j] - across[1][j]) if len(flaps) > 1 else 0
            hints = [error[j], apart, first_gap, abs(shift - tilt)]  # V 9.3
            h = limited(hints)[0]
            e = clamp(size.foretell(hints, far), h // 8 + 1, far) if flaps else h

            p0 = across[0][j] if flaps else mean[j]
            p1 = across[1][j] if len(flaps) > 1 else base[j]
            in_first = across[0][j] + planes[0].tilt(j) if flaps else mean[j]
            predictions = [  # V 10.1
                base[j] + tilt,
                p0,
                p1,
                p1 + planes[1].tilt(j) if len(flaps) > 1 else mean[j],
                16 * self.near_value(j, clamp(whole(in_first), 0, self.largest[j])),
                16 * x[near[0]][j] if near else mean[j],
                base[j] + shift,
            ]
            predictions = [clamp(p, 0, far) for p in predictions]
            d = [p - predictions[6] for p in predictions]
            b, u = size_class(e >> 1), e // 2 + 4  # V 10.3
            gaps = [self.gap[w][j] for w in flaps[0][:3]] if flaps else []
            contexts = [
                12 * b + 3 * f + step,
                three(d[0], d[1], d[2], 8, 8),
                three(d[1], d[2], mean[j] - predictions[6], u, u),
                three(d[4], closing[j] - shift, d[3], 8, u),
                three(*gaps, u, u) if flaps else 0,
                hits + 128 * step if step else 0,
            ]
            hit_context = 8 * (0 if step == 0 else 1 if hits == 0 else 2) + 2 * f + (1 if error[j] < 16 else 0)
            value = self.model.value(decoder, Expectation(predictions, e, contexts, b, hit_context, step, 3))
            if not 0 <= value <= self.largest[j]:  # V 7.2
                decoder.fail("a value is outside the grid")
            x[v][j] = value
            self.seen[j].add(value)
            self.gap[v][j] = 16 * value - base[j] - shift
            hits = sum(1 << i for i in range(7) if whole(predictions[i]) == value)
            if step == 0:
                first_gap = abs(self.gap[v][j])
            whole_plane.pass_axis(j, 16 * value - base[j])
            for plane, p in zip(planes, across):
                plane.pass_axis(j, 16 * value - p[j])
            guess.learn(terms, 16 * value - base[j], e)
            size.learn(hints, min(abs(self.gap[v][j]), 8 * e + 64), e)
        for k in mesh.corners[v]:  # V 8.4
            w = mesh.vertex[mesh.next(k)]
            self.count[w] += 1
            self.sum[w] = [s + value for s, value in zip(self.sum[w], x[v])]

    def shape(self, v: int, flaps: list[tuple[int, int, int, int]]) -> list[Triple]:
        """V 8.3."""
        mesh, x = self.mesh, self.x
        shape = [[0] * 3 for _ in range(4)]
        for a, b, c, tip in flaps:
            q = [x[b][j] - x[a][j] for j in range(3)]
            o = [8 * (x[a][j] + x[b][j]) - 16 * x[c][j] for j in range(3)]
            square = sum(value * value for value in q)
            skew = clamp(div(-16 * sum(s * t for s, t in zip(o, q)), square), -384, 384) if square else 0
            turn = clamp(mesh.degree(a) - mesh.degree(b), -8, 8)
            for j in range(3):
                shape[0][j] += o[j]
                shape[1][j] += (skew * q[j]) >> 4
                shape[2][j] += 4 * q[j] * turn
            for k in (mesh.previous(tip), mesh.next(tip)):
                if k in mesh.opposite and mesh.rank[mesh.vertex[mesh.opposite[k]]] < mesh.rank[v]:
                    z, e = mesh.vertex[mesh.opposite[k]], mesh.vertex[k]
                    other = b if e == a else a
                    for j in range(3):
                        shape[3][j] += 8 * (x[e][j] + x[z][j] - x[c][j] - x[other][j])
        if len(flaps) > 1:
            shape = [[rounded(value, len(flaps)) for value in term] for term in shape]
        return shape

    def closing(self, near: list[int], base: Triple) -> Triple:
        """V 8.4."""
        found = [u for u in near if self.mesh.degree(u) - self.count[u] <= 1]
        total = [0, 0, 0]
        for u in found:
            for j in range(3):
                balance = 16 * ((self.count[u] + 1) * self.x[u][j] - self.sum[u][j]) - base[j]
                total[j] += clamp(balance, -(1 << 26), 1 << 26)
        return [rounded(value, len(found)) for value in total] if len(found) > 1 else total

    def near_value(self, j: int, t: int) -> int:
        """V 8.7."""
        block = 64 * (t // 64)
        below = max((s for s in range(block - 192, t + 1) if s in self.seen[j]), default=None)
        above = min((s for s in range(t, block + 256) if s in self.seen[j]), default=None)
        if above is not None and (below is None or above - t < t - below):
            return above
        return t if below is None else below


def place(values: Triple, header: dict) -> list[float]:
    """V 12: the position of a vertex."""
    if header["lattice"]:
        m, k = header["lattice"]
        values = [(2 * value * m + k) // (2 * k) for value in values]
    if header["corner"]:
        values = [value + first for value, first in zip(values, header["corner"])]
    return [c + header["scale"] * y for c, y in zip(header["center"], values)]


# ---------------------------------------------------------------------------------------------------------------------
# 7  Levels
# ---------------------------------------------------------------------------------------------------------------------


class LevelsReader(Field):
    """V 11."""

    def __init__(self, faces: Iterable[Iterable[int]], vertices: int) -> None:
        super().__init__(Mesh(faces, vertices, traverse=False))
        self.models = [MixedModel(5, rate=16) for _ in range(2)]
        self.x = [[0] * 3 for _ in range(vertices)]
        self.gap = [[0] * 3 for _ in range(vertices)]
        self.ring = [[0] * 3 for _ in range(vertices)]
        self.learners: dict[tuple[int, int], Learner] = {}

    def vertex(self, decoder: RangeDecoder, v: int) -> None:
        """V 11.2, V 11.3."""
        near, flaps = self.mesh.neighbours(v), self.mesh.flaps(v)
        n = len(near)
        busy = rounded(sum(16 * abs(level) for u in near for level in self.x[u]), n) if near else 64
        own = 0
        for j in range(3):
            own = self.level(decoder, v, j, near, flaps, busy, own)

    def level(
        self,
        decoder: RangeDecoder,
        v: int,
        j: int,
        near: list[int],
        flaps: list[tuple[int, int, int, int]],
        busy: int,
        own: int,
    ) -> int:
        """V 11.2 to V 11.5; returns the next `own`."""
        mean, typical, drift, error, ring, late, early = 0, 32, 0, 32, 0, 0, 0
        x = {u: self.x[u][j] for u in (*near, *(w for flap in flaps for w in flap[:3]))}

        def average(term: Callable[[int], int]) -> int:
            return rounded(sum(term(u) for u in near), len(near))

        if near:
            mean, typical = average(lambda u: 16 * x[u]), average(lambda u: 16 * abs(x[u]))
            drift, error = average(lambda u: self.gap[u][j]), average(lambda u: abs(self.gap[u][j]))
            ring = average(lambda u: self.ring[u][j])
            late, early = x[max(near)], x[min(near)]
        flap = tip = mean
        if flaps:
            flap = rounded(sum(16 * (x[a] + x[b] - x[c]) for a, b, c, _ in flaps), len(flaps))
            tip = rounded(sum(16 * x[c] for _, _, c, _ in flaps), len(flaps))
        f = min(len(flaps), 3)
        learner = self.learners.setdefault((j, f), Learner([52000, 28000 if f else 0, 0, 0, 0, 0]))
        terms = [mean, flap - mean, tip - mean, 16 * early - mean, drift, ring - mean]  # V 11.4
        quiet = bool(near) and typical == 0 and tip == 0
        guess = 0 if quiet else learner.foretell(terms, 1 << 24)

        c = whole(guess)  # V 11.5
        rest = guess - 16 * c
        w = sum(abs(rest) > bound for bound in (1, 3, 6))
        a, s = min(size_class(typical), 23), min(size_class(error), 23)
        b, o = min(size_class(busy), 23), min(size_class(4 * own), 11)
        degree = clamp(self.mesh.degree(v) - 3, 0, 7)

        def c3(value: int) -> int:
            return clamp(value - c, -3, 3) + 3

        contexts = [
            24 * min(a, 20) + s,
            16 * s + 4 * f + w,
            49 * c3(late) + 7 * c3(early) + c3(tip >> 4) if j == 0 else 12 * b + o,
            8 * (clamp(guess + 96, 0, 191) >> 2) + degree if j == 0 else 3 * (12 * min(a, 11) + o) + min(w, 2),
            14 * (6 * min(len(near), 5) + min(degree, 5)) + 2 * (3 - w if rest < 0 else 3 + w) + (s > 8),
        ]
        k = max((error >> 4).bit_length() - 1, 0)
        value = self.value(decoder, min(j, 1), contexts, c, rest, k)
        if abs(value) > 1 << 20:  # V 11.1
            decoder.fail("a level is out of range")
        self.x[v][j] = value
        self.gap[v][j] = 16 * value - guess
        self.ring[v][j] = rounded(16 * (value + sum(x[u] for u in near)), len(near) + 1)
        if not quiet:
            learner.learn(terms, 16 * value, error + 4, turn=v % 6)
        return abs(value) + own // 2

    def value(self, decoder: RangeDecoder, sort: int, contexts: list[int], c: int, rest: int, k: int) -> int:
        """V 11.6."""

        def bit(node: int) -> int:
            return self.models[sort].bit(
                decoder, [32 * (512 * i + context) for i, context in enumerate(contexts)], node
            )

        if not bit(0):
            return c
        r = 1 if bit(1) else -1
        d, i = 0, 0
        while True:
            h = k if i < 4 else k + i // 2 - 1
            if d + (1 << h) > 1 << 22 or not bit(2 + 2 * min(i, 9) + (r * rest < 0)):
                break
            d += 1 << h
            i += 1
        if h > 0:
            h -= 1
            d += bit(22 + min(i, 8)) << h
        if h > 0:
            d += decoder.uniform(1 << h)
        return c + r * (1 + d)


# ---------------------------------------------------------------------------------------------------------------------
# 8  Light values
# ---------------------------------------------------------------------------------------------------------------------

Place = tuple[str, int, int]


def number_of(x: float) -> int:
    """V 16.1: f."""
    try:
        (bits,) = struct.unpack("<I", struct.pack("<f", x))
    except OverflowError:
        bits = 0xFF800000 if x < 0 else 0x7F800000
    return bits if bits < 1 << 31 else -1 - (bits - (1 << 31))


def float_of(number: int) -> float:
    """V 16.1: the float of a number."""
    bits = number if number >= 0 else (1 << 31) - 1 - number
    value: float = struct.unpack("<f", struct.pack("<I", bits))[0]
    return value


class ExactReader:
    """V 16."""

    def __init__(self, faces: Iterable[Iterable[int]], vertices: int, header: dict) -> None:
        self.grid, self.header = GridReader(faces, vertices, header["grid"]), header
        self.x = self.grid.x
        self.positions = [[0.0] * 3 for _ in range(vertices)]
        self.known: dict[tuple[int, int], int] = {}
        self.asked = [0, 0, 0]
        self.slots: dict[tuple[int, int], tuple[int, int]] = {}

    def read(self, values: bytes, floats: bytes, count: int) -> None:
        """V 16.3."""
        first = self.grid.next
        self.grid.read(values, count)
        decoder = RangeDecoder(floats)
        for v in self.grid.mesh.order[first : first + count]:
            for j in range(3):
                number = self.number(decoder, j, self.x[v][j])
                self.positions[v][j] = float_of(number)
            if decoder.overran():
                decoder.fail("floats are missing")
        decoder.finish()

    def number(self, decoder: RangeDecoder, j: int, k: int) -> int:
        center, scale = self.header["center"][j], self.header["scale"]
        low, nearest, high = (number_of(center + scale * (k + side)) for side in (-0.5, 0, 0.5))  # V 16.2
        if low >= high:
            decoder.fail("a cell without floats")
        again = (j, k) in self.known
        place = j, self.asked[j] if again else 8
        slot = self.slots.get(place, (1 << 21, 0))
        bit = decoder.bit(clamp(slot[0] >> 6, 1, 65535))
        self.slots[place] = learn_slot(slot, bit, 43)
        if again:
            self.asked[j] = (2 * self.asked[j] + bit) % 8
        guess = self.known[j, k] if again else nearest
        self.known[j, k] = guess if bit else low + decoder.uniform(high - low)
        return self.known[j, k]


class LightReader(Field):
    """V 15."""

    def __init__(self, faces: Iterable[Iterable[int]], vertices: int, largest: list[int]) -> None:
        super().__init__(Mesh(faces, vertices, traverse=False))
        self.largest = largest
        self.x: list[Triple] = [[0] * 3 for _ in range(vertices)]
        self.gap: list[Triple] = [[0] * 3 for _ in range(vertices)]
        self.slots: dict[tuple[int, str, int, int], tuple[int, int]] = {}

    def bit(self, decoder: RangeDecoder, class_: int, place: Place) -> int:
        """V 15.2."""
        slot = self.slots.get((class_, *place), (1 << 21, 0))
        bit = decoder.bit(clamp(slot[0] >> 6, 1, 65535))
        self.slots[class_, *place] = learn_slot(slot, bit, 43)
        return bit

    def ends(self, v: int) -> list[int]:
        """V 15.3."""
        mesh, found = self.mesh, []
        for k in mesh.corners[v]:
            around = [mesh.vertex[mesh.next(k)], mesh.vertex[mesh.previous(k)]]
            found += [u for u in around if mesh.rank[u] < mesh.rank[v]]
            tips = [mesh.vertex[mesh.opposite[k]]] if k in mesh.opposite else []
            if tips and all(mesh.rank[u] < mesh.rank[v] for u in around + tips):  # the first flap
                break
        return found[:16]

    def vertex(self, decoder: RangeDecoder, v: int) -> None:
        """V 15.3 to V 15.5."""
        mesh, x = self.mesh, self.x
        flaps, ends = mesh.flaps(v), self.ends(v)
        normals = [normal(x[a], x[b], x[c]) for a, b, c, _ in flaps]
        plane = Plane([sum(one[j] for one in normals) for j in range(3)])  # V 15.4
        before = 0
        for step, j in enumerate(plane.axes()):
            start, spread = self.start(v, j, flaps, ends), self.spread(j, flaps, ends)
            turn = 0
            if step:
                turn = div(-plane.n[j] * plane.dot, plane.square - plane.used + (plane.square >> 1) + 1)
            guess = clamp(start + turn, 0, 16 * self.largest[j])
            size = ((8 - step) * spread + before) >> 3
            value = self.value(decoder, guess, size, 3 * min(len(flaps), 3) + step)
            if not 0 <= value <= self.largest[j]:  # V 7.2
                decoder.fail("a value is outside the grid")
            x[v][j] = value
            self.gap[v][j] = abs(16 * value - guess)
            before += self.gap[v][j]
            plane.pass_axis(j, 16 * value - start)

    def start(self, v: int, j: int, flaps: list[tuple[int, int, int, int]], ends: list[int]) -> int:
        """V 15.3."""
        x = self.x
        if flaps:
            return rounded(sum(16 * (x[a][j] + x[b][j] - x[c][j]) for a, b, c, _ in flaps), len(flaps))
        if ends:
            return rounded(sum(16 * x[u][j] for u in ends), len(ends))
        return 16 * x[v - 1][j] if v > 0 else 0

    def spread(self, j: int, flaps: list[tuple[int, int, int, int]], ends: list[int]) -> int:
        """V 15.3."""
        if len(flaps) > 1:
            said = [self.x[a][j] + self.x[b][j] - self.x[c][j] for a, b, c, _ in flaps]
            return 12 * (max(said) - min(said))
        return sum(self.gap[u][j] for u in ends) // len(ends) if ends else self.largest[j]

    def value(self, decoder: RangeDecoder, guess: int, size: int, kind: int) -> int:
        """V 15.6."""
        c = whole(guess)
        o = guess - 16 * c
        w = 0 if abs(o) <= 1 else 1 if abs(o) <= 4 else 2
        class_ = min(size_class(size >> 3), 23)

        def plain(*place: str | int) -> int:
            return self.bit(decoder, class_, place)

        if plain("kind", kind, w):
            return c
        bit = plain("sign", 0, w)
        r = -1 if (bit and o >= 0) or (not bit and o < 0) else 1
        k, d, i = max(size.bit_length() - 6, 0), 0, 0
        while d + (1 << k) < 1 << 21:
            if not plain("kind", kind, 3 + min(i, 8)):
                break
            d, i = d + (1 << k), i + 1
            if i >= 4:
                k += 1
        if k > 0:
            if plain("halves", 0, min(i, 3)):
                d += 1 << (k - 1)
            d += decoder.uniform(1 << (k - 1))
        return c + r * (1 + d)
