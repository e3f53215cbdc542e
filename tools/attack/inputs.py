"""Small meshes and sequences of every kind with options of every kind, all from one random number generator."""

from collections.abc import Callable
from dataclasses import replace
from random import Random
from typing import Any, get_args

import numpy as np

from bsm.api import encode_sequence
from bsm.codec.arrays import Positions
from bsm.codec.geometry.attributes import Attribute, Domain
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.sequence.encoder import SequenceEncoder
from bsm.codec.sequence.options import SequenceOptions
from bsm.codec.static.encoder import encode
from bsm.codec.static.options import PRESETS, EncodeOptions, changed
from bsm.codec.static.targets import TARGETS, Target
from tests.shapes import soup
from tools.gridded import random_grid
from tools.vectors.meshes import (
    hub,
    patch,
    shuffled,
    tangled,
    tetrahedron,
    together,
    torus,
    triangle,
)

ATTRIBUTES = 0.25
"""Share of meshes that have one, and of those that have another."""
SEQUENCES = 0.25
"""Share of sequences among random streams."""
MOVING = 0.3
"""Share of sequences with an attribute that changes."""


def random_stream(random: Random) -> bytes:
    """A mesh or a sequence, encoded with options of any kind."""
    if random.random() < SEQUENCES:
        return _sequence(random)
    return encode(random_mesh(random), _static_options(random))


def unencoded_stream(random: Random) -> bytes:
    """A mesh on a grid that no encoder would choose."""
    return random_grid(random, random_mesh(random))


def random_mesh(random: Random) -> TriangleMesh:
    """Some shape, often deformed."""
    mesh = random.choice(_SHAPES)(random)
    for deform in _DEFORMATIONS:
        if random.random() < 0.12:
            mesh = TriangleMesh(deform(random, mesh.positions), mesh.faces)
    if random.random() < 0.15:
        mesh = shuffled(mesh)
    while random.random() < ATTRIBUTES:
        mesh = replace(mesh, attributes=(*mesh.attributes, _attribute(random, mesh)))
    return mesh


def _attribute(random: Random, mesh: TriangleMesh) -> Attribute:
    """Values that are smooth, noisy or few, of any type, domain and meaning."""
    domain: Domain = random.choice(get_args(Domain))
    semantic, components = random.choice(
        (("generic", random.randrange(1, 5)), ("color", 3), ("normal", 3), ("texcoord", 2))
    )
    places = mesh.positions[mesh.faces].mean(axis=1) if domain == "face" else mesh.positions
    if domain == "corner":
        places = mesh.positions[mesh.faces.ravel()]
    numbers = np.random.default_rng(random.randrange(1 << 30))
    extent = np.ptp(mesh.positions) or 1.0
    waves = np.sin(places @ numbers.normal(size=(3, components)) * 4 / extent)
    values = waves + random.choice((0.0, 0.01, 1.0)) * numbers.normal(size=waves.shape)
    kind = random.choice(("uint8", "float32") if semantic == "color" else _NUMBERS)
    if semantic == "color":
        values = np.clip((values + 1.0) / 2.0, 0.0, 1.0)
    if semantic in ("normal", "texcoord"):
        kind = random.choice(("float32", "float64"))
    scale = 255.0 if kind == "uint8" else 100.0 if kind.startswith(("int", "uint")) else 1.0
    stored = np.clip(values * scale, *((0, 255) if kind == "uint8" else (-1e6, 1e6)))
    return Attribute(f"{semantic} {len(mesh.attributes)}", stored.astype(kind), domain, semantic)  # type: ignore[arg-type]


_NUMBERS = ("uint8", "int16", "int32", "float32", "float64")


def _disorder(random: Random) -> TriangleMesh:
    """Faces without any order."""
    numbers = np.random.default_rng(random.randrange(1 << 30))
    size = random.randrange(3, 60)
    faces = numbers.integers(0, size, (random.randrange(1, 2 * size), 3), np.int32)
    return TriangleMesh(numbers.normal(size=(size, 3)), faces)


def _components(random: Random) -> TriangleMesh:
    """Up to forty of them."""
    small: list[Callable[[], TriangleMesh]] = [
        tetrahedron,
        triangle,
        lambda: torus(5, 4),
        lambda: patch(3, 3),
    ]
    return together(*(random.choice(small)() for _ in range(random.choice((2, 5, 40)))))


_SHAPES: tuple[Callable[[Random], TriangleMesh], ...] = (
    lambda random: patch(random.randrange(2, 16), random.randrange(2, 16)),
    lambda random: torus(random.randrange(3, 18), random.randrange(3, 14)),
    lambda random: torus(random.randrange(3, 18), random.randrange(3, 14), phase=random.random()),
    lambda random: together(torus(7, 6), patch(6, 5), triangle()),
    _components,
    lambda random: soup(patch(random.randrange(2, 7), random.randrange(2, 7))),
    _disorder,
    lambda random: tangled(),
    lambda random: hub(),
    lambda random: tetrahedron(),
)


