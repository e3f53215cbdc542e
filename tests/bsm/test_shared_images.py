"""Folders of strangers' meshes and their images: each file is read by its reader, and the others do not suffer."""

import ast
import json
import zipfile
from collections import Counter
from pathlib import Path
from re import _constants, _parser  # type: ignore[attr-defined]

import numpy as np
import pytest

import bsm
from bsm.cli import main
from bsm.files import mesh as meshes

TRIANGLE = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
PNG = b"\x89PNG\r\n\x1a\n" + bytes(range(256)) * 40
MOST_REPEATS = 64  # at the beginning of a pattern that is sought at every byte


def with_material(image, material="x.mtl"):
    return {
        "x.obj": f"mtllib {material}\nusemtl m\n".encode() + TRIANGLE,
        "x.mtl": b"newmtl m\nmap_Kd " + image + b"\n",
    }


def picture(folder):
    with zipfile.ZipFile(folder / "slicer.3mf", "w") as file:
        file.writestr("Metadata/plate_1.png", PNG)
        file.writestr("3D/3dmodel.model", "<model/>")


def buffer_inside(folder):
    buffers = [{"byteLength": 75000, "uri": f"data:application/octet-stream;base64,{100000 * 'A'}"}]
    (folder / "x.gltf").write_text(json.dumps({"asset": {"version": "2.0"}, "buffers": buffers}))


def loop(folder):
    (folder / "loop.png").symlink_to("loop.png")
    write(folder, with_material(b"loop.png"))


def folder_of_that_name(folder):
    (folder / "skin.png").mkdir()
    write(folder, with_material(b"skin.png"))


def sparse(folder):
    write(folder, with_material(b"a.png"))
    with (folder / "x.mtl").open("r+b") as file:
        file.truncate(3 << 30)


def write(folder, files):
    for name, data in files.items():
        (folder / name).write_bytes(data)


ODD = {
    "a picture in a 3MF": picture,
    "a buffer in a glTF": buffer_inside,
    "a link to itself": loop,
    "a folder called like an image": folder_of_that_name,
    "a sparse library": sparse,
    "zeros": lambda folder: write(folder, {**with_material(b"a.png"), "x.mtl": bytes(1 << 16)}),
    "no spaces": lambda folder: write(
        folder, {**with_material(b"a.png"), "x.mtl": b"a" * (1 << 16)}
    ),
    "a NUL": lambda folder: write(folder, with_material(b"a\0b.png")),
    "a NUL in the library": lambda folder: write(folder, with_material(b"a.png", "a\0.mtl")),
    "no UTF-8": lambda folder: write(folder, with_material(b"\xff\xfe.png")),
    "a long name": lambda folder: write(folder, with_material(b"x" * 70000 + b".png")),
    "another folder": lambda folder: write(folder, with_material(b"../secret.png")),
    "another place": lambda folder: write(
        folder, with_material(bytes((folder.parent / "secret.png").absolute()))
    ),
    "a library of another place": lambda folder: write(
        folder, with_material(b"a.png", "../secret.png")
    ),
    "a library that is a device": lambda folder: write(
        folder, with_material(b"a.png", "/dev/zero")
    ),
    "garbage": lambda folder: write(
        folder, {"x.ply": np.random.default_rng(0).bytes(5000), "x.png": PNG}
    ),
}


@pytest.fixture
def reads(monkeypatch):
    """How often each file was read."""
    times, read_cut = Counter(), meshes.read_cut

    def counted(source, *rest, **more):
        times[source.name if hasattr(source, "name") else str(source)] += 1
        return read_cut(source, *rest, **more)

    monkeypatch.setattr(meshes, "read_cut", counted)
    return times


