"""The meshes that the page shows: a stream, the original and Draco's file; encoded here or in another process."""

import math
import multiprocessing
import os
import re
import shutil
import signal
import tempfile
import time
from bisect import bisect_left
from collections.abc import Callable, Generator, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, field, replace
from functools import cache
from multiprocessing.connection import Connection
from pathlib import Path, PurePath, PurePosixPath
from typing import Any

import numpy as np
import numpy.typing as npt

from bsm.account.comparison import (
    compare_meshes,
    errors_of_frames,
    in_order_of,
    pair,
    paired_frames,
)
from bsm.account.images import changed, compare_images
from bsm.api import decode_sequence, encode_sequence
from bsm.bitstream.container.wire import MAGIC
from bsm.bitstream.errors import BsmError, DependencyError, FormatError, MeshError, TargetError
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits
from bsm.codec.arrays import Faces, Order, Positions
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import TriangleMesh, extent_of
from bsm.codec.geometry.metrics import distances_to_surface, farthest_from_surface, surface_distance
from bsm.codec.look.foreseen import Foresight
from bsm.codec.look.measure import look
from bsm.codec.sequence.options import PROMISES
from bsm.codec.sequence.step_search import KNOTS
from bsm.codec.static.encoder import Encoder
from bsm.codec.static.options import PRESETS, EncodeOptions
from bsm.codec.static.targets import Contract
from bsm.encoding.given import Wishes, given_frames, given_mesh
from bsm.files.formats.polygons import MeshFile, without_compression_notes
from bsm.files.mesh import parts_of, read_mesh, size_with_parts
from bsm.files.motion.caches import CACHES
from bsm.files.motion.folder import common_name
from bsm.files.motion.frames import Frames, Wanted
from bsm.files.pipes import Input, is_url, read_chunks, size_of
from bsm.files.sequence import open_sequence
from bsm.files.stream import SequenceStream, decode_whole, is_scene, peek_header
from bsm.files.table import GLTF, by_name, is_mesh_name
from bsm.ground.console import Progress
from bsm.ground.exits import worded

DRACO_LEVEL = 10
DRACO_BITS = range(4, 25)
_SCENERY = re.compile(r"cameras?|(lights? of )?KHR_lights_punctual")
NO_STREAM = "the pipe does not contain a BSM stream; encode it: bsm encode - -o - | ..."
_EVERY = 0.1  # seconds between two reports of a process
_ENCODING = 0.7  # of the time that a mesh takes
_LONGEST = 60  # letters of a name
# The most bits that a grid of the format can have.
_FINEST = 20  # bits of a grid along the longest side
_FINE = 1e-4  # step of an original sequence that is drawn, of the diagonal
# 32 MB as floats. A page gets them before it can draw, so a longer sequence shows errors of frames only.
_MOST_COLORS = 1 << 23  # errors of vertices in frames that a page gets


@dataclass(frozen=True, eq=False)
class Shown:
    """A mesh that the page shows: its stream, the size of the file, and the error of each vertex."""

    title: str
    detail: str
    size: int
    stream: bytes
    off: npt.NDArray[np.float32] | None = None


@dataclass(frozen=True, eq=False)
class Content:
    """The layers of a mesh; `main` is the number of the stream, `facts` its promise and measurements."""

    name: str
    layers: tuple[Shown, ...]
    main: int = 0
    facts: Mapping[str, Any] = field(default_factory=dict)


def alone(name: str, stream: bytes) -> Content:
    return Content(name, (Shown("BSM", "", len(stream), stream),))


def carried(source: TriangleMesh | Frames) -> bytes:
    """Return a stream that is drawn as the original: see `_carrier` for meshes; sequences are nearly exact."""
    if isinstance(source, TriangleMesh):
        return _carrier(source)[0]
    # A sequence cannot be exact in the format, so its step is one that no picture shows.
    frames = np.array(list(source.frames))
    return encode_sequence(
        frames, source.faces, frame_rate=source.frame_rate, metadata=source.metadata, step=_FINE
    )


