"""Keywords of `bsm.encode` and its kin, for type checkers; `bsm.options` checks them when a program runs."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, TypedDict

if TYPE_CHECKING:
    from bsm.codec.static.options import Paper
    from bsm.codec.static.targets import Contract, Target

class _Shared(TypedDict, total=False):
    preset: str | None
    attributes: Mapping[str, str] | tuple[tuple[str, str], ...]
    block_size: int
    effort: str
    keep_order: bool
    limits: str
    look: float | None
    max_error: float | str | None
    nmsve_db: float | None
    overlap: float
    theta: float | None
    threads: int | None

class OptionKeywords(_Shared, total=False):
    """Keywords of meshes, as `EncodeOptions` and `Paper` have them, and targets."""

    bits: int | None
    bpv: float | None
    coefficients: int | None
    contract: Contract | None
    doi: tuple[float, float] | None
    exact: bool
    congruence: bool
    grid: int | None
    grid_cell: float | None
    grid_origin: tuple[float, float, float] | None
    iterations: int
    keep: float | None
    key_interval: int
    key_iterations: int
    key_seed: str | None
    normals: str
    paper: Paper
    partition: str
    power: int
    predict: bool
    shift: float
    size: int | str | None
    smoothing: float | None
    step: float | None
    target: Target | None

class EncodeKeywords(OptionKeywords, total=False):
    """Keywords of `bsm.save`."""

    simplify: bool
    progress: Callable[[int, int], None] | None

class SequenceKeywords(_Shared, total=False):
    """Keywords of sequences, as `SequenceOptions` has them, and targets."""

    bpvf: float | None
    first_step: float | None
    frame_rate: float
    gop: int | None
    keep: float
    kg: float | None
    low_delay: int
    promise: Contract | None
    runs: bool
    step: float
    target: Target | None

class DenoiseKeywords(TypedDict, total=False):
    """Keywords of `bsm.denoise`, as `DenoiseOptions` has them."""

    block_size: int
    fine: str
    hand_over: str
    iterations: int | None
    keep: float
