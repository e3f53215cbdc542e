"""The extension `paper`, from its text, with the parts of the core that the reference decoder has: the same bits."""

import numpy as np
import reference_decoder as law
from paper_decoder import labels_of, unpacked
from reference_integers import RangeDecoder, decode_connectivity, neighbors_of


def onorm(columns, order):
    """M 8.9: M 8.1 in double precision, panels of 32 columns, 2^-36."""
    x = columns.astype(np.float64)
    lengths = law.ordered_sum(x * x)
    for begin in range(0, x.shape[1], 32):
        panel, later = x[:, begin : begin + 32], x[:, begin + 32 :]
        gram, width = law.product(panel.T, panel), panel.shape[1]
        upper, ends, good = np.zeros((width, width)), np.zeros(width), width
        for j in range(width):
            row = gram[j]
            for i in range(j):
                row[j:] -= upper[i, j] * upper[i, j:]
            if not 2.0**-36 * lengths[begin + j] < row[j] < np.inf:
                good = j
                break
            ends[j] = 1.0 / np.sqrt(row[j])
            upper[j, j:] = row[j:] * ends[j]
        turn = np.zeros((good, good))
        for j in range(good)[::-1]:
            for i in range(j + 1, good):
                turn[j] += (-upper[j, i] * ends[j]) * turn[i]
            turn[j, j] = ends[j]
        panel[:, :good] = law.product(panel[:, :good], turn)
        for j in range(begin + good, begin + width):
            x[:, j] = one_by_one(x[:, :j], x[:, j], order)
        shares = law.product(panel.T, later)
        for own, share in zip(panel.T, shares, strict=True):
            later -= own[:, None] * share
    return x


def one_by_one(before, column, order):
    """M 8.8, in double precision; the hash column is one of single precision."""
    hashed = np.array([law.hash_entry(row, before.shape[1]) for row in order]).astype(np.float32)
    for v in (column.copy(), hashed.astype(np.float64)):
        for _ in range(4):
            square = law.ordered_sum(v * v)
            if not 0.0 < square < np.inf:
                break
            v *= 1.0 / np.sqrt(square)
            for own, share in zip(before.T, law.product(before.T, v[:, None]), strict=True):
                v -= own * share
            square = law.ordered_sum(v * v)
            if square > 0.25:
                return v * (1.0 / np.sqrt(square))
    raise law.NumericError("columns cannot be made orthonormal")


class Chain(law.Chain):
    """M 8.3 to M 8.5, M 8.9, M 9.10 by a header's `paper` and `onorm`."""

    def __init__(self, header, graph):
        super().__init__(vars(header), graph)
        self.how, self.apart = header.constants, header.onorm

    def coefficients(self, width, payload):
        how, step = self.how, self.header["step"]
        if how.bits:
            levels = unpacked(payload, width, how.bits)
            levels[0] <<= how.coarser
            return levels * step
        decoder = RangeDecoder(payload)
        points = np.array(self.model.block(decoder, width)) * (step / 2)
        decoder.finish()
        return points

    def iterated(self, solver, start, iterations):
        """M 8.9."""
        columns, result = start[solver.order], np.zeros_like(start)
        for _ in range(iterations):
            for solution in range(1, self.how.power + 1):
                columns = solver.solve(columns)
                if solution % self.apart == 0 or solution == self.how.power:
                    columns = onorm(columns, solver.order).astype(np.float32)
        result[solver.order] = columns
        return result

    def decode(self, block, width, payload):
        how, points, follows = self.how, self.coefficients(width, payload), self.follows(block)
        springs, pulls = np.zeros(block.size), np.zeros((block.size, 3))
        if how.springs:
            springs, pulls = law.surroundings(self.graph, block, self.known)
        exact = how.exact and not follows
        start = law.cosine_columns(block.size, 0, width).astype(np.float32)
        if follows:
            start = np.hstack([self.dictionary, start[:, self.dictionary.shape[1] :]])[:, :width]
        if exact or not block.connected():
            hashes = np.array([[law.hash_entry(r, j) for j in range(width)] for r in range(block.size)])
            start = start + ((2.0**-8 if follows else 0.25) * hashes).astype(np.float32)
        solver, iterations = law.Solver(block.laplacian, springs, how.shift), how.key_iterations
        if follows:
            iterations = how.iterations
        if exact:
            self.dictionary = law.Solver(block.laplacian, springs, 2.0**-5).iterate(start, 2 * 128)
        elif self.apart:
            self.dictionary = self.iterated(solver, start, iterations)
        else:
            self.dictionary = solver.iterate(start, how.power * iterations)
        positions = law.product(self.dictionary, points) + solver.extend(springs, pulls)
        self.known.add(block, positions)
        return positions


def decode(header, frames):
    """Positions, shape (n, 3), and faces, by a header of the product's names and the payloads of (type, payload)."""
    payloads, parts, blended = dict(frames), header.blocks, law.Known(header.vertices)
    faces = decode_connectivity(payloads[law.CONNECTIVITY], header.vertices, header.faces)
    graph = neighbors_of(faces, header.vertices)
    labels = law.derive_labels(graph, parts)
    if law.PARTITION in payloads:
        labels = labels_of(payloads[law.PARTITION], graph, parts)
    coded = [law.varints(payload, 2) for kind, payload in frames if kind == law.BLOCK]
    with np.errstate(all="ignore"):
        for part, (index, width, payload) in zip(law.chain_of(graph, labels, parts), coded, strict=True):
            if index % (header.key_interval or parts) == 0:
                chain = Chain(header, graph)
            core = [v for v, label in enumerate(labels) if label == part]
            block = law.Block(graph, law.grow(graph, core, header.block_size))
            blended.add(block, chain.decode(block, width, payload))
        positions = law.smooth(graph, blended.sums / blended.weights[:, None], header.smoothing)
    return positions * header.scale + np.array(header.center), np.array(faces)
