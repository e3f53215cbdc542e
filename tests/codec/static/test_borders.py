"""Parts that are encoded apart fit: borders are locked, or positions are on one grid."""

import numpy as np
import pytest

import bsm
from bsm.bitstream.container.reader import Reader
from bsm.bitstream.errors import ArgumentError, OptionError, TargetError
from bsm.cli import main
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.static.contract import Contract, Fit
from bsm.codec.static.encoder import Encoder, encode
from bsm.codec.static.options import EncodeOptions
from bsm.files.mesh import read_mesh, write_mesh
from bsm.options import encode_options
from tests.shapes import curved, patch, torus
from tools.measure.borders import halves


def apart(mesh, **keywords):
    """Both parts of a mesh after decoding, by the numbers of the whole; not a number for vertices of the other one."""
    decoded = []
    for part in halves(mesh):
        encoder = Encoder(part, encode_options(**keywords))
        positions = np.vstack([bsm.decode(encoder.encode()).positions, np.full(3, np.nan)])
        decoded.append(positions[encoder.vertex_index])
    return decoded


def gaps(mesh, **keywords):
    one, other = apart(mesh, **keywords)
    found = np.linalg.norm(one - other, axis=1)
    assert np.isfinite(found).sum() > 1
    return found[np.isfinite(found)]


def header_of(data):
    reader = Reader()
    reader.receive_data(data)
    return reader.next_packet()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("mesh", "keywords"),
    [
        (patch(50, 40), {}),
        (patch(50, 40), {"preset": "small"}),
        (patch(50, 40), {"preset": "fine"}),
        (patch(50, 40), {"max_error": 0.002}),
        (torus(50, 30), {"preset": "near-lossless"}),
        (torus(50, 30), {}),
        (patch(9, 8), {}),
        (patch(3, 2), {}),
    ],
)
@pytest.mark.parametrize("gap", [1e-2, 1e-3, 1e-5])
def test_parts_gape_by_no_more_than_they_may(mesh, keywords, gap):
    assert gaps(mesh, lock_borders=gap, **keywords).max() <= gap * mesh.diagonal
    length = f"{gap}mm"
    assert gaps(mesh, lock_borders=length, **keywords).max() <= gap


