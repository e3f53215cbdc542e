"""Encode meshes and sequences for `bsm encode` and `bsm.encode_many`."""

import glob
import math
import os
import time
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field, replace
from itertools import count
from pathlib import Path
from typing import Any

from bsm.account.comparison import (
    Errors,
    flattened,
    lost_attributes,
    worded_errors,
    write_permutation,
)
from bsm.account.images import ImageComparison, changed, compare_images
from bsm.bitstream.errors import HarmError, OptionError, counted
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits
from bsm.codec.geometry.mesh import Metadata
from bsm.codec.progress import Stages
from bsm.encoding.given import Recipe, Wishes, given_frames, given_mesh
from bsm.encoding.simplification import Chosen
from bsm.files.formats.metadata import images_in, kind_of_image
from bsm.files.formats.polygons import MeshFile
from bsm.files.images import ImageRule, digests_in, is_link, with_links, with_smaller_images
from bsm.files.mesh import read_mesh, size_with_parts
from bsm.files.motion.folder import LISTS, frame_files, frame_range, is_numbered, names_many
from bsm.files.motion.frames import Frames, Wanted, describe_runs
from bsm.files.output import open_output, refuse_to_overwrite, write_output
from bsm.files.pipes import is_url
from bsm.files.sequence import open_frames, open_sequence, size_of_sequence
from bsm.files.table import WITH_IMAGES_BESIDE
from bsm.ground.console import Console, Progress, finite
from bsm.jobs.run import Batch, run_many
from bsm.jobs.task import Facts, Job, Task, came_to

# Only for the bar: reading takes a few percent of encoding.
READ = 0.08  # of the time of a mesh
# Of processor time in each frame, as measured; that of reading is measured on the way.
_SECONDS_A_VERTEX = 2.5e-6
# A GLB with animations is a mesh at rest unless something asks for its motion.
_OF_SEQUENCES = ("kg", "bpvf", "gop", "low_delay", "frame_rate", "runs")
"""Options that only sequences have; with them a GLB is read as a sequence."""


@dataclass(frozen=True, kw_only=True)
class EncodeJob(Task):
    """The task of `bsm encode`; `options` are keywords of `bsm.encoding.options`."""

    format: str | None = None
    permutation: str | None = None
    metadata: Mapping[str, str] = field(default_factory=dict)
    options: Mapping[str, Any] = field(default_factory=dict)
    threads: int | None = None
    members: tuple[str, ...] = ()
    frames: str | None = None
    animation: str | None = None
    cache_mesh: str | None = None
    provenance: bool | None = None
    simplify: bool = False
    untrusted: bool = False
    recursive: bool = False
    shared: tuple[str, ...] = ()  # digests of images that several meshes have
    dry_run: bool = False
    explain: bool = False
    images: str | None = None

    @property
    def wishes(self) -> Wishes:
        # A tree that is decoded with --format same gets the names of its sources back.
        # Names of files may be bytes that are not UTF-8; metadata is.
        name = os.fsencode(Path(self.input).name).decode("utf-8", "replace")
        origin: dict[str, str] = {}
        if self.recursive:
            origin["source_name"] = name
        return Wishes(
            keywords={**self.options, "threads": self.threads},
            metadata={**origin, **self.metadata},
            simplify=self.simplify,
            provenance=self.provenance,
            source=self.input,
        )


def shared_images(
    run: Batch, asked: EncodeJob, console: Console, jobs: Sequence[Job]
) -> tuple[str, ...]:
    """Return the digests of the images that several meshes have in files beside them; reads these meshes first."""
    kinds = [asked.format or Path(job.input).suffix[1:].lower() for job in jobs]
    naming = [
        Job(job.input, within=job.within)
        for job, kind in zip(jobs, kinds)
        if kind in WITH_IMAGES_BESIDE
    ]
    # Images of a batch are compared by their digests in a first pass. Held in memory until the end, they would not fit.
    with console.progress("finding images of several meshes"):
        done = run_many(
            replace(run, report=None, resume=False), asked, console, _digests_one, naming
        )
    users = Counter(digest for facts in done for digest in facts.get("images", ()))
    return tuple(sorted(digest for digest, count in users.items() if count > 1))


def _digests_one(job: EncodeJob, console: Console) -> Facts:
    return {"images": sorted(digests_in(_read(job).mesh.metadata))}


