"""A mesh, coded: what the stream will hold, and what its decoder will make of it."""

from collections.abc import Iterator
from dataclasses import dataclass

from bsm.bitstream.container import packets
from bsm.bitstream.container.header import Header
from bsm.bitstream.container.packets import Packet
from bsm.bitstream.container.writer import Writer
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Levels, Positions
from bsm.codec.static.units import checksum_of


@dataclass(frozen=True, eq=False)
class Draft:
    """A stream that might be written."""

    header: Header
    body: tuple[Packet, ...]
    decoded: Positions
    places: Levels | None = None

    @cached_property
    def frames(self) -> tuple[bytes, ...]:
        return tuple(self._write())

    @property
    def size(self) -> int:
        return sum(map(len, self.frames))

    @property
    def coefficients(self) -> tuple[int, ...]:
        """c_i of each block."""
        return tuple(packet.coefficients for packet in self.body if isinstance(packet, packets.Block))

    def _write(self) -> Iterator[bytes]:
        writer = Writer()
        yield writer.start()
        for packet in (self.header, *self.body):
            yield writer.write(packet)
        yield writer.end(checksum_of(self.decoded))
