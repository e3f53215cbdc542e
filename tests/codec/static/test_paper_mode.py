"""The preset "paper": one block after the other by orthogonal iterations, as the paper has it."""

import math
import pickle
import re
from dataclasses import replace

import numpy as np
import pytest

import bsm
from bsm import PRESETS, EncodeOptions, Encoder, Limits, OptionError, Paper, TriangleMesh
from bsm.bitstream.container.wire import FrameType
from bsm.bitstream.limits import NAMED_LIMITS
from bsm.codec.geometry.metrics import mean_edge_length
from bsm.codec.signal.chain import Chain
from bsm.codec.static.ways import block_coder
from bsm.encoding.options import encode_options
from bsm.evaluation.curve import paper_options
from tests.bsm.program import python
from tests.shapes import patch, tetrahedron, together, torus
from tests.streams import info_of
from tools.surgery import frames_of

MESH = torus(60, 40, bumps=0.1)
SMALL = {"block_size": 150, "threads": 1}


def inspected(**options):
    return info_of(bsm.encode(MESH, preset="paper", **{**SMALL, **options}))


def test_a_preset_gives_what_is_not_given_itself():
    assert EncodeOptions(preset="paper") == PRESETS["paper"]
    assert EncodeOptions(preset="none") == PRESETS["none"]
    # The default of other presets.
    assert EncodeOptions(preset="paper", key_interval=8).key_interval == 8
    assert EncodeOptions(preset="paper", keep=0.1) == paper_options(
        keep=0.1, threads=None, limits="default"
    )
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
    assert not info_of(bsm.encode(MESH, step=0.01)).is_paper
    others = (
        {"key_interval": 4},
        {"key_seed": "cosines"},
        {"power": 9},
        {"iterations": 3},
        {"partition": "derived"},
    )
    for other in (*others, {"overlap": 1.05}, {"bits": 10}, {"shift": 0.1}):
        assert not inspected(**other).is_paper
    assert inspected(keep=0.1).is_paper and inspected(block_size=300).is_paper
    assert info_of(bsm.encode(patch(6, 7), preset="paper")).is_paper


def test_sizes_follow_the_error_or_are_fixed():
    sizes = inspected(doi=(0.06, 0.08)).coefficients
    assert len(set(sizes)) > 2
    assert set(inspected(coefficients=20).coefficients) == {20}
    info = inspected(keep=0.1)
    assert set(info.coefficients) == {round(0.1 * info.header.block_size)}
    assert max(inspected(keep=0.3, doi=(0.4, 0.5)).coefficients) <= round(
        0.3 * info.header.block_size
    )


def test_each_block_has_the_least_size_for_its_error():
    """Whatever number of columns was tried, and however many the first block began with; in mean edge lengths."""
    encoder = Encoder(MESH, EncodeOptions(preset="paper", **SMALL))
    prepared = encoder._input.prepared
    highest = PRESETS["paper"].paper.doi[1] * mean_edge_length(
        prepared.positions, prepared.mesh.faces
    )
    blocks, found = prepared.blocks, []
    original = block_coder.offer

    def recorded(chain, residual, *rest):
        dictionary, coefficients = original(chain, residual, *rest)
        found.append(
            np.linalg.norm(residual - dictionary.astype(float) @ coefficients)
            / len(residual) ** 0.5
        )
        return dictionary, coefficients

    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(block_coder, "offer", recorded)
        encoder.encode()
    assert len(found) == blocks.count
    assert 0.8 * highest < np.mean(found) and max(found) <= highest * 1.0001


def test_where_eps_h_cannot_be_met_a_note_says_so():
    encoder = Encoder(MESH, EncodeOptions(preset="paper", keep=0.1, doi=(1e-6, 1e-5), **SMALL))
    encoder.encode()
    count = encoder._input.prepared.blocks.count
    assert f"eps_h is exceeded in {count} of {count} blocks" in encoder.losses[-1]
    with pytest.raises(OptionError, match=r"two thresholds, 0 < eps_l < eps_h"):
        bsm.encode(MESH, preset="paper", doi=(0.2, 0.1))


def test_a_mesh_smaller_than_a_block_is_one_block_and_a_note_says_so():
    encoder = Encoder(patch(6, 7), EncodeOptions(preset="paper"))
    data = encoder.encode()
    assert info_of(data).header.blocks == 1
    assert "no orthogonal iterations follow" in encoder.notes[-1]
    assert FrameType.BLOCK in [kind for kind, _ in frames_of(data)]
    assert bsm.compare(patch(6, 7), data).max_error_relative < 0.07
    assert not any(
        "one block" in note for note in Encoder(patch(6, 7), EncodeOptions(step=0.01)).notes
    )


