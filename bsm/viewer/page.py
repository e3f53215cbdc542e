"""The built page with streams in it, or beside it on a server of the loopback interface."""

from __future__ import annotations

import base64
import json
from collections.abc import Mapping
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from importlib.resources import files

from bitstream.errors import DependencyError

LOOPBACK = "127.0.0.1"

_SLOT = '<script type="application/json" id="streams">'


def page_with_streams(streams: Mapping[str, bytes]) -> str:
    """One page that needs nothing beside it: `streams` by their names are inside."""
    return _filled([{"name": name, "data": base64.b64encode(data).decode()} for name, data in streams.items()])


def page_beside_streams(names: list[str]) -> str:
    """The page for a server that has the streams at the paths /0, /1, ..."""
    return _filled([{"name": name, "url": f"/{number}"} for number, name in enumerate(names)])


def _filled(entries: list[dict[str, str]]) -> str:
    try:
        page = files("bsm.viewer").joinpath("page.html").read_text("utf-8")
    except OSError as error:
        raise DependencyError(f"the page of the viewer is missing, install the package again: {error}") from None
    # Inside a script nothing may look like the end of it.
    listed = json.dumps(entries).replace("<", "\\u003c")
    return page.replace(f"{_SLOT}[]", _SLOT + listed, 1)


class PageServer(ThreadingHTTPServer):
    """Serves the page and its streams to this machine alone.

    Parameters
    ----------
    streams : mapping of str to bytes
        By their names.
    port : int
        0: any that is free.
    """

    daemon_threads = True

    def __init__(self, streams: Mapping[str, bytes], port: int = 0) -> None:
        super().__init__((LOOPBACK, port), _Handler)
        self.content = {"/": ("text/html; charset=utf-8", page_beside_streams(list(streams)).encode())}
        for number, data in enumerate(streams.values()):
            self.content[f"/{number}"] = ("application/octet-stream", data)

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
