"""Decode one stream in a process of its own, and print what that took as JSON: `measure NAME.bsm HOW LIMITS`.

HOW is one of `HOWS` but for "browser"; LIMITS one of `bitstream.limits.NAMED_LIMITS`.
"""

from __future__ import annotations

import json
import resource
import subprocess
import sys
from dataclasses import asdict, dataclass
from pathlib import Path

from bsm.bitstream.container.gop import METHODS, parse_gop_body
from bsm.bitstream.container.header import HEADER_FIELDS
from bsm.bitstream.container.reader import END_OF_STREAM, NEED_DATA
from bsm.bitstream.container.wire import Cursor, FrameType
from bsm.bitstream.errors import BsmError
from bsm.bitstream.limits import NAMED_LIMITS, Limits
from bsm.codec.sequence.decoder import SequenceDecoder
from bsm.codec.sequence.events import FrameEvent
from bsm.codec.static.decoder import Decoder
from bsm.codec.static.encoder import encode
from bsm.codec.static.events import HeaderEvent, LossEvent
from bsm.files.stream import peek_header
from tools.surgery import frames_of, header_entries
from tools.vectors.meshes import torus

HOWS = ("events", "whole", "tolerant", "browser")
MOST_SECONDS = 600
SEQUENCE_BYTES = Limits().sequence_bytes
WEB = Path(__file__).parents[2] / "tools" / "web" / "scripts" / "measure.mjs"


@dataclass
class Taken:
    """What decoding a stream took."""

    outcome: str = "killed"
    vertices: int = 0
    shown: int = 0
    work: float = 0.0
    seconds: float = MOST_SECONDS
    memory: int = 0


def taken_by(path: Path, how: str, limits: str) -> Taken:
    """What a stream takes, in a process of its own; "browser": by the decoder for browsers, with its own limits."""
    command = [sys.executable, "-m", "tools.attack.measure", str(path), how, limits]
    if how == "browser":
        command = ["node", "--expose-gc", str(WEB), str(path)]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=MOST_SECONDS)
    except subprocess.TimeoutExpired:
        return Taken()
    if done.returncode:
        return Taken(f"died with code {done.returncode}: {done.stderr[-200:]}")
    told = json.loads(done.stdout)
    if told.pop("escaped", ""):
        return Taken(f"no error of a stream: {told['outcome']}")
    return Taken(**told)


def bounds(limits: str, taken: Taken, size: int) -> tuple[float, float]:
    """Bytes and seconds that a stream of so many bytes may take (M 14.8, M 14.9)."""
    if limits == "service":
        return float(1 << 30), 10.0
    vertices = taken.vertices
    return (1 << 26) + 1024.0 * vertices + 64.0 * size, 1.0 + 4e-5 * (vertices + taken.shown) + 2e-5 * size


def browser_bounds(taken: Taken, stream: bytes) -> tuple[float, float]:
    """Bytes and seconds of the decoder for browsers: 64 MiB and what sequences keep more, and four times as long."""
    memory, seconds = bounds("default", taken, len(stream))
    return memory + (1 << 26) + sequence_memory(stream, taken.vertices), 4.0 * seconds


def sequence_memory(stream: bytes, vertices: int) -> float:
    """Bytes of all dictionaries of a sequence, for so many vertices, and of positions in its largest GOP."""
    columns, gop = 0, 0
    try:
        for kind, payload in frames_of(stream):
            cursor = Cursor(payload)
            if kind == FrameType.HEADER and (entries := header_entries(payload)).get(HEADER_FIELDS["sequence"].key):
                columns = max(columns, entries.get(HEADER_FIELDS["coefficients"].key, 0))
            elif kind == FrameType.GOP and cursor.varint() >= 0:
                data = cursor.rest()
                body = parse_gop_body(data, Limits().gop_frames, data[0] // METHODS, tolerant=True)
                components = body.fields[0].components if body.method.has_basis else 0
                gop = max(gop, components * (16 * vertices + 120 * body.frames + 24 * components))
    except (BsmError, IndexError, ValueError, TypeError):
        pass  # behind that nothing is decoded
    return min(8.0 * vertices * columns, SEQUENCE_BYTES) + min(gop, SEQUENCE_BYTES)


def seconds_of_cpu() -> float:
    """CPU seconds that this process has taken, all threads together."""
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_utime + usage.ru_stime


def resident(name: str) -> int:
    """Bytes of this process's memory: "VmRSS" now, "VmHWM" at most since `forget_peak`.

    Not `ru_maxrss`, which a process inherits from the one that started it.
    """
    line = next(line for line in Path("/proc/self/status").read_text().splitlines() if line.startswith(name))
    return 1024 * int(line.split()[1])


def forget_peak() -> None:
    """Let the peak begin with what there is now."""
    Path("/proc/self/clear_refs").write_text("5")


def decode_all(data: bytes, how: str, limits: Limits) -> Taken:
    """Decode, and say what came of it."""
    header, _ = peek_header(iter([data]))
    sequence = header is not None and header.gop_frames > 0
    taken, tolerant, size = Taken(), how == "tolerant", 0
    losses = []  # a caller may keep them
    with SequenceDecoder(limits, tolerant=tolerant) if sequence else Decoder(limits, tolerant=tolerant) as decoder:
        try:
            decoder.receive_data(data)
            if how == "whole" and isinstance(decoder, Decoder):
                decoder.finish()
            decoder.receive_eof()
            while (event := decoder.next_event()) is not END_OF_STREAM and event is not NEED_DATA:
                match event:
                    case HeaderEvent(found):
                        size = found.vertices
                    case LossEvent():
                        losses.append(event)
                    case FrameEvent():
                        taken.shown += size
            taken.outcome = "decoded"
        except BsmError as error:
            taken.outcome = f"{type(error).__name__}: {error}"
        taken.work, taken.vertices = decoder.work, decoder.vertices
    return taken


def main() -> None:
    """Run the command."""
    path, how, limits = sys.argv[1:]
    data = Path(path).read_bytes()
    decode_all(encode(torus(20, 20)), how, Limits())  # what is loaded and allocated once is nobody's fault
    forget_peak()
    seconds, memory = seconds_of_cpu(), resident("VmRSS")
    taken = decode_all(data, how, NAMED_LIMITS[limits]())
    taken.seconds, taken.memory = seconds_of_cpu() - seconds, resident("VmHWM") - memory
    print(json.dumps(asdict(taken)))


if __name__ == "__main__":
    main()
