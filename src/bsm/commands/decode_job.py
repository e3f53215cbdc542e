"""What one job of `bsm decode` is asked for."""

from __future__ import annotations

from dataclasses import dataclass

from bsm.jobs.task import Task


@dataclass(frozen=True, kw_only=True)
class DecodeJob(Task):
    """What `bsm decode` is asked for."""

    given: str | None = None
    many: bool = False
    format: str | None = None
    blocks: int | None = None
    layers: int | None = None
    permutation: str | None = None
    tolerant: bool = False
    limits: str = "default"
    frames: str | None = None
