"""What belongs to all frames of a sequence that is written."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

from bsm.codec.arrays import Faces, Positions
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import Metadata, TriangleMesh


@dataclass(frozen=True, eq=False)
class Told:
    """What belongs to all frames."""

    attributes: Callable[[], tuple[Attribute, ...]] = tuple
    metadata: Callable[[], Metadata] = dict
    left_out: list[str] = field(default_factory=list)
    _begun: dict[str, Attribute] = field(default_factory=dict)

    @property
    def frame_rate(self) -> float:
        """Frames per second; 0: not known."""
        rate = self.metadata().get("frame_rate")
        return float(rate) if isinstance(rate, int | float) and 0 < rate < float("inf") else 0.0

    def mesh(self, positions: Positions, faces: Faces, *, with_metadata: bool = True) -> TriangleMesh:
        """The mesh of a frame, with everything."""
        return TriangleMesh(positions, faces, self.attributes(), self.metadata() if with_metadata else {})

    def moved(self) -> tuple[Attribute, ...]:
        """Attributes that are others now than they were when this was asked first."""
        now = self.attributes()
        return tuple(one for one in now if self._begun.setdefault(one.name, one) is not one)

    def loses(self, names: Iterable[str]) -> None:
        """Take note of what cannot be held."""
        self.left_out.extend(name for name in dict.fromkeys(names) if name not in self.left_out)
