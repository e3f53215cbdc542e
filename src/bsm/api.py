"""The functions of `import bsm`: one call each, on whatever is at hand."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from bsm import options as keywords_to
from bsm.bitstream.errors import ArgumentError, MeshError, OptionError
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits
from bsm.codec.arrays import Faces, Positions
from bsm.codec.choices import check_mapping
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import Metadata, TriangleMesh
from bsm.console import Console, watched
from bsm.files.formats.metadata import Written
from bsm.files.mesh import WRITTEN_FORMATS, format_of_name, save_written, written_mesh
from bsm.files.pipes import Input, Source, named, read_bytes, read_chunks
from bsm.files.stream import decode_whole
from bsm.lengths import in_own_unit
from bsm.libraries import as_mesh, read_any, with_metadata

if TYPE_CHECKING:
    import numpy.typing as npt

    from bsm.codec.denoise import DenoiseOptions
    from bsm.codec.look.measure import Look
    from bsm.codec.sequence.options import SequenceOptions
    from bsm.codec.static.options import EncodeOptions
    from bsm.comparison import MeshComparison

_Options = TypeVar("_Options")


def encode(
    mesh: Any, options: EncodeOptions | None = None, /, *, metadata: Metadata | None = None, **keywords: Any
) -> bytes:
    """Compress a mesh.

    Parameters
    ----------
    mesh : mesh, pair of arrays, or path
        A `TriangleMesh`; a mesh of trimesh, pyvista, Open3D or meshio; ``(positions, faces)``; or a file's name.
    options : EncodeOptions, optional
        Instead of keywords.
    metadata : mapping from str to str, int, float or bytes, optional
        Added to what the mesh says of itself.
    **keywords
        As on the command line: `preset` ("small", "balanced", "fine", "near-lossless", "grid14", "lossless", "none"),
        one target (`theta`, `nmsve_db`, `max_error`, `bpv`, `size`), and fields of `EncodeOptions` (`step`,
        `block_size`, `keep_order`, `threads`, ...).

    Returns
    -------
    bytes
        A stream. Vertices and faces are in the coder's order in it unless `keep_order` is true; `Encoder.vertex_order`
        tells that order.

    Raises
    ------
    BsmError
        `ArgumentError` if this is no mesh or there is no such keyword; `MeshError`, `OptionError`, ...

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
    from bsm.codec.static.encoder import Encoder
    from bsm.codec.static.options import EncodeOptions

    chosen = _chosen(options, EncodeOptions, keywords, keywords_to.encode_options)
    check_mapping("metadata", {} if metadata is None else metadata)
    told = with_metadata(as_mesh(mesh), chosen, metadata or {})
    if lengths := in_own_unit(keywords, told.metadata):
        chosen = keywords_to.encode_options(**{**keywords, **lengths})
    with watched("encoding") as progress:
        return b"".join(Encoder(told, chosen).chunks(progress))


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
    **keywords: Any,
) -> list[dict[str, Any]]:
    """Compress mesh files, as ``bsm encode`` does; one that fails stops no other.

    Parameters
    ----------
    sources : iterable of paths
        Or URLs, where fsspec is installed.
    target : path, optional
        A folder, or a URL that ends in a slash; None: beside each source.
    jobs : int
        Files to work on at a time, each in a process, which imports the main module of the program again: let that work
        under ``if __name__ == "__main__"``; 0: one per core.
    dask : str, optional
        The scheduler of a Dask cluster, to work there instead.
    report : path, optional
        A JSON file to write what came of each file to, while the work goes on.
    resume : bool
        Go on from the report: leave what is whole and as it would be made.
    overwrite : bool
        Whether files that are there already are replaced.
    metadata : mapping from str to str, optional
        Added to what each mesh says of itself.
    **keywords
        As `encode` takes them.

    Returns
    -------
    list of dict
        What came of each file, in their order, as ``bsm encode --json`` says it; where it failed, "error" and "exit",
        the exit code that it would have had.

    Raises
    ------
    BsmError, OSError
        If nothing can be begun: wrong options, outputs that would replace each other, no cluster, ...

    Examples
    --------
    >>> import bsm
    >>> rows = bsm.encode_many(["a.ply", "b.obj"], "streams/", preset="fine")
    >>> [("error" in row, row["output"]) for row in rows]
    [(False, 'streams/a.bsm'), (False, 'streams/b.bsm')]
    """
    from bsm.jobs.encode import EncodeJob, encode_one
    from bsm.jobs.plan import plan
    from bsm.jobs.run import Run, run_many

    keywords_to.encode_options(**keywords)
    if isinstance(sources, (str, bytes)) or not isinstance(sources, Iterable):
        raise ArgumentError(f"a list of the paths of files is expected, not {sources!r}")
    if isinstance(jobs, bool) or not isinstance(jobs, int):
        raise ArgumentError(f"jobs must be a whole number, not {jobs!r}")
    check_mapping("metadata", {} if metadata is None else metadata)
    names = [_name(source) for source in sources]
    run = Run(jobs=jobs, dask=dask, report=None if report is None else _name(report), resume=resume)
    folder = None if target is None else _name(target).rstrip("/") + "/"
    planned = plan(names, folder, lambda _: ".bsm")
    threads = keywords.pop("threads", 1 if run.side_by_side and len(planned) > 1 else None)
    told = metadata or {}
    job = EncodeJob(force=overwrite, quiet=True, metadata=told, options=keywords, threads=threads, compared=False)
    return run_many(run, job, Console(quiet=True), encode_one, planned)


