"""bsm compare, where both sides are sequences."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path

import numpy as np

from bsm.bitstream.errors import MeshError, OptionError
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits
from bsm.codec.arrays import Faces, Order, Positions
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.sequence.targets import Runs, compare_runs
from bsm.commands.limits import limits_of
from bsm.console import Console, Progress, as_json, finite
from bsm.files.about import about
from bsm.files.motion.folder import names_many
from bsm.files.motion.frames import Wanted
from bsm.files.output import open_output, refuse_to_overwrite
from bsm.files.permutation import in_order_of, read_permutation
from bsm.files.pipes import read_chunks
from bsm.files.sequence import open_sequence
from bsm.files.sequence_stream import (
    Pieces,
    SequenceStream,
    all_frames,
    numbered,
    numbers_of,
    peek_header,
    pieces_of,
)
from bsm.files.stream import is_stream
from bsm.loops import Loops

Sequence = Pieces


def load_sequence(
    path: str, reader: str | None = None, limits: Limits = DEFAULT_LIMITS, wanted: Wanted | None = None
) -> Sequence | None:
    """The frames and faces of a file, folder or stream; None if it is a mesh. Those of a folder may change."""
    if _is_stream(path):
        header, chunks = peek_header(read_chunks(path))
        if header is None or not header.gop_frames:
            return None
        stream = SequenceStream(chunks, limits=limits)
        return all_frames(stream)
    source = open_sequence(path, reader=reader, wanted=wanted)
    if source is None:
        return None
    if source.meshes is None:
        return [(np.array(list(source.frames)), source.faces)]
    return pieces_of((mesh.positions, mesh.faces) for mesh in source.meshes)


def _is_stream(path: str) -> bool:
    return Path(path).is_file() and is_stream(path)


def compare_loaded(args: argparse.Namespace, original: Sequence, decoded: Sequence, progress: Progress) -> str:
    """How far one sequence is from the other, as it is printed."""
    counts = [[len(frames) for frames, _ in side] for side in (original, decoded)]
    if sum(counts[0]) != sum(counts[1]):
        raise MeshError(f"{args.original} has {sum(counts[0])} frames and {args.decoded} {sum(counts[1])}")
    if counts[0] != counts[1]:
        starts = [np.cumsum(side)[:-1].tolist() or "none" for side in counts]
        raise MeshError(
            f"the faces of {args.original} change at frames {starts[0]} and of {args.decoded} at {starts[1]}"
        )
    if args.permutation and len(original) > 1:
        raise OptionError("--permutation is the order of one mesh, and the faces change")
    order = read_permutation(args.permutation) if args.permutation else None
    runs = [_paired(one, two, order) for one, two in zip(original, decoded, strict=True)]
    result = asdict(compare_runs(runs))
    if args.look:
        progress.stage("looking at all frames")
        result.update(looks(runs, progress))
        progress.stage("comparing")
    if _is_stream(args.decoded):
        samples = sum(frames[..., 0].size for frames, _ in decoded)
        result["bpvf_total"] = 8 * Path(args.decoded).stat().st_size / samples
    of_frames = [found for one, two, _ in runs for found in _of_frames(one, two)]
    if args.picture:
        from bsm.evaluation.plots import frame_errors

        refuse_to_overwrite(args.picture, args.force)
        picture = frame_errors(of_frames, Path(args.decoded).name)
        with open_output(args.picture, overwrite=args.force) as file:
            file.write(picture)
    repeats = _repeats(runs[0][0]) if len(runs) == 1 else ()
    if args.json:
        numbers = {name: finite(value) for name, value in result.items()}
        return as_json({**numbers, "frames": of_frames, "loops": list(repeats)})
    worst = max(range(len(of_frames)), key=lambda number: of_frames[number]["max_error_relative"])
    lines = [f"{name:<19}{value:.6g}" for name, value in result.items()]
    lines.append(f"worst frame        {worst} ({of_frames[worst]['max_error_relative']:.6g})")
    return "\n".join([*lines, *repeats])


def _paired(
    original: tuple[Positions, Faces], decoded: tuple[Positions, Faces], order: Order | None
) -> tuple[Positions, Positions, Faces]:
    """The frames of both in one order of vertices, and their faces."""
    (first, faces), (second, other_faces) = original, decoded
    mesh, kept = TriangleMesh(first[0], faces).without_isolated_vertices()
    other, other_kept = TriangleMesh(second[0], other_faces).without_isolated_vertices()
    rows = numbers_of(in_order_of(mesh, numbered(other.faces, len(other_kept)), order))
    return first[:, kept], second[:, other_kept[rows]], mesh.faces


def _of_frames(one: Positions, two: Positions) -> list[dict[str, float]]:
    """The errors of each frame, in diagonals of the first."""
    diagonal = float(np.linalg.norm(np.ptp(one[0], axis=0))) or 1.0
    found = []
    for original, decoded in zip(one, two, strict=True):
        distances = np.linalg.norm(original - decoded, axis=1) / diagonal
        rms = float(np.sqrt(np.square(distances).mean()))
        found.append({"rms_relative": rms, "max_error_relative": float(distances.max())})
    return found


def _repeats(frames: Positions) -> tuple[str, ...]:
    """What is to be said of loops."""
    loops = Loops()
    for frame in frames:
        loops.take(frame)
    return loops.said()


def _loaded(path: str, args: argparse.Namespace, wanted: Wanted | None = None) -> Sequence | None:
    with about(path):
        return load_sequence(path, args.reader, limits_of(args.limits), wanted)


def looks(runs: Runs, progress: Callable[[int, int], None]) -> dict[str, float]:
    """How frames look, the worst and the mean of those of which something is seen; see `codec.look`."""
    from bsm.codec.look.measure import Looker

    found = []
    total = sum(len(original) for original, _, _ in runs)
    pairs = [
        (one, other, faces) for original, decoded, faces in runs for one, other in zip(original, decoded, strict=True)
    ]
    for number, (one, other, faces) in enumerate(pairs):
        progress(number, total)
        try:
            found.append(Looker(TriangleMesh(one, faces)).look(other))
        except MeshError:
            continue
    if not found:
        raise MeshError("the sequence cannot be looked at: its faces have no area in any frame")
    return {
        "look_worst": max(look.moving for look in found),
        "look_mean": float(np.mean([look.moving for look in found])),
        "dissimilarity_worst": max(look.dissimilarity for look in found),
    }


def compare_if_sequences(args: argparse.Namespace, console: Console) -> bool:
    """Compare two sequences; False if neither is one."""
    with console.progress("reading", "frames") as progress:
        changing = Wanted(runs=True)
        original, decoded = (
            _loaded(path, args, changing if names_many(path) else None) for path in (args.original, args.decoded)
        )
        if original is None and decoded is None:
            return False
        if original is None:  # an animated glTF is a sequence where the other one is
            original = _loaded(args.original, args, changing)
        if decoded is None:
            decoded = _loaded(args.decoded, args, changing)
        if original is None or decoded is None:
            one, other = (args.decoded, args.original) if original is None else (args.original, args.decoded)
            raise MeshError(f"{one} is a sequence and {other} one mesh")
        if args.map:
            raise OptionError("--map shows one mesh; of sequences, --picture draws the errors of each frame")
        progress.stage("comparing")
        text = compare_loaded(args, original, decoded, progress)
    print(text)
    return True
