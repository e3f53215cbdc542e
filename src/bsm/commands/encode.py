"""bsm encode: mesh files to streams."""

import argparse
import os
import shlex
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from bsm.bitstream.errors import OptionError, counted
from bsm.commands.flags import (
    add_encode_flags,
    add_inputs,
    adder,
    asked,
    keywords_of,
    refuse_two_on_one_pipe,
)
from bsm.files.images import ImageRule
from bsm.files.motion.caches import CACHES
from bsm.files.motion.folder import common_name, look_like_frames
from bsm.files.output import refuse_collisions
from bsm.files.pipes import is_url
from bsm.files.table import (
    FORMATS,
    GLTF,
    MESH_SUFFIXES,
    SEQUENCE_FORMATS,
    SEQUENCES_READ,
    WRITTEN_FORMATS,
    format_of_name,
)
from bsm.ground.console import Console
from bsm.jobs.encode import EncodeJob, encode_one, shared_images
from bsm.jobs.packages import copy_descriptions
from bsm.jobs.plan import plan, plan_trees
from bsm.jobs.run import Batch, run_jobs
from bsm.jobs.task import Job

# A user who asks for `-o x.obj` expects a mesh file, and would get a stream under a false name.
_OTHERS = (*SEQUENCE_FORMATS, "gltf", "drc", "3mf", "dae", "fbx", "abc", "json", "zip")
"""Suffixes that are not names of streams."""