def decode(stream: Source, *, limits: Limits = DEFAULT_LIMITS, threads: int | None = None) -> TriangleMesh:
    """Restore a mesh.

    Parameters
    ----------
    stream : bytes, any buffer, path or binary file
        A file need not be seekable; it is read to its end.
    limits : Limits
        What the stream may ask for.
    threads : int, optional
        None: one per core.

    Returns
    -------
    TriangleMesh
        With the attributes and the metadata that were encoded.

    Raises
    ------
    BsmError
        `FormatError`, `UnsupportedError`, `CorruptError`, `TruncatedError`, `LimitError` or `NumericError`, with the
        place in the stream; `ArgumentError` if this is none.

    Examples
    --------
    >>> import bsm
    >>> mesh = bsm.decode("bunny.bsm")
    >>> mesh.positions.dtype, mesh.faces.shape[1]
    (dtype('float64'), 3)
    """
    return decode_whole(read_chunks(stream), limits, threads)


def encode_sequence(
    positions: npt.ArrayLike,
    faces: npt.ArrayLike,
    options: SequenceOptions | None = None,
    /,
    *,
    metadata: Metadata | None = None,
    mesh_attributes: Sequence[Attribute] = (),
    **keywords: Any,
) -> bytes:
    """Compress an animated mesh.

    Parameters
    ----------
    positions : array_like, shape (T, n, 3)
        Of every frame, in the mesh's unit.
    faces : array_like of int, shape (m, 3)
        The same in all of them.
    options : SequenceOptions, optional
        Instead of keywords.
    metadata : mapping from str to str, int, float or bytes, optional
        What belongs to the whole sequence.
    mesh_attributes : sequence of Attribute
        What is the same in all frames; `SequenceDecoder.attributes` gives it back. How well each is kept, the option
        `attributes` says, as of a mesh.
    **keywords
        As on the command line: `preset` ("small", "balanced", "fine", "near-lossless": promises for every frame),
        `low_delay`, bounds (`look`, `max_error`), one target (`kg`, `bpvf`, `theta`, `nmsve_db`), and fields of
        `SequenceOptions` (`step`, `gop`, `frame_rate`, ...).

    Returns
    -------
    bytes
        A stream; vertices are in the coder's order in it unless `keep_order` is true.

    Raises
    ------
    BsmError
        `ArgumentError` if there is no such keyword, `MeshError` if this is no sequence of meshes, `TargetError` if no
        step keeps what is promised.

    Examples
    --------
    >>> import bsm, numpy as np
    >>> mesh = bsm.load("bunny.ply")
    >>> frames = np.stack([mesh.positions * (1 + 0.01 * k) for k in range(8)])
    >>> data = bsm.encode_sequence(frames, mesh.faces, frame_rate=24.0)
    >>> bsm.decode_sequence(data)[0].shape == frames.shape
    True
    """
    from bsm.codec.sequence.encoder import encode_sequence as encode_frames
    from bsm.codec.sequence.options import SequenceOptions

    told = {} if metadata is None else metadata
    check_mapping("metadata", told)
    chosen = _chosen(options, SequenceOptions, keywords, keywords_to.sequence_options)
    with watched("encoding") as progress:
        return encode_frames(positions, faces, chosen, told, mesh_attributes, progress)


