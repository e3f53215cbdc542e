"""Whole assets through `bsm encode`, `decode`, `info` and `compare`: what they had comes back."""

import base64

import numpy as np
import pytest

import bsm
from bsm import Attribute, TriangleMesh, read_mesh
from bsm.cli import main
from tests.bsm.files.test_file_attributes import attribute, dressed, png
from tests.bsm.program import run_json
from tests.bsm.test_libraries import painted
from tests.shapes import tetrahedron, torus

GRID = ("--grid", "12")
"""Of tests that are about what goes along with the shape."""


def notes(capsys, *words):
    assert main([*map(str, words)]) == 0
    return capsys.readouterr().err


def test_everything_comes_back(tmp_path):
    bsm.save(painted(), tmp_path / "a.obj")
    (tmp_path / "a.npz").write_bytes(b"")
    bsm.save(painted(), tmp_path / "a.npz")
    for source in ("a.obj", "a.npz"):
        words = ("encode", tmp_path / source, "-o", tmp_path / "a.bsm", "-fq", *GRID)
        assert main([*map(str, words), "--meta", "author=me=you", "--meta", "name="]) == 0
        for target in ("b.obj", "b.ply", "b.npz"):
            assert (
                main(["decode", str(tmp_path / "a.bsm"), "-o", str(tmp_path / target), "-fq"]) == 0
            )
            errors = run_json("compare", tmp_path / source, tmp_path / target)["attributes"]
            assert errors["texcoord"]["max_error"] < 2e-4
            if source == "a.npz":
                assert (errors["label"] is None) == (target == "b.obj")
                assert errors.get("label") is None or errors["label"]["max_error"] == 0
            metadata = read_mesh(tmp_path / target).mesh.metadata
            assert (metadata["author"], metadata["name"], metadata["unit"]) == ("me=you", "", "mm")
            assert metadata["image.0.data"] == png()


def test_python_compares_as_the_command_does(tmp_path):
    bsm.save(painted(), tmp_path / "a.npz")
    bsm.save(painted(), tmp_path / "a.bsm", attributes={"label": "none"}, grid=12)
    bsm.save(bsm.decode(tmp_path / "a.bsm"), tmp_path / "b.ply")
    for other in ("a.bsm", "b.ply"):
        found = bsm.compare(tmp_path / "a.npz", tmp_path / other)
        result = run_json("compare", tmp_path / "a.npz", tmp_path / other)
        assert found.max_error_relative == result["max_error_relative"] > 0
        assert found.attributes["label"] is result["attributes"]["label"] is None
        assert (
            0
            < found.attributes["texcoord"].max_error
            == result["attributes"]["texcoord"]["max_error"]
            < 2e-4
        )
    assert bsm.compare(tmp_path / "a.npz", painted()).attributes["label"].max_error == 0


def test_info_shows_metadata(tmp_path, capsys):
    bsm.save(painted(), tmp_path / "a.bsm", metadata={"year": 1994}, grid=12)
    info = run_json("info", tmp_path / "a.bsm")
    entries = info["metadata"]
    assert info["bytes"]["metadata"] > len(png()) and info["bytes"]["framing"] < 250
    assert (entries["name"], entries["year"], base64.b64decode(entries["image.0.data"])) == (
        "ring",
        1994,
        png(),
    )
    assert main(["info", str(tmp_path / "a.bsm")]) == 0
    text = capsys.readouterr().out
    assert "  name: ring\n" in text and f"  image.0.data: {len(png())} bytes\n" in text


def test_the_shape_alone_brings_no_images():
    kept = bsm.decode(
        bsm.encode(painted(), attributes={"*": "none"}, metadata={"author": "me"}, grid=12)
    )
    assert not kept.attributes
    assert set(kept.metadata) == {"author", "name", "unit"}
    some = bsm.decode(
        bsm.encode(painted(), attributes={"*": "none", "texcoord": "12bits"}, grid=12)
    )
    assert [attribute.name for attribute in some.attributes] == ["texcoord"]
    assert some.metadata["image.0.data"] == png()


