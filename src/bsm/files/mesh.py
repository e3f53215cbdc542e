"""Mesh files: by our own readers and writers, or by the libraries of the makers of a format, as the table says.

Coordinates are in double precision; vertices, faces and corners keep their order; all other data becomes attributes and
metadata; notes name changes and losses. Files may be hostile: a file that declares more than it contains is refused
before anything is allocated for it.
"""

import math
import os
import sys
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

from bsm.bitstream.container.wire import MAGIC
from bsm.bitstream.errors import (
    BsmError,
    DependencyError,
    FormatError,
    OptionError,
    UnsupportedError,
)
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits, as_limits
from bsm.codec.geometry.mesh import Metadata, TriangleMesh
from bsm.files import landlock, pipes
from bsm.files.formats.metadata import Beside, Written, fetched, images_in
from bsm.files.formats.polygons import Cut, MeshFile, Polygons
from bsm.files.output import can_be_replaced, refuse_to_overwrite, write_output
from bsm.files.parsing import PRECISION, gunzipped, plain_text
from bsm.files.pipes import Input, Source, as_input, is_url
from bsm.files.table import (
    FORMATS,
    GLTF,
    MESH_FORMATS,
    USD_FORMATS,
    WRITTEN_FORMATS,
    by_name,
    format_of_bytes,
    format_of_name,
    is_mesh_name,
    other_kind,
)
from bsm.ground.lengths import metres

_HEAD = 1 << 16  # bytes in which a file tells of its size, if it does
_ALL = 1 << 62
_GZIP = b"\x1f\x8b"
_WAY = "convert it to GLB, OBJ, PLY or VTU first, with the program that made it"
_FOREIGN = {
    (
        "fbx",
        "blend",
        "abc",
        "3ds",
        "x3d",
        "wrl",
    ): "convert it to GLB, OBJ or PLY first, for instance with Blender",
    ("gii",): "convert it to PLY or VTK, for instance with nibabel or mris_convert",
    ("frd",): "convert it to .vtu with ccx2paraview",
    ("unv", "med", "mesh"): "let Gmsh write it anew: gmsh FILE -save -o NEW.msh",
    ("op2", "d3plot"): "save it as .vtu, with pyNastran or, from LS-DYNA, with ParaView",
    (
        "step",
        "stp",
        "iges",
        "igs",
        "brep",
    ): "it holds surfaces; export triangles, for instance with FreeCAD",
    (
        "urdf",
        "sdf",
        "xacro",
        "mjcf",
    ): "it names the meshes of a robot; encode their folder: bsm encode -r FOLDER -o OUT/",
    ("jpg", "jpeg", "png", "webp", "tif", "tiff", "bmp", "gif"): (
        "it is a picture; encode the mesh that shows it, and the picture comes along"
    ),
    ("bvh",): "it moves a skeleton, and has no mesh; export the moving mesh as GLB or USD",
    ("las", "laz", "e57", "pcd", "pts"): "it holds points; point clouds are not supported",
    ("zip", "gz", "bz2", "xz", "tar", "tgz"): "it contains files: unpack it, and read its contents",
}


