"""Compare what attributes take in our files with what they take in Draco's, at the same quantization.

    python -m tools.measure attributes MESH [MESH ...] [--grid 14]

Both put positions on the same grid. What an attribute takes is the file with it less the file
without; in Draco's (level 10), vertices are split where the attribute needs it. Texture coordinates have 12 bits,
normals 8 on an octahedron, colors and whole numbers are exact, and other numbers are kept to 1 % of their range (for
Draco: rounded so first). Every attribute of ours is decoded and compared before it counts. Draco has no values of
faces. Needs DracoPy.
"""

import argparse
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from bsm.codec.decoding import decode
from bsm.codec.geometry.attributes import Attribute, at_corners, compare_values
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.static.encoder import encode
from bsm.codec.static.options import EncodeOptions
from bsm.files.mesh import read_mesh

TEXCOORD_BITS, NORMAL_BITS = 12, 8
SHARE = 1.0
"""Percent of the range that other numbers may be off."""

Array = npt.NDArray[Any]


@dataclass(frozen=True)
class Row:
    """What an attribute takes."""

    what: str
    ours: int
    theirs: int

    @property
    def ratio(self) -> float:
        """Ours to theirs."""
        return self.ours / self.theirs

    def __str__(self) -> str:
        if self.theirs < 0:
            return f"{self.what} | {self.ours} | - | -"
        return f"{self.what} | {self.ours} | {self.theirs} | {self.ratio:.3f}"


def quality_of(attribute: Attribute) -> str:
    """Return the quality at which an attribute is compared, as an option of our encoder."""
    if attribute.values.dtype.kind != "f":
        return "exact"
    if attribute.semantic == "texcoord":
        return f"{TEXCOORD_BITS}bits"
    if attribute.semantic == "normal":
        return f"{NORMAL_BITS}bits"
    return f"{SHARE:g}%"


def check(mesh: TriangleMesh, attribute: Attribute, options: EncodeOptions) -> None:
    """Raise AssertionError unless a decoded attribute is within what its quantization allows."""
    stream = encode(replace(mesh, attributes=(attribute,)), replace(options, keep_order=True))
    decoded = decode(stream)
    found = next(other for other in decoded.attributes if other.name == attribute.name)
    normals = attribute.semantic == "normal"
    original, values = at_corners(attribute, mesh.faces), at_corners(found, decoded.faces)
    error = compare_values(original, values, np.ones(original.shape[:-1]) if normals else None)
    quality = quality_of(attribute)
    extent = float(np.ptp(attribute.values.astype(np.float64), axis=0).max())
    if normals:
        assert (
            error.max_angle_deg is not None and error.max_angle_deg <= 1.3 * 90 / 2**NORMAL_BITS * 2
        ), error
    elif quality == "exact":
        assert error.max_error == 0, error
    else:
        share = SHARE / 100 if quality.endswith("%") else 0.5 / (2**TEXCOORD_BITS - 1)
        assert error.max_error <= share * extent * (1 + 1e-5) + 1e-6 * extent, error


def ours(mesh: TriangleMesh, attributes: tuple[Attribute, ...], grid: int) -> int:
    """Bytes of our file with these attributes, each checked."""
    qualities = {attribute.name: quality_of(attribute) for attribute in attributes}
    options = EncodeOptions(grid=grid, attributes=qualities)
    for attribute in attributes:
        check(
            mesh,
            attribute,
            replace(options, attributes={attribute.name: qualities[attribute.name]}),
        )
    return len(encode(replace(mesh, attributes=attributes), options))


def theirs(mesh: TriangleMesh, attributes: tuple[Attribute, ...], grid: int) -> int:
    """Bytes of Draco's file with these attributes of vertices and corners."""
    import DracoPy

    welded, place = np.unique(mesh.positions, axis=0, return_inverse=True)
    places = place.reshape(-1)[mesh.faces]
    proper = (places != np.roll(places, 1, axis=1)).all(axis=1)
    columns, values = [places[proper].reshape(-1)], []
    for attribute in attributes:
        own = _levels(attribute)
        unique, number = np.unique(own, axis=0, return_inverse=True)
        numbers = replace(attribute, values=number.reshape(-1, 1), semantic="generic")
        columns.append(at_corners(numbers, mesh.faces)[proper].reshape(-1))
        values.append(unique)
    rows, corners = np.unique(np.stack(columns, axis=1), axis=0, return_inverse=True)
    options: dict[str, Any] = {}
    for attribute, column, unique in zip(attributes, rows.T[1:], values, strict=True):
        offered = unique[column]
        if attribute.semantic == "texcoord" and offered.dtype.kind == "f":
            options |= {"tex_coord": offered, "tex_coord_quantization_bits": TEXCOORD_BITS}
        elif attribute.semantic == "normal" and offered.dtype.kind == "f":
            options |= {"normals": offered, "normal_quantization_bits": NORMAL_BITS}
        elif (
            attribute.semantic == "color" and offered.dtype == np.uint8 and "colors" not in options
        ):
            options["colors"] = offered
        else:
            options.setdefault("generic_attributes", {})[attribute.name] = offered
    data: bytes = DracoPy.encode(
        welded[rows[:, 0]].astype(np.float32),
        corners.reshape(-1, 3).astype(np.uint32),
        quantization_bits=grid,
        compression_level=10,
        **options,
    )
    return len(data)


def _levels(attribute: Attribute) -> Array:
    """What Draco is given: floats that it quantizes, or whole numbers."""
    values = attribute.values
    if values.dtype.kind == "f" and attribute.semantic not in ("texcoord", "normal"):
        low, extent = values.min(axis=0), float(np.ptp(values, axis=0).max())
        levels = np.rint((values - low) / (2 * SHARE / 100 * extent))
        return np.asarray(levels, np.uint8 if levels.max() < 256 else np.uint32)
    if values.dtype.kind == "f":
        return np.asarray(values, np.float64)
    if values.min() < 0:
        values = values.astype(np.int64) - values.min()
    return np.asarray(values, np.uint8 if values.max() < 256 else np.uint32)


def rows_of(mesh: TriangleMesh, grid: int) -> tuple[list[Row], Row]:
    """Each attribute, and the whole files."""
    bare = replace(mesh, attributes=(), metadata={})
    rows = []
    alone = len(encode(bare, EncodeOptions(grid=grid)))
    for attribute in mesh.attributes:
        size = ours(bare, (attribute,), grid) - alone
        other = (
            -1
            if attribute.domain == "face"
            else theirs(bare, (attribute,), grid) - theirs(bare, (), grid)
        )
        rows.append(Row(f"{attribute.name}, {quality_of(attribute)}", size, other))
    shared = tuple(attribute for attribute in mesh.attributes if attribute.domain != "face")
    return rows, Row("whole file", ours(bare, shared, grid), theirs(bare, shared, grid))


def main() -> None:
    """Run the command."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("meshes", nargs="+", metavar="MESH")
    parser.add_argument("--grid", type=int, default=14, metavar="BITS")
    options = parser.parse_args()
    ratios: dict[str, list[float]] = {}
    print("| mesh | attribute | ours | Draco | ratio |\n|---|---|---|---|---|")
    for path in options.meshes:
        mesh = read_mesh(path).mesh
        if not mesh.attributes:
            continue
        rows, whole = rows_of(mesh, options.grid)
        for row in (*rows, whole):
            print(f"| {Path(path).name} | {row} |", flush=True)
            if row.theirs > 0:
                ratios.setdefault(row.what.split(",")[0], []).append(row.ratio)
    for what, several in ratios.items():
        print(f"| mean | {what} | | | {np.mean(several):.3f} |")