@pytest.mark.parametrize("count", [2, 20])
def test_names_of_values_leave_with_their_attribute(count, tmp_path):
    path, mesh = tmp_path / "a.obj", tetrahedron()
    corners = "".join(f"v {x} {y} {z}\n" for x, y, z in mesh.positions)
    faces = "".join(f"g g{k}\nusemtl m{k}\nf 1 2 3\nf 1 3 4\n" for k in range(count))
    path.write_text(corners + faces)
    assert {name.split(".")[0] for name in bsm.load(path).metadata} == {"group", "material"}
    assert not bsm.decode(bsm.encode(path, attributes={"*": "none"}, grid=12)).metadata
    some = bsm.decode(bsm.encode(path, attributes={"group": "none"}, grid=12))
    assert {name.split(".")[0] for name in some.metadata} == {"material"}


def test_metadata_of_a_sequence(tmp_path):
    mesh = torus(12, 9)
    np.savez(tmp_path / "s.npz", positions=np.array([mesh.positions] * 3), faces=mesh.faces)
    words = (
        "encode",
        tmp_path / "s.npz",
        "-o",
        tmp_path / "s.bsm",
        "-q",
        "--meta",
        "name=Ring",
        "--set",
        "step=0.01",
    )
    assert main([*map(str, words)]) == 0
    assert run_json("info", tmp_path / "s.bsm")["metadata"] == {"name": "Ring"}
    with bsm.SequenceDecoder() as decoder:
        decoder.receive_data(
            bsm.encode_sequence([mesh.positions] * 2, mesh.faces, metadata={"a": 1}, step=0.01)
        )
        while not isinstance(decoder.next_event(), bsm.Signal):
            pass
        assert dict(decoder.metadata) == {"a": 1}


def test_what_a_format_cannot_hold_is_reported(tmp_path, capsys):
    bsm.save(dressed(), tmp_path / "a.bsm", grid=12)
    printed = notes(capsys, "decode", tmp_path / "a.bsm", "-o", tmp_path / "a.off")
    assert "off cannot hold" in printed and all(
        name in printed for name in ("height", "label", "material")
    )
    assert run_json("decode", tmp_path / "a.bsm", "-o", tmp_path / "a.npz")["left_out"] == []


def test_a_part_of_a_stream_has_metadata_and_says_which_values_it_has_not(tmp_path, capsys):
    bsm.save(painted(torus(40, 24)), tmp_path / "a.bsm", preset="small")
    printed = notes(capsys, "decode", tmp_path / "a.bsm", "-o", tmp_path / "a.npz", "--blocks", "1")
    assert "left out: 3 of 3 attributes" in printed
    assert read_mesh(tmp_path / "a.npz").mesh.metadata["name"] == "ring"
    assert (
        main(["decode", str(tmp_path / "a.bsm"), "-o", str(tmp_path / "b.npz"), "--tolerant", "-q"])
        == 0
    )
    assert {a.name for a in read_mesh(tmp_path / "b.npz").mesh.attributes} == {
        "texcoord",
        "height",
        "label",
    }


def test_an_undamaged_stream_has_computed_normals_where_damage_is_tolerated(tmp_path, capsys):
    mesh = torus(20, 12)
    normals = bsm.Attribute("normal", mesh.positions, semantic="normal")
    made = bsm.TriangleMesh(mesh.positions, mesh.faces, [normals])
    bsm.save(made, tmp_path / "a.bsm", grid=12, attributes={"normal": "recompute"})
    assert "left out" not in notes(
        capsys, "decode", tmp_path / "a.bsm", "-o", tmp_path / "a.npz", "--tolerant"
    )
    (found,), (expected,) = (bsm.load(tmp_path / name).attributes for name in ("a.npz", "a.bsm"))
    assert np.array_equal(found.values, expected.values)


def test_what_lies_beside_is_not_overwritten_unasked(tmp_path):
    bsm.save(painted(), tmp_path / "a.bsm", grid=12)
    (tmp_path / "a.0.png").write_bytes(b"mine")
    assert main(["decode", str(tmp_path / "a.bsm"), "-o", str(tmp_path / "a.obj")]) != 0
    assert (tmp_path / "a.0.png").read_bytes() == b"mine" and not (tmp_path / "a.obj").exists()
    assert main(["decode", str(tmp_path / "a.bsm"), "-o", str(tmp_path / "a.obj"), "-fq"]) == 0
    assert (tmp_path / "a.0.png").read_bytes() == png()


