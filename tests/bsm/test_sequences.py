import io
import json
import subprocess
import sys

import numpy as np
import pytest

from bsm import (
    Attribute,
    FormatError,
    MeshError,
    OptionError,
    TriangleMesh,
    TruncatedError,
    decode_frames,
    read_mesh,
    save,
)
from bsm.files.formats.npz import read_npy
from bsm.files.pipes import Input
from bsm.files.sequence import sequence_kind
from tests.bsm.program import run as bsm
from tests.bsm.program import run_json
from tests.motion import bending, save_frames, sequence_in
from tests.shapes import torus

FRAMES = 6
QUICK = ("--set", "step=0.002")
"""Of tests that are about something else: no promise is to be found out."""


@pytest.fixture
def npz(tmp_path):
    positions, faces = bending(FRAMES)
    path = tmp_path / "torus.npz"
    np.savez(path, positions=positions.astype(np.float32), faces=faces)
    return path


@pytest.mark.parametrize("kind", ["npz", "npy", "obj", "ply"])
def test_there_and_back_in_every_form(npz, tmp_path, kind):
    stream, back = (
        tmp_path / "a.bsm",
        tmp_path / (f"back.{kind}" if kind in ("npz", "npy") else "back"),
    )
    encoded = run_json("encode", npz, "-o", stream, "--gop", 4, *QUICK)
    assert encoded["frames"] == FRAMES and encoded["bytes"] == stream.stat().st_size
    decoded = run_json("decode", stream, "-o", back, *([] if back.suffix else ["--format", kind]))
    assert decoded["frames"] == FRAMES
    direct, through = run_json("compare", npz, stream), run_json("compare", npz, back)
    assert through["kg"] == pytest.approx(direct["kg"], rel=1e-4) and 0 < direct["kg"] < 1
    assert direct["bpvf_total"] == pytest.approx(encoded["bpvf_total"])
    # What was decoded is a sequence again.
    assert run_json("encode", back, "-o", tmp_path / "again.bsm", *QUICK)["frames"] == FRAMES


def test_info_and_verify(npz, tmp_path, capsys):
    stream = tmp_path / "a.bsm"
    encoded = run_json(
        "encode", npz, "-o", stream, "--gop", 4, "--frame-rate", 25, "--preset", "near-lossless"
    )
    info = run_json("info", stream)
    assert info["frames"] == FRAMES and info["metadata"]["frame_rate"] == 25
    lengths = [gop["frames"] for gop in info["gops"]]
    assert max(lengths) <= 4 and sum(lengths) == FRAMES
    assert [gop["first"] for gop in info["gops"]] == np.cumsum([0, *lengths[:-1]]).tolist()
    assert all(stream.read_bytes()[gop["offset"]] & 15 == 7 for gop in info["gops"])
    assert info["bpvf_total"] == pytest.approx(encoded["bpvf_total"])
    assert (
        bsm("info", stream) == 0
        and f"6 frames, 25 per second, in {len(lengths)} GOPs" in capsys.readouterr().out
    )
    assert bsm("verify", stream) == 0
    broken = bytearray(stream.read_bytes())
    broken[info["gops"][1]["offset"] + 20] ^= 1
    stream.write_bytes(broken)
    assert bsm("verify", stream) != 0


def test_some_frames_only(npz, tmp_path):
    stream, whole, part = tmp_path / "a.bsm", tmp_path / "whole.npz", tmp_path / "part.npz"
    assert bsm("encode", npz, "-o", stream, "--gop", 2, *QUICK) == 0
    assert bsm("decode", stream, "-o", whole) == 0
    for text, chosen in (
        ("3:5", slice(3, 5)),
        (":2", slice(2)),
        ("4:", slice(4, None)),
        ("5:99", slice(5, None)),
    ):
        assert bsm("decode", stream, "-o", part, "-f", "--frames", text) == 0
        assert np.array_equal(np.load(part)["positions"], np.load(whole)["positions"][chosen])
    for text in ("3", "3:3", "a:b", "-1:2", "6:9"):
        assert bsm("decode", stream, "-o", part, "-f", f"--frames={text}") != 0


