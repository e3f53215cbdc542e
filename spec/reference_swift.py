"""The extension `swift` in plain Python: rows of values that are quick to decode, beside reference_integers.py.

It decodes payloads of VALUES (A 9), given the faces of the rows, and tangents from their words; declarations and seams
it leaves to others. The rules stand beside what follows them (extension-swift.md, and of extension-attributes.md A 2.3,
A 5 and A 6).
"""

import math

from reference_integers import (
    Mesh,
    Model,
    RangeDecoder,
    clamp,
    div,
    learn_slot,
    rounded,
    size_class,
    whole,
)


def shortened(numbers, bits):  # V: all by the same shift
    shift = max(max(abs(x).bit_length() for x in numbers) - bits, 0)
    return [x >> shift for x in numbers], shift


def cross(p, q):
    return [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]


def dot(p, q):
    return sum(a * b for a, b in zip(p, q))


def less(p, q):
    return [a - b for a, b in zip(p, q)]


def sign(x):  # F 1.4: sgn
    return (x > 0) - (x < 0)


# V 15.2, V 15.6, and with `mixed` A 9.5: how far values of one component are from their guesses.
class Distances:
    def __init__(self, mixed):
        self.plain, self.mixed = {}, Model(3) if mixed else None
        if mixed:
            self.mixed.first_weight = 24576

    def read(self, decoder, guess, size, kind, contexts):
        c, sized = whole(guess), min(size_class(size >> 3), 23)

        def asked(node):
            if self.mixed:
                return self.mixed.bit(decoder, contexts, node)
            place = (sized, kind if node < 12 else None, node)
            slot = self.plain.get(place, (1 << 21, 0))
            bit = decoder.bit(clamp(slot[0] >> 6, 1, 65535))
            self.plain[place] = learn_slot(slot, bit, 43)
            return bit

        o = guess - 16 * c
        w = (abs(o) > 1) + (abs(o) > 4)
        if asked(w):
            return c
        r = -1 if (asked(12 + w) == 1) == (o >= 0) else 1
        k, d, i = max(size.bit_length() - 6, 0), 0, 0
        while d + (1 << k) < 1 << 21 and asked(3 + min(i, 8)):
            d += 1 << k
            i += 1
            k += i >= 4
        if k > 0:
            d += asked(15 + min(i, 3)) << (k - 1)
            d += decoder.uniform(1 << (k - 1))
        return c + r * (1 + d)


class Directions:  # A 6.1 to A 6.3
    def __init__(self, k):
        self.k, self.z = k, 16 * k

    def scaled(self, x):
        x, _ = shortened(x, 28)
        total = sum(map(abs, x))
        return [rounded(self.z * each, total) for each in x] if total else [0, 0, self.z]

    def fold(self, p, q):
        return (1 if p >= 0 else -1) * (self.z - abs(q)), (1 if q >= 0 else -1) * (self.z - abs(p))

    def view(self, x):
        pole = max(range(3), key=lambda i: (abs(x[i]), -i))
        return pole, -1 if x[pole] < 0 else 1

    def seen(self, view, x):
        pole, s = view
        pair = x[(pole + 1) % 3], x[(pole + 2) % 3]
        return self.fold(*pair) if s * x[pole] < 0 else pair

    def direction(self, view, pair):
        pole, s = view
        h, x = self.z - abs(pair[0]) - abs(pair[1]), [0, 0, 0]
        x[pole] = s * h
        x[(pole + 1) % 3], x[(pole + 2) % 3] = self.fold(*pair) if h < 0 else pair
        return x


