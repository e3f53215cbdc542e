"""The façade: real meshes in, bytes out, and back."""

import io
import json
import mmap

import numpy as np
import pytest

import bsm
from bsm.cli import main
from bsm.files.table import MESH_FORMATS
from tests.motion import bending
from tests.shapes import torus

QUICK = {"block_size": 150, "threads": 1, "step": 0.004}


@pytest.fixture(scope="module")
def mesh():
    return torus(20, 12)


@pytest.fixture(scope="module")
def stream(mesh):
    return bsm.encode(mesh, **QUICK)


@pytest.fixture(scope="module")
def decoded(stream):
    return bsm.decode(stream)


def same(a, b):
    return np.array_equal(a.positions, b.positions) and np.array_equal(a.faces, b.faces)


# ------------------------------------------------------------------------------------------------------- round trips


def test_options_are_those_of_the_command_line(mesh, tmp_path):
    bsm.save(mesh, tmp_path / "a.ply")
    given = ["--theta", "4", "--preset", "small", "--set", "block-size=150", "--set", "power=2"]
    assert main(["encode", str(tmp_path / "a.ply"), "-q", *given]) == 0
    keywords = {"theta": 4, "preset": "small", "block_size": 150, "power": 2}
    assert bsm.encode(tmp_path / "a.ply", **keywords) == (tmp_path / "a.bsm").read_bytes()
    assert bsm.compare(tmp_path / "a.ply", tmp_path / "a.bsm").theta_deg <= 4.1


def test_options_as_an_object(mesh, stream):
    assert bsm.encode(mesh, bsm.EncodeOptions(**QUICK)) == stream
    with pytest.raises(bsm.ArgumentError, match="not both"):
        bsm.encode(mesh, bsm.EncodeOptions(), step=0.1)
    with pytest.raises(bsm.ArgumentError, match="EncodeOptions is expected, not SequenceOptions"):
        bsm.encode(mesh, bsm.SequenceOptions())
    with pytest.raises(TypeError, match="did you mean theta"):
        bsm.encode(mesh, thetta=5)


def test_every_kind_of_buffer(stream, decoded):
    read_only = np.frombuffer(stream, np.uint8)
    for buffer in (bytearray(stream), memoryview(stream), read_only, np.repeat(read_only, 2)[::2]):
        assert same(bsm.decode(buffer), decoded)


def test_every_kind_of_file(stream, decoded, tmp_path):
    path = tmp_path / "a.bsm"
    path.write_bytes(stream)
    assert same(bsm.decode(path), decoded) and same(bsm.decode(str(path)), decoded)
    with open(path, "rb") as file:
        assert same(bsm.decode(file), decoded)
        assert not file.closed
        with mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as mapped:
            assert same(bsm.decode(mapped), decoded)
    with open(path, "rb", buffering=0) as raw:
        assert same(bsm.decode(raw), decoded)


def test_sequences():
    positions, faces = bending(5)
    data = bsm.encode_sequence(positions, faces, step=0.001, keep_order=True, threads=1)
    again, same_faces = bsm.decode_sequence(io.BytesIO(data))
    assert np.array_equal(same_faces, faces)
    assert np.abs(again - positions).max() < 0.01
    with pytest.raises(bsm.ArgumentError, match="power"):
        bsm.encode_sequence(positions, faces, power=3)
    with pytest.raises(bsm.UnsupportedError):
        bsm.decode(data)
    with pytest.raises(bsm.FormatError):
        bsm.decode_sequence(bsm.encode(torus(6, 5)))


# ------------------------------------------------------------------------------------------------------------- files


