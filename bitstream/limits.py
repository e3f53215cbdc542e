"""How much memory and work a caller grants to a decoder."""

from __future__ import annotations

from dataclasses import dataclass

from bitstream.errors import LimitError


@dataclass(frozen=True)
class Limits:
    """Upper bounds that a decoder checks before it allocates or works; raise them with `dataclasses.replace`.

    The defaults admit a mesh of sixteen million vertices and refuse a stream that only claims to hold one
    (counts are also checked against the bytes that are present).
    """

    vertices: int = 1 << 24
    faces: int = 1 << 25
    blocks: int = 1 << 17
    block_size: int = 8192
    coefficients: int = 4096
    frames: int = 1 << 20
    gop_frames: int = 1024
    frame_bytes: int = 1 << 28
    metadata_bytes: int = 1 << 23
    work: float = 5e13
    """Floating point operations of the dictionaries, by the estimate of the specification."""
    sequence_bytes: float = 1 << 31
    """Memory for the dictionaries of a sequence, and for the coefficients of a GOP."""
    field_bytes: float = 1 << 32
    """Memory for decoding a grid or a layer of refinement, or the values of an attribute."""
    attributes: int = 255
    attribute_values: int = 1 << 28
    """Numbers of all attributes of a mesh: values times their components."""

    def check(self, name: str, value: float) -> None:
        """Raise `LimitError` if `value` exceeds the limit called `name`."""
        bound = getattr(self, name)
        if value > bound:
            raise LimitError(
                f"{name} = {value:g} is over the limit of {bound:g}; if you trust the source, raise Limits.{name}"
            )


DEFAULT_LIMITS = Limits()
