"""bsm tile: a mesh larger than memory to a folder of tiles, coarse to fine."""

import argparse
import errno
import os
import posixpath
from contextlib import ExitStack, suppress
from pathlib import Path

from bsm.bitstream.errors import BsmError, FormatError, OptionError, counted
from bsm.codec.static.options import EncodeOptions
from bsm.codec.threads import available_threads
from bsm.commands.flags import add_flags, adder, asked, within
from bsm.files.images import ImageRule
from bsm.files.output import by_its_own_name, refuse_to_overwrite
from bsm.files.pipes import about, is_url, name_in, remove, size_of, state_of
from bsm.files.stream import MANIFEST
from bsm.ground.console import Console, print_json
from bsm.ground.exits import report_error
from bsm.jobs.run import Batch, run_many
from bsm.jobs.task import Job, Outcome, came_to
from bsm.tiles.cutting import Plan, chosen_lattice, cut, load_plan
from bsm.tiles.joining import CONTENT_HELP, CONTENTS, TILESET, write_tileset
from bsm.tiles.making import TileJob, tile_one
from bsm.tiles.reading import read_big
from bsm.tiles.shards import is_unfinished, open_tiles, write_shards, write_unfinished
from bsm.tiles.work import NOTE, held, refuse_others, remove_made, there


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = adder(parser)
    add_flags(parser, "tile", "inputs", "many inputs")
    add(
        "--triangles",
        "N",
        "largest number of triangles of a tile (default 2^19)",
        type=within(64),
        default=1 << 19,
    )
    more = "write tileset.json (3D Tiles) and a GLB for each tile instead of shards. "
    add("--tileset", "", more + CONTENT_HELP, nargs="?", choices=CONTENTS, const=CONTENTS[0])
    images = "how the textures of tiles are written: webp, webp:85, jpeg:90@2048 (default webp)"
    add("--images", "RULE", images, type=ImageRule.parse, default=ImageRule("webp"))


def run(args: argparse.Namespace, console: Console) -> int:
    # Raises the errors of wrong values, before hours of reading.
    grid_cell = args.grid_cell if args.grid_cell is not None else 1.0
    EncodeOptions(grid_cell=grid_cell, grid_origin=args.grid_origin)
    if not is_url(args.input) and args.input != "-":
        os.stat(args.input)
    beside = os.path.join(args.output, ".work")
    outputs = [Path(args.output)]
    if is_url(args.output):
        beside = f"{name_in(args.output) or 'tiles'}.work"
        outputs = []
    work = Path(os.path.abspath(args.work or beside))
    # The default lies in the output folder, which others may be able to write to.
    if not args.work and work.is_symlink():
        raise OptionError(f"{work} is a symbolic link; remove it, or name a folder with --work")
    # Both folders are locked for the whole run. A second run would take away the files of the first.
    with ExitStack() as folders:
        folders_taken = [*outputs]
        if args.work or not outputs:
            folders_taken.append(work)
        for folder in folders_taken:
            folders.enter_context(there(folder))
        is_left = False
        for folder in folders_taken:
            is_left |= folders.enter_context(held(folder, args.force or args.resume))
        folders.enter_context(console.progress())
        return _run(args, console, work, is_left)


def _run(args: argparse.Namespace, console: Console, work: Path, is_left: bool) -> int:
    """Do the work in folders that this process has locked."""
    plan = _begun(args, work, console, is_left)
    asked_for = asked(TileJob, args, input="", output="", most=args.triangles, force=False)

    def ended(job: Job, outcome: Outcome) -> None:
        if outcome.error is not None:
            report_error(outcome.error, as_json=args.json, options=console.options)

    # The report is what --resume reads: tiles that are done and unchanged are not made again.
    many = asked(Batch, args, report=str(work / "tiles.json"))
    share = 0.96  # of the work
    if args.tileset:
        share = 0.5
    with console.progress(until=share):
        rows = run_many(many, asked_for, console, tile_one, _jobs(plan, work, args.finest), ended)
    # The manifest is written after the last tile, so that a reader never takes a part for the whole. The work stays and
    # can be resumed.
    if failed := [facts for facts in rows if "error" in facts]:
        console.note(
            f"{len(failed)} of {len(rows)} tiles failed; --resume repeats these and the tiles above them"
        )
        return int(failed[0]["exit"])
    over = args.force or args.resume
    rows.sort(key=lambda facts: (-len(Path(facts["output"]).stem), facts["output"]))
    write_unfinished(args.output, args.input)
    manifest, bytes_written = write_shards(
        args.output, plan, rows, os.path.basename(args.input), overwrite=over
    )
    # Before the tileset, which needs as much room again.
    remove_made(work)
    if args.tileset:
        bytes_written = write_tileset(
            open_tiles(args.output), args.output, console, content=args.tileset, overwrite=over
        )
        # What the tileset holds again.
        for name in (MANIFEST, *(shard["file"] for shard in manifest["shards"])):
            remove(posixpath.join(args.output, name))
    elif over:
        with suppress(FileNotFoundError):
            remove(posixpath.join(args.output, TILESET))  # it may be of another mesh
    came = came_to(size_of(args.input), bytes_written)
    console.note(
        f"{args.input} -> {args.output}: {counted(vertices=plan.vertices, faces=plan.faces, tiles=len(rows))} in "
        f"{counted(levels=len(manifest['levels']))}, on a grid of {plan.lattice.cell:g}, {came}"
    )
    if joined := sum(facts.get("joined", 0) for facts in rows):
        console.note(
            f"vertices that share a grid point with another and are joined: {joined} "
            f"(fewer with --grid-cell {plan.lattice.cell / 2:g})"
        )
    if ratios := [facts["psnr_db"] for facts in rows if facts.get("psnr_db") is not None]:
        console.note(
            f"textures are written as {args.images.kind}, PSNR {min(ratios):.1f} dB in the worst tile"
        )
    if args.json:
        print_json(manifest)
    return 0