def test_it_takes_a_layer_of_borders_and_little_more():
    mesh = curved(patch(60, 50))
    promise = Contract(0.01, 8.0)
    ways = ({}, {"lock_borders": True})
    plain, locked = (encode(mesh, encode_options(block_size=300, contract=promise, **more)) for more in ways)
    assert header_of(plain).borders == 0
    assert header_of(locked).borders == 1 and header_of(locked).layers[-1].axes == 3
    assert len(plain) < len(locked) < 2 * len(plain)
    sides = (np.arange(3000) % 50 % 49 == 0) | (np.arange(3000) // 50 % 59 == 0)
    encoder = Encoder(mesh, encode_options(lock_borders=True, contract=promise))
    moved = np.linalg.norm(bsm.decode(encoder.encode()).positions[encoder.vertex_index] - mesh.positions, axis=1)
    assert moved[sides].max() <= Fit().gap / 2 * mesh.diagonal < moved[~sides].mean()
    assert moved.max() <= 0.01 * mesh.diagonal


def test_what_has_no_borders_is_as_it_was():
    assert encode(torus(), encode_options(lock_borders=True)) == encode(torus())


def test_a_decoder_may_leave_borders_out():
    data = encode(patch(60, 50), encode_options(block_size=300, lock_borders=True))
    with bsm.Decoder(layers=1) as decoder:
        decoder.receive_data(data)
        assert np.isfinite(decoder.finish().positions).all()


@pytest.mark.parametrize("mesh", [patch(50, 40), patch(6, 5)])
def test_what_cannot_be_kept_is_an_error(mesh):
    with pytest.raises(TargetError, match="borders that gape by at most 1e-13 diagonals cannot be had"):
        encode(mesh, encode_options(lock_borders=1e-13))


@pytest.mark.parametrize(
    "keywords",
    [{"theta": 5.0}, {"grid": 12}, {"step": 0.01}, {"preset": "grid14"}, {"grid_cell": 1.0}, {"size": 900}],
)
def test_borders_are_locked_by_promises_alone(keywords):
    with pytest.raises(OptionError, match="borders are locked where there is a promise"):
        bsm.encode(torus(), lock_borders=True, **keywords)


def test_values_that_say_nothing():
    for value in (0.0, -1.0, 2.0, "0mm", float("nan")):
        with pytest.raises(OptionError):
            encode_options(lock_borders=value)
    with pytest.raises(ArgumentError, match="lock_borders must be a number, or one with a unit"):
        encode_options(lock_borders="a.ply")
    assert encode_options(lock_borders=False).lock_borders is None
    assert encode_options(lock_borders="1%").lock_borders == Fit(0.01)
    assert encode_options(lock_borders=1e-3, max_error=0.02).contract == Contract(0.02)


# ------------------------------------------------------------------------------------------------------------ one grid


@pytest.mark.parametrize(
    ("cell", "origin", "shift"),
    [
        (2.0**-10, None, -7.0),
        (2.0**-10, (0.5, -0.25, 1024.0), 0.0),
        (0.001, None, 0.0),
        (0.0013, (-1.3, 0.7, 100.0), 0.0),
        (0.0007, None, 100.0),
    ],
)
def test_parts_on_one_grid_fit_bit_for_bit(cell, origin, shift):
    mesh = TriangleMesh(torus(50, 30).positions + shift, torus(50, 30).faces)
    one, other = apart(mesh, grid_cell=cell, grid_origin=origin)
    start = np.array(origin or (0.0, 0.0, 0.0))
    places = np.floor((mesh.positions - start) / cell + 0.5)
    both = np.isfinite(one).all(axis=1) & np.isfinite(other).all(axis=1)
    assert both.sum() > 20 and one[both].tobytes() == other[both].tobytes()
    for part in (one, other):
        there = np.isfinite(part).all(axis=1)
        np.testing.assert_allclose(part[there], (places * cell + start)[there], rtol=0, atol=1e-9 * cell)


def test_grids_that_cannot_be():
    mesh = torus()
    with pytest.raises(TargetError, match="larger than 1048575 cells"):
        encode(mesh, EncodeOptions(grid_cell=1e-7))
    with pytest.raises(TargetError, match="too small to count"):
        encode(mesh, EncodeOptions(grid_cell=1e-17))
    with pytest.raises(TargetError, match="too far to tell places exactly"):
        encode(mesh, EncodeOptions(grid_cell=0.0013, grid_origin=(1e3, 0.1, 0.2)))
    for keywords in (
        {"grid": 9, "grid_cell": 1.0},
        {"grid_origin": (0.0, 0.0, 0.0)},
        {"grid_cell": 0.0},
        {"grid_cell": 1.0, "step": 0.1},
        {"grid_cell": 1.0, "grid_origin": (0.0, float("inf"), 0.0)},
    ):
        with pytest.raises(OptionError):
            EncodeOptions(**keywords)


def test_on_the_command_line(tmp_path, capsys):
    write_mesh(tmp_path / "a.ply", patch(30, 20))
    name = str(tmp_path / "a.ply")
    assert main(["encode", "-q", name, "--lock-borders"]) == 0
    assert main(["encode", "-fq", name, "--lock-borders", "0.01mm", "--preset", "fine", "--meta", "unit=mm"]) == 0
    words = ["--grid-cell", "0.001", "--set", "grid_origin=-1,-2,-3", "--preset", "grid14"]
    assert main(["encode", "-fq", name, *words]) == 0
    mesh = read_mesh(name).mesh
    decoded = bsm.decode(str(tmp_path / "a.bsm"))
    assert bsm.compare(mesh, decoded).max_error <= 0.001
    assert main(["encode", "-fq", name, "--lock-borders", "1e-13"]) == 10
    assert "cannot be had on this mesh" in capsys.readouterr().err
    assert main(["encode", "-fq", name, "--lock-borders", "--theta", "5"]) == 2
    with pytest.raises(SystemExit, match="2"):
        main(["encode", "-fq", name, "--grid-cell", "0.001", "--set", "grid_origin=1,2"])


# -------------------------------------------------------------------------------------------------------- real meshes


@pytest.mark.real
@pytest.mark.parametrize("name", ["static/bunny_34834.ply", "static/c3d_spot.ply", "assets/cloth.obj"])
def test_halves_of_real_meshes(meshes, name):
    mesh = read_mesh(str(meshes / name)).mesh.without_isolated_vertices()[0]
    assert gaps(mesh, lock_borders=True).max() <= 1e-4 * mesh.diagonal < 0.5 * gaps(mesh).mean()


@pytest.mark.real
def test_vertices_that_are_brought_back_count_for_normals(meshes):
    """A search that left them out would stop just where they bend normals too much, and only a grid would be left."""
    mesh = read_mesh(str(meshes / "static" / "armadillo_20002_derived.ply")).mesh
    for part in halves(mesh):
        header = header_of(encode(part, encode_options(lock_borders=True, contract=Contract(0.01, 8.0))))
        assert len(header.layers) == 3 and header.borders == 1
