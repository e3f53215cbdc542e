"""Constants of the format for the decoder in TypeScript, from those that Python has.

python -m tools.web_constants --write    web/src/constants.ts
python -m tools.web_constants            fail if that is not what Python has
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from bsm.bitstream.container.header import HEADER_DEFAULTS, HEADER_FIELDS, Field
from bsm.bitstream.container.wire import MAGIC, MAX_VARINT_BYTES, SHORT, VERSION, FrameType
from bsm.bitstream.limits import Limits

TARGET = Path(__file__).parents[1] / "web/src/constants.ts"

_PLAIN: dict[Any, str] = {int: "int", float: "float"}
_OF_A_BUILD = ("vertices", "attributes", "light", "sequence", "paper", "congruence")
"""Fields that tell which decoder a stream needs."""
_IN_A_GRID = ("HEADER", "METADATA", "CONNECTIVITY", "GRID", "END")
"""Frames of a stream on a light grid."""
_OF_A_GRID = ("vertices", "faces", "center", "scale", "grid", "lattice", "corner", "light")
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


def _field(name: str, field: Field) -> str:
    kind = _PLAIN[field.item if field.type is tuple else field.type]
    parts = [f"key: {field.key}", f'type: "{kind}"', f"low: {_number(field.low)}", f"high: {_number(field.high)}"]
    if name in HEADER_DEFAULTS:
        usual: Any = HEADER_DEFAULTS[name]
        numbers = f"[{', '.join(map(_number, usual))}]" if isinstance(usual, tuple) else _number(usual)
        parts.append(f"default: {numbers}")
    if field.type is tuple:
        parts.append(f"lengths: [{field.lengths[0]}, {field.lengths[1]}]")
    return f"{{ {', '.join(parts)} }}"


def _table(called: str, what: str, entries: dict[Any, str]) -> str:
    lines = [f"    {name}: {content}," for name, content in entries.items()]
    return "\n".join([f"/** {what} */", f"export const {called} = {{", *lines, "} as const;"])


def limits_there(limits: Limits) -> dict[str, float]:
    """Limits by the names that the browser's decoder has for them."""
    named = {name: name for name in _SAME_LIMITS} | _OTHER_LIMITS
    return {camel(ours): getattr(limits, theirs) for ours, theirs in named.items()}


def source() -> str:
    """The module."""
    magic = ", ".join(map(str, (*MAGIC, VERSION)))
    kinds = {FrameType[name].value: f'"{name.lower()}"' for name in _IN_A_GRID}
    keys = {name: str(HEADER_FIELDS[name].key) for name in _OF_A_BUILD}
    fields = {name: _field(name, HEADER_FIELDS[name]) for name in _OF_A_GRID}
    granted = {name: _number(value) for name, value in limits_there(Limits()).items()}
    parts = [
        "/** Constants of the format, which `python -m tools.web_constants --write` makes of Python's. */",
        f"/** What a stream begins with: magic and version. */\nexport const PREAMBLE = [{magic}] as const;\n"
        f"/** A payload of fewer bytes has a short checksum (F 3). */\nexport const SHORT = {SHORT};\n"
        f"export const MAX_VARINT_BYTES = {MAX_VARINT_BYTES};",
        _table("KINDS", "Types of frames of a light grid (F 3.4).", kinds),
        _table("HEADER_KEYS", "Keys of the fields that tell which decoder a stream needs (F 4.4).", keys),
        _table("GRID_FIELDS", "The header of a light grid (F 4.4, F 4.6).", fields),
        _table("LIMITS", "Limits that are Python's (M 14.1).", granted),
    ]
    return "\n\n".join(parts) + "\n"


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