def _reading(job: EncodeJob) -> tuple[Limits, bool | None]:
    """Return the limits of the input, and whether a process of its own reads it."""
    if job.untrusted:
        return Limits.service(), True
    return DEFAULT_LIMITS, None


def _read(job: EncodeJob) -> MeshFile:
    limits, isolated = _reading(job)
    return read_mesh(job.input, job.format, limits, isolated=isolated)


def encode_one(job: EncodeJob, console: Console) -> Facts:
    wishes = job.wishes
    # Wrong options are said before missing inputs, and these before outputs that exist: the order in which a user wants
    # to hear of them.
    wishes.check()
    for name in job.members or (job.input,):
        # Of a pipe, a URL or a pattern, reading tells.
        if name != "-" and not is_url(name) and not glob.has_magic(name) and not is_numbered(name):
            os.stat(name)
    runs = bool(job.options.get("runs"))
    asked = (
        job.animation,
        job.cache_mesh,
        job.frames,
        *(job.options.get(name) for name in _OF_SEQUENCES),
    )
    limits, apart = _reading(job)
    wanted = Wanted(job.options.get("frame_rate") or 0.0, job.animation or "", job.cache_mesh, runs)
    members = _frame_files(job, console)
    # Several meshes in one stream: the user has said that they are frames.
    if members:
        frames = open_frames(members, job.format, limits, wanted, isolated=apart)
        return _encode_sequence(replace(job, members=tuple(members)), wishes, console, frames)
    motion: Wanted | None = wanted
    if all(choice is None for choice in asked):
        motion = None
    sequence = open_sequence(job.input, job.format, motion, limits, isolated=apart)
    if sequence is not None:
        if job.frames is not None:
            first, last = frame_range(job.frames)
            count_all = sequence.count
            sequence = sequence.between(first, last)
            if count_all:
                console.note(f"{job.input}: {_frames_in_words(first, min(last, count_all))}")
        return _encode_sequence(job, wishes, console, sequence)
    for name, given in (
        ("animation", job.animation),
        ("mesh", job.cache_mesh),
        ("frames", job.frames),
    ):
        if given is not None:
            raise OptionError(f"--{name} is for sequences; this is a single mesh")
    return _encode_mesh(job, wishes, console)


def _frame_files(job: EncodeJob, console: Console) -> Sequence[str]:
    """Return the files of frames that are named one by one, or those of a range in a folder or pattern."""
    if job.frames is None:
        return job.members
    first, last = frame_range(job.frames)
    files: Sequence[str] = job.members
    if not files and not is_url(job.input) and names_many(job.input):
        files = frame_files(job.input, follow=not job.untrusted)
    chosen = files[first:last]
    if files and not chosen:
        raise OptionError(
            f"{job.input} has {counted(frames=len(files))}; --frames {job.frames} names none of them"
        )
    if chosen:
        names = f"{Path(chosen[0]).name} to {Path(chosen[-1]).name}"
        console.note(f"{job.input}: {_frames_in_words(first, first + len(chosen))}: {names}")
    return chosen


def _frames_in_words(first: int, end: int) -> str:
    """Say which frames are encoded; `end` is the number after the last one."""
    return f"frames {first} to {end - 1}, where 0 is the first"


def _encode_mesh(job: EncodeJob, wishes: Wishes, console: Console) -> Facts:
    with console.progress("reading", until=READ):
        source = _read(job)
    # Lossless is a promise about the file, and what no stream holds breaks it.
    if source.dropped and job.options.get("preset") == "lossless" and not job.force:
        lost = ", ".join(source.dropped)
        raise HarmError(
            f"lossless would lose contents that no stream holds: {lost}; --force leaves them out"
        )
    linked: dict[str, bytes] = {}

    def images(metadata: Metadata) -> Metadata:
        found, files = _images_of(job, metadata)
        # Files of linked images are written only with the stream, or a failed run would leave them behind.
        linked.update(files)
        return found

    given, begin = given_mesh(source.mesh, replace(wishes, images=images)), time.perf_counter()
    if job.simplify and job.permutation:
        raise OptionError("--permutation orders all vertices, and --simplify leaves some out")
    with _written(job, console) as (file, progress):
        found = given.encode(progress)
        encoder, result = found.encoder, found.attempt
        file.writelines(result.frames)
        # Before the stream has its name, so that no stream stands beside another's.
        if job.permutation:
            write_permutation(job.permutation, encoder.vertex_order, overwrite=job.force)
        if not job.dry_run:
            _write_linked(linked)
    seconds = time.perf_counter() - begin
    attributes: dict[str, Errors | None] = {}
    # Fewer triangles have other corners, at which attributes cannot be compared.
    if found.apart is None and encoder.decoded:
        attributes = lost_attributes(source.mesh, encoder.decoded)
    notes = [
        *source.notes,
        *given.losses,
        *found.notes,
        *(_measured(note, attributes) for note in encoder.notes),
    ]
    notes += given.notes[len(given.losses) :]
    compared_images: list[ImageComparison] = []
    # Images that stay as they are need no second look, and Pillow takes long to load.
    if job.images not in (None, "keep", "none", "link"):  # Pillow reads no others
        compared_images = compare_images(source.mesh.metadata, given.mesh.metadata)
    notes += changed(compared_images)
    more, summary, facts = _result(job, given, found, source.mesh.metadata, linked)
    if attributes:
        facts["attribute_errors"] = attributes
    if compared_images:
        facts["images"] = [image.facts() for image in compared_images]
    return _finish(job, console, notes + more, summary, seconds, facts)


