"""Small files that take long to encode: their pictures are bounded, and the search for worse ones is sound."""

import json
from contextlib import suppress
from random import Random

import pytest

import bsm
from bsm.codec.look.measure import LookMetric
from tools.attack.costly import Recipe, changed, drawn, encoded, search
from tools.attack.manifests import Folder, used, walk

FEWER = 2.5e8  # samples that a search may draw, about a second
WORST = 6e8  # and where it looks at attributes, too


@pytest.fixture
def metrics(monkeypatch):
    """Every `LookMetric` that is made."""
    made, begin = [], LookMetric.__init__
    monkeypatch.setattr(
        LookMetric, "__init__", lambda self, *args, **named: made.append(self) or begin(self, *args, **named)
    )
    return made


@pytest.mark.parametrize(
    ("shape", "vertices", "faces"),
    [("copies", 3, 1000), ("planes", 300, 100), ("slivers", 60, 300), ("random", 10, 800)],
)
def test_what_is_drawn_for_small_files_is_bounded_whatever_covers_what(metrics, shape, vertices, faces):
    taken = encoded(Recipe(shape, vertices, faces, 0.0, "none", "balanced", 1).ply, "balanced")
    assert taken.outcome.endswith(" bytes")
    assert metrics
    assert sum(metric._drawn_pictures * metric._size.work for metric in metrics) < FEWER


def test_recipes_are_files_that_are_read_and_mutants_are_others():
    random = Random("recipes")
    recipe = drawn(random)
    for _ in range(20):
        recipe = changed(recipe, random)
        small = Recipe(**{**vars(recipe), "vertices": min(recipe.vertices, 300), "faces": min(recipe.faces, 300)})
        try:
            assert len(bsm.load(small.ply, limits=bsm.Limits.service()).faces)
        except bsm.MeshError as error:
            assert str(error)


@pytest.mark.slow
def test_a_short_search_finds_no_file_over_the_bound():
    worst = search(30.0, "test")
    assert worst[0][0] <= 6.0, worst[0]  # on a slow core, as src/bsm/SERVICE.md says


@pytest.mark.slow
@pytest.mark.parametrize(("vertices", "faces"), [(2, 300), (2, 4924), (5, 2075)])
def test_what_is_drawn_for_the_worst_files_that_a_search_has_found_is_bounded(metrics, vertices, faces):
    with suppress(bsm.TargetError):
        recipe = Recipe("grid", vertices, faces, 0.0, "normal", "near-lossless", 18864366)
        bsm.encode(bsm.load(recipe.ply), preset=recipe.preset, threads=1)
    drawn = sum(metric._drawn_pictures * metric._size.work for metric in metrics)
    assert 0 < drawn < WORST


def test_mutated_manifests_end_in_results_or_errors_of_ours():
    assert not list(walk(60, "sample"))


@pytest.mark.slow
def test_many_mutated_manifests_end_in_results_or_errors_of_ours():
    assert not list(walk(2000, "many"))


def test_a_sound_folder_is_used_and_what_escapes_is_seen(tmp_path, monkeypatch):
    folder = Folder(tmp_path / "tiles")
    used(str(folder.path))
    assert json.loads((folder.path / "manifest.json").read_text()) == folder.manifest
    monkeypatch.setattr("tools.attack.manifests.used", lambda path: 1 // 0)
    (problem,) = walk(1, "a")
    assert "ZeroDivisionError" in problem
