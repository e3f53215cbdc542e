"""Frames that come again are coded once."""

import numpy as np
import pytest

import bsm
from bsm import Attribute, SequenceEncoder, SequenceOptions, TriangleMesh, decode_sequence
from bsm.bitstream.container.packets import Gop
from tests.motion import bending
from tools.payloads import parse_stretches
from tools.surgery import Cursor, scan

STEP = 0.002
TURNS: dict[str, list[int]] = {
    "loop": [*range(6), *range(6)],
    "twos": [t for t in range(6) for _ in range(2)],
    "there and back": [*range(6), *range(5, -1, -1)],
    "still": [0, 1, 2, 3, 4, 5, *[5] * 6],
    "jumps": [0, 1, 2, 3, 4, 5, 2, 0, 5, 3, 1, 4],
}


def options(**changes: object) -> SequenceOptions:
    return SequenceOptions(**{"block_size": 100, "step": STEP, "threads": 1, **changes})  # type: ignore[arg-type]


def coded(
    positions: np.ndarray, faces: np.ndarray, **changes: object
) -> tuple[bytes, np.ndarray, np.ndarray]:
    """The stream, what its frames are, and what they should be."""
    encoder = SequenceEncoder(faces, options(**changes), len(positions))
    data = b"".join(encoder.chunks(positions))
    return data, decode_sequence(data, threads=1)[0], positions[:, encoder.vertex_order]


def places(data: bytes) -> list[list[int]]:
    """The coded frame that each frame of every GOP with a basis shows."""
    gops = (packet for packet, _ in scan(data) if isinstance(packet, Gop))
    return [parse_stretches(Cursor(gop.data[2:]), gop.data[1]) for gop in gops]


@pytest.mark.parametrize("turns", TURNS.values(), ids=list(TURNS))
def test_frames_that_come_again_cost_next_to_nothing(turns: list[int]) -> None:
    positions, faces = bending(6)
    once, _, _ = coded(positions, faces)
    data, decoded, _ = coded(positions[turns], faces)
    assert places(data) == [turns]
    for frame, number in zip(decoded, turns, strict=True):
        assert np.array_equal(frame, decoded[turns.index(number)])
    again, _, _ = coded(np.concatenate([positions, bending(7)[0][6:] + 0.3 * positions[1:]]), faces)
    assert len(once) < len(data) < 1.1 * len(once) < len(again)


def test_what_is_shown_longer_is_nearer() -> None:
    positions, faces = bending(6)
    errors = []
    for turns in ([0, 1, 2, 3, 4, 5], [0, 1, 2, 3, 4, *[5] * 30]):
        _, decoded, original = coded(positions[turns], faces)
        errors.append(np.square(decoded - original).mean(axis=(1, 2))[:6])
    assert errors[1][5] < 0.5 * errors[0][5]


def test_groups_of_frames_tell_of_their_own() -> None:
    positions, faces = bending(6)
    turns = [*range(6), *range(6), *[3, 4, 5, 5, 4, 3] * 2]
    data, decoded, original = coded(positions[turns], faces, gop=12)
    assert places(data) == [turns[:12], [0, 1, 2, 2, 1, 0] * 2]
    assert np.abs(decoded - original).max() < 4 * STEP * np.linalg.norm(
        np.ptp(positions[0], axis=0)
    )


def test_promises_are_kept_as_frames_are_shown() -> None:
    positions, faces = bending(6)
    noise = 1e-5 * np.random.default_rng(0).standard_normal((12, *positions[0].shape))
    data, decoded, original = coded(
        positions[TURNS["loop"]] + noise, faces, promise=bsm.Contract(0.004)
    )
    assert places(data) == [TURNS["loop"]]
    far = np.linalg.norm(decoded - original, axis=2).max() / np.linalg.norm(
        np.ptp(positions[0], axis=0)
    )
    assert far <= 0.004


def test_frames_whose_attributes_differ_are_not_the_same() -> None:
    positions, faces = bending(4)
    heat = np.linspace(0.0, 300.0, len(positions[0]))
    turns, warm = [0, 1, 2, 3, 0, 1, 2, 3], [1.0, 2.0, 3.0, 4.0, 1.0, 5.0, 3.0, 6.0]
    frames = [
        TriangleMesh(
            positions[turn], faces, (Attribute("heat", (heat * factor).astype(np.float32)),)
        )
        for turn, factor in zip(turns, warm, strict=True)
    ]
    data = b"".join(
        SequenceEncoder(faces, options(keep_order=True, attributes={"heat": 0.5}), 8).chunks(frames)
    )
    assert places(data) == [[0, 1, 2, 3, 0, 4, 2, 5]]
    for frame, found in zip(frames, bsm.decode_frames(data), strict=True):
        assert np.abs(found.attributes[0].values - frame.attributes[0].values).max() <= 0.5
