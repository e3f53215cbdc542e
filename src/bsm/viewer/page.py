"""The built page, with embedded streams or on a local server."""

import base64
import gzip
import hashlib
import io
import json
import os
import re
import secrets
import select
import socket
import tempfile
import time
import webbrowser
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import closing, contextmanager, suppress
from dataclasses import dataclass
from functools import lru_cache
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from importlib.resources import files
from pathlib import Path, PurePath
from threading import Condition, Lock
from typing import Any, BinaryIO
from urllib.parse import parse_qs, urlsplit

from bsm._core import SkimmedPacket
from bsm.bitstream.container.wire import MAGIC, FrameType, write_preamble
from bsm.bitstream.errors import BsmError, DependencyError, OptionError
from bsm.bitstream.limits import Limits
from bsm.codec.static.presets import DEFAULT, SEQUENCE_ROWS
from bsm.files.inspection import Skimmer
from bsm.files.pipes import place_of, read_range
from bsm.ground.exits import worded
from bsm.viewer.contents import Content, uploaded

_CHUNK = 1 << 18
_PAUSE = 0.05  # seconds between looks at a file that has not grown
_PATIENCE = 1.0  # seconds between looks whether a page is still there


class Arrival:
    """A stream that one thread receives and other threads send."""

    def __init__(self, name: str) -> None:
        self.name = name
        self._data = bytearray()
        self._over = False
        self._change = Condition()
        # Wide, since the stream comes from a program that the user has started. The page has limits of its own.
        self._skimmer: Skimmer | None = Skimmer(Limits.wide())
        # A page that is opened late need not get hours of frames: it enters at the last GOP that begins anew.
        # Of the present mesh: its header, all metadata so far, what is before its GOPs.
        self._head: list[slice] = []
        self._metadata: list[slice] = []
        self._entry: int | None = None

    def receive(self, chunks: Iterable[bytes]) -> None:
        """Take all chunks, up to the end of input or of the stream."""
        try:
            for chunk in chunks:
                self.take(chunk)
                if self._over:
                    return
        finally:
            self.end()

    def take(self, chunk: bytes) -> None:
        """Look at the packets that are complete now; pages do not enter a stream after damage."""
        with self._change:
            self._data += chunk
            try:
                if self._skimmer:
                    for packet in self._skimmer.receive(chunk):
                        self._note(packet, slice(packet.offset, packet.offset + packet.length))
            except BsmError:
                # After damage no place to enter is known for certain. Pages then get all bytes, and their decoder says
                # what is wrong.
                self._entry = self._skimmer = None
            self._change.notify_all()

    def end(self) -> None:
        with self._change:
            self._over = True
            self._change.notify_all()

    def begins(self) -> bool:
        """Wait for the first bytes; return whether a stream begins with them."""
        with self._change:
            self._change.wait_for(lambda: self._over or len(self._data) >= len(MAGIC))
            return self._data.startswith(MAGIC[: len(self._data)])

    def chunks(self) -> Iterator[bytes]:
        """Yield received bytes that a page needs, then new ones, or empty ones while none arrive, up to the end."""
        with self._change:
            at = 0
            if self._entry is not None and not self._over:
                # Only while bytes still arrive: a complete stream is sent from its beginning, so that the page can play
                # all of it.
                at = self._entry
                first = write_preamble() + b"".join(self._data[place] for place in self._head)
        if at > 0:
            yield first
        while True:
            with self._change:
                if not self._over and len(self._data) == at:
                    # An empty piece follows if nothing has come, so that the caller can see whether the page is still
                    # there.
                    self._change.wait(_PATIENCE)
                piece = bytes(self._data[at : at + _CHUNK])
                if self._over and not piece:
                    return
            at += len(piece)
            yield piece

    def _note(self, packet: SkimmedPacket, place: slice) -> None:
        self._over = packet.type == FrameType.END
        if packet.type == FrameType.METADATA:
            self._metadata.append(place)
        if packet.type == FrameType.HEADER:
            assert self._skimmer is not None
            self._entry = None
            # A run that repeats an earlier mesh cannot be entered: its faces were sent only then.
            self._head = []
            if self._skimmer.header.mesh_of is None:
                self._head = [place, *self._metadata]
        elif packet.type == FrameType.GOP:
            if self._head and packet.begins:
                self._entry = place.start
        elif self._head and self._entry is None:
            self._head.append(place)


