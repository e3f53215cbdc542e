"""A service that takes uploads of strangers: a mesh in, a stream out, and no request that takes the machine with it.

    python examples/service.py --port 8000
    curl --data-binary @bunny.ply http://127.0.0.1:8000/encode?preset=fine -o bunny.bsm
    curl --data-binary @bunny.bsm http://127.0.0.1:8000/decode -o bunny.ply

Uploads are bounded, reading and decoding keep to `Limits.service()`, and a pool of processes does the work, each
request in so much time. The standard library alone serves; put a proper server in front of it on the open web.
"""

from __future__ import annotations

import argparse
import multiprocessing
import tempfile
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures import TimeoutError as TooLong
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from urllib.parse import parse_qs, urlsplit

import bsm

MOST_BYTES = 64 << 20
MOST_SECONDS = 60.0
PRESETS = ("small", "balanced", "fine", "near-lossless")


def encode(data: bytes, preset: str) -> bytes:
    """A stream of an uploaded mesh, in whatever format it is."""
    mesh = bsm.read_mesh(data, limits=bsm.Limits.service()).mesh
    return bsm.encode(mesh, preset=preset, limits="service", threads=1)


def decode(data: bytes, _: str) -> bytes:
    """A PLY file of an uploaded stream."""
    mesh = bsm.decode(data, limits=bsm.Limits.service(), threads=1)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "mesh.ply")
        bsm.save(mesh, path)
        return path.read_bytes()


class Handler(BaseHTTPRequestHandler):
    """Answers POST /encode?preset=NAME and POST /decode."""

    pool: ProcessPoolExecutor

    def do_POST(self) -> None:
        """Take one upload."""
        url = urlsplit(self.path)
        work = {"/encode": encode, "/decode": decode}.get(url.path)
        preset = parse_qs(url.query).get("preset", ["balanced"])[0]
        length = self.headers.get("Content-Length", "")
        if work is None or preset not in PRESETS:
            return self.answer(404, "POST /encode?preset=NAME or /decode")
        if not length.isdecimal():
            return self.answer(411, "say how long the upload is")
        if int(length) > MOST_BYTES:
            return self.answer(413, f"at most {MOST_BYTES} bytes")
        data = self.rfile.read(int(length))
        try:
            self.answer(200, self.pool.submit(work, data, preset).result(MOST_SECONDS))
        except bsm.LimitError as error:
            self.answer(413, str(error))
        except bsm.BsmError as error:
            self.answer(422, str(error))
        except TooLong:
            self.answer(503, f"this takes more than {MOST_SECONDS:.0f} s")

    def answer(self, status: int, body: str | bytes) -> None:
        """Send a stream or mesh, or a sentence."""
        content = body if isinstance(body, bytes) else f"{body}\n".encode()
        self.send_response(status)
        self.send_header("Content-Type", "application/octet-stream" if isinstance(body, bytes) else "text/plain")
        self.send_header("Content-Length", str(len(content)))
        self.end_headers()
        self.wfile.write(content)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--host", default="127.0.0.1")
    parser.add_argument("--port", type=int, default=8000, help="0: any that is free")
    parser.add_argument("--jobs", type=int, default=2, help="requests that are worked on at a time")
    args = parser.parse_args()
    with ProcessPoolExecutor(args.jobs, multiprocessing.get_context("spawn")) as Handler.pool:
        server = ThreadingHTTPServer((args.host, args.port), Handler)
        print(f"http://{args.host}:{server.server_address[1]}", flush=True)
        server.serve_forever()


if __name__ == "__main__":
    main()
