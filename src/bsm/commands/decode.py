"""bsm decode: streams to mesh files and sequences."""

import argparse
import time
from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from itertools import chain, islice, takewhile
from pathlib import Path

import numpy as np

from bsm.bitstream.container.header import Header
from bsm.bitstream.errors import BsmError, OptionError, counted
from bsm.bitstream.limits import as_limits
from bsm.codec.arrays import Faces, Order
from bsm.codec.geometry.mesh import Metadata, TriangleMesh
from bsm.commands.flags import add_flags, add_inputs, adder, asked, refuse_two_on_one_pipe
from bsm.files.formats.metadata import Written
from bsm.files.formats.polygons import without_compression_notes
from bsm.files.images import is_link, linked_images, with_linked_images
from bsm.files.inspection import inspect_stream
from bsm.files.libraries import as_decoded
from bsm.files.mesh import save_written, unheard, unknown_suffix, written_mesh
from bsm.files.output import (
    default_output,
    no_link,
    output_inside,
    refuse_collisions,
    refuse_to_overwrite,
)
from bsm.files.parsing import PRECISION
from bsm.files.partial import blocks_in_words, decode_blocks, decode_what_is_left
from bsm.files.pipes import about, read_chunks, size_of
from bsm.files.stream import SequenceStream, decode_whole, is_scene, peek_header, refuse_mesh
from bsm.files.table import (
    MESH_SUFFIXES,
    ONE_FILE,
    SEQUENCE_FORMATS,
    WRITTEN_FORMATS,
    by_name,
    format_of_name,
)
from bsm.ground.console import Console, printable
from bsm.ground.lengths import known_unit, metres, unit_of
from bsm.jobs.packages import copy_descriptions
from bsm.jobs.plan import STREAM_SUFFIXES, plan, plan_trees
from bsm.jobs.run import Batch, run_jobs
from bsm.jobs.task import Facts, Job, Task, anywhere, came_to

WITH_FLOATS = 2  # of `Header.light`
# Streams of live sequences do not say how many frames they have, so this is found out only at their end.
NO_FRAMES = "the stream does not contain these frames; they count from 0, and bsm info says how many there are"


@dataclass(frozen=True, kw_only=True)
class DecodeJob(Task):
    given: str | None = None
    recursive: bool = False
    many: bool = False
    format: str | None = None
    blocks: int | None = None
    layers: int | None = None
    permutation: str | None = None
    tolerant: bool = False
    limits: str = "default"
    float32: bool = False
    unit_out: str | None = None
    frames: str | None = None


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_inputs(
        parser,
        "stream, scene of glTF with streams, or - for standard input",
        "mesh file, - for a pipe, or folder for several inputs (default: IN with .ply). For a sequence: npz "
        "(default), PC2, MDD, GLB, USD, a folder for its frames, or a pattern such as walk/%%04d.obj",
    )
    same = "format of the output (default: by its name, else ply); with -r also same: names and formats of the sources"
    adder(parser)("--format", "", same, choices=(*SEQUENCE_FORMATS, "same"))
    add_flags(parser.add_mutually_exclusive_group(), "decode a part")
    add_flags(parser, "decode", "limits")
    add_flags(parser.add_argument_group("sequences"), "decode sequences")


def run(args: argparse.Namespace, console: Console) -> int:
    suffix = f".{args.format or 'ply'}"
    # All inputs are looked at before the first is decoded: with a hundred files, a wrong one should not come up in
    # between.
    if not args.recursive:
        _refuse_meshes(args.inputs)
    if args.recursive and args.format == "same":
        jobs = list(map(_as_source, plan_trees(args.inputs, args.output, ".ply", STREAM_SUFFIXES)))
        outputs = [job.output for job in jobs]
        refuse_collisions((job.input for job in jobs), outputs)
        copy_descriptions(args.inputs, args.output, console, overwrite=args.force)
        args.format = None
    elif args.recursive:
        jobs = plan_trees(args.inputs, args.output, suffix, STREAM_SUFFIXES)
    elif args.format == "same":
        raise OptionError("--format same is for folders, with -r; name the output with -o")
    else:
        jobs = plan(args.inputs, args.output, lambda _: suffix, sole_folder=True)
    if args.permutation and len(jobs) > 1:
        raise OptionError("--permutation is for one input")
    if args.permutation and (args.blocks is not None or args.tolerant):
        raise OptionError("--permutation orders whole meshes; leave out --blocks and --tolerant")
    refuse_two_on_one_pipe(args, jobs[0].output)
    # Workers of a cluster have other current folders.
    target = args.output
    if target and args.dask:
        target = anywhere(target)
    job = asked(DecodeJob, args, output="", given=target, many=len(jobs) > 1)
    return run_jobs(asked(Batch, args), job, console, decode_one, jobs)


