"""bsm denoise: remove noise from a mesh, or from every frame of a sequence."""

import argparse
import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import asdict, dataclass, field, replace
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from bsm.bitstream.errors import OptionError, counted
from bsm.codec.geometry.metrics import mean_edge_length
from bsm.commands.flags import (
    add_flags,
    add_inputs,
    adder,
    asked,
    options_of,
    refuse_two_on_one_pipe,
)
from bsm.encoding.options import denoise_options
from bsm.files import mesh as meshes
from bsm.files import table
from bsm.files.formats.metadata import Written
from bsm.files.motion.folder import separate_meshes
from bsm.files.motion.frames import Frames
from bsm.files.output import output_inside, refuse_to_overwrite
from bsm.files.pipes import size_of
from bsm.files.sequence import open_sequence, sequence_kind, sequence_writer
from bsm.files.table import format_of_name
from bsm.ground.console import Console
from bsm.ground.lengths import length, unit_of
from bsm.jobs.plan import plan
from bsm.jobs.run import Batch, run_jobs
from bsm.jobs.task import Facts, Task

if TYPE_CHECKING:
    from bsm.codec.denoise import AutomaticChoice, DenoiseOptions

GOALS = ("shading", "shape")
BEGINNINGS = {
    "tgv": "total generalized variation of normals (tgv)",
    "rays": "surface of fewest bends along camera rays",
    "bends": "surface of fewest bends",
    "none": "guided normals",
}
FINISHES = {
    "learnt": "learnt normals",
    "flat": "planes",
    "flat, learnt": "learnt normals and planes",
}
STREAM = "bsm"


@dataclass(frozen=True, kw_only=True)
class DenoiseJob(Task):
    """The task of `bsm denoise`: formats, the goal of the automatic mode, or options instead of it."""

    format: str | None = None
    goal: str = GOALS[0]
    strength: float = 1.0
    look: bool = False
    options: dict[str, Any] = field(default_factory=dict)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = adder(parser)
    add_inputs(
        parser,
        "mesh file (PLY, OBJ, STL, GLB, 3MF, ...), - for standard input, or a sequence: npz, USD, folder, pattern. From"
        " 8 frames on, noise that changes with the frames is removed in time first",
        "output file, or folder for several inputs (default: IN with .denoised before its suffix). A stream (.bsm) is "
        "encoded near-lossless",
    )
    add(
        "--format",
        "",
        "format of the input and of a piped output",
        choices=(*table.MESH_FORMATS, "npy"),
    )
    goal = (
        "aim of the automatic mode: normals close to the true ones (shading), or vertices (shape)"
    )
    add("--for", "", goal, dest="goal", choices=GOALS, default=GOALS[0])
    add_flags(parser, "denoise")
    ways = parser.add_argument_group(
        "instead of the automatic mode",
        "Without these options, bsm chooses the method by the noise of the mesh, or of the first frame.\n"
        "If you give one, the others have their defaults. The scheme of the paper is --method oi. A result\n"
        "that loses detail is written only with --force.",
    )
    add_flags(ways, "denoise method")


def run(args: argparse.Namespace, console: Console) -> int:
    meshes_in = {path: separate_meshes(path, args.format) for path in args.inputs}
    inputs: list[str] = []
    for path in args.inputs:
        inputs += meshes_in[path] or [path]
    if args.output is not None and any(meshes_in.values()) and not Path(args.output).is_dir():
        # A folder of meshes becomes a folder, whether its name ends in / or not.
        # Without the sign, `plan` would take the name for that of a file, and refuse several inputs.
        args.output = args.output.rstrip("/") + "/"
    # Never onto the input itself: denoising is a judgment, and the original may be needed again.
    beside = ".denoised"
    if args.output:
        beside = ""
    jobs = plan(inputs, args.output, lambda name: beside + _suffix(name), sole_folder=True)
    refuse_two_on_one_pipe(args, jobs[0].output)
    job = asked(DenoiseJob, args, output="", options=options_of(args, "denoise method"))
    return run_jobs(asked(Batch, args), job, console, denoise_one, jobs)


