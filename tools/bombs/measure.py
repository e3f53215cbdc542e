"""Decode one stream in a process of its own: what it took, as a line of JSON.

python -m tools.bombs.measure NAME.bsm [events | whole] [default | service]
"""

from __future__ import annotations

import json
import resource
import sys
from pathlib import Path

from bitstream.container.reader import END_OF_STREAM, NEED_DATA
from bitstream.errors import BsmError
from bitstream.limits import Limits
from bsm.files.sequence_stream import peek_header
from codec.sequence.decoder import FrameEvent, SequenceDecoder
from codec.static.decoder import Decoder
from codec.static.encoder import encode
from codec.static.events import ConnectivityEvent, HeaderEvent
from tools.vectors.meshes import torus


def seconds_of_cpu() -> float:
    """That this process has taken, all threads together."""
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


def decode_all(data: bytes, limits: Limits, whole: bool) -> tuple[str, int]:
    """What becomes of a stream, and how many vertices it gave, those of every frame."""
    header, _ = peek_header(iter([data]))
    sequence = header is not None and header.gop_frames > 0
    vertices = size = 0
    try:
        with SequenceDecoder(limits) if sequence else Decoder(limits) as decoder:
            decoder.receive_data(data)
            if whole and isinstance(decoder, Decoder):
                return "decoded", len(decoder.finish().positions)
            decoder.receive_eof()
            while (event := decoder.next_event()) is not END_OF_STREAM and event is not NEED_DATA:
                if isinstance(event, HeaderEvent):
                    size = event.header.vertices
                elif isinstance(event, ConnectivityEvent):
                    vertices = size
                elif isinstance(event, FrameEvent):
                    vertices += size
    except BsmError as error:
        return type(error).__name__ + ": " + str(error), vertices
    return "decoded", vertices


def main() -> None:
    """Run the command."""
    path, how, limits = sys.argv[1:]
    data = Path(path).read_bytes()
    decode_all(encode(torus(20, 20)), Limits(), how == "whole")  # what is loaded and allocated once is nobody's fault
    forget_peak()
    seconds, memory = seconds_of_cpu(), resident("VmRSS")
    outcome, vertices = decode_all(data, Limits.service() if limits == "service" else Limits(), how == "whole")
    taken = {"seconds": seconds_of_cpu() - seconds, "memory": resident("VmHWM") - memory}
    print(json.dumps({"outcome": outcome, "vertices": vertices} | taken))


if __name__ == "__main__":
    main()
