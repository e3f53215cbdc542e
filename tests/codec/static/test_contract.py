"""Contracts: kept on what is decoded, on any mesh, or refused."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

import bsm
from bsm.codec.geometry.metrics import Original, Reference
from bsm.codec.look.measure import LookMetric, look
from bsm.codec.static.encoder import KEPT_EXACTLY
from bsm.encoding.options import encode_options
from tests.codec.static.test_presets import PROMISING
from tests.shapes import knot, patch, tetrahedron, together, torus


def noisy(mesh: bsm.TriangleMesh, amount: float) -> bsm.TriangleMesh:
    """Every vertex moved a little."""
    offsets = np.random.default_rng(0).normal(size=mesh.positions.shape)
    return bsm.TriangleMesh(mesh.positions + amount * mesh.diagonal * offsets, mesh.faces)


def kept(encoder: bsm.Encoder, data: bytes) -> tuple[float, float]:
    """Farthest vertex over the diagonal, and mean angle, of what a stream decodes to."""
    original, decoded = (
        Original(encoder.mesh.positions, encoder.mesh.faces),
        bsm.decode(data).positions,
    )
    farthest = np.linalg.norm(original.positions - decoded, axis=1).max()
    return farthest / (encoder.mesh.diagonal or 1.0), original.angle(decoded)


def looks(encoder: bsm.Encoder, data: bytes) -> float:
    """Distance in pictures of what a stream decodes to; 0 where nothing can be seen."""
    try:
        return LookMetric(encoder.mesh.bare).look(bsm.decode(data).positions).distance
    except bsm.MeshError:
        return 0.0


def assert_kept(mesh: bsm.TriangleMesh, options: bsm.EncodeOptions) -> bsm.Encoder:
    """Encode a mesh; all bounds of its contract hold."""
    contract, encoder = options.contract, bsm.Encoder(mesh, options)
    data = encoder.encode()
    farthest, angle = kept(encoder, data)
    assert farthest <= contract.farthest * (1 + 1e-9) and angle <= contract.angle + 1e-9
    assert looks(encoder, data) <= contract.look
    return encoder


def patterned(mesh: bsm.TriangleMesh) -> bsm.TriangleMesh:
    """With normals that have nothing to do with its shape: edges are visible that are not creases."""
    normals = np.repeat(np.random.default_rng(0).normal(size=(len(mesh.faces), 3)), 3, axis=0)
    return bsm.TriangleMesh(
        mesh.positions, mesh.faces, (bsm.Attribute("normal", normals, "corner", "normal"),)
    )


@pytest.mark.parametrize("preset", ["balanced", "small"])
def test_a_look_holds_by_the_normals_that_are_sent(preset):
    mesh, options = patterned(torus(60, 40)), bsm.PRESETS[preset]
    assert look(mesh, bsm.decode(bsm.encode(mesh, options))).distance <= options.contract.look


@pytest.mark.parametrize("preset", PROMISING)
@pytest.mark.parametrize(
    "mesh",
    [
        tetrahedron(),
        patch(24, 30),
        torus(48, 30),
        noisy(torus(48, 30), 0.002),
        together(*(torus(8, 6) for _ in range(20)), torus(40, 30)),
        bsm.TriangleMesh(torus(30, 20).positions * (1.0, 1.0, 0.0), torus(30, 20).faces),
        bsm.TriangleMesh(torus(30, 20).positions + 1e7, torus(30, 20).faces),
        bsm.TriangleMesh(torus(30, 20).positions * 1e-12, torus(30, 20).faces),
        bsm.TriangleMesh(np.zeros((3, 3)), [(0, 1, 2)]),
        bsm.TriangleMesh([(0, 0, 0), (1, 0, 0), (3, 0, 0)], [(0, 1, 2), (0, 0, 1)]),
        bsm.TriangleMesh(torus(8, 6).positions, np.repeat(np.arange(48), 3).reshape(48, 3)),
    ],
    ids=[
        "tetrahedron",
        "patch",
        "torus",
        "noise",
        "many",
        "flat",
        "far",
        "tiny",
        "point",
        "line",
        "dots",
    ],
)
def test_presets_keep_what_they_promise(mesh: bsm.TriangleMesh, preset: str) -> None:
    assert_kept(mesh, bsm.PRESETS[preset])


@given(st.integers(0, 2**32 - 1), st.floats(1e-4, 0.1), st.floats(0.5, 30.0))
@example(592908, 0.0625, 1.0)  # most of its area is in faces of one plane, and others have none
@settings(max_examples=20)
def test_any_bounds_are_kept(seed: int, farthest: float, angle: float) -> None:
    random = np.random.default_rng(seed)
    size = int(random.integers(4, 40))
    mesh = bsm.TriangleMesh(random.normal(size=(size, 3)), random.integers(0, size, (2 * size, 3)))
    encoder = bsm.Encoder(mesh, bsm.EncodeOptions(contract=bsm.Contract(farthest, angle)))
    got = kept(encoder, encoder.encode())
    assert got[0] <= farthest * (1 + 1e-9)
    assert got[1] <= angle + 1e-9


@pytest.mark.parametrize("preset", PROMISING)
@pytest.mark.parametrize(
    "mesh", [torus(48, 30), noisy(torus(48, 30), 0.002)], ids=["torus", "noise"]
)
def test_what_is_quick_to_decode_is_on_a_grid_and_as_good(
    mesh: bsm.TriangleMesh, preset: str
) -> None:
    header = assert_kept(mesh, replace(bsm.PRESETS[preset], effort="quick")).draft().header
    assert header.grid and header.light


@pytest.mark.parametrize("option", [{"grid": 9}, {"grid_cell": 0.01}])
def test_quick_grids_are_light_with_the_same_positions(option: dict[str, Any]) -> None:
    plain, light = (
        bsm.Encoder(torus(80, 40), encode_options(effort=effort, **option)).draft()
        for effort in ("normal", "quick")
    )
    assert light.header == replace(plain.header, light=1) and not plain.header.light
    first, other = (bsm.decode(b"".join(draft.frames)) for draft in (plain, light))
    np.testing.assert_array_equal(first.positions, other.positions)
    np.testing.assert_array_equal(first.faces, other.faces)


@pytest.mark.parametrize("option", [{"step": 0.01}, {"bits": 12}, {"keep": 0.1}])
def test_quick_decoding_excludes_options_of_blocks(option: dict[str, float]) -> None:
    with pytest.raises(bsm.OptionError, match="quick"):
        encode_options(effort="quick", **option)


def test_a_bound_in_the_unit_of_the_mesh() -> None:
    mesh = bsm.TriangleMesh(torus(40, 24).positions * 100.0, torus(40, 24).faces)
    encoder = bsm.Encoder(mesh, bsm.EncodeOptions(contract=bsm.Contract(0.05, absolute=True)))
    decoded = bsm.decode(encoder.encode()).positions
    assert np.sqrt(np.square(decoded - encoder.mesh.positions).sum(axis=1)).max() <= 0.05


def test_a_bound_wider_than_a_tenth_of_the_mesh_is_refused() -> None:
    """Somebody took one unit for another."""
    mesh = bsm.TriangleMesh(
        torus(40, 24).positions * 0.1, torus(40, 24).faces, metadata={"unit": "mm"}
    )
    with pytest.raises(
        bsm.OptionError,
        match=r"0\.05 mm is \d+% of this mesh's size \(0\.\d+ mm\): is its unit mm\?",
    ):
        bsm.Encoder(mesh, bsm.EncodeOptions(contract=bsm.Contract(0.05, absolute=True))).encode()
    promise = bsm.PRESETS["balanced"].contract
    encoder = bsm.Encoder(
        mesh, bsm.EncodeOptions(contract=replace(promise, farthest=0.05, absolute=True))
    )
    assert encoder.encode() == bsm.Encoder(mesh).encode() and "is its unit mm?" in encoder.notes[-1]


def test_what_cannot_be_kept_is_refused_and_says_what_can_be_had() -> None:
    with pytest.raises(
        bsm.TargetError, match=r"vertex error 1e-10 % of .* cannot be kept.* the best possible is"
    ):
        bsm.Encoder(torus(40, 24), bsm.EncodeOptions(contract=bsm.Contract(1e-12))).encode()


@pytest.mark.parametrize(
    "bounds", [(0.0, 1.0), (2.0, 1.0), (float("nan"), 1.0), (0.1, 0.0), (0.1, 181.0)]
)
def test_bounds_that_are_none(bounds: tuple[float, float]) -> None:
    with pytest.raises(bsm.OptionError):
        bsm.Contract(*bounds)


def test_who_says_how_to_code_gets_that() -> None:
    encoder = bsm.Encoder(noisy(torus(80, 40), 0.01), bsm.EncodeOptions(step=0.03))
    assert encoder.draft().header.step == pytest.approx(0.03)
    assert kept(encoder, encoder.encode())[1] > 8.0


@pytest.mark.parametrize("bits", [1, 4, 11, 16, 20])
def test_a_grid_gives_exactly_the_nearest_places(bits: int) -> None:
    mesh = torus(20, 12)
    encoder = bsm.Encoder(mesh, bsm.EncodeOptions(grid=bits))
    decoded, wanted = bsm.decode(encoder.encode()).positions, encoder.mesh.positions
    low, step = wanted.min(axis=0), np.ptp(wanted, axis=0).max() / ((1 << bits) - 1)
    places = (decoded - low) / step
    assert np.abs(places - np.rint(places)).max() < 0.1
    assert np.abs(decoded - wanted).max() <= 0.5 * step + 1e-6


@pytest.mark.slow
def test_many_components_cost_what_their_vertices_cost() -> None:
    many = together(*(torus(18, 12) for _ in range(30)))
    encoder = bsm.Encoder(many)
    draft = encoder.draft()
    assert draft.header.grid
    assert draft.size < 12 * len(many.positions) / 8


def test_small_parts_keep_their_shape() -> None:
    """A small part far from a large one is bound by its own diagonal, down to a tenth of the bound of the whole."""
    small = torus(12, 8)
    large = torus(60, 40)
    mesh = bsm.TriangleMesh(
        np.concatenate([large.positions, 0.04 * small.positions + (0.0, 0.0, large.diagonal)]),
        np.concatenate([large.faces, small.faces + len(large.positions)]),
    )
    for way in (bsm.EncodeOptions(block_size=300), bsm.EncodeOptions(effort="quick")):
        encoder = bsm.Encoder(mesh, replace(way, contract=bsm.Contract(0.02, 12.0, by_part=0.02)))
        moved = (
            np.linalg.norm(bsm.decode(encoder.encode()).positions - encoder.mesh.positions, axis=1)
            / mesh.diagonal
        )
        part = encoder.vertex_order >= len(large.positions)
        assert moved[part].max() <= 0.02 * 0.1 * (1 + 1e-9) and moved.max() <= 0.02 * (1 + 1e-9)


@pytest.mark.parametrize("preset", ["small", "balanced"])
def test_a_label_does_not_sink_into_its_wall(preset: str) -> None:
    wall = patch(8, 8)
    label = bsm.TriangleMesh(
        [(0.3, 0.3, 0), (0.7, 0.3, 0), (0.7, 0.6, 0), (0.3, 0.6, 0)], [(0, 1, 2), (0, 2, 3)]
    )
    low, size = wall.positions.min(axis=0), np.ptp(wall.positions, axis=0).max()
    above = low + size * (label.positions + np.array([0.0, 0.0, 0.002]))
    flat = wall.positions * (1.0, 1.0, 0.0) + low * (0.0, 0.0, 1.0)
    random = np.random.default_rng(0).normal(size=flat.shape) * (1e-3, 1e-3, 0.0)
    mesh = bsm.TriangleMesh(
        np.concatenate([flat + random, above]),
        np.concatenate([wall.faces, label.faces + len(flat)]),
    )
    encoder = bsm.Encoder(mesh, bsm.PRESETS[preset])
    decoded = bsm.decode(encoder.encode()).positions
    part = encoder.vertex_order >= len(flat)
    assert decoded[part, 2].min() > decoded[~part, 2].max()


@pytest.mark.parametrize("gap", [0.0007, 0.002])
def test_a_shell_stays_inside_another_one_without_a_finer_grid(gap: float) -> None:
    outer = torus(48, 32)
    around = np.arctan2(outer.positions[:, 1], outer.positions[:, 0])
    outward = outer.positions - np.column_stack([np.cos(around), np.sin(around), 0.0 * around])
    inner, n = outer.positions - gap * outer.diagonal * outward, len(outer.positions)
    both = bsm.TriangleMesh(
        np.concatenate([outer.positions, inner]), np.concatenate([outer.faces, outer.faces + n])
    )
    encoder = bsm.Encoder(both)
    decoded = bsm.decode(encoder.encode()).positions[encoder.vertex_index]
    assert ((decoded[:n] - decoded[n:]) * outward).sum(axis=1).min() > 0.0
    # A grid with the usual step keeps all bounds. With whole parts within half a gap, none does.
    kept = [event.step for event in encoder.trials if event.action == "draw" and event.error <= 1.0]
    usual = encoder.trials[0].step
    assert max(kept) > 0.8 * usual


def test_a_bound_that_cannot_be_kept_says_what_can() -> None:
    with pytest.raises(
        bsm.TargetError,
        match=r"vertex error 1e-10 % .* cannot be kept .* possible is vertex error ",
    ):
        bsm.Encoder(
            noisy(torus(20, 12), 0.01), bsm.EncodeOptions(contract=bsm.Contract(1e-12, look=1.0))
        ).encode()


def test_what_only_exact_positions_keep_is_kept_by_them() -> None:
    mesh = noisy(torus(20, 12), 0.01)
    mesh = replace(mesh, positions=mesh.positions.astype(np.float32).astype(np.float64))
    for contract in (bsm.Contract(0.01, look=1e-9), bsm.Contract(0.01, angle=1e-9)):
        encoder = bsm.Encoder(mesh, bsm.EncodeOptions(contract=contract))
        decoded = bsm.decode(encoder.encode()).positions[encoder.vertex_index]
        assert (decoded == mesh.positions).all()
        assert KEPT_EXACTLY in encoder.notes


def test_a_promise_holds_beside_a_target() -> None:
    mesh, promise = noisy(torus(40, 24), 0.002), bsm.Contract(0.0005)
    loose = bsm.Encoder(
        mesh, bsm.EncodeOptions(contract=promise, target=bsm.Target("theta_deg", 20.0))
    )
    assert kept(loose, loose.encode())[0] <= 0.0005 * (1 + 1e-9)
    assert len(loose.encode()) <= 1.01 * len(bsm.encode(mesh, bsm.EncodeOptions(contract=promise)))
    with pytest.raises(
        bsm.TargetError, match=r"1000 bytes at most cannot be reached with vertex error 0\.05 %"
    ):
        bsm.Encoder(
            mesh, bsm.EncodeOptions(contract=promise, target=bsm.Target("size", 1000.0))
        ).encode()
    both = bsm.Encoder(mesh, bsm.EncodeOptions(contract=promise, target=bsm.Target("size", 6000.0)))
    assert len(both.encode()) <= 6000 and kept(both, both.encode())[0] <= 0.0005 * (1 + 1e-9)


def test_a_target_beside_the_look_takes_little_more_than_either() -> None:
    mesh, promise = knot(1500), bsm.PRESETS["balanced"].contract
    contracts = promise, bsm.Contract(0.1, visual=1e-5), replace(promise, visual=1e-5)
    look, alone, both = (
        bsm.Encoder(mesh, bsm.EncodeOptions(contract=contract)) for contract in contracts
    )
    sizes = [len(encoder.encode()) for encoder in (look, alone, both)]
    assert sizes[2] <= 1.15 * max(sizes[:2])
    decoded = bsm.decode(both.encode()).positions
    assert Reference(both.mesh.positions, both.mesh.faces).nmsve(decoded) <= 1e-5