@pytest.mark.parametrize("untrusted", [False, True])
@pytest.mark.parametrize("odd", ODD)
def test_a_bad_file_is_named_and_the_others_are_encoded(
    odd, untrusted, tmp_path, monkeypatch, capsys, reads
):
    monkeypatch.chdir(tmp_path)
    if untrusted:
        pytest.importorskip("landlockpy")
    Path("secret.png").write_bytes(PNG)
    for folder in ("in", "in/good"):
        Path(folder).mkdir()
    for name in ("a", "b"):
        write(Path("in/good"), {f"{name}.obj": with_material(b"skin.png")["x.obj"]})
    write(Path("in/good"), {"x.mtl": with_material(b"skin.png")["x.mtl"], "skin.png": PNG})
    ODD[odd](Path("in"))
    main(["encode", "-r", "in", "-o", "out", *["--untrusted"][:untrusted]])
    said = capsys.readouterr().err
    assert {path.name for path in Path("out/good").iterdir()} == {"a.bsm", "b.bsm"}
    assert [path.read_bytes() for path in Path("out/images").iterdir()] == [PNG]
    assert (
        "1 image of several meshes" in said and "Traceback" not in said and "unexpected" not in said
    )
    assert set(reads.values()) <= {1, 2}, (
        "a file is read to find what others have too, and to encode it"
    )
    odd_one = next(
        path for path in Path("in").iterdir() if path.suffix in (".obj", ".ply", ".gltf", ".3mf")
    )
    encoded = main(["encode", str(odd_one), "-o", "alone.bsm", *["--untrusted"][:untrusted]]) == 0
    assert encoded == Path("out", odd_one.with_suffix(".bsm").name).exists()
    if encoded:
        assert PNG not in bsm.load("alone.bsm").metadata.values()
    else:
        assert f"in/{odd_one.name}: " in said


def test_folders_without_other_files_are_read_once(tmp_path, reads):
    for name in ("a", "b"):
        write(tmp_path, {f"{name}.obj": with_material(b"")["x.obj"]})
    assert main(["encode", "-r", str(tmp_path), "-o", str(tmp_path / "out"), "-q"]) == 0
    assert set(reads.values()) == {1}


def patterns_of_bytes():
    """The patterns over bytes in the room of files, and whether each is only tried where a text begins."""
    for path in Path(bsm.__file__).parent.joinpath("files").rglob("*.py"):
        tree = ast.parse(path.read_text())
        used: dict[str, set[str]] = {}
        for node in ast.walk(tree):
            if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
                used.setdefault(node.value.id, set()).add(node.attr)
        called = {
            id(call): name.id
            for node in ast.walk(tree)
            if isinstance(node, ast.Assign)
            for target in node.targets
            for names, values in [
                (getattr(target, "elts", [target]), getattr(node.value, "elts", [node.value]))
            ]
            for name, call in zip(names, values)
            if isinstance(name, ast.Name)
        }
        for node in ast.walk(tree):
            if not (isinstance(node, ast.Call) and ast.unparse(node.func).startswith("re.")):
                continue
            way = ast.unparse(node.func).removeprefix("re.")
            ways = used.get(called.get(id(node), ""), {way}) if way == "compile" else {way}
            for given in node.args[:1]:
                if isinstance(given, ast.Constant) and isinstance(given.value, bytes):
                    yield path.name, given.value, ways <= {"match", "fullmatch"}


def begins_with_many(pattern):
    """Whether a try to match may go over many bytes before it fails, from wherever it begins."""
    for branch in [pattern] if pattern[0][0] is not _constants.BRANCH else pattern[0][1][1]:
        operation, given = branch[0]
        may_fail = branch[1:].getwidth()[0] > 0
        if (
            operation in (_constants.MAX_REPEAT, _constants.MIN_REPEAT)
            and given[1] > MOST_REPEATS
            and may_fail
        ):
            return True
        if operation is _constants.SUBPATTERN and begins_with_many(given[-1]):
            return True
    return False


def test_no_pattern_over_bytes_begins_anew_at_each():
    found = list(patterns_of_bytes())
    assert len(found) > 15
    assert [row for row in found if not row[2] and begins_with_many(_parser.parse(row[1]))] == []
    assert begins_with_many(_parser.parse(rb"[^\s]+\.png")) and not begins_with_many(
        _parser.parse(rb"^[ \t]*v")
    )
