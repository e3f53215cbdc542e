"""What stays the same from generation to generation, and what a stream says of how it was made."""

from dataclasses import replace
from hashlib import sha256

import numpy as np
import pytest

import bsm
from bsm import BsmError, TriangleMesh, read_mesh
from bsm.cli import main
from bsm.files.table import WRITTEN_FORMATS
from tests.conftest import mesh_folder
from tests.shapes import curved, tetrahedron, torus

GENERATIONS = 10
MADE = {
    "torus": torus(20, 12),
    "curved": curved(torus(30, 20)),
    "tetrahedron": tetrahedron(),
    "far": (torus(12, 8).positions * 1e-3 + 1e4, torus(12, 8).faces),
    "uneven": (torus(12, 8).positions * (1.0, 0.5, 1e2), torus(12, 8).faces),
    "random": (
        np.random.default_rng(1).normal(size=(60, 3)),
        np.random.default_rng(2).integers(0, 60, (200, 3)),
    ),
}
MOST_BYTES = 300_000  # of real files: larger ones say nothing more


def real():
    folder = mesh_folder()
    paths = (
        []
        if folder is None
        else [path for room in ("assets", "hostile") for path in (folder / room).iterdir()]
    )
    return sorted(
        f"{path.parent.name}/{path.name}" for path in paths if path.stat().st_size < MOST_BYTES
    )


def generations(mesh, preset, count=GENERATIONS):
    """The streams of a mesh, for `lossless` in single precision, of what that decodes to, and so on."""
    if preset == "lossless":
        mesh = replace(mesh, positions=mesh.positions.astype(np.float32))
    for _ in range(count):
        data = bsm.encode(mesh, preset=preset, threads=1)
        yield data
        mesh = bsm.decode(data, threads=1)


@pytest.mark.parametrize("preset", ["grid14", "lossless"])
@pytest.mark.parametrize("name", MADE)
def test_ten_generations_are_the_same_bytes(name, preset):
    mesh = MADE[name] if isinstance(MADE[name], TriangleMesh) else TriangleMesh(*MADE[name])
    assert len({*generations(mesh, preset)}) == 1


def test_vertices_that_rounding_puts_at_one_place_are_one_from_the_second_generation_on():
    flat = TriangleMesh(torus(12, 8).positions * (1.0, 1e-3, 1e3), torus(12, 8).faces)
    first, second, *others = generations(flat, "grid14")
    assert set(others) == {second} != {first}
    places = [{tuple(row) for row in bsm.decode(data).positions} for data in (first, second)]
    assert places[0] == places[1] and bsm.compare(flat, first).merged > 0


@pytest.mark.real
@pytest.mark.parametrize("preset", ["grid14", "lossless"])
@pytest.mark.parametrize(
    "name", real() or [pytest.param("", marks=pytest.mark.skip("no real meshes"))]
)
def test_real_meshes_come_back_in_every_generation(name, preset, meshes):
    """Once two generations are the same bytes, all that follow are."""
    try:
        mesh = read_mesh(str(meshes / name)).mesh.bare
        first, second, third = generations(mesh, preset, 3)
    except BsmError:
        pytest.skip("no mesh that can be encoded")
    assert second == third
    kept = [bsm.decode(data) for data in (first, second)]
    # Vertices at one place became one.
    assert first == second or len(kept[1].positions) < len(kept[0].positions)
    assert np.array_equal(*(np.unique(mesh.positions, axis=0) for mesh in kept))


def printed(capsys, *words):
    capsys.readouterr()
    assert main([*map(str, words)]) == 0
    return capsys.readouterr()


def test_a_stream_says_how_it_was_made_and_the_next_one_that_it_is_another_generation(
    tmp_path, capsys
):
    source, stream, again = tmp_path / "a.ply", tmp_path / "a.bsm", tmp_path / "b.ply"
    bsm.save(torus(20, 12), source)
    assert not printed(capsys, "encode", source).err.count("generation")
    assert "provenance" not in bsm.decode(stream).metadata
    printed(capsys, "encode", source, "-f", "--provenance", "--max-error", "0.2%")
    made = bsm.decode(stream).metadata["provenance"]
    digest = sha256(source.read_bytes()).hexdigest()
    assert made == f"bsm {bsm.__version__} balanced max_error=0.2% sha256={digest}"
    assert made in printed(capsys, "info", stream).out
    printed(capsys, "decode", stream, "-o", again)
    assert "is generation 2: errors add up" in printed(capsys, "encode", again).err
    second = bsm.decode(tmp_path / "b.bsm").metadata["provenance"]
    assert second.startswith(f"bsm {bsm.__version__} balanced generation=2 sha256=")
    printed(capsys, "decode", tmp_path / "b.bsm", "-o", tmp_path / "c.ply")
    third = printed(capsys, "encode", tmp_path / "c.ply", "--preset", "lossless", "--no-provenance")
    assert "is generation 3\n" in third.err
    assert "provenance" not in bsm.decode(tmp_path / "c.bsm").metadata
    # Python counts generations as the command line does; a user's own words stay.
    with pytest.warns(bsm.BsmWarning, match="is generation 2: errors add up"):
        counted = bsm.decode(bsm.encode(bsm.decode(stream), preset="fine")).metadata["provenance"]
    assert counted == f"bsm {bsm.__version__} fine generation=2"
    assert "provenance" not in bsm.decode(bsm.encode(bsm.decode(stream), provenance=False)).metadata
    own = {"provenance": "a flea market"}
    assert bsm.decode(bsm.encode(bsm.load(source), metadata=own)).metadata == own


@pytest.mark.parametrize("kind", WRITTEN_FORMATS)
def test_a_decoded_file_says_so_and_the_next_stream_which_generation_it_is(
    kind, tmp_path, capsys, monkeypatch
):
    if kind == "3mf":
        pytest.importorskip("lib3mf", reason="needs lib3mf (extra formats)")
    monkeypatch.chdir(tmp_path)
    bsm.save(torus(20, 12), "a.ply")
    assert "generation" not in printed(capsys, "encode", "a.ply").err
    for generation in (2, 3):
        printed(capsys, "decode", "a.bsm", "-f", "-o", f"b.{kind}")
        errors = printed(capsys, "encode", f"b.{kind}", "-f", "-o", "a.bsm").err
        assert f"generation {generation}: errors add up" in errors
    assert bsm.decode("a.bsm").metadata["provenance"] == f"bsm {bsm.__version__} generation=3"
    printed(capsys, "encode", "a.ply", "-f", "--preset", "lossless")
    printed(capsys, "decode", "a.bsm", "-f", "-o", f"b.{kind}")
    assert "generation" not in printed(capsys, "encode", f"b.{kind}", "-f", "-o", "a.bsm").err


@pytest.mark.parametrize("name", ["b.npz", "b.pc2", "b%04d.ply"])
def test_frames_say_how_they_were_made(name, tmp_path, capsys):
    frames = np.stack([torus(12, 8).positions + 0.1 * t for t in range(3)])
    np.savez(tmp_path / "a.npz", positions=frames, faces=torus(12, 8).faces)
    printed(capsys, "encode", tmp_path / "a.npz", "--provenance")
    assert " balanced sha256=" in printed(capsys, "info", tmp_path / "a.bsm").out
    printed(capsys, "encode", tmp_path / "a.npz", "-f")
    printed(capsys, "decode", tmp_path / "a.bsm", "-o", tmp_path / name)
    assert (
        "generation 2: errors add up"
        in printed(capsys, "encode", tmp_path / name, "-o", tmp_path / "b.bsm").err
    )
