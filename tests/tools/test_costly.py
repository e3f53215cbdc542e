"""Small files that take long to encode: their pictures are bounded, and the search for worse ones is sound."""

from random import Random

import numpy as np
import pytest

import bsm
from bsm.codec.look.pictures import Canvas
from tools.attack.costly import KINDS, Recipe, changed, drawn, encoded, search
from tools.attack.costly_files import FILES, File, changed_file, drawn_file, read_file

FEWER = 2.5e8  # samples that a search may draw, about a second


@pytest.fixture
def samples(monkeypatch):
    """About how many samples each picture takes: those of the picture, and on average half the area of each face."""
    taken, draw = [], Canvas.draw

    def counting(canvas, positions, faces, normals, camera, **words):
        a, b, c = (positions[corner] for corner in faces.T)
        areas = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
        taken.append((1 + areas / 2 / np.ptp(positions, axis=0).max() ** 2) * canvas.samples.size)
        return draw(canvas, positions, faces, normals, camera, **words)

    monkeypatch.setattr(Canvas, "draw", counting)
    return taken


@pytest.mark.parametrize(
    ("shape", "vertices", "faces"),
    [("copies", 3, 1000), ("planes", 300, 100), ("slivers", 60, 300), ("random", 10, 800)],
)
def test_what_is_drawn_for_small_files_is_bounded_whatever_covers_what(
    samples, shape, vertices, faces
):
    taken = encoded(Recipe(shape, vertices, faces, 0.0, "none", "balanced", 1).ply, "balanced")
    assert taken.outcome.endswith(" bytes")
    assert 0 < sum(samples) < FEWER


@pytest.mark.parametrize("kind", KINDS)
def test_what_is_drawn_for_every_kind_is_bounded(samples, kind):
    of = KINDS[kind]
    recipe = Recipe(of.shapes[0], 30, 60, 0.1, of.attributes[-1], of.presets[0], 3)
    taken = encoded(recipe.ply, recipe.preset, kind)
    assert taken.outcome.endswith(" bytes") and not taken.escaped
    assert (sum(samples) > 0) == (kind != "paper")
    assert sum(samples) < 2 * FEWER  # a long polygon of any corners covers more than most soups


def test_recipes_are_files_that_are_read_and_mutants_are_others():
    random = Random("recipes")
    recipe = drawn(random)
    for _ in range(20):
        recipe = changed(recipe, random)
        small = Recipe(
            **{
                **vars(recipe),
                "vertices": min(recipe.vertices, 300),
                "faces": min(recipe.faces, 300),
            }
        )
        try:
            assert len(bsm.load(small.ply, limits=bsm.Limits.service()).faces)
        except bsm.MeshError as error:
            assert str(error)


@pytest.mark.parametrize("kind", FILES)
def test_files_that_repeat_something_are_read_or_refused(kind):
    if kind == "xdmf":
        pytest.importorskip("lxml", reason="needs the extra simulation")
    assert read_file(File(kind, ())).outcome.endswith(" bytes")
    for way in FILES[kind][2]:
        taken = read_file(File(kind, ((way, 40),)))
        assert taken.outcome.endswith(" bytes") or "Error: " in taken.outcome, way
    random, file = Random(kind), drawn_file(kind, Random(kind))
    assert any(changed_file(file, random).data != file.data for _ in range(9))


@pytest.mark.slow
def test_a_short_search_finds_no_file_over_the_bound():
    worst = search(30.0, "test")
    assert worst[0][0] <= 6.0, worst[0]  # on a slow core, as src/bsm/SERVICE.md says
