"""The vectors of the specification.

    python -m tools.vectors                            hold this project's decoder against all of them
    python -m tools.vectors --new                      make those that are missing, for the next minor version
    python -m tools.vectors --example                  print the worked examples of spec/vectors/README.md

spec/vectors/run.py runs any other decoder, by its command line.
"""

import sys

import numpy as np

from bsm.bitstream.errors import BsmError
from bsm.codec.decoding import SequenceDecoder, decode
from bsm.codec.events import END_OF_STREAM, ConnectivityEvent, FrameEvent
from bsm.codec.geometry.attributes import Attribute
from tools.command import parser_of
from tools.vectors.example import example
from tools.vectors.store import (
    NEXT,
    Arrays,
    Vector,
    arrays_of,
    arrays_of_frames,
    read_manifest,
    write_needs,
    write_vectors,
)
from tools.vectors.worked_blocks import worked_blocks


def main() -> int:
    """Run the command."""
    parser = parser_of(__doc__)
    parser.add_argument("--new", action="store_true", help="make the vectors that are missing")
    parser.add_argument(
        "--example", action="store_true", help="print the worked examples of the specification"
    )
    parser.add_argument(
        "--only", metavar="TEXT", default="", help="only vectors whose names hold this"
    )
    args = parser.parse_args()
    if args.new:
        return write()
    if args.example:
        print(example(), worked_blocks(), sep="\n", end="")
        return 0
    vectors = [vector for vector in read_manifest() if args.only in vector.name]
    wrong = 0
    for vector in vectors:
        complaint = try_product(vector)
        wrong += complaint is not None
        if complaint:
            print(f"{vector.name}: {complaint} ({vector.probes})")
    print(f"{len(vectors) - wrong} of {len(vectors)} vectors are treated as they should be")
    return 1 if wrong else 0


def try_product(vector: Vector) -> str | None:
    """What this project's decoder does wrong with a vector, or None."""
    decoder = _decode_sequence if "-sequence" in vector.name else _decode_static
    try:
        decoded = decoder(vector.stream.read_bytes())
    except BsmError as error:
        found = error_name(error)
        return None if found == vector.error else f"refused as {found}, {error}"
    return (
        f"decoded, and not refused as {vector.error}"
        if vector.error
        else vector.complaint(*decoded)
    )


def error_name(error: BsmError) -> str:
    """The class of an error, as manifests call it."""
    return type(error).__name__.removesuffix("Error").lower()


def _decode_static(data: bytes) -> tuple[np.ndarray, np.ndarray, Arrays]:
    mesh = decode(data)
    return mesh.positions, mesh.faces, arrays_of(mesh.attributes)


def _decode_sequence(data: bytes) -> tuple[np.ndarray, np.ndarray, Arrays]:
    frames: list[np.ndarray] = []
    faces: list[np.ndarray] = []
    runs: list[tuple[int, int, int]] = []
    shown: list[tuple[Attribute, ...]] = []
    with SequenceDecoder() as decoder:
        decoder.receive_data(data)
        decoder.receive_eof()
        while (event := decoder.next_event()) is not END_OF_STREAM:
            if isinstance(event, ConnectivityEvent):
                runs.append((len(frames), event.vertices, len(event.faces)))
                faces.append(event.faces)
                shown.clear()
            elif isinstance(event, FrameEvent):
                frames.append(event.positions)
                shown.append(event.attributes)
        arrays = arrays_of_frames(decoder.attributes, shown)
    if len(runs) == 1:
        return np.array(frames).reshape(-1, runs[0][1], 3), faces[0], arrays
    return (
        np.concatenate(frames),
        np.concatenate(faces),
        arrays | {"runs": np.array(runs, np.int32)},
    )


def write() -> int:
    """Make the vectors that are missing; write none if the decoder does not treat one as it should."""
    from tools.vectors.made import BADS, GOODS

    known = {vector.name for vector in read_manifest()}
    streams: dict[Vector, bytes] = {}
    meshes = {}
    for name, made in (GOODS | BADS).items():
        if name in known:
            continue
        vector = Vector(name, made.probes, getattr(made, "error", None), NEXT)
        streams[vector] = made.make()
        decoder = _decode_sequence if "-sequence" in name else _decode_static
        try:
            meshes[vector] = decoder(streams[vector])
            found = None
        except BsmError as error:
            found = error_name(error)
        if found != vector.error:
            print(
                f"{name} is {found or 'decoded'}, and should be {vector.error or 'decoded'}",
                file=sys.stderr,
            )
            return 1
    write_vectors(streams, meshes)
    write_needs()
    print(f"{len(streams)} vectors, {sum(map(len, streams.values()))} bytes of streams")
    return 0


if __name__ == "__main__":
    sys.exit(main())