def _refuse_meshes(names: Iterable[str]) -> None:
    for name in names:
        with about(name):
            if not is_scene(name):
                refuse_mesh(name)


def _as_source(job: Job) -> Job:
    """Give the output the name of the file that a stream was made of; a format that is not written becomes another."""
    name = ""
    # A damaged stream has no name that can be trusted; it is decoded with the usual name, and the error comes from
    # there.
    with suppress(BsmError, OSError):  # decoding it will say so
        name = str(inspect_stream(read_chunks(job.input)).metadata.get("source_name", ""))
    # The name comes from the stream, that is from anyone. It must not lead out of the folder, or hide the file.
    if (
        name != Path(name).name
        or name.startswith(".")
        or Path(name).suffix.lower() not in MESH_SUFFIXES
    ):
        return job
    # A format that cannot be written is replaced by one that loses least of its contents.
    if not format_of_name(name):
        suffix = "vtp"  # which holds fields
        if Path(name).suffix.lower() == ".gltf":
            suffix = "glb"
        name = f"{name}.{suffix}"
    return replace(job, output=no_link(str(Path(job.output).with_name(name))))


def decode_one(args: DecodeJob, console: Console) -> Facts:
    if is_scene(args.input):
        return _decode_scene(args, console)
    # The header comes first in a stream, so a pipe can be asked whether it is a sequence before it is read.
    header, chunks = peek_header(read_chunks(args.input))
    if header is not None and header.gop_frames:
        return _decode_sequence(args, console, chunks)
    if args.frames is not None:
        raise OptionError("--frames is for sequences; this is a single mesh")
    output, kind = _mesh_output(args)
    begin = time.perf_counter()
    limits = as_limits(args.limits)
    with console.progress("decoding", until=0.6) as progress:
        # Whole, in part and damaged streams have three readers, since each promises something else: everything or an
        # error, a prefix, and whatever is left.
        if args.tolerant:
            mesh = decode_what_is_left(
                chunks, lambda text: console.note(f"{args.input}: {text}"), limits
            )
        elif args.blocks is None:
            mesh = decode_whole(chunks, limits, layers=args.layers)
        else:
            mesh = decode_blocks(chunks, args.blocks, progress, limits)
    seconds = time.perf_counter() - begin
    if args.permutation:
        mesh = _reordered(mesh, args.permutation)
    exact = header is not None and header.light == WITH_FLOATS
    # The mesh is fine without them, so these are notes.
    for image in linked_images(mesh.metadata, args.input):
        if image.fault:
            console.note(f"{args.input}: {image.note}")
    mesh = _as_asked(args, console, with_linked_images(mesh, args.input), kind, exact=exact)
    # A stream that was decoded in part has values of the first attributes only. Tolerant decoding names those it lost.
    if not args.tolerant and header is not None and header.attributes > len(mesh.attributes):
        missing = f"{header.attributes - len(mesh.attributes)} of {header.attributes} attributes"
        console.note(f"{args.input}: left out: {missing}, whose values are missing")
    if header is not None:
        for note in _notes_on_part(args, header):
            console.note(f"{args.input}: {note}")
    counts = {"vertices": len(mesh.positions), "faces": len(mesh.faces)}
    with console.progress("writing"):
        file = written_mesh(mesh, kind, _name_of_mesh(output))
        _note_unheard(args, console, mesh.metadata, kind)
        return counts | _saved(args, console, output, kind, file, f"{counted(**counts)}, ", seconds)


