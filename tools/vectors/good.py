"""Streams that every decoder must decode, each for one thing that it probes."""

from collections.abc import Callable
from dataclasses import dataclass

from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.static.encoder import encode
from bsm.codec.static.options import EncodeOptions, changed
from tools.surgery import with_header
from tools.vectors.meshes import patch, tetrahedron, together, torus

BASE = EncodeOptions(block_size=30, keep=0.3, step=1 / 256, smoothing=0.0, threads=1)


PAPER: dict[str, object] = {"bits": 12, "key_interval": 0}
"""The coding of the paper."""


@dataclass(frozen=True)
class Good:
    """A stream to be decoded; `make` is called only when vectors are written."""

    probes: str
    make: Callable[[], bytes]


def _static(probes: str, mesh: Callable[[], TriangleMesh], **options: object) -> Good:
    return Good(probes, lambda: encode(mesh(), changed(BASE, **options)))


def _small() -> TriangleMesh:
    return torus(12, 10)


def _onorm(**options: object) -> bytes:
    return encode(_small(), changed(BASE, **PAPER, **options))


STATIC: dict[str, Good] = {
    "good-onorm": _static("Onorm in doubles after two solutions, in one chain", _small, **PAPER, power=2),
    "good-onorm-three": _static("two iterations of three solutions", _small, **PAPER, power=3, iterations=2),
    "good-onorm-panels": _static(
        "Onorm in doubles of columns in several panels, of a key block as well",
        lambda: torus(18, 14),
        **(PAPER | {"key_seed": "cosines", "block_size": 120, "keep": 0.6}),
        power=2,
    ),
    "good-onorm-rest": Good(
        "five solutions, two by two and the last alone", lambda: with_header(_onorm(power=5), onorm=2)
    ),
    "good-onorm-dependent": Good(
        "columns of which eight solutions leave nothing: they are made one by one in doubles",
        lambda: with_header(_onorm(power=8, shift=2.0**-16), onorm=8),
    ),
    "good-onorm-pieces": _static(
        "Onorm in doubles where blocks hold several components",
        lambda: together(torus(7, 6), patch(6, 5), tetrahedron()),
        **PAPER,
        power=2,
    ),
}
