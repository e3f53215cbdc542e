"""A decoder of values on vertices and faces, written from extension-attributes.md (A): slow, plain, easy to compare.

It shares no code with the product. Docstrings and comments name the rules that they implement.

    1  Rows, places             (A 1, A 2)
    2  Forecasts                (A 3)
    3  Plain values, colours    (A 4)
    4  Texture coordinates      (A 5)
    5  Normals                  (A 6)
    6  Faces                    (A 7)
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import isqrt
from typing import NamedTuple

from reference_connectivity import RangeDecoder
from reference_fields import Expectation, Learner, Mesh, Model, clamp, div, rounded, size_class, three, whole

Row = list[int]
Triple = tuple[int, int, int]
Pair = tuple[int, int]

# ---------------------------------------------------------------------------------------------------------------------
# 1  Rows, places
# ---------------------------------------------------------------------------------------------------------------------


class Base(NamedTuple):
    """A 2.3."""

    a: int
    b: int
    c: int | None
    tip: int | None


class Place(NamedTuple):
    """A 2.2 to A 2.4."""

    near: list[int]
    error: int | None
    bases: list[Base]
    twin: int | None
    degree: int
    last: int | None

    @property
    def number(self) -> int:
        """A 2.3: b."""
        return min(len(self.bases), 3)


class ValueReader:
    """A 1 to A 6: `x` are the rows."""

    def __init__(
        self,
        faces: Iterable[Iterable[int]],
        vertices: int,
        largest: Sequence[int],
        kind: str,
        geometry: Sequence[Sequence[int]] | None,
        places: Sequence[int],
    ) -> None:
        self.mesh = Mesh(faces, vertices, traverse=True)
        self.largest, self.geometry = list(largest), geometry
        self.model = Model()
        self.next = 0
        self.x: list[Row] = [[0] * len(self.largest) for _ in range(vertices)]
        self.gap: list[Row] = [[0] * len(self.largest) for _ in range(vertices)]
        self.seen: list[set[int]] = [set() for _ in self.largest]
        self.ring: dict[int, list[int]] = {}
        for v, place in enumerate(places):
            self.ring.setdefault(place, []).append(v)
        self.place = list(places)
        code = {"texcoord": TexcoordRows, "normal": NormalRows}.get(kind, PlainRows)
        self.rows = code(self)

    def read(self, payload: bytes, count: int) -> list[int]:
        """A 1.3: the next vertices."""
        decoder = RangeDecoder(payload)
        vertices = self.mesh.order[self.next : self.next + count]
        for v in vertices:
            if decoder.overran():
                break
            self.rows.row(decoder, v, self.survey(v))
        decoder.finish()
        self.next += count
        return vertices

    def error(self, v: int) -> int:
        """A 2.1: err."""
        return min(sum(map(abs, self.gap[v])), 1 << 28)

    def survey(self, v: int) -> Place:
        """A 2.2 to A 2.4."""
        mesh, now = self.mesh, self.mesh.rank[v]
        near = mesh.neighbours(v)
        bases = []
        for k in mesh.corners[v]:
            a, b = mesh.vertex[mesh.next(k)], mesh.vertex[mesh.previous(k)]
            if mesh.rank[a] < now and mesh.rank[b] < now and a != b:
                tip = mesh.opposite.get(k)
                behind = None if tip is None else mesh.vertex[tip]
                known = behind is not None and mesh.rank[behind] < now
                bases.append(Base(a, b, behind if known else None, tip))
        bases = sorted(
            bases[:8],
            key=lambda s: self.error(s.a) + self.error(s.b) + 2 * self.error(s.a if s.c is None else s.c),
        )
        ring = self.ring[self.place[v]]
        at = ring.index(v)
        twins = [u for u in (ring[at + 1 :] + ring[:at])[:8] if mesh.rank[u] < now]
        error = rounded(sum(map(self.error, near)), len(near) * len(self.largest)) if near else None
        twin = max(twins, key=lambda u: mesh.rank[u]) if twins else None
        return Place(near, error, bases, twin, clamp(mesh.degree(v) - 3, 0, 5), mesh.order[now - 1] if now else None)

    def near_value(self, j: int, w: int) -> int:
        """A 2.5, V 8.7."""
        block = w // 64
        below = [s for s in self.seen[j] if s <= w and s // 64 >= block - 3]
        above = [s for s in self.seen[j] if s >= w and s // 64 <= block + 3]
        if above and (not below or min(above) - w < w - max(below)):
            return min(above)
        return max(below) if below else w

    def gap_context(self, place: Place, j: int, u: int) -> int:
        """A 2.6."""
        if not place.bases:
            return 0
        base = place.bases[0]
        third = base.a if base.c is None else base.c
        return three(self.gap[base.a][j], self.gap[base.b][j], self.gap[third][j], u, u)

    def decode(self, decoder: RangeDecoder, j: int, e: Expectation) -> int:
        """A 1.1."""
        value = self.model.value(decoder, e)
        if not 0 <= value <= self.largest[j]:
            decoder.fail(f"component {j} is {value}")
        self.seen[j].add(value)
        return value


def hit_class(j: int, hits: int) -> int:
    """A 1.4."""
    return 0 if j == 0 else 1 if hits == 0 else 2


def hits_of(predictions: list[int], value: int) -> int:
    """A 1.4."""
    return sum(1 << i for i, p in enumerate(predictions) if whole(p) == value)


# ---------------------------------------------------------------------------------------------------------------------
# 2  Forecasts
# ---------------------------------------------------------------------------------------------------------------------


class Forecasts:
    """A 3: all learners of a kind."""

    def __init__(self, first: list[int]) -> None:
        self.first = first
        self.guesses: dict[tuple[int, int, int], Learner] = {}
        self.sizes: dict[tuple[int, int], Learner] = {}

    def make(
        self, place: Place, j: int, base: int, terms: list[int], hints: list[int], reach: int, informed: bool
    ) -> Forecast:
        """A 3.1, A 3.2."""
        guess = self.guesses.setdefault((j, place.number, place.degree), Learner(self.first))
        size = self.sizes.setdefault((j, place.number), Learner([40000, 8192, 0, 0]))
        return Forecast(guess, size, base, terms, hints, reach, informed)


class Forecast:
    """A 3.2 to A 3.4."""

    def __init__(
        self, guess: Learner, size: Learner, base: int, terms: list[int], hints: list[int], reach: int, informed: bool
    ) -> None:
        self.guess, self.size, self.base, self.terms, self.hints = guess, size, base, terms, hints
        self.shift = guess.foretell(terms, reach)
        h = clamp(hints[0], -(1 << 26), 1 << 26)
        self.e = clamp(size.foretell(hints, reach), h // 8 + 1, reach) if informed else h
        self.u = self.e // 2 + 4

    def take(self, fine: int) -> int:
        """A 3.3: the gap."""
        gap = fine - self.base - self.shift
        self.guess.learn(self.terms, fine - self.base, self.e)
        self.size.learn(self.hints, min(abs(gap), 8 * self.e + 64), self.e)
        return gap


def expectation(
    predictions: list[int], f: Forecast, contexts: list[int], scale_context: int, hit_context: int, j: int
) -> Expectation:
    """A 1.4."""
    return Expectation(predictions, f.e, contexts, scale_context, hit_context, min(j, 2), 3)


# ---------------------------------------------------------------------------------------------------------------------
# 3  Plain values, colours
# ---------------------------------------------------------------------------------------------------------------------


class PlainRows:
    """A 4."""

    def __init__(self, reader: ValueReader) -> None:
        self.reader = reader
        self.forecasts = Forecasts([16384, 16384, 0, 0, 0, 0, 0])
        self.count = [0] * reader.mesh.vertices  # V 8.4: C
        self.sum: list[Row] = [[0] * len(reader.largest) for _ in range(reader.mesh.vertices)]  # V 8.4: X

    def row(self, decoder: RangeDecoder, v: int, place: Place) -> None:
        """All components of a vertex."""
        reader, mesh = self.reader, self.reader.mesh
        offs: list[int] = []
        gaps: list[int] = []
        hits = 0
        for j in range(len(reader.largest)):
            hits = self.component(decoder, v, place, j, offs, gaps, hits)
        for k in mesh.corners[v]:
            u = mesh.vertex[mesh.next(k)]
            self.count[u] += 1
            self.sum[u] = [s + value for s, value in zip(self.sum[u], reader.x[v])]

    def closing(self, place: Place, j: int, straight: int) -> int:
        """A 4.3, V 8.4."""
        said = []
        for u in place.near:
            if self.reader.mesh.degree(u) - self.count[u] <= 1:
                missing = (self.count[u] + 1) * self.reader.x[u][j] - self.sum[u][j]
                said.append(clamp(16 * missing - straight, -(1 << 26), 1 << 26))
        return rounded(sum(said), len(said)) if said else 0

    def fold(self, v: int, base: Base, j: int) -> int:
        """A 4.2, V 8.3: FOLD."""
        mesh, x = self.reader.mesh, self.reader.x
        assert base.tip is not None and base.c is not None
        total = 0
        for k in (mesh.previous(base.tip), mesh.next(base.tip)):
            beyond = mesh.opposite.get(k)
            if beyond is None or mesh.rank[mesh.vertex[beyond]] >= mesh.rank[v]:
                continue
            e = mesh.vertex[k]
            other = base.b if e == base.a else base.a
            total += 8 * (x[e][j] + x[mesh.vertex[beyond]][j] - x[base.c][j] - x[other][j])
        return total

    def component(
        self, decoder: RangeDecoder, v: int, place: Place, j: int, offs: list[int], gaps: list[int], hits: int
    ) -> int:
        """A 4.1 to A 4.8; returns hits."""
        reader, x, g = self.reader, self.reader.x, self.reader.gap
        near, n, reach = place.near, len(place.near), 16 * self.reader.largest[j]
        mean = reach // 2 if place.last is None else 16 * x[place.last][j]  # A 4.1
        spread, drift, error = 0, 0, reach
        if near:
            mean = rounded(sum(16 * x[u][j] for u in near), n)
            spread = rounded(sum(abs(16 * x[u][j] - mean) for u in near), n)
            drift = rounded(sum(g[u][j] for u in near), n)
            error = rounded(sum(abs(g[u][j]) for u in near), n)
        beside = mean  # A 4.2
        if place.bases:
            beside = rounded(sum(8 * (x[s.a][j] + x[s.b][j]) for s in place.bases), len(place.bases))
        triangles = [(x[s.a][j], x[s.b][j], x[s.c][j]) for s in place.bases if s.c is not None]
        straight, best, length, fold = mean, mean, 0, 0
        if triangles:
            flaps = len(triangles)
            straight = rounded(sum(16 * (a + b - c) for a, b, c in triangles), flaps)
            length = rounded(sum(8 * (a + b - 2 * c) for a, b, c in triangles), flaps)
            fold = rounded(sum(self.fold(v, s, j) for s in place.bases if s.c is not None), flaps)
            best = 16 * (triangles[0][0] + triangles[0][1] - triangles[0][2])
        one, two = [gaps[j - 1] if j > 0 else 0, gaps[j - 2] if j > 1 else 0]  # A 4.4
        terms = [straight - mean, best - mean, self.closing(place, j, straight), length, fold]  # A 4.5
        terms += [offs[j - 1] if j > 0 else drift, offs[j - 2] if j > 1 else beside - mean]
        hints = [error, spread, abs(one), abs(best - mean)]
        f = self.forecasts.make(place, j, mean, terms, hints, reach, n > 0)
        guess = mean + f.shift
        first = 16 * x[near[0]][j] if near else mean
        alike = first  # A 4.6, A 4.7
        candidates = [u for u in (place.twin, *near) if u is not None]
        if j > 0 and candidates:
            z = min(candidates, key=lambda u: sum(abs(x[u][i] - x[v][i]) for i in range(j)))
            alike = 16 * (x[z][j] + x[v][j - 1] - x[z][j - 1])
        second = 16 * x[near[1]][j] if n > 1 else mean
        predictions = [
            mean,
            best,
            straight if place.bases else first,
            second if place.twin is None else 16 * x[place.twin][j],
            16 * reader.near_value(j, clamp(whole(guess), 0, reader.largest[j])),
            alike,
            guess,
        ]
        predictions = [clamp(p, 0, reach) for p in predictions]
        d = [p - predictions[6] for p in predictions]
        b, t, size = place.number, int(place.twin is not None), size_class(f.e >> 1)  # A 4.8
        contexts = [
            4 * (4 * size + b) + j,
            three(d[0], d[1], d[2], 8, 8),
            three(d[0], d[1], beside - predictions[6], f.u, f.u),
            three(one, two, d[5], f.u, f.u) if j > 0 else clamp(whole(guess), 0, 511),
            reader.gap_context(place, j, f.u),
            128 * j + hits if j > 0 else 4 * size_class(spread) + b,
        ]
        place_of_hits = 8 * hit_class(j, hits) + 2 * b + t
        e = expectation(predictions, f, contexts, 4 * (2 * size + t) + j, place_of_hits, j)
        value = x[v][j] = reader.decode(decoder, j, e)
        offs.append(16 * value - mean)
        gaps.append(f.take(16 * value))
        g[v][j] = gaps[j]
        return hits_of(predictions, value)


# ---------------------------------------------------------------------------------------------------------------------
# 4  Texture coordinates
# ---------------------------------------------------------------------------------------------------------------------


class Claim(NamedTuple):
    """A 5.3."""

    similar: Row
    affine: Row
    across: Row
    weight: int


def narrowed(numbers: Sequence[int], limit: int, greatest: int) -> list[int]:
    """All shifted right until the greatest absolute value, before that, is below the limit when shifted."""
    shift = 0
    while greatest >> shift >= limit:
        shift += 1
    return [x >> shift for x in numbers]


def product(p: Sequence[int], q: Sequence[int]) -> list[int]:
    """The vector product."""
    return [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]


def dot(p: Sequence[int], q: Sequence[int]) -> int:
    """The scalar product."""
    return sum(x * y for x, y in zip(p, q))


class TexcoordRows:
    """A 5."""

    def __init__(self, reader: ValueReader) -> None:
        self.reader = reader
        self.forecasts = Forecasts([8192, 0, 0, 0, 0, 0, 0])
        self.turns = 0  # A 5.2: T
        self.stride = 16 * reader.largest[0]  # A 5.2: W

    def spot(self, a: int, b: int, w: int) -> tuple[int, int, int] | None:
        """A 5.1: along, beside, weight."""
        at = self.reader.geometry
        if at is None:
            return None
        both = [at[b][i] - at[a][i] for i in range(3)] + [at[w][i] - at[a][i] for i in range(3)]
        both = narrowed(both, 1 << 14, max(map(abs, both)))
        p, q = both[:3], both[3:]
        square = dot(p, p)
        if square == 0:
            return None
        across = product(p, q)
        r = isqrt(dot(across, across))
        along = clamp(div(65536 * dot(p, q), square), -(1 << 19), 1 << 19)
        return along, min(65536 * r // square, 1 << 19), clamp(256 * square // (r + 1), 1, 1 << 16)

    def turn(self, a: int, b: int, c: int) -> int:
        """A 5.2."""
        p, q, r = (self.reader.x[v] for v in (a, b, c))
        area = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
        return (area > 0) - (area < 0)

    def claim(self, v: int, base: Base) -> Claim:
        """A 5.2, A 5.3."""
        x = self.reader.x
        a, b = x[base.a], x[base.b]
        c = b if base.c is None else x[base.c]
        s = 0 if base.c is None else self.turn(base.b, base.a, base.c)
        if s == 0:
            s = 1 if self.turns >= 0 else -1
        q = [b[j] - a[j] for j in range(2)]
        beyond = [-s * q[1], s * q[0]]
        across = [16 * (a[j] + b[j] - c[j]) for j in range(2)]
        affine, similar = across, [8 * (a[j] + b[j]) for j in range(2)]
        spot = self.spot(base.a, base.b, v)
        if spot is None:
            return Claim(similar, affine, across, 1)
        along, beside, weight = spot
        similar = [16 * a[j] + ((along * q[j] + beside * beyond[j]) >> 12) for j in range(2)]
        far = None if base.c is None else self.spot(base.a, base.b, base.c)
        if base.c is None:
            affine = similar
        elif far is not None and far[1] >= 1024 and 65536 * beside // far[1] <= 1 << 19:
            f = 65536 * beside // far[1]
            rest = along + ((f * far[0]) >> 16)
            steps = [(rest * q[j] - f * (c[j] - a[j])) >> 12 for j in range(2)]
            affine = [16 * a[j] + clamp(steps[j], -(1 << 26), 1 << 26) for j in range(2)]
        return Claim(similar, affine, across, weight)

    @staticmethod
    def along(e: int, p: int, q: int) -> int:
        """A 5.6."""
        while max(abs(p), abs(q)) >= 1 << 18:
            p, q = p >> 1, q >> 1
        e = clamp(e, -(1 << 24), 1 << 24)
        return clamp(div(e * p * q, p * p + (p * p + q * q) // 64 + 1), -(1 << 26), 1 << 26)

    def row(self, decoder: RangeDecoder, v: int, place: Place) -> None:
        """A 5.4 to A 5.10."""
        reader, x, g = self.reader, self.reader.x, self.reader.gap
        near, n, count = place.near, len(place.near), len(place.bases)
        claims = [self.claim(v, base) for base in place.bases]
        mean, drift = [0, 0] if place.last is None else [16 * value for value in x[place.last]], [0, 0]  # A 5.5
        if near:
            mean = [rounded(sum(16 * x[u][j] for u in near), n) for j in range(2)]
            drift = [rounded(sum(g[u][j] for u in near), n) for j in range(2)]
        similar, affine, across, spread, rise, run = mean, mean, mean, [0, 0], [0, 0], [0, 0]  # A 5.4
        if claims:
            weights = sum(c.weight for c in claims)
            similar = [rounded(sum(c.weight * c.similar[j] for c in claims), weights) for j in range(2)]
            affine = [rounded(sum(c.weight * c.affine[j] for c in claims), weights) for j in range(2)]
            across = [rounded(sum(c.weight * c.across[j] for c in claims), weights) for j in range(2)]
            off = [sum(abs(c.affine[j] - affine[j]) + abs(c.similar[j] - similar[j]) for c in claims) for j in range(2)]
            spread = [rounded(value, 2 * count) for value in off]
            a, b = x[place.bases[0].a], x[place.bases[0].b]
            rise = [similar[j] - 8 * (a[j] + b[j]) for j in range(2)]
            run = [16 * (b[j] - a[j]) for j in range(2)]
        first, hits = 0, 0
        for j in range(2):
            reach = 16 * reader.largest[j]
            one = claims[0].affine[j] if claims else affine[j]
            two = claims[1].affine[j] if count > 1 else one
            like = similar[j] - affine[j]
            terms = [like, across[j] - affine[j], mean[j] - affine[j], 0, 0, drift[j], one - affine[j]]  # A 5.7
            if j > 0:
                terms[3:5] = [self.along(first, *rise), self.along(first, *run)]
            usual = self.stride >> 4 if near else reach
            hints = [place.error if claims else usual, spread[j], abs(first), abs(like)]
            f = self.forecasts.make(place, j, affine[j], terms, hints, reach, count > 0)
            guess = affine[j] + f.shift
            predictions = [  # A 5.9
                affine[j],
                similar[j],
                one,
                two if place.twin is None else 16 * x[place.twin][j],
                16 * reader.near_value(j, clamp(whole(guess), 0, reader.largest[j])),
                16 * x[near[0]][j] if near else mean[j],
                guess,
            ]
            predictions = [clamp(p, 0, reach) for p in predictions]
            d = [p - predictions[6] for p in predictions]
            b4, t, size = place.number, int(place.twin is not None), size_class(f.e >> 1)  # A 5.10
            contexts = [
                2 * (4 * size + b4) + j,
                three(d[0], d[1], d[2], 8, 8),
                three(d[1], d[2], mean[j] - predictions[6], f.u, f.u),
                three(d[4], across[j] - predictions[6], d[3], 8, f.u),
                reader.gap_context(place, j, f.u),
                128 + hits if j > 0 else 0,
            ]
            place_of_hits = 8 * hit_class(j, hits) + 2 * b4 + t
            e = expectation(predictions, f, contexts, 2 * (4 * size + b4) + j, place_of_hits, j)
            value = x[v][j] = reader.decode(decoder, j, e)
            hits = hits_of(predictions, value)
            gap = f.take(16 * value)
            g[v][j] = gap if count > 0 else self.stride >> 7  # A 5.8
            first = gap
        if near:
            away = sum(abs(16 * x[v][j] - mean[j]) for j in range(2))
            self.stride += (8 * away - self.stride) >> 4
        self.turns += sum(self.turn(base.a, base.b, v) for base in place.bases)


# ---------------------------------------------------------------------------------------------------------------------
# 5  Normals
# ---------------------------------------------------------------------------------------------------------------------


def sign(x: int) -> int:
    """A 6.2."""
    return -1 if x < 0 else 1


class View(NamedTuple):
    """A 6.2."""

    pole: int
    sign: int
    z: int

    def folded(self, p: int, q: int) -> Pair:
        """A 6.2: fold."""
        return sign(p) * (self.z - abs(q)), sign(q) * (self.z - abs(p))

    def see(self, d: Triple) -> Pair:
        """A 6.2: seen."""
        p, q = d[(self.pole + 1) % 3], d[(self.pole + 2) % 3]
        return self.folded(p, q) if self.sign * d[self.pole] < 0 else (p, q)

    def direction(self, p: int, q: int) -> Triple:
        """A 6.2: is."""
        h = self.z - abs(p) - abs(q)
        if h < 0:
            p, q = self.folded(p, q)
        entries = {self.pole: self.sign * h, (self.pole + 1) % 3: p, (self.pole + 2) % 3: q}
        return entries[0], entries[1], entries[2]


class NormalRows:
    """A 6."""

    def __init__(self, reader: ValueReader) -> None:
        self.reader = reader
        self.forecasts = Forecasts([0] * 7)
        self.k = reader.largest[0] // 2
        self.z = 16 * self.k
        vertices = reader.mesh.vertices
        self.o: list[Triple] = [(0, 0, 0)] * vertices
        self.area: list[Triple] = [(0, 0, 0)] * vertices
        self.angle: list[Triple] = [(0, 0, 0)] * vertices
        self.ring: list[Triple] = [(0, 0, 0)] * vertices
        if reader.geometry is not None:
            for v in range(vertices):
                self.expect(v, reader.geometry)
            for v in range(vertices):
                self.average(v)

    def scaled(self, x: Sequence[int]) -> Triple:
        """A 6.1."""
        x = narrowed(x, 1 << 28, max(map(abs, x)))
        total = sum(map(abs, x))
        if total == 0:
            return 0, 0, self.z
        return rounded(self.z * x[0], total), rounded(self.z * x[1], total), rounded(self.z * x[2], total)

    def expect(self, v: int, at: Sequence[Sequence[int]]) -> None:
        """A 6.4, A 6.5."""
        mesh = self.reader.mesh
        area, angle = [0, 0, 0], [0, 0, 0]
        for k in mesh.corners[v][:64]:
            a, b = mesh.vertex[mesh.next(k)], mesh.vertex[mesh.previous(k)]
            x, y = ([clamp(at[u][i] - at[v][i], -(1 << 24), 1 << 24) for i in range(3)] for u in (a, b))
            w = product(x, y)
            area = [s + value for s, value in zip(area, w)]
            *w, c = narrowed([*w, dot(x, y)], 1 << 28, max(map(abs, w)))
            length = isqrt(dot(w, w))
            if length > 0:
                z = abs(c)
                f = 4096 * min(z, length) // max(z, length)
                wide = (f * (2048 + ((711 * (4096 - f)) >> 12))) >> 12
                wide = 4096 - wide if length > z else wide
                wide = 8192 - wide if c < 0 else wide
                angle = [s + div(16384 * value, length) * wide for s, value in zip(angle, w)]
        if any(area):
            self.area[v], self.angle[v] = self.scaled(area), self.scaled(angle)

    def average(self, v: int) -> None:
        """A 6.5: r."""
        mesh, total = self.reader.mesh, [0, 0, 0]
        for k in mesh.corners[v][:64]:
            for u in (mesh.vertex[mesh.next(k)], mesh.vertex[mesh.previous(k)]):
                total = [s + value for s, value in zip(total, self.area[u])]
        self.ring[v] = self.scaled(total) if any(total) else self.area[v]

    def row(self, decoder: RangeDecoder, v: int, place: Place) -> None:
        """A 6.6 to A 6.9."""
        reader, o, near = self.reader, self.o, place.near
        mean = self.scaled([sum(o[u][i] for u in near) for i in range(3)])  # A 6.6
        if not near and place.last is not None:
            mean = o[place.last]
        if not any(self.area[v]):
            self.area[v] = self.angle[v] = self.ring[v] = mean
        own = self.area[v]
        drifts = [sum(o[u][i] - self.area[u][i] for u in near) for i in range(3)]
        drift = self.scaled([own[i] + (rounded(drifts[i], len(near)) if near else 0) for i in range(3)])
        flaps = reader.mesh.flaps(v)
        across = mean
        if flaps:
            across = self.scaled([sum(o[a][i] + o[b][i] - o[c][i] for a, b, c, _ in flaps) for i in range(3)])
        nearest = mean
        candidates = [u for u in (place.twin, *near) if u is not None]
        if candidates:
            nearest = o[min(candidates, key=lambda u: sum(abs(o[u][i] - own[i]) for i in range(3)))]
        twin = o[place.twin] if place.twin is not None else o[near[0]] if near else mean

        pole = max(range(3), key=lambda i: (abs(own[i]), -i))  # A 6.7
        view = View(pole, sign(own[pole]), self.z)
        seen = [view.see(d) for d in (own, self.angle[v], drift, twin, nearest, mean, self.ring[v], across)]
        pair: list[int] = []
        first, hits = 0, 0
        for j in range(2):
            a, w, drifted, same, close, middle, ring, beyond = (d[j] for d in seen)
            terms = [w - a, ring - a, drifted - a, middle - a, beyond - a, close - a, first]  # A 6.8
            hints = [16 if place.error is None else place.error]
            hints += [abs(w - a) + abs(ring - a), abs(first), abs(close - a)]
            f = self.forecasts.make(place, j, a, terms, hints, self.z, True)
            predictions = [a, w, drifted, same, close, middle, a + f.shift]  # A 6.9
            predictions = [clamp(p, -self.z, self.z) for p in predictions]
            d = [p - predictions[6] for p in predictions]
            b, t, size = place.number, int(place.twin is not None), size_class(f.e)
            contexts = [
                2 * (4 * size + b) + j,
                three(d[0], d[1], d[2], 8, 8),
                three(d[3], d[4], d[5], 8, f.u),
                6 * (2 * (2 * view.pole + (view.sign > 0)) + j) + place.degree,
                three(d[0], d[4], first, 4, 4),
                128 + hits if j > 0 else 0,
            ]
            place_of_hits = 8 * hit_class(j, hits) + 2 * b + t
            e = expectation(predictions, f, contexts, 2 * (2 * size + t) + j, place_of_hits, j)
            value = reader.model.value(decoder, e)
            if abs(value) > self.k:
                decoder.fail(f"entry {j} of a normal is {value}")
            hits = hits_of(predictions, value)
            pair.append(16 * value)
            first = reader.gap[v][j] = f.take(16 * value)
        o[v] = view.direction(*pair)
        reader.x[v] = [entry // 16 + self.k for entry in View(2, 1, self.z).see(o[v])]


# ---------------------------------------------------------------------------------------------------------------------
# 6  Faces
# ---------------------------------------------------------------------------------------------------------------------


class FaceReader:
    """A 7: `x` are the rows."""

    def __init__(self, faces: Iterable[Iterable[int]], largest: Sequence[int]) -> None:
        given = [list(face) for face in faces]
        vertices = max((v for face in given for v in face), default=-1) + 1
        self.mesh = Mesh(given, vertices, traverse=False)
        self.largest = list(largest)
        self.model = Model()
        self.done = 0
        self.x: list[Row] = [[0] * len(self.largest) for _ in given]
        self.gap: list[Row] = [[0] * len(self.largest) for _ in given]
        self.next = [0] * len(self.largest)  # A 7.4
        self.memory = [[0] * 256 for _ in self.largest]

    def read(self, payload: bytes, count: int) -> range:
        """A 7.1: the next faces."""
        decoder = RangeDecoder(payload)
        faces = range(self.done, self.done + count)
        for f in faces:
            if decoder.overran():
                break
            hits = 0
            for j in range(len(self.largest)):
                hits = self.component(decoder, f, j, hits)
        decoder.finish()
        self.done += count
        return faces

    def component(self, decoder: RangeDecoder, f: int, j: int, hits: int) -> int:
        """A 7.2 to A 7.5; returns hits."""
        x = self.x
        beside = [self.mesh.opposite[k] // 3 for k in range(3 * f, 3 * f + 3) if k in self.mesh.opposite]
        beside = [g for g in beside if g < f]
        if j > 0:
            beside = sorted(beside, key=lambda g: x[g][j - 1] != x[f][j - 1])
        b = len(beside)
        last = x[f - 1][j] if f > 0 else 0
        n = [x[g][j] for g in beside] + [last] * (3 - b)
        mean, size = 16 * last, 4 * self.largest[j]  # A 7.3
        if b > 0:
            mean = rounded(sum(16 * value for value in n[:b]), b)
            size = rounded(sum(abs(self.gap[g][j]) for g in beside) + sum(abs(16 * y - mean) for y in n[:b]), b) + 1
        h = 31 * n[0] + last if j == 0 else 0  # A 7.4
        for value in x[f][:j]:
            h = 31 * h + value
        slot = (2654435761 * h) % (1 << 32) >> 24
        usual = self.memory[j][slot]
        fresh = min(self.next[j], self.largest[j])
        predictions = [*(16 * value for value in (*n, last, usual, fresh)), mean]  # A 7.5
        alike = (n[0] == n[1]) + 2 * (n[1] == n[2]) + 4 * (n[0] == last) + 8 * (usual == n[0])
        agrees = int(n[0] == n[1]) if j == 0 else 16 + int(hits > 0)
        contexts = [
            4 * (4 * alike + b) + j,
            n[0] % 512,
            (23 * n[0] + last) % 512,
            (23 * n[0] + 7 * n[1] + n[2]) % 512,
            16 * size_class(size) + alike,
            128 * j + hits if j > 0 else f % 3,
        ]
        hit_context = 2 * (2 * b + (n[0] == last)) + agrees
        e = Expectation(predictions, size, contexts, 4 * size_class(size) + j, hit_context, min(j, 2), 3)
        value = self.model.value(decoder, e)
        if not 0 <= value <= self.largest[j]:
            decoder.fail(f"component {j} of face {f} is {value}")
        x[f][j] = self.memory[j][slot] = value
        self.gap[f][j] = 16 * value - mean
        self.next[j] = max(self.next[j], value + 1)
        return hits_of(predictions, value)