@pytest.mark.parametrize("suffix", [*MESH_FORMATS, "bsm", "PLY", "BSM"])
def test_save_and_load(mesh, suffix, tmp_path):
    path = tmp_path / f"a.{suffix}"
    options = QUICK | {"keep_order": True, "step": 0.0005} if suffix.lower() == "bsm" else {}
    bsm.save(mesh, path, **options)
    assert [file.name for file in tmp_path.iterdir()] == [path.name]
    back = bsm.load(path)
    expected = mesh.positions[mesh.faces]
    tolerance = 0.02 if suffix.lower() == "bsm" else 1e-6
    assert back.positions[back.faces] == pytest.approx(expected, abs=tolerance)


def test_what_cannot_be_saved(mesh, tmp_path):
    with pytest.raises(bsm.OptionError, match=r"use one of \.bsm, \.3mf, \.dae, \.glb, \.npz"):
        bsm.save(mesh, tmp_path / "a.wrl")
    with pytest.raises(bsm.OptionError, match=r"step is an option of \.bsm files"):
        bsm.save(mesh, tmp_path / "a.ply", step=1)
    with pytest.raises(
        bsm.ArgumentError, match=r"a path is expected, or an open .* not TriangleMesh"
    ):
        bsm.save(tmp_path / "a.ply", mesh)
    bsm.save(mesh, tmp_path / "a.ply")
    with pytest.raises(FileExistsError, match="overwrite=True"):
        bsm.save(mesh, tmp_path / "a.ply", overwrite=False)
    with pytest.raises(FileNotFoundError) as caught:
        bsm.save(mesh, tmp_path / "no" / "a.ply")
    assert caught.value.filename == str(tmp_path / "no" / "a.ply")


@pytest.mark.parametrize(
    "read", [bsm.load, bsm.read_mesh, bsm.decode, bsm.decode_sequence, bsm.encode]
)
def test_folders_and_missing_files(read, tmp_path):
    with pytest.raises(bsm.FormatError, match="is a folder"):
        read(tmp_path)
    with pytest.raises(FileNotFoundError, match="none"):
        read(tmp_path / "none")


# ------------------------------------------------------------------------------------------------ compare and denoise


def test_compare_takes_all_kinds(mesh, stream, decoded, tmp_path):
    (tmp_path / "a.bsm").write_bytes(stream)
    expected = bsm.compare(mesh, decoded)
    assert 0 < expected.max_error_relative < 0.05
    for other in (
        stream,
        io.BytesIO(stream),
        tmp_path / "a.bsm",
        (decoded.positions, decoded.faces),
    ):
        assert bsm.compare(mesh, other) == expected
    encoder = bsm.Encoder(mesh, bsm.EncodeOptions(**QUICK))
    assert bsm.compare(mesh, decoded, order=encoder.vertex_order) == expected
    assert bsm.compare(mesh, mesh).rms == 0
    with pytest.raises(bsm.MeshError):
        bsm.compare(mesh, torus(9, 8))


def test_denoise():
    clean = torus(48, 32, bumps=0.0)
    noise = np.random.default_rng(1).normal(0, 0.02, clean.positions.shape)
    noisy = bsm.TriangleMesh(clean.positions + noise, clean.faces)
    before = bsm.compare(clean, noisy).theta_deg
    assert bsm.compare(clean, bsm.denoise((noisy.positions, noisy.faces))).theta_deg < before
    assert same(
        bsm.denoise(noisy, bsm.DenoiseOptions(iterations=2)), bsm.denoise(noisy, iterations=2)
    )


def test_denoise_warns_of_normals_that_it_leaves_out():
    clean = torus(48, 32, bumps=0.0)
    normals = bsm.Attribute(
        "normal", np.tile([0.0, 0.0, 1.0], (len(clean.positions), 1)), semantic="normal"
    )
    dressed = bsm.TriangleMesh(clean.positions, clean.faces, [normals])
    assert bsm.denoise(dressed) is dressed
    with pytest.warns(bsm.BsmWarning, match="normal"):
        moved = bsm.denoise(dressed, keep=0.05, force=True)
    assert not moved.attributes


# ---------------------------------------------------------------------------------------------- in memory, and in part