def test_tolerant_decoding_names_what_is_lost(npz, tmp_path, capsys):
    stream, part = tmp_path / "a.bsm", tmp_path / "part.npz"
    assert bsm("encode", npz, "-o", stream, "--gop", 2, *QUICK) == 0
    gop = next(gop for gop in run_json("info", stream)["gops"] if gop["first"] == 2)
    broken = bytearray(stream.read_bytes())
    broken[gop["offset"] + 20] ^= 1
    stream.write_bytes(broken)
    assert bsm("decode", stream, "-o", part) != 0 and not part.exists()
    assert bsm("decode", stream, "-o", part, "--tolerant") == 0
    error = capsys.readouterr().err
    assert (
        "frames 2 to 3 are lost: " in error
        and "frames 4 to 5 are lost: a GOP refers to a missing GOP" in error
    )
    assert len(np.load(part)["positions"]) == 2


def test_folders_and_patterns_are_taken_in_the_order_of_numbers(tmp_path):
    positions, faces = bending(12)
    save_frames(tmp_path / "run", "off", positions, faces)
    for number in range(12):
        (tmp_path / "run" / f"{number:05d}.off").rename(tmp_path / "run" / f"{number}.off")
    for path in (tmp_path / "run", tmp_path / "run" / "*.off"):
        source = sequence_in(str(path))
        assert source.count == 12
        assert np.abs(np.array(list(source.frames)) - positions).max() < 1e-6


def test_colors_that_change_are_not_dropped_in_silence(tmp_path, capsys):
    positions, faces = bending(3)
    kinds = ("once", "face", (0, 9, 0)), ("on", "face", (0, 9, 18)), ("move", "vertex", (0, 9, 0))
    for name, domain, shades in kinds:
        (tmp_path / name).mkdir()
        for number, shade in enumerate(shades):
            size = len(faces if domain == "face" else positions[0])
            color = Attribute("color", np.full((size, 3), shade, np.uint8), domain, "color")
            save(
                TriangleMesh(positions[number], faces, [color]),
                str(tmp_path / name / f"{number}.ply"),
            )
    stream = tmp_path / "x.bsm"
    assert bsm("encode", tmp_path / "once", "-o", stream, "--set", "step=0.01") != 0
    assert "color differs in" in capsys.readouterr().err and not stream.exists()
    assert bsm("encode", tmp_path / "once", "-o", stream, "--set", "step=0.01", "--runs") == 0
    assert "color changes at frame 1, but stays as before" in capsys.readouterr().err
    assert bsm("encode", tmp_path / "on", "-o", stream, "--set", "step=0.01", "--force") == 0
    assert "left out, for they move or change: color" in capsys.readouterr().err
    assert bsm("encode", tmp_path / "move", "-o", stream, "--set", "step=0.01", "--force") == 0
    assert (
        "color: per vertex, moves, within 0.09 on average in every frame" in capsys.readouterr().err
    )
    assert bsm("decode", stream, "-o", f"{tmp_path / 'back'}/", "--format", "ply") == 0
    for number, shade in enumerate((0, 9, 0)):
        (color,) = read_mesh(tmp_path / "back" / f"0000{number}.ply").mesh.attributes
        assert (color.values == shade).all()
    np.savez(
        tmp_path / "x.npz",
        positions=positions,
        faces=faces,
        colors=np.zeros((3, len(positions[0]), 5), np.uint8),
    )
    assert bsm("encode", tmp_path / "x.npz", "-o", stream, "--set", "step=0.01", "--force") == 0
    assert "left out: colors" in capsys.readouterr().err