def encode_frames(
    meshes: Iterable[Any],
    options: SequenceOptions | None = None,
    /,
    *,
    metadata: Metadata | None = None,
    **keywords: Any,
) -> bytes:
    """Compress an animation whose faces may change from frame to frame, as in volumetric capture.

    Parameters
    ----------
    meshes : iterable of meshes, pairs of arrays, or paths
        A frame each, as `encode` takes a mesh. Colours and numbers of vertices may change from frame to frame; other
        attributes are those of the first frame with other faces than before.
    options : SequenceOptions, optional
        As `encode_sequence` takes them; faces may change unless `runs` is false.
    metadata : mapping of str, optional
        What belongs to the whole sequence.
    **keywords
        Fields of the options. Targets are for frames that share them.

    Returns
    -------
    bytes
        A stream, for `decode_frames`.

    Raises
    ------
    MeshError
        If there is no frame, or the faces of one are others than those before and `runs` is false.

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
    from bsm.codec.sequence.encoder import SequenceEncoder
    from bsm.codec.sequence.options import SequenceOptions

    if isinstance(meshes, (str, bytes)) or not isinstance(meshes, Iterable):
        raise ArgumentError(f"a mesh for each frame is expected, not {type(meshes).__name__}")
    told = {} if metadata is None else metadata
    check_mapping("metadata", told)
    given = {"runs": True, **keywords} if options is None else keywords
    chosen = _chosen(options, SequenceOptions, given, keywords_to.sequence_options)
    frames = map(as_mesh, meshes)
    first = next(frames, None)
    if first is None:
        raise MeshError("a sequence needs at least one frame")
    attributes = [one for one in first.attributes if one.semantic != "normal"]
    count = len(meshes) if isinstance(meshes, Sequence) else 0
    encoder = SequenceEncoder(first.faces, chosen, count, told, attributes)
    return b"".join(encoder.chunks(chain([first], frames)))


def decode_frames(
    stream: Source, *, limits: Limits = DEFAULT_LIMITS, threads: int | None = None
) -> Iterator[TriangleMesh]:
    """Restore an animation frame by frame, whether its faces change or not.

    Parameters
    ----------
    stream, limits, threads
        As `decode` takes them; the stream is read as the frames are taken.

    Returns
    -------
    iterator of TriangleMesh
        The frames, each with its own faces and attributes.

    Raises
    ------
    BsmError
        As `decode_sequence`, where it is met, while the frames are taken.

    Examples
    --------
    >>> import bsm
    >>> for frame in bsm.decode_frames("dance.bsm"):
    ...     bounds = frame.positions.min(axis=0), frame.positions.max(axis=0)
    """
    from bsm.decoding import SequenceDecoder
    from bsm.events import FrameEvent

    with SequenceDecoder(limits, threads) as decoder:
        for event in decoder.events(read_chunks(stream)):
            if isinstance(event, FrameEvent):
                yield TriangleMesh(event.positions, event.faces, event.attributes, decoder.metadata)


def decode_sequence(
    stream: Source, *, limits: Limits = DEFAULT_LIMITS, threads: int | None = None
) -> tuple[Positions, Faces]:
    """Restore an animated mesh.

    Parameters
    ----------
    stream, limits, threads
        As `decode` takes them; the stream is read to its end first, a `SequenceDecoder` gives frames while bytes come.

    Returns
    -------
    positions : float64 array, shape (T, n, 3)
    faces : int32 array, shape (m, 3)

    Raises
    ------
    BsmError
        As `decode`; `UnsupportedError` also for the stream of a single mesh, `MeshError` if the faces change:
        `decode_frames` takes these, too.

    Examples
    --------
    >>> import bsm
    >>> positions, faces = bsm.decode_sequence("dance.bsm")
    >>> positions.ndim, faces.shape[1]
    (3, 3)
    """
    from bsm.decoding import decode_sequence as decode_frames

    return decode_frames(read_bytes(stream), limits, threads)


def load(source: Source, *, limits: Limits = DEFAULT_LIMITS, reader: str | None = None) -> TriangleMesh:
    """Read a mesh, from a mesh file or a stream, whatever it is.

    `read_mesh` also tells what was changed and left out on reading.

    Parameters
    ----------
    source : path, or anything else that `decode` takes
        OBJ, OFF, PLY, STL, VTP, npz and BSM; with trimesh installed (``pip install 'bsm-codec[formats]'``) also GLB,
        glTF, 3MF, DAE and others.
    limits : Limits
        What the file may ask for.
    reader : str, optional
        "openmesh" or "trimesh": read with that library, instead of ourselves where we know the format.

    Returns
    -------
    TriangleMesh

    Raises
    ------
    BsmError, OSError
        If this holds no mesh: `FormatError`, `MeshError`, ...; `DependencyError` where a library is missing.

    Examples
    --------
    >>> import bsm
    >>> mesh = bsm.load("spot.obj")
    >>> [attribute.name for attribute in mesh.attributes][:1]
    ['texcoord']
    """
    return read_any(Input(source), limits=limits, reader=reader)


def save(mesh: Any, path: str | os.PathLike[str], *, overwrite: bool = True, **keywords: Any) -> tuple[str, ...]:
    """Write a mesh to a file, as a whole or not at all, in the format of its name.

    Images and, for OBJ, the library of materials are written beside it; their names begin like its own.

    Parameters
    ----------
    mesh : mesh, pair of arrays, or path
        As `encode` takes it.
    path : path
        With the suffix .bsm, .glb (with trimesh), .npz, .obj, .off, .ply, .stl or .vtp.
    overwrite : bool
        Whether a file of this name is replaced.
    **keywords
        Of `encode`, for .bsm only.

    Returns
    -------
    tuple of str
        The names of attributes and metadata that the format cannot hold.

    Raises
    ------
    OptionError, FileExistsError
        If the name tells no format, or one that has no options; if the file exists and `overwrite` is false.

    Examples
    --------
    >>> import bsm
    >>> mesh = bsm.load("spot.obj")
    >>> bsm.save(mesh, "again.bsm", preset="fine")
    ()
    >>> "texcoord" in bsm.save(mesh, "again.stl")  # what STL cannot hold
    True
    """
    _name(path)
    suffix = Path(path).suffix.lower()
    kind = format_of_name(path)
    if suffix == ".bsm":
        written = Written(encode(mesh, **keywords))
    elif kind is None:
        raise OptionError(f"{path}: the name tells no format; use one of .bsm, .{', .'.join(WRITTEN_FORMATS)}")
    elif keywords:
        raise OptionError(f"{path}: {next(iter(keywords))} is an option of .bsm files only")
    else:
        written = written_mesh(as_mesh(mesh), kind, path)
    return save_written(path, written, overwrite=overwrite)


def denoise(
    mesh: Any,
    options: DenoiseOptions | None = None,
    /,
    *,
    goal: str = "shading",
    strength: float = 1.0,
    force: bool = False,
    **keywords: Any,
) -> TriangleMesh:
    """Remove noise from the positions of a mesh; the faces stay.

    Parameters
    ----------
    mesh : mesh, pair of arrays, or path
        As `encode` takes it.
    options : DenoiseOptions, optional
        Instead of keywords.
    **keywords
        Fields of `DenoiseOptions`; without any of them everything is chosen from the noise of the mesh.
    goal : str
        What that strives for: "shading" (normals near the clean ones) or "shape" (vertices).
    strength : float
        How much of every movement is made, from 0 to 1.
    force : bool
        Let the options have their way even where they do harm.

    Returns
    -------
    TriangleMesh
        The same object's faces, attributes and metadata; where nothing is found to remove, the same positions, too.

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

    chosen = _chosen(options, DenoiseOptions, keywords, keywords_to.denoise_options)
    with watched("denoising") as progress:
        return denoise_mesh(as_mesh(mesh), chosen, goal=goal, strength=strength, force=force, progress=progress.stage)