def written_to(file: BinaryIO) -> Iterator[bytes]:
    """Yield the bytes of a file that is still being written, until it is deleted or truncated; close it then."""
    size = 0
    with file:
        # A file without a name, or a shorter one, will not grow to what it was going to be.
        while (now := os.fstat(file.fileno())).st_nlink > 0 and now.st_size >= size:
            if chunk := file.read(_CHUNK):
                size += len(chunk)
                yield chunk
            else:
                time.sleep(_PAUSE)


# A range is held in memory while it is sent. A page asks for tiles, which are far smaller.
_MOST_RANGE = 1 << 26  # bytes of a range that is sent
_RANGE = re.compile(r"bytes=(\d{1,18})-(\d{1,18})")
_LENGTH = re.compile(r"\d{1,15}")


@dataclass(frozen=True)
class Ranged:
    """A file of a local folder or below a URL, which is sent in ranges."""

    folder: str
    name: str
    size: int

    def whole(self) -> bytes:
        return read_range(place_of(self.folder, self.name), 0, self.size)


@dataclass(frozen=True, eq=False)
class Tiled:
    """A folder of tiles: its manifest, and its shards by their names."""

    name: str
    files: Mapping[str, bytes | Ranged]

    def listed(self, number: int) -> dict[str, Any]:
        """Return the description for a page that fetches the files from a folder named by a number."""
        return {"name": self.name, "main": 0, "facts": {}, "tiles": str(number), "layers": []}


LOOPBACK = "127.0.0.1"
UPLOAD = "/upload"
# Seconds that any upload has, and bytes per second that give it more.
_UPLOAD_TIME, _SLOWEST = 10.0, 1e6
# The body is held in memory, and then written to files for the process that encodes it.
MOST_BYTES = 64 << 20

