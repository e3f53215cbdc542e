"""Names of other files in files whose libraries open them by themselves: each must be in the folder of the file.

The names are checked before a library sees the file. A system with Landlock also keeps the library from other folders;
elsewhere this check is all there is.
"""

import gzip
import re
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any, BinaryIO, cast
from xml.etree import ElementTree

from bsm.bitstream.errors import FormatError, imported
from bsm.bitstream.limits import Limits
from bsm.files.formats.vtp import elements_of
from bsm.files.parsing import as_library_error
from bsm.files.pipes import about, file_beside

_IN_XML = ("vtu", "vts", "vtr", "vti", "pvtu", "pvtp", "pvts", "pvtr", "pvti", "vtm", "vtpc", "vtp")
_WITHOUT_NAMES = ("UnstructuredGrid", "PolyData", "StructuredGrid", "RectilinearGrid", "ImageData")
_NAMING = ("source", "file", "filename")  # attributes of elements, in lower case
_IN_HDF = ("vtkhdf", "exo", "ex2", "e", "cgns")
_HDF = b"\x89HDF\r\n\x1a\n"
_ADF_LINK = b"LK" + 30 * b" "  # the kind of a node of CGNS without HDF5 that names another file
_LEADING_OUT = re.compile(
    r"""(?:^|[\s"'/\\])\.\.(?:[/\\]|\s|$)|(?:^|[\s"'])(?:[/\\]|[A-Za-z]:[/\\])"""
)
_INCLUDE = re.compile(rb"#\s*(?:include|calc|codeStream)")
_PIECE, _HEAD = 1 << 20, 1 << 12


def refuse_outside(path: str, kind: str, limits: Limits, *, closed: bool) -> None:
    """Refuse a file that names files of other folders; `closed`: the system keeps its library from these, too."""
    source_path = Path(path)
    folder = source_path.resolve().parent
    if kind in _IN_XML:
        _refuse_in_xml(source_path, folder, limits)
    elif kind in ("case", "encas"):
        limits.check("metadata_bytes", source_path.stat().st_size)
        _refuse_in_case(source_path)
    elif kind == "foam" and not closed:
        _refuse_includes(folder)
    if kind in ("case", "encas", "foam") and not closed:
        _refuse_links(folder)
    if kind in _IN_HDF:
        with open(path, "rb") as file:
            is_hdf = file.read(len(_HDF)) == _HDF
        if is_hdf:
            refuse_outside_hdf(source_path, folder)
        elif (
            kind == "cgns"
            and not closed
            and any(_ADF_LINK in piece for piece in _pieces(source_path, len(_ADF_LINK)))
        ):
            raise FormatError(
                "this CGNS file links to another one; write it as HDF5, with cgnsconvert -h"
            )


def _refuse_in_xml(path: Path, folder: Path, limits: Limits) -> None:
    waiting, paths = [path], {path.resolve()}
    while waiting:
        current = waiting.pop()
        # The suffix does not tell: the library goes by this type. Files without names may be large, and not all XML.
        if _type_in(current) in _WITHOUT_NAMES:
            continue
        limits.check("metadata_bytes", current.stat().st_size)
        for element in elements_of(current.read_bytes()):
            for name in (value for key, value in element.attrib.items() if key.lower() in _NAMING):
                with about(name):
                    # The library looks beside the file that has the name, which may be in a folder below.
                    target = file_beside(folder, str(current.resolve().parent / name))
                if target.suffix[1:].lower() in _IN_XML and target not in paths:
                    paths.add(target)
                    waiting.append(target)


def _type_in(path: Path) -> str:
    """Return the type that the first element of a file of VTK says."""
    parser: Any = ElementTree.XMLPullParser(["start"])
    with open(path, "rb") as file, suppress(ElementTree.ParseError):
        while piece := file.read(_HEAD):
            parser.feed(piece)
            if first := next(iter(parser.read_events()), None):
                return str(first[1].get("type", ""))
    return ""


def _refuse_in_case(path: Path) -> None:
    for number, line in enumerate(path.read_text("latin-1").splitlines(), 1):
        if _LEADING_OUT.search(line.partition(":")[2]) or _LEADING_OUT.search(line):
            raise FormatError(
                f"line {number}: {line.strip()[:80]!r} names a file that is not in the folder of the mesh"
            )


def _refuse_includes(folder: Path) -> None:
    """Refuse an OpenFOAM case whose files include others, in whatever way."""
    for path in sorted(folder.rglob("*")):
        if path.is_file() and any(_INCLUDE.search(piece) for piece in _pieces(path, 32)):
            name = path.relative_to(folder)
            raise FormatError(
                f"{name} includes other files; write them into it, e.g. with foamDictionary -expand"
            )


def _refuse_links(folder: Path) -> None:
    """Refuse a folder with links to others: which of its files are read is not known here."""
    for path in sorted(folder.rglob("*")):
        if path.is_symlink() and not path.resolve().is_relative_to(folder):
            raise FormatError(
                f"{path.relative_to(folder)} is a link to another folder; put the file in its place"
            )


def _pieces(path: Path, overlap: int) -> Iterator[bytes]:
    """Yield the bytes of a file, also of one that gzip has compressed, in pieces that overlap."""
    with open(path, "rb") as plain, _unpacked(plain) as file, as_library_error("gzip"):
        end = b""
        while piece := file.read(_PIECE):
            yield end + piece
            end = piece[-overlap:]


def _unpacked(file: BinaryIO) -> BinaryIO:
    packed = file.read(2) == b"\x1f\x8b"
    file.seek(0)
    if packed:
        return cast(BinaryIO, gzip.open(file))
    return file


# ------------------------------------------------------------------------------------------------------- HDF5


