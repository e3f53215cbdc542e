"""What is said of losses: images, attributes, fields of sequences; each figure is what `bsm compare` finds."""

import io
import json
import re
import shlex
from pathlib import Path

import numpy as np
import pytest

import bsm
from bsm.account.images import compare_image, compare_images, file_of
from bsm.cli import COMMANDS, command_parser, main
from bsm.ground.console import for_command
from bsm.viewer.contents import compared
from tests.motion import sequence_in
from tests.shapes import torus

MESH = torus(24, 16)
COUNT = len(MESH.positions)


def image(side, kind="png", seed=1):
    from PIL import Image

    rows = np.random.default_rng(seed).normal(size=(side, side, 3)).cumsum(0).cumsum(1)
    table = (255 * (rows - rows.min()) / np.ptp(rows)).astype(np.uint8)
    file = io.BytesIO()
    Image.fromarray(table).save(file, kind)
    return file.getvalue(), table


def facts(capsys, *words):
    capsys.readouterr()
    assert main([*map(str, words), "--json"]) == 0
    return json.loads(capsys.readouterr().out)


@pytest.fixture
def textured(tmp_path):
    places = np.random.default_rng(1).random((COUNT, 2), np.float32)
    given = bsm.Attribute("texcoord", places, "vertex", "texcoord")
    entries = {"material.0.name": "skin", "material.0.map_Kd": 0}
    entries |= {"image.0.name": "skin.png", "image.0.data": image(256)[0]}
    bsm.save(bsm.TriangleMesh(MESH.positions, MESH.faces, (given,), entries), tmp_path / "a.obj")
    return tmp_path


def test_the_ratio_of_images_is_that_of_their_pixels():
    from PIL import Image

    data, table = image(64)
    noisy = np.clip(
        table.astype(int) + np.random.default_rng(2).integers(-3, 4, table.shape), 0, 255
    ).astype(np.uint8)
    file = io.BytesIO()
    Image.fromarray(noisy).save(file, "png")
    found = compare_image("a", data, file.getvalue())
    wrong = np.square(noisy.astype(float) - table).mean()
    assert found.psnr_db == pytest.approx(10 * np.log10(255**2 / wrong)) and "PSNR" in str(found)
    assert compare_image("a", data, data).psnr_db is None and "unchanged" in str(
        compare_image("a", data, data)
    )
    again = io.BytesIO()
    Image.fromarray(table).save(again, "webp", lossless=True)
    assert "exact" in str(compare_image("a", data, again.getvalue()))
    assert compare_image("a", data, b"").after is None and "missing" in str(
        compare_image("a", data, b"")
    )
    # Which Pillow cannot read.
    assert compare_image("a", data, b"\x89PNG" + bytes(40)).psnr_db is None
    assert (file_of(data).width, file_of(data).height, file_of(data).kind) == (64, 64, "png")


def test_images_are_found_by_number_or_by_name():
    data, other = image(16)[0], image(16, "jpeg")[0]
    given = {
        "image.0.name": "a.png",
        "image.0.data": data,
        "image.1.name": "b.png",
        "image.1.data": data,
    }
    found = compare_images(
        given,
        {
            "image.1.name": "b.png",
            "image.1.data": data,
            "image.7.name": "a.jpg",
            "image.7.data": other,
        },
    )
    assert [(one.name, one.after.kind) for one in found] == [("a.png", "jpg"), ("b.png", "png")]
    assert [one.after for one in compare_images(given, {})] == [None, None]


@pytest.mark.parametrize("command", ["encode", "glb"])
def test_what_images_lose_is_said_and_is_what_compare_finds(command, textured, capsys):
    output = textured / ("b.bsm" if command == "encode" else "b.glb")
    assert (
        main([command, str(textured / "a.obj"), "-o", str(output), "--images", "webp:60@64"]) == 0
    )
    said = next(line for line in capsys.readouterr().err.splitlines() if "PSNR" in line)
    assert "256 x 256 pixels, png" in said and "64 x 64 pixels, webp" in said
    (found,) = facts(capsys, "compare", textured / "a.obj", output)["images"]
    assert f"PSNR {found['psnr_db']:.1f} dB" in said and 10 < found["psnr_db"] < 50
    assert (
        f"{found['before']['bytes']} bytes" in said and f"{found['after']['bytes']} bytes" in said
    )
    capsys.readouterr()
    assert main(["compare", str(textured / "a.obj"), str(output)]) == 0
    assert said.partition(": ")[2] in capsys.readouterr().out


