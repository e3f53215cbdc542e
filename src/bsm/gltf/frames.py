"""The frames of an animated glTF: morph targets, skins and moving nodes, sampled at a rate."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from bsm.bitstream.errors import FormatError, OptionError
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits
from bsm.codec.arrays import Positions
from bsm.files.formats.metadata import Material, Value, described
from bsm.files.formats.polygons import Column, MeshFile, Polygons, sorted_into_parts
from bsm.files.motion.frames import LIKELY_RATES, Frames, Wanted, checked_frames, rate_of_times
from bsm.files.room import require_count
from bsm.files.rows import Doubles
from bsm.gltf.document import Document, Tree, as_format_error, read_document
from bsm.gltf.scene import Part, Scene

USUAL_RATE = 30.0
PER_TRIANGLE, PER_PART = 200, 2000
"""Bytes that parts take while they are joined: for each triangle of each table, and for each part."""


def read_gltf(path: str, wanted: Wanted, limits: Limits = DEFAULT_LIMITS) -> Frames:
    """The frames of a GLB or glTF."""
    document = read_document(path)
    with as_format_error(), np.errstate(over="ignore", invalid="ignore"):  # what is not finite is refused later
        document.require_plain()
        return _frames(path, document, wanted, limits)


def _frames(path: str, document: Document, wanted: Wanted, limits: Limits) -> Frames:
    number, animation = _chosen(document, wanted.animation)
    scene = Scene(document, animation, limits)
    if not scene.parts:
        raise FormatError("this glTF has no triangles in its scene")
    if not scene.moves:
        raise FormatError(
            f"animation {number} of this glTF moves nothing that is seen; leave out --animation for the mesh"
        )
    keys = scene.keys
    rate = wanted.rate or _rate(keys)
    count = int(np.floor((keys[-1] - keys[0]) * rate + 1e-3)) + 1
    require_count("frames", count, limits)
    limits.check_work(scene.work * count, scene.vertices * count, document.received)
    times = keys[0] + np.arange(count) / rate
    still = _still(scene, document, float(times[0]), limits)

    def positions() -> Iterator[Positions]:
        for time in times:
            yield scene.at(float(time))

    others = len(document.items("animations")) - 1
    called = str(animation.get("name") or number)
    notes = [f"animation {called}, {count} frames at {rate:g} per second", *scene.notes, *still.notes]
    notes += [f"{others} other {'animation was' if others == 1 else 'animations were'} left out"] if others else []
    notes += ["left out, for they move: normals"] if _has_normals(document) else []
    mesh = still.mesh
    frames = checked_frames(path, positions(), len(mesh.positions))
    return Frames(mesh.faces, count, frames, mesh.attributes, tuple(dict.fromkeys(notes)), rate, mesh.metadata)


def _chosen(document: Document, wish: str) -> tuple[int, Tree]:
    animations = document.items("animations")
    if not animations:
        raise FormatError("this glTF has no animation; leave out --animation to encode it as one mesh")
    names = [str(one.get("name", "")) for one in animations]
    if wish in names:
        return names.index(wish), animations[names.index(wish)]
    if not wish.isdecimal() and wish:
        raise OptionError(f"there is no animation {wish}; there are {', '.join(filter(None, names)) or len(names)}")
    number = int(wish or 0)
    if number >= len(animations):
        raise OptionError(f"there is no animation {number}; there are {len(animations)}, counted from 0")
    return number, animations[number]


def _rate(keys: Doubles) -> float:
    """The rate of the keys, as far as it can be told."""
    rate = rate_of_times(keys)
    if 5 <= rate <= 240:
        return rate
    since = keys - keys[0]
    fits = [one for one in LIKELY_RATES if np.abs(since * one - np.rint(since * one)).max() < 0.02]
    return float(fits[0]) if fits else USUAL_RATE


def _has_normals(document: Document) -> bool:
    return any("NORMAL" in one["attributes"] for mesh in document.items("meshes") for one in mesh["primitives"])


def _still(scene: Scene, document: Document, time: float, limits: Limits) -> MeshFile:
    """The mesh of the first frame."""
    parts = scene.parts
    begin = np.cumsum([0, *(len(part.base) for part in parts)])
    triangles = sum(len(part.faces) for part in parts)
    require_count("faces", triangles, limits)
    tables = sum(1 + len(part.columns) for part in parts) * triangles // len(parts)
    limits.check_memory(PER_TRIANGLE * tables + PER_PART * len(parts), scene.vertices, document.received)
    faces = np.concatenate([part.faces + first for part, first in zip(parts, begin)])
    columns = _columns(parts)
    metadata: dict[str, Value] = {"up": "y", "unit": "meters"}
    numbers = np.repeat([part.material for part in parts], [len(part.faces) for part in parts])
    used = [int(number) for number in np.unique(numbers)]
    if any(number >= 0 for number in used):
        words, images = _materials(document, used)
        metadata |= described(words) | images
        if len(used) > 1:
            columns.append(Column("material", np.maximum(numbers, 0)[:, None].astype(np.int32), "face"))
    notes: list[str] = []
    if len(parts) > 1:
        notes, column, names = sorted_into_parts([part.name for part in parts], [len(part.faces) for part in parts])
        columns, metadata = [*columns, *column], {**metadata, **names}
    elif parts[0].name:
        metadata["name"] = parts[0].name
    sizes = np.full(len(faces), 3)
    positions = scene.at(time)
    found = Polygons(positions, sizes, faces.reshape(-1), tuple(notes), (), tuple(columns), metadata)
    return found.checked(limits)


def _columns(parts: list[Part]) -> list[Column]:
    """What the vertices of the files have, at the corners of the faces."""
    sizes = [max(int(part.corners.max(initial=-1)) + 1, *(len(c.values) for c in part.columns), 0) for part in parts]
    begin = np.cumsum([0, *sizes])
    corners = np.concatenate([part.corners.reshape(-1) + first for part, first in zip(parts, begin)])
    found = []
    named_columns = [{column.name: column for column in reversed(part.columns)} for part in parts]
    for name in dict.fromkeys(column.name for part in parts for column in part.columns):
        of_parts = [columns.get(name) for columns in named_columns]
        model = next(column for column in of_parts if column is not None)
        tables = []
        for column, size in zip(of_parts, sizes, strict=True):
            blank = np.full((size, model.values.shape[1]), 255 if model.semantic == "color" else 0, model.values.dtype)
            if column is not None and column.values.shape[1] == model.values.shape[1]:
                blank[: len(column.values)] = column.values
            tables.append(blank)
        found.append(replace(model, values=np.concatenate(tables), domain="corner", indices=corners))
    return found


def _materials(document: Document, used: list[int]) -> tuple[dict[int, Material], dict[str, Value]]:
    """Materials in the words of glTF, and their images as metadata."""
    words: dict[int, Material] = {}
    numbers: dict[int, int] = {}
    for number in used:
        if number < 0:
            continue
        tree = document.item("materials", number)
        flat: Tree = {**tree, **tree.get("pbrMetallicRoughness", {})}
        words[number] = {}
        for name, value in flat.items():
            if name.endswith("Texture"):
                source = document.item("textures", value["index"]).get("source")
                if isinstance(source, int):
                    words[number][name] = numbers.setdefault(source, len(numbers))
            elif isinstance(value, bool):
                words[number][name] = int(value)
            elif isinstance(value, str | int | float):
                words[number][name] = value
            elif isinstance(value, list) and all(isinstance(one, int | float) for one in value):
                words[number][name] = " ".join(f"{one:.6g}" for one in value)
    images: dict[str, Value] = {}
    for source, number in numbers.items():
        name, data = document.image(source)
        images |= {f"image.{number}.data": data, **({f"image.{number}.name": name} if name else {})}
    return words, images