def test_without_metis_our_rule_cuts_and_a_note_says_so(tmp_path):
    bsm.save(MESH, tmp_path / "a.ply")
    words = ["encode", tmp_path / "a.ply", "--preset", "paper"]
    without = "import sys; sys.modules['pymetis'] = None; from bsm.cli import main; sys.exit(main(sys.argv[1:]))"
    done = python("-c", without, *words, text=True)
    assert done.returncode == 0, done.stderr
    assert re.search(
        "METIS .* is not installed: BSM's own rule cuts the mesh into parts", done.stderr
    )
    data = (tmp_path / "a.bsm").read_bytes()
    assert len(bsm.decode(data).faces) == len(MESH.faces)
    info = info_of(data)
    assert info.sizes["partition"] == 0 and not info.is_paper


@pytest.mark.parametrize(
    "more", [{"look": 1.0}, {"max_error": 0.01}, {"grid": 12}, {"grid_cell": 0.1}]
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


def test_coefficients_are_as_many_as_decoders_grant(monkeypatch):
    granted = Limits(work=2e7, work_per_vertex=0.0, work_per_byte=0.0)
    monkeypatch.setitem(NAMED_LIMITS, "default", lambda: granted)
    encoder = Encoder(MESH, EncodeOptions(preset="paper", doi=(1e-7, 1e-6), **SMALL))
    info = info_of(data := encoder.encode())
    assert (
        max(info.coefficients) < info.header.block_size / 2
        and "eps_h is exceeded" in encoder.losses[-1]
    )
    assert bsm.decode(data, limits=granted).faces.shape == MESH.faces.shape
    with pytest.raises(OptionError, match="decoders with default limits would refuse this stream"):
        bsm.encode(MESH, preset="paper", keep=0.5, **SMALL)


@pytest.mark.parametrize(
    "target", [{"nmsve_db": -42.0}, {"theta": 6.0}, {"bpv": 8.0}, {"size": 2500}]
)
def test_a_quality_or_a_rate_is_reached_by_eps(target):
    encoder = Encoder(MESH, encode_options(preset="paper", **target, **SMALL))
    found = encoder.result()
    assert -0.1 < encoder.options.target.excess(found) <= 0.0
    assert info_of(b"".join(found.frames)).is_paper and not encoder.losses


def test_a_target_and_a_given_c_exclude_each_other():
    with pytest.raises(
        OptionError, match="a target is reached by doi; it excludes keep and coefficients"
    ):
        bsm.encode(MESH, preset="paper", keep=0.1, theta=3.0)


SHEET = TriangleMesh(
    np.array([(i // 2, i % 2, 0.1 * (i % 3)) for i in range(60)]),
    np.arange(58)[:, None] + np.arange(3),
)
ODD = {
    "a point": TriangleMesh(np.zeros((1, 3)), np.zeros((1, 3), np.int32)),
    "a triangle": TriangleMesh(np.eye(3), np.array([(0, 1, 2)], np.int32)),
    "a strip": SHEET,
    "an open sheet": patch(20, 20),
    "components": together(*[tetrahedron()] * 12),
}


@pytest.mark.parametrize("name", ODD)
def test_every_mesh_gives_a_stream(name):
    assert bsm.compare(ODD[name], bsm.encode(ODD[name], preset="paper")).max_error_relative < 0.1


def test_an_exact_basis_is_made_once_and_is_the_same_at_any_width():
    encoder = Encoder(MESH, EncodeOptions(preset="paper", **SMALL))
    prepared, rules = encoder._input.prepared, encoder._spectral._rules()
    fresh = Chain(rules, replace(prepared.blocks))
    fresh.begin(0)
    narrow = fresh.dictionary(20)
    wide = fresh.dictionary(60)
    assert fresh.is_exact and fresh.held == 60
    assert np.array_equal(wide[:, :20], narrow)
    again = Chain(rules, fresh._blocks)
    vertices, *_ = again.begin(0)
    assert again.held == 60
    assert np.shares_memory(again.dictionary(60), fresh.dictionary(60))  # and not made again
    kept = again.dictionary(30)
    assert np.array_equal(kept, wide[:, :30])
    again.commit(30, np.ascontiguousarray(prepared.positions[vertices]))
    again.begin(1)
    assert not again.is_exact  # a block of the same size follows


def test_bytes_do_not_depend_on_what_is_kept(monkeypatch):
    expected = bsm.encode(MESH, preset="paper", **SMALL)
    monkeypatch.setattr("bsm.codec.signal.chain.HELD", 0)
    assert bsm.encode(MESH, preset="paper", **SMALL) == expected