_SLOT = '<script type="application/json" id="bsm-streams">'
_SCRIPT = "<!-- script -->"
_BYTES = "application/octet-stream"
# A client may name gzip to say that it does not want it, by q=0.
_GZIP = re.compile(r"\bgzip\b(?!\s*;\s*q=0)")
# The page and the kernels are the same for every request. Streams are never compressed again: they would not shrink.
_gzipped = lru_cache(maxsize=8)(gzip.compress)
# The page shows names from files. Should one of them ever become markup, no foreign script may run, and nothing may
# leave this machine.
_POLICY = (
    "default-src 'none'; script-src 'sha256-{}' 'wasm-unsafe-eval' blob:; worker-src blob:; connect-src 'self' data:; "
    "style-src 'unsafe-inline'; img-src 'self' data: blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)

_LARGEST_ANGLE = 180  # degrees between two faces: they lie on each other
_PRESETS = sorted((row.name for row in SEQUENCE_ROWS), key=lambda name: name != DEFAULT)
"""What pages offer; the first is chosen."""
Place = Callable[[str, bytes], dict[str, str]]


def _built(name: str) -> bytes:
    """A file that `web` builds: in the package, or in the checkout that is installed."""
    viewer = files("bsm.viewer")
    # An editable install has links in the package or none, by how the checkout was made; a wheel has the files
    # themselves.
    for place in (
        viewer / name,
        viewer / "built" / name,
        Path(__file__).parents[3] / "web" / "built" / name,
    ):
        if place.is_file():
            return place.read_bytes()
    raise DependencyError(f"a part of the viewer is missing, install the package again: {name}")


def embedded(_: str, data: bytes) -> dict[str, str]:
    """Return bytes as a data URL of the page."""
    # A page that is opened from a disk cannot fetch files beside it. Everything is inside of it.
    return {"data": base64.b64encode(data).decode()}


def check_crease_angle(angle: float | None) -> None:
    """Raise an error unless pages can draw with an angle."""
    if angle is not None and not 0 <= angle <= _LARGEST_ANGLE:
        raise OptionError(
            f"the crease angle must be from 0 (flat) to {_LARGEST_ANGLE} degrees (smooth), not {angle}"
        )


def script(place: Place, *more: str, crease_angle: float | None = None) -> str:
    """Return the module of the page with the addresses of the full kernels, and of `more` smaller ones or scripts."""
    kernels = {
        PurePath(name).stem: place(f"/{name}", _built(name)) for name in ("kernels.wasm", *more)
    }
    told: dict[str, Any] = {**kernels, "presets": _PRESETS}
    # The page has the rule. Without an angle, it decides by the edges of each mesh.
    if crease_angle is not None:
        told["creaseAngle"] = crease_angle
    return f"const KERNELS={json.dumps(told)};{_built('viewer.js').decode()}"


def page_with(contents: Sequence[Content], crease_angle: float | None = None) -> str:
    """Return a page of one file, with all streams inside."""
    entries = [listed(content, "", embedded) for content in contents]
    return _page(entries, script(embedded, crease_angle=crease_angle))


def site_with(
    contents: Sequence[Content | Tiled], crease_angle: float | None = None
) -> dict[str, bytes | Ranged]:
    """Return the files of a page that encodes by itself, by their names; any web server can send them."""
    built: dict[str, bytes | Ranged] = {
        name: _built(name) for name in ("encode.wasm", "encode-moving.wasm")
    }

    def place(path: str, data: bytes) -> dict[str, str]:
        name = path.removeprefix("/").replace("/", "-")
        if not PurePath(name).suffix:
            name += ".bin"
        built[name] = data
        return {"url": name}

    entries = []
    for number, content in enumerate(contents):
        if isinstance(content, Tiled):
            built |= {f"{number}/{name}": data for name, data in content.files.items()}
            entries.append(content.listed(number))
        else:
            entries.append(listed(content, f"/{number}", place))
    module = script(place, "grid.wasm", "encoder.js", crease_angle=crease_angle)
    built["index.html"] = _page(entries, module).encode()
    return built


def listed(content: Content, path: str, place: Place) -> dict[str, Any]:
    """Return the description of a mesh for the page; `place` gives the address of the bytes of a path."""
    layers = []
    for number, layer in enumerate(content.layers):
        entry: dict[str, Any] = {"title": layer.title, "detail": layer.detail, "size": layer.size}
        entry |= place(f"{path}/{number}", layer.stream)
        if layer.off is not None:
            entry["off"] = place(f"{path}/{number}/off", layer.off.astype("<f4").tobytes())
        layers.append(entry)
    return {
        "name": content.name,
        "main": content.main,
        "facts": dict(content.facts),
        "layers": layers,
    }


def _page(entries: list[dict[str, Any]], script: str) -> str:
    # No text inside a script may look like its end tag.
    # A stream or a name could spell the end tag of the script.
    inside = json.dumps(entries).replace("<", "\\u003c")
    # One replacement each: what was inserted might hold the words of the slot.
    return (
        _built("page.html")
        .decode()
        .replace(f"{_SLOT}[]", _SLOT + inside, 1)
        .replace(_SCRIPT, script, 1)
    )


@contextmanager
def in_browser(address: str) -> Iterator[None]:
    """Show an address in the browser, by a file that leads there: other users see the command line of a browser."""
    with tempfile.TemporaryDirectory(prefix="bsm-") as folder:
        page = Path(folder, "view.html")
        page.touch(0o600)
        # The address holds the token, and a command line can be read by every user of the machine. The file cannot.
        page.write_text(
            f'<meta http-equiv="refresh" content="0; url={address}"><a href="{address}">bsm view</a>'
        )
        webbrowser.open(page.as_uri())
        yield


class PageServer(ThreadingHTTPServer):
    """Serves the page and its streams to this machine only, and encodes meshes that are dropped on it."""

    # A page that is open holds a connection. Without this, Ctrl-C would wait until it is closed.
    daemon_threads = True

    def __init__(
        self,
        contents: Sequence[Content | Arrival | Tiled],
        port: int = 0,
        crease_angle: float | None = None,
    ) -> None:
        # Never another address: the server reads files that the user named, and has no accounts.
        super().__init__((LOOPBACK, port), _Handler)
        self.content: dict[str, tuple[str, bytes | Arrival | Ranged]] = {}
        self.encoding = Lock()
        # Another user of this machine may reach the port, and does not know it.
        self.token = secrets.token_urlsafe(16)
        entries = []
        for number, content in enumerate(contents):
            path = f"/{number}"
            if isinstance(content, Arrival):
                layer = {"title": "BSM", "detail": "", "size": 0} | self.place(path, content)
                entries.append(
                    {"name": content.name, "main": 0, "facts": {}, "live": True, "layers": [layer]}
                )
            elif isinstance(content, Tiled):
                self.content |= {
                    f"{path}/{name}": (_BYTES, data) for name, data in content.files.items()
                }
                entries.append(content.listed(number))
            else:
                entries.append(listed(content, path, self.place))
        module = script(self.place, "grid.wasm", crease_angle=crease_angle)
        self.content["/"] = ("text/html; charset=utf-8", _page(entries, module).encode())
        self.policy = _POLICY.format(
            base64.b64encode(hashlib.sha256(module.encode()).digest()).decode()
        )

    def place(self, path: str, data: bytes | Arrival) -> dict[str, str]:
        """Have the page fetch these bytes, at an address relative to its own."""
        kind = _BYTES
        if path.endswith(".wasm"):
            kind = "application/wasm"
        self.content[path] = (kind, data)
        return {"url": path[1:]}

    def dropped(self, content: Content) -> dict[str, Any]:
        """Have the page fetch the result of an upload, in place of the previous one."""
        # Results of uploads would otherwise stay in memory for as long as the server runs.
        for path in [path for path in self.content if path.startswith(UPLOAD)]:
            del self.content[path]
        # A new address each time, since the page might find the result of an earlier upload in its cache.
        return listed(content, f"{UPLOAD}/{time.monotonic_ns()}", self.place)

    @property
    def host(self) -> str:
        return f"{LOOPBACK}:{self.server_address[1]}"

    @property
    def address(self) -> str:
        return f"http://{self.host}/{self.token}/"


class _Handler(BaseHTTPRequestHandler):
    server: PageServer
    timeout = 60.0  # seconds that a page may take to send or receive anything

    def parse_request(self) -> bool:
        """Refuse a request of anything but our page, and leave the path after the token."""
        if not super().parse_request():
            return False
        token, _, path = self.path.removeprefix("/").partition("/")
        self.path = f"/{path}"
        # With another name for this machine, a page of someone else looks for its servers.
        # The usual comparison ends at the first letter that differs, and its time tells how many were right.
        knows = secrets.compare_digest(token.encode(), self.server.token.encode())
        if knows and self.headers.get("Host") == self.server.host:
            return True
        self.send_error(
            HTTPStatus.FORBIDDEN, explain="Open the whole address that bsm view printed."
        )
        return False

    def do_GET(self) -> None:
        """Answer with the content of a path."""
        if self.path not in self.server.content:
            self.send_error(HTTPStatus.NOT_FOUND)
        else:
            kind, data = self.server.content[self.path]
            status = HTTPStatus.OK
            if isinstance(data, Ranged):
                asked = _RANGE.fullmatch(self.headers.get("Range", ""))
                begin, end = 1, 0
                if asked:
                    begin, end = map(int, asked.groups())
                # Only ranges with both ends are answered. A request without one would fetch a shard of 64 MB.
                if not begin <= end < min(data.size, begin + _MOST_RANGE):
                    self.send_error(HTTPStatus.REQUESTED_RANGE_NOT_SATISFIABLE)
                    return
                try:
                    place = place_of(data.folder, data.name)
                    data, status = (
                        read_range(place, begin, end + 1 - begin),
                        HTTPStatus.PARTIAL_CONTENT,
                    )
                except (BsmError, OSError) as error:
                    self.send_error(HTTPStatus.INTERNAL_SERVER_ERROR, worded(error))
                    return
            self._answer(data, kind, status)

    def do_POST(self) -> None:
        """Encode the mesh of an upload, and say line by line in JSON how far that is."""
        url = urlsplit(self.path)
        asked = parse_qs(url.query)
        names, sizes = (
            asked.get("name", ["mesh"]),
            asked.get("size", [self.headers.get("Content-Length", "")]),
        )
        length = self.headers.get("Content-Length", "")
        # Pages of others may send here, too, but not in our name.
        if self.headers.get("Origin") != f"http://{self.server.host}":
            self.send_error(HTTPStatus.FORBIDDEN)
        elif url.path != UPLOAD or asked.get("preset", [""])[0] not in _PRESETS:
            self.send_error(HTTPStatus.NOT_FOUND)
        # int() takes signs, spaces, underscores and digits of other scripts, which no header has.
        elif not all(map(_LENGTH.fullmatch, (length, *sizes))) or sum(map(int, sizes)) != int(
            length
        ):
            self.send_error(HTTPStatus.LENGTH_REQUIRED)
        elif int(length) > MOST_BYTES:
            self.send_error(HTTPStatus.REQUEST_ENTITY_TOO_LARGE, f"At most {MOST_BYTES >> 20} MiB")
        elif len(data := self._body(int(length))) < int(length):
            self.close_connection = True  # the page is gone, or too slow
        # One upload at a time: encoding uses all cores and much memory, and a page that is reloaded often must not pile
        # it up.
        # One that was cancelled ends soon.
        elif not self.server.encoding.acquire(timeout=10 * _PATIENCE):
            self.send_error(HTTPStatus.SERVICE_UNAVAILABLE, "One mesh at a time")
        else:
            try:
                body = io.BytesIO(data)
                files = [
                    (name, body.read(int(size))) for name, size in zip(names, sizes, strict=False)
                ]
                self._answer(self._reported(files, asked["preset"][0]), "text/plain")
            finally:
                self.server.encoding.release()

    def _body(self, length: int) -> bytes:
        """Read the body as far as it arrives in time; no other upload waits for it."""
        data, end = bytearray(), time.monotonic() + _UPLOAD_TIME + length / _SLOWEST
        with suppress(OSError):
            # The time-out of a socket begins again with each byte, so the time that is left is set before each read.
            while len(data) < length and (left := end - time.monotonic()) > 0:
                self.connection.settimeout(left)
                if not (piece := self.rfile.read1(length - len(data))):
                    break
                data += piece
        self.connection.settimeout(self.timeout)
        return bytes(data)

    def _reported(self, files: Sequence[tuple[str, bytes]], preset: str) -> Iterator[bytes]:
        """Lines of JSON: stage and share, at last an entry or an error."""
        with closing(uploaded(files, preset)) as reports:
            for report in reports:
                if isinstance(report, Content):
                    report = {"entry": self.server.dropped(report)}
                yield json.dumps(report).encode() + b"\n"

    def _answer(
        self, data: bytes | Arrival | Iterator[bytes], kind: str, status: HTTPStatus = HTTPStatus.OK
    ) -> None:
        """Send bytes, or chunks of them until the page is gone."""
        self.send_response(status)
        if (
            isinstance(data, bytes)
            and kind != _BYTES
            and _GZIP.search(self.headers.get("Accept-Encoding", ""))
        ):
            data = _gzipped(data)
            self.send_header("Content-Encoding", "gzip")
        self.send_header("Content-Type", kind)
        # A stream holds bytes from anywhere. A browser must not find out by itself that they look like a page.
        self.send_header("X-Content-Type-Options", "nosniff")
        self.send_header("X-Frame-Options", "DENY")
        self.send_header("Referrer-Policy", "no-referrer")
        self.send_header("Content-Security-Policy", self.server.policy)
        if isinstance(data, bytes):
            self.send_header("Content-Length", str(len(data)))
            data = iter([data])
        self.end_headers()
        if isinstance(data, Arrival):
            data = data.chunks()
        with suppress(OSError):  # the page is closed
            for piece in data:
                # The page has gone; it says nothing more while it is there.
                # Sending to a page that is gone fails only after some time. Until then an upload would be encoded for
                # nobody.
                quiet = (kind != _BYTES or not piece) and select.select(
                    [self.connection], [], [], 0
                )[0]
                if quiet and not self.connection.recv(1, socket.MSG_PEEK):
                    return
                self.wfile.write(piece)

    def log_message(self, format: str, *args: object) -> None:
        """Say nothing of requests."""
