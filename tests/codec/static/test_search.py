"""The search for a step: it ends near its bound, asks little, and another way never makes a file larger."""

import math
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from bsm import Attribute, Contract, EncodeOptions, Encoder, TargetError, TriangleMesh, read_mesh
from bsm.codec.static.choice.bounds import Bounds
from bsm.codec.static.choice.grids import Gridded
from bsm.codec.static.choice.search import Search, Way
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
BY_CHANCE = 1.14  # a way whose first trial promises less is not opened, though a later one may be smaller


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


def sizes(mesh: TriangleMesh, monkeypatch: pytest.MonkeyPatch, effort: str = "normal") -> tuple[int, list[int]]:
    """Bytes with all ways, and with each of them alone."""
    everything = Search._ways
    options = EncodeOptions(threads=1, effort=effort)
    found = [Encoder(mesh, options).draft().size]
    for alone in range(len(everything(*_asked(mesh, options)))):

        def size(search: Search, bounds: Bounds, grid: Gridded, alone: int = alone) -> list[Way]:
            return [everything(search, bounds, grid)[alone]]

        monkeypatch.setattr(Search, "_ways", size)
        with suppress(TargetError):  # no step of this way alone keeps the promise
            found.append(Encoder(mesh, options).draft().size)
        monkeypatch.setattr(Search, "_ways", everything)
    return found[0], found[1:]


def _asked(mesh: TriangleMesh, options: EncodeOptions) -> tuple[Search, Bounds, Gridded]:
    encoder, contract = Encoder(mesh, options), options.promise
    search = encoder._input.search
    bounds = Bounds(search._measures, contract)
    return search, bounds, Gridded(search._prepared, bounds)


@pytest.mark.parametrize(("mesh", "rough"), [(torus(40, 24), 0.0), (patch(24, 24), 0.002)], ids=["torus", "patch"])
def test_a_further_way_makes_no_file_larger(mesh: TriangleMesh, rough: float, monkeypatch: pytest.MonkeyPatch) -> None:
    noise = np.random.default_rng(0).normal(size=mesh.positions.shape)
    whole, less = sizes(replace(mesh, positions=mesh.positions + rough * mesh.diagonal * noise), monkeypatch)
    assert whole <= min(less) + 1  # where parts repeat, no places are chosen


@pytest.mark.parametrize("effort", ["quick", "normal", pytest.param("best", marks=pytest.mark.slow)])
def test_a_further_way_makes_no_file_with_normals_larger(effort: str, monkeypatch: pytest.MonkeyPatch) -> None:
    mesh = torus(40, 24)
    normals = Attribute("normal", smooth_normals(mesh).astype(np.float32), "vertex", "normal")
    whole, less = sizes(replace(mesh, attributes=(normals,)), monkeypatch, effort)
    assert whole <= BY_CHANCE * min(less)


@pytest.mark.real
@pytest.mark.slow
@pytest.mark.parametrize("name", SOME)
def test_a_further_way_makes_no_real_file_larger(name: str, meshes: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    whole, less = sizes(read_mesh(str(meshes / name)).mesh.bare, monkeypatch)
    assert whole <= BY_CHANCE * min(less)


def test_looks_that_do_not_decide_end_at_one_grid() -> None:
    mesh = torus(14, 10)
    found = {Encoder(mesh, EncodeOptions(contract=Contract(1e-3, look=look))).encode() for look in (20.0, 30.0)}
    assert len(found) == 1
