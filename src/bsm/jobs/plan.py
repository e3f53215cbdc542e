"""Which output each input has."""

import errno
import glob
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path, PurePath

from bsm.bitstream.errors import OptionError
from bsm.files import pipes
from bsm.files.output import default_output, no_link, output_inside, own_name, refuse_collisions
from bsm.files.table import MESH_SUFFIXES, SEQUENCE_FORMATS
from bsm.jobs.task import Job


def plan(
    inputs: Sequence[str],
    output: str | None,
    suffix: Callable[[str], str],
    *,
    sole_folder: bool = False,
) -> list[Job]:
    """Return a job for each input, with its output."""
    names = input_names(inputs)
    output = own_name(output) if output else None
    folder = output is not None and (
        output.endswith("/") or (not pipes.is_url(output) and Path(output).is_dir())
    )
    if len(names) > 1:
        # Meshes have no end mark on a pipe: two of them could not be told apart.
        if "-" in names or output == "-":
            raise OptionError("a pipe holds one mesh; name files, or give only one input")
        if output and not folder:
            raise OptionError(f"{len(names)} inputs need an output folder: -o {output}/")
    if output is None:
        jobs = [Job(name, default_output(name, suffix(name))) for name in names]
    elif folder and not (sole_folder and len(names) == 1):
        jobs = [Job(name, output_inside(output, name, suffix(name))) for name in names]
    else:
        jobs = [Job(name, output, follow=True) for name in names]
    # Two inputs that differ only in their suffix would write one file.
    jobs = apart(jobs, suffix)
    refuse_collisions(names, [job.output for job in jobs])
    if output and folder and not pipes.is_url(output):
        # After all refusals, so that a wrong command leaves no empty folders.
        Path(output).mkdir(parents=True, exist_ok=True)
    return jobs


STREAM_SUFFIXES = (".bsm",)


def files_in(folders: Sequence[str], read: Sequence[str] = MESH_SUFFIXES) -> list[tuple[str, Path]]:
    """Return the files that are read in folders and subfolders, each after its folder."""
    for folder in folders:
        if pipes.is_url(folder) or not Path(folder).is_dir():
            raise OptionError(f"{folder}: not a local folder; --recursive searches local folders")
    # Sorted, because file systems list folders in any order.
    every = ((folder, path) for folder in folders for path in sorted(Path(folder).rglob("*")))
    found = [
        (folder, path) for folder, path in every if path.suffix.lower() in read and path.is_file()
    ]
    if not found:
        what = "mesh files"
        if read == STREAM_SUFFIXES:
            what = "streams"
        raise OptionError(f"no {what} in {', '.join(folders)} or subfolders ({', '.join(read)})")
    return found


def plan_trees(
    folders: Sequence[str], output: str | None, suffix: str, read: Sequence[str] = MESH_SUFFIXES
) -> list[Job]:
    """Return a job for each file that is read in folders and subfolders; `output` gets the same subfolders."""
    _refuse_name_of_file(output)
    jobs = []
    for folder, path in files_in(folders, read):
        place = path
        if output is not None:
            place = Path(output, path.relative_to(folder))
        target = no_link(str(place.with_suffix(suffix)))
        jobs.append(Job(str(path), target, follow=output or folder, within=folder))
    jobs = apart(jobs, lambda _: suffix)
    refuse_collisions([job.input for job in jobs], [job.output for job in jobs])
    for parent in {Path(job.output).parent for job in jobs}:
        parent.mkdir(parents=True, exist_ok=True)
    return jobs


def _refuse_name_of_file(output: str | None) -> None:
    """Raise `OptionError` if the folder for many outputs has the name of one file."""
    if output is None or output.endswith("/") or Path(output).is_dir():
        return
    suffix = PurePath(output).suffix.lower()
    if suffix in (*STREAM_SUFFIXES, *MESH_SUFFIXES, *(f".{kind}" for kind in SEQUENCE_FORMATS)):
        folder = PurePath(output).with_suffix("")
        raise OptionError(
            f"{output}: -r writes a file for each input into a folder, and this is the name of one file; name the "
            f"folder: -o {folder}/. A folder of this name ends in a slash: -o {output}/"
        )


def apart(jobs: Sequence[Job], suffix: Callable[[str], str]) -> list[Job]:
    """Keep the suffixes of inputs that differ only in the suffix: part.obj.bsm, part.stl.bsm."""
    often = Counter(job.output for job in jobs)

    def output(job: Job) -> str:
        if often[job.output] < 2:
            return job.output
        name = job.input
        if pipes.is_url(name):
            name = pipes.name_in(name)
        kept, added = PurePath(name).suffix, suffix(job.input)
        return no_link(f"{job.output.removesuffix(added)}{kept}{added}")

    return [replace(job, output=output(job)) for job in jobs]


def input_names(inputs: Sequence[str]) -> list[str]:
    """Return the names of the inputs; expand URLs with ``*``."""
    names: list[str] = []
    for given in inputs:
        name = own_name(given)
        found = [name]
        # A shell expands patterns of local files only.
        if pipes.is_url(name):
            found = pipes.expanded(name)
        elif name != given and glob.has_magic(name):  # of a file:// URL, which no shell expands
            found = sorted(glob.glob(name))
        if not found:
            raise FileNotFoundError(errno.ENOENT, "no such file", given)
        names += found
    return names
