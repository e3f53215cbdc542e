"""One mesh file for each frame, in a folder, named by a pattern, or one by one."""

import glob
import json
import math
import os
import re
import sys
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from functools import lru_cache, partial
from itertools import chain, pairwise
from pathlib import Path
from typing import Any

import numpy as np

from bsm.bitstream.errors import FormatError, MeshError, OptionError
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits
from bsm.codec.geometry.attributes import Attribute, has
from bsm.codec.geometry.mesh import NoFacesError, TriangleMesh
from bsm.codec.sequence.runs import (
    EMPTY,
    SHOWN,
    can_move,
    empty_frame,
    is_empty,
    moved_to,
    other_faces,
)
from bsm.files.conventions import TIME_VALUE
from bsm.files.formats.metadata import Written
from bsm.files.formats.polygons import CutAlike, MeshFile, Polygons
from bsm.files.mesh import read_cut, save_written, written_mesh
from bsm.files.motion.frames import Frames, Wanted, rate_of_times, timing_of
from bsm.files.pipes import about, file_beside, is_pipe, is_url, refuse_link_out
from bsm.files.table import FORMATS, MESH_SUFFIXES, START, STEP

# A sign counts in names such as t_-5, while step-5 has a hyphen.
# A "-" that follows a letter or a digit is a hyphen.
_NUMBERS = re.compile(r"((?:(?<![^\W_])-)?\d+)")
_SIGNED, _UNITS = re.compile(r"-?\d+"), re.compile(r"\d([fpnuµm]?s|min|h)(?![^\W_])")
# Fortran writes 1.0D-05; without the point, it is a name such as model3d-01.
_DECIMALS = re.compile(
    r"((?:(?<![^\W_])-)?(?:\d*\.\d+[dD][-+]\d+|(?:\d+(?:\.\d+)?|(?<![^_])\.\d+)(?:[eE][-+]?\d+)?))"
)
_PLACE = re.compile(r"%(0?)(\d*)d|(##+)")
"""The place of a frame's number in a pattern: %04d, or #### as animation programs write it."""


def names_many(path: str) -> bool:
    """Whether a path is that of a folder, or a pattern: ``run/*.obj``, ``run/%04d.obj`` or ``run/####.obj``."""
    return os.path.isdir(path) or (
        (glob.has_magic(path) or is_numbered(path)) and not os.path.exists(path)
    )


def mesh_files(path: str) -> list[str]:
    """The mesh files of a folder or pattern, in any order."""
    if Path(path).is_dir():
        names = [os.path.join(path, name) for name in os.listdir(path)]
    elif is_numbered(path):
        names = glob.glob(_PLACE.sub("*", path))
    else:
        names = glob.glob(path)
    read = (name for name in names if Path(name).suffix.lower() in MESH_SUFFIXES)
    return [name for name in read if not os.path.basename(name).startswith(".")]


def frame_files(path: str, *, follow: bool = True) -> list[str]:
    """The mesh files of a folder or pattern, by the numbers in their names; `follow` links to other folders."""
    names = mesh_files(path)
    if not names:
        raise FormatError(
            f"no mesh files in {path} ({', '.join(MESH_SUFFIXES)}); -r looks in the folders below, too"
        )
    # A process that reads files from strangers could open the folders of links, too.
    if not follow:
        for name in names:
            with about(name):
                refuse_link_out(os.path.dirname(name), name)
    return in_order(names)


def frame_range(text: str) -> tuple[int, int]:
    """Return the first frame of a range A:B, and the one after the last."""
    first = last = 0
    match = re.fullmatch("([0-9]*):([0-9]*)", text)
    if match:
        first, last = int(match[1] or 0), int(match[2] or sys.maxsize)
    if first >= last:
        raise OptionError(f"--frames {text}: give A:B with 0 <= A < B; either may be left out")
    return first, last


def separate_meshes(path: str, file_format: str | None = None) -> list[str]:
    """The mesh files of a folder or pattern if they are meshes by themselves; none if they are frames."""
    if is_pipe(path) or is_url(path) or not names_many(path):
        return []
    names = sorted(mesh_files(path)) or frame_files(path)  # which says why there are none
    if len(names) > 1:
        cut = CutAlike()
        # The first and the last, since scans of different things rarely agree, and frames always do: reading all would
        # take as long as the job itself.
        first, last = (
            read_cut(name, file_format, DEFAULT_LIMITS, cut).mesh for name in (names[0], names[-1])
        )
        if first.positions.shape == last.positions.shape and np.array_equal(
            first.faces, last.faces
        ):
            return []
    return names