def test_beside_a_pipe_nothing_lies(tmp_path, capfdbinary):
    bsm.save(painted(), tmp_path / "a.bsm", grid=12)
    assert main(["decode", str(tmp_path / "a.bsm"), "-o", "-", "--format", "obj"]) == 0
    printed = capfdbinary.readouterr()
    assert printed.out.count(b"\nf ") == len(painted().faces) and b"obj cannot hold" in printed.err
    assert [path.name for path in tmp_path.iterdir()] == ["a.bsm"]


def test_a_stream_does_not_stand_beside_the_permutation_of_another(tmp_path):
    bsm.save(torus(8, 6), tmp_path / "a.ply")
    np.savez(tmp_path / "walk.npz", positions=[torus(8, 6).positions] * 2, faces=torus(8, 6).faces)
    for name in ("a.ply", "walk.npz"):
        words = ["encode", str(tmp_path / name), "--permutation", str(tmp_path / "none" / "p.npy")]
        assert main([*words, "-o", str(tmp_path / "a.bsm")]) == 9
        assert not (tmp_path / "a.bsm").exists()


def test_a_permutation_takes_attributes_along(tmp_path):
    mesh = torus(12, 9)
    numbered = TriangleMesh(
        mesh.positions, mesh.faces, [Attribute("number", np.arange(len(mesh.positions)))]
    )
    bsm.save(numbered, tmp_path / "a.ply")
    assert (
        main(
            [
                "encode",
                str(tmp_path / "a.ply"),
                "--permutation",
                str(tmp_path / "p.npy"),
                "-q",
                *GRID,
            ]
        )
        == 0
    )
    words = ["--permutation", str(tmp_path / "p.npy"), "-o", str(tmp_path / "b.ply"), "-q"]
    assert main(["decode", str(tmp_path / "a.bsm"), *words]) == 0
    again = read_mesh(tmp_path / "b.ply").mesh
    assert attribute(again, "number").values[:, 0].tolist() == list(range(len(mesh.positions)))


def test_compare_tells_what_is_not_there_any_more(tmp_path, capsys):
    mesh = dressed()
    bsm.save(mesh, tmp_path / "a.npz")
    bsm.save(mesh, tmp_path / "b.off")
    errors = run_json("compare", tmp_path / "a.npz", tmp_path / "b.off")["attributes"]
    assert (
        errors["height"] is None
        and errors["color"]["max_error"] == 0
        and errors["normal"]["max_angle_deg"] == 0
    )
    assert main(["compare", str(tmp_path / "a.npz"), str(tmp_path / "b.off")]) == 0
    printed = capsys.readouterr().out
    assert (
        "height: missing\n" in printed and f"only in {tmp_path / 'a.npz'}: height, label" in printed
    )


@pytest.mark.slow
@pytest.mark.real
@pytest.mark.parametrize(
    ("name", "bounds"),
    [
        ("spot_uv.obj", {"texcoord": 1.5e-3}),
        ("fuze_colours.ply", {"color": 0, "face_color": 0, "texcoord": 1.5e-3}),
        ("cortex_sulc.ply", {"sulc": 5e-5}),
        ("Duck.glb", {"normal": 4.0, "texcoord": 1.5e-3}),
    ],
)
def test_real_assets(meshes, name, bounds, tmp_path):
    """With the default preset: positions within 1 % of the diagonal, attributes within what the encoder says."""
    if name.endswith(".glb"):
        pytest.importorskip("trimesh")
    source = meshes / "assets" / name
    assert main(["encode", str(source), "-o", str(tmp_path / "a.bsm"), "-q"]) == 0
    before = read_mesh(source).mesh
    for target in ("a.bsm", "b.ply", "b.npz"):
        if target != "a.bsm":
            assert (
                main(["decode", str(tmp_path / "a.bsm"), "-o", str(tmp_path / target), "-q"]) == 0
            )
        found = run_json("compare", source, tmp_path / target)
        assert found["max_error_relative"] <= 0.01
        assert set(found["attributes"]) == set(bounds)
        for attribute_name, bound in bounds.items():
            errors = found["attributes"][attribute_name]
            assert errors.get("max_angle_deg", errors["max_error"]) <= bound
        again = bsm.load(tmp_path / target)
        assert {k: v for k, v in again.metadata.items() if k in before.metadata} == before.metadata