_MEANT = {
    "units": "unit",
    "scale_unit": "unit",
    "up_axis": "up",
    "upaxis": "up",
    "fps": "frame_rate",
}
"""Names of metadata that readers would not find, and the names that have their meaning."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_inputs(
        parser,
        "mesh file (PLY, OBJ, STL, GLB, 3MF, ...), - for standard input, or a sequence (see below)",
        "output file, - for a pipe, or folder for several inputs (default: IN with .bsm). Several inputs to one .bsm "
        "are the frames of a sequence",
    )
    formats = tuple(kind for kind, row in FORMATS.items() if row.reader or kind in SEQUENCES_READ)
    text = "format of the input, as a suffix without the dot (default: by its name or content)"
    adder(parser)("--format", "FORMAT", text, choices=formats)
    add_encode_flags(parser)


def run(args: argparse.Namespace, console: Console) -> int:
    piped = args.frames is not None and ":" not in args.frames
    # The flag stands for a pipe of frames, too, and argparse takes the input behind it for its value.
    if piped and args.frames:
        args.inputs.insert(0, args.frames)
    if piped:
        args.frames = None
    _refuse_other_formats(args.inputs, args.output)
    # The option of other programs chooses the format of the output. Here it is that of the input.
    if args.format in GLTF and format_of_name(args.inputs[0]) not in (None, "glb"):
        first = shlex.quote(args.inputs[0])
        raise OptionError(
            f"--format is the format of the input; for a scene, run: bsm glb {first} -o OUT.glb"
        )
    if piped and args.format not in (None, "npy"):
        raise OptionError(
            f"--frames takes npy arrays; it cannot be combined with --format {args.format}"
        )
    jobs, members = _planned(args, console)
    refuse_two_on_one_pipe(args, jobs[0].output)
    many, options = asked(Batch, args), keywords_of(args)
    threads = None
    # Processes side by side use all cores already. More threads in each would only take turns.
    if many.side_by_side and len(jobs) > 1:
        threads = 1
    threads = options.pop("threads", threads)
    more = {
        "output": "",
        "metadata": _metadata_of(args),
        "options": options,
        "threads": threads,
        "members": members,
    }
    _check_images(args, jobs)
    more["format"] = args.format
    if piped:
        more["format"] = "npy"
    job = asked(EncodeJob, args, **more)
    # Without any other file in the folders there can be no shared image, and the meshes need not be read twice.
    if args.images is None and args.recursive and _has_other_files(args.inputs):
        job = replace(job, shared=shared_images(many, job, console, jobs))
    if job.shared:
        once = f"{counted(images=len(job.shared))} of several meshes: once in the folder images"
        console.note(f"{once}, to which the streams link; --images keep stores them in each")
    if args.recursive and not args.dry_run:
        copy_descriptions(args.inputs, args.output, console, overwrite=args.force)
    return run_jobs(many, job, console, encode_one, jobs)


def _metadata_of(args: argparse.Namespace) -> dict[str, str]:
    """Return the metadata that a command line gives."""
    metadata = {}
    if args.up:
        metadata["up"] = args.up
    for text in args.meta:
        name, sign, value = text.partition("=")
        if not name or not sign:
            raise OptionError(f"--meta takes NAME=TEXT, not {name!r}")
        if name.lower() in _MEANT:
            raise OptionError(
                f"--meta {name}: programs look for it as {_MEANT[name.lower()]}={value}"
            )
        metadata[name] = value
    return metadata


def _check_images(args: argparse.Namespace, jobs: Sequence[Job]) -> None:
    """Raise an error if images cannot be written as the command line says."""
    # Images in files need a folder that they can be written to.
    if args.images == "link" and any(job.output == "-" or is_url(job.output) for job in jobs):
        raise OptionError(
            "--images link writes files beside streams; it takes neither a pipe nor a URL"
        )
    if args.images not in (None, "keep", "none", "link"):
        ImageRule.parse(args.images)
        # Decoders of images are a usual way into a process. Bytes of strangers never reach Pillow.
        if args.untrusted:
            raise OptionError("--images lets Pillow read images; leave it out with --untrusted")


def _has_other_files(folders: Sequence[str]) -> bool:
    """Return whether folders have files other than meshes."""
    for folder in folders:
        for path in Path(folder).rglob("*"):
            if path.suffix.lower() not in MESH_SUFFIXES and path.is_file():
                return True
    return False


def _planned(args: argparse.Namespace, console: Console) -> tuple[list[Job], tuple[str, ...]]:
    """Return the jobs; for several meshes in one stream, one job and the names of these meshes."""
    members: tuple[str, ...] = ()
    one_stream = (args.output or "").lower().endswith(".bsm") and not Path(args.output).is_dir()
    # Several meshes to one stream can only mean frames.
    if len(args.inputs) > 1 and one_stream and not args.recursive:
        members, args.inputs = tuple(args.inputs), [common_name(args.inputs)]
    elif args.output is None and len(args.inputs) > 1 and look_like_frames(args.inputs):
        console.note(
            f"{len(args.inputs)} inputs are numbered like the frames of one animation; to write one stream, add "
            "-o NAME.bsm"
        )
    if args.dry_run:
        if args.permutation or args.report:
            raise OptionError("--dry-run writes no file; leave out --permutation and --report")
        args.output = None
    if args.recursive:
        jobs = plan_trees(args.inputs, args.output, ".bsm")
    else:
        jobs = plan(args.inputs, args.output, lambda _: ".bsm")
    if args.dry_run:
        # A dry run does all the work and throws it away, so that its figures are those of the real run.
        jobs = [replace(job, output=os.devnull, follow=True) for job in jobs]
    if args.permutation:
        if len(jobs) > 1:
            raise OptionError("--permutation is for one input")
        # The three may name one file by mistake. The second write would destroy the first.
        refuse_collisions(args.inputs, [jobs[0].output, args.permutation, args.report or ""])
    return jobs, members


def _refuse_other_formats(inputs: Sequence[str], output: str | None) -> None:
    """Raise an error that names the right command if the name of the output is that of another format."""
    suffix = Path(output or "").suffix[1:].lower()
    if output is None or output.endswith("/") or suffix not in _OTHERS or Path(output).is_dir():
        return
    stream = shlex.quote(str(Path(output).with_suffix(".bsm")))
    scene = shlex.quote(str(Path(output).with_suffix(".glb")))
    if len(inputs) < 4:
        names = shlex.join(inputs)
    else:
        names = shlex.join([inputs[0], "..."])
    moving = (
        len(inputs) > 1
        or Path(inputs[0]).is_dir()
        or Path(inputs[0]).suffix[1:].lower() in (*CACHES, "npz")
    )
    formats = WRITTEN_FORMATS
    if moving:
        formats = SEQUENCE_FORMATS
    advice = f"bsm encode {names} -o {stream}"
    if suffix in GLTF and not moving:
        advice = f"bsm glb {names} -o {scene}"
    elif suffix in GLTF:
        advice += f"; bsm glb {stream} -o {scene}"
    elif suffix in formats:
        advice += f"; then bsm decode {stream} -o {shlex.quote(output)}"
    raise OptionError(f"{output}: encode writes streams, .bsm. Run: {advice}")