def _carrier(mesh: TriangleMesh) -> tuple[bytes, Order]:
    """Return a stream to the bit, or on the finest grid where single precision is coarser; and its order."""
    # Lossless streams hold single precision. A mesh in doubles may have more, and is then drawn from a grid.
    with suppress(MeshError, TargetError):
        encoder = Encoder(mesh, PRESETS["lossless"])
        return b"".join(encoder.chunks()), encoder.vertex_order
    encoder = Encoder(mesh, EncodeOptions(grid=_FINEST, attributes={"*": "exact"}))
    return b"".join(encoder.chunks()), encoder.vertex_order


def compared(
    name: str,
    stream: bytes,
    original: TriangleMesh | Frames,
    *,
    size: int | None = None,
    preset: str | None = None,
    limits: Limits = DEFAULT_LIMITS,
    before: bytes | None = None,
) -> Content:
    """Return a stream with its original, a file of `size` bytes, `before`, and Draco's file if DracoPy is there."""
    header, _ = peek_header(Input(stream).chunks())
    # An animated mesh and a single one have no common frames; nothing of the page would fit both.
    if bool(header and header.gop_frames) != isinstance(original, Frames):
        raise MeshError(f"{name} and its original must both be sequences, or both meshes")
    rivals: tuple[Shown, ...] = ()
    if isinstance(original, Frames):
        # Only where attributes move, each frame is read as a mesh.
        if original.meshes is None:
            moments = [(frame, original.attributes) for frame in original.frames]
        else:
            moments = [(mesh.positions, mesh.attributes) for mesh in original.meshes]
        frames = np.array([frame for frame, _ in moments])
        decoder = SequenceStream(Input(stream).chunks(), limits=limits)
        found, off = _over_time(
            name, decoder, frames, original.faces, [fields for _, fields in moments]
        )
        plain, promised = 12 * frames.size // 3, _promised(PROMISES, preset)
        original = replace(original, frames=iter(frames))
    else:
        found, off, rivals = _at_rest(
            original, decode_whole(Input(stream).chunks(), limits), len(stream)
        )
        plain = 12 * (len(original.positions) + len(original.faces))
        promised = _promised(
            {known: options.contract for known, options in PRESETS.items()}, preset
        )
    detail = ""
    if not size:
        detail = "as plain arrays"
    first = Shown("Original", detail, size or plain, before or carried(original))
    second = Shown("BSM", preset or "", len(stream), stream, off)
    return Content(name, (first, second, *rivals), 1, {"preset": preset, **found, **promised})


def _at_rest(
    original: TriangleMesh, decoded: TriangleMesh, size: int
) -> tuple[dict[str, Any], npt.NDArray[np.float32], tuple[Shown, ...]]:
    """Return measurements of a mesh, the error of each vertex, and the file of Draco beside a stream of some size."""
    used, kept = decoded.without_isolated_vertices()
    whole = original.without_isolated_vertices()[0]
    source = whole.bare
    # Vertices in no face have no error, and NaN says so.
    off = np.full(len(decoded.positions), np.nan, np.float32)
    diagonal, alike = source.diagonal or 1.0, True
    facts: dict[str, Any] = {
        "before": [len(original.positions), len(original.faces)],
        "diagonal": diagonal,
    }
    try:
        paired = pair(whole, used)
    except MeshError:
        # Without matching vertices, the distance between the surfaces is the only fair measure: it does not ask for the
        # same triangles.
        apart = surface_distance(source.positions, source.faces, used.positions, used.faces)
        facts |= {"apart": apart.mean / diagonal, "farthest": apart.hausdorff / diagonal}
        off[kept] = distances_to_surface(used.positions, source.positions, source.faces)
        alike = False
    else:
        source = paired.original
        off[kept] = np.linalg.norm(in_order_of(used, source) - used.positions, axis=1)
        errors = compare_meshes(whole, used, paired)
        facts |= {"angle": errors.angle_deg, "farthest": errors.max_error_relative}
        facts["attributes"] = {
            name: found and asdict(found) for name, found in errors.attributes.items()
        }
    rivals: tuple[Shown, ...] = ()
    # Faces without area are invisible; Draco refuses some meshes.
    with suppress(DependencyError, MeshError):
        facts["look"] = look(source, used).distance
        # Draco's file would need the same attributes at the same quality, or the sizes would not compare.
        if alike and not original.attributes:
            rivals, facts["draco"] = _rival(source, size, facts["look"])
    return facts, off, rivals


