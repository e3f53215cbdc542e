"""A search that returns a value too coarse is found out: nothing is written, and the exit code is 10."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import bsm
from bsm import PRESETS, Attribute, Contract, EncodeOptions, Encoder, Target, TriangleMesh, encode
from bsm.codec.look.measure import LookMetric, own_normals
from bsm.codec.static import encoder
from bsm.codec.static.choice import attributes, grids
from bsm.codec.static.choice.bounds import Bounds
from bsm.codec.static.choice.search import OneSearch, Search
from bsm.codec.static.choice.trials import Trial
from bsm.ground.exits import exit_of
from tests.shapes import patch

MESH = patch(12, 12)
COARSE = 3  # bits of a grid that keeps no promise


def shaded(mesh: TriangleMesh, zero: int = 0) -> TriangleMesh:
    """A mesh with normals at vertices, some of no length."""
    normals = np.tile([0.0, 0.0, 1.0], (len(mesh.positions), 1))
    normals[:, :2] = 0.3 * np.sin(9.0 * mesh.positions[:, :2])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    normals[:zero] = 0.0
    return replace(
        mesh, attributes=(Attribute("normal", normals.astype(np.float32), "vertex", "normal"),)
    )


def colored(mesh: TriangleMesh) -> TriangleMesh:
    colors = (0.5 + 0.5 * np.sin(9.0 * mesh.positions)).astype(np.float32)
    return replace(mesh, attributes=(Attribute("color", colors, "vertex", "color"),))


def rounded(given: Search, *_: object) -> object:
    return grids.rounded(given.prepared, COARSE)


def the_coarsest_step(
    attempt: Callable[[float], object], target: Target, first: float, *_: object
) -> object:
    return attempt(first / 10.0 if target.shrinks_with_step else first * 10.0)


def the_coarsest_trial(search: OneSearch, *_: object) -> None:
    search.best = search.prospects[0].way.at(0.05)


BROKEN = {
    "the smallest stream": (MESH, {}, Search, "smallest", rounded),
    "an angle": (MESH, {"target": Target("theta_deg", 0.5)}, Search, "smallest", rounded),
    "a visual error": (MESH, {"target": Target("nmsve_db", -60.0)}, Search, "smallest", rounded),
    "a bound": (MESH, {"contract": Contract(1e-4)}, Search, "smallest", rounded),
    "whether bounds are kept": (MESH, {}, OneSearch, "run", the_coarsest_trial),
    "normals": (shaded(MESH), {}, attributes, "bisect_left", lambda values, *_, **__: 0),
    "colors": (colored(patch(20, 20)), {}, attributes, "bisect_left", lambda values, *_, **__: 0),
    "a step": (
        MESH,
        {"target": Target("nmsve_db", -60.0), "coefficients": 30},
        encoder,
        "search_step",
        the_coarsest_step,
    ),
    "a size": (
        MESH,
        {"target": Target("size", 100), "coefficients": 30},
        encoder,
        "search_step",
        the_coarsest_step,
    ),
}


@pytest.mark.parametrize("name", BROKEN)
def test_a_broken_search_is_found_out(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    mesh, options, owner, attribute, broken = BROKEN[name]
    monkeypatch.setattr(owner, attribute, broken)
    with pytest.raises((bsm.VerificationError, bsm.TargetError)) as caught:
        list(Encoder(mesh, EncodeOptions(threads=1, **options)).chunks())
    assert exit_of(caught.value).code == 10


def test_the_smallest_stream_stands_for_a_broken_best_one_of_a_size(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(Search, "best", rounded)
    options = EncodeOptions(threads=1, target=Target("size", 2000))
    data = encode(MESH, options)
    assert len(data) <= 2000 and options.promise is not None
    assert LookMetric(MESH).compare(bsm.decode(data)).distance <= options.promise.look


@pytest.mark.parametrize("preset", ["small", "balanced", "fine"])
@pytest.mark.parametrize("zero", [0, 1, 40])
def test_the_look_holds_with_normals_of_no_length(preset: str, zero: int) -> None:
    mesh, options = shaded(MESH, zero), replace(PRESETS[preset], threads=1)
    made = Encoder(mesh, options)
    decoded = bsm.decode(made.encode())
    assert LookMetric(mesh).compare(decoded).distance <= options.promise.look * 1.001
    own = own_normals(decoded)
    lengths = np.square(own.reshape(-1, 3)).sum(axis=1)
    assert (lengths < 0.5).sum() == np.isin(mesh.faces, np.arange(zero)).sum()


def test_a_draft_is_judged_by_what_is_decoded(tmp_path: Path) -> None:
    made = Encoder(shaded(MESH), EncodeOptions(threads=1))
    draft, promise = made.draft(), made.options.promise
    assert made._input.measured(draft, promise)[0] == ""
    assert "look" in made._input.measured(draft, replace(promise, look=promise.look / 50.0))[0]
    assert "vertex" in made._input.measured(draft, replace(promise, farthest=1e-7))[0]
    decoded = Trial(0.0, made._input.prepared.units.into(draft.decoded), lambda: draft)
    assert Bounds(made._input.measures, promise).keeps(decoded)
    assert len(encode(MESH, EncodeOptions(threads=1))) > 0


def test_places_in_a_texture_that_repeats_are_kept_although_pictures_do_not_show_them() -> None:
    places = 10.0 * MESH.positions[:, :2] / np.ptp(MESH.positions[:, :2]) * 12
    mesh = replace(
        MESH, attributes=(Attribute("uv", places.astype(np.float32), "vertex", "texcoord"),)
    )
    found = bsm.decode(bsm.encode(mesh, keep_order=True, threads=1)).attributes[0].values
    assert np.abs(found - places).max() < 1.0 / 128.0


@pytest.mark.parametrize("quality", ["2bits", "20deg", "0.5", "100%"])
def test_a_quality_of_normals_that_breaks_the_look_is_refused(quality: str) -> None:
    with pytest.raises(bsm.TargetError, match="this quality of normals"):
        encode(shaded(MESH), EncodeOptions(attributes=(("normal", quality),)))


@pytest.mark.parametrize("quality", ["0.005", "0.5%", "10bits", "exact"])
def test_normals_of_no_length_keep_none(quality: str) -> None:
    given = shaded(MESH, 30)
    found = (
        bsm.decode(encode(given, EncodeOptions(attributes=(("normal", quality),))))
        .attributes[0]
        .values
    )
    assert (np.linalg.norm(found, axis=1) == 0.0).sum() == 30
