"""bsm denoise: remove noise from a mesh, or from every frame of a sequence."""

from __future__ import annotations

import argparse
import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import asdict, dataclass, field, replace
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any

from bsm.batch import Facts, plan, run_jobs, size_of
from bsm.bitstream.errors import OptionError
from bsm.codec.arrays import Positions
from bsm.commands.inputs import add_inputs, asked, run_of
from bsm.commands.reader import add_reader_flag
from bsm.console import Console, Progress
from bsm.farm.jobs import Task
from bsm.files.mesh import MESH_FORMATS, format_of_name, read_mesh, save_written, written_mesh
from bsm.files.motion.frames import Frames
from bsm.files.naming import output_inside, refuse_terminal
from bsm.files.output import refuse_to_overwrite
from bsm.files.sequence import open_sequence, sequence_kind, sequence_writer

if TYPE_CHECKING:
    from bsm.codec.denoise import AutomaticChoice, DenoiseOptions, Step

FINE = ("guided", "bilateral", "non-iterative", "fast-effective", "bilateral-normal", "l0")
HAND_OVERS = ("positions", "heights", "normals", "none")
GOALS = ("shading", "shape")
_OPTIONS = ("fine", "hand_over", "iterations", "keep", "block_size")


@dataclass(frozen=True, kw_only=True)
class DenoiseJob(Task):
    """What `bsm denoise` is asked for: formats, the goal of the automatic mode, and options instead of it."""

    format: str | None = None
    reader: str | None = None
    goal: str = GOALS[0]
    options: dict[str, Any] = field(default_factory=dict)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what the command takes."""
    add_inputs(
        parser,
        "mesh file (OBJ, OFF, PLY, STL, npz), - for standard input, or a sequence: npz, folder, or quoted pattern",
        "file, in the format of its name, or folder for any number of inputs",
    )
    parser.add_argument("--format", choices=(*MESH_FORMATS, "npy"), help="format of the input, and of a piped output")
    add_reader_flag(parser)
    parser.add_argument(
        "--for",
        dest="goal",
        choices=GOALS,
        default=GOALS[0],
        help="what the automatic mode strives for: normals near the clean ones (shading), or vertices (shape)",
    )
    ways = parser.add_argument_group(
        "instead of the automatic mode",
        "with none of these everything is chosen from the noise of the mesh (of the first frame); "
        "with any of them the others have the paper's values; a result that takes more away than noise is not written "
        "without --force",
    )
    ways.add_argument("--fine", choices=FINE, default=argparse.SUPPRESS, help="fine step (guided)")
    ways.add_argument(
        "--hand-over",
        choices=HAND_OVERS,
        default=argparse.SUPPRESS,
        help="what the fine step gets: coarse positions, noisy ones moved to it along its normals, noisy "
        "ones smoothed along coarse normals, or no coarse step",
    )
    ways.add_argument(
        "--iterations",
        type=int,
        metavar="N",
        default=argparse.SUPPRESS,
        help="of the fine step, 0: none (the method's own)",
    )
    ways.add_argument(
        "--keep",
        type=float,
        metavar="FRACTION",
        default=argparse.SUPPRESS,
        help="share of a block's frequencies that the coarse step keeps, c over n_d (0.1)",
    )
    ways.add_argument(
        "--block-size",
        type=int,
        metavar="N",
        default=argparse.SUPPRESS,
        help="vertices of a block before overlap, about (500)",
    )


def run(args: argparse.Namespace, console: Console) -> int:
    """Denoise all inputs."""
    if args.output is None:
        raise OptionError("say with -o where to write")
    jobs = plan(args.inputs, args.output, _suffix, sole_folder=True)
    if jobs[0].output == "-" and args.json:
        raise OptionError("--json and -o - would both write to standard output")
    refuse_terminal(jobs[0].output)
    given = {name: getattr(args, name) for name in _OPTIONS if hasattr(args, name)}
    return run_jobs(run_of(args), asked(DenoiseJob, args, output="", options=given), console, denoise_one, jobs)


def denoise_one(args: DenoiseJob, console: Console) -> Facts:
    """Denoise one mesh or one sequence."""
    options = _options(args)
    if sequence := open_sequence(args.input, args.format, args.reader):
        result = _denoise_sequence(args, console, sequence, options)
    else:
        if Path(args.output).is_dir():
            args = replace(args, output=output_inside(args.output, args.input, _suffix(args.input)))
        result = _denoise_mesh(args, console, options)
    sizes = {"input_bytes": size_of(args.input), "output_bytes": size_of(args.output)}
    return {"input": args.input, "output": args.output, **sizes, **result}


def _suffix(name: str) -> str:
    """The input's own, or what holds a sequence."""
    return f".{format_of_name(name) or ('npz' if Path(name).is_dir() else 'ply')}"


def _options(args: DenoiseJob) -> DenoiseOptions | None:
    """What was asked for; None: nothing."""
    if not args.options:
        return None
    from bsm.codec.denoise import DenoiseOptions

    return DenoiseOptions(**args.options)