def compare(original: Any, decoded: Any, *, order: npt.ArrayLike | None = None) -> MeshComparison:
    """How far a mesh is from another of the same faces.

    Parameters
    ----------
    original, decoded : mesh, pair of arrays, path, or stream
        As `encode` takes a mesh, or `decode` a stream. Vertices that no face uses are left out; where only that makes
        the meshes comparable, vertices at one position are one.
    order : int array, shape (n,), optional
        Vertex j of `decoded` is vertex order[j] of `original`: `Encoder.vertex_order`. Without it the order may be the
        same, or the decoder's.

    Returns
    -------
    MeshComparison
        Errors of positions, and in `attributes` those of each attribute of `original` by its name.

    Raises
    ------
    MeshError
        If they have different faces.

    Examples
    --------
    >>> import bsm
    >>> errors = bsm.compare("bunny.ply", "bunny.bsm")
    >>> errors.max_error_relative <= 0.01, errors.theta_deg < 10
    (True, True)
    """
    import numpy as np

    from bsm.comparison import compare_meshes, pair

    first, second = (as_mesh(_opened(mesh)).without_isolated_vertices()[0] for mesh in (original, decoded))
    numbers = None if order is None else np.asarray(order)
    if numbers is not None and (numbers.ndim != 1 or numbers.dtype.kind not in "iu"):
        raise ArgumentError(f"order must be a list of whole numbers, not {order!r}")
    return compare_meshes(first, second, pair(first, second, None if numbers is None else numbers.astype(np.int64)))


