"""The built page with streams in it, or beside it on a server of the loopback interface."""

from __future__ import annotations

import base64
import json
from collections.abc import Callable, Sequence
from dataclasses import asdict
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from importlib.resources import files
from typing import Any

from bsm.bitstream.errors import DependencyError
from bsm.viewer.content import Content

LOOPBACK = "127.0.0.1"

_SLOT = '<script type="application/json" id="bsm-streams">'
_SCRIPT = "<!-- script -->"
_BYTES = "application/octet-stream"

Place = Callable[[str, bytes], dict[str, str]]


def built(name: str) -> str:
    """Text of a file that `tools/web` builds.

    Raises
    ------
    DependencyError
        If it is missing.
    """
    try:
        return files("bsm.viewer").joinpath(name).read_text("utf-8")
    except OSError as error:
        raise DependencyError(f"a part of the viewer is missing, install the package again: {error}") from None


def page_with(contents: Sequence[Content]) -> str:
    """One page that needs nothing beside it: all streams are inside."""
    return _page(contents, lambda _, data: {"data": base64.b64encode(data).decode()})


def _page(contents: Sequence[Content], place: Place) -> str:
    """The page, with what `place` says of where the bytes are that have a path."""
    entries: list[dict[str, Any]] = []
    for number, content in enumerate(contents):
        entry: dict[str, Any] = {"name": content.name} | place(f"/{number}", content.stream)
        if content.original is not None:
            entry["original"] = place(f"/{number}/original", content.original.astype("<f4").tobytes())
        if content.draco is not None:
            entry["draco"] = asdict(content.draco)
        entries.append(entry)
    # Inside a script nothing may look like the end of it.
    listed = json.dumps(entries).replace("<", "\\u003c")
    return built("page.html").replace(f"{_SLOT}[]", _SLOT + listed, 1).replace(_SCRIPT, built("viewer.js"), 1)


class PageServer(ThreadingHTTPServer):
    """Serves the page and its streams to this machine alone.

    Parameters
    ----------
    contents : sequence of Content
    port : int
        0: any that is free.
    """

    daemon_threads = True

    def __init__(self, contents: Sequence[Content], port: int = 0) -> None:
        super().__init__((LOOPBACK, port), _Handler)
        self.content: dict[str, tuple[str, bytes]] = {}

        def place(path: str, data: bytes) -> dict[str, str]:
            self.content[path] = (_BYTES, data)
            return {"url": path}

        self.content["/"] = ("text/html; charset=utf-8", _page(contents, place).encode())

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
            self.send_header("Content-Length", str(len(data)))
            self.send_header("X-Content-Type-Options", "nosniff")
            self.end_headers()
            self.wfile.write(data)

    def log_message(self, format: str, *args: object) -> None:
        """Say nothing of requests."""