def _noise(random: Random, positions: Positions) -> Positions:
    size = 10.0 ** random.uniform(-6, 0)
    noise: Positions = np.random.default_rng(random.randrange(1 << 30)).normal(size=positions.shape)
    moved: Positions = positions + size * noise
    return moved


_DEFORMATIONS: tuple[Callable[[Random, Positions], Positions], ...] = (
    _noise,
    lambda random, positions: positions * 10.0 ** random.randrange(-9, 10),
    lambda random, positions: positions + np.array([1e4, -3e5, 7.0]),
    lambda random, positions: positions * (1.0, 1.0, 0.0),
    lambda random, positions: np.round(positions, random.randrange(2)),
    lambda random, positions: positions.astype(np.float32).astype(np.float64),
)


def _some(random: Random, choices: dict[str, Callable[[], Any]], share: float) -> dict[str, Any]:
    return {name: make() for name, make in choices.items() if random.random() < share}


def _static_options(random: Random) -> EncodeOptions:
    way = random.randrange(8)
    options: dict[str, Any] = {
        "block_size": random.choice((12, 30, 30, 60, 100, 750)),
        "threads": 1,
    }
    if way == 0:
        preset = vars(PRESETS[random.choice(sorted({*PRESETS} - {"none"}))])
        return EncodeOptions(
            **{**preset, "effort": random.choice(("quick", "normal", "normal")), "threads": 1}
        )
    if way == 1:
        keep, effort = random.random() < 0.3, random.choice(("quick", "normal"))
        return EncodeOptions(
            grid=random.randrange(1, 21), threads=1, keep_order=keep, effort=effort
        )
    if way == 2:
        options["target"] = Target(random.choice(TARGETS), random.choice((0.01, 1.0, 8.0, 400.0)))
    elif way == 3:
        options |= {"bits": random.randrange(2, 17), "partition": "metis"}
    elif way == 4:
        options["doi"] = (0.05, 0.2)
    else:
        options["step"] = 2.0 ** -random.randrange(3, 16)
    return changed(EncodeOptions(), **{**_some(random, _static_choices(random), 0.15), **options})


def _static_choices(random: Random) -> dict[str, Callable[[], Any]]:
    return {
        "keep": lambda: random.choice((0.05, 0.3, 1.0)),
        "coefficients": lambda: random.choice((1, 4, 20)),
        "overlap": lambda: random.choice((1.0, 1.15, 2.0)),
        "partition": lambda: "metis",
        "key_seed": lambda: random.choice(("svd", "cosines")),
        "key_interval": lambda: random.choice((0, 1, 2, 5)),
        "power": lambda: random.choice((1, 2, 8, 16)),
        "iterations": lambda: random.choice((1, 3, 9)),
        "key_iterations": lambda: random.choice((1, 8, 40)),
        "shift": lambda: 10.0 ** random.randrange(-6, 4),
        "predict": lambda: False,
        "smoothing": lambda: random.choice((0.0, 0.5, 8.0)),
        "keep_order": lambda: True,
    }


def _sequence(random: Random) -> bytes:
    mesh = random_mesh(random)
    speed, frames = 10.0 ** random.uniform(-4, 0), random.randrange(1, 9)
    still = mesh.positions
    swing = np.sin(still[:, [1, 2, 0]] * 3 / (np.ptp(still) or 1.0)) * (np.ptp(still) or 1.0)
    positions = np.array([still + speed * np.sin(0.7 * t) * swing for t in range(frames)])
    choices: dict[str, Callable[[], Any]] = {
        "low_delay": lambda: random.choice((1, 2)),
        "gop": lambda: random.choice((2, 3, 5)),
        "overlap": lambda: 1.3,
        "keep_order": lambda: True,
        "frame_rate": lambda: 25.0,
    }
    moving = random.random() < MOVING
    if not moving:  # few columns cannot tell of attributes as well as is asked
        choices["keep"] = lambda: random.choice((0.005, 0.05, 0.5))
    options = {
        "step": 2.0 ** -random.randrange(4, 14),
        "block_size": random.choice((12, 36, 100)),
        "threads": 1,
    }
    chosen = SequenceOptions(**{**options, **_some(random, choices, 0.4)})
    if moving:
        kind, width = (
            random.choice(("uint8", "int16", "float32", "float64")),
            random.randrange(1, 5),
        )
        places = np.resize(still / (np.abs(still).max() or 1.0), (len(still), width))
        meshes = []
        for t, frame in enumerate(positions):
            attribute = Attribute(
                "moving", (60.0 + 50.0 * np.sin(3.0 * places + 0.7 * t)).astype(kind)
            )
            meshes.append(replace(mesh, positions=frame, attributes=(*mesh.attributes, attribute)))
        return b"".join(SequenceEncoder(mesh.faces, chosen, frames).chunks(meshes))
    return encode_sequence(positions, mesh.faces, chosen, mesh_attributes=mesh.attributes)
