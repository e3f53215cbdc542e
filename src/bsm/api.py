"""The functions of `import bsm`; they accept any mesh-like object."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import wraps
from inspect import Parameter, signature
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO, TypeAlias, TypeVar, Unpack, cast

from bsm.bitstream.errors import ArgumentError, MeshError, OptionError
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits, as_limits
from bsm.codec.arrays import Faces, Positions
from bsm.codec.choices import checked_metadata, checked_whole, suggestion
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import Metadata, NoFacesError, TriangleMesh
from bsm.files.formats.metadata import Written
from bsm.files.inspection import inspect_stream, summarize_stream
from bsm.files.libraries import as_mesh, read_any, warn
from bsm.files.mesh import save_written, unknown_suffix, written_mesh
from bsm.files.partial import blocks_in_words, decode_blocks, decode_what_is_left
from bsm.files.pipes import Input, Source, as_input, named, read_chunks
from bsm.files.stream import SequenceStream, decode_whole, peek_header, refuse_mesh_file
from bsm.files.table import format_of_name
from bsm.ground.console import Console, watched
from bsm.ground.synonyms import advice_on_keyword

if TYPE_CHECKING:
    import numpy.typing as npt

    from bsm.account.comparison import MeshComparison
    from bsm.codec.denoise import DenoiseOptions
    from bsm.codec.look.measure import Look
    from bsm.codec.sequence.options import SequenceOptions
    from bsm.codec.static.options import EncodeOptions
    from bsm.encoding.given import MovingRecipe, Wishes
    from bsm.keywords import DenoiseKeywords, EncodeKeywords, OptionKeywords, SequenceKeywords

Heard: TypeAlias = Callable[[int, int], None] | None
_Function = TypeVar("_Function", bound=Callable[..., Any])


def _with_known_keywords(function: _Function) -> _Function:
    """Let a function refuse keywords that it does not have by an `ArgumentError` with advice."""
    parameters = signature(function).parameters
    keywords = [
        name for name, parameter in parameters.items() if parameter.default is not Parameter.empty
    ]

    @wraps(function)
    def call(*values: Any, **named_values: Any) -> Any:
        for name in named_values:
            if name not in parameters:
                raise ArgumentError(
                    f"{function.__name__} has no keyword {name}{_advice_on(name, keywords)}"
                )
        return function(*values, **named_values)

    return cast("_Function", call)


def _advice_on(name: str, keywords: Sequence[str]) -> str:
    """Say which keyword is meant by an unknown one: by its meaning, or else by its letters."""
    by_meaning = advice_on_keyword(name, keywords)
    if by_meaning:
        return f"; instead: {by_meaning}"
    return suggestion(name, keywords) or f"; its keywords are {', '.join(keywords)}"


def encode(
    mesh: Any,
    options: EncodeOptions | None = None,
    /,
    *,
    metadata: Metadata | None = None,
    simplify: bool = False,
    provenance: bool | None = None,
    progress: Heard = None,
    **keywords: Unpack[OptionKeywords],
) -> bytes:
    """Compress a mesh.

    Parameters
    ----------
    mesh : mesh, pair of arrays, or path
        A `TriangleMesh`; a mesh of trimesh, pyvista, Open3D or meshio; ``(positions, faces)``; or a file or its name.
    options : EncodeOptions, optional
        Instead of keywords.
    metadata : mapping from str to str, int, float or bytes, optional
        Added to the metadata of the mesh.
    simplify : bool
        Also try fewer triangles, and vertices that slide along the surface: the smallest stream counts that keeps the
        promised look, and `max_error` as the distance between the surfaces. Attributes other than normals and colors of
        vertices are errors.
    provenance : bool, optional
        Whether to store how the stream was made; None: only for a mesh that was decoded from a stream.
    progress : callable, optional
        Called in this thread with the finished work and the total; the first number never falls. If it raises an
        exception, the work ends, the exception reaches the caller, and unfinished files are removed.
    **keywords
        As on the command line: `preset` (a name of `PRESETS`), bounds (`look`, `max_error`), one target (`theta`,
        `nmsve_db`, `bpv`, `size`), and fields of `EncodeOptions` (`step`, `block_size`, `keep_order`, `threads`, ...).

    Returns
    -------
    bytes
        A stream. Unless `keep_order` is true, vertices and faces have the order of `Encoder.vertex_order`.

    Warns
    -----
    BsmWarning
        If the stream cannot hold something in the file or mesh; see `Encoder.notes`.

    Raises
    ------
    BsmError
        `ArgumentError` if `mesh` is not a mesh or a keyword does not exist; `MeshError`, `OptionError`, ...

    Examples
    --------
    >>> import bsm
    >>> data = bsm.encode("bunny.ply", preset="fine")
    >>> mesh = bsm.load("bunny.ply")
    >>> close = bsm.encode(mesh, max_error=0.001)  # of the diagonal
    >>> small = bsm.encode((mesh.positions, mesh.faces), size="3kB", preset="none")
    >>> len(small) <= 3000
    True
    """
    # Here and below, functions import what they need: a program that only decodes does not load the encoder.
    from bsm.encoding.given import given_mesh

    # Before the mesh is read: a wrong keyword is said at once, and not after minutes of reading.
    wishes = _wishes(mesh, options, keywords, metadata, provenance, simplify=simplify)
    with watched("encoding", progress) as reported:
        recipe = given_mesh(as_mesh(mesh), wishes)
        encoding = recipe.encode(reported)
    warn([*recipe.losses, *encoding.encoder.losses])
    return b"".join(encoding.attempt.frames)


def _wishes(
    source: Any,
    options: EncodeOptions | SequenceOptions | None,
    keywords: Mapping[str, Any],
    metadata: Metadata | None,
    provenance: bool | None,
    **more: Any,
) -> Wishes:
    """Return the wishes of a caller, after a check of what does not depend on the mesh."""
    from bsm.encoding.given import Wishes

    name = str(source) if isinstance(source, (str, os.PathLike)) else ""
    shared: dict[str, Any] = {
        "keywords": keywords,
        "options": options,
        "provenance": provenance,
        **more,
    }
    wishes = Wishes(source=name, metadata=checked_metadata(metadata), **shared)
    wishes.check()
    return wishes


def encode_many(
    sources: Iterable[str | os.PathLike[str]],
    target: str | os.PathLike[str] | None = None,
    /,
    *,
    jobs: int = 1,
    dask: str | None = None,
    report: str | os.PathLike[str] | None = None,
    resume: bool = False,
    overwrite: bool = False,
    metadata: Mapping[str, str] | None = None,
    simplify: bool = False,
    provenance: bool | None = None,
    progress: Heard = None,
    **keywords: Unpack[OptionKeywords],
) -> list[dict[str, Any]]:
    """Compress mesh files, as ``bsm encode`` does. A file that fails does not stop the others.

    Parameters
    ----------
    sources : iterable of paths
        Paths, or URLs if fsspec is installed.
    target : path, optional
        A folder, or a URL that ends in a slash; None: next to each source.
    jobs : int
        Number of processes; 0: one per core. Each imports the main module of your program again, so guard its work by
        ``if __name__ == "__main__"``.
    dask : str, optional
        Address of the scheduler of a Dask cluster, instead of processes. A cluster without workers for a minute is an
        `OSError`.
    report : path, optional
        A JSON file for the result of each file, updated during the work.
    resume : bool
        Continue from the report: skip files whose output is complete and up to date.
    overwrite : bool
        Whether to replace existing files.
    metadata, simplify, provenance, progress, **keywords
        As in `encode`; `progress` hears of all files together. If it raises an exception, finished files are kept.

    Returns
    -------
    list of dict
        The result of each file in order, as ``bsm encode --json`` prints it; for a failed file, "error" and "exit", its
        exit code.

    Raises
    ------
    BsmError, OSError
        If the work cannot start: wrong options, outputs that would replace each other, no cluster, ...

    Examples
    --------
    >>> import bsm
    >>> rows = bsm.encode_many(["a.ply", "b.obj"], "streams/", preset="fine")
    >>> [("error" in row, row["output"]) for row in rows]
    [(False, 'streams/a.bsm'), (False, 'streams/b.bsm')]
    """
    from bsm.encoding.given import Wishes
    from bsm.jobs.encode import EncodeJob, encode_one
    from bsm.jobs.plan import plan
    from bsm.jobs.run import Batch, run_many

    # A path is iterable, too: each of its letters would be taken for a file.
    if isinstance(sources, (str, bytes)) or not isinstance(sources, Iterable):
        raise ArgumentError(f"sources must be a list of paths, not {sources!r}")
    checked_whole("jobs", jobs, 0)
    entries = checked_metadata(metadata)
    Wishes(keywords=keywords, metadata=entries).check()
    report_name = folder = None
    if report is not None:
        report_name = named(report)
    run = Batch(jobs=jobs, dask=dask, report=report_name, resume=resume)
    # With a slash, so that the plan takes it for a folder even if it is not there yet.
    if target is not None:
        folder = named(target).rstrip("/") + "/"
    planned = plan([named(source) for source in sources], folder, lambda _: ".bsm")
    options: dict[str, Any] = {**keywords}
    threads = None
    # Processes side by side with all threads each would fight for the cores.
    if run.side_by_side and len(planned) > 1:
        threads = 1
    threads = options.pop("threads", threads)
    more: dict[str, Any] = {
        "metadata": entries,
        "options": options,
        "simplify": simplify,
        "provenance": provenance,
    }
    job = EncodeJob(force=overwrite, quiet=True, threads=threads, **more)
    return run_many(run, job, Console(quiet=True, heard=progress), encode_one, planned)


@_with_known_keywords
def decode(
    stream: Source,
    *,
    blocks: int | None = None,
    tolerant: bool = False,
    limits: Limits | str = DEFAULT_LIMITS,
    threads: int | None = None,
    progress: Heard = None,
) -> TriangleMesh:
    """Restore a mesh.

    Parameters
    ----------
    stream : bytes, any buffer, path or binary file
        The function reads a file to its end; it need not be seekable.
    blocks : int, optional
        Stop after this many blocks, and return the faces whose vertices have arrived.
    tolerant : bool
        Go on after damage, and return the faces that are left.
    limits : Limits, or "default", "service" or "wide"
        Limits on the memory and work of the stream.
    threads : int, optional
        None: one per core.
    progress : callable, optional
        As in `encode`.

    Returns
    -------
    TriangleMesh
        The mesh with its attributes and metadata.

    Warns
    -----
    BsmWarning
        For each loss, if `tolerant`; if the stream has fewer than `blocks`.

    Raises
    ------
    BsmError
        `FormatError`, `UnsupportedError`, `CorruptError`, `TruncatedError`, `LimitError` or `NumericError`, with the
        offset in the stream; `ArgumentError` if `stream` is of a wrong type.

    Examples
    --------
    >>> import bsm
    >>> mesh = bsm.decode("bunny.bsm")
    >>> mesh.positions.dtype, mesh.faces.shape[1]
    (dtype('float64'), 3)
    """
    if blocks is not None and tolerant:
        raise OptionError("a stream is decoded tolerantly to its end; leave out blocks or tolerant")
    source = as_input(stream)
    refuse_mesh_file(source)
    limits, chunks = as_limits(limits), source.chunks()
    with watched("decoding", progress) as reported:
        if blocks is not None:
            header, chunks = peek_header(chunks)
            mesh = decode_blocks(chunks, checked_whole("blocks", blocks, 1), reported, limits)
            if header is not None and (fewer := blocks_in_words(blocks, header)):
                warn([f"blocks={blocks}: {fewer}"])
            return mesh
        if tolerant:
            losses: list[str] = []
            mesh = decode_what_is_left(chunks, losses.append, limits)
            warn(losses)
            return mesh
        listener = reported if progress else None
        return decode_whole(chunks, limits, threads, progress=listener)


@_with_known_keywords
def info(stream: Source, *, limits: Limits | str = DEFAULT_LIMITS) -> dict[str, Any]:
    """List the contents of a stream without decoding it.

    Parameters
    ----------
    stream, limits
        As in `decode`.

    Returns
    -------
    dict
        The facts that ``bsm info --json`` prints: version, counts, bytes by their use, attributes, metadata, ...

    Raises
    ------
    BsmError
        As in `decode`.

    Examples
    --------
    >>> import bsm
    >>> facts = bsm.info("bunny.bsm")
    >>> facts["vertices"] > 0, facts["bytes"]["total"] > 0
    (True, True)
    """
    return summarize_stream(inspect_stream(read_chunks(stream), as_limits(limits)))


def encode_sequence(
    positions: npt.ArrayLike,
    faces: npt.ArrayLike,
    options: SequenceOptions | None = None,
    /,
    *,
    metadata: Metadata | None = None,
    mesh_attributes: Sequence[Attribute] = (),
    provenance: bool | None = None,
    progress: Heard = None,
    **keywords: Unpack[SequenceKeywords],
) -> bytes:
    """Compress an animated mesh.

    Parameters
    ----------
    positions : array_like, shape (T, n, 3)
        Positions of every frame, in the unit of the mesh.
    faces : array_like of int, shape (m, 3)
        The faces of all frames.
    options : SequenceOptions, optional
        Instead of keywords.
    metadata, provenance, progress
        As in `encode`, for the whole sequence.
    mesh_attributes : sequence of Attribute
        Attributes that do not change; `SequenceDecoder.attributes` returns them. The option `attributes` sets their
        quality, as for a mesh.
    **keywords
        As on the command line: `preset` (one of `PRESETS` that promises a look: here of every frame), `low_delay`,
        bounds (`look`, `max_error`), one target (`kg`, `bpvf`, `theta`, `nmsve_db`), and fields of `SequenceOptions`
        (`step`, `gop`, `frame_rate`, ...).

    Returns
    -------
    bytes
        A stream. Vertices have the coder's order unless `keep_order` is true.

    Raises
    ------
    BsmError
        `ArgumentError` if a keyword does not exist, `MeshError` if the arrays are not a sequence of meshes,
        `TargetError` if no step keeps the promise.

    Examples
    --------
    >>> import bsm, numpy as np
    >>> mesh = bsm.load("bunny.ply")
    >>> frames = np.stack([mesh.positions * (1 + 0.01 * k) for k in range(8)])
    >>> data = bsm.encode_sequence(frames, mesh.faces, frame_rate=24.0)
    >>> bsm.decode_sequence(data)[0].shape == frames.shape
    True
    """
    from bsm.codec.sequence.encoder import frames_of
    from bsm.encoding.given import given_frames
    from bsm.files.motion.frames import Frames

    wishes, frames = _wishes(None, options, keywords, metadata, provenance), frames_of(positions)
    first = TriangleMesh(frames[0], faces)  # type: ignore[arg-type]
    moving: dict[str, Any] = {"attributes": mesh_attributes, "meshes": iter(frames)}
    source = Frames(first.faces, len(frames), iter(()), **moving)
    return _joined(given_frames(source, wishes, first), progress)


def _joined(recipe: MovingRecipe, progress: Heard) -> bytes:
    with watched("encoding", progress) as reported:
        data = b"".join(recipe.chunks(reported))
    warn([*recipe.losses, *recipe.encoder.losses])
    return data


def encode_frames(
    meshes: Iterable[Any],
    options: SequenceOptions | None = None,
    /,
    *,
    metadata: Metadata | None = None,
    provenance: bool | None = None,
    progress: Heard = None,
    **keywords: Unpack[SequenceKeywords],
) -> bytes:
    """Compress an animation whose faces may change from frame to frame, as in volumetric capture.

    Parameters
    ----------
    meshes : iterable of meshes, pairs of arrays, or paths
        The frames, each a mesh as in `encode`. Colors and other numbers of vertices may change from frame to frame.
        Other attributes are taken from the first frame of each run of frames with equal faces, and metadata from the
        first frame.
    options, metadata, provenance, progress, **keywords
        As in `encode_sequence`. Faces may change unless `runs` is false; targets need frames that share their faces.

    Returns
    -------
    bytes
        A stream, for `decode_frames`.

    Raises
    ------
    MeshError
        If `meshes` is empty, or if the faces change and `runs` is false.

    Examples
    --------
    >>> import bsm
    >>> mesh = bsm.load("bunny.ply")
    >>> moved = bsm.TriangleMesh(mesh.positions + 0.1, mesh.faces)
    >>> half = bsm.TriangleMesh(mesh.positions, mesh.faces[::2])
    >>> data = bsm.encode_frames([mesh, moved, half])
    >>> [len(frame.faces) == len(mesh.faces) for frame in bsm.decode_frames(data)]
    [True, True, False]
    """
    from bsm.codec.sequence.runs import is_empty
    from bsm.encoding.given import given_frames
    from bsm.files.motion.frames import Frames

    if isinstance(meshes, (str, bytes)) or not isinstance(meshes, Iterable):
        raise ArgumentError(f"a mesh for each frame is expected, not {type(meshes).__name__}")
    choices: dict[str, Any] = {**keywords}
    if options is None:
        choices = {"runs": True, **keywords}
    wishes = _wishes(None, options, choices, metadata, provenance)
    as_frame: Callable[[Any], TriangleMesh] = as_mesh
    if getattr(options, "runs", choices.get("runs")):
        as_frame = _as_frame
    frames = map(as_frame, meshes)
    first = next(frames, None)
    if first is None:
        raise MeshError("a sequence needs at least one frame")
    attributes = [a for a in first.attributes if a.semantic != "normal" and not is_empty([a])]
    count = 0
    if isinstance(meshes, Sequence):
        count = len(meshes)
    shared: dict[str, Any] = {"attributes": tuple(attributes), "metadata": first.metadata}
    source = Frames(first.faces, count, iter(()), **shared, meshes=chain([first], frames))
    return _joined(given_frames(source, wishes, first), progress)


def _as_frame(frame: Any) -> TriangleMesh:
    from bsm.codec.sequence.runs import empty_frame

    try:
        return as_mesh(frame)
    except NoFacesError:
        return empty_frame()


@_with_known_keywords
def decode_frames(
    stream: Source, *, limits: Limits | str = DEFAULT_LIMITS, threads: int | None = None
) -> Iterator[TriangleMesh]:
    """Restore an animation frame by frame, whether its faces change or not.

    Parameters
    ----------
    stream, limits, threads
        As in `decode`. The iterator reads the stream as you take frames.

    Returns
    -------
    iterator of TriangleMesh
        The frames, each with its own faces and attributes.

    Raises
    ------
    BsmError
        As in `decode_sequence`, when the iterator reaches the error.

    Examples
    --------
    >>> import bsm
    >>> for frame in bsm.decode_frames("dance.bsm"):
    ...     bounds = frame.positions.min(axis=0), frame.positions.max(axis=0)
    """
    decoded = SequenceStream(read_chunks(stream), limits=as_limits(limits), threads=threads)
    for _, positions in decoded.changing_frames():
        yield TriangleMesh(positions, decoded.faces, decoded.attributes, decoded.metadata)


@_with_known_keywords
def decode_sequence(
    stream: Source,
    *,
    limits: Limits | str = DEFAULT_LIMITS,
    threads: int | None = None,
    progress: Heard = None,
) -> tuple[Positions, Faces]:
    """Restore an animated mesh.

    Parameters
    ----------
    stream, limits, threads, progress
        As in `decode`. The function reads the whole stream; a `SequenceDecoder` returns frames while bytes arrive.

    Returns
    -------
    positions : float64 array, shape (T, n, 3)
    faces : int32 array, shape (m, 3)

    Raises
    ------
    BsmError
        As in `decode`. Also `FormatError` for the stream of a single mesh, and `MeshError` if the faces change, which
        `decode_frames` accepts.

    Examples
    --------
    >>> import bsm
    >>> positions, faces = bsm.decode_sequence("dance.bsm")
    >>> positions.ndim, faces.shape[1]
    (3, 3)
    """
    import numpy as np

    with watched("decoding", progress) as reported:
        decoded, frames = (
            SequenceStream(read_chunks(stream), limits=as_limits(limits), threads=threads),
            list[Positions](),
        )
        for _, positions in decoded.frames():
            frames.append(positions)
            reported(len(frames), decoded.header.frames)
    return np.array(frames or np.empty((0, 0, 3))), decoded.faces


@_with_known_keywords
def load(
    source: Source, *, limits: Limits | str = DEFAULT_LIMITS, format: str | None = None
) -> TriangleMesh:
    """Read a mesh from a mesh file or a stream.

    `read_mesh` also returns notes on changes and losses.

    Parameters
    ----------
    source : path, or anything else that `decode` takes
        OBJ, OFF, PLY, STL, VTP, npz and BSM; with trimesh installed (``pip install 'bsm-codec[formats]'``) also GLB,
        glTF, 3MF, DAE and others.
    limits : Limits, or "default", "service" or "wide"
        Largest memory and work that the file may take.
    format : str, optional
        The format as a suffix without the dot; None: by the name or the contents.

    Returns
    -------
    TriangleMesh

    Raises
    ------
    BsmError, OSError
        If the file is not a mesh: `FormatError`, `MeshError`, ...; `DependencyError` if a library is missing.

    Examples
    --------
    >>> import bsm
    >>> mesh = bsm.load("spot.obj")
    >>> [attribute.name for attribute in mesh.attributes][:1]
    ['texcoord']
    """
    return read_any(Input(source), file_format=format, limits=as_limits(limits))


def save(
    mesh: Any,
    path: str | os.PathLike[str] | BinaryIO,
    *,
    overwrite: bool = True,
    format: str | None = None,
    **keywords: Unpack[EncodeKeywords],
) -> tuple[str, ...]:
    """Write a mesh to a file in the format of its name. If it fails, no partial file remains.

    Images and, for OBJ, the material library are written next to it; their names begin with the file's name.

    Parameters
    ----------
    mesh : mesh, pair of arrays, or path
        As `encode` takes it.
    path : path or binary file
        A path that ends in .bsm, .3mf (with lib3mf), .dae (with pycollada), .glb, .npz, .obj, .off, .ply, .stl or .vtp;
        or an open file, such as `io.BytesIO`, next to which nothing is written.
    overwrite : bool
        Whether to replace an existing file.
    format : str, optional
        The format as a suffix without the dot; an open file needs it.
    **keywords
        As in `encode`, for .bsm only.

    Returns
    -------
    tuple of str
        The names of attributes and metadata that the format cannot store, and of files that would stand next to it.

    Raises
    ------
    OptionError, FileExistsError
        If the suffix is unknown, if the format has no options, or if the file exists and `overwrite` is false.

    Examples
    --------
    >>> import bsm, io
    >>> mesh = bsm.load("spot.obj")
    >>> bsm.save(mesh, "again.bsm", preset="fine")
    ()
    >>> "texcoord" in bsm.save(mesh, "again.stl")  # what STL cannot hold
    True
    >>> file = io.BytesIO()
    >>> lost = bsm.save(mesh, file, format="glb")
    >>> file.getvalue()[:4]
    b'glTF'
    """
    if isinstance(path, str | os.PathLike):
        name = named(path)
        if format is not None:
            name = f"{name}.{format}"
        written = _as_file(mesh, name, keywords)
        try:
            return save_written(path, written, overwrite=overwrite)
        except FileExistsError as error:
            # The message of the command line names its option -f, which Python does not have.
            error.strerror = "the file exists already; overwrite=True replaces it"
            raise
    if not hasattr(path, "write"):
        raise ArgumentError(
            f"a path is expected, or an open binary file and its format, not {type(path).__name__}"
        )
    if format is None:
        raise ArgumentError(
            'an open file has no suffix that tells the format; add one, such as format="ply"'
        )
    written = _as_file(mesh, f"mesh.{format}", keywords)
    path.write(written.data)
    return (*written.left_out, *written.beside)


def _as_file(mesh: Any, name: str, keywords: EncodeKeywords) -> Written:
    """Return a mesh as a file of the format that its name tells."""
    if Path(name).suffix.lower() == ".bsm":
        return Written(encode(mesh, **keywords))
    kind = format_of_name(name)
    if kind is None:
        raise unknown_suffix(name, "bsm")
    if keywords:
        raise OptionError(f"{name}: {next(iter(keywords))} is an option of .bsm files only")
    return written_mesh(as_mesh(mesh), kind, name)


def denoise(
    mesh: Any,
    options: DenoiseOptions | None = None,
    /,
    *,
    goal: str = "shading",
    strength: float = 1.0,
    force: bool = False,
    progress: Heard = None,
    **keywords: Unpack[DenoiseKeywords],
) -> TriangleMesh:
    """Remove noise from the positions of a mesh. The faces do not change.

    Parameters
    ----------
    mesh, progress
        As in `encode`.
    options : DenoiseOptions, optional
        Instead of keywords.
    **keywords
        Fields of `DenoiseOptions`. Without any, or with method="auto", the noise of the mesh decides the method.
    goal : str
        Aim of this choice: "shading" (normals close to the true ones) or "shape" (vertices).
    strength : float
        Fraction of every movement, from 0 to 1.
    force : bool
        Return the result even if it loses detail.

    Returns
    -------
    TriangleMesh
        Same faces, metadata and attributes, except normals, which are dropped. The given mesh itself if there is no
        noise to remove.

    Warns
    -----
    BsmWarning
        If normals are dropped.

    Raises
    ------
    HarmError
        If the options would make the mesh worse.

    Examples
    --------
    >>> import bsm
    >>> clean = bsm.denoise("scan.ply")
    >>> careful = bsm.denoise("scan.ply", goal="shape", strength=0.5)
    """
    from bsm.codec.denoise import DenoiseOptions
    from bsm.codec.denoise import denoise as denoise_mesh
    from bsm.encoding.options import chosen_options, denoise_options

    chosen = chosen_options(options, DenoiseOptions, keywords, denoise_options)
    with watched("denoising", progress) as heard:
        original = as_mesh(mesh)
        clean = denoise_mesh(
            original, chosen, goal=goal, strength=strength, force=force, progress=heard.stage
        )
    if stale := [
        attribute.name for attribute in original.attributes if attribute not in clean.attributes
    ]:
        warn([f"left out, for they fit no longer: {', '.join(stale)}"])
    return clean


@_with_known_keywords
def compare(original: Any, decoded: Any, *, order: npt.ArrayLike | None = None) -> MeshComparison:
    """Measure the errors of a mesh against an original with the same faces.

    Parameters
    ----------
    original, decoded : mesh, pair of arrays, path, or stream
        A mesh as in `encode`, or a stream as in `decode`; without vertices that no face uses. If the meshes only match
        after merging, vertices at one position are merged.
    order : int array, shape (n,), optional
        Vertex j of `decoded` is vertex order[j] of `original`, as in `Encoder.vertex_order`. None: the same order, or
        the decoder's.

    Returns
    -------
    MeshComparison
        Errors of positions; `attributes` has the errors of each attribute of `original` by name.

    Raises
    ------
    MeshError
        If the meshes have different faces.

    Examples
    --------
    >>> import bsm
    >>> errors = bsm.compare("bunny.ply", "bunny.bsm")
    >>> errors.max_error_relative <= 0.01, errors.theta_deg < 10
    (True, True)
    """
    from bsm.account.comparison import compare_meshes, order_of_used, pair

    pair_as_given = list(map(as_mesh, (original, decoded)))
    first, second = (mesh.without_isolated_vertices()[0] for mesh in pair_as_given)
    used_order = None
    if order is not None:
        used_order = order_of_used(order, *pair_as_given)
    return compare_meshes(first, second, pair(first, second, used_order))


@_with_known_keywords
def look(original: Any, other: Any, *, threads: int | None = None) -> Look:
    """Measure the look distance of two meshes; at 1 they look the same in smooth shading. Their faces may differ.

    Parameters
    ----------
    original, other : mesh, pair of arrays, path, or stream
        As `encode` takes a mesh, or `decode` a stream.
    threads : int, optional
        None: one per core. The result does not depend on it.

    Returns
    -------
    Look
        `distance`, the look distance, and its parts: `unlike` (mean difference of shades) and `gone` (the largest).

    Raises
    ------
    MeshError
        If the original is invisible because it has no area.

    Examples
    --------
    >>> import bsm
    >>> seen = bsm.look("bunny.ply", "bunny.bsm")
    >>> seen.distance <= 1  # as the default promises
    True
    """
    from bsm.codec.look.measure import look as look_at

    first, second = map(as_mesh, (original, other))
    return look_at(first, second, threads=threads)
