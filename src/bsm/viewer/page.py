"""The built page with streams in it, or beside it on a server of the loopback interface."""

from __future__ import annotations

import base64
import hashlib
import json
import select
import socket
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import asdict
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from importlib.resources import files
from typing import Any

from bsm.bitstream.errors import DependencyError
from bsm.viewer.content import Content
from bsm.viewer.growing import Growing

LOOPBACK = "127.0.0.1"

_SLOT = '<script type="application/json" id="bsm-streams">'
_SCRIPT = "<!-- script -->"
_BYTES = "application/octet-stream"
_POLICY = (
    "default-src 'none'; script-src 'sha256-{}' 'wasm-unsafe-eval' blob:; worker-src blob:; connect-src 'self' data:; "
    "style-src 'unsafe-inline'; img-src 'self' data: blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)

Place = Callable[[str, bytes], dict[str, str]]


def built(name: str) -> str:
    """Text of a file that `tools/web` builds."""
    try:
        return files("bsm.viewer").joinpath(name).read_text("utf-8")
    except OSError as error:
        raise DependencyError(f"a part of the viewer is missing, install the package again: {error}") from None


def page_with(contents: Sequence[Content]) -> str:
    """One page that needs nothing beside it: all streams are inside."""
    return _page(
        [_listed(content, "", lambda _, data: {"data": base64.b64encode(data).decode()}) for content in contents]
    )


def _listed(content: Content, path: str, place: Place) -> dict[str, Any]:
    """What the page knows of a stream, with what `place` says of where the bytes are that have a path."""
    entry: dict[str, Any] = {"name": content.name} | place(path, content.stream)
    if content.original is not None:
        entry["original"] = place(f"{path}/original", content.original.astype("<f4").tobytes())
    if content.draco is not None:
        entry["draco"] = asdict(content.draco)
    return entry


def _page(entries: list[dict[str, Any]]) -> str:
    # Inside a script nothing may look like the end of it.
    listed = json.dumps(entries).replace("<", "\\u003c")
    return built("page.html").replace(f"{_SLOT}[]", _SLOT + listed, 1).replace(_SCRIPT, built("viewer.js"), 1)


class PageServer(ThreadingHTTPServer):
    """Serves the page and its streams to this machine alone."""

    daemon_threads = True

    def __init__(self, contents: Sequence[Content | Growing], port: int = 0) -> None:
        super().__init__((LOOPBACK, port), _Handler)
        self.content: dict[str, tuple[str, bytes | Growing]] = {}

        def place(path: str, data: bytes | Growing) -> dict[str, str]:
            self.content[path] = (_BYTES, data)
            return {"url": path}

        entries = []
        for number, content in enumerate(contents):
            path = f"/{number}"
            if isinstance(content, Growing):
                entries.append({"name": content.name, "live": True} | place(path, content))
            else:
                entries.append(_listed(content, path, place))
        page = _page(entries)
        self.content["/"] = ("text/html; charset=utf-8", page.encode())
        script = hashlib.sha256(page.rpartition('<script type="module">')[2].rpartition("</script>")[0].encode())
        self.policy = _POLICY.format(base64.b64encode(script.digest()).decode())

    @property
    def host(self) -> str:
        """Address and port."""
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
            self.send_response(HTTPStatus.OK)
            self.send_header("Content-Type", kind)
            self.send_header("X-Content-Type-Options", "nosniff")
            self.send_header("X-Frame-Options", "DENY")
            self.send_header("Content-Security-Policy", self.server.policy)
            if isinstance(data, bytes):
                self.send_header("Content-Length", str(len(data)))
            self.end_headers()
            with suppress(ConnectionError):  # the page is closed
                for piece in [data] if isinstance(data, bytes) else data.chunks():
                    if not piece and self._is_alone():
                        return
                    self.wfile.write(piece)

    def _is_alone(self) -> bool:
        """Whether the page has gone; it says nothing more while it is there."""
        return bool(select.select([self.connection], [], [], 0)[0]) and not self.connection.recv(1, socket.MSG_PEEK)

    def log_message(self, format: str, *args: object) -> None:
        """Say nothing of requests."""
