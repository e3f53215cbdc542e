"""Answers to mistakes of newcomers: they are true, and say what to type instead."""

import base64
import io
import json
from pathlib import Path

import numpy as np
import pytest

import bsm
from bsm.evaluation.curve import mesh_facts, read_points
from bsm.ground.synonyms import OPTIONS, advice_on_keyword
from tests.bsm.program import run
from tests.shapes import torus


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder with a mesh, a stream of blocks, a sequence, its frames, and a scene."""
    monkeypatch.chdir(tmp_path)
    mesh = torus(24, 24)
    bsm.save(mesh, "ring.ply")
    bsm.save(mesh, "ring.glb")
    bsm.save(mesh, "ring.bsm", coefficients=20, block_size=100)
    frames = np.array([mesh.positions + 0.1 * number for number in range(4)])
    np.savez("walk.npz", positions=frames, faces=mesh.faces)
    (tmp_path / "frames").mkdir()
    for number, frame in enumerate(frames, 1):
        bsm.save(bsm.TriangleMesh(frame, mesh.faces), f"frames/walk_{number:04d}.obj")
    return tmp_path


ANSWERS = """
encode ring.ply --coefficients 50 | instead: --set coefficients=
encode ring.ply --block-size 50 | instead: --set block_size=
encode ring.ply --scale 0.001 | instead: --meta unit=mm | bsm decode --unit-out m scales
encode ring.ply --textures keep | instead: --images keep
glb ring.glb -o out.glb -cc | instead: --preset small
glb ring.glb -o out.glb --max-error 0.1% | instead: --preset near-lossless
encode frames --start 1 --end 10 | instead: --frames 1:10 (frames 1 to 9, where 0 is the first)
encode frames --size 10kB | for single meshes | instead: bpvf=2, as an option --bpvf 2
decode ring.bsm -o no/where.ply | the folder no of the output does not exist; create it first
view -r frames | FOLDER/*.bsm | bsm view also takes a folder
info -r frames | FOLDER/*.bsm
verify -r frames --report check.json | instead: --json > report.json
checksum ring.bsm | bsm verify
cite | CITATION.cff
--cite | CITATION.cff
curve --help-all | unknown option --help-all; instead: --help
curve --nonsense | unknown option --nonsense
decode ring.bsm -o b.ply --blocks 1:3 | is a range | from the first on
encode ring.ply --grid 1.5 | a whole number is expected
encode ring.ply --grid-cell 1 --grid-origin 1,2 | 3 numbers with commas between them
encode -r frames -o one.bsm | -o one/ | -o one.bsm/
decode -r . -o all.ply | -o all/ | -o all.ply/
encode ring.jpg | it is a picture
encode walk.bvh | it moves a skeleton
encode ring.ply -o x.bsm --images webp:101 | from 1 to 100, not 101
encode ring.ply -o x.bsm --kg 1 | nmsve_db
info frames | is a folder without streams
info . | bsm info ./*.bsm | bsm verify -r
compare . frames | add -r
"""


@pytest.mark.parametrize("line", ANSWERS.strip().splitlines())
def test_an_answer_says_what_to_type(line, folder, capsys):
    for name in ("ring.jpg", "walk.bvh"):
        Path(name).write_bytes(b"\xff\xd8\xff" + bytes(90))
    words, *expected = line.split(" | ")
    assert run(*words.split()) not in (0, None)
    answer = capsys.readouterr().err
    assert all(part in answer for part in expected), answer
    assert "Traceback" not in answer
    assert not Path("one.bsm").exists() and not Path("all.ply").exists()


def test_a_folder_may_be_called_like_a_file_where_that_is_meant(folder):
    assert run("encode", "-r", "frames", "-o", "all.bsm/", "-q") == 0
    assert (folder / "all.bsm/walk_0001.bsm").is_file()
    assert run("encode", "-r", "frames", "-o", "all.bsm", "-q", "-f") == 0


def test_a_plain_scene_is_told_from_a_compressed_one(folder, capsys):
    assert run("info", "ring.glb") == 0
    assert capsys.readouterr().out.startswith(
        "scene of 1 primitive, not compressed: bsm glb ring.glb -o OUT.glb"
    )


def test_decoded_blocks_are_counted(folder, capsys):
    count = bsm.info("ring.bsm")["blocks"]
    assert count > 2
    assert run("decode", "ring.bsm", "-o", "a.ply", "--blocks", 2) == 0
    assert f"ring.bsm: the first 2 of {count} blocks\n" in capsys.readouterr().err
    assert run("decode", "ring.bsm", "-o", "b.ply", "--blocks", 999) == 0
    assert f"--blocks 999: the stream has {count}, and all were decoded" in capsys.readouterr().err
    with pytest.warns(
        bsm.BsmWarning, match=f"blocks=999: the stream has {count}, and all were decoded"
    ):
        bsm.decode("ring.bsm", blocks=999)


def test_a_part_of_a_stream_without_parts_is_all_of_it_and_said(folder, capsys):
    Path("whole.bsm").write_bytes(bsm.encode(bsm.load("ring.ply"), preset="lossless"))
    assert run("decode", "whole.bsm", "--blocks", 1) == 0
    assert (
        "whole.bsm: --blocks 1: the stream has no blocks, and all of it was decoded\n"
        in capsys.readouterr().err
    )
    with pytest.warns(bsm.BsmWarning, match="blocks=1: the stream has no blocks"):
        bsm.decode("whole.bsm", blocks=1)
    assert run("decode", "whole.bsm", "--layers", 1, "-f") == 0
    assert (
        "whole.bsm: --layers 1: the stream has 1, and all of it was decoded\n"
        in capsys.readouterr().err
    )


def test_frames_are_told_by_number_and_name(folder, capsys):
    assert run("encode", "frames", "-o", "some.bsm", "--frames", "1:3") == 0
    answer = capsys.readouterr().err
    assert "frames 1 to 2, where 0 is the first: walk_0002.obj to walk_0003.obj" in answer
    assert answer.count("where 0 is the first") == 1
    assert run("encode", "walk.npz", "-o", "other.bsm", "--frames", "1:") == 0
    assert "walk.npz: frames 1 to 3, where 0 is the first\n" in capsys.readouterr().err


def test_the_mesh_of_a_cache_is_named(folder, capsys):
    assert run("encode", "walk.npz", "-q") == 0
    assert run("decode", "walk.bsm", "-o", "w.pc2") == 0
    assert "PC2 holds no faces; they are in w.obj" in capsys.readouterr().err
    assert Path("w.obj").is_file()


def test_coefficients_beyond_a_block_are_told(folder, capsys):
    assert run("encode", "ring.ply", "-o", "c.bsm", "--set", "coefficients=100000") == 0
    most = int(capsys.readouterr().err.partition("coefficients: ")[2].partition(" at most")[0])
    assert (
        most == bsm.info("c.bsm")["block_size"] and max(bsm.info("c.bsm")["coefficients"]) <= most
    )
    assert run("encode", "ring.ply", "-o", "d.bsm", "--set", "coefficients=5") == 0
    assert "coefficients:" not in capsys.readouterr().err


POINTS = {
    "": "the file is empty",
    '{"label": "mine", "bpv": [4, 8]}': "CSV is expected",
    "label;bpv;theta_deg\nmine;4;3\n": "separated by commas, not by ';'",
    "label\tbpv\ttheta_deg\nmine\t4\t3\n": "separated by commas",
    "mine,4,3\n": "its first line must name label, bpv, and theta_deg or nmsve_db; it is 'mine,4,3'",
    "label,bpv,nmsve_db\nmine,4,45\n": "line 2: nmsve_db is 45, .* is it -45",
    "label,bpv,theta_deg\nmine,4,-3\n": "line 2: theta_deg is -3; .* 0 to 180 degrees",
    "label,bpv,theta_deg\nmine,4,181\n": "line 2: theta_deg is 181",
}


@pytest.mark.parametrize("text", POINTS)
def test_points_that_cannot_be_meant_are_refused(text, tmp_path):
    file = tmp_path / "points.csv"
    file.write_text(text)
    facts = {"ring": mesh_facts(torus(6, 5), "ring")}
    with pytest.raises(bsm.FormatError, match=POINTS[text]):
        read_points(str(file), facts)
    file.write_text("label,bpv,nmsve_db\nmine,4,-45\n")
    assert read_points(str(file), facts)[0]["points"][0]["nmsve_db"] == -45


def test_a_dae_holds_ambient_and_specular_colors(tmp_path):
    collada = pytest.importorskip("collada")
    words = {
        "name": "orange",
        "Ka": "0.1 0.2 0.3",
        "Kd": "1 0.5 0",
        "Ks": "0.4 0.5 0.6",
        "Ns": "12",
        "Ni": "1.5",
    }
    metadata = {f"material.0.{word}": value for word, value in words.items()}
    mesh = bsm.TriangleMesh(torus(6, 5).positions, torus(6, 5).faces, metadata=metadata)
    assert bsm.save(mesh, tmp_path / "a.dae") == ()
    effect = collada.Collada(str(tmp_path / "a.dae")).effects[0]
    assert effect.ambient[:3] == pytest.approx((0.1, 0.2, 0.3))
    assert effect.specular[:3] == pytest.approx((0.4, 0.5, 0.6))
    assert (effect.shininess, effect.index_of_refraction) == pytest.approx((12, 1.5))
    # What no effect holds is still named.
    odd = bsm.TriangleMesh(
        mesh.positions, mesh.faces, metadata={**metadata, "material.0.Ka": "spectral a.rfl"}
    )
    assert bsm.save(odd, tmp_path / "b.dae") == ("Ka of material orange",)


def mesh_of_a_ring() -> bsm.TriangleMesh:
    return torus(6, 5)


PYTHON = {
    "there are no bytes": (bsm.TruncatedError, lambda data: bsm.decode(b"")),
    r"bytes.fromhex\(text\)": (bsm.ArgumentError, lambda data: bsm.decode(data.hex())),
    r"base64.b64decode\(text\)": (
        bsm.ArgumentError,
        lambda data: bsm.decode(base64.b64encode(data).decode()),
    ),
    "this is a PLY, not a BSM stream; bsm.load reads it": (
        bsm.FormatError,
        lambda data: bsm.decode(ply_bytes()),
    ),
    "Limits has no limit max_vertices; did you mean vertices": (
        bsm.ArgumentError,
        lambda data: bsm.Limits(max_vertices=2),
    ),
    "decode has no keyword timeout; instead: limits='service'": (
        bsm.ArgumentError,
        lambda data: bsm.decode(data, timeout=5),
    ),
    "decode has no keyword thread; did you mean threads": (
        bsm.ArgumentError,
        lambda data: bsm.decode(data, thread=1),
    ),
    "decode has no keyword verbose; its keywords are blocks": (
        bsm.ArgumentError,
        lambda data: bsm.decode(data, verbose=True),
    ),
    "quality for a mesh; instead: preset='fine'": (
        bsm.ArgumentError,
        lambda data: bsm.encode(mesh_of_a_ring(), quality=10),
    ),
    "it is an entry of the metadata": (
        bsm.ArgumentError,
        lambda data: bsm.encode(mesh_of_a_ring(), unit="mm"),
    ),
    "come without a name": (
        bsm.ArgumentError,
        lambda data: bsm.encode(mesh_of_a_ring(), options=bsm.EncodeOptions()),
    ),
    "did you mean coefficients": (bsm.ArgumentError, lambda data: bsm.EncodeOptions(coefs=50)),
    "its options are keep": (bsm.ArgumentError, lambda data: bsm.EncodeOptions(xyz=50)),
    'format="ply"': (bsm.ArgumentError, lambda data: bsm.save(mesh_of_a_ring(), io.BytesIO())),
    "frame 1 has 3 vertices, and frame 0 has 30; encode_frames": (
        bsm.MeshError,
        lambda data: bsm.encode_sequence(
            [mesh_of_a_ring().positions, np.ones((3, 3))], mesh_of_a_ring().faces
        ),
    ),
    "its vertices are mesh.positions": (AttributeError, lambda data: mesh_of_a_ring().vertices),
    "its triangles are mesh.faces": (AttributeError, lambda data: mesh_of_a_ring().triangles),
    r"bsm.save\(mesh, path\)": (AttributeError, lambda data: mesh_of_a_ring().save("x.ply")),
}


def ply_bytes() -> bytes:
    file = io.BytesIO()
    bsm.save(mesh_of_a_ring(), file, format="ply")
    return file.getvalue()


@pytest.mark.parametrize("message", PYTHON)
def test_errors_of_python_say_what_to_write(message):
    error, call = PYTHON[message]
    with pytest.raises(error, match=message):
        call(bsm.encode(mesh_of_a_ring(), grid=10))


def test_advice_on_keywords_names_keywords_that_there_are():
    """An advice is a keyword of the function and, but for true, a literal value."""
    keywords = (
        "preset",
        "max_error",
        "size",
        "grid",
        "threads",
        "limits",
        "frame_rate",
        "effort",
        "attribute",
    )
    answers = {
        word: advice_on_keyword(word.lstrip("-").replace("-", "_"), keywords) for word in OPTIONS
    }
    given = {word: answer.partition("=") for word, answer in answers.items() if answer}
    assert given["--fps"] == ("frame_rate", "=", "30") and given["--quality"][2] == "'fine'"
    for word, (keyword, _, value) in given.items():
        assert keyword in keywords, word
        assert value == "True" or json.loads(value.replace("'", '"')) is not None