def _differing(names: Sequence[str]) -> list[str]:
    """The parts of paths below the folder that they share."""
    if not names:
        return []
    paths = [os.path.abspath(name) for name in names]
    shared = os.path.commonpath([os.path.dirname(path) for path in paths])
    return [os.path.relpath(path, shared) for path in paths]


def _stems(names: Sequence[str]) -> list[str]:
    return [os.path.splitext(name)[0] for name in _differing(names)]


def _varying(stems: Sequence[str]) -> tuple[str, list[str]]:
    """The numbers that alone tell names apart, or none; and the letters around the first."""
    rows = [_DECIMALS.split(stem) for stem in stems]
    place = _varying_place(rows)
    if place is None:
        return "", []
    words = [row[place].lower().replace("d", "e") for row in rows]
    return f"{rows[0][place - 1][-1:]}#{rows[0][place + 1][:1]}", words


def _varying_place(rows: Sequence[Sequence[str]]) -> int | None:
    """Return the place of the only number that differs between names, which are split into texts and numbers."""
    if len({len(row) for row in rows}) != 1:
        return None
    places = [place for place, values in enumerate(zip(*rows)) if len(set(values)) > 1]
    if len(places) != 1 or places[0] % 2 == 0:
        return None
    return places[0]


def times_in(names: Sequence[str]) -> list[float]:
    """Times in seconds that folders are called, or numbers with an exponent or below zero in names; or nothing."""
    around, words = _varying(_stems(names))
    pattern = r"^-.*[.]|e[-+]"
    if around in (f"#{os.sep}", f"{os.sep}#{os.sep}"):  # of a folder
        pattern = r"[.]|e[-+]"
    if not any(re.search(pattern, word, re.I) for word in words):
        return []
    return [*map(float, words)]


def in_order(names: Sequence[str]) -> list[str]:
    times = times_in(names)
    if times:
        pairs = sorted(zip(times, names, strict=True))
        for (time, name), (next_time, next_name) in pairwise(pairs):
            if time == next_time:
                raise MeshError(f"{name} and {next_name} have one time; name one file for each")
        return [name for _, name in pairs]
    ordered = _sorted_naturally(names)
    _require_clear(ordered)
    _require_one_series(ordered)
    numbers = _numbers(ordered)
    steps = np.diff(numbers)
    if len(steps) and steps.min() > 0 and (steps != steps.min()).any():
        place = int(np.argmax(steps != steps.min()))
        missing = numbers[place] + int(steps.min())
        between = f"between {ordered[place]} and {ordered[place + 1]}"
        raise MeshError(
            f"frame {missing} is missing {between}; add it, or number the files without a gap"
        )
    return ordered


def _sorted_naturally(names: Sequence[str]) -> list[str]:
    """Sort names by the numbers in them."""
    keys = dict(zip(names, map(_natural, _differing(names)), strict=True))
    return sorted(names, key=keys.__getitem__)


def _require_one_series(ordered: Sequence[str]) -> None:
    """Refuse two files for one frame, and two series of frames; names that are alike but for numbers are one."""
    names_by_stem: dict[str, list[str]] = {}
    names_by_series: dict[str, list[str]] = {}
    for name, stem in zip(ordered, _stems(ordered), strict=True):
        names_by_stem.setdefault(stem, []).append(name)
        names_by_series.setdefault(_DECIMALS.sub("#", stem), []).append(name)
    for names in names_by_stem.values():
        if len(names) > 1:
            raise MeshError(
                f"{names[0]} and {names[1]} are two files for one frame; name the files of one format"
            )
    series = [*names_by_series.values()]
    if len(series) > 1 and all(len(names) > 1 for names in series):
        those = " and ".join(map(common_name, series[:2]))
        raise MeshError(
            f"these files are {len(series)} series of frames, {those}; name the files of one, as a pattern"
        )