def denoise_one(args: DenoiseJob, console: Console) -> Facts:
    options = denoise_options(**args.options)
    if sequence := open_sequence(args.input, args.format):
        result = _denoise_sequence(args, console, sequence, options)
    else:
        if Path(args.output).is_dir():
            args = replace(args, output=output_inside(args.output, args.input, _suffix(args.input)))
        result = _denoise_mesh(args, console, options)
    sizes = {"input_bytes": size_of(args.input), "output_bytes": size_of(args.output)}
    return {"input": args.input, "output": args.output, **sizes, **result}


def _suffix(name: str) -> str:
    usual = "ply"
    if Path(name).is_dir():
        usual = "npz"
    return f".{format_of_name(name) or usual}"


def _denoise_mesh(
    args: DenoiseJob, console: Console, options: "DenoiseOptions | None"
) -> dict[str, Any]:
    kind = _kind_of_output(args)
    # Imported here, since only some runs need them, and the codec takes time to load.
    from bsm.api import encode, look
    from bsm.codec.denoise import FrameDenoiser

    with console.progress("reading", until=0.05):
        source = meshes.read_mesh(args.input, args.format)
    mesh = source.mesh
    begin = time.perf_counter()
    with console.progress("denoising", until=0.95) as progress:
        ways: dict[str, Any] = {"goal": args.goal, "strength": args.strength, "force": args.force}
        denoiser = FrameDenoiser(
            mesh.positions, mesh.faces, options, **ways, progress=progress.stage
        )
        (positions,) = denoiser([mesh.positions])
    unit = unit_of(mesh.metadata)
    for line in _found(
        denoiser.choice, args.goal, mean_edge_length(mesh.positions, mesh.faces), unit
    ):
        console.note(line)
    words, moves = _movement(np.linalg.norm(positions - mesh.positions, axis=1), unit)
    # If no vertex has moved, the file is copied byte by byte. To write it anew would lose what the reader does not
    # keep.
    same = (
        not moves["vertices"] and kind == format_of_name(args.input) and Path(args.input).is_file()
    )
    if same:
        words += "; the file is copied"
    else:
        for note in source.notes:
            console.note(f"{args.input}: {note}")
    console.note(f"moved      {words}")
    seconds = time.perf_counter() - begin
    # Normals belong to the positions that they were made for. They are left out, and a note says so.
    moved, stale = mesh, tuple[str, ...]()
    if moves["vertices"]:
        moved, stale = mesh.moved(positions)
    more: dict[str, Any] = {"moved": moves}
    if args.look:
        distance = look(mesh, moved)
        console.note(
            f"look       {distance.distance:.2g} from the input (at 1, both look the same)"
        )
        more["look"] = asdict(distance)
    if same:
        file = meshes.copied(args.input, mesh, args.output)
    elif kind == STREAM:
        file = Written(encode(moved, preset="near-lossless"))
    else:
        file = meshes.written_mesh(moved, kind, args.output)
    left_out = meshes.save_written(
        args.output, file, overwrite_beside=args.force, **args.placing(args.output)
    )
    if left_out or stale:
        console.note(f"{args.input}: left out: {', '.join((*stale, *left_out))}")
    console.note(
        f"{args.input}: {counted(vertices=len(mesh.positions))} -> {args.output}, {seconds:.2f} s"
    )
    return {
        **_result((len(positions), len(mesh.faces), 1), seconds, denoiser.choice, options),
        **more,
    }


def _movement(moves: Any, unit: str) -> tuple[str, Facts]:
    """Return in words, and as numbers, how far vertices moved, shape (n,)."""
    touched, farthest = int((moves > 0.0).sum()), float(moves.max(initial=0.0))
    facts = {"vertices": touched, "mean": 0.0, "farthest": farthest}
    if not touched:
        return "no vertex", facts
    facts["mean"] = mean = float(moves[moves > 0.0].mean())
    who = "all vertices"
    if touched < len(moves):
        who = f"{touched} of {counted(vertices=len(moves))}"
    return f"{who}, by {length(mean, unit)} on average, {length(farthest, unit)} at most", facts


def _kind_of_output(args: DenoiseJob) -> str:
    kind = format_of_name(args.output)
    if args.output == "-":
        kind = args.format
    elif args.output.lower().endswith(f".{STREAM}"):
        kind = STREAM
    if kind not in (*table.WRITTEN_FORMATS, STREAM):
        # A pipe has no name that could tell a format.
        if args.output == "-":
            raise OptionError(
                f"a pipe has no suffix; give --format: {', '.join(table.WRITTEN_FORMATS)}"
            )
        raise meshes.unknown_suffix(args.output, STREAM)
    refuse_to_overwrite(args.output, args.may_replace(args.output))
    return str(kind)


