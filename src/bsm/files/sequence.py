"""Sequences in files and pipes: frames that share their faces, read and written one at a time.

Forms: mesh files, one for each frame, in a folder, named by a pattern (``run/*.obj``, ``run/%04d.obj``) or one by one;
an npz with `positions` of shape (T, n, 3) and `faces`; PC2 and MDD beside a mesh; animated glTF; USD; and, for live
pipes, npy arrays one after the other.
"""

import os
import tempfile
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from itertools import chain
from itertools import count as count_from
from pathlib import Path

import numpy as np

from bsm.bitstream.errors import BsmError, CorruptError, OptionError, UnsupportedError
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits
from bsm.codec.arrays import Faces, Positions
from bsm.codec.geometry.mesh import Metadata, TriangleMesh
from bsm.codec.sequence.runs import is_empty
from bsm.files import landlock
from bsm.files.formats.npz import NPY, open_npz_sequence, read_archive, read_pipe, write_npy
from bsm.files.formats.polygons import CutAlike, MeshFile, joined_files
from bsm.files.mesh import (
    is_apart,
    kind_of,
    parts_of,
    read_cut,
    read_mesh,
    save_written,
    written_mesh,
)
from bsm.files.motion import folder
from bsm.files.motion.caches import CACHES, mesh_beside, mesh_of, read_cache, write_cache
from bsm.files.motion.frames import USUAL_RATE, Frames, FrameWriter, Shared, Wanted
from bsm.files.output import open_output, refuse_to_overwrite, write_output
from bsm.files.pipes import Input, Source, as_input, files_behind, is_pipe, is_url, size_of
from bsm.files.table import (
    FORMATS,
    GLTF,
    ONE_FILE,
    RATE,
    SEQUENCE_FORMATS,
    SEQUENCES_READ,
    TIMES,
    WRITTEN_FORMATS,
    by_name,
)

_ISOLATED = ("bsm.files.isolation", "frames_isolated")  # it loads this module
ZIP = b"PK\x03\x04"


def open_sequence(
    source: Source,
    file_format: str | None = None,
    request: Wanted | None = None,
    limits: Limits = DEFAULT_LIMITS,
    *,
    isolated: bool | None = None,
) -> Frames | None:
    """The sequence that `source` names, or None if it is not one but perhaps a mesh; `isolated` as in `read_mesh`."""
    # A look at a pipe must not consume bytes: the reader of the mesh needs all of them.
    if is_pipe(source) and file_format != "npy":
        return None
    input_source, wishes = as_input(source), request or Wanted()
    if not is_url(input_source.name) and folder.names_many(input_source.name):
        names = folder.frame_files(input_source.name, follow=not is_apart((), limits, isolated))
        return open_frames(names, file_format, limits, wishes, isolated=isolated)
    kind = file_format or Path(input_source.name).suffix[1:].lower()
    if kind == "abc":
        raise UnsupportedError(
            "Alembic is not read here: export it from Blender as USD, or with the extension for BSM"
        )
    if kind in folder.LISTS and input_source.is_file:
        if is_apart((), limits, isolated) and landlock.lack() is None:
            listed: Frames = by_name(*_ISOLATED)(input_source, file_format, limits, kind, request)
            return listed
        names, times, parts = folder.listed(input_source.name, kind, limits)
        return open_frames(
            names, None, limits, replace(wishes, times=times, parts=parts), isolated=isolated
        )
    moves = (
        kind in SEQUENCES_READ
        and kind not in ("npz", "npy")
        and (kind not in GLTF or request is not None)
    )
    apart_kind, is_sequence, piped = kind, input_source.is_file, False
    if not moves:
        head = input_source.peek(len(NPY))
        piped = head == NPY or file_format == "npy"
        # A 3MF is a ZIP, too.
        packed = head.startswith(ZIP) and (file_format is not None or kind in ("", "npz"))
        is_sequence = file_format in (None, "npz", "npy") and (piped or packed)
        apart_kind = "npz"
    if not is_sequence:
        return None
    if is_apart((apart_kind,), limits, isolated):
        isolated_frames: Frames | None = by_name(*_ISOLATED)(
            input_source, file_format, limits, kind, request
        )
    elif kind in CACHES:
        isolated_frames = read_cache(input_source.name, kind, wishes, limits)
    elif moves and FORMATS[kind].apart:
        isolated_frames = by_name("bsm.files.apart", "frames_of")(
            input_source.name, kind, wishes, limits, here=isolated is False
        )
    elif moves:
        row = FORMATS[kind]
        isolated_frames = by_name(row.modules[0], row.reader.removesuffix("_mesh"))(
            input_source.name, wishes, limits
        )
    elif piped:
        isolated_frames = read_pipe(input_source, limits)
    else:
        isolated_frames = read_archive(input_source, limits)
    return isolated_frames


