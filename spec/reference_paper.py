"""The extension `paper` for reference_decoder.py: packed coefficients, labels of parts, exact bases, Onorm in doubles.

The rules stand beside what follows them (extension-paper.md). Packed coefficients that are shortened need zstandard.
"""

import math

import numpy as np
import reference_decoder as law
from reference_integers import CorruptError, Model, NumericError, RangeDecoder

# F 10.1: the largest value of each entry of `paper`; all but the shift are whole numbers
LARGEST = {
    "bits": 32,
    "coarser": 30,
    "exact": 1,
    "power": 64,
    "iterations": 1024,
    "key_iterations": 1024,
}
LARGEST |= {"shift": 2.0**30, "springs": 1}
LEAST = {"power": 1, "iterations": 1, "key_iterations": 1, "shift": 2.0**-30}


def settings_of(header):
    """F 10: the entries of `paper` by their names, and `onorm`."""
    found = dict(zip(LARGEST, header["paper"], strict=True))
    for name, value in found.items():
        law.require(LEAST.get(name, 0) <= value <= LARGEST[name], f"{name} is out of range")
        law.require(name == "shift" or value == int(value), f"{name} is not a whole number")
    law.require(not header["onorm"] or found["bits"], "onorm without packed coefficients")  # F 10.2
    return {name: value if name == "shift" else int(value) for name, value in found.items()}


def unpacked(payload, count, bits):
    """F 6, M 9.10: `count` levels of three numbers, row by row."""
    size = -(-3 * count * bits // 8)
    law.require(len(payload) <= size, "packed levels are too long")
    data = payload if len(payload) == size else decompressed(b"\x28\xb5\x2f\xfd" + payload, size)
    digits = np.unpackbits(np.frombuffer(data, np.uint8))
    law.require(not digits[3 * count * bits :].any(), "bits after packed levels are not 0")
    numbers = digits[: 3 * count * bits].reshape(-1, bits) @ (1 << np.arange(bits)[::-1])
    return numbers.reshape(count, 3) - (1 << bits - 1)


def decompressed(frame, size):
    """F 6.2: the content of a zstd frame that says that it has `size` bytes."""
    import zstandard

    try:
        about, decoder = (
            zstandard.get_frame_parameters(frame),
            zstandard.ZstdDecompressor().decompressobj(),
        )
        law.require(
            about.content_size == size and about.window_size <= 8 << 20, "zstd says another size"
        )
        law.require(
            not about.has_checksum and not about.dict_id, "zstd has a checksum or a dictionary"
        )
        data = decoder.decompress(frame)
    except zstandard.ZstdError as error:
        raise CorruptError(f"zstd: {error}") from None
    law.require(
        decoder.eof and not decoder.unused_data and len(data) == size,
        "a zstd frame of another length",
    )
    return data


def labels_of(payload, graph, blocks):
    """C 10: the part of each vertex."""
    decoder, model, labels, used = RangeDecoder(payload), Model(inputs=3), [], 0
    for v, row in enumerate(graph):
        before = [labels[w] for w in sorted(row, reverse=True) if w < v]
        candidates = sorted([*dict.fromkeys(before)][:4], key=lambda part: -before.count(part))
        c, m, label = len(candidates), len(before), None
        for k, part in enumerate(candidates):
            votes = before.count(part)
            # C 10.3.
            contexts = min(m, 15), min(votes, 7) + 8 * (k < c - 1), min(m - votes, 3) + 4 * (c - 1)
            if model.bit(decoder, contexts, k):
                label = part
                break
        if label is None:
            new = model.bit(decoder, (0, c, int(used < blocks)), 4) or not used  # C 10.4
            label = used if new else decoder.uniform(used)
        law.require(label < blocks, "more parts than blocks")
        used = max(used, label + 1)
        labels.append(label)
        if decoder.overran():
            decoder.fail("labels are missing")
    decoder.finish()
    law.require(used == blocks, "more blocks than parts")  # C 10.6
    return labels


def onorm(columns, order, alone):
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
        alone += range(good, width)
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
    raise NumericError("columns cannot be made orthonormal")


class Chain(law.Chain):
    """M 8.3 to M 8.5, M 8.9, M 9.10 by a header's `paper` and `onorm`."""

    def __init__(self, header, graph):
        super().__init__(header, graph)
        self.how, self.apart = settings_of(header), header["onorm"]
        self.shift = self.how["shift"]

    def coefficients(self, width, payload):
        if not self.how["bits"]:
            return super().coefficients(width, payload)
        levels = unpacked(payload, width, self.how["bits"])
        levels[0] <<= self.how["coarser"]
        return levels * self.header["step"]

    def around(self, block):
        if self.how["springs"]:
            return super().around(block)
        return np.zeros(block.size), np.zeros((block.size, 3))

    def solutions(self, block):  # M 8.5: z and t
        if self.follows(block):
            return self.how["power"], self.how["iterations"]
        return (2, 128) if self.exact(block) else (self.how["power"], self.how["key_iterations"])

    def exact(self, block):
        return self.how["exact"] and not self.follows(block)

    def hashes(self, block):
        return self.exact(block) or super().hashes(block)

    def improved(self, block, solver, start):
        if self.exact(block):
            exact = law.Solver(block.laplacian, solver.springs, 2.0**-5)  # M 8.5
            exact.alone = solver.alone
            return exact.iterate(start, 256)
        if not self.apart:
            return super().improved(block, solver, start)
        columns, result, (power, iterations) = (
            start[solver.order],
            np.zeros_like(start),
            self.solutions(block),
        )
        for _ in range(iterations):  # M 8.9
            for solution in range(1, power + 1):
                columns = solver.solve(columns)
                if solution % self.apart == 0 or solution == power:
                    columns = onorm(columns, solver.order, solver.alone).astype(np.float32)
        result[solver.order] = columns
        return result

    def onorms(self, block):  # M 14.3
        power, iterations = self.solutions(block)
        if not self.apart or self.exact(block):
            return super().onorms(block)
        return 2 * iterations * math.ceil(power / self.apart)