def test_arrays_that_change_go_from_npz_to_npz_and_to_forms_that_hold_them(tmp_path, capsys):
    positions, faces = bending(5)
    times = np.arange(5)[:, None]
    arrays = {
        "vertex/heat": 300 + np.sin(3 * positions[0][:, 0] + 0.5 * times),
        "color": (120 + 100 * np.sin(positions + times[:, :, None])).astype(np.uint8),
        "part": np.arange(len(faces)) // 50,
        "height": positions[0][:, 2].astype(np.float32),
        "junk": np.arange(3),
    }
    np.savez(tmp_path / "x.npz", positions=positions, faces=faces, **arrays)
    stream, back = tmp_path / "x.bsm", tmp_path / "back.npz"
    wanted = (
        word
        for each in ("heat=0.002", "color=exact", "height=exact")
        for word in ("--attribute", each)
    )
    assert bsm("encode", tmp_path / "x.npz", "-o", stream, "--keep-order", *wanted, *QUICK) == 0
    errors = capsys.readouterr().err
    assert (
        "left out: junk" in errors
        and "heat: per vertex, moves, within 0.002 in every frame" in errors
    )
    assert bsm("decode", stream, "-o", back) == 0
    with np.load(back) as found:
        assert len(found) == 7 and {"positions", "faces", "metadata"} <= {*found}
        np.testing.assert_array_equal(found["vertex/color"], arrays["color"])
        np.testing.assert_array_equal(found["face/part"][:, 0], arrays["part"])
        np.testing.assert_array_equal(found["vertex/height"][:, 0], arrays["height"])
        assert found["vertex/heat"].shape == (5, len(positions[0]), 1)
        assert np.abs(found["vertex/heat"][:, :, 0] - arrays["vertex/heat"]).max() <= 0.002
        again = {name: found[name] for name in found}
    np.savez(tmp_path / "again.npz", **again)
    assert (
        bsm("encode", tmp_path / "again.npz", "-o", tmp_path / "again.bsm", "--set", "step=0.01")
        == 0
    )
    assert bsm("decode", stream, "-o", f"{tmp_path / 'ply'}/", "--format", "ply") == 0
    colors = {a.name: a.values for a in read_mesh(tmp_path / "ply" / "00003.ply").mesh.attributes}
    np.testing.assert_array_equal(colors["color"], arrays["color"][3])
    capsys.readouterr()
    assert bsm("decode", stream, "-o", tmp_path / "back.pc2") == 0
    assert "how color changes" in capsys.readouterr().err
    assert bsm("decode", stream, "-o", tmp_path / "back.glb") == 0
    left_out = capsys.readouterr().err
    assert "how heat changes" in left_out and "how color changes" not in left_out
    frames = sequence_in(tmp_path / "back.glb").meshes
    for mesh, shades in zip(frames, arrays["color"], strict=True):
        (color,) = (
            attribute.values for attribute in mesh.attributes if attribute.semantic == "color"
        )
        np.testing.assert_array_equal(np.unique(color[:, :3], axis=0), np.unique(shades, axis=0))
    assert bsm("info", stream) == 0
    assert "uint8 per vertex, color" in capsys.readouterr().out
    last = {
        attribute.name: attribute.values for attribute in list(decode_frames(stream))[4].attributes
    }
    np.testing.assert_array_equal(last["color"], arrays["color"][4])


def test_a_field_that_is_not_finite_is_refused_with_its_frame(tmp_path, capsys):
    positions, faces = bending(3)
    heat = np.zeros((3, len(positions[0])))
    heat[2, 7] = np.nan
    np.savez(tmp_path / "x.npz", positions=positions, faces=faces, heat=heat)
    assert bsm("encode", tmp_path / "x.npz", "-o", tmp_path / "x.bsm") != 0
    assert "frame 2: a value of the attribute 'heat' is not finite" in capsys.readouterr().err
    assert not (tmp_path / "x.bsm").exists()


def test_permutation_restores_the_order(npz, tmp_path):
    stream, order, back = (tmp_path / name for name in ("a.bsm", "order.npy", "back.npz"))
    assert bsm("encode", npz, "-o", stream, "--permutation", order, *QUICK) == 0
    assert bsm("decode", stream, "-o", back, "--permutation", order) == 0
    original, decoded = np.load(npz), np.load(back)
    assert np.abs(original["positions"] - decoded["positions"]).max() < 0.04
    assert run_json("compare", npz, stream, "--permutation", order)["kg"] < 1


@pytest.mark.slow
def test_what_only_wide_limits_allow_is_written_for_them(tmp_path):
    positions, faces = bending(2, 60, 40)
    np.savez(tmp_path / "large.npz", positions=positions, faces=faces)
    words = [
        "encode",
        tmp_path / "large.npz",
        "-o",
        tmp_path / "a.bsm",
        "--quick",
        "--set",
        "block_size=2300",
    ]
    for more in ([], ["-q"]):
        assert bsm(*words, *more) == 2 and not (tmp_path / "a.bsm").exists()
    assert bsm(*words, "--set", "limits=wide") == 0


