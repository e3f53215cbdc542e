"""The built page with streams in it, or beside it on a server of the loopback interface."""

import base64
import gzip
import hashlib
import json
import math
import os
import re
import select
import socket
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass
from functools import lru_cache
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from importlib.resources import files
from threading import Condition
from typing import Any, BinaryIO

import numpy as np
import numpy.typing as npt

from bsm.bitstream.container.gop import method_of
from bsm.bitstream.container.header import HEADER_FIELDS
from bsm.bitstream.container.wire import MAGIC, FrameType, Tag, parse_map, parse_tag, parse_varint, write_preamble
from bsm.bitstream.errors import BsmError, CorruptError, DependencyError, MeshError, UnsupportedError
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.metrics import Reference
from bsm.comparison import in_order_of
from bsm.exits import worded
from bsm.files.pipes import Input, read_range
from bsm.files.stream import decode_whole, peek_header

_CHUNK = 1 << 18
_PAUSE = 0.05  # seconds between looks at a file that has not grown
_PATIENCE = 1.0  # seconds between looks whether a page is still there


class Growing:
    """A stream that one thread receives and others send on."""

    def __init__(self, name: str) -> None:
        self.name = name
        self._data = bytearray()
        self._over = False
        self._change = Condition()
        self._scanned = len(write_preamble())
        self._head: list[slice] = []  # of the present mesh: its header, all metadata so far, what is before its GOPs
        self._metadata: list[slice] = []
        self._entry: int | None = None

    def receive(self, chunks: Iterable[bytes]) -> None:
        """Take all bytes that come, until there are no more, or the stream says that it ends."""
        try:
            for chunk in chunks:
                self.take(chunk)
                if self._over:
                    return
        finally:
            self.end()

    def take(self, chunk: bytes) -> None:
        with self._change:
            self._data += chunk
            self._scan()
            self._change.notify_all()

    def end(self) -> None:
        with self._change:
            self._over = True
            self._change.notify_all()

    def begins(self) -> bool:
        """Whether this is a stream, or the beginning of one, once that is clear."""
        with self._change:
            self._change.wait_for(lambda: self._over or len(self._data) >= len(MAGIC))
            return self._data.startswith(MAGIC[: len(self._data)])

    def chunks(self) -> Iterator[bytes]:
        """What a page is sent: of what has come as much as it needs, then what comes, to the end; nothing now and
        then while nothing comes, so that whoever sends it on can look whether the page is still there."""
        with self._change:
            at = 0
            if self._entry is not None and not self._over:
                at = self._entry
                first = write_preamble() + b"".join(self._data[place] for place in self._head)
        if at > 0:
            yield first
        while True:
            with self._change:
                if not self._over and len(self._data) == at:
                    self._change.wait(_PATIENCE)
                piece = bytes(self._data[at : at + _CHUNK])
                if self._over and not piece:
                    return
            at += len(piece)
            yield piece

    def _scan(self) -> None:
        """Look at the frames that are there as a whole; nobody enters a stream behind damage."""
        try:
            while (tag := parse_tag(self._data, self._scanned)) and tag.end <= len(self._data):
                self._note(tag, slice(self._scanned, tag.end))
                self._scanned = tag.end
        except BsmError:
            self._entry = None
            self._scanned = len(self._data)

    def _note(self, tag: Tag, place: slice) -> None:
        self._over = tag.type == FrameType.END
        if tag.type == FrameType.METADATA:
            self._metadata.append(place)
        if tag.type == FrameType.HEADER:
            run = dict(parse_map(bytes(self._data[tag.payload : tag.checksum]))).get(HEADER_FIELDS["run"].key)
            again = isinstance(run, (list, tuple)) and len(run) > 1  # it has the mesh of an earlier run
            self._entry = None
            self._head = [] if again else [place, *self._metadata]
        elif tag.type == FrameType.GOP:
            first = parse_varint(self._data, tag.payload)
            if first is None or first[1] >= tag.checksum:
                raise CorruptError("a GOP has no method")
            if self._head and method_of(self._data[first[1]]).begins:
                self._entry = place.start
        elif self._head and self._entry is None:
            self._head.append(place)


