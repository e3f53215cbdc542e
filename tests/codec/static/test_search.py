"""The search for a step: it ends near its bound, asks little, and another way never makes a file larger."""

import math
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from bsm import (
    PRESETS,
    Attribute,
    Contract,
    EncodeOptions,
    Encoder,
    Target,
    TargetError,
    TriangleMesh,
    look,
    read_mesh,
)
from bsm.codec.static.choice import search
from bsm.codec.static.choice.bounds import Bounds
from bsm.codec.static.choice.table import ways_of
from bsm.codec.static.choice.trials import Way
from bsm.codec.static.targets import SLACK, secant
from tests.codec.static.attributes.test_attributes import smooth_normals
from tests.shapes import patch, torus

SOME = (
    "assets/monkey.glb", "assets/1002_tray_bottom.STL", "assets/featuretype.STL", "assets/Duck.glb",
    "assets/robot_forearm.obj", "assets/stirrer.obj", "static/c3d_spot.ply",
    "static/trim_star.ply", "static/twelve_dodecahedron.ply", "static/fandisk_6475.ply", "static/block.ply",
    "static/fr_casting.ply", "static/gargoyle_10002.ply", "assets/robot_hand.obj",
    "static/cgal_elephant_with_holes.ply",
)  # fmt: skip
# A way whose first trial promises less is not opened, though a later one may be smaller.
BY_CHANCE = 1.14


@pytest.mark.parametrize("slope", [0.6, 1.0, 1.8])
@pytest.mark.parametrize("first", [0.2, 0.7, 1.0, 1.3, 3.0])
def test_it_uses_up_what_is_allowed(slope: float, first: float) -> None:
    tried: list[float] = []
    secant(lambda step: tried.append(step) or slope * math.log(step), first, 1e-6, 100.0)
    assert math.exp(-SLACK) <= max(step for step in tried if step <= 1.0) ** slope
    assert len(tried) <= 6


def test_it_stays_within_what_there_is() -> None:
    tried: list[float] = []
    secant(lambda step: tried.append(step) or -1.0, 1.0, 1e-3, 2.0)
    assert max(tried) == pytest.approx(2.0)
    tried.clear()
    secant(lambda step: tried.append(step) or 1.0, 1.0, 1e-3, 2.0)
    assert min(tried) >= 1e-3 * (1.0 - 1e-12)


def sizes(
    mesh: TriangleMesh, monkeypatch: pytest.MonkeyPatch, effort: str = "normal"
) -> tuple[int, list[int]]:
    """Bytes with all ways, and with each of them alone."""
    options = EncodeOptions(threads=1, effort=effort)
    encoder = Encoder(mesh, options)
    whole = encoder.draft().size
    alone = []
    for name in dict.fromkeys(event.way for event in encoder.trials if event.action == "estimate"):

        def only(*given: Any, name: str = name) -> list[Way]:
            return [way for way in ways_of(*given) if way.name == name]

        monkeypatch.setattr(search, "ways_of", only)
        with suppress(TargetError):  # no step of this way alone keeps the promise
            alone.append(Encoder(mesh, options).draft().size)
    monkeypatch.setattr(search, "ways_of", ways_of)
    return whole, alone


@pytest.mark.parametrize(
    ("mesh", "rough"), [(torus(40, 24), 0.0), (patch(24, 24), 0.002)], ids=["torus", "patch"]
)
def test_a_further_way_makes_no_file_larger(
    mesh: TriangleMesh, rough: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    noise = np.random.default_rng(0).normal(size=mesh.positions.shape)
    whole, less = sizes(
        replace(mesh, positions=mesh.positions + rough * mesh.diagonal * noise), monkeypatch
    )
    assert whole <= min(less) + 1  # where parts repeat, no places are chosen


@pytest.mark.parametrize(
    "effort", ["quick", "normal", pytest.param("best", marks=pytest.mark.slow)]
)
def test_a_further_way_makes_no_file_with_normals_larger(
    effort: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    mesh = torus(40, 24)
    normals = Attribute("normal", smooth_normals(mesh).astype(np.float32), "vertex", "normal")
    whole, less = sizes(replace(mesh, attributes=(normals,)), monkeypatch, effort)
    assert whole <= BY_CHANCE * min(less)


@pytest.mark.real
@pytest.mark.slow
@pytest.mark.parametrize("name", SOME)
def test_a_further_way_makes_no_real_file_larger(
    name: str, meshes: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole, less = sizes(read_mesh(str(meshes / name)).mesh.bare, monkeypatch)
    assert whole <= BY_CHANCE * min(less)


def test_looks_that_do_not_decide_end_at_one_grid() -> None:
    mesh = torus(14, 10)
    found = {
        Encoder(mesh, EncodeOptions(contract=Contract(1e-3, look=look))).encode()
        for look in (20.0, 30.0)
    }
    assert len(found) == 1


def test_every_way_has_an_estimate_and_the_end_a_reason() -> None:
    encoder = Encoder(torus(40, 24), EncodeOptions(threads=1))
    encoder.encode()
    actions = [event.action for event in encoder.trials]
    bounds = Bounds(encoder._input.measures, encoder.options.promise)
    names = [way.name for way in ways_of(encoder._input.prepared, bounds, encoder.options)]
    assert [event.way for event in encoder.trials if event.action == "estimate"] == names
    assert actions.index("code" if "code" in actions else "draw") >= len(names), (
        "estimates come first"
    )
    assert actions[-1] == "end" and encoder.trials[-1].reason
    drawn = [event for event in encoder.trials if event.action == "draw"]
    assert any(event.error <= 1.0 for event in drawn) and all(event.step > 0.0 for event in drawn)


def test_a_trial_depends_on_its_step_only() -> None:
    mesh, options = torus(40, 24), EncodeOptions(threads=1)
    sizes = []
    for order in (1, -1):
        sent = Encoder(mesh, options)._input
        ways = ways_of(sent.prepared, Bounds(sent.measures, options.promise), options)
        steps = [factor * way.first for way in ways for factor in (1.0, 0.7, 0.5)][::order]
        trials = [way.at(step).draft.size for way in ways[::order] for step in steps]
        sizes.append(trials[::order])
    assert sizes[0] == sizes[1]


@pytest.mark.parametrize("name", [None, "balanced"])
def test_more_bytes_never_look_worse(name: str | None) -> None:
    mesh = torus(40, 24)
    preset = PRESETS[name or "none"]
    usual = len(Encoder(mesh, EncodeOptions(threads=1)).encode())
    looks = []
    for factor in (0.5, 0.8, 1.0, 1.3, 1.7, 2.5, 4.0, 8.0, 20.0):
        options = replace(preset, threads=1, target=Target("size", factor * usual))
        try:
            data = Encoder(mesh, options).encode()
        except TargetError:
            assert factor < 1.0, "the default's own stream fits"
            continue
        assert len(data) <= factor * usual
        looks.append(look(mesh, data).distance)
    assert len(looks) >= 6 and looks == sorted(looks, reverse=True)
    assert looks[-1] < 1e-3, "far beyond the bytes of lossless, nothing is lost"