def open_frames(
    names: Sequence[str],
    file_format: str | None,
    limits: Limits,
    request: Wanted,
    *,
    isolated: bool | None,
) -> Frames:
    """The sequence of these mesh files by their times or numbers; errors as of `open_sequence`."""
    ordered = list(names)
    if not request.times:
        ordered = folder.in_order(names)
    kinds = [kind_of(Input(name), file_format) for name in ordered]
    if is_apart(kinds, limits, isolated):
        paths = [os.path.abspath(name) for name in ordered]
        frames: Frames = by_name(*_ISOLATED)(paths, file_format, limits, kinds[0], request)
        return frames
    groups = _groups_of_files(ordered, request.parts or [1] * len(ordered))
    by_label = {", ".join(group): group for group in groups}
    # One for each place in a group: polygons of later frames must be cut along the diagonals of the first, or faces
    # would change although nothing does but positions.
    cuts = [CutAlike() for _ in range(max(map(len, groups)))]

    def read(label: str) -> MeshFile:
        group = by_label[label]
        files = [
            read_cut(name, file_format, limits, cut, isolated=isolated)
            for name, cut in zip(group, cuts)
        ]
        return joined_files(files, group, limits)

    return folder.read_files([", ".join(group) for group in groups], read, request)


def _groups_of_files(names: Sequence[str], counts: Sequence[int]) -> list[Sequence[str]]:
    """Return the files of each frame: lists of ParaView may name several for one time, the parts of one mesh."""
    ends = np.cumsum(counts).tolist()
    return [names[begin:end] for begin, end in zip([0, *ends], ends, strict=False)]


def _files_of_frames(path: str) -> Iterable[str]:
    """Return the files that a sequence is read from, without streams and others in its folder."""
    meshes: list[str] = []
    if folder.names_many(path):
        meshes = sorted(folder.mesh_files(path))
    return meshes or files_behind(path)


def size_of_sequence(
    paths: Sequence[str], metadata: Metadata, mesh: str | None = None
) -> int | None:
    """The bytes of all files that a sequence was read from, each once: lists and theirs, caches and their mesh."""
    if any(is_url(path) or path == "-" for path in paths):
        return size_of(paths[0])
    if any(size_of(path) is None for path in paths if not folder.names_many(path)):
        return None
    file_names: list[str] = []
    for path in chain.from_iterable(map(_files_of_frames, paths)):
        kind = Path(path).suffix[1:].lower()
        file_names.append(path)
        if kind in folder.LISTS:
            listed_names, *_ = folder.listed(path, kind, DEFAULT_LIMITS)
            file_names += listed_names
        if kind in CACHES:
            file_names.append(mesh or mesh_beside(path))
    parts: list[Path] = []
    if file_names:
        parts += filter(None, parts_of(file_names[-1], metadata).values())
    files = {os.path.realpath(str(file)) for file in (*file_names, *parts)}
    return sum(os.path.getsize(file) for file in files if os.path.isfile(file)) or None


