"""The preset "paper": one block after the other by orthogonal iterations, as the paper has it."""

import math
import pickle
import sys
from dataclasses import replace

import numpy as np
import pytest

import bsm
from bsm import PRESETS, EncodeOptions, Encoder, OptionError, Paper
from bsm.bitstream.container.wire import FrameType
from bsm.codec.static.ways import block_coder
from bsm.evaluation.curve import paper_options
from bsm.files.inspection import inspect_stream
from tests.shapes import patch, torus
from tools.surgery import frames_of

MESH = torus(60, 40, bumps=0.1)
SMALL = {"block_size": 150, "threads": 1}


def inspected(**options):
    return inspect_stream(iter([bsm.encode(MESH, preset="paper", **{**SMALL, **options})]))


def test_a_preset_gives_what_is_not_given_itself():
    assert EncodeOptions(preset="paper") == PRESETS["paper"]
    assert EncodeOptions(preset="none") == PRESETS["none"]
    assert EncodeOptions(preset="paper", key_interval=8).key_interval == 8  # the default of other presets
    assert EncodeOptions(preset="paper", keep=0.1) == paper_options(keep=0.1, threads=None, limits="default")
    assert EncodeOptions(preset="paper", paper=Paper(power=3)).paper == Paper(power=3)
    options = EncodeOptions(preset="paper", block_size=300)
    assert replace(options, threads=2) == EncodeOptions(preset="paper", block_size=300, threads=2)
    assert pickle.loads(pickle.dumps(options)) == options
    with pytest.raises(OptionError, match="unknown preset 'papers'; did you mean paper"):
        EncodeOptions(preset="papers")


def test_the_stream_is_as_the_paper_has_it():
    info = inspected()
    header, how = info.header, info.header.constants
    assert info.is_paper and info.sizes["partition"] > 0
    assert (how.bits, how.exact, how.power, how.iterations, how.springs) == (12, 1, 2, 1, 0)
    assert (header.key_interval, header.smoothing, header.refinement) == (0, 0.0, ())
    parts = Encoder(MESH, EncodeOptions(preset="paper", **SMALL))._input.prepared.partition
    assert header.block_size == round(1.15 * parts.sizes.max())
    assert not inspect_stream(iter([bsm.encode(MESH, step=0.01)])).is_paper
    assert not inspected(key_interval=4).is_paper
    assert not inspected(key_seed="cosines").is_paper


def test_sizes_follow_the_error_or_are_fixed():
    sizes = inspected(doi=(0.02, 0.03)).coefficients
    assert len(set(sizes)) > 2
    assert set(inspected(coefficients=20).coefficients) == {20}
    info = inspected(keep=0.1)
    assert set(info.coefficients) == {round(0.1 * info.header.block_size)}
    assert max(inspected(keep=0.3, doi=(0.15, 0.2)).coefficients) <= round(0.3 * info.header.block_size)


def test_each_block_has_the_least_size_for_its_error():
    """Whatever number of columns was tried, and however many the first block began with."""
    encoder = Encoder(MESH, EncodeOptions(preset="paper", **SMALL))
    highest = PRESETS["paper"].paper.doi[1]
    blocks, found = encoder._input.prepared.blocks, []
    original = block_coder.offer

    def recorded(chain, residual, *rest):
        dictionary, coefficients = original(chain, residual, *rest)
        found.append(np.linalg.norm(residual - dictionary.astype(float) @ coefficients))
        return dictionary, coefficients

    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(block_coder, "offer", recorded)
        encoder.encode()
    assert len(found) == blocks.count
    assert max(found) <= highest * 1.0001


def test_bounds_that_cannot_be_met_are_an_error():
    with pytest.raises(OptionError, match=r"eps_h = 1e-05 of doi cannot be met: 18 coefficients of a block of 1\d\d "):
        bsm.encode(MESH, preset="paper", keep=0.1, doi=(1e-6, 1e-5), **SMALL)
    with pytest.raises(OptionError, match=r"two thresholds, 0 < eps_l < eps_h"):
        bsm.encode(MESH, preset="paper", doi=(0.2, 0.1))


def test_a_mesh_smaller_than_a_block_is_one_block_and_a_note_says_so():
    encoder = Encoder(patch(6, 7), EncodeOptions(preset="paper"))
    data = encoder.encode()
    assert inspect_stream(iter([data])).header.blocks == 1
    assert "no orthogonal iterations follow" in encoder.notes[-1]
    assert FrameType.BLOCK in [kind for kind, _ in frames_of(data)]
    assert bsm.compare(patch(6, 7), data).max_error_relative < 0.07
    assert not any("one block" in note for note in Encoder(patch(6, 7), EncodeOptions(step=0.01)).notes)


def test_without_metis_the_message_says_how_to_install_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "pymetis", None)
    with pytest.raises(bsm.DependencyError, match=r"METIS.* is not installed; run: pip install 'bsm-codec\[paper\]'"):
        bsm.encode(MESH, preset="paper")


@pytest.mark.parametrize(
    "more", [{"look": 1.0}, {"max_error": 0.01}, {"theta": 3}, {"size": "3kB"}, {"grid": 12}, {"grid_cell": 0.1}]
)
def test_it_promises_nothing_and_has_no_grid(more):
    with pytest.raises(OptionError, match=f"preset paper fixes the coding .* {next(iter(more))}"):
        bsm.encode(MESH, preset="paper", **more)
    assert PRESETS["paper"].promise is None
    with pytest.raises(OptionError):
        bsm.encode(MESH, preset="paper", effort="quick")


def test_a_fixed_size_and_a_size_that_follows_cost_about_the_papers_rate():
    info = inspected(keep=0.1)
    coded = 12 * 3 * sum(info.coefficients) / info.header.vertices
    assert math.isclose(info.bpv_paper, coded)
