"""Scenes of glTF with their geometry coded, or restored."""

from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from itertools import chain
from typing import Any

import numpy as np

from bsm.account.images import ImageComparison
from bsm.bitstream.errors import FormatError, UnsupportedError
from bsm.codec.threads import ordered_map
from bsm.files.images import ImageRule
from bsm.files.parsing import as_format_error
from bsm.gltf import document as gltf
from bsm.gltf.bundles import Bundle, BundleStream, as_mesh, bundles_of, code_bundle
from bsm.gltf.coding import EXTENSION, Array, Tree
from bsm.gltf.rewrite import Rewritten, group_bundles, users_of
from bsm.gltf.scene import parents_of, places_of


@dataclass(frozen=True)
class Compressed:
    """A .glb, how many of its primitives are coded, why others are not, notes with their counts, errors, images."""

    data: bytes
    coded: int
    unchanged: dict[str, int]
    fallback: bytes = b""
    notes: Mapping[str, int] = field(default_factory=dict)
    error: tuple[float, float] = (0.0, 0.0)
    images: tuple[ImageComparison, ...] = ()


@as_format_error("glTF")
def count_primitives(document: gltf.Document) -> int:
    return len(list(document.primitives()))


@as_format_error("glTF")
def compress(
    document: gltf.Document,
    options: Mapping[str, Any],
    images: ImageRule | None = None,
    fallback: str | None = None,
    progress: Callable[[int, int], None] | None = None,
    *,
    jobs: int = 1,
    one_grid: bool = False,
) -> Compressed:
    """Code each primitive of triangles where that makes the scene smaller; `options` are those of `bsm.encode`."""
    # Its accessors have no bytes of their own: what a decoder fills would be coded again, with the errors of both.
    if EXTENSION in document.compressed:
        raise FormatError(
            f"its geometry is compressed already, by {EXTENSION}; start from the scene before that"
        )
    scene = Rewritten(document, fallback)
    reasons, notes = Counter[str](), Counter[str]()
    bundles = bundles_of(document, scene.tree, reasons)
    users = users_of(bundles, scene.tree, scene.foreign_numbers)
    exact = options.get("preset") == "lossless"
    quality_options: dict[str, Any] = {}
    if exact:
        quality_options["*"] = "exact"
    quality_options |= options.get("attributes", {})
    each: list[Mapping[str, Any]] = [options] * len(bundles)
    # Meshes that touch share borders. With grids of their own, rounding would open cracks between them.
    if one_grid:
        each = [*_one_grid(document, scene.tree, bundles, options)]
    each = [{**grid_options, "attributes": quality_options} for grid_options in each]
    sizes, coded = [sum(map(len, bundle)) for bundle in bundles], list[BundleStream | str]()
    meshes = (as_mesh(document, bundle, exact=exact) for bundle in bundles)
    bundle_jobs = zip(meshes, map(len, bundles), each, strict=True)
    # Threads suffice: the work is in C, which gives the interpreter's lock away.
    for stream_or_reason in ordered_map(lambda mesh: code_bundle(*mesh), bundle_jobs, jobs or None):
        if progress:
            progress(sum(sizes[: len(coded)]), sum(sizes))
        coded.append(stream_or_reason)
    coded_primitives, errors = 0, [(0.0, 0.0)]
    copies: dict[bytes, set[int]] = {}
    for number, stream_or_reason in enumerate(coded):
        if isinstance(stream_or_reason, BundleStream):
            copies.setdefault(stream_or_reason.stream, set()).add(number)
    for together in group_bundles(bundles, [*users.values(), *copies.values()]):
        streams = {
            number: stream_or_reason
            for number in together
            if isinstance(stream_or_reason := coded[number], BundleStream)
        }
        for number in together:
            if isinstance(why := coded[number], str):
                reasons[why] += sizes[number]
        freed = [index for index, theirs in users.items() if theirs <= streams.keys()]
        primitives = sum(sizes[number] for number in streams)
        # Bundles that share accessors are put in together or not at all: half of them would leave the accessors in the
        # file. Those with equal streams pay for one together.
        if scene.would_shrink(list(streams.values()), freed):
            coded_primitives += primitives
            for number, stream_or_reason in streams.items():
                scene.put(bundles[number], stream_or_reason)
                notes.update(stream_or_reason.notes)
                errors.append(stream_or_reason.error)
        elif streams:
            reasons["a stream would not be smaller"] += primitives
    data = scene.finished(images)
    worst = (max(error for error, _ in errors), max(share for _, share in errors))
    plain = b""
    if fallback:
        plain = b"".join(scene.plain)
    return Compressed(data, coded_primitives, dict(reasons), plain, notes, worst, (*scene.images,))


@as_format_error("glTF")
def restore(document: gltf.Document) -> bytes:
    """A .glb without compressed geometry."""
    for number, mesh in enumerate(document.items("meshes")):
        if EXTENSION in mesh.get("extensions", {}):
            # Accessors are restored one by one. Frames become morph targets in another way, which the message names.
            raise UnsupportedError(
                f"mesh {number} moves, and plain glTF cannot hold it: decode its stream to .glb"
            )
    return Rewritten(document, None).finished()


def _one_grid(
    document: gltf.Document, tree: Tree, bundles: list[Bundle], options: Mapping[str, Any]
) -> list[dict[str, Any]]:
    """Options of each bundle: those whose nodes turn and scale alike share the places and the size of their cells."""
    matrices: dict[object, Array] = {}
    for node, matrix in places_of(document, parents_of(document)).items():
        entry = document.item("nodes", node)
        # A skin places vertices by joints and ignores the matrix of the node.
        if "skin" in entry:
            matrix = np.eye(4)
        matrices.setdefault(entry.get("mesh"), matrix)
    meshes: dict[int, int] = {}
    for number, mesh in enumerate(tree["meshes"]):
        meshes |= {id(primitive): number for primitive in mesh["primitives"]}
    placed = [matrices.get(meshes[id(bundle[0][0])], np.eye(4)) for bundle in bundles]
    # Nine digits: writers compute the same rotation in different ways.
    keys = [np.round(matrix[:3, :3], 9).tobytes() for matrix in placed]
    cells: dict[bytes, float] = {}
    every = chain.from_iterable(bundles)
    corners = [same[0]["attributes"]["POSITION"] for same in every]
    document.limits.check_memory(
        gltf.PER_NUMBER * sum(map(document.claimed, corners)), 0, document.received
    )
    for bundle, key in zip(bundles, keys, strict=True):
        tables = [document.numbers(same[0]["attributes"]["POSITION"]) for same in bundle]
        extent = max(float(np.ptp(table, axis=0).max(initial=0.0)) for table in tables)
        cells[key] = max(cells.get(key, 0.0), extent / (1 << 14))
    bundle_options = []
    for matrix, cell in zip(placed, map(cells.__getitem__, keys), strict=True):
        # Not solve, since a node may scale an axis to zero.
        moved = np.linalg.lstsq(matrix[:3, :3], matrix[:3, 3], rcond=None)[0]
        grid: dict[str, Any] = {"grid": 14}
        if cell:
            grid = {"grid_cell": cell, "grid_origin": tuple((-moved % cell).tolist())}
        others = {name: value for name, value in options.items() if name not in ("preset", "grid")}
        bundle_options.append(others | grid)
    return bundle_options
