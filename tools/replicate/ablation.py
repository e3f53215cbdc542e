"""What each tool of the codec is worth: bytes and decoding time without it, over those with it, for the same promise.

A tool is left out by an option that exists, or by replacing what the encoder calls. What decoders cannot follow is not
decoded, only counted: its decoding time is not known.
"""

from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from functools import partial
from statistics import fmean, median
from typing import Any
from unittest.mock import patch

import numpy as np

from bsm.bitstream.container.gop import GopMethod
from bsm.bitstream.errors import BsmError
from bsm.codec.decoding import decode
from bsm.codec.sequence import gop, step_search
from bsm.codec.sequence.encoder import SequenceEncoder
from bsm.codec.static.choice import blocks, search, table
from bsm.codec.static.encoder import Encoder
from bsm.codec.static.options import EncodeOptions, changed
from bsm.codec.static.ways import in_blocks as coding
from bsm.encoding.options import encode_options, sequence_options
from tools.replicate.fetch import Source
from tools.replicate.rates import Row, by_turns, spread

Patches = Sequence[tuple[Any, str, Any]]


@dataclass(frozen=True)
class Tool:
    """A tool of the codec, and how to do without it: other options of coding, and patches of the encoder."""

    coded: dict[str, Any]
    patches: Patches = ()
    decodes: bool = True
    options: dict[str, Any] | None = None
    against: dict[str, Any] | None = None

    @contextmanager
    def left_out(self) -> Iterator[None]:
        with ExitStack() as stack:
            for owner, name, value in self.patches:
                stack.enter_context(patch.object(owner, name, value))
            if not self.decodes:
                stack.enter_context(patch.object(Encoder, "_verified", lambda _, draft, *__: draft))
            yield


def _ways(*prefixes: str) -> Any:
    """The table of ways without those whose names begin so; all, if none is left."""
    original = table.ways_of

    def ways(*given: Any) -> list[Any]:
        found = original(*given)
        return [way for way in found if not way.name.startswith(prefixes)] or found

    return ways


GRIDS = "grid", "images", "made", "rows", "chosen"
UPRIGHT = np.eye(3).reshape(1, 9)  # a frame along the axes of space instead of along normals
TOOLS: dict[str, Tool] = {
    "blocks (only grids)": Tool({}, [(search, "ways_of", _ways("levels", "blocks"))]),
    "grids (only blocks with refinement)": Tool({}, [(search, "ways_of", _ways(*GRIDS))]),
    "grids that models were made on": Tool({}, [(search, "ways_of", _ways("made"))]),
    "choice of grid places by rate": Tool(
        {}, [(search, "ways_of", _ways("chosen", "rows, chosen"))]
    ),
    "choice of refinement by rate": Tool({}, [(blocks, "PULLED", 1e-9)]),
    "frames along normals": Tool(
        {},
        [(coding, "local_frames", lambda places, _: UPRIGHT.repeat(len(places), axis=0))],
        decodes=False,
    ),
    "unfolding of faces": Tool({}, [(blocks, "UNFOLDED", 0)]),
    "overlap of 5 % (not in the default)": Tool({"overlap": 1.05}),
    "warm start": Tool({"key_interval": 1}),
    "springs and prediction": Tool({"predict": False}),
    "smoothing": Tool({}, [(coding, "SMOOTHING_STEPS", (0.0,))]),
    "z = 3 (z = 1)": Tool({"power": 1}),
    "second iteration of key blocks": Tool({"key_iterations": 1}),
    "parts that both sides derive (METIS, sent)": Tool({"partition": "metis"}),
    "blocks of 450 (of 225)": Tool({"block_size": 225}),
    "mixing of contexts (grid14, fast profile)": Tool(
        {}, options={"grid": 14, "effort": "quick"}, against={"preset": "grid14"}
    ),
    "best effort (not in the default)": Tool({}, options={"effort": "best"}),
}


def _encoded(mesh: Any, tool: Tool | None, options: EncodeOptions) -> tuple[int, bytes | None]:
    """Bytes of a stream without a tool, and the stream where it can be decoded."""
    encoder = Encoder(mesh, options)
    if tool is None:
        data = encoder.encode()
        return len(data), data
    encoder._input = encoder._input.but(options=changed(options, **tool.coded))
    with tool.left_out():
        data = encoder.encode()
    return len(data), data if tool.decodes else None