def test_tiles_say_what_their_textures_lose(textured, capsys):
    assert (
        main(["tile", str(textured / "a.obj"), "-o", str(textured / "t"), "--images", "webp:20@32"])
        == 0
    )
    coarse = float(
        re.search(r"written as webp, PSNR ([\d.]+) dB in the worst tile", capsys.readouterr().err)[
            1
        ]
    )
    assert (
        main(
            [
                "tile",
                str(textured / "a.obj"),
                "-o",
                str(textured / "t"),
                "-f",
                "--images",
                "webp:95",
            ]
        )
        == 0
    )
    assert 10 < coarse < float(re.search(r"PSNR ([\d.]+) dB", capsys.readouterr().err)[1])


def test_attributes_of_a_mesh_have_the_errors_that_compare_finds(textured, capsys):
    told = facts(capsys, "encode", textured / "a.obj", "-o", textured / "b.bsm")
    found = facts(capsys, "compare", textured / "a.obj", textured / "b.bsm")
    assert (
        told["attribute_errors"] == found["attributes"]
        and 0 < told["attribute_errors"]["texcoord"]["max_error_texels"] <= 0.25
    )
    assert any(
        re.search(r"texcoord: .*; largest error [\d.e-]+, [\d.]+ texels", note)
        for note in told["notes"]
    )


@pytest.fixture
def moving(tmp_path):
    """Frames with a number that moves, a vector that moves, a color that stays, and normals, in meters."""
    colors = np.random.default_rng(3).integers(0, 256, (COUNT, 3), np.uint8)
    for frame in range(4):
        bent = MESH.positions * (1.0 + 0.05 * frame * MESH.positions[:, :1])
        fields = (
            bsm.Attribute(
                "p", (100 * np.sin(3 * MESH.positions[:, :1] + frame)).astype(np.float32)
            ),
            bsm.Attribute("U", (MESH.positions * np.cos(0.2 * frame)).astype(np.float32)),
            bsm.Attribute("color", colors, "vertex", "color"),
            bsm.Attribute(
                "Normals", np.tile(np.float32([0, 0, 1]), (COUNT, 1)), "vertex", "normal"
            ),
        )
        (tmp_path / "in").mkdir(exist_ok=True)
        bsm.save(
            bsm.TriangleMesh(bent, MESH.faces, fields, {"unit": "m"}),
            tmp_path / "in" / f"w{frame}.vtp",
        )
    return tmp_path


def test_fields_of_a_sequence_have_the_errors_that_compare_finds(moving, capsys):
    output, wishes = (
        moving / "b.bsm",
        ("--max-error", "5mm", "--attribute", "p=0.1%", "--attribute", "U=0.01"),
    )
    told = facts(capsys, "encode", moving / "in", "-o", output, *wishes)
    found = facts(capsys, "compare", moving / "in", output)
    for name, most in (("p", 0.2), ("U", 0.01)):
        assert told["attribute_errors"][name]["max_error"] == pytest.approx(
            found["attributes"][name]["max_error"], rel=1e-6
        )
        assert (
            0 < found["attributes"][name]["max_error"] <= most
            and 0 <= found["attributes"][name]["worst_frame"] < 4
        )
        assert any(
            note.startswith(f"{name}: ") and "; largest error" in note for note in told["notes"]
        )
    assert (
        found["attributes"]["color"]["max_error"] <= 255 and found["attributes"]["Normals"] is None
    )
    assert told["unit"] == "mm" and told["max_error"] == pytest.approx(
        1000 * found["max_error"], rel=1e-6
    )
    assert told["max_error_relative"] == pytest.approx(found["max_error_relative"], rel=1e-6)
    assert 0 < found["max_error"] <= 0.005
    assert (
        "left out: Normals; a sequence has no normals, which follow from positions" in told["notes"]
    )
    page = compared("w", output.read_bytes(), sequence_in(str(moving / "in"))).facts["attributes"]
    assert {name: page[name] for name in ("p", "U", "color")} == {
        name: found["attributes"][name] for name in ("p", "U", "color")
    }
    capsys.readouterr()
    assert main(["encode", str(moving / "in"), "-o", str(output), "-f", *wishes]) == 0
    assert re.search(
        r"largest vertex error [\d.]+ mm \([\d.]+ % of the diagonal\), 5mm asked for",
        capsys.readouterr().err,
    )
    # The error is that of the decoded frames.
    off = [
        np.linalg.norm(
            bsm.load(moving / "in" / f"w{number}.vtp").positions.min(axis=0)
            - frame.positions.min(axis=0)
        )
        for number, frame in enumerate(bsm.decode_frames(output))
    ]
    assert max(off) <= 0.005


