"""Our codec and Draco behind one interface: settings in, a whole file out, and positions in the original's order."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass, fields
from typing import Any, Protocol

from bsm.bitstream.limits import NAMED_LIMITS
from bsm.codec.arrays import Positions
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.static.decoder import decode
from bsm.codec.static.encoder import Encoder
from bsm.codec.static.options import EncodeOptions
from bsm.codec.static.targets import Target
from bsm.evaluation.draco import decode_draco, encode_draco, positions_in_order
from bsm.files.stream import inspect_stream


@dataclass(frozen=True, eq=False)
class Coded:
    """A whole file, and how to compare what comes out of it with what went in."""

    data: bytes
    align: Callable[[TriangleMesh], Positions]


@dataclass(frozen=True)
class Breakdown:
    """Where the bytes of a file went, as far as its format tells."""

    connectivity: int | None = None
    partition: int | None = None
    order: int | None = None
    coefficients: int | None = None
    framing: int | None = None
    bpv_paper: float | None = None


class Codec(Protocol):
    """A codec at one setting."""

    @property
    def settings(self) -> dict[str, Any]:
        """What tells this setting from others, ready for JSON."""

    def encode(self, mesh: TriangleMesh) -> Coded:
        """Encode a mesh whose vertices are all used by faces."""

    def decode(self, data: bytes) -> TriangleMesh:
        """Decode a whole file, vertices in the file's order."""

    def breakdown(self, data: bytes) -> Breakdown:
        """Take a file apart."""


@dataclass(frozen=True)
class Spectral:
    """This project's codec; on one thread, so that times compare."""

    options: EncodeOptions

    @property
    def settings(self) -> dict[str, Any]:
        """The options that are not the defaults, and the step where it counts; not what decoders grant."""
        names = (item.name for item in fields(EncodeOptions) if item.name != "limits")
        values = {name: getattr(self.options, name) for name in names}
        defaults = EncodeOptions()
        changed = {name: value for name, value in values.items() if value != getattr(defaults, name)}
        if self.options.target is not None:
            return {**changed, "target": asdict(self.options.target)}
        return changed if self.options.bits else {"step": self.options.first_step, **changed}

    def encode(self, mesh: TriangleMesh) -> Coded:
        """Encode; the encoder itself knows the order of the vertices."""
        encoder = Encoder(mesh, self.options)

        def align(decoded: TriangleMesh) -> Positions:
            if self.options.keep_order:
                return decoded.positions
            return decoded.positions[encoder.vertex_index]

        return Coded(encoder.encode(), align)

    def decode(self, data: bytes) -> TriangleMesh:
        """Decode on as many threads as the encoder was given."""
        return decode(data, NAMED_LIMITS[self.options.limits](), self.options.threads)

    def breakdown(self, data: bytes) -> Breakdown:
        """What `bsm info` shows."""
        info = inspect_stream(iter([data]))
        return Breakdown(
            info.connectivity, info.partition, info.order, info.coefficient_bytes, info.framing, info.bpv_paper
        )


@dataclass(frozen=True)
class Draco:
    """Draco's edgebreaker through DracoPy."""

    position_bits: int
    levels: tuple[int, ...] = (10,)

    @property
    def settings(self) -> dict[str, Any]:
        """Bits and levels."""
        return {"position_bits": self.position_bits, "levels": list(self.levels)}

    def encode(self, mesh: TriangleMesh) -> Coded:
        """Encode; the order of the vertices is found when it is asked for."""
        data = min((encode_draco(mesh, self.position_bits, level) for level in self.levels), key=len)
        return Coded(data, lambda decoded: positions_in_order(mesh, decoded, self.position_bits))

    def decode(self, data: bytes) -> TriangleMesh:
        """Positions that a stream of this codec holds."""
        return decode_draco(data)

    def breakdown(self, data: bytes) -> Breakdown:
        """Draco does not tell."""
        return Breakdown()