def read_mesh(
    source: Source,
    file_format: str | None = None,
    limits: Limits = DEFAULT_LIMITS,
    *,
    isolated: bool | None = None,
) -> MeshFile:
    """Read a mesh file.

    Parameters
    ----------
    source : path, buffer or binary file
        "-" reads standard input. Pipes and files compressed by gzip are accepted. Materials and images that a file
        names are read if they are in its folder or below.
    file_format : str, optional
        A suffix of a format that is read. None: by the name, or else by the first bytes.
    limits : Limits
        `vertices` and `faces` bound the mesh.
    isolated : bool, optional
        Read the file in a process of its own, which the system ends if it exceeds the memory or work of `limits`, and
        which can write no file and reach no other folder than the file's. None: if `limits.most_memory` is finite, as
        for `Limits.service()`. This needs Linux and landlockpy; elsewhere formats that other libraries read are then
        refused, and True is refused for all.

    Returns
    -------
    MeshFile
        Vertices and faces in the order of the file. Isolated vertices, degenerate and repeated faces are kept; polygons
        are cut into triangles.

    Raises
    ------
    FormatError, TruncatedError, CorruptError, MeshError, LimitError
        If the file is not a mesh of triangles or polygons with finite coordinates.
    UnsupportedError
        If the format must be read in a process of its own, and this system cannot.
    DependencyError
        If a library is needed and missing, such as landlockpy.
    OSError
        If the file cannot be read.

    Examples
    --------
    >>> import bsm
    >>> read = bsm.read_mesh("bunny.ply")
    >>> read.mesh, read.notes, read.dropped
    (TriangleMesh(... vertices, ... faces), (), ())
    """
    return read_cut(source, file_format, limits, None, isolated=isolated)


def read_cut(
    source: Source,
    file_format: str | None,
    limits: Limits,
    cut: Cut | None,
    *,
    isolated: bool | None = None,
) -> MeshFile:
    """Read a mesh file as `read_mesh` does, with a function that cuts its polygons."""
    input_source, limits = as_input(source), as_limits(limits)
    kind = kind_of(input_source, file_format)
    if is_apart((kind,), limits, isolated):
        read_isolated = by_name("bsm.files.isolation", "read_isolated")
        isolated_mesh: MeshFile = read_isolated(input_source, file_format, limits, kind)
        return isolated_mesh
    name = input_source.name
    path: str | None = None
    folder: Path | None = None
    if input_source.is_file:
        path, folder = name, Path(name).parent
    if kind in FORMATS and FORMATS[kind].apart:
        # These libraries open a file by its name themselves, often several times; they know no gzip.
        if path is None or input_source.peek(2) == _GZIP:
            raise FormatError(f".{kind} files are read from an uncompressed file with a name")
        return _read_apart(path, kind, limits, cut, here=isolated is False)
    data = input_source.read_all()
    if data.startswith(_GZIP):
        path, name, data = None, name.removesuffix(".gz"), gunzipped(data, limits)
    data = plain_text(data)
    if not data:
        raise FormatError("the file is empty")
    if data.startswith(MAGIC):
        raise FormatError("this is a BSM stream, not a mesh file; decode it first")
    kind = _kind(name, data, file_format)
    row = FORMATS.get(kind)
    other_format = ""
    # A reader's error about line 1 would say less.
    if row is not None and row.namesakes:
        other_format = other_kind(data, kind)
    if other_format and (kind, other_format) != ("glb", "JSON"):
        raise FormatError(
            f"this is {other_format}, not .{kind}; give it the right name, or name its format"
        )
    if row is None or not row.reader or (kind in USD_FORMATS and not path):
        way = next((way for kinds, way in _FOREIGN.items() if kind in kinds), _WAY)
        what = "this"
        if kind:
            what = f".{kind}"
        raise FormatError(f"{what} is not a mesh format that is known here: {way}")
    reader = by_name(row.modules[0], row.reader)
    if kind in USD_FORMATS:
        stage: MeshFile = reader(path, limits)
        return stage
    if kind in GLTF:
        scene: MeshFile = reader(by_name("bsm.gltf.document", "Document")(data, folder, limits))
        return scene
    polygons: Polygons
    if row.by_path:
        polygons = reader(data, path, limits)
    else:
        polygons = reader(data, limits)
    if row.beside:
        beside = Beside(folder, limits)
        metadata, notes, lost = fetched(polygons.metadata, beside.read)
        dropped = (*polygons.dropped, *lost)
        polygons = replace(
            polygons, metadata=metadata, notes=(*polygons.notes, *notes), dropped=dropped
        )
    return polygons.checked(limits, len(data), cut)