def _denoise_mesh(args: DenoiseJob, console: Console, options: DenoiseOptions | None) -> dict[str, Any]:
    kind = args.format if args.output == "-" else format_of_name(args.output)
    if kind not in MESH_FORMATS:
        raise OptionError(f"{args.output}: the name tells no mesh format; use one of .{', .'.join(MESH_FORMATS)}")
    refuse_to_overwrite(args.output, args.may_replace(args.output))

    from bsm.codec.denoise import FrameDenoiser

    source = read_mesh(args.input, args.format, reader=args.reader)
    for note in source.notes:
        console.note(f"{args.input}: {note}")
    mesh = source.mesh
    begin = time.perf_counter()
    denoiser = FrameDenoiser(mesh.positions, mesh.faces, options, goal=args.goal, force=args.force)
    (positions,) = denoiser([mesh.positions])
    _tell(console, denoiser.choice)
    _tell_moved(console, mesh.positions, positions)
    seconds = time.perf_counter() - begin
    moved, stale = mesh.moved(positions)
    overwrite = args.may_replace(args.output)
    written = written_mesh(moved, kind, args.output)
    left_out = save_written(args.output, written, overwrite=overwrite, overwrite_beside=args.force)
    if left_out or stale:
        console.note(f"{args.input}: left out: {', '.join((*stale, *left_out))}")
    console.note(f"{args.input}: {len(mesh.positions)} vertices -> {args.output}, {seconds:.2f} s")
    return _result(len(positions), len(mesh.faces), 1, seconds, denoiser.choice, options)


def _denoise_sequence(
    args: DenoiseJob, console: Console, source: Frames, options: DenoiseOptions | None
) -> dict[str, Any]:
    kind = sequence_kind(args.output, args.format if args.output == "-" else None)

    from bsm.codec.denoise import FrameDenoiser

    first = next(source.frames)
    begin = time.perf_counter()
    denoiser = FrameDenoiser(first, source.faces, options, goal=args.goal, force=args.force)
    count = 0
    writer = sequence_writer(args.output, kind, source.faces, source.count, overwrite=args.may_replace(args.output))
    with writer as write, console.progress("denoising", "frames") as progress:
        for frame in denoiser(_counted(chain([first], source.frames), source.count, progress)):
            write(frame)
            count += 1
            if count == 1:
                _tell(console, denoiser.choice)
    seconds = time.perf_counter() - begin
    console.note(
        f"{args.input}: {count} frames of {len(first)} vertices -> {args.output}, "
        f"{seconds:.2f} s, {1e3 * seconds / count:.0f} ms a frame"
    )
    return _result(len(first), len(source.faces), count, seconds, denoiser.choice, options)


def _counted(frames: Iterator[Positions], total: int, progress: Progress) -> Iterator[Positions]:
    for number, frame in enumerate(frames, start=1):
        yield frame
        if total:
            progress(number, total)


def _tell(console: Console, choice: AutomaticChoice | None) -> None:
    """What the automatic mode found and chose."""
    if choice is None:
        return
    if choice.outliers:
        console.note(f"put back   {choice.outliers} vertices that stood out by themselves")
    if not choice.steps:
        if not choice.outliers:
            said = "steadied   " if choice.kind == "unsteady" else "left       as it was: "
            console.note(f"{said}{choice.reason}")
        return
    noise = choice.noise
    console.note(f"found      {choice.reason}")
    console.note(f"noise      {noise.normal:.2f} mean edges along the normals, {noise.tangential:.2f} across")
    for step, times in Counter(choice.steps).items():
        share = "" if times == len(choice.steps) else f"{100 * times / len(choice.steps):.0f} % "
        console.note(f"chosen     {share}{_described(step)}")
    console.note(f"expected   {choice.expected:.1f} after {choice.untreated:.1f}, more where there is fine detail")


def _described(step: Step) -> str:
    recipe = step.recipe
    guide = {
        "patches": "guided normal filter",
        "own": "bilateral normal filter",
        "local": "local bilateral normal filter",
    }[recipe.guide]
    begun = f"hand-over of {recipe.hand_over}, c = {100 * recipe.keep:g} % of a block"
    if not recipe.needs_coarse:
        begun = "no hand-over"
    return f"{begun}; {step.iterations} iterations of the {guide}, sigma_r {recipe.sigma_r:g}"


def _tell_moved(console: Console, before: Positions, after: Positions) -> None:
    moved = int((before != after).any(axis=1).sum())
    if 0 < moved < len(before):
        console.note(f"left       {len(before) - moved} of {len(before)} vertices as they were")


def _result(
    vertices: int,
    faces: int,
    frames: int,
    seconds: float,
    choice: AutomaticChoice | None,
    options: DenoiseOptions | None,
) -> dict[str, Any]:
    return {
        "vertices": vertices,
        "faces": faces,
        "frames": frames,
        "seconds": seconds,
        "automatic": None if choice is None else asdict(choice),
        "options": None if options is None else asdict(options),
    }