@pytest.mark.parametrize(
    "words", [["--kg", 1, "--bpvf", 2], ["--set", "doi=1,2"], ["--bpv", 2], ["--gop", 0]]
)
def test_options_that_do_not_go_with_a_sequence(npz, tmp_path, words):
    assert bsm("encode", npz, "-o", tmp_path / "a.bsm", *words) != 0
    assert not (tmp_path / "a.bsm").exists()


def test_options_of_sequences_do_not_go_with_a_mesh(npz, tmp_path, capsys):
    assert bsm("decode", npz) != 0
    positions, faces = bending(1)
    np.savez(tmp_path / "mesh.npz", positions=positions[0], faces=faces)
    assert bsm("encode", tmp_path / "mesh.npz", "--gop", 3) != 0
    assert "sequences" in capsys.readouterr().err
    assert bsm("encode", npz, *QUICK) == 0 and bsm("encode", tmp_path / "mesh.npz", *QUICK) == 0
    assert bsm("decode", npz.with_suffix(".bsm"), "--blocks", 1, "-o", tmp_path / "x.npz") != 0
    assert bsm("decode", npz.with_suffix(".bsm"), "-o", tmp_path / "x.ply") != 0
    assert bsm("decode", tmp_path / "mesh.bsm", "--format", "npy", "-o", tmp_path / "x.npy") != 0
    assert bsm("compare", npz, tmp_path / "mesh.npz") != 0


@pytest.mark.long
def test_live_pipes():
    positions, faces = bending(9)
    encoding = [
        sys.executable,
        "-m",
        "bsm",
        "encode",
        "-",
        "--format",
        "npy",
        "-o",
        "-",
        "--low-delay",
        "1",
    ]
    decoding = [sys.executable, "-m", "bsm", "decode", "-", "-o", "-"]
    pipe = subprocess.PIPE
    with (
        subprocess.Popen(encoding, stdin=pipe, stdout=pipe) as encode,
        subprocess.Popen(decoding, stdin=encode.stdout, stdout=pipe) as decode,
    ):
        encode.stdin.write(arrays(faces))
        shown = Input(decode.stdout)
        for number, frame in enumerate(positions):
            encode.stdin.write(arrays(frame))
            encode.stdin.flush()
            if number == 0:
                assert read_npy(shown).shape == faces.shape
            # Every frame comes out before the next one goes in.
            assert read_npy(shown).shape == frame.shape
        encode.stdin.close()
        assert read_npy(shown) is None and encode.wait() == 0 and decode.wait() == 0


def arrays(*items):
    file = io.BytesIO()
    for item in items:
        np.save(file, item)
    return file.getvalue()


@pytest.mark.parametrize(
    ("data", "error"),
    [
        (arrays(np.zeros((4, 2), int)), FormatError),
        (arrays(np.zeros((4, 3))), FormatError),
        (arrays(np.zeros((4, 3), int), np.zeros((5, 2))), FormatError),
        (arrays(np.zeros((4, 3), int), np.zeros((5, 3)))[:-1], TruncatedError),
        (arrays(np.full((4, 3), 7), np.zeros((5, 3))), MeshError),
        (arrays(np.zeros((4, 3), int)), MeshError),
        (arrays(np.zeros((4, 3), int))[:20], TruncatedError),
        (arrays(np.zeros((4, 3), int)) + b"something else", FormatError),
        (arrays(np.array([None, {}], object)), MeshError),
    ],
)
def test_damaged_arrays(tmp_path, data, error):
    (tmp_path / "a.npy").write_bytes(data)
    with pytest.raises(error):
        list(sequence_in(str(tmp_path / "a.npy")).frames)


def test_what_is_no_sequence(tmp_path):
    assert sequence_in("-") is None
    positions, faces = bending(1)
    np.savez(tmp_path / "mesh.npz", positions=positions[0], faces=faces)
    assert sequence_in(str(tmp_path / "mesh.npz")) is None
    np.savez(tmp_path / "none.npz", positions=positions[:0], faces=faces)
    with pytest.raises(MeshError):
        sequence_in(str(tmp_path / "none.npz"))
    (tmp_path / "empty").mkdir()
    with pytest.raises(FormatError):
        sequence_in(str(tmp_path / "empty"))