@contextmanager
def sequence_writer(
    path: str,
    kind: str,
    faces: Faces,
    count: int,
    *,
    overwrite: bool,
    follow: bool | str = True,
    shared: Shared | None = None,
) -> Iterator[FrameWriter]:
    """Open a sequence for writing; yields what takes frame after frame."""
    shared = shared or Shared()
    with ExitStack() as opened:
        enter = opened.enter_context
        if folder.is_numbered(path) or kind not in ONE_FILE or (kind == "glb" and _is_folder(path)):
            if is_url(path):
                raise OptionError(
                    f"{path}: frames are written to a folder of this machine, or as an npz"
                )
            yield _of_files(
                enter(folder.write_files(path, kind, overwrite=overwrite)), kind, faces, shared
            )
            return
        shared = replace(shared, held=FORMATS[kind].times)
        if kind in CACHES:
            yield enter(_cache_writer(path, kind, faces, count, overwrite, follow, shared))
            return
        if kind == "pvd":
            yield enter(_list_writer(path, faces, overwrite, follow, shared))
            return
        file = enter(open_output(path, overwrite=overwrite, follow=follow))
        if kind == "npz":
            yield _of_one_mesh(enter(open_npz_sequence(file, faces, count, shared)), kind)
        elif kind == "npy":
            write_npy(file, faces)
            yield _of_one_mesh(lambda frame: write_npy(file, frame), kind)
            shared.loses(
                [*(attribute.name for attribute in shared.attributes()), *shared.metadata()]
            )
        elif kind == "glb":
            yield enter(by_name("bsm.gltf.write", "write_frames")(file, path, faces, shared))
        else:
            yield enter(
                by_name("bsm.files.motion.usd.writing", "write_usd")(file, kind, faces, shared)
            )


def _of_files(
    write_mesh: Callable[[TriangleMesh, int], Iterable[str]],
    kind: str,
    present: Faces,
    shared: Shared,
) -> FrameWriter:
    """A writer of a file for each frame; materials and images lie beside the first one alone."""
    numbered, numbers, fresh = shared.numbered, count_from(0), True
    times_held: frozenset[str] = frozenset()
    if kind == "vtp" or (numbered and kind != "glb"):
        times_held = FORMATS[kind].times
    frames = replace(shared, held=times_held)

    def take(frame: Positions, faces: Faces | None = None) -> None:
        nonlocal present, fresh
        if faces is not None:
            present = faces
        number = file_number = next(numbers)
        mesh = frames.mesh(frame, present, with_metadata=fresh)
        fresh = fresh and is_empty(mesh.attributes)
        if kind == "vtp":
            mesh = frames.timed(mesh, number)
        if numbered:
            file_number = int(frames.code(number))
        frames.loses(write_mesh(mesh, file_number))

    return take


def _of_one_mesh(write: Callable[[Positions], None], kind: str) -> FrameWriter:
    """A writer of a form that has one set of faces."""
    numbers = count_from(0)

    def take(frame: Positions, faces: Faces | None = None) -> None:
        number = next(numbers)
        if faces is not None:
            raise OptionError(
                f"{kind.upper()} holds one set of faces, and they change after {number} frames; write to a folder, to "
                "numbered files (%04d.obj), GLB, PC2 or USD, or frames of the same faces, --frames A:B"
            )
        write(frame)

    return take


@contextmanager
def _list_writer(
    path: str, faces: Faces, overwrite: bool, follow: bool | str, shared: Shared
) -> Iterator[FrameWriter]:
    """A list for ParaView, and a folder beside it, called like it, with a VTP for each time."""
    from html import escape

    refuse_to_overwrite(path, overwrite)
    rows, below = list[str](), Path(path).with_suffix("")

    with folder.write_files(str(below), "vtp", overwrite=overwrite) as write:

        def write_mesh(mesh: TriangleMesh, _: int) -> tuple[str, ...]:
            number = len(rows)
            time = shared.code(number) / (shared.frame_rate or USUAL_RATE)
            name = escape(f"{below.name}/{number:05d}.vtp", quote=False)
            rows.append(f'<DataSet timestep="{time:.9g}" part="0" file="{name}"/>\n')
            return write(mesh, number)

        yield _of_files(write_mesh, "vtp", faces, shared)
        text = f'<VTKFile type="Collection" version="0.1"><Collection>\n{"".join(rows)}</Collection></VTKFile>\n'
        write_output(path, text.encode(), overwrite=overwrite, follow=follow)