def written_to(file: BinaryIO) -> Iterator[bytes]:
    """The bytes of a file that is still being written, until it is deleted or begun again; it is closed then."""
    size = 0
    with file:
        while (now := os.fstat(file.fileno())).st_nlink > 0 and now.st_size >= size:
            if chunk := file.read(_CHUNK):
                size += len(chunk)
                yield chunk
            else:
                time.sleep(_PAUSE)


DRACO_LEVEL = 10
DRACO_BITS = range(6, 25)
_RANGE = re.compile(r"bytes=(\d{1,18})-(\d{1,18})")


@dataclass(frozen=True)
class Rival:
    """Draco's smallest file whose normals are as good as the stream's: bytes, bits per coordinate, degrees."""

    bytes: int
    bits: int
    theta: float


@dataclass(frozen=True)
class Ranged:
    """A file, here or behind a URL, that is sent by ranges."""

    path: str
    size: int


@dataclass(frozen=True, eq=False)
class Tiled:
    """A folder of tiles: its manifest, and its shards by their names."""

    name: str
    files: Mapping[str, bytes | Ranged]


@dataclass(frozen=True, eq=False)
class Content:
    name: str
    stream: bytes
    original: npt.NDArray[np.float32] | None = None
    draco: Rival | None = None


def compared(name: str, stream: bytes, original: TriangleMesh, limits: Limits = DEFAULT_LIMITS) -> Content:
    """A stream of a mesh beside its original, and beside Draco's file of that if DracoPy is installed."""
    header, _ = peek_header(Input(stream).chunks())
    if header is not None and header.gop_frames:
        raise UnsupportedError(f"{name} is a sequence; only single meshes are compared with an original")
    decoded = decode_whole(Input(stream).chunks(), limits)
    used, kept = decoded.without_isolated_vertices()
    source = original.without_isolated_vertices()[0]
    if len(source.positions) != len(used.positions):
        from bsm.codec.static.preamble_encoding import join

        source = join(source, keep=False).mesh
    positions = decoded.positions.copy()
    positions[kept] = in_order_of(used, source)
    draco = _rival(TriangleMesh(positions[kept], used.faces), used)
    return Content(name, stream, positions.astype(np.float32), draco)


def _rival(original: TriangleMesh, decoded: TriangleMesh) -> Rival | None:
    """Draco's file of `original` with normals as good as those of `decoded`."""
    try:
        from bsm.evaluation.curve import decode_draco, encode_draco, positions_in_order
    except DependencyError:
        return None

    reference = Reference(original.positions, original.faces)
    theta = reference.theta(decoded.positions)
    for bits in DRACO_BITS:
        try:
            data = encode_draco(original, bits, DRACO_LEVEL)
            positions = positions_in_order(original, decode_draco(data), bits)
        except (DependencyError, MeshError):
            return None
        kept = reference.theta(positions)
        if kept <= theta or math.isclose(kept, theta):
            return Rival(len(data), bits, kept)
    return None


LOOPBACK = "127.0.0.1"

