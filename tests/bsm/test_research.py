"""bsm.research: ideas of one's own in the codec."""

import numpy as np
import pytest

import bsm
from bsm import research
from tests.shapes import knot, patch, torus

MESH = knot(2000)
PARTS = patch(20, 15), torus(20, 15), torus(15, 20), torus(24, 9)


def eigenvectors(site, width):
    return np.linalg.eigh(site.laplacian + np.diag(site.springs))[1][:, :width]


def constant(site):
    return np.zeros((site.size, 3)) + site.prediction.mean(axis=0)


def short(site):
    return 0.95 * site.prediction


def stripes(offsets, neighbors, parts):
    return np.arange(len(offsets) - 1) * parts // (len(offsets) - 1)


def test_nothing_of_ones_own_is_the_codec():
    step = 0.01
    assert research.encode(MESH, step=step, threads=1).data == bsm.encode(
        MESH, step=step, threads=1
    )


def test_the_codecs_own_dictionary_and_predictor_change_nothing():
    same = research.Idea(research.Site.ours, lambda site: site.prediction)
    stream, mesh = research.encode(MESH, same, step=0.01)
    ours = research.encode(MESH, step=0.01)
    assert stream == research.MARK + ours.data
    assert np.array_equal(mesh.positions, ours.mesh.positions)
    assert np.array_equal(mesh.positions, bsm.decode(ours.data).positions)


@pytest.mark.slow
@pytest.mark.parametrize(
    "idea",
    [research.Idea(dictionary=eigenvectors), research.Idea(predictor=constant)],
    ids=["dictionary", "predictor"],
)
def test_what_is_encoded_with_an_idea_comes_with_its_mesh(idea):
    data, decoded = research.encode(MESH, idea, step=0.01)
    assert bsm.compare(MESH, decoded).max_error_relative < 0.2
    with pytest.raises(bsm.FormatError):
        bsm.decode(data)


def test_a_partition_is_sent_and_any_decoder_decodes_it():
    data, mesh = research.encode(
        MESH, research.Idea(partition=stripes), step=0.01, block_size=300, keep_order=True
    )
    decoded = bsm.decode(data)
    assert bsm.compare(MESH, decoded).max_error_relative < 0.05
    assert np.array_equal(decoded.positions, mesh.positions) and np.array_equal(
        decoded.faces, mesh.faces
    )
    found = research.blocks(MESH, research.Idea(partition=stripes), block_size=300)
    assert len(found) == round(len(MESH.positions) / 300)


def test_blocks_are_what_the_codec_works_on():
    found = research.blocks(MESH, step=0.01, block_size=400)
    assert {vertex for block in found for vertex in block.site.vertices} == set(
        range(len(MESH.positions))
    )
    for block in found:
        site, columns = block.site, block.dictionary
        np.testing.assert_allclose(columns.T @ columns, np.eye(columns.shape[1]), atol=1e-5)
        np.testing.assert_allclose(site.laplacian.sum(axis=0), 0)
        assert block.coefficients.shape == (columns.shape[1], 3) and "vertices" in repr(site)
    # Later blocks are held by earlier ones, and close to where they are expected.
    assert not found[0].site.springs.any() and all(block.site.springs.any() for block in found[1:])
    error = np.abs(found[-1].positions - found[-1].site.prediction)
    assert error.mean() < np.abs(found[0].positions - found[0].site.prediction).mean()


@pytest.mark.parametrize(
    ("idea", "error", "words"),
    [
        (
            research.Idea(dictionary=lambda site, width: np.zeros((site.size, 2))),
            bsm.ArgumentError,
            "shape",
        ),
        (
            research.Idea(dictionary=lambda site, width: np.full((site.size, width), np.nan)),
            bsm.ArgumentError,
            "finite",
        ),
        (research.Idea(predictor=lambda site: site.ours(3)), bsm.OptionError, "not known"),
        (
            research.Idea(partition=lambda offsets, neighbors, parts: [0.5]),
            bsm.ArgumentError,
            "integers",
        ),
    ],
)
def test_what_cannot_be_is_reported(idea, error, words):
    with pytest.raises(error, match=words):
        research.encode(MESH, idea, step=0.01)


def test_an_idea_that_gives_another_thing_each_time_is_refused():
    random = np.random.default_rng(0)
    idea = research.Idea(
        predictor=lambda site: site.prediction + random.normal(size=(site.size, 3))
    )
    with pytest.raises(bsm.OptionError, match="returns different values"):
        research.encode(MESH, idea, step=0.01)


def test_curves_are_measured_beside_ours():
    found = research.curves(MESH, {"short": research.Idea(predictor=short)}, (0.02, 0.01, 0.005))
    assert found["ours"]["bytes_of_ours"] == 1.0 < found["short"]["bytes_of_ours"]
    assert [len(result["points"]) for result in found.values()] == [3, 3]
    with pytest.raises(bsm.OptionError, match="choose another one"):
        research.curves(MESH, {"ours": research.Idea()})


def test_parts_are_decoded_one_after_the_other_as_they_were_encoded():
    """A part of another size begins anew, and after one of its size a part takes one iteration from its basis."""
    pytest.importorskip("zstandard", reason="needs zstandard (extra paper)")
    encoder, decoder, streams = research.PartCoder(), research.PartCoder(), []
    for mesh in PARTS:
        data, expected = encoder.encode(mesh)
        decoded = decoder.decode(data)
        assert np.array_equal(decoded.positions, expected.positions)
        assert np.array_equal(decoded.faces, expected.faces)
        edges = np.linalg.norm(np.diff(mesh.positions[mesh.faces[:, :2]], axis=1), axis=2).mean()
        assert bsm.compare(mesh, decoded).rms <= 0.31 * edges
        streams.append(data)
    alone = [research.PartCoder().encode(mesh).data for mesh in PARTS]
    assert alone[0] == streams[0] and alone[1] != streams[1] and alone[3] == streams[3]
    for others in ([], [streams[0], streams[3]], streams[:2]):
        decoder = research.PartCoder()
        for data in others:
            decoder.decode(data)
        with pytest.raises(bsm.CorruptError, match="does not follow"):
            decoder.decode(streams[1])


def test_what_is_no_part_is_refused():
    pytest.importorskip("zstandard", reason="needs zstandard (extra paper)")
    data, _ = research.PartCoder().encode(PARTS[0])
    others = (
        bsm.encode(MESH, preset="paper"),
        research.MARK + bsm.encode(MESH),
        data[len(research.MARK) :],
        data[:-9],
    )
    changed = (data[:at] + bytes([data[at] ^ 1]) + data[at + 1 :] for at in range(0, len(data), 5))
    for other in (*others, *changed, b""):
        with pytest.raises(bsm.BsmError):
            research.PartCoder().decode(other)
    with pytest.raises(bsm.LimitError):
        research.PartCoder(limits="service", keep=1.0).encode(patch(60, 60))


def test_what_a_part_cannot_have_is_refused_before_anything_is_coded():
    with pytest.raises(bsm.MeshError, match="at most 8192 vertices, not 8464; cut it"):
        research.PartCoder().encode(patch(92, 92))
    for wrong in (
        {"bits": None},
        {"keep_order": True},
        {"block_size": 100},
        {"partition": "metis"},
        {"look": 1.0},
    ):
        with pytest.raises(bsm.OptionError, match=f"a part cannot have {next(iter(wrong))}"):
            research.PartCoder(**wrong)
