"""The codec of the paper, decoded from the bytes of a stream with numpy and the integers of the reference decoder.

Nothing of the product: R^z is a dense matrix in double precision, Onorm is numpy's QR factorization.
"""

import numpy as np
import reference_decoder as law
from reference_integers import decode_connectivity, neighbors_of
from reference_paper import labels_of, unpacked


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
    power, iterations, shift = (
        (how.power, how.iterations, how.shift) if follows else (2, 128, 2.0**-5)
    )
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
    cores = [
        [v for v, label in enumerate(labels) if label == part] for part in range(header.blocks)
    ]
    sums, weights = np.zeros((header.vertices, 3)), np.zeros(header.vertices)
    coded = [law.varints(payload, 2) for kind, payload in frames if kind == law.BLOCK]
    for part, (_, width, payload) in zip(
        law.chain_of(graph, labels, header.blocks), coded, strict=True
    ):
        block = law.Block(graph, law.grow(graph, cores[part], header.block_size))
        basis = dictionary(block, basis, width, how)
        coefficients = unpacked(payload, width, how.bits) * header.step
        coefficients[0] *= 2.0**how.coarser
        copies = np.maximum(block.degrees, 1.0)
        sums[block.vertices] += copies[:, None] * (basis @ coefficients)
        weights[block.vertices] += copies
    return sums / weights[:, None] * header.scale + np.array(header.center), np.array(faces)