def _write_linked(images: Mapping[str, bytes]) -> None:
    """Write linked images, which are the same for several streams: equal bytes replace a file that exists."""
    for name, data in images.items():
        Path(name).parent.mkdir(exist_ok=True)
        write_output(name, data, overwrite=True, follow=str(Path(name).parents[1]))


def _result(
    job: EncodeJob, given: Recipe, found: Chosen, source: Metadata, linked: Mapping[str, bytes]
) -> tuple[list[str], str, Facts]:
    """Return notes on images and the look of a stream, its sizes and errors in words, and as facts."""
    encoder, size, promise = found.encoder, found.attempt.size, given.options.promise
    images = _image_bytes(given.mesh.metadata)
    notes = _notes_on_images(job, given.mesh.metadata, size)
    # Grids say by themselves what they keep. All others without a promise get a measured figure instead.
    if not given.options.is_grid and (promise is None or promise.look == math.inf):
        notes.append(f"no look is promised; measured: {encoder.seen(found.attempt)}")
    header = found.attempt.header
    most, wanted = header.block_size, given.options.coefficients
    if wanted is not None and header.blocks and wanted > most:
        notes.append(
            f"coefficients: {most} at most, the vertices of the largest block; {wanted} were asked for"
        )
    vertices, faces = header.vertices, len(encoder.mesh.faces)
    errors, numbers = _errors(found, job.simplify, *given.unit)
    (taken, parts), bpv = size_with_parts(job.input, source), 8 * (size - images) / vertices
    beside = {name: len(data) for name, data in linked.items()}
    written = size + sum(beside.values())
    summary = f"{counted(vertices=vertices, faces=faces)}, {came_to(taken, written)}, {bpv:.2f} bits per vertex"
    if images:
        summary += " without images"
    summary += "; "
    if promise is not None and encoder.look is not None:
        summary += f"look {encoder.look:.2f} of {promise.look:g}, "
    # The bound that decides is worth a word where it is not the usual one: loosening it makes the file smaller.
    if encoder.binding not in ("", "look") and found.apart is None:
        summary += f"limited by the {encoder.binding}, "
    summary += errors
    facts: Facts = {
        "vertices": vertices,
        "faces": faces,
        "input_bytes": taken,
        "output_bytes": written,
        "bytes": size,
    }
    facts["bpv_total"] = bpv
    if parts:
        facts |= {"input_parts": parts, "output_parts": beside}
    facts |= numbers
    facts |= {"look": encoder.look, "binding": encoder.binding}
    if job.explain:
        notes += [str(event) for event in encoder.trials]
        facts["trials"] = [asdict(event) for event in encoder.trials]
    return notes, summary, facts


def _image_bytes(metadata: Metadata) -> int:
    return sum(len(value) for value in metadata.values() if isinstance(value, bytes))


def _notes_on_images(job: EncodeJob, metadata: Metadata, size: int) -> list[str]:
    """Return notes on the images in the metadata of a stream of this size."""
    notes: list[str] = []
    if job.images == "none":
        notes.append("left out: images")
    images = _image_bytes(metadata)
    if images and job.images:
        notes.append(f"{images} bytes are images")
    elif images:
        note = f"{images} bytes are unchanged images"
        # A JPEG loses quality once more, and few bytes.
        pngs = [data for _, data in images_in(metadata).values() if kind_of_image(data) == "png"]
        # Advice only where images are most of the file.
        if 2 * sum(map(len, pngs)) >= size:
            note += "; --images webp:85 makes them smaller"
        notes.append(note)
    return notes


