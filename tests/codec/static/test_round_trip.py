import numpy as np
import pytest

import bsm
from bsm.codec.geometry.metrics import compare
from bsm.codec.static.units import Units
from bsm.encoding.options import encode_options
from tests.shapes import patch, tetrahedron, together, torus
from tests.streams import events_of

SMALL = {"block_size": 120, "keep": 0.3, "step": 0.002}


def round_trip(mesh, **options):
    encoder = bsm.Encoder(mesh, encode_options(**options))
    decoded = bsm.decode(encoder.encode())
    return (
        encoder,
        decoded,
        compare(mesh.positions[encoder.vertex_order], decoded.positions, decoded.faces),
    )


@pytest.mark.parametrize(
    "options",
    [
        {},
        {"key_interval": 1},
        {"key_interval": 1, "key_seed": "svd"},
        {"partition": "metis"},
        {"bits": 12},
        {"bits": 16, "overlap": 1.3},
        {"overlap": 1.0},
        {"key_interval": 0},
        {"key_interval": 3, "power": 1, "iterations": 2},
        {"predict": False, "smoothing": 0.0},
        {"key_seed": "svd", "key_interval": 2},
        {"smoothing": 4.0},
        {"threads": 1},
    ],
    ids=str,
)
def test_a_mesh_comes_back(options):
    mesh = torus()
    encoder, _, result = round_trip(mesh, **{**SMALL, **options})
    assert np.array_equal(np.sort(encoder.vertex_order), np.arange(len(mesh.positions)))
    assert result.rms_relative < 0.006
    assert result.theta_deg < 12


def test_the_faces_come_back_under_the_new_numbers():
    mesh = together(torus(), patch(20, 30))
    encoder, decoded, _ = round_trip(mesh, **SMALL)
    back = encoder.vertex_order[decoded.faces]
    expected = mesh.faces[encoder.face_order]
    turned = [np.roll(back, shift, axis=1) for shift in range(3)]
    assert np.logical_or.reduce([(t == expected).all(axis=1) for t in turned]).all()


def test_a_step_finer_than_levels_can_hold_is_refused():
    with pytest.raises(bsm.OptionError):
        bsm.encode(torus(), bsm.EncodeOptions(**{**SMALL, "step": 1e-8}))


@pytest.mark.parametrize(
    "mesh",
    [
        tetrahedron(),
        bsm.TriangleMesh(np.eye(3), np.array([[0, 1, 2]])),
        bsm.TriangleMesh(np.zeros((3, 3)), np.array([[0, 1, 2]])),
        bsm.TriangleMesh(
            np.eye(3), np.array([[0, 1, 2], [0, 1, 2], [2, 1, 0], [1, 1, 2], [2, 2, 2]])
        ),
        together(*[tetrahedron()] * 40),
        together(torus(12, 8), tetrahedron(), patch(4, 4)),
        bsm.TriangleMesh(patch(9, 9).positions + 1e7, patch(9, 9).faces),
        bsm.TriangleMesh(patch(9, 9).positions * 1e-30, patch(9, 9).faces),
        bsm.TriangleMesh(patch(9, 9).positions * 1e200, patch(9, 9).faces),
    ],
    ids=[
        "tetrahedron",
        "triangle",
        "point",
        "repeated",
        "components",
        "mixed",
        "far",
        "tiny",
        "huge",
    ],
)
@pytest.mark.parametrize("options", [{}, {"bits": 12}, {"key_interval": 1}], ids=str)
def test_small_and_strange_meshes_come_back(mesh, options):
    encoder = bsm.Encoder(
        mesh, encode_options(block_size=50, keep=1.0, step=1e-4, smoothing=0.0, **options)
    )
    decoded = bsm.decode(encoder.encode())
    error = np.abs(mesh.positions[encoder.vertex_order] - decoded.positions).max()
    assert error <= 0.01 * mesh.diagonal + 1e-9 * np.abs(mesh.positions).max()