def test_inputs_count_every_file_once(moving, capsys):
    sizes = [path.stat().st_size for path in (moving / "in").iterdir()]
    rows = "".join(f'<DataSet timestep="{n}" file="in/w{n}.vtp"/>' for n in range(4))
    (moving / "a.pvd").write_text(
        f'<VTKFile type="Collection"><Collection>{rows}</Collection></VTKFile>'
    )
    told = facts(capsys, "encode", moving / "a.pvd")
    assert told["input_bytes"] == sum(sizes) + (moving / "a.pvd").stat().st_size
    assert facts(capsys, "encode", moving / "in", "-o", moving / "c.bsm")["input_bytes"] == sum(
        sizes
    )


def test_rows_of_a_batch_do_not_count_a_shared_file_each(textured, capsys):
    for name in ("b", "c"):
        (textured / f"{name}.obj").write_bytes((textured / "a.obj").read_bytes())
    words = ("encode", "-r", textured, "-o", textured / "out", "--report", textured / "r.json")
    assert main([*map(str, words)]) == 0
    lines = capsys.readouterr().err.splitlines()
    rows = [line.split()[1:3] for line in lines if re.match(r"\S+\.obj +\d+ +\d+", line)]
    assert len(rows) == 3 and max(int(row[1]) for row in rows) < len(image(256)[0])
    assert any("of several rows, which count once" in line for line in lines)


def test_pictures_have_titles_and_a_bar(textured, capsys):
    assert main(["encode", str(textured / "a.obj"), "-q"]) == 0
    words = ["compare", str(textured / "a.obj"), str(textured / "a.bsm")]
    assert (
        main([*words, "--picture", str(textured / "p.png"), "--map", str(textured / "m.png")]) == 0
    )
    assert re.search(
        r"m.png: red is [\d.e-]+ and more; the largest error is", capsys.readouterr().err
    )
    from PIL import Image

    from bsm.account.drawing import surface_colors

    for name, size in (("p.png", (1152, 432)), ("m.png", (768, 432))):
        with Image.open(textured / name) as picture:
            assert picture.size == size
    mesh = bsm.load(textured / "a.obj")
    colors, table = surface_colors(mesh), image(256)[1] / 255.0
    given = mesh.attributes[0]
    rows = given.values[given.indices if given.indices is not None else mesh.faces].mean(axis=1)
    across, up = (rows * 256).astype(int).T
    assert np.array_equal(colors, table[255 - up, across])
    other = torus(20, 12)
    bsm.save(other, textured / "other.ply")
    # Other faces.
    assert (
        main([*words[:2], str(textured / "other.ply"), "--picture", str(textured / "q.png")]) == 0
    )


MISTAKES = [
    "encode FOLDER/empty",
    "view FOLDER/empty --save p.html",
    "view FOLDER/mixed --save p.html",
    "compare FOLDER/mixed FOLDER/a.bsm",
    "decode FOLDER/cut.bsm -o FOLDER/x.ply",
    "verify FOLDER/cut.bsm",
    "glb FOLDER/mixed -o FOLDER/x.glb",
    "encode FOLDER/x.urdf",
    "demo --max-error 1mm -o FOLDER",
    "encode FOLDER/a.ply --max-error 1mm",
    "encode FOLDER/nothing.ply -o FOLDER/a.bsm",
    "encode FOLDER/a.ply -o FOLDER/a.bsm --max-error -1",
    "encode FOLDER/a.ply -o FOLDER/a.bsm --meta unit=milimeter",
    "encode FOLDER/a.ply --qualty fine",
    "encode FOLDER/a.ply -j two",
    "tile FOLDER/empty -o FOLDER/t",
    "denoise FOLDER/empty -o FOLDER/t",
]