# A wrong guess still gives an animation, which jerks for no visible reason; so names that can be read in two
# ways are refused.
def _require_clear(ordered: Sequence[str]) -> None:
    """Refuse names whose numbers can be read in two ways, with another order each."""
    bases, stems = _differing(ordered), _stems(ordered)
    shapes = [_NUMBERS.sub("#", base) for base in bases]
    place = _first_place(shape != shapes[0] for shape in shapes)
    reason = ""
    if len(set(shapes)) > len({_SIGNED.sub("#", base) for base in bases}):
        reason = 'the "-" may be a sign or a hyphen; write _- before negative numbers'
    has_one_length = len({*map(len, stems)}) == 1
    varying_letters = sum(len({*letters}) > 1 for letters in zip(*stems))
    if not (has_one_length and varying_letters <= 1) and not any(map(_NUMBERS.search, stems)):
        place, reason = len(ordered) - 1, "nothing in their names tells it; add their times"
    if len({re.sub("[#.]+", "#", shape) for shape in shapes}) < len({*shapes}):
        reason = "some have a point ahead of the number"
    _, words = _varying(stems)
    falls = _first_fall([*map(float, words)])
    if falls and len({number.partition(".")[0] for number in words}) > 1:
        place, reason = falls, "as decimal numbers they are the other way round"
    units = list(chain.from_iterable(map(_UNITS.findall, stems)))
    other_unit = _first_place(unit != units[0] for unit in units)
    if other_unit:
        place, reason = other_unit, "their units differ"
    for keys in zip(*(map(_natural, base.split(os.sep)) for base in bases)):
        falls = _first_fall(keys)
        if falls:
            place, reason = falls, "folders and names both count"
    if reason:
        first = ordered[max(place - 1, 0)]
        raise MeshError(
            f"the order of {first} and {ordered[place]} is unclear: {reason}, or number the files from 0 on"
        )


def _first_place(marks: Iterable[bool]) -> int:
    """Return the place of the first mark; 0 if there is none."""
    return next((place for place, mark in enumerate(marks) if mark), 0)


def _first_fall(keys: Sequence[Any]) -> int:
    """Return the place of the first key that is less than the one before it; 0 if they do not fall."""
    return next((place for place in range(1, len(keys)) if keys[place] < keys[place - 1]), 0)


def look_like_frames(names: Sequence[str]) -> bool:
    """Whether files are called like the frames of one animation: alike but for a number that counts up evenly."""
    steps = np.diff(_numbers(_sorted_naturally(names)))
    return len(steps) > 0 and steps.min() > 0 and bool((steps == steps.min()).all())


def common_name(names: Sequence[str]) -> str:
    """Return one name for many files: their common beginning and end."""
    first, last = min(names), max(names)
    length = 0
    while length < len(first) and first[length] == last[length]:
        length += 1
    return f"{first[:length]}*{Path(first).suffix}"


def _natural(name: str) -> list[str | int]:
    parts: list[str | int] = [*_NUMBERS.split(name)]
    parts[1::2] = map(int, parts[1::2])
    return parts


def _numbers(ordered: Sequence[str]) -> list[int]:
    """The number that counts the files; none, if there is none that alone tells them apart."""
    rows = [_NUMBERS.split(name) for name in _differing(ordered)]
    place = _varying_place(rows)
    if place is None:
        return []
    return [int(row[place]) for row in rows]