class Rows:  # A 9: of one group of components
    def __init__(self, faces, rows, largest, swift, normals=False, geometry=None):
        self.mesh, self.largest, self.normals, self.geometry = (
            Mesh(faces, rows, False),
            largest,
            normals,
            geometry,
        )
        self.distances = [Distances(swift == 2) for _ in largest]
        self.values, self.tallies, self.errors, self.turns = [], [], [], 0
        self.directions = Directions(largest[0] // 2)
        self.own, self.surface = (
            [],
            [self.angle(v) for v in range(rows)] if normals and geometry else [],
        )

    def read(self, payload, count):
        decoder = RangeDecoder(payload)
        for _ in range(count):
            self.row(decoder, len(self.values))
        decoder.finish()
        return self.values

    def angle(self, v):  # A 6.4, from all corners
        vertex, at, total = self.mesh.vertex, self.geometry, [0, 0, 0]
        for k in self.mesh.corners[v]:
            x, y = (less(at[vertex[end[k]]], at[v]) for end in (self.mesh.next, self.mesh.previous))
            w, shift = shortened(cross(x, y), 28)
            c, length = dot(x, y) >> shift, math.isqrt(dot(w, w))
            if length == 0:
                continue
            z = abs(c)
            f = 4096 * min(z, length) // max(z, length)
            a = (f * (2048 + ((711 * (4096 - f)) >> 12))) >> 12
            a = 4096 - a if length > z else a
            a = 8192 - a if c < 0 else a
            total = [t + div(16384 * each, length) * a for t, each in zip(total, w)]
        return self.directions.scaled(total) if any(total) else [0, 0, 0]

    def around(self, v):  # A 9.2
        vertex, ends, bases = self.mesh.vertex, [], []
        for k in self.mesh.corners[v]:
            a, b = vertex[self.mesh.next[k]], vertex[self.mesh.previous[k]]
            ends += [u for u in (a, b) if u < v]
            if a < v and b < v and a != b:
                c = vertex[self.mesh.opposite[k]] if k in self.mesh.opposite else v
                bases.append((a, b, c if c < v else None))
        return ends[:32], bases[:8]

    def row(self, decoder, v):
        ends, bases = self.around(v)
        sums = [sum(self.tallies[u][q] for u in ends) for q in range(3)]
        best = sums.index(min(sums))  # A 9.3
        first = 160 if self.normals else 16 * self.largest[0]
        s = sum(self.errors[u] for u in ends) // (len(ends) * len(self.largest)) if ends else first
        candidates = (
            self.normal_candidates(v, ends) if self.normals else self.candidates(v, ends, bases)
        )
        guesses, shown = candidates[best], candidates
        if self.normals:  # A 9.7
            view = self.directions.view(self.directions.scaled(candidates[best]))
            guesses = self.directions.seen(view, self.directions.scaled(candidates[best]))
            shown = [(p[(view[0] + 1) % 3], p[(view[0] + 2) % 3]) for p in candidates]
            r = min((len(ends) + 1) >> 1, 3)
        else:
            guesses = [clamp(g, 0, 16 * most) for g, most in zip(guesses, self.largest)]
            r = min(sum(c is not None for _, _, c in bases), 3)
        x, gaps = [], []
        for j, distances in enumerate(self.distances):  # A 9.4, A 9.5
            size, d = ((8 - j) * s + sum(map(abs, gaps))) >> 3, gaps[-1] if j else 0
            kind = min(size_class(abs(d) >> 3), 11) if j else 3 * r + best
            h = few(self.errors[max(ends)]) if ends else 7
            contexts = [
                12 * min(size_class(size >> 3), 23) + kind,
                3 * (8 * few(shown[0][j] - shown[1][j]) + few(shown[0][j] - shown[2][j])) + best,
                2 * (8 * h + few(d)) + (d > 0) if j else 8 * h + few(size),
            ]
            x.append(distances.read(decoder, guesses[j], size, kind, contexts))
            gaps.append(16 * x[j] - guesses[j])
            low, high = (
                (-self.largest[0] // 2, self.largest[0] // 2)
                if self.normals
                else (0, self.largest[j])
            )
            if not low <= x[j] <= high:
                decoder.fail("a value is out of its range")
        target = [16 * each for each in x]
        if self.normals:
            target = self.directions.direction(view, target)
            self.own.append(target)
            x = [each // 16 + self.directions.k for each in self.directions.seen((2, 1), target)]
        self.values.append(x)
        self.tallies.append([min(sum(map(abs, less(p, target))), 1 << 20) for p in candidates])
        self.errors.append(min(sum(map(abs, gaps)), 1 << 24) if ends else 128)
        if len(x) == 2 and self.geometry and not self.normals:  # A 5.2
            self.turns += sum(self.turn(a, b, v) for a, b, _ in bases)

    def candidates(self, v, ends, bases):  # A 9.6
        columns, x = range(len(self.largest)), self.values
        last = [16 * x[v - 1][j] if v else 8 * self.largest[j] for j in columns]
        mean = (
            [rounded(16 * sum(x[u][j] for u in ends), len(ends)) for j in columns] if ends else last
        )
        flaps = [base for base in bases if base[2] is not None]
        across = (
            [
                rounded(16 * sum(x[a][j] + x[b][j] - x[c][j] for a, b, c in flaps), len(flaps))
                for j in columns
            ]
            if (flaps)
            else mean
        )
        if not self.geometry or len(self.largest) != 2:
            return across, mean, last
        if not bases:
            return across, across, mean
        claims = [self.claim(v, *base) for base in bases]
        weights = sum(w for _, _, w in claims)
        affine, similar = (
            [rounded(sum(claim[i][j] * claim[2] for claim in claims), weights) for j in columns]
            for i in (0, 1)
        )
        return affine, across, similar

    def turn(self, a, b, c):  # A 5.2
        a, b, c = (self.values[u] for u in (a, b, c))
        return sign((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))

    def spot(self, w, a, b):  # A 5.1
        numbers, _ = shortened(
            less(self.geometry[b], self.geometry[a]) + less(self.geometry[w], self.geometry[a]), 14
        )
        p, q = numbers[:3], numbers[3:]
        if not any(p):
            return None
        r, square = math.isqrt(dot(cross(p, q), cross(p, q))), dot(p, p)
        along = clamp(div(65536 * dot(p, q), square), -(1 << 19), 1 << 19)
        return (
            along,
            clamp(65536 * r // square, 0, 1 << 19),
            clamp(256 * square // (r + 1), 1, 1 << 16),
        )

    def claim(self, v, a, b, c):  # A 5.3
        x = self.values
        third, s = x[b if c is None else c], 0 if c is None else self.turn(b, a, c)
        s = s or (1 if self.turns >= 0 else -1)
        affine = [16 * (x[a][j] + x[b][j] - third[j]) for j in (0, 1)]
        similar = [8 * (x[a][j] + x[b][j]) for j in (0, 1)]
        spot = self.spot(v, a, b)
        if spot is None:
            return affine, similar, 1
        q = less(x[b], x[a])
        across = (-s * q[1], s * q[0])
        similar = [16 * x[a][j] + ((spot[0] * q[j] + spot[1] * across[j]) >> 12) for j in (0, 1)]
        far = self.spot(c, a, b) if c is not None else None
        if c is None:
            affine = similar
        elif far and far[1] >= 1024 and (f := 65536 * spot[1] // far[1]) <= 1 << 19:
            rest = spot[0] + ((f * far[0]) >> 16)
            moves = [(rest * q[j] - f * (x[c][j] - x[a][j])) >> 12 for j in (0, 1)]
            affine = [16 * x[a][j] + clamp(moves[j], -(1 << 26), 1 << 26) for j in (0, 1)]
        return affine, similar, spot[2]

    def normal_candidates(self, v, ends):  # A 9.7
        mean = [0, 0, self.directions.z] if v == 0 else self.own[v - 1]
        if ends:
            mean = [rounded(sum(self.own[u][i] for u in ends), len(ends)) for i in range(3)]
        if not self.geometry:
            self.surface.append([0, 0, 0])
        if not any(self.surface[v]):
            self.surface[v] = self.directions.scaled(mean)
        a, drift = self.surface[v], [0, 0, 0]
        if ends:
            drift = [
                rounded(sum(self.own[u][i] - self.surface[u][i] for u in ends), len(ends))
                for i in range(3)
            ]
        return a, [p + q for p, q in zip(a, drift)], mean


def few(x):  # A 9.5: f
    return min(size_class(abs(x) >> 3), 7)


def plus(p, q):
    return [a + b for a, b in zip(p, q)]


def of_length_1(x):
    length = math.sqrt(dot(x, x))
    return [each / length for each in x]


def tangents(faces, bases, at, coordinates, normals, largest, words):
    """The values of tangents (A 9.9, A 9.10), of rows with the faces `faces`.

    `bases` are the faces of the rows of normals and of texture coordinates, `at` is the place of each tangent's row on
    the grid, `coordinates` are words and `normals` values, `largest` is the greatest first word.
    """
    turned, gradients = [0] * len(words), [[0.0, 0.0, 0.0] for _ in words]
    of_normals = [[0.0, 0.0, 1.0] for _ in words]
    seen = set()
    for rows, of_normal, of_coordinates in zip(faces, *bases):
        h, gradient = gradient_of(
            [at[row] for row in rows], [coordinates[row] for row in of_coordinates]
        )
        for row, normal in zip(rows, of_normal):
            if row not in seen:
                seen.add(row)
                of_normals[row] = normals[normal]
            turned[row] += h
            gradients[row] = plus(gradients[row], gradient)
    k = largest // 4
    return [
        tangent(k, *row)
        for row in zip(gradients, [1.0 if h >= 0 else -1.0 for h in turned], of_normals, words)
    ]


def gradient_of(at, words):  # A 9.9: H, and G over its length
    b, c = ([clamp(x, -(1 << 24), 1 << 24) for x in less(at[k], at[0])] for k in (1, 2))
    (u_b, v_b), (u_c, v_c) = less(words[1], words[0]), less(words[2], words[0])
    h = sign(u_b * v_c - u_c * v_b)
    gradient = [float(h * (v_c * p - v_b * q)) for p, q in zip(b, c)]
    if not any(gradient):
        return 0, [0.0, 0.0, 0.0]
    return h, of_length_1(gradient)


def tangent(k, s, hand, n, word):
    height = dot(s, n)
    x = [each - height * across for each, across in zip(s, n)]
    if dot(x, x) < 2.0**-20:
        i = min(range(3), key=lambda j: (abs(n[j]), j))
        x = [float(j == i) - n[i] * n[j] for j in range(3)]
    g = of_length_1(x)
    b = cross(n, g)
    t = word[0] - 2 * k
    p, q = k - abs(t), sign(t) * min(abs(t), 2 * k - abs(t))
    return [
        *of_length_1([p * along + q * aside for along, aside in zip(g, b)]),
        -hand if word[1] else hand,
    ]