def _read_apart(path: str, kind: str, limits: Limits, cut: Cut | None, *, here: bool) -> MeshFile:
    """Read a file by a library that has a process of its own."""
    surface_of = by_name("bsm.files.apart", "surface_of")
    surface, times = surface_of(path, kind, limits, here=here)
    still: Polygons = surface
    if len(times) > 1:
        still = replace(surface, dropped=(*surface.dropped, f"later steps ({len(times) - 1})"))
    return still.checked(limits, os.path.getsize(path), cut)


def kind_of(source: Input, file_format: str | None) -> str:
    """The format of a file, by its name, or else by its first bytes; "" if they do not tell."""
    size_of_head = _ALL
    if source.is_file:
        size_of_head = _HEAD
    head = source.peek(size_of_head)
    name = source.name
    if head.startswith(_GZIP):
        name = name.removesuffix(".gz")
    return _kind(name, plain_text(head), file_format)


def _kind(name: str, data: bytes, file_format: str | None) -> str:
    suffix = Path(name).suffix[1:].lower()
    if file_format:
        return file_format
    # The name first: text of many formats has lines that begin like those of an OBJ, as that of an array called v.
    if is_mesh_name(name):
        return suffix
    return format_of_bytes(data) or suffix


def is_apart(kinds: Iterable[str], limits: Limits, isolated: bool | None) -> bool:
    """Whether files of these formats are read in a process of its own; refused if they must be and cannot."""
    is_wanted = limits.most_memory < math.inf if isolated is None else isolated
    if not is_wanted:
        return False
    lack = landlock.lack()
    foreign = next(
        (kind for kind in kinds if isolated or kind not in (*MESH_FORMATS, *GLTF, "npy", "")), None
    )
    if lack is not None and foreign is not None:
        error: type[BsmError] = UnsupportedError
        if "pip" in lack:
            error = DependencyError
        what = "files"
        if foreign:
            what = f".{foreign} files"
        why = "since nothing else bounds a reader's memory, time and files"
        raise error(
            f"{what} from strangers are read in a process of its own, {why}; that needs {lack}"
        )
    return sys.platform == "linux"


def written_mesh(
    mesh: TriangleMesh, file_format: str, path: str | os.PathLike[str] = "mesh"
) -> Written:
    """A mesh as a file of one of `WRITTEN_FORMATS`, what that cannot hold, and what lies beside it."""
    if mesh.metadata.items() >= PRECISION.items():
        metadata = {name: value for name, value in mesh.metadata.items() if name not in PRECISION}
        mesh = TriangleMesh(mesh.positions.astype("f4"), mesh.faces, mesh.attributes, metadata)
    written: Written = by_name(*FORMATS[file_format].writer.split(":"))(mesh, Path(path).stem)
    return written


def unheard(metadata: Metadata, file_format: str) -> str:
    """Return the unit and the axis of a mesh that other programs do not learn from a format, in words."""
    unit, up = str(metadata.get("unit", "")), str(metadata.get("up", "")).lower()
    statements: list[str] = []
    if FORMATS[file_format].own_unit and metres(unit) not in (None, 1.0):
        statements.append(f"the unit ({unit})")
    if file_format == "obj" and up in ("x", "z"):
        statements.append(f"the upward axis ({up})")
    return " and ".join(statements)


def write_mesh(
    path: str | os.PathLike[str], mesh: TriangleMesh, *, overwrite: bool = True
) -> tuple[str, ...]:
    """Write a mesh file, as a whole or not at all, in the format of its name, and the files that belong beside it."""
    kind = format_of_name(path)
    if kind not in WRITTEN_FORMATS:
        raise unknown_suffix(path)
    written = written_mesh(mesh, kind, path)
    return save_written(path, written, overwrite=overwrite)