@pytest.mark.parametrize("line", MISTAKES)
def test_messages_name_options_of_their_command_only(line, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    bsm.save(MESH, tmp_path / "a.ply")
    (tmp_path / "a.bsm").write_bytes(bsm.encode(MESH))
    (tmp_path / "cut.bsm").write_bytes(bsm.encode(MESH)[:-9])
    (tmp_path / "x.urdf").write_text("<robot/>")
    (tmp_path / "empty").mkdir()
    (tmp_path / "mixed").mkdir()
    for number, mesh in enumerate((MESH, torus(8, 7), torus(9, 8))):
        bsm.save(mesh, tmp_path / "mixed" / f"{number}.ply")
    words = line.replace("FOLDER", str(tmp_path)).split()
    try:
        code = main(words)
    except SystemExit as error:
        code = error.code
    said = capsys.readouterr().err
    assert code and "Traceback" not in said and "exists already" not in said
    known = set(command_parser(words[0])._option_string_actions)
    for clause in re.split(r"; |\. |\? |\n", said.replace(str(tmp_path), "")):
        if not re.search(r"\bbsm [a-z]|unknown option", clause):
            assert {*re.findall(r"(?<![\w/.-])--?[a-z][\w-]*", clause)} <= known, clause


def test_advice_is_that_of_the_command():
    text = "no mesh files in d; -r looks in the folders below, too; run: bsm encode -r d"
    assert for_command(text, frozenset({"-r"})) == text == for_command(text, None)
    assert for_command(text, frozenset({"--save"})) == "no mesh files in d; run: bsm encode -r d"


@pytest.mark.parametrize("command", COMMANDS)
def test_examples_of_the_help_are_commands(command):
    text = command_parser(command).format_help()
    lines = re.findall(rf"^  bsm ({command} .*?)(?:   .*)?$", text, re.MULTILINE)
    for line in lines:
        command_parser(command).parse_command(shlex.split(line)[1:])
    if command == "encode":
        assert len(lines) == 2 and text.index("--preset") < text.index("--dask")
        assert text.index("bsm encode") < text.index("positional arguments")
        assert all(
            text.count(f"  {option}") == 1
            for option in ("--images RULE", "--simplify ", "--dask ADDRESS")
        )


def test_points_of_another_codec_are_drawn_and_compared(tmp_path, capsys):
    for name in ("DracoPy", "matplotlib", "tabulate", "scipy"):
        pytest.importorskip(name)
    bsm.save(torus(30, 20), tmp_path / "t.ply")
    (tmp_path / "mine.csv").write_text(
        "label,bpv,theta_deg,nmsve_db\nMy codec,3,20,-30\nMy codec,9,4,-40\nMy codec,20,.2,\n"
    )
    words = [
        "curve",
        str(tmp_path / "t.ply"),
        "-o",
        str(tmp_path / "c"),
        "--codecs",
        "draco",
        "--points",
    ]
    assert main([*words, str(tmp_path / "mine.csv")]) == 0
    assert "my-codec" in capsys.readouterr().out
    drawn = (tmp_path / "c" / "t.theta.svg").read_text()
    assert main(["curve", "-o", str(tmp_path / "c")]) == 0  # earlier results, and those of others
    assert (tmp_path / "c" / "t.theta.svg").exists() and len(drawn) > 1000
    result = json.loads((tmp_path / "c" / "t.my-codec.json").read_text())
    assert (result["label"], len(result["points"]), result["points"][2]["nmsve_db"]) == (
        "My codec",
        3,
        None,
    )
    for text, words_of_error in (
        ("label,bpv\nx,1\n", "must name label, bpv"),
        ("label,bpv,theta_deg\nx,0,1\n", "line 2: bits per vertex must be above 0"),
        ("label,bpv,theta_deg\nx,a,1\n", "line 2: a number is missing or wrong"),
        ("label,bpv,theta_deg\nx,1,nan\n", "errors finite"),
        ("label,bpv,theta_deg,mesh\nx,1,1,u\n", "mesh must be one of t"),
        ("label,bpv,theta_deg\nDraco,1,1\n", "give another label"),
    ):
        (tmp_path / "bad.csv").write_text(text)
        assert (
            main(["curve", "-o", str(tmp_path / "c"), "--points", str(tmp_path / "bad.csv")]) == 3
        )
        assert words_of_error in capsys.readouterr().err
    (tmp_path / "c" / "t.x.json").write_text('{"schema": 1, "codec": "x"}')
    assert main(["curve", "-o", str(tmp_path / "c")]) == 3
    assert "not points of a curve" in capsys.readouterr().err
    assert not list(Path(tmp_path / "c").glob("*.part"))