def _name_of_mesh(output: str) -> str:
    """The name that the writer of a mesh is given; a pipe has none of its own."""
    if output == "-":
        return "mesh"
    return output


def _notes_on_part(args: DecodeJob, header: Header) -> Iterator[str]:
    """Say which of the blocks and layers of a stream were decoded, where some were asked for."""
    if args.blocks is not None:
        fewer = blocks_in_words(args.blocks, header)
        if fewer:
            yield f"--blocks {args.blocks}: {fewer}"
        else:
            yield f"the first {args.blocks} of {counted(blocks=header.blocks)}"
    layers = 1
    if header.refinement:
        layers = 2
    if args.layers is not None and (layers == 1 or args.layers > layers):
        yield f"--layers {args.layers}: the stream has {layers}, and all of it was decoded"


def _note_unheard(args: DecodeJob, console: Console, metadata: Metadata, kind: str) -> None:
    if names := unheard(metadata, kind):
        console.note(
            f"{args.input}: other programs do not read {names} in {kind}; write GLB or USD, or --unit-out m"
        )


def _as_asked(
    args: DecodeJob, console: Console, mesh: TriangleMesh, kind: str, *, exact: bool
) -> TriangleMesh:
    """A mesh in the requested unit and precision, which says that it was decoded if it is not exact."""
    # A file made of a lossy stream says so. If it is encoded again, errors add up, and the encoder can warn.
    fields = mesh.metadata
    if not exact:
        fields = as_decoded(fields)
    left_out = {"source_name"}
    if kind != "obj":
        left_out |= set(filter(is_link, fields))
    metadata, scale = {name: value for name, value in fields.items() if name not in left_out}, 1.0
    if args.unit_out:
        # Only a known unit can be converted. To invent one would change the size of the mesh by powers of ten.
        scale_of_stream, scale_of_output = (
            metres(unit_of(metadata)),
            known_unit(args.unit_out, "unit"),
        )
        if scale_of_stream is None:
            console.note(
                f"{args.input}: not scaled: its unit is {printable(unit_of(metadata)) or 'not known'}"
            )
        else:
            scale, metadata["unit"] = scale_of_stream / scale_of_output, args.unit_out
    # Writers look for this mark, and round; positions stay doubles until then, so that scaling does not round twice.
    if args.float32:
        metadata |= PRECISION
    return replace(mesh, positions=scale * mesh.positions, metadata=metadata)


def _mesh_output(args: DecodeJob) -> tuple[str, str]:
    """The file that a mesh goes to, and its format."""
    output = args.output
    if Path(output).is_dir():
        output = output_inside(output, args.input, f".{args.format or 'ply'}")
    kind = args.format or format_of_name(output)
    if output == "-" and not args.format:
        kind = "ply"
    if kind not in WRITTEN_FORMATS:
        raise unknown_suffix(output, kind=kind)
    # Before anything is decoded, so that the user does not wait for an error.
    refuse_to_overwrite(output, args.may_replace(output))
    return output, kind


def _decode_scene(args: DecodeJob, console: Console) -> Facts:
    """Decode the sequence in a glTF scene; write other scenes without compressed geometry, or as meshes at rest."""
    document = by_name("bsm.gltf.document", "read_document")(args.input, as_limits(args.limits))
    # A scene that wraps a sequence of ours holds the whole stream, and decodes as that would.
    if (moving := document.moving) is not None:
        return _decode_sequence(args, console, iter([moving]))
    if args.tolerant or any(
        option is not None for option in (args.blocks, args.layers, args.permutation, args.frames)
    ):
        raise OptionError(
            "--blocks, --layers, --tolerant, --permutation and --frames are for streams, not for scenes"
        )
    (output, kind), begin = _mesh_output(args), time.perf_counter()
    if kind == "glb":
        file = Written(by_name("bsm.gltf.compress", "restore")(document))
    else:
        source = by_name("bsm.gltf.scene", "read_gltf_mesh")(document)
        for note in without_compression_notes(source.notes):
            console.note(f"{args.input}: {note}")
        file = written_mesh(source.mesh, kind, output)
    return _saved(args, console, output, kind, file, "", time.perf_counter() - begin)


