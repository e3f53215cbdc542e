"""What the paper's method carries in default streams: bytes of blocks, and the same streams without them."""

import math
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from unittest.mock import patch

from bsm.bitstream.errors import BsmError
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.static.encoder import Encoder
from bsm.codec.static.options import EncodeOptions, changed
from bsm.codec.static.ways.in_blocks import InBlocks
from bsm.encoding.options import encode_options
from bsm.files.inspection import StreamInfo, inspect_stream
from tools.replicate.fetch import Source
from tools.replicate.rates import Row

WIDTHS = (1, 8, 16, 35, 70, 140)
"""Values of c that are tried in every block."""
COARSE: dict[str, dict[str, Any]] = {
    "small": {"preset": "small"},
    "-40 dB": {"preset": "none", "nmsve_db": -40.0},
}
"""Coarse settings: a preview, and a target."""
COARSE_MESHES = 5
ONLY_MEANS = 1


@contextmanager
def fixed_width(width: int) -> Iterator[None]:
    """Let every block have this c, as far as it has rows."""
    begin = InBlocks.__init__

    def begin_with_width(self: InBlocks, prepared: Any, options: EncodeOptions, *more: Any) -> None:
        begin(self, prepared, changed(options, coefficients=width), *more)

    with patch.object(InBlocks, "__init__", begin_with_width):
        yield


def stream_of(mesh: TriangleMesh, **keywords: Any) -> tuple[int, StreamInfo]:
    """Bytes of a stream, and what is in it."""
    data = Encoder(mesh, encode_options(threads=1, **keywords)).encode()
    return len(data), inspect_stream(iter([data]))


def share_mesh(source: Source) -> Row:
    """Shares of a default stream; its bytes with means in place of blocks, and in the paper's mode."""
    mesh = source.mesh()
    size, info = stream_of(mesh)
    row: Row = {
        "mesh": source.name,
        "vertices": len(mesh.positions),
        "bytes": size,
        "base": bool(info.header.base),
    }
    if not info.header.base:
        return row
    kinds = info.positions
    shape = info.sizes["connectivity"] + kinds["blocks"] + kinds["levels_of_cells"]
    with fixed_width(ONLY_MEANS):
        without, _ = stream_of(mesh)
    paper, _ = stream_of(mesh, preset="paper")
    sizes = {"size": info.header.blocks, "c": [min(info.coefficients), max(info.coefficients)]}
    return row | {"positions": kinds, "shape": shape, "without": without, "paper": paper, **sizes}


def widths_of_mesh(source: Source) -> Row:
    """Bytes of coarse streams by c, over those of the codec's own c."""
    mesh, ratios = source.mesh(), dict[str, list[float]]()
    for name, keywords in COARSE.items():
        own, _ = stream_of(mesh, **keywords)
        for width in WIDTHS:
            try:
                with fixed_width(width):
                    size, _ = stream_of(mesh, **keywords)
                ratio = size / own
            except BsmError:
                ratio = math.nan  # so few coefficients do not reach the target
            ratios.setdefault(name, []).append(ratio)
    return {"mesh": source.name, "vertices": len(mesh.positions), "widths": ratios}


def share_lines(rows: Iterable[Row]) -> list[str]:
    """A line of Markdown for each scan that is coded on cells."""
    lines = []
    for row in rows:
        if not row["base"]:
            continue
        total, kinds = row["bytes"], row["positions"]
        parts = [kinds["blocks"], kinds["levels_of_cells"], kinds["levels_of_vertices"]]
        shares = [f"{100 * part / total:.1f} %" for part in parts]
        beside = [
            f"{100 * row['shape'] / total:.0f} %",
            f"{row['without'] / total:.3f}",
            f"{row['paper']:,}",
        ]
        cells = [
            row["mesh"],
            f"{row['vertices']:,}",
            f"{total:,}",
            f"{parts[0]:,}",
            *shares,
            *beside,
        ]
        lines.append(f"| {' | '.join(cells)} |")
    return lines


def width_lines(rows: Sequence[Row]) -> list[str]:
    """A line for each setting: the least and the largest ratio over meshes, by c."""
    lines = []
    for name in COARSE:
        columns = zip(*(row["widths"][name] for row in rows), strict=True)
        cells = [span_of(column, 3) for column in columns]
        lines.append(f"| {name} | {' | '.join(cells)} |")
    return lines


def span_of(values: Iterable[float], digits: int) -> str:
    found = [value for value in values if not math.isnan(value)]
    if not found:
        return "-"
    return f"{min(found):.{digits}f} to {max(found):.{digits}f}"


def quoted(shares: Sequence[Row], widths: Sequence[Row]) -> dict[str, str]:
    """What the documents quote."""
    coded = [row for row in shares if row["base"]]
    part = {
        kind: [100 * row["positions"][kind] / row["bytes"] for row in coded]
        for kind in coded[0]["positions"]
    }
    return {
        "lines": "\n".join(share_lines(coded)),
        "scans": str(len(coded)),
        "blocks": span_of(part["blocks"], 1),
        "cells": span_of(part["levels_of_cells"], 0),
        "vertices": span_of(part["levels_of_vertices"], 0),
        "shape": span_of((100 * row["shape"] / row["bytes"] for row in coded), 0),
        "without": span_of((row["without"] / row["bytes"] for row in coded), 3),
        "worse": str(sum(row["without"] > row["bytes"] for row in coded)),
        "paper": span_of((row["paper"] / row["bytes"] for row in coded), 2),
        "widths": "\n".join(width_lines(widths)),
        "tried": f"{', '.join(map(str, WIDTHS[:-1]))} and {WIDTHS[-1]}",
        "coarse meshes": ", ".join(row["mesh"] for row in widths),
    }


def written_tables(shares: Sequence[Row], widths: Sequence[Row], folder: Path) -> Path:
    """Write the tables as Markdown."""
    path, words = folder / "shares.md", quoted(shares, widths)
    path.write_text(
        "\n\n".join(f"{name}:\n\n{text}" for name, text in words.items()) + "\n", encoding="utf-8"
    )
    return path
