"""A stream to positions and faces in the several ways that must agree."""

from __future__ import annotations

from itertools import pairwise
from random import Random

import numpy as np

from bitstream.container.reader import END_OF_STREAM, NEED_DATA
from bitstream.errors import BsmError
from bitstream.limits import DEFAULT_LIMITS, Limits
from codec.sequence.decoder import FrameEvent, SequenceDecoder, decode_sequence
from codec.static.decoder import Decoder, decode
from codec.static.events import BlockEvent, ConnectivityEvent, LossEvent, RefinementEvent
from tools.proof.tally import Decoded, Outcome
from tools.surgery import first_entries

GOP_FRAMES = 23
"""Header key that only sequences store."""


def is_sequence(stream: bytes) -> bool:
    """Whether the header says so; what is no stream is taken for a mesh."""
    return bool(first_entries(stream).get(GOP_FRAMES))


def whole(stream: bytes, limits: Limits = DEFAULT_LIMITS, threads: int = 1) -> Outcome:
    """By the functions for complete streams."""
    try:
        if is_sequence(stream):
            return decode_sequence(stream, limits, threads)
        mesh = decode(stream, limits, threads)
        return mesh.positions, mesh.faces
    except BsmError as error:
        return error


def piecewise(
    stream: bytes, random: Random, limits: Limits = DEFAULT_LIMITS, threads: int = 1, tolerant: bool = False
) -> tuple[Outcome, int]:
    """By events, from pieces of random lengths; and how many losses were told."""
    try:
        return _by_events(stream, random, limits, threads, tolerant)
    except BsmError as error:
        return error, 0


def _by_events(stream: bytes, random: Random, limits: Limits, threads: int, tolerant: bool) -> tuple[Decoded, int]:
    kind = SequenceDecoder if is_sequence(stream) else Decoder
    faces, vertices, losses = np.zeros((0, 3), np.int32), 0, 0
    positions: list[np.ndarray] = []
    frames: list[np.ndarray] = []
    with kind(limits, threads, tolerant=tolerant) as decoder:
        for piece in (*_pieces(stream, random), b""):
            if piece:
                decoder.receive_data(piece)
            else:
                decoder.receive_eof()
            while (event := decoder.next_event()) is not NEED_DATA and event is not END_OF_STREAM:
                match event:
                    case ConnectivityEvent():
                        faces, vertices = event.faces, event.vertices
                        positions = [np.full((event.vertices, 3), np.nan)]
                        positions[0][event.loose.vertices] = event.loose.positions
                    case BlockEvent() | RefinementEvent():
                        positions[0][event.vertices] = event.positions
                    case FrameEvent():
                        frames.append(event.positions)
                    case LossEvent():
                        losses += 1
    if kind is SequenceDecoder:
        return (np.array(frames).reshape(len(frames), vertices, 3), faces), losses
    return (positions[0] if positions else np.zeros((0, 3)), faces), losses


def _pieces(stream: bytes, random: Random) -> list[bytes]:
    cuts = sorted({0, len(stream), *(random.randrange(len(stream) + 1) for _ in range(random.choice((0, 1, 4, 30))))})
    return [stream[first:last] for first, last in pairwise(cuts) if last > first]
