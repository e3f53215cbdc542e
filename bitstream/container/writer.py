"""Packets to bytes."""

import zlib

from bsm.bitstream.container.packets import WRITERS, End, Packet
from bsm.bitstream.container.wire import write_frame, write_preamble
from bsm.bitstream.errors import OptionError
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits


class Writer:
    """Turns packets into the bytes of a stream; encoders decode the result before they return it."""

    def __init__(self, limits: Limits = DEFAULT_LIMITS) -> None:
        self._limits = limits
        self._frames = 0
        self._crc: int | None = None

    def start(self) -> bytes:
        """Return the preamble, which comes first."""
        if self._crc is not None:
            raise OptionError("the stream has been started already")
        preamble = write_preamble()
        self._crc = zlib.crc32(preamble)
        return preamble

    def write(self, packet: Packet) -> bytes:
        """Return the frame of one packet; `end` makes that of END."""
        if isinstance(packet, End):
            raise OptionError("END is made by Writer.end()")
        return self._frame(packet)

    def end(self, positions: int | None = None) -> bytes:
        """Return the END frame, with the checksum of decoded positions if it is known."""
        return self._frame(End(self._frames, self._crc or 0, positions))

    def _frame(self, packet: Packet) -> bytes:
        if self._crc is None:
            raise OptionError("call Writer.start() first")
        frame_type, write = WRITERS[type(packet)]
        payload = write(packet)
        self._limits.check("frame_bytes", len(payload))
        frame = write_frame(frame_type, payload)
        self._frames += 1
        self._crc = zlib.crc32(frame, self._crc)
        return frame