_SLOT = '<script type="application/json" id="bsm-streams">'
_SCRIPT = "<!-- script -->"
_BYTES = "application/octet-stream"
_GZIP = re.compile(r"\bgzip\b(?!\s*;\s*q=0)")
_gzipped = lru_cache(maxsize=8)(gzip.compress)
_POLICY = (
    "default-src 'none'; script-src 'sha256-{}' 'wasm-unsafe-eval' blob:; worker-src blob:; connect-src 'self' data:; "
    "style-src 'unsafe-inline'; img-src 'self' data: blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)

Place = Callable[[str, bytes], dict[str, str]]


def _built(name: str) -> bytes:
    """A file that `tools/web` builds."""
    try:
        return files("bsm.viewer").joinpath(name).read_bytes()
    except OSError as error:
        raise DependencyError(f"a part of the viewer is missing, install the package again: {error}") from None


def embedded(_: str, data: bytes) -> dict[str, str]:
    """The place of bytes that are in the page."""
    return {"data": base64.b64encode(data).decode()}


def script(place: Place, *more: str) -> str:
    """The page's module, told where the kernels of everything are, and `more` that are for less."""
    kernels = {name: place(f"/{name}.wasm", _built(f"{name}.wasm")) for name in ("kernels", "kernels-scalar", *more)}
    return f"const KERNELS={json.dumps(kernels)};{_built('viewer.js').decode()}"


def page_with(contents: Sequence[Content]) -> str:
    """One page that needs nothing beside it: all streams are inside."""
    return _page([_listed(content, "", embedded) for content in contents], script(embedded))


def _listed(content: Content, path: str, place: Place) -> dict[str, Any]:
    """What the page knows of a stream, with what `place` says of where the bytes are that have a path."""
    entry: dict[str, Any] = {"name": content.name} | place(path, content.stream)
    if content.original is not None:
        entry["original"] = place(f"{path}/original", content.original.astype("<f4").tobytes())
    if content.draco is not None:
        entry["draco"] = asdict(content.draco)
    return entry


def _page(entries: list[dict[str, Any]], script: str) -> str:
    # Inside a script nothing may look like the end of it.
    listed = json.dumps(entries).replace("<", "\\u003c")
    return _built("page.html").decode().replace(f"{_SLOT}[]", _SLOT + listed, 1).replace(_SCRIPT, script, 1)


class PageServer(ThreadingHTTPServer):
    """Serves the page and its streams to this machine alone."""

    daemon_threads = True

    def __init__(self, contents: Sequence[Content | Growing | Tiled], port: int = 0) -> None:
        super().__init__((LOOPBACK, port), _Handler)
        self.content: dict[str, tuple[str, bytes | Growing | Ranged]] = {}

        def place(path: str, data: bytes | Growing) -> dict[str, str]:
            self.content[path] = ("application/wasm" if path.endswith(".wasm") else _BYTES, data)
            return {"url": path}

        entries = []
        for number, content in enumerate(contents):
            path = f"/{number}"
            if isinstance(content, Growing):
                entries.append({"name": content.name, "live": True} | place(path, content))
            elif isinstance(content, Tiled):
                self.content |= {f"{path}/{name}": (_BYTES, data) for name, data in content.files.items()}
                entries.append({"name": content.name, "tiles": path})
            else:
                entries.append(_listed(content, path, place))
        module = script(place, "small")
        self.content["/"] = ("text/html; charset=utf-8", _page(entries, module).encode())
        self.policy = _POLICY.format(base64.b64encode(hashlib.sha256(module.encode()).digest()).decode())

    @property
    def host(self) -> str:
        return f"{LOOPBACK}:{self.server_address[1]}"


class _Handler(BaseHTTPRequestHandler):
    server: PageServer

    def do_GET(self) -> None:
        """Answer with what is at a path."""
        # Another name for this machine is a page of someone else that looks for its servers.
        if self.headers.get("Host") != self.server.host:
            self.send_error(HTTPStatus.FORBIDDEN)
        elif self.path not in self.server.content:
            self.send_error(HTTPStatus.NOT_FOUND)
        else:
            kind, data = self.server.content[self.path]
            status = HTTPStatus.OK
            if isinstance(data, Ranged):
                asked = _RANGE.fullmatch(self.headers.get("Range", ""))
                begin, end = map(int, asked.groups()) if asked else (1, 0)
                if not begin <= end < data.size:
                    self.send_error(HTTPStatus.REQUESTED_RANGE_NOT_SATISFIABLE)
                    return
                try:
                    data, status = read_range(data.path, begin, end + 1 - begin), HTTPStatus.PARTIAL_CONTENT
                except (BsmError, OSError) as error:
                    self.send_error(HTTPStatus.INTERNAL_SERVER_ERROR, worded(error))
                    return
            self.send_response(status)
            if isinstance(data, bytes) and kind != _BYTES and _GZIP.search(self.headers.get("Accept-Encoding", "")):
                data = _gzipped(data)
                self.send_header("Content-Encoding", "gzip")
            self.send_header("Content-Type", kind)
            self.send_header("X-Content-Type-Options", "nosniff")
            self.send_header("X-Frame-Options", "DENY")
            self.send_header("Content-Security-Policy", self.server.policy)
            if isinstance(data, bytes):
                self.send_header("Content-Length", str(len(data)))
            self.end_headers()
            with suppress(ConnectionError):  # the page is closed
                for piece in [data] if isinstance(data, bytes) else data.chunks():
                    # The page has gone; it says nothing more while it is there.
                    gone = not piece and select.select([self.connection], [], [], 0)[0]
                    if gone and not self.connection.recv(1, socket.MSG_PEEK):
                        return
                    self.wfile.write(piece)

    def log_message(self, format: str, *args: object) -> None:
        """Say nothing of requests."""