def refuse_outside_hdf(path: Path, folder: Path) -> None:
    """Refuse an HDF5 file with tables or links in files that are not in a folder, and so on for these."""
    h5py = imported("h5py", "names in HDF5 files are checked with h5py", "simulation")
    waiting, paths = [path.resolve()], {path.resolve()}
    with as_library_error("h5py"):
        while waiting:
            with h5py.File(waiting.pop(), "r") as file:
                for name, place in _named_in(h5py, file):
                    with about(name):
                        target = file_beside(folder, name)
                        if place and not _has(h5py, target, place):
                            # HDF5 would give zeros for it, without a word.
                            raise FormatError(
                                f"it has no table {place}, which a virtual table shows"
                            )
                    if target not in paths:
                        paths.add(target)
                        waiting.append(target)


def _named_in(h5py: Any, file: Any) -> list[tuple[str, str]]:
    """Return the files that an HDF5 file names; and the table there, where a virtual table shows one."""
    links = list[tuple[str, str]]()

    def see_link(_: str, link: Any) -> None:
        if isinstance(link, h5py.ExternalLink):
            links.append((str(link.filename), ""))

    def see_object(name: str, item: Any) -> None:
        if not isinstance(item, h5py.Dataset):
            return
        # HDF5 looks for these in the current folder, and not beside the file.
        if item.external:
            raise FormatError(
                f"the table {name} is in the file {item.external[0][0]}; write it into the HDF5 file"
            )
        if not item.is_virtual:
            return
        links.extend(
            (str(source.file_name), str(source.dset_name))
            for source in item.virtual_sources()
            if source.file_name != "."
        )

    file.visititems_links(see_link)
    file.visititems(see_object)
    return links


def _has(h5py: Any, path: Path, place: str) -> bool:
    with h5py.File(path, "r") as file:
        return place in file


# ------------------------------------------------------------------------------------------------------- USD


def layers_inside(pxr: Any, path: str) -> list[Any]:
    """Open the layers that a stage may open; refuse one that is not in the folder of the stage, or below."""
    folder = Path(path).resolve().parent
    opened = [pxr.Sdf.Layer.FindOrOpen(path)]
    paths = {str(Path(path).resolve())}
    for layer in filter(None, opened):
        for name in _layers_named_in(pxr, layer):
            with about(name):
                target = _resolved(pxr, layer, name, folder)
            if not target or target in paths:
                continue
            paths.add(target)
            # The stage says which of its layers cannot be read.
            with suppress(pxr.Tf.ErrorException):
                opened.append(pxr.Sdf.Layer.FindOrOpen(target))
    return opened


# Not by GetCompositionAssetDependencies, which ends the process where a damaged layer has a prim without a name.
def _layers_named_in(pxr: Any, layer: Any) -> Iterator[str]:
    """Yield the names of the layers below a layer, and of those in its references and payloads, also of variants."""
    yield from layer.subLayerPaths
    paths = list[Any]()
    layer.Traverse(pxr.Sdf.Path.absoluteRootPath, paths.append)
    for path in paths:
        if not (path.IsPrimPath() or path.IsPrimVariantSelectionPath()):
            continue
        prim = layer.GetObjectAtPath(path)
        if not prim:
            raise FormatError("a layer of this stage is damaged: it has a prim without contents")
        for field in ("references", "payload"):
            if prim.HasInfo(field):
                arcs = prim.GetInfo(field).GetAddedOrExplicitItems()
                yield from filter(None, (arc.assetPath for arc in arcs))


def _resolved(pxr: Any, layer: Any, name: str, folder: Path) -> str:
    """Return where a layer is that another one names, perhaps in a package; "" if it is not there."""
    if name.startswith("`"):
        raise FormatError(
            "the name of a layer is an expression here; flatten the stage, e.g. with usdcat --flatten"
        )
    plain, _ = pxr.Sdf.Layer.SplitIdentifier(name)
    if not plain:
        return ""
    anchored = pxr.Sdf.ComputeAssetPathRelativeToLayer(layer, plain)
    if not anchored:
        return ""
    path = str(pxr.Ar.GetResolver().Resolve(anchored))
    outer_path = path
    if pxr.Ar.IsPackageRelativePath(path):
        outer_path, _ = pxr.Ar.SplitPackageRelativePathOuter(path)
    if path:
        file_beside(folder, outer_path)
    return path


def refuse_clips_outside(pxr: Any, stage: Any, path: str) -> None:
    """Refuse value clips in layers that are not in the folder of a stage; it has opened none of them yet."""
    folder = Path(path).resolve().parent
    roots = [stage.GetPseudoRoot(), *stage.GetPrototypes()]
    prims = (prim for root in roots for prim in pxr.Usd.PrimRange.AllPrims(root))
    for clips in (prim.GetMetadata("clips") for prim in prims if prim.HasMetadata("clips")):
        for one in clips.values():
            assets = [*one.get("assetPaths", ()), *filter(None, [one.get("manifestAssetPath")])]
            names = [asset.path for asset in assets]
            template = str(one.get("templateAssetPath", ""))  # a name with # for digits
            for name in filter(None, (*names, template)):
                with about(name):
                    _require_clip_inside(pxr, stage, name, folder)


def _require_clip_inside(pxr: Any, stage: Any, name: str, folder: Path) -> None:
    """Refuse a name that leads out of a folder from any layer: the stage does not tell which one has it."""
    for layer in stage.GetUsedLayers():
        if not layer.anonymous and not layer.realPath.endswith(".usdz"):
            _resolved(pxr, layer, name, folder)
            if not (Path(layer.realPath).resolve().parent / name).resolve().is_relative_to(folder):
                raise FormatError("it is not in the folder of the mesh")
