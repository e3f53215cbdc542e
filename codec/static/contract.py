"""What an encoder promises of a decoded mesh, whatever the mesh."""

import math
from dataclasses import dataclass

from bsm.bitstream.errors import OptionError, public
from bsm.codec.geometry.metrics import decibel

ANY_ANGLE = 180.0
WIDEST = 0.1  # of the diagonal: who asks for a wider bound took one unit for another


def _refuse_wide(what: str, share: float) -> None:
    if share > WIDEST:
        raise OptionError(
            f"{what} may be at most {WIDEST:.0%} of the bounding box's diagonal away, not {share:.4g} times it; a "
            "number without a unit is a share of the diagonal: 0.001 is 0.1%"
        )


@public
@dataclass(frozen=True)
class Contract:
    """Bounds that a decoded mesh keeps.

    Parameters
    ----------
    farthest : float
        How far any vertex may come to lie from its place. The Hausdorff distance of the surfaces is no larger.
    angle : float
        Mean angle between corresponding normals, degrees, faces counted by their area; 180: any.
    absolute : bool
        `farthest` is in the mesh's unit, and not relative to the diagonal of its bounding box.
    look : float
        Distance in pictures (`codec.look`): 1 looks the same; infinite: any.
    alike : bool
        In `angle` all faces count alike, whatever their area.
    visual : float
        Normalised mean visual error (`codec.geometry.metrics.nmsve`); infinite: any.
    by_part : float
        The same as `farthest`, always over diagonals, and each connected part by its own: down to a tenth of what it is
        for the whole; parts near each other keep their order in depth. Infinite: no such bound.

    Raises
    ------
    OptionError
        If a bound is not positive.

    Examples
    --------
    >>> import bsm
    >>> promise = bsm.Contract(0.005, look=2.0)  # 0.5 % of the diagonal, and a look of 2
    >>> data = bsm.encode("bunny.ply", bsm.EncodeOptions(contract=promise))
    """

    farthest: float
    angle: float = ANY_ANGLE
    absolute: bool = False
    look: float = math.inf
    by_part: float = math.inf
    alike: bool = False
    visual: float = math.inf

    def __post_init__(self) -> None:
        if not 0.0 < self.farthest < float("inf"):
            raise OptionError(f"a bound on the farthest vertex must be above 0, not {self.farthest:g}")
        if not self.absolute:
            _refuse_wide("the farthest vertex", self.farthest)
        if not 0.0 < self.angle <= ANY_ANGLE:
            raise OptionError(f"a mean angle must be within 0 to {ANY_ANGLE:g} degrees, not {self.angle:g}")
        if not self.visual > 0.0:
            raise OptionError(f"a visual error must be above 0, not {self.visual:g}")
        if not self.by_part > 0.0:
            raise OptionError(f"a bound on the vertices of a part must be above 0, not {self.by_part:g}")
        if not self.look > 0.0:
            raise OptionError(f"a look must be above 0, not {self.look:g}: 1 looks the same, 3 is a preview")

    def reach(self, diagonal: float, unit: float) -> float:
        """How far a vertex of a mesh of this diagonal may come to lie from its place, in multiples of `unit`.

        Raises
        ------
        OptionError
            If that is so far that nothing of the mesh would be left to be recognised.
        """
        if self.absolute and diagonal > 0.0:
            _refuse_wide(f"a bound of {self.farthest:g}", self.farthest / diagonal)
        return (self.farthest if self.absolute else self.farthest * diagonal) / unit

    def worded(self, farther: float, angle: float, look: float, visual: float) -> str:
        """The bounds that are broken, in words: a vertex so many times as far as it may be; degrees; looks; error."""
        broken = []
        if farther > 1.0:
            broken.append(f"no vertex farther than {self.farthest * farther:.4g}")
        if angle > self.angle:
            broken.append(f"normals {angle:.4g} degrees wrong on average")
        if self.look < look < math.inf:  # infinite: nobody looked
            broken.append(f"a look of {look:.3g}")
        if visual > self.visual:
            broken.append(f"a visual error of {decibel(visual):.6g} dB")
        return " and ".join(broken)

    def __str__(self) -> str:
        bound = f"no vertex farther than {self.farthest:.4g}" + ("" if self.absolute else " diagonals")
        angle = f", normals {self.angle:g} degrees wrong on average" if self.angle < ANY_ANGLE else ""
        visual = f", a visual error of {decibel(self.visual):.6g} dB" if self.visual < math.inf else ""
        return bound + angle + visual + (f", a look of {self.look:g}" if self.look < math.inf else "")
