"""A service for untrusted uploads: it encodes meshes, and no request can exhaust the machine.

    python examples/service.py --port 8000
    curl --data-binary @bunny.ply http://127.0.0.1:8000/encode?preset=fine -o bunny.bsm
    curl -F file=@bunny.ply http://127.0.0.1:8000/encode -o bunny.bsm
    curl --data-binary @bunny.bsm http://127.0.0.1:8000/decode -o bunny.ply
    curl http://127.0.0.1:8000/health

Reading and decoding keep to `Limits.service()`, in processes: one that takes too long is killed, one that dies is
replaced. Uploads, their time, connections and what waits are bounded. Answers name the class of an error. Each
warning, such as contents that no stream holds, is a header `X-BSM-Warning`, and a line of the logger `bsm`.
The standard library alone serves; put a proper server in front of it on the open web.
"""

from __future__ import annotations

import argparse
import logging
import multiprocessing
import re
import signal
import socket
import sys
import tempfile
import warnings
from collections.abc import Iterator
from contextlib import suppress
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from multiprocessing.connection import Connection
from pathlib import Path
from queue import Empty, Queue
from threading import BoundedSemaphore, Timer
from urllib.parse import parse_qs, quote, urlsplit

import bsm

MOST_BYTES = 64 << 20
MOST_CONNECTIONS = 16
"""At a time, each with an upload in memory; more are sent away."""
PRESETS = tuple(name for name, preset in bsm.PRESETS.items() if preset.contract is not None)
"""Those with a promise: others need a target, or send whatever the mesh takes."""
SPAWN = multiprocessing.get_context("spawn")
MOST_WARNINGS = 20
"""Headers of an answer; a mesh can lose more."""
LOGGER = logging.getLogger("bsm.service")
Answer = tuple[int, "str | bytes", tuple[str, ...]]
"""Status, body and warnings."""


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


WORK = {"/encode": encode, "/decode": decode}


def answer_to(path: str, data: bytes, preset: str) -> Answer:
    """Do the work; the body of an error is a sentence that begins with its class."""
    try:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", bsm.BsmWarning)
            body = WORK[path](data, preset)
        notes = [
            str(warning.message)
            for warning in caught
            if issubclass(warning.category, bsm.BsmWarning)
        ]
        return 200, body, tuple(map(without_names, notes[:MOST_WARNINGS]))
    except bsm.BsmError as error:
        status = 413 if isinstance(error, bsm.LimitError) else 422
        return status, f"{type(error).__name__}: {without_names(str(error))}", ()
    except Exception as error:
        return 413 if isinstance(error, MemoryError) else 500, type(error).__name__, ()


def without_names(sentence: str) -> str:
    """Return a sentence about an upload without the names of files on this machine."""
    return re.sub(r"(?<![^\s'\"(])/\S+", "(a file)", sentence)


def file_in_form(content_type: str, body: bytes) -> bytes:
    """Return the first file of a form, which `curl -F file=@bunny.ply` sends. Other bodies are returned whole."""
    boundary = re.fullmatch(
        r'multipart/form-data\s*;.*?boundary="?([\w\'()+,./:=? -]{1,70}?)"?\s*', content_type
    )
    if boundary is None:
        return body
    line = b"--" + boundary[1].encode()
    for begin in find_all(body, line):
        head_end = body.find(b"\r\n\r\n", begin)
        end = body.find(b"\r\n" + line, head_end)
        if head_end < 0 or end < 0:
            break
        if b"filename" in body[begin:head_end].lower():
            return body[head_end + 4 : end]
    raise ValueError("the form has no file: curl -F file=@bunny.ply")


def find_all(body: bytes, line: bytes) -> Iterator[int]:
    """Yield the places of the lines that separate the parts of a form."""
    place = body.find(line)
    while place >= 0:
        yield place
        place = body.find(b"\r\n" + line, place + len(line))