@pytest.mark.parametrize("kind", ["ply", "stl", "off", "obj", "glb", "npz", "vtp", "bsm"])
def test_files_in_memory_are_those_on_disk(mesh, kind, tmp_path):
    file = io.BytesIO()
    lost = bsm.save(mesh, file, format=kind)
    path = tmp_path / f"mesh.{kind}"
    assert lost == bsm.save(mesh, path)
    if kind != "npz":  # archives hold the time of writing
        assert file.getvalue() == path.read_bytes()
    from_memory = bsm.load(file.getvalue(), format=None if kind == "bsm" else kind)
    assert same(from_memory, bsm.load(path))


def test_files_beside_one_in_memory_are_named(tmp_path):
    flat = bsm.TriangleMesh([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
    (tmp_path / "a.mtl").write_text("newmtl red\nKd 1 0 0\n")
    bsm.save(flat, tmp_path / "a.obj")
    text = (tmp_path / "a.obj").read_text().replace("f ", "usemtl red\nf ")
    (tmp_path / "a.obj").write_text(f"mtllib a.mtl\n{text}")
    file = io.BytesIO()
    assert bsm.save(bsm.load(tmp_path / "a.obj"), file, format="obj") == ("mesh.mtl",)


def test_an_open_file_needs_a_format(mesh):
    with pytest.raises(bsm.ArgumentError, match='format="ply"'):
        bsm.save(mesh, io.BytesIO())
    with pytest.raises(bsm.OptionError, match="nonsense"):
        bsm.save(mesh, io.BytesIO(), format="nonsense")


def test_info_is_that_of_the_command(stream, tmp_path, capsys):
    (tmp_path / "a.bsm").write_bytes(stream)
    assert main(["info", "--json", str(tmp_path / "a.bsm")]) == 0
    printed = json.loads(capsys.readouterr().out)
    facts = bsm.info(tmp_path / "a.bsm")
    assert printed["vertices"] == facts["vertices"] and printed["bytes"] == facts["bytes"]
    assert bsm.info(stream) == facts
    with pytest.raises(bsm.FormatError):
        bsm.info(b"nonsense")


def test_a_stream_in_part_and_a_damaged_one(decoded):
    stream = bsm.encode(torus(40, 30), block_size=150, step=0.004)
    whole = bsm.decode(stream)
    part = bsm.decode(stream, blocks=1)
    assert 0 < len(part.faces) < len(whole.faces)
    damaged = bytearray(stream)
    damaged[len(stream) * 3 // 4] ^= 255
    with pytest.raises(bsm.CorruptError):
        bsm.decode(damaged)
    with pytest.warns(bsm.BsmWarning, match="lost"):
        left = bsm.decode(damaged, tolerant=True)
    assert 0 < len(left.faces) <= len(whole.faces)
    with pytest.raises(bsm.OptionError, match="leave out"):
        bsm.decode(stream, blocks=1, tolerant=True)


def test_limits_have_names_everywhere(mesh, stream, tmp_path):
    bsm.save(mesh, tmp_path / "a.ply")
    for name in ("default", "service", "wide"):
        assert same(bsm.decode(stream, limits=name), bsm.decode(stream))
        assert same(bsm.load(tmp_path / "a.ply", limits=name), bsm.load(tmp_path / "a.ply"))
        assert bsm.info(stream, limits=name)["vertices"] == len(mesh.positions)
        with bsm.Decoder(name) as decoder:
            assert any(isinstance(event, bsm.EndEvent) for event in decoder.events([stream]))
    with pytest.raises(bsm.ArgumentError, match="'service'"):
        bsm.decode(stream, limits="services")


def test_a_missing_folder_is_named_and_nothing_else(mesh, tmp_path):
    path = tmp_path / "no" / "where.ply"
    with pytest.raises(FileNotFoundError) as caught:
        bsm.save(mesh, path)
    assert str(caught.value).endswith(
        f"folder {path.parent} of the output does not exist; create it first: '{path}'"
    )
