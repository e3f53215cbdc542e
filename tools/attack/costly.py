"""`python -m tools.attack costly`: search for small files of meshes that take long to encode, by mutating the worst.

Each file is a binary PLY file with few bytes for its mesh, read under the limits of a service, or a file of a kind of
`costly_files`, which is trusted. It is encoded on one thread, as a sequence of some frames for that kind. The CPU time
of both is compared with the bound of src/bsm/SERVICE.md: `SECONDS` and `SECONDS_PER_BYTE`.
"""

import time
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from random import Random
from typing import Any

import numpy as np

import bsm
from bsm.bitstream.errors import BsmError
from tools.attack.costly_files import FILES, File, changed_file, drawn_file, read_file
from tools.attack.taken import Taken, taken_by_each, warm_up
from tools.command import parser_of

SECONDS, SECONDS_PER_BYTE = 2.0, 2e-5
FAN = 255  # corners of the longest polygon whose number of corners takes a byte
SHAPES = ("random", "planes", "fan", "slivers", "shells", "grid", "copies", "tiny")
ATTRIBUTES = ("none", "none", "none", "color", "normal", "texcoord")
PRESETS = ("balanced", "balanced", "fine", "small", "near-lossless")
FRAMES = 6


@dataclass(frozen=True)
class Kind:
    """What recipes of a kind are drawn from."""

    shapes: tuple[str, ...] = SHAPES
    attributes: tuple[str, ...] = ATTRIBUTES
    presets: tuple[str, ...] = PRESETS
    options: Mapping[str, Any] = field(default_factory=dict)


KINDS = {
    "meshes": Kind(),
    "lean": Kind(options={"effort": "quick"}),
    "congruence": Kind(("parts", "copies", "planes"), ("none",)),
    "looks": Kind(attributes=("none",), options={"effort": "best"}),
    "attributes": Kind(attributes=("color", "normal", "texcoord", "all")),
    "paper": Kind(attributes=("none",), presets=("paper",)),
    "base": Kind(("grid", "shells"), ("none",), options={"congruence": False}),
    "sequences": Kind(attributes=("none",)),
}


@dataclass(frozen=True)
class Recipe:
    """What a file is made of: a shape of `vertices` and `faces`, where `small` of the faces are tiny."""

    shape: str
    vertices: int
    faces: int
    small: float
    attribute: str
    preset: str
    seed: int

    @property
    def ply(self) -> bytes:
        """The file."""
        random = np.random.default_rng(self.seed)
        positions, polygons = _polygons(self, random)
        tiny = int(self.small * len(positions))
        positions[:tiny] = positions[0] + 1e-3 * random.normal(size=(tiny, 3))
        many, wide = len(positions), len(positions) > 256
        values, lines = _attribute(self.attribute, random, many)
        columns = (
            np.column_stack([positions, values]).astype("<f4")
            if values.shape[1]
            else positions.astype("<f4")
        )
        head = ["ply", "format binary_little_endian 1.0", f"element vertex {many}"]
        head += [f"property float {name}" for name in ("x", "y", "z", *lines)]
        head += [f"element face {len(polygons)}"]
        head += [
            f"property list uchar {'ushort' if wide else 'uchar'} vertex_indices",
            "end_header",
            "",
        ]
        corners = (
            bytes([len(polygon)]) + polygon.astype("<u2" if wide else "u1").tobytes()
            for polygon in polygons
        )
        return "\n".join(head).encode() + columns.tobytes() + b"".join(corners)