def _saved(
    args: DecodeJob,
    console: Console,
    output: str,
    kind: str,
    file: Written,
    counts: str,
    seconds: float,
) -> Facts:
    """Write a file, and note its size and losses."""
    left_out = save_written(output, file, overwrite_beside=args.force, **args.placing(output))
    if left_out:
        console.note(f"{args.input}: {kind} cannot hold {', '.join(left_out)}")
    received, written = size_of(args.input), len(file.data)
    console.note(f"{args.input} -> {output}: {counts}{came_to(received, written)}, {seconds:.2f} s")
    sizes = {"input_bytes": received, "output_bytes": written}
    return {
        "input": args.input,
        "output": output,
        **sizes,
        "seconds": seconds,
        "left_out": list(left_out),
    }


def _decode_sequence(args: DecodeJob, console: Console, chunks: Iterator[bytes]) -> Facts:
    """Decode one sequence; write each frame as soon as it is decoded."""
    from bsm.files.motion.caches import CACHES, mesh_of  # modules that meshes do without
    from bsm.files.motion.folder import frame_range, mesh_files, names_many
    from bsm.files.motion.frames import Shared, describe_runs
    from bsm.files.sequence import sequence_kind, sequence_writer

    if args.blocks is not None or args.layers is not None:
        raise OptionError("--blocks and --layers are for single meshes; this is a sequence")
    output, (first, last) = _sequence_output(args), frame_range(args.frames or ":")
    if last - first == 1 and _is_of_one_frame(output, args.format):
        return _decode_frame(args, console, chunks, first, output)
    kind = sequence_kind(output, args.format)
    refuse_to_overwrite(output, args.may_replace(output))
    begin = time.perf_counter()
    # Decoding begins at the first frame that is wanted; GOPs before it are skipped where no later one needs them.
    stream = _opened(args, console, chunks, first)
    header, frames = stream.header, stream.changing_frames()
    # Writers need the faces before the first frame, and the decoder has those only with it.
    ahead = list(islice(frames, 1))  # whose faces are those that are written first
    if not ahead or ahead[0][0] >= last:
        raise OptionError(NO_FRAMES)
    # With damage, frames may be missing: a writer that was told their number would wait for them.
    expected = 0
    if header.frames and not args.tolerant:
        expected = min(last, header.frames) - first
    order, faces = _ordered(stream.faces, args.permutation)
    metadata = as_decoded(stream.metadata)
    # Attributes follow the order of the stream. With another order of vertices they would be at wrong places, so they
    # are left out, and a note says so.
    shared = Shared()
    if not args.permutation:
        shared = Shared(lambda: stream.attributes, lambda: metadata, first=first)
    writer = sequence_writer(output, kind, faces, expected, shared=shared, **args.placing(output))
    with writer as write, console.progress("decoding") as progress:
        for count, (number, frame) in enumerate(
            takewhile(lambda found: found[0] < last, chain(ahead, frames)), 1
        ):
            changed = stream.run_starts[-1:] == [number]
            # A permutation belongs to one set of faces.
            if args.permutation and changed:
                raise OptionError(
                    f"--permutation is the order of one mesh, but the faces change at frame {number}"
                )
            changed_faces = None
            if changed:
                changed_faces = stream.faces
            write(frame[order], changed_faces)
            if expected:
                progress(count, expected)
    lost, place = shared.left_out, kind
    if args.permutation:
        lost, place = (
            [attribute.name for attribute in stream.attributes],
            f"{kind} with --permutation",
        )
    if lost:
        console.note(f"{args.input}: not written to {place}: {', '.join(lost)}")
    _note_unheard(args, console, metadata, kind)
    if kind in CACHES:
        faces_file = str(mesh_of(output))
        if stream.run_starts:
            faces_file = "an OBJ beside each file"
        console.note(f"{args.input}: {kind.upper()} holds no faces; they are in {faces_file}")
    # Files of an earlier, longer run would be read as further frames of this sequence.
    if names_many(output) and (others := len(mesh_files(output)) - count) > 0:
        console.note(f"{output}: {others} other meshes are there and count as frames; remove them")
    seconds = time.perf_counter() - begin
    if stream.run_starts:
        console.note(f"{args.input}: {describe_runs(stream.run_starts)}")
    counts = {"vertices": len(ahead[0][1]), "faces": header.faces}
    console.note(
        f"{args.input} -> {output}: {counted(frames=count)} of {counted(**counts)}, {seconds:.2f} s"
    )
    sizes = {"input_bytes": size_of(args.input), "output_bytes": size_of(output)}
    return {
        "input": args.input,
        "output": output,
        "frames": count,
        **counts,
        **sizes,
        "seconds": seconds,
    }