def work_for(pipe: Connection) -> None:
    """What a process does: one request after the other."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    # Loads what it needs before it is needed.
    bsm.encode(([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)]), threads=1)
    pipe.send("ready")
    with suppress(EOFError):
        while True:
            pipe.send(answer_to(*pipe.recv()))


class Worker:
    """A process for one request at a time, and another one once it hangs or dies."""

    def __init__(self) -> None:
        self.begin()

    def begin(self) -> None:
        """Start a process."""
        self.pipe, far = SPAWN.Pipe()
        self.process = SPAWN.Process(target=work_for, args=(far,), daemon=True)
        self.process.start()
        far.close()
        self.ready = False

    def wait(self) -> None:
        """Wait until the process is ready."""
        if not self.ready:
            self.pipe.recv()
            self.ready = True

    def replace(self) -> None:
        """Kill the process, and start another one."""
        self.process.kill()
        self.process.join()
        self.pipe.close()
        self.begin()

    def do(self, request: tuple[str, bytes, str], seconds: float) -> Answer:
        """Answer a request; retry it once if its process dies, since other requests may have killed it."""
        for _ in range(2):
            try:
                self.wait()
                self.pipe.send(request)
                if self.pipe.poll(seconds):
                    answer: Answer = self.pipe.recv()
                    return answer
            except (EOFError, OSError):
                self.replace()
            else:
                self.replace()
                return 503, f"TimeoutError: this takes more than {seconds:g} s", ()
        return 503, "MemoryError: the processes that worked on this have died", ()


class Server(ThreadingHTTPServer):
    """Threads that read and answer, and the workers."""

    daemon_threads = True

    def __init__(self, address: tuple[str, int], jobs: int, seconds: float) -> None:
        self.seconds = seconds
        self.connections = BoundedSemaphore(MOST_CONNECTIONS)
        self.busy = BoundedSemaphore(jobs)
        self.workers: Queue[Worker] = Queue()
        # One is ready while another one begins.
        self.all_workers = [Worker() for _ in range(jobs + 1)]
        for worker in self.all_workers:
            worker.wait()
            self.workers.put(worker)
        super().__init__(address, Handler)

    def process_request(self, request: socket.socket, client_address: tuple[str, int]) -> None:
        """Begin a thread, or send away."""
        if self.connections.acquire(blocking=False):
            super().process_request(request, client_address)
        else:
            with suppress(OSError):
                request.settimeout(1.0)
                request.sendall(b"HTTP/1.0 503 Service Unavailable\r\n\r\ntoo many connections\n")
            self.shutdown_request(request)

    def process_request_thread(
        self, request: socket.socket, client_address: tuple[str, int]
    ) -> None:
        """Serve one connection."""
        try:
            super().process_request_thread(request, client_address)
        finally:
            self.connections.release()

    def work(self, request: tuple[str, bytes, str]) -> Answer:
        """Let a worker do it, as soon as one is free."""
        if not self.busy.acquire(timeout=self.seconds):
            return 503, f"all workers have been busy for {self.seconds:g} s", ()
        try:
            worker = self.workers.get(timeout=self.seconds)
            try:
                return worker.do(request, self.seconds)
            finally:
                self.workers.put(worker)
        except Empty:
            return 503, "no worker is ready", ()
        finally:
            self.busy.release()


class Handler(BaseHTTPRequestHandler):
    """Answers POST /encode?preset=NAME, POST /decode and GET /health."""

    server: Server

    def setup(self) -> None:
        """From now on there is so much time for head and body together, however slowly they come."""
        # More than for reading, so that a late upload gets its answer.
        self.timeout = 2.0 * self.server.seconds
        super().setup()
        self.patience = Timer(self.server.seconds, self.stop_reading)
        self.patience.daemon = True
        self.patience.start()

    def stop_reading(self) -> None:
        """Let what is being read end here."""
        with suppress(OSError):
            self.connection.shutdown(socket.SHUT_RD)

    def handle(self) -> None:
        """Serve one request; clients come and go."""
        with suppress(OSError):
            super().handle()

    def finish(self) -> None:
        """Let go of everything."""
        self.patience.cancel()
        with suppress(OSError):
            super().finish()

    def log_message(self, format: str, *words: object) -> None:
        """Log a request; the base class would write to standard error."""
        LOGGER.info("%s " + format, self.address_string(), *words)

    def do_GET(self) -> None:
        """Say whether uploads can be taken."""
        if urlsplit(self.path).path != "/health":
            return self.answer(404, "GET /health")
        alive = any(worker.process.is_alive() for worker in self.server.all_workers)
        return self.answer(200 if alive else 503, "ok" if alive else "no worker is alive")

    def do_POST(self) -> None:
        """Take one upload."""
        try:
            url = urlsplit(self.path)
            preset = parse_qs(url.query).get("preset", ["balanced"])[0]
        except ValueError:
            return self.answer(400, "this is no address")
        lengths = self.headers.get_all("Content-Length", [])
        if url.path not in WORK or preset not in PRESETS:
            return self.answer(404, "POST /encode?preset=NAME or /decode")
        if not lengths:
            return self.answer(411, "say how long the upload is")
        if len(lengths) > 1 or not re.fullmatch("[0-9]{1,15}", lengths[0]):
            return self.answer(400, "Content-Length is a number of bytes")
        if int(lengths[0]) > MOST_BYTES:
            return self.answer(413, f"at most {MOST_BYTES} bytes")
        data = self.rfile.read(int(lengths[0]))
        self.patience.cancel()
        if len(data) < int(lengths[0]):
            return self.answer(408, f"the upload did not come within {self.server.seconds:g} s")
        try:
            data = file_in_form(self.headers.get("Content-Type", ""), data)
        except ValueError as error:
            return self.answer(400, str(error))
        return self.answer(*self.server.work((url.path, data, preset)))

    def answer(self, status: int, body: str | bytes, notes: tuple[str, ...] = ()) -> None:
        """Send a stream or mesh, or a sentence, and warnings."""
        content = body if isinstance(body, bytes) else f"{body}\n".encode()
        self.send_response(status)
        self.send_header(
            "Content-Type", "application/octet-stream" if isinstance(body, bytes) else "text/plain"
        )
        self.send_header("X-Content-Type-Options", "nosniff")
        self.send_header("Content-Length", str(len(content)))
        for note in notes:
            LOGGER.warning("%s: %s", self.path, note)
            # A line break would begin another header; other letters than those of ASCII have no agreed form in one.
            self.send_header("X-BSM-Warning", quote(note, safe=" !#$&'()*+,/:;=?@[]<>{}|^`\"~"))
        self.end_headers()
        self.wfile.write(content)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--host", default="127.0.0.1")
    parser.add_argument("--port", type=int, default=8000, help="0: any that is free")
    parser.add_argument("--jobs", type=int, default=2, help="requests that are worked on at a time")
    parser.add_argument(
        "--seconds", type=float, default=60.0, help="for an upload to come, and for the work on it"
    )
    args = parser.parse_args()
    logging.basicConfig(level=logging.INFO, format="%(asctime)s %(name)s %(levelname)s %(message)s")
    signal.signal(signal.SIGTERM, lambda *_: sys.exit())
    server = Server((args.host, args.port), args.jobs, args.seconds)
    print(f"http://{args.host}:{server.server_address[1]}", flush=True)
    with suppress(KeyboardInterrupt):
        server.serve_forever()


if __name__ == "__main__":
    main()
