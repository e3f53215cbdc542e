"""The page of a folder: for each file its pictures, sizes, errors and images, failures and large errors first."""

import base64
import csv
import html
import io
import warnings
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

from bsm.account.drawing import surface_colors
from bsm.bitstream.errors import BsmError, OptionError
from bsm.bitstream.limits import Limits
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.files.libraries import read_any
from bsm.files.pipes import Input
from bsm.files.stream import is_stream
from bsm.ground.exits import worded
from bsm.ground.pictures import bounds_of, png, render, view_matrix

Facts: TypeAlias = Mapping[str, Any]
Load: TypeAlias = Callable[[str], TriangleMesh]

SIDE = 240  # pixels of a picture
MOST_PICTURES = 300  # a page of more than this is too large to open
_VIEW = view_matrix(30.0, 20.0)
_UPRIGHT = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
"""Turns the y axis up, for meshes whose format or metadata say so."""
_UP_Y = (".obj", ".glb", ".gltf", ".dae")
PAGE_LIMITS = Limits.service()
"""Memory and work of a mesh that is only drawn."""
_COLUMNS = (
    *(
        "input",
        "output",
        "input_bytes",
        "output_bytes",
        "vertices",
        "faces",
        "look",
        "max_error",
        "max_error_relative",
    ),
    *("seconds", "error", "exit", "output_sha256", "notes"),
)
_STYLE = (
    "body{font:15px/1.5 system-ui,sans-serif;margin:2em;color:#222}table{border-collapse:collapse}"
    "th,td{padding:.4em .8em;border-bottom:1px solid #ccc;text-align:right;vertical-align:top}"
    "th:first-child,td:first-child,td.words{text-align:left}img{display:block}.failed{color:#a00}"
    "@media(prefers-color-scheme:dark){body{background:#1b1b1b;color:#ddd}.failed{color:#f88}}"
)


def report_kind(path: str) -> str:
    """Return the format of a report by its suffix: json, csv or html; raise `OptionError` for others."""
    suffix = Path(path).suffix[1:].lower()
    if suffix in ("json", "csv", "html"):
        return suffix
    if suffix in ("", "part"):
        return "json"
    raise OptionError(f"{path}: reports are written as .json, .csv or .html")