def _jobs(plan: Plan, work: Path, finest: bool) -> list[Job]:
    """A job for each tile; those of coarser tiles wait for the tiles that they are made of."""
    names = [name for name in plan.nodes() if name in plan.leaves or not finest]
    numbers, jobs = {name: number for number, name in enumerate(names)}, list[Job]()
    for name in names:
        # A coarse tile waits for its eight parts only, not for its whole level: few processes are ever idle.
        below = tuple(numbers[name + eighth] for eighth in "01234567" if name + eighth in numbers)
        source = "plan.json"
        if below:
            source = f"{name}[0-7].mesh"
        jobs.append(Job(str(work / source), str(work / f"{name}.bsm"), below))
    return jobs


def _begun(args: argparse.Namespace, work: Path, console: Console, is_left: bool) -> Plan:
    """Return the plan, with the output marked as unfinished; `left`: a killed process had locked a folder before."""
    unfinished = is_unfinished(args.output)
    # The user chooses. Both continuing and starting again are reasonable, and starting again may throw away hours.
    if unfinished and (work / "plan.json").is_file() and not (args.force or args.resume):
        message = "these tiles are unfinished: --resume continues, -f starts again"
        raise FileExistsError(errno.EEXIST, message, args.output)
    for name in (MANIFEST, TILESET):
        refuse_to_overwrite(
            posixpath.join(args.output, name),
            args.force or bool(unfinished) or (is_left and args.resume),
        )
    refuse_others(work)
    if unfinished is not False:
        write_unfinished(args.output, args.input)
    with about(args.input), by_its_own_name(work):
        try:
            return _planned(args, work, console)
        except BsmError:
            if unfinished is None:
                with suppress(OSError):
                    remove(posixpath.join(args.output, MANIFEST))
            raise


def _planned(args: argparse.Namespace, work: Path, console: Console) -> Plan:
    """Return the plan of the resumed run, or of a new one."""
    options = {
        name: getattr(args, name) for name in ("triangles", "grid_cell", "grid_origin", "images")
    }
    # With other options or another input, tiles of two runs would not fit together.
    asked_for = repr((options, state_of(args.input)))
    note = work / NOTE
    if args.resume and (work / "plan.json").is_file():
        if note.read_text() != asked_for:
            raise FormatError(
                f"{work} belongs to another mesh or other options; leave out --resume, or give another --work"
            )
        return load_plan(work / "plan.json")
    remove_made(work)
    work.mkdir(parents=True, exist_ok=True)
    with note.open("x") as file:
        file.write(asked_for)
    try:
        raw = read_big(args.input, args.format, work, console)
        if raw.left_out:
            names = ", ".join(raw.left_out)
            console.note(
                f"{args.input}: left out: {names}; tiles have positions, faces, colors, normals, textures"
            )
        with console.progress("cutting", until=0.3):
            threads = args.jobs or available_threads()
            plan = cut(
                raw, *chosen_lattice(raw, args.grid_cell, args.grid_origin, threads), args.triangles
            )
    # Plain errors of the system, such as a full disk, leave the work for --resume.
    except BsmError:  # no run could go on with what is refused
        remove_made(work)
        raise
    plan.save(work / "plan.json")
    return plan