def test_forms_of_the_output():
    given = ("-", None), ("a.npz", None), ("a", None), ("a", "obj")
    assert [sequence_kind(*pair) for pair in given] == ["npy", "npz", "ply", "obj"]
    assert sequence_kind("a.wrl/", None) == sequence_kind("take1.2", None) == "ply"
    for pair in (
        ("a.ply", None),
        ("-", "ply"),
        ("a.npz", "npy"),
        ("a.gltf", None),
        ("%04d.wrl", None),
    ):
        with pytest.raises(OptionError):
            sequence_kind(*pair)


def test_attributes_that_stay_go_along(tmp_path, capsys):
    mesh = torus(14, 10)
    at = mesh.positions[mesh.faces]
    corners = (at[:, :, :2] * 0.2 + 0.5).reshape(-1, 2).astype(np.float32)
    blink = np.zeros((len(mesh.positions), 1), np.float32)
    (tmp_path / "run").mkdir()
    for number in range(4):
        attributes = (
            Attribute("texcoord", corners, "corner", "texcoord"),
            Attribute("normal", mesh.positions, "vertex", "normal"),
        )
        frame = TriangleMesh(mesh.positions * (1 + 0.05 * number), mesh.faces, attributes)
        save(frame, tmp_path / "run" / f"{number}.obj")
        heat = Attribute("heat", blink + number)
        color = Attribute(
            "color", np.full((len(mesh.positions), 3), 7, np.uint8), "vertex", "color"
        )
        (tmp_path / "ply").mkdir(exist_ok=True)
        save(
            TriangleMesh(frame.positions, mesh.faces, (heat, color)),
            tmp_path / "ply" / f"{number}.ply",
        )
    assert bsm("encode", tmp_path / "run", "-o", tmp_path / "run.bsm", "--keep-order", *QUICK) == 0
    assert "normal" in capsys.readouterr().err
    assert bsm("decode", tmp_path / "run.bsm", "-o", tmp_path / "out", "--format", "obj", "-q") == 0
    for number in range(4):
        found = read_mesh(tmp_path / "out" / f"{number:05}.obj").mesh
        assert [attribute.name for attribute in found.attributes] == ["texcoord"]
        again = found.attributes[0]
        assert np.abs(again.values[again.indices].reshape(-1, 2) - corners).max() < 2e-4
    assert bsm("decode", tmp_path / "run.bsm", "-o", tmp_path / "out.npz") == 0
    with np.load(tmp_path / "out.npz") as arrays:
        shown = arrays["corner/texcoord"][arrays["corner/texcoord/indices"]]
        assert np.abs(shown.reshape(-1, 2) - corners).max() < 2e-4
    capsys.readouterr()
    assert (
        bsm(
            "encode",
            tmp_path / "ply",
            "-o",
            tmp_path / "ply.bsm",
            "--attribute",
            "color=5bits",
            *QUICK,
        )
        == 0
    )
    assert "heat" in capsys.readouterr().err
    assert run_json("info", tmp_path / "ply.bsm")["attributes"][0]["name"] == "color"


def test_the_program_says_errors_of_frames(tmp_path, capsys):
    walk, faces = bending(5)
    # A face without area once vertices at one position are one: its third vertex is left out.
    n, walk = walk.shape[1], np.concatenate([walk, walk[:, :1], walk[:, :1] + 3.0], axis=1)
    np.savez(
        tmp_path / "a.npz", positions=np.concatenate([walk, walk]), faces=[*faces, (0, n, n + 1)]
    )
    assert bsm("encode", tmp_path / "a.npz", "--set", "step=0.002") == 0
    assert "10 frames of " in capsys.readouterr().err
    assert bsm("compare", tmp_path / "a.npz", tmp_path / "a.bsm", "--json") == 0
    found = json.loads(capsys.readouterr().out)
    each = [frame["max_error_relative"] for frame in found["frames"]]
    assert (
        len(each) == 10
        and max(each) == pytest.approx(found["max_error_relative"])
        and max(each) < 0.01
    )
    assert bsm("compare", tmp_path / "a.npz", tmp_path / "a.bsm") == 0
    printed = capsys.readouterr().out
    assert f"worst_frame        {each.index(max(each))} " in printed
