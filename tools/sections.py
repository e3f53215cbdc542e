"""Meshes in sections of any kind, sound or not, put together without the encoder: for vectors, proof and bombs."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from random import Random
from typing import Any

import numpy as np

from bsm.bitstream.coefficients.adaptive import CoefficientModel, encode_coefficients, encode_layers
from bsm.bitstream.coefficients.packed import pack_coefficients
from bsm.bitstream.coefficients.priors import detail_experience
from bsm.bitstream.connectivity.faces import EncodedConnectivity, encode_connectivity
from bsm.bitstream.container.wire import FrameType, write_varint
from bsm.bitstream.fields.levels import LevelsEncoder
from bsm.codec.geometry.mesh import TriangleMesh
from tools.surgery import Frames, header_frame, stream_of

BITS = 6
"""Of packed levels."""
SPREAD = 9
"""Random levels are at most so large."""

WriteBlock = Callable[[int, int], bytes]
"""What stands behind the index in a BLOCK, told the section and the block's number in it."""


def in_sections(coded: EncodedConnectivity, counts: Sequence[int], write: WriteBlock, **fields: Any) -> Frames:
    """Frames of a mesh with a section behind each of its cuts, and one before the first."""
    ends = [cut.faces for cut in coded.cuts]
    pairs = zip((last - first for first, last in pairwise((0, *ends))), counts[:-1], strict=True)
    announced = {
        "vertices": len(coded.vertex_order),
        "faces": len(coded.faces),
        "blocks": sum(counts),
        "sections": [number for pair in pairs for number in pair],
    }
    frames: Frames = [header_frame(**announced | fields)]
    index = 0
    for section, (piece, count) in enumerate(zip(coded.pieces(coded.cuts), counts, strict=True)):
        frames.append((FrameType.CONNECTIVITY, piece))
        for number in range(count):
            frames.append((FrameType.BLOCK, write_varint(index) + write(section, number)))
            index += 1
    return frames


def random_sections(random: Random, mesh: TriangleMesh) -> bytes | None:
    """A stream of any sections, blocks, options and levels with the faces of a mesh; None if they cannot be cut."""
    used, corners = np.unique(mesh.faces, return_inverse=True)
    faces, vertices = corners.reshape(-1, 3).astype(np.int32), len(used)
    asked = sorted({random.randrange(1, len(faces) + 1) for _ in range(random.randrange(1, 8))})
    coded = encode_connectivity(faces, vertices, asked)
    kept, counts, begin = [], [], 0
    for cut in coded.cuts:
        if begin < cut.vertices < vertices:  # a section must have vertices
            kept.append(cut)
            counts.append(cut.vertices - begin)
            begin = cut.vertices
    if not kept:
        return None
    sizes = [*counts, vertices - begin]
    counts = [random.randrange(1, min(size, 4) + 1) for size in sizes]
    rooms = [size * 103 // (100 * count) + 1 for size, count in zip(sizes, counts, strict=True)]
    block_size = min(vertices, int(max(*rooms, -(-vertices // sum(counts))) * random.choice((1.0, 1.15, 2.0))))
    columns = random.randrange(1, max(1, min(block_size // 2, 12)) + 1)
    numbers = np.random.default_rng(random.randrange(1 << 30))
    options = _options(random, block_size)
    coded = replace(coded, cuts=tuple(kept))
    fields = options | {"block_size": block_size, "coefficients": columns}
    frames = in_sections(coded, counts, _writer(options, columns, numbers), **fields)
    return stream_of([*frames, *_layers(options, coded, numbers)])


def _options(random: Random, block_size: int) -> dict[str, Any]:
    """Some fields of a header."""
    choices: dict[str, Any] = {
        "key_interval": random.randrange(1, 4),
        "power": random.choice((1, 3)),
        "iterations": 2,
        "key_iterations": random.choice((1, 4)),
        "shift": random.choice((2.0**-4, 4.0)),
        "coding": 0,
        "stiffness": random.choice((0.0, 1.0)),
        "smoothing": random.choice((0.5, 4.0)),
        "key_seed": 1,
        "refinements": random.choice(([2.0**-16, 0.0], [2.0**-16, 0.5, 2.0**-18, 0.0])),
    }
    chosen = {name: value for name, value in choices.items() if random.random() < 0.25}
    if chosen.get("coding") == 0:
        chosen |= {"bits": BITS, "coarser": random.randrange(3)}
    elif random.random() < 0.5:
        chosen |= {"details": random.randrange(1, max(1, min(block_size // 2, 12)) + 1), "detail_step": 2.0**-6}
    return {"step": 2.0**-6} | chosen


def _writer(options: dict[str, Any], columns: int, numbers: np.random.Generator) -> WriteBlock:
    """Writes blocks of random levels, by models that live as long as their chains."""
    interval = options.get("key_interval", 0)
    details = -(-options.get("details", 0) // 3)
    models: list[CoefficientModel] = []

    def write(section: int, number: int) -> bytes:
        width = int(numbers.integers(1, columns + 1))
        levels = numbers.integers(-SPREAD, SPREAD + 1, (width, 3), np.int32)
        if number == 0 or (interval and number % interval == 0):
            models[:] = [CoefficientModel(columns), CoefficientModel(details, detail_experience())]
        if options.get("coding", 1) == 0:
            payload = pack_coefficients(levels.ravel() + (1 << (BITS - 1)), BITS)
        elif details:
            above = numbers.integers(-SPREAD, SPREAD + 1, (int(numbers.integers(details + 1)), 3), np.int32)
            payload = encode_layers(models[0], levels, models[1], above)
        else:
            payload = encode_coefficients(models[0], levels)
        return write_varint(width) + payload

    return write


def _layers(
    options: dict[str, Any], coded: EncodedConnectivity, numbers: np.random.Generator
) -> Iterator[tuple[int, bytes]]:
    """Random levels of refinement, a layer in two frames."""
    size = len(coded.vertex_order)
    ratios = options.get("refinements", [])[1::2]
    for layer, ratio in enumerate(ratios):
        levels = numbers.integers(-SPREAD, SPREAD + 1, (size, 3 if ratio else 1))
        encoder, half = LevelsEncoder(coded.faces, levels), -(-size // 2)
        for first, count in ((0, half), (half, size - half)):
            if count:
                payload = write_varint(layer) + write_varint(first) + write_varint(count)
                yield FrameType.REFINEMENT, payload + encoder.chunk(count)
