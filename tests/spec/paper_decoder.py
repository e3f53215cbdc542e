"""The codec of the paper, decoded from the bytes of a stream with numpy and the blocks of the reference decoder.

Nothing of the product: R^z is a dense matrix in double precision, Onorm is numpy's QR factorization.
"""

import numpy as np
import reference_decoder as law
import zstandard
from reference_integers import Model, RangeDecoder, decode_connectivity, neighbors_of


def labels_of(payload, graph, blocks):
    """C 10: the part of each vertex."""
    decoder, model, labels, used = RangeDecoder(payload), Model(inputs=3), [], 0
    for v, row in enumerate(graph):
        before = [labels[w] for w in sorted(row, reverse=True) if w < v]
        candidates = sorted([*dict.fromkeys(before)][:4], key=lambda part: -before.count(part))
        c, m, label = len(candidates), len(before), None
        for k, part in enumerate(candidates):
            votes = before.count(part)
            contexts = min(m, 15), min(votes, 7) + 8 * (k < c - 1), min(m - votes, 3) + 4 * (c - 1)
            if model.bit(decoder, contexts, k):
                label = part
                break
        if label is None:
            new = model.bit(decoder, (0, c, int(used < blocks)), 4) or not used
            label = used if new else decoder.uniform(used)
        used = max(used, label + 1)
        labels.append(label)
    decoder.finish()
    return labels


def unpacked(payload, count, bits):
    """F 6: `count` rows of three numbers."""
    size = (3 * count * bits + 7) // 8
    if len(payload) < size:
        payload = zstandard.ZstdDecompressor().decompress(b"\x28\xb5\x2f\xfd" + payload)
    digits = np.unpackbits(np.frombuffer(payload, np.uint8))[: 3 * count * bits].reshape(-1, bits)
    return (digits @ (1 << np.arange(bits)[::-1])).reshape(count, 3) - (1 << bits - 1)


def onorm(columns):
    q, r = np.linalg.qr(columns)
    return q * np.sign(np.diag(r))


def dictionary(block, previous, width, how):
    """M 8.3 to M 8.5, M 8.9: the exact basis, or orthogonal iterations from the columns of the block before."""
    start = law.cosine_columns(block.size, 0, width)
    if follows := previous is not None and len(previous) == block.size:
        start = np.hstack([previous, start[:, previous.shape[1] :]])[:, :width]
    if not follows or not block.connected():
        hashes = [[law.hash_entry(r, j) for j in range(width)] for r in range(block.size)]
        start = start + (2.0**-8 if follows else 0.25) * np.array(hashes)
    power, iterations, shift = (how.power, how.iterations, how.shift) if follows else (2, 128, 2.0**-5)
    inverse = np.linalg.inv(block.laplacian + shift * np.eye(block.size))
    inverse = np.linalg.matrix_power(inverse, power)
    for _ in range(iterations):
        start = onorm(inverse @ start)
    return start


def decode(header, frames):
    """Positions, shape (n, 3), and faces, by a header of the product's names and the payloads of (type, payload)."""
    payloads = dict(frames)
    faces = decode_connectivity(payloads[law.CONNECTIVITY], header.vertices, header.faces)
    graph, how, basis = neighbors_of(faces, header.vertices), header.constants, None
    labels = labels_of(payloads[law.PARTITION], graph, header.blocks)
    cores = [[v for v, label in enumerate(labels) if label == part] for part in range(header.blocks)]
    sums, weights = np.zeros((header.vertices, 3)), np.zeros(header.vertices)
    coded = [law.varints(payload, 2) for kind, payload in frames if kind == law.BLOCK]
    for part, (_, width, payload) in zip(law.chain_of(graph, labels, header.blocks), coded, strict=True):
        block = law.Block(graph, law.grow(graph, cores[part], header.block_size))
        basis = dictionary(block, basis, width, how)
        coefficients = unpacked(payload, width, how.bits) * header.step
        coefficients[0] *= 2.0**how.coarser
        copies = np.maximum(block.degrees, 1.0)
        sums[block.vertices] += copies[:, None] * (basis @ coefficients)
        weights[block.vertices] += copies
    return sums / weights[:, None] * header.scale + np.array(header.center), np.array(faces)
