"""The harness of attacks: what inputs take, each in a process of its own, held against what they may take."""

import faulthandler
import gc
import importlib
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
import warnings
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

from bsm.bitstream.container.gop import METHODS, WITH_ATTRIBUTES, GopMethod
from bsm.bitstream.container.header import HEADER_FIELDS
from bsm.bitstream.container.wire import FrameType
from bsm.bitstream.errors import BsmError
from bsm.bitstream.limits import NAMED_LIMITS, Limits
from bsm.codec.decoding import Decoder, SequenceDecoder
from bsm.codec.events import END_OF_STREAM, NEED_DATA, FrameEvent, HeaderEvent, LossEvent
from bsm.codec.static.encoder import encode
from bsm.files.stream import peek_header
from tools.payloads import parse_stretches
from tools.surgery import Cursor, frames_of, header_entries
from tools.vectors.meshes import torus

MOST_SECONDS = 600
MOST_ADDRESSES = 12 << 30
"""Of one process: what asks for more fails, and the machine lives on."""
_PATIENCE = 20
"""How much longer than it may work a process may wait."""
SEQUENCE_BYTES = Limits().sequence_bytes
WEB = Path(__file__).parents[2] / "web" / "scripts" / "measure.mjs"
BROWSER = 4.0
"""How much longer a browser may take."""


@dataclass(frozen=True)
class Taken:
    """What became of some bytes, and what that took."""

    outcome: str = "died, or took too long"
    size: int = 0
    vertices: int = 0
    shown: int = 0
    work: float = 0.0
    seconds: float = 0.0
    memory: int = 0

    @property
    def escaped(self) -> bool:
        """Whether something else came out than what was asked for or an error of ours."""
        return self.outcome.startswith(("died", "escaped"))

    def problem(self, memory: float, seconds: float) -> str | None:
        """Describe how a result exceeds the allowed bytes and seconds."""
        if self.escaped:
            return self.outcome
        if self.memory <= memory and self.seconds <= seconds:
            return None
        took = f"{self.memory / 2**20:.0f} of {memory / 2**20:.0f} MiB, {self.seconds:.2f} of {seconds:.2f} s"
        return f"{took}; {self.size} bytes, {self.outcome[:100]}"


Work = Callable[[], Taken]
Prepared = Callable[[], Work]


@dataclass(frozen=True)
class Case:
    """An input that is large in one place."""

    name: str
    make: Callable[[], Any]


def problems_of(
    names: Iterable[str],
    works: Sequence[Prepared],
    limits: str,
    most: float = 1.0,
    seconds: int = MOST_SECONDS,
) -> Iterator[str]:
    """Yield which works take more than `most` of what limits allow, or end in something else than a result."""
    for name, cost in zip(names, taken_by_each(works, seconds), strict=True):
        memory, time_allowed = bounds(limits, cost)
        if problem := cost.problem(most * memory, most * time_allowed):
            yield f"{name} ({limits}): {problem}"


def report(problems: Iterable[str], inputs: str) -> int:
    """Print problems as they come, and what was tried; return the exit code."""
    count = 0
    for problem in problems:
        count += 1
        print(problem, flush=True)
    print(f"{inputs}, {count} findings")
    return 1 if count else 0


def bounds(limits: str, cost: Taken) -> tuple[float, float]:
    """Bytes and seconds that what was taken may take (M 14.8, M 14.9)."""
    if limits == "service":
        return float(1 << 30), 10.0
    vertices, size = cost.vertices, cost.size
    return (1 << 26) + 1024.0 * vertices + 64.0 * size, 1.0 + 4e-5 * (
        vertices + cost.shown
    ) + 2e-5 * size


def browser_bounds(cost: Taken, stream: bytes) -> tuple[float, float]:
    """Bytes and seconds of the decoder for browsers: 64 MiB and what sequences keep more, and longer by `BROWSER`."""
    memory, seconds = bounds("default", cost)
    return memory + (1 << 26) + sequence_memory(stream, cost.vertices), BROWSER * seconds


def sequence_memory(stream: bytes, vertices: int) -> float:
    """Return the bytes of all dictionaries of a sequence, and of positions in its largest GOP."""
    columns, gop = 0, 0
    try:
        for kind, payload in frames_of(stream):
            cursor = Cursor(payload)
            if kind == FrameType.HEADER and (entries := header_entries(payload)).get(
                HEADER_FIELDS["sequence"].key
            ):
                columns = max(columns, entries.get(HEADER_FIELDS["coefficients"].key, 0))
            elif kind == FrameType.GOP and cursor.varint() >= 0:
                frames, components = beginning_of_gop(cursor.take(1)[0] % METHODS, cursor)
                gop = max(gop, components * (16 * vertices + 120 * frames + 24 * components))
    except (BsmError, IndexError, ValueError, TypeError):
        pass  # behind that nothing is decoded
    return min(8.0 * vertices * columns, SEQUENCE_BYTES) + min(gop, SEQUENCE_BYTES)


def beginning_of_gop(kind: int, cursor: Cursor) -> tuple[int, int]:
    """Return the frames of a GOP of a kind, and the components of its positions."""
    frames = cursor.varint()
    if not GopMethod(kind % WITH_ATTRIBUTES).has_basis:
        return frames, 0
    parse_stretches(cursor, frames)
    for _ in range(cursor.varint() if kind >= WITH_ATTRIBUTES else 0):
        cursor.varint()
        cursor.take(cursor.varint())
    cursor.take(4)  # the step
    return frames, cursor.varint()