@dataclass(frozen=True)
class Curve:
    """A codec at several operating points: one line of a plot, one JSON file per mesh."""

    name: str
    label: str
    codecs: tuple[Codec, ...]


PAPER_KEEPS = (0.05, 0.10, 0.15, 0.20, 0.25)
PAPER_THRESHOLDS = (0.14, 0.1, 0.07, 0.05, 0.035)
"""eps_h of dynamic orthogonal iterations; eps_l is a tenth less."""


EXACT_BASES: dict[str, Any] = {"key_interval": 1, "key_seed": "svd"}
"""Every block in its exact basis, as by SVD."""
COLD_STARTS: dict[str, Any] = {"key_interval": 1, "key_seed": "cosines", "key_iterations": 1}
"""Every block by one orthogonal iteration from cosines."""


def paper_options(**changes: Any) -> EncodeOptions:
    """The paper's mode: METIS, 12 bits for every coefficient, one chain."""
    settings: dict[str, Any] = {"partition": "metis", "bits": 12, "key_interval": 0, "power": 1}
    return EncodeOptions(**{**settings, "threads": 1, "limits": "wide", **changes})


def paper_curves(block_size: int = 500, keeps: tuple[float, ...] = PAPER_KEEPS) -> tuple[Curve, ...]:
    """The lines of the paper's rate-distortion figure: full SVD, orthogonal iterations of several kinds, and DOI."""
    dynamic = (
        Spectral(paper_options(keep=0.4, block_size=block_size, doi=(0.9 * threshold, threshold)))
        for threshold in PAPER_THRESHOLDS
    )
    lines: tuple[tuple[str, str, dict[str, Any]], ...] = (
        ("svd", "SVD", EXACT_BASES),
        ("oi-r1", "OI, R", {}),
        ("oi-r1-t2", "OI, R, 2 iterations", {"iterations": 2}),
        ("oi-r1-t3", "OI, R, 3 iterations", {"iterations": 3}),
        ("oi-r2", "OI, R²", {"power": 2}),
        ("oi-r3", "OI, R³", {"power": 3}),
        ("oi-r4", "OI, R⁴", {"power": 4}),
        ("oi-r1-cold", "OI, R, no warm start", COLD_STARTS),
        ("oi-r2-cold", "OI, R², no warm start", COLD_STARTS | {"power": 2}),
    )
    fixed = (
        Curve(
            name,
            label,
            tuple(Spectral(paper_options(keep=keep, block_size=block_size, **changes)) for keep in keeps),
        )
        for name, label, changes in lines
    )
    return (*fixed, Curve("doi-r1", "DOI, R", tuple(dynamic)))


OUR_STEPS = (2.4e-2, 1.6e-2, 1.1e-2, 8e-3, 5.5e-3, 4e-3, 2.8e-3, 2e-3, 1.3e-3, 8e-4)


FINE_STEP = 4e-3
OUR_ANGLES = (3.0, 2.0, 1.2, 0.7, 0.4, 0.2)
"""Below this step, and at these mean angles of normals in degrees, blocks alone are no longer the smallest way."""


def our_curve(*, fine: bool = False, **changes: Any) -> Curve:
    """The product at a ladder of steps, everything else its defaults; with `fine`, at angles instead of fine steps."""
    steps = [step for step in OUR_STEPS if not fine or step >= FINE_STEP]
    codecs = [Spectral(EncodeOptions(**{"threads": 1, "step": step, **changes})) for step in steps]
    if fine:
        codecs += [Spectral(EncodeOptions(threads=1, target=Target("theta_deg", angle))) for angle in OUR_ANGLES]
    return Curve("ours", "ours", tuple(codecs))


def draco_curve() -> Curve:
    """Draco at 6 to 14 bits per coordinate; level 10, below nine bits level 7 where it is smaller."""
    return Curve("draco", "Draco", tuple(Draco(bits, (7, 10) if bits < 9 else (10,)) for bits in range(6, 15)))