def read_files(
    names: Sequence[str], read_named: Callable[[str], MeshFile], request: Wanted
) -> Frames:
    """The frames in files, each read when asked for; with `runs`, faces change. Times: wanted, in files, or numbers."""
    runs, rate, times = request.runs, request.rate, request.times
    # A list may name one file for many times.
    read_once, notes = lru_cache(maxsize=1)(read_named), list[str]()

    def read(number: int) -> TriangleMesh:
        with about(f"{names[number]} (frame {number})"):
            try:
                mesh_file = read_once(names[number])
            except NoFacesError as error:
                if runs:
                    return empty_frame()
                raise MeshError(f"{error}; with --runs, frames may be without") from error
        if number == 0:
            notes.extend(note for note in mesh_file.notes if note not in notes)
        return mesh_file.mesh

    first, count = read(0), len(names)
    metadata = {name: value for name, value in first.metadata.items() if name != TIME_VALUE}
    if TIME_VALUE in first.metadata and not times:
        times = [float(read(number).metadata.get(TIME_VALUE, "nan")) for number in range(count)]
    times = times or times_in(names)
    rate_of_names = rate_of_times(np.array(times, np.float64))
    if rate and times and rate_of_names != rate:
        note = f"the times of frames are replaced by the frame rate {rate:g}"
        if rate_of_names > 0:
            note += f"; theirs is {rate_of_names:g}"
        notes.append(note)
    timing: Mapping[str, float | str] | None = _numbering(names)
    if times:
        rate, timing = timing_of(np.array(times, np.float64), rate)
    if timing is None:
        notes.append("the times of frames are not numbers that grow, and are left out")
    # An attribute that moves differs most between the first and the last frame; looking at all frames would read the
    # folder twice.
    last = first
    if first.attributes and not runs:
        last = read(count - 1)
    attributes = _attributes_in_all(first, last, notes)
    still = [attribute.name for attribute in attributes if not can_move(attribute)]
    if count > 1 and still:
        first_in_words = "the first frame"
        if runs:
            first_in_words = "the first frame of each run"
        notes.append(f"{', '.join(still)}: as {first_in_words} has them")
    changes = (
        runs
        or len(still) < len(attributes)
        or any(name.startswith(SHOWN) for name in first.metadata)
    )

    def meshes() -> Iterator[TriangleMesh]:
        if runs:
            yield first
        else:
            yield replace(first, attributes=attributes)
        for number in range(1, count):
            mesh = read(number)
            if not runs:
                mesh = _with_faces_of(
                    first, names[0], attributes, mesh, f"{names[number]} (frame {number})"
                )
            yield mesh

    positions = (mesh.positions for mesh in meshes())
    shared = attributes, tuple(notes), rate, {**metadata, **(timing or {})}
    moving: Iterator[TriangleMesh] | None = None
    if changes:
        moving = meshes()
    return Frames(first.faces, count, positions, *shared, moving)


def _attributes_in_all(
    first: TriangleMesh, last: TriangleMesh, notes: list[str]
) -> tuple[Attribute, ...]:
    """Return the attributes of the first frame that the last one has, too; note the others."""
    attributes: list[Attribute] = []
    normals: list[str] = []
    others: list[str] = []
    for attribute in first.attributes:
        if attribute.name == EMPTY:
            continue
        if _as_in(last, attribute) is not None:
            attributes.append(attribute)
        elif attribute.semantic == "normal":
            normals.append(attribute.name)
        else:
            others.append(attribute.name)
    if normals:
        notes.append(
            f"left out: {', '.join(normals)}; a sequence has no normals, which follow from positions"
        )
    if others:
        notes.append(f"left out, for they move or change: {', '.join(others)}")
    return tuple(attributes)


def read_steps(
    surface: Callable[[int], Polygons],
    times: Sequence[float],
    size: int,
    request: Wanted,
    limits: Limits,
) -> Frames | None:
    """The steps in a file of so many bytes as frames; None if it has fewer than two."""
    if len(times) < 2:
        return None
    cut = CutAlike()

    def read(step: str) -> MeshFile:
        return surface(int(step)).checked(limits, size, cut)

    return read_files([*map(str, range(len(times)))], read, replace(request, times=times))


def _with_faces_of(
    first: TriangleMesh,
    of_first: str,
    attributes: Sequence[Attribute],
    mesh: TriangleMesh,
    name: str,
) -> TriangleMesh:
    """A frame with the attributes that are kept; an error if its faces are not those of the first one."""
    difference = other_faces(first, mesh)
    if difference:
        raise MeshError(
            f"these are different meshes, not the frames of one animation: {name} has other faces than {of_first}: "
            f"{difference}; if their faces change, --runs; to work on each by itself, name the files, or the folder "
            "with -r, and write to a folder, -o FOLDER/"
        )
    attributes_here: list[Attribute] = []
    for attribute in attributes:
        same_here = _as_in(mesh, attribute)
        if same_here is None:
            raise MeshError(
                f"{attribute.name} differs in {name} but not in the last frame; only colors and numbers of vertices "
                "may change: --runs keeps others as the first frame has them"
            )
        attributes_here.append(same_here)
    return replace(mesh, attributes=tuple(attributes_here))


LISTS = ("pvd", "series")  # of ParaView, files and their times