def decode_all(data: bytes, how: str, limits: Limits) -> Taken:
    """Decode: by "events" on one thread, or on "threads", "whole", or "tolerant"."""
    header, _ = peek_header(iter([data]))
    sequence = header is not None and header.gop_frames > 0
    tolerant, threads = how == "tolerant", 1 if how == "events" else 2
    size = shown_vertices = 0
    losses = []  # a caller may keep them
    kind = SequenceDecoder if sequence else Decoder
    with kind(limits, threads, tolerant=tolerant) as decoder:
        try:
            decoder.receive_data(data)
            if how == "whole" and isinstance(decoder, Decoder):
                decoder.decode_rest()
            decoder.receive_eof()
            while (event := decoder.next_event()) is not END_OF_STREAM and event is not NEED_DATA:
                match event:
                    case HeaderEvent(found):
                        size = found.vertices
                    case LossEvent():
                        losses.append(event)
                    case FrameEvent():
                        shown_vertices += size
            outcome = "decoded"
        except BsmError as error:
            outcome = f"{type(error).__name__}: {error}"
        return Taken(outcome, len(data), decoder.vertices, shown_vertices, decoder.work)


def taken_by(stream: bytes, how: str, limits: str) -> Taken:
    """What a stream takes in a process of its own; by "browser" with that one's own limits."""
    if how == "browser":
        return next(iter(taken_by_browser([stream])))
    return next(taken_by_each([lambda: partial(decode_all, stream, how, NAMED_LIMITS[limits]())]))


def taken_by_browser(streams: Sequence[bytes]) -> list[Taken]:
    """What streams take in the decoder for browsers, one after the other in one process."""
    with tempfile.TemporaryDirectory() as folder:
        for number, stream in enumerate(streams):
            Path(folder, f"{number}.bsm").write_bytes(stream)
        command = ["node", "--expose-gc", str(WEB), folder]
        process = subprocess.run(
            command, capture_output=True, text=True, timeout=MOST_SECONDS, check=True
        )
    costs = []
    for line, stream in zip(process.stdout.splitlines(), streams, strict=True):
        report = json.loads(line)
        if problem := report.pop("escaped"):
            report["outcome"] = f"escaped: {problem}"
        costs.append(Taken(size=len(stream), **report))
    return costs


def taken_by_each(works: Sequence[Prepared], seconds: int = MOST_SECONDS) -> Iterator[Taken]:
    """What each work takes, in processes forked for some of them; `works` prepare it, which is not counted."""
    count = 0
    while count < len(works):
        reports = _reported_by_child(works[count:], seconds)
        yield from reports or [Taken()]
        count += max(1, len(reports))


def _reported_by_child(works: Sequence[Prepared], seconds: int) -> list[Taken]:
    """What one process tells of the first works: until it dies, or until it keeps so much that it hides what comes."""
    reading, writing = os.pipe()
    sys.stdout.flush()
    if (child := os.fork()) == 0:
        os.close(reading)
        gc.freeze()  # what was there before is not looked through for each
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)  # where libraries complain
        faulthandler.disable()  # pytest's writes to another copy of standard error
        # Of our own arithmetic none may be heard of.
        warnings.filterwarnings("error", category=RuntimeWarning, module=r"bsm\.")
        resource = importlib.import_module("resource")  # of POSIX
        resource.setrlimit(resource.RLIMIT_AS, (MOST_ADDRESSES, MOST_ADDRESSES))
        for prepare in works:
            # Processor time: a busy machine is not a finding.
            signal.setitimer(signal.ITIMER_PROF, 2 * seconds)
            signal.alarm(_PATIENCE * seconds)
            cost = _measured(prepare())
            os.write(writing, json.dumps(vars(cost)).encode() + b"\n")
            if cost.memory > 1 << 24:
                break
        os._exit(0)
    os.close(writing)
    with os.fdopen(reading, "rb") as pipe:
        lines = pipe.read().splitlines()
    os.waitpid(child, 0)
    return [Taken(**json.loads(line)) for line in lines]


def _measured(work: Work) -> Taken:
    Path("/proc/self/clear_refs").write_text("5")  # the peak begins with what there is now
    seconds, memory = time.process_time(), resident("VmRSS")
    try:
        cost = work()
    except BaseException as error:
        cost = Taken(f"escaped: {type(error).__name__}: {error}"[:1000])
    own_seconds, own_memory = time.process_time() - seconds, resident("VmHWM") - memory
    return replace(cost, seconds=cost.seconds + own_seconds, memory=max(cost.memory, own_memory))


def resident(name: str) -> int:
    """Bytes of this process's memory: "VmRSS" now, "VmHWM" at most.

    Not `ru_maxrss`, which a process inherits from the one that started it.
    """
    line = next(
        line for line in Path("/proc/self/status").read_text().splitlines() if line.startswith(name)
    )
    return 1024 * int(line.split()[1])


def warm_up() -> None:
    """Modules and allocations of the first call do not count."""
    for how in ("events", "whole"):
        decode_all(encode(torus(20, 20)), how, Limits())