def _promised(contracts: Mapping[str, Contract | None], preset: str | None) -> dict[str, Any]:
    if not preset:
        return {}
    contract = contracts[preset]
    if contract is None:
        return {}
    bounds = {"look": contract.look, "farthest": min(contract.farthest, contract.by_part)}
    return {"promised": {bound: value for bound, value in bounds.items() if math.isfinite(value)}}


def _over_time(
    name: str,
    decoder: SequenceStream,
    before: Positions,
    faces: Faces,
    fields: Sequence[tuple[Attribute, ...]],
) -> tuple[dict[str, Any], npt.NDArray[np.float32] | None]:
    """Return the largest errors of each frame and field, the look of the worst of some, and errors of vertices."""
    moments = [(frame, decoder.attributes) for _, frame in decoder.frames()]
    decoded = np.array([frame for frame, _ in moments])
    if len(decoded) != len(before):
        raise MeshError(f"{name} has {len(decoded)} frames, and its original has {len(before)}")
    off = np.full(decoded.shape[:2], np.nan, np.float32)
    facts: dict[str, Any] = {"diagonal": float(np.linalg.norm(extent_of(before[0]))) or 1.0}
    # The encoder measures the look of the same frames. To draw all of them would take longer than encoding.
    kept, some = (
        np.unique(decoder.faces),
        np.linspace(0, len(before) - 1, min(KNOTS, len(before))).round().astype(int),
    )
    try:
        paired = paired_frames(before, faces, decoded, decoder.faces)
        first, second, shared = paired.before, paired.after, paired.faces
        known = [fields for _, fields in moments]
        facts["attributes"] = errors_of_frames(fields, known, (faces, decoder.faces), paired)
        errors = np.linalg.norm(first - second, axis=2).max(axis=1) / facts["diagonal"]
        foresight = Foresight(shared)
        foreseen = [foresight.look(*both) for both in zip(first, second, strict=True)]
        # The page colors decoded vertices, so errors are needed in their order as well.
        with suppress(MeshError):  # vertices that were merged have no error of their own
            back_again = paired_frames(decoded, decoder.faces, before, faces)
            off[:, kept] = np.linalg.norm(back_again.before - back_again.after, axis=2)
    except MeshError:
        for frame, (now, then) in enumerate(zip(decoded, before, strict=True)):
            off[frame, kept] = distances_to_surface(now[kept], then, faces)
        used = np.unique(faces)
        # Distances of one surface from the other are not symmetric: a part that is missing shows from the other side
        # only.
        back = [
            farthest_from_surface(t[used], d, decoder.faces)
            for d, t in zip(decoded, before, strict=True)
        ]
        errors = np.maximum(np.nanmax(off, axis=1), back) / facts["diagonal"]
        facts["apart"], foreseen = float(np.nanmean(off)) / facts["diagonal"], errors.tolist()
    looks = []  # of the frames that an encoder draws, too
    for frame in sorted({*some.tolist(), int(np.argmax(foreseen))}):
        with suppress(MeshError):  # nothing of it can be seen
            then, now = (
                TriangleMesh(before[frame], faces),
                TriangleMesh(decoded[frame], decoder.faces),
            )
            looks.append(look(then, now).moving)
    if looks:
        facts |= {"look": max(looks), "drawn": len(looks)}
    facts |= {"farthest": float(errors.max()), "errors": errors.tolist()}
    if off.size > _MOST_COLORS or not np.isfinite(off).any():
        return facts, None
    return facts, off