def test_vertices_without_faces_are_dropped_with_a_note():
    mesh = bsm.TriangleMesh(np.arange(18.0).reshape(6, 3) ** 2, np.array([[1, 2, 4]]))
    encoder, decoded, _ = round_trip(mesh)
    assert sorted(encoder.vertex_order) == [1, 2, 4] and len(decoded.positions) == 3
    assert encoder.notes == ("left out 3 vertices that no face uses",)


@pytest.mark.parametrize("smoothing", [0.0, 3.0])
def test_every_vertex_becomes_final_once_and_stays(smoothing):
    mesh = torus(60, 40)
    data = bsm.encode(mesh, bsm.EncodeOptions(**SMALL, smoothing=smoothing))
    decoded = bsm.decode(data)
    positions = np.full_like(decoded.positions, np.nan)
    final = np.zeros(len(positions), bool)
    early = 0
    blocks = [event for event in events_of(data) if isinstance(event, bsm.BlockEvent)]
    for number, event in enumerate(blocks):
        assert not final[event.vertices].any()
        assert len(np.unique(event.vertices)) == len(event.vertices)
        positions[event.vertices] = event.positions
        final[event.vertices[event.final]] = True
        early += int(event.final.sum()) if number < len(blocks) - 3 else 0
    assert final.all() and early > len(positions) / 4
    assert np.array_equal(positions, decoded.positions)


def test_a_stream_cut_anywhere_is_reported_as_truncated():
    data = bsm.encode(torus(20, 12), bsm.EncodeOptions(**SMALL))
    for length in range(0, len(data), 7):
        with pytest.raises(bsm.TruncatedError):
            bsm.decode(data[:length])


def test_a_stream_over_the_limits_is_refused():
    data = bsm.encode(torus(), bsm.EncodeOptions(**SMALL))
    for limit in (
        {"vertices": 959},
        {"faces": 1000},
        {"block_size": 99},
        {"most_work": 1e3},
        {"blocks": 2},
    ):
        with pytest.raises(bsm.LimitError):
            bsm.decode(data, limits=bsm.Limits(**limit))


def test_illegal_options_are_refused():
    for wrong in (
        {"keep": 0.0},
        {"bits": 1},
        {"bits": 17},
        {"overlap": 0.9},
        {"key_seed": "random"},
        {"step": -1.0},
    ):
        with pytest.raises(bsm.OptionError):
            encode_options(**wrong)


def test_the_order_can_be_kept():
    shuffled = np.random.default_rng(5)
    mesh = together(torus(), patch(9, 12))
    place = shuffled.permutation(len(mesh.positions))
    faces = np.array(
        [np.roll(face, k) for face, k in zip(mesh.faces, shuffled.integers(0, 3, len(mesh.faces)))]
    )
    mesh = bsm.TriangleMesh(mesh.positions[np.argsort(place)], shuffled.permutation(place[faces]))
    data = bsm.encode(mesh, bsm.EncodeOptions(**SMALL, keep_order=True))
    decoded = bsm.decode(data)
    assert np.array_equal(decoded.faces, mesh.faces)
    assert compare(mesh.positions, decoded.positions, mesh.faces).rms_relative < 0.006
    seen = np.full_like(decoded.positions, np.nan)
    for event in events_of(data):
        if isinstance(event, bsm.BlockEvent):
            seen[event.vertices] = event.positions
    assert np.array_equal(seen, decoded.positions)


def test_many_bits_hold_a_first_row_that_is_large_beside_nothing():
    mesh = patch(40, 40)
    errors = []
    for bits in (8, 12, 13, 16):
        encoder = bsm.Encoder(mesh, encode_options(bits=bits, coefficients=1, block_size=100))
        decoded = bsm.decode(encoder.encode()).positions
        errors.append(np.abs(decoded - mesh.positions[encoder.vertex_order]).max())
    assert max(errors) < 1.01 * min(errors)


@pytest.mark.parametrize("value", [np.inf, -np.inf, np.nan, 1.5e308])
def test_positions_beyond_the_range_are_an_error(value):
    positions = np.ones((17, 3))
    for row in (0, 13, 16):
        positions[row, row % 3] = value
        with pytest.raises(bsm.NumericError, match="not finite"):
            Units((10.0, -20.0, 0.3), 1.7).back(positions)
        positions[row] = 1.0
