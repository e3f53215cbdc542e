"""Small files that tell readers and `bsm glb` to make much of little, and outputs that would replace inputs."""

import json

import numpy as np
import pytest

import bsm
from bsm import FormatError, Limits, read_mesh
from bsm.cli import main
from tests.bsm.files.test_file_attributes import png
from tests.gltf import Built, unpack
from tests.shapes import torus
from tests.streams import memory_below


def scene(path, accessors, primitives):
    """A scene without any bytes: all its accessors are zeros."""
    table = [{"componentType": 5126, "type": kind, "count": count} for kind, count in accessors]
    tree = {"asset": {"version": "2.0"}, "accessors": table, "meshes": [{"primitives": primitives}]}
    path.write_text(
        json.dumps(tree | {"nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}], "scene": 0})
    )
    return str(path)


def test_combinations_of_accessors_are_counted_each(tmp_path, capsys):
    count = 20
    pairs = [
        {"POSITION": 0, "_X": 1 + a, "_Y": 1 + count + b}
        for a in range(count)
        for b in range(count)
    ]
    accessors = [("VEC3", 9000), *[("SCALAR", 9000)] * (2 * count)]
    path = scene(
        tmp_path / "a.gltf", accessors, [{"attributes": attributes} for attributes in pairs]
    )
    with memory_below(150e6):
        assert main(["glb", path, "-o", str(tmp_path / "a.glb"), "-q"]) == 6
    assert "memory" in capsys.readouterr().err and not (tmp_path / "a.glb").exists()


def test_one_grid_checks_before_it_reads(tmp_path):
    primitives = [{"attributes": {"POSITION": number}} for number in range(20)]
    path = scene(tmp_path / "a.gltf", [("VEC3", 44_000_000)] * 20, primitives)
    with memory_below(100e6):
        assert main(["glb", path, "-o", str(tmp_path / "a.glb"), "--one-grid", "-q"]) == 6


def test_images_of_many_pixels_stay_as_they_are(tmp_path, capsys):
    pytest.importorskip("PIL.Image")
    built = Built()
    shape = torus(12, 8)
    positions = built.array(shape.positions.astype(np.float32))
    faces = built.array(shape.faces.astype(np.uint16).reshape(-1))
    built.nodes({"mesh": built.mesh({"attributes": {"POSITION": positions}, "indices": faces})})
    image = png(9000, 9000, 1, 0, pixels=bytes(9000 * 1126))  # black, of single bits
    built.tree["images"] = [{"bufferView": built.view(image), "mimeType": "image/png"}]
    (tmp_path / "a.glb").write_bytes(built.bytes)
    with memory_below(100e6):
        code = main(
            ["glb", str(tmp_path / "a.glb"), "-o", str(tmp_path / "b.glb"), "--images", "webp"]
        )
    assert code == 0 and "pixels" in capsys.readouterr().err


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "utf-16-le", "utf-16-be"])
def test_a_vtp_has_no_doctype_in_any_encoding(encoding):
    entities = '<!ENTITY a "1 2 3 ">' + "".join(f'<!ENTITY a{n} "{"&a;" * 50}">' for n in range(20))
    text = f"<!DOCTYPE VTKFile [{entities}]><VTKFile type='PolyData'>&a1;</VTKFile>"
    for limits in (Limits(), Limits.service()):
        with pytest.raises(FormatError, match=r"DOCTYPE|broken|no mesh format"):
            read_mesh(text.encode(encoding), "vtp", limits, isolated=False)


def test_no_output_of_glb_replaces_what_it_reads(tmp_path, capsys):
    bsm.save(torus(12, 8), tmp_path / "a.glb")
    data = (tmp_path / "a.glb").read_bytes()
    (tmp_path / "b.fallback.bin").write_bytes(data)
    assert (
        main(
            [
                "glb",
                str(tmp_path / "b.fallback.bin"),
                "-o",
                str(tmp_path / "b.glb"),
                "--fallback",
                "-f",
            ]
        )
        == 2
    )
    assert (tmp_path / "b.fallback.bin").read_bytes() == data and not (tmp_path / "b.glb").exists()
    tree, numbers = unpack(data)
    tree["buffers"] = [{"uri": "c.glb", "byteLength": len(numbers)}]
    (tmp_path / "c.glb").write_bytes(numbers)
    (tmp_path / "c.gltf").write_text(json.dumps(tree))
    assert main(["glb", str(tmp_path / "c.gltf"), "-o", str(tmp_path / "c.glb"), "-f"]) == 2
    assert (tmp_path / "c.glb").read_bytes() == numbers
    assert capsys.readouterr().err.count("would replace the input") == 2


def test_facts_have_the_same_keys_in_every_case(tmp_path, capsys):
    bsm.save(torus(60, 50), tmp_path / "a.ply")
    keys = []
    for words in ([], ["--simplify"], ["--simplify", "--preset", "small"], ["--dry-run"]):
        assert main(["encode", str(tmp_path / "a.ply"), "--json", "-f", *words]) == 0
        facts = json.loads(capsys.readouterr().out)
        keys.append(list(facts))
        assert facts["error_of"] == ("vertices" if facts["faces_before"] is None else "surfaces")
        assert (facts["theta_deg"] is None) == (facts["faces_before"] is not None)
        assert facts["output"] == (None if words == ["--dry-run"] else str(tmp_path / "a.bsm"))
    assert keys.count(keys[0]) == len(keys)
    assert len(bsm.decode(tmp_path / "a.bsm").faces) <= 6000