def ablate_mesh(source: Source) -> Row:
    """Bytes and decoding seconds with everything, and without each tool."""
    mesh, usual = source.mesh(), encode_options(threads=1)
    found: dict[str, Any] = {}
    whole: dict[str, tuple[int, bytes | None]] = {}
    for name, tool in TOOLS.items():
        options = encode_options(threads=1, **tool.options) if tool.options else usual
        try:
            if (against := str(tool.against)) not in whole:
                everything = encode_options(threads=1, **tool.against) if tool.against else usual
                whole[against] = _encoded(mesh, None, everything)
            size, data = whole[against]
            without, other = _encoded(mesh, tool, options)
        except BsmError as error:
            found[name] = {"failed": str(error)}
            continue
        found[name] = {"bytes": without / size}
        if data is not None and other is not None:
            found[name]["decode"] = 1.0 if other == data else _decode_ratio(other, data)
    return {
        "mesh": source.name,
        "group": source.group,
        "vertices": len(mesh.positions),
        "tools": found,
    }


def _decode_ratio(first: bytes, second: bytes) -> float:
    """Seconds to decode one over those for another, by turns."""
    seconds = by_turns(
        {str(k): partial(decode, data, threads=1) for k, data in enumerate((first, second))}
    )
    return seconds["0"] / seconds["1"]


MOVING_TOOLS: dict[str, Tool] = {
    "prediction of groups of 16 frames": Tool(
        {"gop": 16},
        [(gop.GopEncoder, "method_with_basis", lambda *_: GopMethod.LEARNT)],
        against={"gop": 16},
    ),
    "temporal basis of whole groups (8 frames at a time)": Tool({"low_delay": 8}),
    "frames evened by visible error": Tool({}, [(step_search, "_evening", np.ones_like)]),
    "groups of 512 (of 16)": Tool({"gop": 16}),
}


def ablate_motion(frames: Any, faces: Any) -> dict[str, float]:
    """Bytes without each tool over those with it, for a look of 1 in each frame."""

    def size(**changes: Any) -> int:
        options = sequence_options(threads=1, look=1.0, **changes)
        return len(
            b"".join(
                SequenceEncoder(faces, replace(options, frame_rate=25.0), len(frames)).chunks(
                    frames
                )
            )
        )

    found, whole = {}, size()
    for name, tool in MOVING_TOOLS.items():
        with tool.left_out():
            without = size(**tool.coded)
        found[name] = without / (size(**tool.against) if tool.against else whole)
    return found


COLUMNS = (
    "tool left out", "meshes", "mean", "quartile", "median", "quartile", "largest", "its mesh", "differ",
    "mean in blocks", "decoding",
)  # fmt: skip
LITTLE = 1.005
"""Tools that save less in the mean are named."""


def ablation_table(rows: Sequence[Row]) -> list[tuple[str, ...]]:
    """A line for each tool: bytes over those of everything, of how many the stream is another one, decoding time."""
    found = []
    for name in TOOLS:
        entries = [
            (row["tools"][name], row) for row in rows if "bytes" in row["tools"].get(name, {})
        ]
        if not entries:
            continue
        _, _, *cells = spread(name, "", [(entry["bytes"], row["mesh"]) for entry, row in entries])
        blocks = [entry["bytes"] for entry, row in entries if in_blocks(row)]
        other = [entry for entry, _ in entries if entry["bytes"] != 1.0]
        times = [entry["decode"] for entry in other if "decode" in entry]
        mean, seconds = (
            f"{of(numbers):.3f}" if numbers else "-"
            for of, numbers in ((fmean, blocks), (median, times))
        )
        found.append((name, *cells, str(len(other)), mean, seconds))
    return found


def in_blocks(row: Row) -> bool:
    """Whether the default codes this mesh in blocks: without them it would take other bytes."""
    return bool(row["tools"]["blocks (only grids)"].get("bytes", 1.0) != 1.0)


def ablation_note(rows: Sequence[Row]) -> str:
    """What the table counts, and which tools save little."""
    lines = ablation_table(rows)
    little = [
        line[0] for line in lines if float(line[2]) < LITTLE and not line[0].endswith("default)")
    ]
    idle = [
        line[0]
        for line in lines
        if line[-2] != "-" and float(line[-2]) < LITTLE and line[0] in little
    ]
    vertices = [row["vertices"] for row in rows]
    return (
        f"{len(rows)} fetched meshes, of {min(vertices):,} to {max(vertices):,} vertices. "
        f"{sum(map(in_blocks, rows))} of them are coded in blocks, the others on grids. Bytes without the tool are "
        "over those of the default, for the same promise, a look of 1: above 1 the tool saves so much. The encoder "
        "chooses among the ways that are left, so tools of blocks count nothing where a grid wins. The column "
        '"differ" counts meshes whose stream becomes another one. Decoding is processor time of one thread over that '
        "of the default, the median over meshes that differ. A dash: no decoder follows, or nothing differs. "
        f"Worth less than {100 * (LITTLE - 1):.1f} % in the mean: {'; '.join(little) or 'none'}. "
        f"Of these, also where blocks are coded: {'; '.join(idle) or 'none'}."
    )