def _opened(
    args: DecodeJob, console: Console, chunks: Iterator[bytes], start: int
) -> SequenceStream:
    on_damage = None
    if args.tolerant:
        on_damage = console.note
    return SequenceStream(chunks, on_damage, start, as_limits(args.limits))


def _is_of_one_frame(output: str, file_format: str | None) -> bool:
    from bsm.files.motion.folder import is_numbered

    kind = file_format or format_of_name(output)
    return (
        kind in WRITTEN_FORMATS
        and kind not in ONE_FILE
        and not is_numbered(output)
        and not Path(output).is_dir()
    )


def _sequence_output(args: DecodeJob) -> str:
    """The file or folder that a sequence goes to: an npz, or a folder if the format is one of meshes."""
    suffix = ""
    if args.format in (None, *ONE_FILE):
        suffix = f".{args.format or 'npz'}"
    if args.recursive:
        return str(Path(args.output).with_suffix(suffix))
    if args.given is not None and args.many:
        return output_inside(args.given, args.input, suffix)
    if args.given is None:
        return default_output(args.input, suffix)
    return str(args.output)


def _reordered(mesh: TriangleMesh, permutation: str) -> TriangleMesh:
    from bsm.account.comparison import read_permutation, reorder  # which take long to load

    return reorder(mesh, read_permutation(permutation))


def _ordered(faces: Faces, permutation: str | None) -> tuple[Order | slice, Faces]:
    """The rows of frames in the order that a file says, if there is one, and faces that fit."""
    if permutation is None:
        return slice(None), faces
    # `reorder` takes meshes. Their numbers as coordinates make it tell where each row goes.
    # As positions, which tell the order.
    numbers = np.repeat(np.arange(faces.max() + 1.0)[:, None], 3, axis=1)
    mesh = _reordered(TriangleMesh(numbers, faces), permutation)
    return mesh.positions[:, 0].astype(np.int64), mesh.faces


def _decode_frame(
    args: DecodeJob, console: Console, chunks: Iterator[bytes], number: int, output: str
) -> Facts:
    """Write one frame of a sequence as a mesh."""
    kind = str(args.format or format_of_name(output))
    refuse_to_overwrite(output, args.may_replace(output))
    begin = time.perf_counter()
    stream = _opened(args, console, chunks, number)
    changed = next(stream.changing_frames(), None)
    # A tolerant decoder may go on after a lost frame, and return a later one.
    if changed is None or changed[0] != number:
        raise OptionError(NO_FRAMES)
    mesh = TriangleMesh(changed[1], stream.faces, stream.attributes, stream.metadata)
    mesh = _as_asked(args, console, mesh, kind, exact=False)
    if args.permutation:
        mesh = _reordered(mesh, args.permutation)
    facts = {"frames": 1, "vertices": len(mesh.positions), "faces": len(mesh.faces)}
    file = written_mesh(mesh, kind, _name_of_mesh(output))
    return facts | _saved(
        args, console, output, kind, file, f"frame {number}, ", time.perf_counter() - begin
    )
