"""Packets to bytes."""

import zlib

from bsm.bitstream.container.packets import WRITERS, End, Packet
from bsm.bitstream.container.wire import write_frame, write_preamble
from bsm.bitstream.limits import DEFAULT_LIMITS


class Writer:
    """Turns packets into the bytes of a stream; encoders decode the result before they return it."""

    def __init__(self) -> None:
        self._frames = self._crc = 0

    def start(self) -> bytes:
        """Return the preamble, which comes first."""
        preamble = write_preamble()
        self._crc = zlib.crc32(preamble)
        return preamble

    def write(self, packet: Packet) -> bytes:
        """Return the frame of one packet."""
        frame_type, write = WRITERS[type(packet)]
        payload = write(packet)
        DEFAULT_LIMITS.check("frame_bytes", len(payload))
        frame = write_frame(frame_type, payload)
        self._frames += 1
        self._crc = zlib.crc32(frame, self._crc)
        return frame

    def end(self, positions: int | None = None) -> bytes:
        """Return the END frame, with the checksum of decoded positions if it is known."""
        return self.write(End(self._frames, self._crc, positions))
