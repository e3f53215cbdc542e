"""A stream to positions and faces in the several ways that must agree."""

from itertools import pairwise
from random import Random

import numpy as np

from bsm.bitstream.container.header import HEADER_FIELDS
from bsm.bitstream.errors import BsmError
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits
from bsm.codec.decoding import Decoder, SequenceDecoder, decode
from bsm.codec.events import (
    END_OF_STREAM,
    NEED_DATA,
    AttributeEvent,
    BlockEvent,
    ConnectivityEvent,
    FrameEvent,
    LossEvent,
    RefinementEvent,
)
from bsm.codec.geometry.attributes import Attribute
from tools.attack.tally import Decoded, Outcome
from tools.surgery import first_entries
from tools.vectors.store import Arrays, arrays_of, arrays_of_frames


def is_sequence(stream: bytes) -> bool:
    """Whether the header says so; other bytes are taken for a mesh."""
    return bool(first_entries(stream).get(HEADER_FIELDS["sequence"].key))


def whole(stream: bytes, limits: Limits = DEFAULT_LIMITS, threads: int = 1) -> Outcome:
    """All at once: a mesh by the function for complete streams."""
    try:
        if is_sequence(stream):
            return _by_events(stream, [stream], limits, threads)[0]
        mesh = decode(stream, limits, threads)
        return mesh.positions, mesh.faces, arrays_of(mesh.attributes)
    except BsmError as error:
        return error


def piecewise(
    stream: bytes,
    random: Random,
    limits: Limits = DEFAULT_LIMITS,
    threads: int = 1,
    tolerant: bool = False,
) -> tuple[Outcome, int]:
    """Decode by events, from pieces of random lengths; also return the number of losses."""
    try:
        return _by_events(stream, _pieces(stream, random), limits, threads, tolerant)
    except BsmError as error:
        return error, 0


def _by_events(
    stream: bytes, pieces: list[bytes], limits: Limits, threads: int, tolerant: bool = False
) -> tuple[Decoded, int]:
    kind = SequenceDecoder if is_sequence(stream) else Decoder
    faces, vertices, losses = np.zeros((0, 3), np.int32), 0, 0
    positions: list[np.ndarray] = []
    frames: list[np.ndarray] = []
    values: dict[str, Attribute] = {}
    shown_attributes: list[tuple[Attribute, ...]] = []
    runs: list[tuple[int, int, np.ndarray]] = []
    with kind(limits, threads, tolerant=tolerant) as decoder:
        for piece in (*pieces, b""):
            if piece:
                decoder.receive_data(piece)
            else:
                decoder.receive_eof()
            while (event := decoder.next_event()) is not NEED_DATA and event is not END_OF_STREAM:
                match event:
                    case ConnectivityEvent():
                        if kind is SequenceDecoder:  # a run, with a mesh of its own
                            faces, vertices, positions = np.zeros((0, 3), np.int32), 0, []
                            shown_attributes.clear()
                            runs.append((len(frames), event.vertices, event.faces))
                        faces = np.concatenate([faces, event.faces])
                        more = np.full((event.vertices - vertices, 3), np.nan)
                        positions, vertices = [np.concatenate([*positions, more])], event.vertices
                        positions[0][event.loose.vertices] = event.loose.positions
                    case BlockEvent() | RefinementEvent():
                        positions[0][event.vertices] = event.positions
                    case FrameEvent():
                        frames.append(event.positions)
                        shown_attributes.append(event.attributes)
                    case AttributeEvent():
                        rows = vertices if event.domain == "vertex" else len(faces)
                        if event.indices is not None:
                            rows = 1 + int(event.indices.max(initial=-1))
                        values[event.name] = _with_values(values.get(event.name), event, rows)
                    case LossEvent():
                        losses += 1
        if len(runs) > 1 and isinstance(decoder, SequenceDecoder):
            return _of_runs(
                frames,
                runs,
                {} if losses else arrays_of_frames(decoder.attributes, shown_attributes),
            ), losses
        arrays = {} if losses else arrays_of_frames(_completed(decoder, values), shown_attributes)
    if kind is SequenceDecoder:
        return (np.array(frames).reshape(len(frames), vertices, 3), faces, arrays), losses
    return (positions[0] if positions else np.zeros((0, 3)), faces, arrays), losses


def _of_runs(
    frames: list[np.ndarray], runs: list[tuple[int, int, np.ndarray]], arrays: Arrays
) -> Decoded:
    """Frames of several meshes, one after the other, as the vectors hold them."""
    table = np.array([(first, vertices, len(faces)) for first, vertices, faces in runs], np.int32)
    positions = np.concatenate([np.zeros((0, 3)), *frames])
    return positions, np.concatenate([faces for _, _, faces in runs]), arrays | {"runs": table}


def _completed(
    decoder: Decoder | SequenceDecoder, attributes: dict[str, Attribute]
) -> list[Attribute]:
    """Return attributes from events, in the order of the mesh, and recomputed normals, which have no event."""
    mesh = decoder if isinstance(decoder, SequenceDecoder) else decoder.decode_rest()
    return [
        attributes.get(a.name, a)
        for a in mesh.attributes
        if a.name in attributes or a.semantic == "normal"
    ]


def _with_values(attribute: Attribute | None, event: AttributeEvent, rows: int) -> Attribute:
    """An attribute with what an event tells of it; zeros where nothing has come yet."""
    shape = (rows, *event.values.shape[1:])
    values = np.zeros(shape, event.values.dtype) if attribute is None else attribute.values.copy()
    values[event.rows] = event.values
    return Attribute(event.name, values, event.domain, event.semantic, event.indices)


def _pieces(stream: bytes, random: Random) -> list[bytes]:
    cuts = sorted(
        {
            0,
            len(stream),
            *(random.randrange(len(stream) + 1) for _ in range(random.choice((0, 1, 4, 30)))),
        }
    )
    return [stream[first:last] for first, last in pairwise(cuts) if last > first]