def listed(path: str, kind: str, limits: Limits) -> tuple[list[str], list[float], list[int]]:
    """Return the files of a list, the times, and how many files each time has."""
    # Before reading: a list is text that is parsed as a whole.
    limits.check("metadata_bytes", os.path.getsize(path))
    data = Path(path).read_bytes()
    try:
        if kind == "series":
            rows = [
                (float(entry["time"]), str(entry["name"])) for entry in json.loads(data)["files"]
            ]
        else:
            from bsm.files.formats.vtp import elements_of  # which loads a parser of XML

            entries = [element.attrib for element in elements_of(data) if element.tag == "DataSet"]
            rows = [(float(entry.get("timestep") or 0.0), entry["file"]) for entry in entries]
        if not all(math.isfinite(time) for time, _ in rows):
            raise ValueError("a time is not finite")
    # JSON may hold anything in any place, and nested lists end the recursion of its parser.
    except (
        ValueError,
        TypeError,
        KeyError,
        AttributeError,
        OverflowError,
        RecursionError,
    ) as error:
        raise FormatError(
            f"this is not a .{kind} file of ParaView: {type(error).__name__}: {error}"
        ) from error
    counts = Counter(time for time, _ in sorted(rows, key=lambda row: row[0]))
    different = len(set(rows))
    if kind == "series":
        different = len(counts)
    if not rows or different < len(rows):
        raise MeshError("the list names no file, or two for one time that are not its parts")
    names: list[str] = []
    for _, name in sorted(rows, key=lambda row: row[0]):
        with about(name):
            file = file_beside(Path(path).resolve().parent, name)
            names.append(str(file))
    return names, [*counts], [*counts.values()]


def _numbering(names: Sequence[str]) -> dict[str, float | str]:
    """Return the first number and the step of names that count frames, as metadata."""
    numbers = _numbers(names)
    metadata: dict[str, float | str] = {}
    if len(numbers) < 2:
        return metadata
    start, step = float(numbers[0]), float(numbers[1] - numbers[0])
    if start:
        metadata[START] = start
    if step != 1:
        metadata[STEP] = step
    return metadata


def _as_in(mesh: TriangleMesh, attribute: Attribute) -> Attribute | None:
    """An attribute of the first frame as a later one has it; None where it differs and cannot move."""
    if can_move(attribute):
        return moved_to(attribute, mesh.attributes)
    if attribute.semantic == "normal" or not has(mesh.attributes, attribute):
        return None
    return attribute


# --------------------------------------------------------------------------------------------------------- the way back


def is_numbered(path: str) -> bool:
    """Whether a path has a place for the number of a frame, as ``walk/%04d.obj`` and ``walk/####.obj`` have."""
    name = os.path.basename(path)
    return len(_PLACE.findall(name)) == 1 and "%" not in _PLACE.sub("", name)


def _number_at(number: int, place: re.Match[str]) -> str:
    """Write the number of a frame as its place in a pattern asks."""
    if place[3]:
        return f"{number:0{len(place[3])}d}"
    return f"{number:{place[1]}{place[2]}d}"


def _written_frame(mesh: TriangleMesh, kind: str, target: Path) -> Written:
    contents_of_nothing = FORMATS[kind].empty
    if is_empty(mesh.attributes) and contents_of_nothing is not None:
        return Written(contents_of_nothing)
    return written_mesh(mesh, kind, target)


@contextmanager
def write_files(
    path: str, kind: str, *, overwrite: bool
) -> Iterator[Callable[[TriangleMesh, int], tuple[str, ...]]]:
    """A file for each frame: in a folder, or called by a pattern; files that were written are removed after an error"""
    pattern = Path(path)
    if not is_numbered(path):
        pattern = Path(path, f"%05d.{kind}")
    if not is_numbered(pattern.name):
        raise OptionError(f"{path}: write one %d or %04d for the number of the frame")
    new = not pattern.parent.exists()
    pattern.parent.mkdir(parents=True, exist_ok=True)
    if not is_numbered(path) and any(pattern.parent.iterdir()) and not overwrite:
        raise FileExistsError(17, "the folder is not empty; -f writes into it", path)
    written: list[Path] = []

    def write(mesh: TriangleMesh, number: int) -> tuple[str, ...]:
        target = pattern.parent / _PLACE.sub(partial(_number_at, number), pattern.name)
        file = _written_frame(mesh, kind, target)
        # Only files that are new are removed after an error: a frame of before, half overwritten or not, is the user's.
        was_there = target.exists()
        if not was_there:
            written.extend([target, *(target.parent / name for name in file.beside)])
        return save_written(target, file, overwrite=overwrite, follow=False)

    try:
        yield write
    except BaseException:
        for target in written:
            target.unlink(missing_ok=True)
        if new and not any(pattern.parent.iterdir()):
            pattern.parent.rmdir()
        raise
