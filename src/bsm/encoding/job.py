"""What is asked for each mesh or sequence that becomes a stream."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from bsm.farm.jobs import Task


@dataclass(frozen=True, kw_only=True)
class EncodeJob(Task):
    """What `bsm encode` is asked for.

    Parameters
    ----------
    format : str, optional
        Of the input; None: by its name or content.
    reader : str, optional
        The library that reads it.
    permutation : str, optional
        The file that gets the order of vertices.
    metadata : mapping from str to str
        Added to what the mesh says of itself.
    wishes : mapping
        Keywords of `bsm.options.encode_options`, or of `sequence_options`, except `threads`.
    threads : int, optional
        To use; None: one per core.
    compared : bool
        Whether the error of a sequence is measured.
    members : tuple of str
        The files of all frames, where each was named.
    animation, cache_mesh : str, optional
        Of a glTF the animation, of a cache of points the mesh; see `Wanted`.
    """

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