def load_mesh(path: str) -> TriangleMesh:
    """Read a mesh or a stream to draw it, without telling again what its reader leaves out."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return read_any(Input(path), limits=PAGE_LIMITS)


def load_stream(path: str) -> TriangleMesh:
    """Read a stream to draw it; refuse mesh files, whose readers are not trusted with this input."""
    if not is_stream(path):
        raise OptionError("untrusted inputs are not read again")
    return load_mesh(path)


def write_table(results: Sequence[Facts]) -> bytes:
    """Return results as a table of comma-separated values, a row for each."""
    text = io.StringIO()
    table = csv.DictWriter(text, _COLUMNS, extrasaction="ignore", lineterminator="\n")
    table.writeheader()
    for result in results:
        notes = "; ".join(result.get("notes") or ())
        table.writerow(
            {name: _guarded(value) for name, value in {**result, "notes": notes}.items()}
        )
    return text.getvalue().encode()


def _guarded(value: object) -> object:
    """Keep a spreadsheet from taking a name for a formula."""
    if isinstance(value, str) and value[:1] in ("=", "+", "-", "@"):
        return f"'{value}"
    return value


def write_page(title: str, results: Sequence[Facts], load: Load) -> bytes:
    """Return the page of results as HTML in one file, with pictures of inputs and outputs."""
    ordered = sorted(results, key=_severity)
    rows = "\n".join(
        _row(result, load, has_picture=place < MOST_PICTURES)
        for place, result in enumerate(ordered)
    )
    left = len(ordered) - MOST_PICTURES
    more = ""
    if left > 0:
        more = f"<p>The last {left} rows have no pictures.</p>"
    heads = (
        "file",
        "before, after",
        "bytes",
        "relative size",
        "look distance",
        "largest error",
        "notes",
    )
    head = "".join(f"<th>{name}</th>" for name in heads)
    name = html.escape(title)
    page = (
        f'<!doctype html><html lang="en"><meta charset="utf-8"><title>{name}</title><style>{_STYLE}</style>'
        f"<h1>{name}</h1><p>{_summary(ordered)}</p><table><thead><tr>{head}</tr></thead>"
        f"<tbody>{rows}</tbody></table>{more}</html>\n"
    )
    return page.encode()


def _severity(result: Facts) -> tuple[bool, float, float]:
    """Order failures before results, and large errors before small ones."""
    return (
        "error" not in result,
        -(result.get("look") or 0.0),
        -(result.get("max_error_relative") or 0.0),
    )


def _summary(results: Sequence[Facts]) -> str:
    failures = sum("error" in result for result in results)
    return f"{len(results)} files, {failures} failed. Failures come first, then the largest look distances and errors."


def _row(result: Facts, load: Load, *, has_picture: bool) -> str:
    name = html.escape(str(result["input"]))
    if "error" in result:
        reason = html.escape(str(result["error"]))
        return f'<tr class="failed"><td>{name}</td><td class="words" colspan="6">{reason}</td></tr>'
    notes = list(result.get("notes") or ())
    picture = ""
    if has_picture and "output_bytes" in result:
        try:
            picture = _picture(result, load)
        except (BsmError, OSError) as error:
            notes.append(f"no picture: {worded(error)}")
    cells = (name, picture, _sizes(result), _ratio(result), _number(result, "look"), _error(result))
    told = [*map(_image_note, result.get("images") or ()), *map(str, notes)]
    words = "<br>".join(map(html.escape, told))
    return f'<tr>{"".join(f"<td>{cell}</td>" for cell in cells)}<td class="words">{words}</td></tr>'


def _picture(result: Facts, load: Load) -> str:
    """Return the pictures of the input and the output beside each other, seen from one side."""
    names = dict.fromkeys((result["input"], result.get("output") or result["input"]))
    meshes = [load(name) for name in names]
    up = meshes[0].metadata.get("up")
    source = str(meshes[0].metadata.get("source_name", result["input"]))
    view = _VIEW
    if up == "y" or (up is None and source.lower().endswith(_UP_Y)):
        view = _VIEW @ _UPRIGHT
    bounds = bounds_of(meshes[0].positions, view)
    drawn = []
    for mesh in meshes:
        colors = surface_colors(mesh)
        drawn.append(
            render(mesh.positions, mesh.faces, SIDE, view=view, bounds=bounds, colors=colors)
        )
    data = base64.b64encode(png(np.hstack(drawn))).decode()
    name = html.escape(f"{result['input']} before and after")
    return f'<img width="{SIDE * len(drawn)}" height="{SIDE}" alt="{name}" src="data:image/png;base64,{data}">'


def _sizes(result: Facts) -> str:
    sizes = [result.get("input_bytes"), result.get("output_bytes")]
    return " → ".join(f"{size:,}" for size in sizes if size is not None)


def _ratio(result: Facts) -> str:
    before, after = result.get("input_bytes"), result.get("output_bytes")
    if not before or not after:
        return ""
    return f"{100 * after / before:.3g} %"


def _number(result: Facts, name: str) -> str:
    value = result.get(name)
    if value is None:
        return ""
    return f"{value:.3g}"


def _error(result: Facts) -> str:
    share = result.get("max_error_relative")
    if share is None:
        return ""
    length = ""
    if result.get("unit"):
        length = f"{result['max_error']:.3g} {html.escape(result['unit'])}, "
    return f"{length}{100 * share:.3g} % of the diagonal"


def _image_note(image: Mapping[str, Any]) -> str:
    before, after = (image.get(side) or {} for side in ("before", "after"))
    quality = image.get("psnr_db")
    equal = "equal"
    if quality is not None:
        equal = f"{quality:.3g} dB"
    return f"image {image.get('name', '')}: {before.get('bytes', '?')} → {after.get('bytes', '?')} bytes, {equal}"
