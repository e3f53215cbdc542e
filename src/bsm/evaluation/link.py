"""When it pays to send fewer bytes that take longer to decode: the bandwidth at which two codecs are as quick."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass

from bsm.bitstream.errors import CorruptError
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.metrics import Reference
from bsm.codec.static.decoder import decode
from bsm.codec.static.encoder import Encoder
from bsm.codec.static.options import EncodeOptions
from bsm.codec.static.targets import Target
from bsm.evaluation.draco import decode_draco, encode_draco, positions_in_order

DRACO_LEVEL = 10
THETA = 7.0
"""Mean angle between normals, in degrees, that both codecs have to keep."""


@dataclass(frozen=True)
class Delivery:
    """A file, the mean angle that it keeps, and the seconds to decode it with all threads."""

    size: int
    theta_deg: float
    seconds: float


def break_even(ours: Delivery, theirs: Delivery) -> float:
    """Megabits per second below which `ours` is there and decoded first; infinite where it always is, 0 where never."""
    saved, spent = 8 * (theirs.size - ours.size), ours.seconds - theirs.seconds
    if saved <= 0:
        return 0.0 if spent >= 0 else math.nan
    return saved / spent / 1e6 if spent > 0 else math.inf


def deliveries(mesh: TriangleMesh, repeats: int, theta: float = THETA) -> tuple[Delivery, Delivery]:
    """The smallest file of ours, and of Draco (level 10), that keeps the angle."""
    encoder = Encoder(mesh, EncodeOptions(target=Target("theta_deg", theta)))
    ours = encoder.encode()
    order, reference = encoder.vertex_order, Reference(mesh.positions, mesh.faces)
    found = Reference(mesh.positions[order], decode(ours).faces).theta(decode(ours).positions)
    bits, theirs, kept = 5, b"", math.inf
    while kept > theta:
        bits += 1
        theirs = encode_draco(mesh, bits, DRACO_LEVEL)
        kept = reference.theta(positions_in_order(mesh, decode_draco(theirs), bits))
    if found > theta:
        raise CorruptError(f"asked for {theta:g} degrees, the decoded mesh has {found:g}")
    return (
        Delivery(len(ours), found, _fastest(lambda: decode(ours), repeats)),
        Delivery(len(theirs), kept, _fastest(lambda: decode_draco(theirs), repeats)),
    )


def _fastest(work: Callable[[], object], repeats: int) -> float:
    best = math.inf
    for _ in range(repeats + 1):
        begin = time.perf_counter()
        work()
        best = min(best, time.perf_counter() - begin)
    return best