def unknown_suffix(
    path: str | os.PathLike[str], *more: str, kind: str | None = None
) -> OptionError:
    """Return an error that lists the suffixes that can be written."""
    suffix = kind or Path(path).suffix[1:]
    fault = "its name has no suffix"
    if suffix:
        fault = f"single meshes are not written as {suffix}"
    return OptionError(f"{path}: {fault}; use one of .{', .'.join((*more, *WRITTEN_FORMATS))}")


def parts_of(path: str, metadata: Metadata) -> dict[str, Path | None]:
    """Where the files are that a mesh file names, materials, images and buffers; None: it is missing."""
    libraries = str(metadata.get("mtllib", "")).split("\n")
    names = {*libraries, *(name for name, _ in images_in(metadata).values())}
    if Path(path).suffix.lower() == ".gltf":
        with suppress(BsmError):
            names = {*by_name("bsm.gltf.document", "read_document")(path).files}
    beside = Beside(Path(path).resolve().parent, Limits())
    # Images may lie beside the library of materials that names them, and not beside the mesh.
    prefixes = [""]
    for library in libraries:
        folder, _, _ = library.replace("\\", "/").rpartition("/")
        if folder:
            prefixes.append(f"{folder}/")
    parts: dict[str, Path | None] = {}
    for name in filter(None, names):
        places = [beside.find(f"{prefix}{name}") for prefix in dict.fromkeys(prefixes)]
        parts[name] = next((place for place in places if isinstance(place, Path)), None)
    return parts


def size_with_parts(path: str, metadata: Metadata) -> tuple[int | None, dict[str, int]]:
    """The bytes of a file with those beside it that it names; and the sizes of these."""
    size = pipes.size_of(path)
    if size is None or is_url(path) or path == "-":
        return size, {}
    parts = {str(part): part.stat().st_size for part in parts_of(path, metadata).values() if part}
    return size + sum(parts.values()), parts


def copied(source: str, mesh: TriangleMesh, output: str | os.PathLike[str]) -> Written:
    """The bytes of a mesh file, and, unless they go to its own folder, those of the files there that it names."""
    parts: dict[str, Path | None] = {}
    if (
        not can_be_replaced(output)
        or Path(output).resolve().parent != Path(source).resolve().parent
    ):
        parts = parts_of(source, mesh.metadata)
    beside = {Path(name).name: part.read_bytes() for name, part in parts.items() if part}
    missing = tuple(name for name, part in parts.items() if not part)
    return Written(Path(source).read_bytes(), missing, beside)


def save_written(
    path: str | os.PathLike[str],
    written: Written,
    *,
    overwrite: bool,
    overwrite_beside: bool | None = None,
    follow: bool | str = True,
) -> tuple[str, ...]:
    """Write the files beside a mesh file, then the file; return the losses. A pipe has no files beside it."""
    beside: dict[str, bytes] = {}
    lost: list[str] = []
    for name, data in written.beside.items():
        place = _sibling(path, name)
        if not place:
            lost.append(name)
        elif is_url(place) or not Path(place).is_file() or Path(place).read_bytes() != data:
            beside[place] = data
    replace_beside = overwrite if overwrite_beside is None else overwrite_beside
    refuse_to_overwrite(path, overwrite)
    # All names are asked before the first file is written: a refusal in the middle would leave half of the output.
    for place in beside:
        refuse_to_overwrite(place, replace_beside)
    follow_beside = follow
    if not isinstance(follow, str):
        follow_beside = False
    for place, data in beside.items():
        write_output(place, data, overwrite=replace_beside, follow=follow_beside)
    # The mesh comes last: who sees it finds all the files that it names.
    write_output(path, written.data, overwrite=overwrite, follow=follow)
    return (*written.left_out, *lost)


def _sibling(path: str | os.PathLike[str], name: str) -> str | None:
    if isinstance(path, str) and is_url(path):
        return pipes.beside(path, name)
    if os.fspath(path) == "-" or not can_be_replaced(path):
        return None
    return str(Path(path).parent / name)