def _measured(note: str, attributes: Mapping[str, Errors | None]) -> str:
    """Return a note of an encoder; that on an attribute with its largest error."""
    errors = attributes.get(note.partition(": ")[0])
    if not errors:
        return note
    return f"{note}; {worded_errors(errors)}"


def _images_of(job: EncodeJob, metadata: Metadata) -> tuple[Metadata, dict[str, bytes]]:
    """Return metadata with images as the job wants them, and linked images by their files."""
    # Links of the input lead from another folder.
    metadata = {name: value for name, value in metadata.items() if not is_link(name)}
    if job.images == "link" or job.shared:
        folder = root = Path(job.output).parent
        # Streams of a tree share one folder of images at its top, so links lead upwards.
        if isinstance(job.follow, str):
            root = Path(job.follow)
        path_to_root = Path(os.path.relpath(root, folder))
        way = "".join(f"{part}/" for part in path_to_root.parts)
        metadata, files = with_links(metadata, way, job.shared)
        return metadata, {str(root / name): data for name, data in files.items()}
    if job.images == "none":
        images = {f"image.{number}.data" for number in images_in(metadata)}
        return {name: value for name, value in metadata.items() if name not in images}, {}
    if job.images not in (None, "keep"):
        metadata = with_smaller_images(metadata, ImageRule.parse(job.images))
    return metadata, {}


def _errors(found: Chosen, simplify: bool, unit: str, per_own: float) -> tuple[str, Facts]:
    """Return the errors in words, and as numbers; if there are fewer triangles, the distance between the surfaces."""
    apart, error = found.apart, found.attempt.comparison
    relative, value = error.max_error_relative, error.max_error * per_own
    # Without matching vertices there is no error of a vertex; the distance of the surfaces takes its place in words and
    # facts.
    if apart is not None:
        relative, value = apart / (found.original.diagonal or 1.0), apart * per_own
    words = _length(value, relative, unit)
    names = ("theta_deg", "angle_deg", "nmsve_db", "nmsve_paper_db", "faces_before", "flattened")
    facts: Facts = dict.fromkeys(names)
    facts |= {"max_error_relative": relative, "error_of": "vertices"}
    if unit:
        facts |= {"max_error": value, "unit": unit}
    if apart is not None:
        facts["error_of"] = "surfaces"
        facts["faces_before"] = len(found.original.faces)
        return (
            f"{facts['faces_before']} faces before simplifying, surfaces {words} apart where measured",
            facts,
        )
    facts |= {
        name: finite(getattr(error, name))
        for name in ("theta_deg", "angle_deg", "nmsve_db", "nmsve_paper_db")
    }
    mesh = found.encoder.mesh
    facts["flattened"] = flattened(mesh.positions, found.attempt.draft.decoded, mesh.faces)
    summary = f"largest vertex error {words}, mean normal error {error.angle_deg:.2f} degrees"
    if simplify:
        summary += "; all triangles are kept"
    if facts["flattened"]:
        summary += f", {counted(triangles=facts['flattened'])} flattened by rounding"
    return summary, facts


def _length(value: float, relative: float, unit: str) -> str:
    share = f"{100 * relative:.3g} % of the diagonal"
    if not unit:
        return share
    return f"{value:.3g} {unit} ({share})"