def _polygons(recipe: Recipe, random: np.random.Generator) -> tuple[np.ndarray, list[np.ndarray]]:
    many, count = max(recipe.vertices, 3), max(recipe.faces, 1)
    turns = 2 * np.pi * np.arange(many) / many
    at = random.normal(size=(many, 3))
    match recipe.shape:
        case "planes" | "copies" | "grid":  # large, above each other
            rows = -(-many // 3)
            corners = np.array([[-1.0, -1.0], [1.0, -1.0], [0.0, 1.0]])
            step = 0.0 if recipe.shape == "copies" else 1.0 / rows
            at = np.column_stack(
                [np.tile(corners, (rows, 1)), np.repeat(step * np.arange(rows), 3)]
            )
            faces = np.arange(3 * rows).reshape(-1, 3)
            if recipe.shape == "grid":
                side = max(2, int(many**0.5))
                at = np.stack(np.meshgrid(*(np.arange(side, dtype=float),) * 2, [0.0]), -1).reshape(
                    -1, 3
                )
                at[:, 2] = random.normal(size=len(at))
                first = np.arange(side * side).reshape(side, side)[:-1, :-1].ravel()
                faces = np.concatenate(
                    [first[:, None] + [0, 1, side], first[:, None] + [1, side + 1, side]]
                )
            return at, list(np.resize(faces, (count, 3)))
        case "parts":  # one part, moved and turned
            part, size = random.normal(size=(5, 3)), -(-many // 5)
            turned = np.linalg.qr(random.normal(size=(size, 3, 3)))[0]
            at = (part @ turned + 9.0 * random.normal(size=(size, 1, 3))).reshape(-1, 3)
            corners = random.integers(0, 5, (6, 3)) + 5 * np.arange(size)[:, None, None]
            return at, list(np.resize(corners, (count, 3)))
        case "fan":  # planes through one line
            at = np.column_stack([np.cos(turns), np.sin(turns), np.resize([-1.0, 1.0], many)])
        case "slivers":
            at = np.column_stack(
                [np.cos(turns), 1e-3 * np.sin(turns), np.resize([-1.0, 1.0], many)]
            )
        case "shells":
            at = (
                at
                / np.linalg.norm(at, axis=1, keepdims=True)
                * np.linspace(1.0, 2.0, many)[:, None]
            )
        case "tiny":
            at[1:-2] = at[0] + 1e-4 * at[1:-2]
    long = [FAN] * (count // (FAN - 2)) + [count % (FAN - 2) + 2]
    return at, [random.integers(0, many, size) for size in long]


def _attribute(
    kind: str, random: np.random.Generator, many: int
) -> tuple[np.ndarray, tuple[str, ...]]:
    columns = {"none": "", "color": "red green blue", "normal": "nx ny nz", "texcoord": "s t"}
    names = columns.get(kind, " ".join(columns.values())).split()
    values = random.uniform(0.0, 1.0, (many, len(names)))
    return values, tuple(names)


def drawn(random: Random, kind: Kind = KINDS["meshes"]) -> Recipe:
    """Any recipe of a kind."""
    vertices, faces = (int(10 ** random.uniform(low, 3.7)) for low in (0.5, 0.0))
    small = random.choice((0.0, 0.0, 0.0, random.random()))
    shape, attribute, preset = map(random.choice, (kind.shapes, kind.attributes, kind.presets))
    return Recipe(shape, vertices, faces, small, attribute, preset, random.randrange(1 << 30))


def changed(recipe: Recipe, random: Random, kind: Kind = KINDS["meshes"]) -> Recipe:
    """The recipe with one thing as another has it, or with more or less of it."""
    name, changes = random.choice(list(vars(recipe))), dict[str, Any]()
    if name in ("vertices", "faces"):
        changes[name] = max(1, int(getattr(recipe, name) * 2 ** random.uniform(-2, 2)))
    else:
        changes[name] = getattr(drawn(random, kind), name)
    return replace(recipe, **changes)


def encoded(data: bytes, preset: str, kind: str = "meshes") -> Taken:
    """Read a file as a service does, and encode it."""
    try:
        mesh = bsm.load(data, limits=bsm.Limits.service())
        if kind == "sequences":
            frames = [
                mesh.positions * np.cos(t * mesh.positions[:, [1, 2, 0]]) for t in range(FRAMES)
            ]
            stream = bsm.encode_sequence(frames, mesh.faces, preset=preset, threads=1)
            return Taken(f"{len(stream)} bytes", FRAMES * len(data), len(mesh.faces))
        stream = bsm.encode(mesh, preset=preset, threads=1, **KINDS[kind].options)
        return Taken(f"{len(stream)} bytes", len(data), len(mesh.faces))
    except BsmError as error:
        return Taken(f"{type(error).__name__}: {error}", len(data))


def share(cost: Taken) -> float:
    """What it took over what it may take; something else than a stream or an error of ours is the worst."""
    return float("inf") if cost.escaped else cost.seconds / (SECONDS + SECONDS_PER_BYTE * cost.size)


def search(
    seconds: float, seed: str, most: int = 12, kind: str = "meshes"
) -> list[tuple[float, Recipe | File, Taken]]:
    """Return the worst files found within a time, the worst first."""
    random, worst, end = (
        Random(seed),
        list[tuple[float, Recipe | File, Taken]](),
        time.monotonic() + seconds,
    )
    while time.monotonic() < end:
        new = not worst or random.random() < 0.3
        recipes = [
            _drawn(kind, random) if new else _changed(random.choice(worst)[1], kind, random)
            for _ in range(4)
        ]
        works = [partial(_prepared, recipe, kind) for recipe in recipes]
        costs = zip(recipes, taken_by_each(works, seconds=120), strict=True)
        worst = sorted(
            [*worst, *((share(cost), recipe, cost) for recipe, cost in costs)],
            key=lambda row: -row[0],
        )
        worst = worst[:most]
    return worst


def _drawn(kind: str, random: Random) -> Recipe | File:
    return drawn_file(kind, random) if kind in FILES else drawn(random, KINDS[kind])


def _changed(recipe: Recipe | File, kind: str, random: Random) -> Recipe | File:
    return (
        changed_file(recipe, random)
        if isinstance(recipe, File)
        else changed(recipe, random, KINDS[kind])
    )


def _prepared(recipe: Recipe | File, kind: str) -> partial[Taken]:
    if isinstance(recipe, File):
        return partial(read_file, recipe)
    return partial(encoded, recipe.ply, recipe.preset, kind)


def main() -> int:
    """Run the command."""
    parser = parser_of(__doc__)
    parser.add_argument(
        "--seconds", type=float, default=600, help="how long to search (default: %(default)s)"
    )
    parser.add_argument("--seed", default="0")
    parser.add_argument(
        "--kind", choices=(*KINDS, *FILES), default="meshes", help="default: %(default)s"
    )
    parser.add_argument("--save", type=Path, metavar="FILE", help="write the worst file here")
    args = parser.parse_args()
    warm_up()
    worst = search(args.seconds, args.seed, kind=args.kind)
    for part, recipe, cost in worst:
        print(
            f"{part:.2f} of the bound: {cost.seconds:.2f} s, {cost.size} bytes, {cost.outcome[:60]}; {recipe}"
        )
    if args.save:
        recipe = worst[0][1]
        args.save.write_bytes(recipe.data if isinstance(recipe, File) else recipe.ply)
    return 1 if worst[0][0] > 1.0 else 0
