"""Whether rounding errors may change what a stream decodes to."""

import numpy as np
import pytest

import bsm
from bsm.cli import main
from bsm.codec.signal import chain
from bsm.codec.static.encoder import encode
from bsm.codec.static.options import EncodeOptions
from bsm.steadiness import NOISE, PEAK, RMS, shaken, unsteadiness
from tests.shapes import patch, tetrahedron, together, torus
from tools.vectors.store import read_manifest

GOOD = [vector for vector in read_manifest() if vector.error is None]


def scattered(**options):
    """A torus, and forty tetrahedra: every one has a lowest frequency of its own. All of it is one block."""
    mesh = together(*(tetrahedron() for _ in range(40)), torus(16, 10))
    rest = {"step": 1e-4, "keep": 1.0, "block_size": 2000, "smoothing": 0.0, "threads": 1, "limits": "wide"}
    return encode(mesh, EncodeOptions(**rest, **options))


@pytest.fixture
def plain_starts(monkeypatch):
    """Blocks in pieces start like others, as they must not."""
    monkeypatch.setattr(chain, "in_pieces", lambda block: False)


def test_noise_is_small_and_everywhere():
    values = np.zeros((50, 2))
    values[0] = 3.0, 4.0
    noise = np.abs(shaken(values) - values)
    assert 0.0 < noise[:, 1].max() <= 4.0 * NOISE + 1e-17 and (noise[1:] > 0).all()


@pytest.mark.parametrize("vector", GOOD[::4], ids=[vector.name for vector in GOOD[::4]])
def test_vectors_are_steady(vector):
    rms, peak = unsteadiness(vector.stream.read_bytes(), threads=1)
    assert rms <= RMS and peak <= PEAK


@pytest.mark.parametrize(
    "options", [{}, {"key_interval": 0}, {"key_seed": "svd"}, {"power": 16}, {"key_iterations": 40}]
)
def test_pieces_do_not_magnify_rounding_errors(options):
    assert 0.0 < unsteadiness(scattered(**options), limits=bsm.Limits.wide())[1] < 1e-11


def test_without_noise_in_their_start_they_would(plain_starts, tmp_path, capsys):
    stream = scattered()
    assert unsteadiness(stream)[1] > 0.01
    with pytest.raises(bsm.NumericError, match="rounding errors"):
        bsm.check_steadiness(stream)
    (tmp_path / "a.bsm").write_bytes(stream)
    assert main(["verify", "--steady", str(tmp_path / "a.bsm")]) == 7
    assert "rounding errors" in capsys.readouterr().err


def test_verify_says_what_is_steady(tmp_path):
    (tmp_path / "a.bsm").write_bytes(encode(patch(12, 9), EncodeOptions(step=1e-3, threads=1)))
    assert main(["verify", "--steady", str(tmp_path / "a.bsm")]) == 0
    assert main(["verify", "--steady", "--quick", str(tmp_path / "a.bsm")]) == 2


def test_sequences_and_grids():
    streams = {vector.name: vector.stream.read_bytes() for vector in GOOD}
    assert unsteadiness(streams["good-grid"]) == (0.0, 0.0)
    assert 0.0 < bsm.unsteadiness(streams["good-sequence-learnt"])[1] < 1e-10
