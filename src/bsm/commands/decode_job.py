"""What one job of `bsm decode` is asked for."""

from __future__ import annotations

from dataclasses import dataclass

from bsm.farm.jobs import Task


@dataclass(frozen=True, kw_only=True)
class DecodeJob(Task):
    """What `bsm decode` is asked for.

    Parameters
    ----------
    given : str, optional
        The output as it was named; None: it was not.
    many : bool
        Whether this is one of several inputs.
    format : str, optional
        Of the output; None: by its name.
    blocks, layers : int, optional
        Where to stop.
    permutation : str, optional
        The file that has the order of the input's vertices.
    tolerant : bool
        Go on behind damage.
    limits : str
        What the stream may cost.
    frames : str, optional
        Of a sequence, A:B.
    """

    given: str | None = None
    many: bool = False
    format: str | None = None
    blocks: int | None = None
    layers: int | None = None
    permutation: str | None = None
    tolerant: bool = False
    limits: str = "default"
    frames: str | None = None