@contextmanager
def _cache_writer(
    path: str,
    kind: str,
    first: Faces,
    count: int,
    overwrite: bool,
    follow: bool | str,
    shared: Shared,
) -> Iterator[FrameWriter]:
    """A cache, and beside it the mesh of its first frame; where faces change, both for each run, by its first frame."""
    refuse_to_overwrite(path, overwrite)
    refuse_to_overwrite(mesh_of(path), overwrite or _plays(mesh_of(path), first))
    meshes, begun, frames_taken = list[TriangleMesh](), 0, 0
    # A cache begins with the number of its frames, which is known at the end of a run only, so frames wait on the disk.
    with tempfile.TemporaryFile() as spool:

        def end(*, last: bool = False) -> None:
            name = path
            if begun or not last:
                name = str(Path(path).with_stem(f"{Path(path).stem}_{begun:05d}"))
            mesh, beside = meshes[-1], mesh_of(name)
            fits = _plays(beside, mesh.faces)
            refuse_to_overwrite(beside, overwrite or fits)
            spool.seek(0)
            codes = [shared.code(number) for number in range(begun, frames_taken)]
            frames = (
                np.frombuffer(spool.read(mesh.positions.nbytes)).reshape(-1, 3) for _ in codes
            )
            with open_output(name, overwrite=overwrite, follow=follow and name == path) as file:
                write_cache(file, kind, codes, frames, shared.frame_rate)
            shared.loses(name for name in (TIMES, RATE) if name in mesh.metadata)
            if not fits:
                obj = written_mesh(mesh, "obj", beside)
                shared.loses(save_written(beside, obj, overwrite=overwrite, follow=False))
            spool.seek(0)
            spool.truncate()

        def take(frame: Positions, faces: Faces | None = None) -> None:
            nonlocal begun, frames_taken
            if meshes and faces is not None:
                end()
                begun = frames_taken
            if frames_taken == begun:
                present = first if faces is None else faces
                meshes.append(shared.mesh(np.array(frame), present))
            spool.write(np.ascontiguousarray(frame, np.float64).tobytes())
            frames_taken += 1
            shared.loses(
                f"how {attribute.name} changes"
                for attribute in shared.moved(anew=faces is not None)
            )

        yield take
        if count and frames_taken != count:
            raise CorruptError(f"{frames_taken} of {count} frames came")
        end(last=True)


def _plays(path: str, faces: Faces) -> bool:
    """Whether a mesh file is there that has these faces, in any order: it is the animator's, and stays."""
    mesh_faces = faces[:0]
    try:
        if os.path.isfile(path):
            mesh_faces = read_mesh(path).mesh.faces
    except (BsmError, OSError):
        return False
    # Faces without area were added for loose vertices, and OBJ files of animators do not have them.
    pairs = (triangles[triangles[:, 0] != triangles[:, 1]] for triangles in (mesh_faces, faces))
    distinct_faces, other_faces = (
        np.unique(np.sort(triangles, axis=1), axis=0) for triangles in pairs
    )
    return np.array_equal(distinct_faces, other_faces)


def _is_folder(path: str) -> bool:
    return path.endswith("/") or Path(path).is_dir()


def sequence_kind(path: str, file_format: str | None) -> str:
    """The form in which a sequence is written: as asked for, or as the name tells."""
    if path == "-":
        kind = file_format or "npy"
        if kind not in ("npz", "npy"):
            raise OptionError("a sequence goes to standard output as npy or npz")
        return kind
    suffix = Path(path).suffix[1:].lower()
    if suffix == "abc":
        raise OptionError(
            f"{path}: Alembic is not written here; write USD, or take the sequence through Blender"
        )
    if suffix in SEQUENCE_FORMATS and not Path(path).is_dir():
        if file_format not in (None, suffix):
            raise OptionError(f"{path}: the name does not go with --format {file_format}")
        if folder.is_numbered(path) and suffix not in WRITTEN_FORMATS:
            raise OptionError(
                f"{path}: {suffix.upper()} holds all frames in one file; leave out the number"
            )
        if folder.is_numbered(path) or suffix in ONE_FILE:
            return suffix
        raise OptionError(
            f"{path}: this is a sequence; write it to one file (.{', .'.join(ONE_FILE)}), to a folder, to numbered "
            f"files, {Path(path).with_suffix('')}-%04d.{suffix}, or write one frame, --frames 0:1 for the first"
        )
    if file_format is None and suffix[:1].isalpha() and not _is_folder(path):
        raise OptionError(
            f"{path}: sequences are not written as {suffix}; as {', '.join(SEQUENCE_FORMATS)} they are, and a folder "
            "of this name ends in /"
        )
    return file_format or "ply"
