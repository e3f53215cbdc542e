"""Constants of the format for the decoder in TypeScript, from those that Python has.

python -m tools.web_constants --write    web/src/constants.ts
python -m tools.web_constants            fail if that is not what Python has
"""

from __future__ import annotations

import argparse
from enum import EnumMeta
from pathlib import Path
from typing import Any

from bsm.bitstream.container.header import Field, Header, Paper, defaults_of, fields_of
from bsm.bitstream.container.wire import MAGIC, MAX_VARINT_BYTES, SHORT, VERSION, FrameType
from bsm.bitstream.limits import Limits

TARGET = Path(__file__).parents[1] / "web/src/constants.ts"

_TYPES: dict[tuple[Any, Any], str] = {(tuple, int): "ints", (tuple, float): "floats"}
_PLAIN: dict[Any, str] = {int: "int", float: "float", str: "string", bytes: "binary"}
_OTHER_LIMITS = {"block_memory": "memory", "block_memory_per_vertex": "memory_per_vertex"}
"""Limits that the browser's decoder calls otherwise: its own `memory` is that of the machine in the page."""
_SAME_LIMITS = (
    *("vertices", "faces", "blocks", "block_size", "coefficients", "frames", "gop_frames", "frame_bytes"),
    *("metadata_bytes", "attributes", "attribute_values", "sequence_bytes", "work", "work_per_vertex"),
    "work_per_byte",
    "memory_per_byte",
)


def camel(name: str) -> str:
    """A name as TypeScript has it."""
    first, *others = name.split("_")
    return first + "".join(map(str.capitalize, others))


def _number(value: float) -> str:
    return str(int(value)) if value == int(value) and abs(value) < 2**53 else repr(value)


def _content(value: Any) -> str:
    if isinstance(value, bytes):
        return f"new Uint8Array({len(value)})"
    if isinstance(value, tuple):
        return f"[{', '.join(map(_number, value))}]"
    return _number(value)


def _field(name: str, field: Field, defaults: dict[str, Any]) -> str:
    kind = "method" if field.reserved else _TYPES.get((field.type, field.item)) or _PLAIN[field.type]
    parts = [f"key: {field.key}", f'type: "{kind}"', f"low: {_number(field.low)}", f"high: {_number(field.high)}"]
    if name in defaults:
        parts.append(f"default: {_content(defaults[name])}")
    if field.type is tuple:
        parts.append(f"lengths: [{field.lengths[0]}, {field.lengths[1]}]")
    return f"    {camel(name)}: {{ {', '.join(parts)} }},"


def _fields(called: str, kind: Any, what: str) -> str:
    lines = [_field(name, field, defaults_of(kind)) for name, field in fields_of(kind).items()]
    return "\n".join([f"/** {what} */", f"export const {called} = {{", *lines, "} satisfies Record<string, Field>;"])


def _kinds(kinds: EnumMeta) -> str:
    lines = [f'    {kind.value}: "{kind.name.lower()}",' for kind in kinds]  # type: ignore[var-annotated]
    return "\n".join(["/** Types of frames (F 3.4). */", "export const KINDS = {", *lines, "} as const;"])


def limits_there(limits: Limits) -> dict[str, float]:
    """Limits by the names that the browser's decoder has for them."""
    named = {name: name for name in _SAME_LIMITS} | _OTHER_LIMITS
    return {camel(ours): getattr(limits, theirs) for ours, theirs in named.items()}


def source() -> str:
    """The module."""
    granted = [f"    {name}: {_number(value)}," for name, value in limits_there(Limits()).items()]
    magic = ", ".join(map(str, (*MAGIC, VERSION)))
    return (
        "\n\n".join(
            [
                "/** Constants of the format, which `python -m tools.web_constants --write` makes of Python's. */\n"
                'import type { Field } from "./record";',
                f"/** What a stream begins with: magic and version. */\nexport const PREAMBLE = [{magic}] as const;\n"
                f"/** A payload of fewer bytes has a short checksum (F 3). */\nexport const SHORT = {SHORT};\n"
                f"export const MAX_VARINT_BYTES = {MAX_VARINT_BYTES};",
                _kinds(FrameType),
                _fields("HEADER_FIELDS", Header, "Fields of the header (F 4.4)."),
                _fields("PAPER_FIELDS", Paper, "Numbers of `paper`, by places, and the law's constants (F 4)."),
                "\n".join(
                    ["/** Limits that are Python's (M 14.1). */", "export const LIMITS = {", *granted, "} as const;"]
                ),
            ]
        )
        + "\n"
    )


def main() -> None:
    """Write the module, or compare it."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", action="store_true", help="write it")
    if parser.parse_args().write:
        TARGET.write_text(source())
    elif TARGET.read_text() != source():
        raise SystemExit(f"{TARGET} is not what Python has; run: python -m tools.web_constants --write")


if __name__ == "__main__":
    main()
