"""What is asked for each mesh or sequence that becomes a stream."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from bsm.farm.jobs import Task


@dataclass(frozen=True, kw_only=True)
class EncodeJob(Task):
    """What `bsm encode` is asked for."""

    format: str | None = None
    reader: str | None = None
    permutation: str | None = None
    metadata: Mapping[str, str] = field(default_factory=dict)
    wishes: Mapping[str, Any] = field(default_factory=dict)
    threads: int | None = None
    compared: bool = True
    members: tuple[str, ...] = ()
    animation: str | None = None
    cache_mesh: str | None = None
