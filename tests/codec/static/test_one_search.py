"""The default is the smallest file of its promise, as far as the rule of bytes and decoding time goes."""

from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np
import pytest

from bsm import Contract, EncodeOptions, Encoder, TriangleMesh, read_mesh
from bsm.codec.look.pictures import Canvas
from bsm.codec.static.choice.attributes import Sent
from bsm.codec.static.preamble_encoding import Draft
from tests.shapes import torus


def bumpy() -> TriangleMesh:
    """A torus whose vertices are moved at random."""
    mesh = torus()
    noise = np.random.default_rng(5).normal(0.0, 0.01, mesh.positions.shape)
    return TriangleMesh(mesh.positions + noise, mesh.faces)


@pytest.mark.parametrize(("bound", "binding"), [(0.0002, "vertex error"), (0.01, "look")])
def test_the_encoder_says_what_binds(bound: float, binding: str) -> None:
    encoder = Encoder(
        torus(), EncodeOptions(contract=Contract(bound, look=1.0), threads=1, congruence=False)
    )
    encoder.encode()
    assert encoder.binding == binding


def test_quick_draws_few_pictures() -> None:
    drawn = {"quick": 0, "normal": 0}
    draw = Canvas.draw
    for effort in drawn:

        def counted(*given: Any, effort: str = effort, **words: bool) -> Any:
            drawn[effort] += 1
            return draw(*given, **words)

        with patch.object(Canvas, "draw", counted):
            encoder = Encoder(bumpy(), EncodeOptions(threads=1, effort=effort))
            encoder.encode()
        assert encoder.look is not None and encoder.look <= 1.0
    assert drawn["quick"] <= 30 < drawn["normal"], drawn


@pytest.mark.real
def test_folds_do_not_leave_the_look_unused(meshes: Path) -> None:
    cloth = read_mesh(str(meshes / "assets/cloth.obj")).mesh.bare
    size = Encoder(cloth, EncodeOptions(threads=1)).draft().size
    assert size < 3700  # 3800 with the usual steps along tangents


@pytest.mark.parametrize("scale", [0.7, 1.1, 3.0])
def test_the_last_check_draws_no_grid_again(scale: float) -> None:
    draw, measured = Canvas.draw, Sent.measured
    drawn, last = list[Any](), list[tuple[bool, int]]()

    def counted(*given: Any, **words: Any) -> Any:
        drawn.append(given)
        return draw(*given, **words)

    def checked(given: Sent, draft: Draft, contract: Contract) -> Any:
        before, found = len(drawn), measured(given, draft, contract)
        last.append((draft.places is not None, len(drawn) - before))
        return found

    mesh = torus()
    noise = np.random.default_rng(5).normal(0.0, 0.1, mesh.positions.shape)
    mesh = TriangleMesh(scale * (mesh.positions + noise) + 0.1, mesh.faces)
    with patch.object(Canvas, "draw", counted), patch.object(Sent, "measured", checked):
        Encoder(mesh, EncodeOptions(threads=1)).encode()
    assert last == [(True, 0)]