def _rival(
    source: TriangleMesh, size: int, distance: float
) -> tuple[tuple[Shown], dict[str, int] | None]:
    """Return Draco's finest file of at most `size` bytes, and the size of its smallest file of at most this look."""
    from bsm.evaluation.curve import decode_draco, encode_draco, positions_in_order

    @cache
    def file(bits: int) -> bytes:
        return encode_draco(source, bits, DRACO_LEVEL)

    @cache
    def mesh(bits: int) -> TriangleMesh:
        return TriangleMesh(
            positions_in_order(source, decode_draco(file(bits)), bits), source.faces
        )

    # Sizes grow with the bits, so a bisection over 21 settings encodes four or five times instead of all.
    small = DRACO_BITS[
        max(bisect_left(DRACO_BITS, True, key=lambda bits: len(file(bits)) > size) - 1, 0)
    ]
    good = bisect_left(
        DRACO_BITS, True, key=lambda bits: look(source, mesh(bits)).distance <= distance
    )
    # The page has no decoder of Draco. Its result travels as a stream of ours that changes nothing.
    stream, order = _carrier(mesh(small))  # joins vertices that Draco merged
    off = np.linalg.norm(mesh(small).positions - source.positions, axis=1)[order]
    layer = Shown("Draco", f"{small} bits", len(file(small)), stream, off.astype(np.float32))
    # Draco may not come that close at any number of bits. Then there is nothing to say about its size.
    if good == len(DRACO_BITS):
        return (layer,), None
    return (layer,), {"bytes": len(file(DRACO_BITS[good])), "bits": DRACO_BITS[good]}


def made(
    name: str,
    size: int | None,
    given: MeshFile | Frames,
    preset: str,
    report: Callable[[str, float], None],
) -> Content:
    """Encode a file and compare it; call `report` with each stage and the fraction done."""
    report("encoding", 0.0)
    begin = time.perf_counter()
    source = _shape_of(given)
    wishes = Wishes(keywords={"preset": preset})
    notes, less = list(given.notes), _lost_data(given)
    if isinstance(source, TriangleMesh):
        asked = given_mesh(source, wishes)
        found = asked.encode(Progress(""))
        stream = b"".join(found.attempt.frames)
        notes += [*asked.losses, *found.encoder.losses]
    else:
        frames = np.array(list(source.frames))
        source = replace(source, frames=iter(frames))
        moving = given_frames(replace(source, count=len(frames), frames=iter(frames)), wishes)
        stream = b"".join(moving.chunks(Progress("")))
        notes += [*moving.losses, *moving.encoder.losses]
    seconds = time.perf_counter() - begin
    report("comparing", _ENCODING)
    content = compared(name, stream, source, size=size, preset=preset)
    return replace(
        content, facts={**content.facts, "seconds": seconds, "notes": notes, "less": less}
    )


def encoded_scene(name: str, path: str, limits: Limits = DEFAULT_LIMITS) -> Content | None:
    """Return the decoded contents of a glTF scene with streams; None for all other inputs."""
    if not is_scene(path):
        return None
    document = by_name("bsm.gltf.document", "read_document")(path, limits)
    if not document.streams:
        return None
    size = size_of(path) or document.received
    if document.moving is not None:
        return Content(name, (Shown("GLB", "", size, document.moving),), facts={"notes": []})
    source = by_name("bsm.gltf.scene", "read_gltf_mesh")(document)
    # The page draws one stream, and the scene may have several, at places that its nodes tell.
    facts = {"notes": without_compression_notes(source.notes)}
    return Content(name, (Shown("GLB", "", size, carried(source.mesh)),), facts=facts)


def _shape_of(source: MeshFile | Frames) -> TriangleMesh | Frames:
    """The mesh of a file, or frames as they are."""
    if isinstance(source, MeshFile):
        return source.mesh
    return source


def _lost_data(given: MeshFile | Frames) -> bool:
    """Whether so much of a file is left out that sizes cannot be compared: more than cameras and lights."""
    return isinstance(given, MeshFile) and not all(map(_SCENERY.fullmatch, given.dropped))


