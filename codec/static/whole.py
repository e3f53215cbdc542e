"""What a decoder of meshes ends with."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.static.events import Losses
from bsm.codec.static.stages import Ended


class Whole(Protocol):
    """What a decoder has put together."""

    def mesh(self) -> TriangleMesh:
        """The mesh in its own unit."""

    def losses(self) -> Losses:
        """What of it is missing or less good."""


@dataclass(frozen=True, eq=False)
class Complete(Ended):
    """All that is wanted is there, or known to be lost."""

    whole: Whole
