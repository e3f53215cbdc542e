"""Made shapes and the training on them: closed, oriented, deterministic; and something is learnt."""

from functools import partial
from pathlib import Path

import numpy as np
import pytest

from bsm.codec.denoise.learnt import BASE, read_networks
from bsm.codec.denoise.surface import Topology
from tools.made_shapes import made_shape
from tools.train_denoiser import described, example, improved, train


@pytest.mark.parametrize("seed", range(6))
def test_made_shapes_are_closed_look_outwards_and_are_repeated(seed: int) -> None:
    positions, faces = made_shape(seed, 18)
    assert np.isfinite(positions).all() and len(faces) > 100
    assert not Topology(faces, len(positions)).boundary.any()
    corners = positions[faces]
    assert np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() > 0.0
    again, other = made_shape(seed, 18)
    assert (again == positions).all() and (other == faces).all()


@pytest.mark.slow
def test_training_learns_and_is_repeated() -> None:
    pytest.importorskip("torch")
    parts = [described(case) for case in map(partial(example, Path()), range(3)) if case]
    first, again = (train(parts, 1, rounds=150) for _ in range(2))
    numbers, wanted = map(np.concatenate, zip(*parts))
    apart = np.linalg.norm(first(numbers) - wanted, axis=1).mean()
    assert apart < 0.9 * np.linalg.norm(numbers[:, BASE] - wanted, axis=1).mean()
    assert (first(numbers) == again(numbers)).all()


def test_a_stage_brings_an_example_nearer_to_the_truth() -> None:
    case = example(Path(), 10**6)
    seen = map(described, (case, improved(read_networks()[0], case)))
    before, after = (
        np.linalg.norm(numbers[:, BASE] - wanted, axis=1).mean() for numbers, wanted in seen
    )
    assert after < 0.9 * before
