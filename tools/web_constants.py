"""Constants of the format for the decoder in TypeScript, from those that Python has.

python -m tools.web_constants --write    web/src/constants.json
python -m tools.web_constants            fail if that is not what Python has
"""

import json
from dataclasses import MISSING
from pathlib import Path
from typing import Any

from bsm.bitstream.container.header import HEADER_FIELDS, Field
from bsm.bitstream.container.wire import MAGIC, MAX_VARINT_BYTES, SHORT, VERSION, FrameType
from bsm.bitstream.limits import Limits
from tools.command import parser_of

TARGET = Path(__file__).parents[1] / "web/src/constants.json"

_IN_A_GRID = ("HEADER", "METADATA", "CONNECTIVITY", "GRID", "END")
"""Frames of a stream on a light grid."""
_OF_A_GRID = (
    "vertices",
    "faces",
    "center",
    "scale",
    "grid",
    "lattice",
    "corner",
    "light",
    "congruence",
)
_OTHER_LIMITS = {"block_memory": "memory", "block_memory_per_vertex": "memory_per_vertex"}
"""Limits that the browser's decoder calls otherwise: its own `memory` is that of the machine in the page."""
_SAME_LIMITS = (
    *(
        "vertices",
        "faces",
        "blocks",
        "block_size",
        "coefficients",
        "frames",
        "gop_frames",
        "frame_bytes",
    ),
    *(
        "metadata_bytes",
        "attributes",
        "attribute_values",
        "sequence_bytes",
        "work",
        "work_per_vertex",
    ),
    "work_per_byte",
    "memory_per_byte",
)


def camel(name: str) -> str:
    """A name as TypeScript has it."""
    first, *others = name.split("_")
    return first + "".join(map(str.capitalize, others))


def _field(field: Field) -> dict[str, Any]:
    found = {"key": field.key, "type": field.item.__name__, "low": field.low, "high": field.high}
    found |= {} if field.default is MISSING else {"default": field.default}
    return found | ({"lengths": field.lengths} if field.type is tuple else {})


def limits_there(limits: Limits) -> dict[str, float]:
    """Limits by the names that the browser's decoder has for them."""
    named = {name: name for name in _SAME_LIMITS} | _OTHER_LIMITS
    return {camel(ours): getattr(limits, theirs) for ours, theirs in named.items()}


def source() -> str:
    """The file."""
    found = {
        "PREAMBLE": [*MAGIC, VERSION],
        "SHORT": SHORT,
        "MAX_VARINT_BYTES": MAX_VARINT_BYTES,
        "KINDS": {FrameType[name].value: name.lower() for name in _IN_A_GRID},
        "HEADER_KEYS": {camel(name): field.key for name, field in HEADER_FIELDS.items()},
        "GRID_FIELDS": {name: _field(HEADER_FIELDS[name]) for name in _OF_A_GRID},
        "LIMITS": limits_there(Limits()),
    }
    return json.dumps(found, indent=4, allow_nan=False) + "\n"


def main() -> None:
    """Write the file, or compare it."""
    parser = parser_of(__doc__)
    parser.add_argument("--write", action="store_true", help="write it")
    if parser.parse_args().write:
        TARGET.write_text(source())
    elif TARGET.read_text() != source():
        raise SystemExit(
            f"{TARGET} is not what Python has; run: python -m tools.web_constants --write"
        )


if __name__ == "__main__":
    main()