def _denoise_sequence(
    args: DenoiseJob, console: Console, source: Frames, options: "DenoiseOptions | None"
) -> dict[str, Any]:
    format_of_pipe = None
    if args.output == "-":
        format_of_pipe = args.format
    kind = sequence_kind(args.output, format_of_pipe)

    from bsm.codec.denoise import FrameDenoiser

    if args.look:
        raise OptionError("--look is for single meshes; leave it out for a sequence")
    # The denoiser learns from the first frame how noisy the sequence is, before it sees the others.
    first = next(source.frames)
    begin = time.perf_counter()
    denoiser = FrameDenoiser(
        first, source.faces, options, goal=args.goal, strength=args.strength, force=args.force
    )
    count = 0
    writer = sequence_writer(
        args.output, kind, source.faces, source.count, **args.placing(args.output)
    )
    with writer as write, console.progress("denoising") as progress:
        for frame in denoiser(chain([first], source.frames)):
            write(frame)
            count += 1
            if source.count:
                progress(count, source.count)
            if count == 1:
                # The choice is made while the first frame is denoised, so it can be told only now.
                for line in _found(
                    denoiser.choice, args.goal, mean_edge_length(first, source.faces)
                ):
                    console.note(line)
    seconds = time.perf_counter() - begin
    console.note(
        f"{args.input}: {counted(frames=count)} of {counted(vertices=len(first))} -> {args.output}, "
        f"{seconds:.2f} s, {1e3 * seconds / count:.0f} ms a frame"
    )
    return _result((len(first), len(source.faces), count), seconds, denoiser.choice, options)


def _result(
    shape: tuple[int, int, int],
    seconds: float,
    choice: "AutomaticChoice | None",
    options: "DenoiseOptions | None",
) -> dict[str, Any]:
    chosen = {"automatic": choice and asdict(choice), "options": options and asdict(options)}
    return {
        **dict(zip(("vertices", "faces", "frames"), shape, strict=True)),
        "seconds": seconds,
        **chosen,
    }


def _found(
    choice: "AutomaticChoice | None", goal: str, edge: float, unit: str = ""
) -> Iterator[str]:
    """Yield lines about the noise and the chosen method; none if the options chose the method."""
    if choice is None:
        return
    if choice.outliers:
        yield f"outliers   {counted(vertices=choice.outliers)} moved back"
    # Doing nothing is a result. It is told with its reason, and with the way to insist.
    if not choice.steps:
        if not choice.outliers:
            if choice.kind == "unsteady":
                yield f"steadied   {choice.reason}"
            else:
                yield f"unchanged  {choice.reason}"
                ask = "--hand-over none --iterations 5 --force"
                yield f"           if you see noise, choose a filter: bsm denoise IN {ask}"
        return
    noise = choice.noise
    yield f"found      {choice.reason}"
    line = f"noise      {noise.normal:.2f} edges ({length(noise.normal * edge, unit)})"
    if not choice.reliable:
        line += "; the error cannot be estimated here"
    elif goal == "shape":
        line += f"; vertices about {choice.untreated:.2f} -> {choice.expected:.2f} edges off"
    elif choice.kind != "unsteady":
        least, most = round(choice.expected), round(choice.at_most)
        degrees = f"{least}"
        if most < 2:
            degrees = "below 2"
        elif least < most:
            degrees = f"{least} to {most}"
        line += f"; normals about {choice.untreated:.0f} -> {degrees} degrees off"
        if least < most:
            line += ", more for finer detail"
    yield line
    yield f"chosen     {choice.why}:"
    for step, times in Counter(choice.steps).items():
        chosen = step.filter
        begun = BEGINNINGS.get(chosen.hand_over, f"spectral filter, hand-over {chosen.hand_over}")
        if chosen.needs_coarse:
            begun += f" (c/n {chosen.keep:g})"
        share = 100.0 * times / len(choice.steps)
        then = f"then {step.iterations} iterations of guided normals, sigma_r {chosen.sigma_r:g}"
        yield f"           {share:.0f} %: {begun}, {then}"
    if choice.finish != "none":
        yield f"finish     {FINISHES[choice.finish]}"