def _encode_sequence(job: EncodeJob, wishes: Wishes, console: Console, source: Frames) -> Facts:
    """Encode one sequence; write each GOP as soon as its frames have arrived."""
    for name in ("images", "simplify"):
        if getattr(job, name):
            raise OptionError(f"--{name} is for single meshes; this is a sequence")
    begin = time.perf_counter()
    if job.permutation and job.options.get("runs"):
        raise OptionError("--permutation is the order of one mesh; with --runs the faces change")
    given, numbers, size = given_frames(source, wishes), count(), 0
    encoder, chosen = given.encoder, given.encoder.options
    with _written(job, console) as (file, progress):
        vertices = int(source.faces.max(initial=0)) + 1
        stages = Stages(
            progress, {"reading": 0.0, "encoding": _SECONDS_A_VERTEX * vertices * source.count}
        )
        # Frames are counted as they pass, because some sources do not know their number.
        read = (
            frame for frame, _ in zip(clocked(iter(given.frames), source.count, stages), numbers)
        )
        for chunk in replace(given, frames=read).chunks(stages.of("encoding")):
            size += file.write(chunk)
            # A reader may follow the file while it grows, as `bsm view --follow` does.
            file.flush()
        # Before the stream has its name, so that no stream stands beside another's.
        if job.permutation:
            write_permutation(job.permutation, encoder.vertex_order, overwrite=job.force)
    seconds = time.perf_counter() - begin
    runs = encoder.run_starts[1:]
    notes = [*source.notes, *given.losses, *encoder.notes]
    if runs:
        notes.append(describe_runs(runs))
    attributes: dict[str, Errors | None] = {
        name: {"max_error": e} for name, e in encoder.attribute_errors.items()
    }
    notes = [_measured(note, attributes) for note in notes]
    look, seen = math.inf, encoder.worst_look
    if chosen.promise is not None:
        look = chosen.promise.look
    look_in_words = ""
    if seen is not None and look != math.inf:
        look_in_words = f"look {seen:.2f} of {look:g} in the worst frame drawn, "
    # Nothing was promised, but the figure was measured on the way, and costs nothing.
    elif seen is not None:
        where = "in the frame with the largest normal error"
        notes.append(
            f"no look is promised; measured: look {seen:.2g} {where} (the default keeps 1)"
        )
    done, vertices, faces = next(numbers), len(encoder.vertex_order), len(encoder.face_order)
    bpvf = 8 * size / encoder.samples
    paths = job.members or (job.input,)
    is_list = Path(job.input).suffix[1:].lower() in LISTS
    taken: int | None = None
    # A list from a stranger is only parsed in a process of its own.
    if not (job.untrusted and is_list):
        taken = size_of_sequence(paths, source.metadata, job.cache_mesh)
    summary = f"{counted(frames=done)} of {counted(vertices=vertices, faces=faces)}"
    if runs:
        summary += " at the end"
    summary += f", {came_to(taken, size)}, {bpvf:.3f} bits per vertex and frame; {look_in_words}"
    unit, per_own = given.unit
    error, relative = encoder.max_error * per_own, encoder.max_error_relative
    summary += f"largest vertex error {_length(error, relative, unit)}"
    if job.options.get("max_error"):
        summary += f", {job.options['max_error']} asked for"
    summary += f", KG error {encoder.kg:.3g} %"
    if job.options.get("kg"):
        summary += ", copies of a vertex counted once"
    facts: Facts = {
        "frames": done,
        "vertices": vertices,
        "faces": faces,
        "input_bytes": taken,
        "output_bytes": size,
    }
    facts |= {"bytes": size, "bpvf_total": bpvf, "kg": finite(encoder.kg)}
    facts["max_error_relative"] = relative
    if unit:
        facts |= {"max_error": error, "unit": unit}
    if attributes:
        facts["attribute_errors"] = attributes
    return _finish(job, console, notes, summary, seconds, facts)


def clocked(
    frames: Iterator[Any],
    expected: int,
    stages: Stages,
    clock: Callable[[], float] = time.process_time,
) -> Iterator[Any]:
    """Yield frames, and report how long it takes to read them."""
    spent = 0.0
    for number in count(1):
        begin = clock()
        frame = next(frames, None)
        spent += clock() - begin
        if frame is None:
            return
        # Some sources do not know how many frames they have.
        if expected:
            stages.expect("reading", spent / number * expected)
            stages.report("reading", min(number / expected, 1.0))
        yield frame


@contextmanager
def _written(job: EncodeJob, console: Console) -> Iterator[tuple[Any, Progress]]:
    """Open the output, which must not be there unless it may be replaced, and report progress while it is written."""
    if job.permutation:
        refuse_to_overwrite(job.permutation, job.may_replace(job.permutation))
    output = open_output(job.output, **job.placing(job.output))
    with output as file, console.progress("encoding") as progress:
        yield file, progress


def _finish(
    job: EncodeJob, console: Console, notes: list[str], summary: str, seconds: float, facts: Facts
) -> Facts:
    for note in notes:
        console.note(f"{job.input}: {note}")
    console.note(f"{job.input} -> {job.output}: {summary}; {seconds:.2f} s")
    output: str | None = job.output
    if job.dry_run:
        output = None
    return {"input": job.input, "output": output, **facts, "seconds": seconds, "notes": notes}