def look(original: Any, other: Any, *, threads: int | None = None) -> Look:
    """How much alike two meshes look in pictures, of whatever vertices and faces; up to 1 they look the same.

    Parameters
    ----------
    original, other : mesh, pair of arrays, path, or stream
        As `encode` takes a mesh, or `decode` a stream.
    threads : int, optional
        None: one per core. The result does not depend on it.

    Returns
    -------
    Look
        `distance`, and what it is made of: `dissimilarity` (1 - SSIM) and `visible` (share of pixels).

    Raises
    ------
    MeshError
        If nothing of the original can be seen, since it has no area.

    Examples
    --------
    >>> import bsm
    >>> seen = bsm.look("bunny.ply", "bunny.bsm")
    >>> seen.distance <= 1  # as the default promises
    True
    """
    from bsm.codec.look.measure import look as look_at

    first, second = (as_mesh(_opened(mesh)) for mesh in (original, other))
    return look_at(first, second, threads=threads)


def _name(path: str | os.PathLike[str]) -> str:
    if not isinstance(path, (str, os.PathLike)):
        raise ArgumentError(f"the path of a file is expected, not {type(path).__name__}")
    return named(path)


def _opened(mesh: Any) -> Any:
    return Input(mesh) if isinstance(mesh, (bytes, bytearray, memoryview)) or hasattr(mesh, "read") else mesh


def _chosen(
    options: _Options | None, kind: type[_Options], keywords: dict[str, Any], build: Callable[..., _Options | None]
) -> _Options | None:
    if options is None:
        return build(**keywords)
    if not isinstance(options, kind):
        raise ArgumentError(f"{kind.__name__} is expected, not {type(options).__name__}; or give options by keyword")
    if keywords:
        raise ArgumentError(f"give {kind.__name__}, or keywords such as {next(iter(keywords))}; not both")
    return options