@dataclass(frozen=True, eq=False)
class Given:
    """A sequence, a mesh file or the bytes of a stream, from a file of some size; files that were used and missed."""

    name: str
    source: Frames | MeshFile | bytes
    size: int | None
    used: tuple[str, ...] = ()
    missing: tuple[str, ...] = ()

    def decoded(self, limits: Limits) -> tuple[bytes | None, TriangleMesh | Frames]:
        """Return the stream, if it is one, and the mesh or sequence."""
        if not isinstance(self.source, bytes):
            return None, _shape_of(self.source)
        header, chunks = peek_header(iter([self.source]))
        if not header or not header.gop_frames:
            return self.source, decode_whole(chunks, limits)
        positions, faces = decode_sequence(self.source, limits=limits)
        return self.source, Frames(faces, len(positions), iter(positions))


def given_at(path: str, limits: Limits = DEFAULT_LIMITS, wanted: Wanted | None = None) -> Given:
    """Open a sequence, a stream or a mesh file."""
    if frames := open_sequence(path, None, wanted, limits):
        used = [path]
        if wanted and wanted.mesh:
            used.append(str(wanted.mesh))
        size = None
        if PurePath(path).suffix:
            size = size_of(path)
        return Given(path, frames, size, tuple(used))
    data = b"".join(read_chunks(path))
    # An empty file begins every other text, so it counts as a stream, and the decoder says that it ends too early.
    if MAGIC.startswith(data[: len(MAGIC)]):
        return Given(path, data, len(data), (path,))
    if path == "-":
        raise FormatError(NO_STREAM)
    if PurePath(path).suffix.lower() == ".bsm":
        decode_whole(iter([data]))  # raises the error of the stream
    found = read_mesh(path, limits=limits)
    missing: tuple[str, ...] = ()
    if not is_url(path):
        parts = parts_of(path, found.mesh.metadata)
        missing = tuple(name for name, part in parts.items() if part is None)
    size, there = size_with_parts(path, found.mesh.metadata)
    return Given(path, found, size, (path, *there), missing)


def given_among(paths: Sequence[str], folder: str) -> list[Given]:
    """Open files that were sent together: one or two with all that they name, or the frames of a sequence."""
    # Files that are dropped on a page come from anywhere. The limits are those for strangers.
    limits = Limits.service()
    caches = [path for path in paths if PurePath(path).suffix[1:].lower() in CACHES]
    # A cache of positions has no faces, so the mesh beside it is its topology, and not a second thing to show.
    shown = caches or [
        path for path in paths if path.lower().endswith(".bsm") or is_mesh_name(path)
    ]
    if len(shown) > 2:
        frames = replace(given_at(folder, limits), name=PurePath(common_name(shown)).name)
        return [replace(frames, size=sum(size_of(path) or 0 for path in shown), used=tuple(shown))]
    mesh = None
    if caches:
        mesh = next(filter(is_mesh_name, paths), None)
    files = []
    for path in shown or paths[:1]:
        if mesh is None:
            wanted = _moving(path)
        else:
            wanted = Wanted(mesh=mesh)
        files.append(given_at(path, limits, wanted))
    return files


def _moving(path: str) -> Wanted | None:
    """What to ask of a glTF file that has animations: the first one."""
    if PurePath(path).suffix[1:].lower() not in GLTF:
        return None
    if not by_name("bsm.gltf.document", "read_document")(path).items("animations"):
        return None
    return Wanted()


def against(before: Given, given: Given, limits: Limits) -> Content:
    """Compare a mesh, sequence or stream with another one, as they are."""
    (carrier, original), (stream, shown) = (each.decoded(limits) for each in (before, given))
    name = PurePath(given.name).name
    content = compared(
        name, stream or carried(shown), original, size=before.size, limits=limits, before=carrier
    )
    first, second, *rivals = content.layers
    title = "BSM"
    if not stream:
        title = PurePath(name).suffix[1:].upper() or "Other"
        # Draco's file was made to be compared with a stream.
        rivals = []
    second = replace(second, title=title, detail=name, size=given.size or 0)
    layers = (replace(first, detail=PurePath(before.name).name), second, *rivals)
    read = [
        (PurePath(each.name).name, each.source)
        for each in (before, given)
        if not isinstance(each.source, bytes)
    ]
    notes = [
        f"{which}: {note}"
        for which, source in read
        for note in without_compression_notes(source.notes)
    ]
    if isinstance(original, TriangleMesh) and isinstance(shown, TriangleMesh):
        notes += changed(compare_images(original.metadata, shown.metadata))
    less = any(_lost_data(source) for _, source in read)
    facts = {**content.facts, "notes": notes, "less": less}
    if not stream:
        facts["draco"] = None
    return replace(content, layers=layers, facts=facts)


