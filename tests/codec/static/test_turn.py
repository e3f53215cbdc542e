"""Grids in the axes of the part: found where they pay, and turned back by decoders."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import bsm
from bsm import (
    PRESETS,
    Attribute,
    EncodeOptions,
    Encoder,
    Target,
    TriangleMesh,
    decode,
    encode,
    read_mesh,
)
from bsm.codec.geometry.turns import turn_of, turned_by
from tests.refined import header_of
from tools.surgery import frames_of, is_brief, stream_of
from tools.vectors.meshes import together, torus

BOX = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
SIDES = np.array(
    [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
)
FACES = np.concatenate([SIDES[:, [0, 1, 2]], SIDES[:, [0, 2, 3]]]).astype(np.int32)
ASKEW = (0.3, -0.2, 0.4)


def boxes(count: int = 60) -> TriangleMesh:
    """Boxes of any sizes along the axes."""
    numbers = np.random.default_rng(count)
    parts = [
        BOX * numbers.uniform(0.2, 2.0, 3) + numbers.uniform(-5.0, 5.0, 3) for _ in range(count)
    ]
    mesh = together(*(TriangleMesh(part, FACES) for part in parts))
    return replace(mesh, faces=mesh.faces.astype(np.int32))


def askew(mesh: TriangleMesh, turn: tuple[float, ...] = ASKEW) -> TriangleMesh:
    return replace(mesh, positions=turned_by(mesh.positions, turn))


entries = st.tuples(*[st.floats(-1.0, 1.0, width=32)] * 3)


@given(entries)
def test_a_turn_is_the_rotation_of_its_quaternion(turn):
    b, c, d = turn
    matrix = np.array([
        [1 + b * b - c * c - d * d, 2 * (b * c - d), 2 * (b * d + c)],
        [2 * (b * c + d), 1 - b * b + c * c - d * d, 2 * (c * d - b)],
        [2 * (b * d - c), 2 * (c * d + b), 1 - b * b - c * c + d * d],
    ]) / (1 + b * b + c * c + d * d)  # fmt: skip
    places = np.random.default_rng(1).normal(size=(5, 3))
    assert np.allclose(turned_by(places, turn), places @ matrix.T, atol=1e-14)
    assert np.allclose(turned_by(turned_by(places, turn), turn, back=True), places, atol=1e-14)


@given(entries)
@settings(max_examples=30, deadline=None)
def test_the_axes_of_boxes_are_found(turn):
    mesh = askew(boxes(), turn)
    axes = turned_by(np.eye(3), turn_of(mesh.positions, mesh.faces)) @ turned_by(np.eye(3), turn).T
    assert np.allclose(np.sort(np.abs(axes), axis=1), [0.0, 0.0, 1.0], atol=3e-3), (
        "a relabeling of the axes"
    )


def test_nothing_is_turned_without_reason():
    for mesh in (
        boxes(),
        torus(20, 16),
        TriangleMesh(np.zeros((3, 3)), np.array([[0, 1, 2]], np.int32)),
    ):
        assert turn_of(mesh.positions, mesh.faces) == (0.0, 0.0, 0.0)
        assert header_of(encode(mesh)).turn == (0.0, 0.0, 0.0)


def test_a_part_that_was_modeled_askew_takes_about_the_bytes_of_one_along_the_axes():
    straight, turned = Encoder(boxes(), EncodeOptions()), Encoder(askew(boxes()), EncodeOptions())
    sizes = [len(encoder.encode()) for encoder in (straight, turned)]
    # Pictures show its boxes from other sides, and so its grid is finer.
    assert any(turned.result().header.turn) and sizes[1] < 1.7 * sizes[0]
    assert turned.look is not None and turned.look <= 1.0


@pytest.mark.parametrize(
    "options",
    [{"congruence": False}, {"grid": 12}, {"exact": True}, {"effort": "quick"}],
    ids=lambda o: next(iter(o)),
)
def test_streams_of_1_0_are_not_turned(options):
    data = encode(askew(boxes(20)), EncodeOptions(**options))
    assert data[4] == 0x10 and header_of(data).turn == (0.0, 0.0, 0.0)


def test_sent_normals_keep_their_axes():
    mesh = askew(boxes())
    normals = Attribute(
        "normal", np.tile([0.0, 0.0, 1.0], (len(mesh.positions), 1)), "vertex", "normal"
    )
    assert header_of(encode(replace(mesh, attributes=(normals,)))).turn == (0.0, 0.0, 0.0)


def test_attributes_order_and_metadata_come_back_from_turned_grids():
    mesh = askew(boxes())
    labels = Attribute(
        "label", np.arange(len(mesh.positions), dtype=np.uint16)[:, None] // 8, "vertex"
    )
    data = encode(
        replace(mesh, attributes=(labels,), metadata={"unit": "mm"}), EncodeOptions(keep_order=True)
    )
    found = decode(data)
    assert any(header_of(data).turn) and not is_brief(data)
    assert (found.attributes[0].values == labels.values).all() and found.metadata["unit"] == "mm"
    assert (found.faces == mesh.faces).all() and np.abs(
        found.positions - mesh.positions
    ).max() < 0.2


def test_one_frame_holds_a_turned_grid():
    data = encode(askew(boxes(20)))
    assert is_brief(data) and any(header_of(data).turn)
    assert (decode(data).positions == decode(stream_of(frames_of(data))).positions).all()


def test_a_size_is_met_in_turned_axes():
    result = Encoder(
        askew(boxes()), EncodeOptions(target=Target("size", 1200.0), contract=None)
    ).result()
    assert result.size <= 1200 and any(result.header.turn)


def test_info_names_it(tmp_path, capsys):
    from bsm.cli import main

    (tmp_path / "a.bsm").write_bytes(bsm.encode(askew(boxes(20))))
    assert main(["info", str(tmp_path / "a.bsm")]) == 0
    assert "turn, brief:" in capsys.readouterr().out


@pytest.mark.real
@pytest.mark.parametrize("preset", ["balanced", "fine"])
def test_a_real_part_is_turned_back(meshes, preset):
    mesh = read_mesh(str(meshes / "assets/1002_tray_bottom.STL")).mesh
    bare = TriangleMesh(mesh.positions, mesh.faces)
    sizes = []
    for some in (bare, askew(bare)):  # rounding must not count its right angles as folds
        encoder = Encoder(some, PRESETS[preset])
        sizes.append(len(encoder.encode()))
        assert encoder.look is not None and encoder.look <= PRESETS[preset].contract.look
    assert any(encoder.result().header.turn) and sizes[1] < 1.1 * sizes[0]