def _work(pipe: Connection, paths: Sequence[str], folder: str, preset: str) -> None:
    """Encode an upload in a process, or compare two; send reports, then the result or an error message."""
    # Ctrl-C reaches every process of a terminal. The parent ends this one, so it must not print a traceback of its own.
    signal.signal(signal.SIGINT, signal.SIG_IGN)

    def report(stage: str, share: float) -> None:
        pipe.send({"stage": stage, "share": share})

    try:
        first, *others = given = given_among(paths, folder)
        stage = "encoding"
        if others:
            stage = "comparing"
        report(stage, 0.0)
        name = PurePath(first.name).name
        if others:
            content = against(first, others[0], Limits.service())
        elif isinstance(first.source, bytes):
            raise FormatError(f"{name} is a stream, which the page opens by itself, or empty")
        else:
            scene = encoded_scene(name, first.name, Limits.service())
            content = scene or made(name, first.size, first.source, preset, report)
        pipe.send(replace(content, facts={**content.facts, **_names_of_files(given, paths)}))
    except (BsmError, MemoryError) as error:
        # The temporary folder means nothing to the user, who sent a file by its name.
        pipe.send({"error": worded(error).replace(f"{folder}/", "")})


def _names_of_files(given: Sequence[Given], paths: Sequence[str]) -> dict[str, list[str]]:
    """Return the names of files that are missing, and of those sent that were used or not."""
    names: dict[str, list[str]] = {"missing": [], "used": [], "unused": []}
    # Temporary folders may lie behind a link, as /tmp does on macOS. Names are compared where they lead.
    used = set()
    for each in given:
        names["missing"] += each.missing
        used |= set(map(os.path.realpath, each.used))
    for path in paths:
        what = "unused"
        if os.path.realpath(path) in used:
            what = "used"
        names[what].append(PurePath(path).name)
    return names


def _put(folder: str, name: str, data: bytes) -> str:
    """Write a file that was sent, at its place in a folder that was dropped."""
    parts = PurePosixPath(name.replace("\\", "/").replace("\0", "")).parts
    # The name comes from a page. Parts like .. would lead out of the folder, and long names exceed what file systems
    # allow.
    path = Path(
        folder, *[part[-_LONGEST:] for part in parts if part not in ("/", "..")] or ["mesh"]
    )
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(data)
    return str(path)


def uploaded(
    files: Sequence[tuple[str, bytes]], preset: str
) -> Generator[dict[str, Any] | Content]:
    """Encode files dropped on the page, or compare two, in a process that ends with this generator; yield reports."""
    # Not forked: the server has threads, and a fork copies their locks as they are, perhaps held for ever.
    context = multiprocessing.get_context("spawn")
    here, there = context.Pipe()
    folder = tempfile.mkdtemp(prefix="bsm-")
    paths = [_put(folder, name, data) for name, data in files]
    process = context.Process(target=_work, args=(there, paths, folder, preset), daemon=True)
    process.start()
    # With the other end open here as well, `recv` would wait for ever after the process has died.
    there.close()
    try:
        report: Any = {"stage": "reading", "share": 0.0}
        yield report
        while isinstance(report, dict) and "stage" in report:
            if here.poll(_EVERY):
                report = here.recv()
            yield report
    except (EOFError, OSError):
        yield {"error": "the process that encoded it has died"}
    finally:
        process.kill()
        process.join()
        here.close()
        shutil.rmtree(folder, ignore_errors=True)
