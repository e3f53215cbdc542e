"""Messages on damaged streams say which part of the mesh is damaged, and which parts are left out."""

import io
from pathlib import Path

import numpy as np
import pytest

import bsm
from bsm import Attribute, TriangleMesh
from bsm.bitstream.container.wire import FrameType, sections_of
from bsm.cli import main
from tests.shapes import torus

WORDS = {
    FrameType.HEADER: "the header is damaged",
    FrameType.CONNECTIVITY: "the faces are damaged",
    FrameType.GRID: "positions are damaged",
    FrameType.ATTRIBUTE: "the description of an attribute is damaged",
    FrameType.VALUES: "values of an attribute are damaged",
    FrameType.METADATA: "metadata (names, materials, images) are damaged",
    FrameType.END: "the end of the stream is damaged",
}


@pytest.fixture(scope="module")
def stream() -> bytes:
    """A stream with a texture, its image and its coordinates."""
    pillow = pytest.importorskip("PIL.Image")
    mesh = torus(24, 24)
    coordinates = mesh.positions[:, :2] / 4 + 0.5
    picture = io.BytesIO()
    noise = np.random.default_rng(1).integers(0, 255, (32, 32, 3), np.uint8)
    pillow.fromarray(noise).save(picture, "PNG")
    metadata = {"material.0.name": "skin", "material.0.map_Kd": 0, "image.0.name": "skin.png"}
    metadata["image.0.data"] = picture.getvalue()
    attributes = (Attribute("uv", coordinates.astype(np.float32), "vertex", "texcoord"),)
    return bytes(
        bsm.encode(TriangleMesh(mesh.positions, mesh.faces, attributes, metadata), preset="grid14")
    )


def places(stream: bytes) -> dict[FrameType, tuple[int, int]]:
    """Return a byte within the last section of each type, and the number of bytes that its checksum is for."""
    found = {}
    offset = 5
    for section in sections_of(stream):
        begin = stream.index(bytes(section.payload), offset)
        found[FrameType(section.type)] = begin + len(section.payload) // 2, len(section.payload)
        offset = begin + len(section.payload)
    return found


def with_damage(stream: bytes, place: int) -> bytes:
    damaged = bytearray(stream)
    damaged[place] ^= 0xFF
    return bytes(damaged)


def test_sections_are_walked_to_the_end_of_a_sound_stream(stream):
    sections = list(sections_of(stream))
    assert [section.type for section in sections][-1] == FrameType.END
    assert all(section.is_sound for section in sections)
    assert [section.is_sound for section in sections_of(stream[:-1])][-1] is False


def test_a_damaged_section_is_named_by_its_contents(stream, tmp_path, capsys):
    file = tmp_path / "a.bsm"
    where = places(stream)
    assert where.keys() == WORDS.keys()
    for kind, (place, size) in where.items():
        file.write_bytes(with_damage(stream, place))
        for command in (["verify"], ["info"], ["decode", "-o", str(tmp_path / "a.ply")]):
            assert main([command[0], str(file), *command[1:]]) == 4
            error = capsys.readouterr().err
            assert f"{WORDS[kind]}: the checksum of {size} bytes is wrong [byte " in error
            assert "frame" not in error
            assert ("; --tolerant decodes" in error) == (command[0] == "decode")


def test_tolerant_decoding_names_lost_attributes_materials_and_images(stream, tmp_path, capsys):
    file, output = tmp_path / "a.bsm", tmp_path / "a.obj"
    where = places(stream)

    def notes_on(data: bytes) -> str:
        file.write_bytes(data)
        assert main(["decode", str(file), "-o", str(output), "-f", "--tolerant"]) == 0
        return capsys.readouterr().err

    # All that follows a damaged attribute is lost with it: the image comes last.
    notes = notes_on(with_damage(stream, where[FrameType.VALUES][0]))
    assert "left out: the attribute uv\n" in notes and "left out: the image skin.png\n" in notes
    notes = notes_on(with_damage(stream, where[FrameType.ATTRIBUTE][0]))
    assert "left out: 1 of 1 attributes, whose values are missing\n" in notes
    assert "left out: the image skin.png\n" in notes
    for damaged in (
        with_damage(stream, where[FrameType.METADATA][0]),
        stream[: where[FrameType.METADATA][0]],
    ):
        notes = notes_on(damaged)
        assert "left out: the image skin.png\n" in notes and "attribute" not in notes
        assert "left out: other entries of the damaged metadata\n" in notes
        # The materials stay, and name no image that is not there.
        library = (tmp_path / "a.mtl").read_text() if (tmp_path / "a.mtl").exists() else ""
        assert "map_Kd" not in library and not list(tmp_path.glob("*.png"))
        file.write_bytes(damaged)
        assert main(["decode", str(file), "-o", str(tmp_path / "a.glb"), "-f", "--tolerant"]) == 0
        assert "map_Kd" not in capsys.readouterr().err, "the image is lost, whatever GLB holds"
    assert "left out" not in notes_on(stream)
    assert "left out" not in notes_on(with_damage(stream, where[FrameType.END][0]))


def test_no_advice_repeats_what_was_tried(stream, tmp_path, capsys):
    file = tmp_path / "a.bsm"
    file.write_bytes(with_damage(stream, places(stream)[FrameType.CONNECTIVITY][0]))
    assert main(["decode", str(file), "-o", str(tmp_path / "a.ply"), "--tolerant"]) == 4
    error = capsys.readouterr().err
    assert "--tolerant" not in error and error.strip().endswith(
        "; no other part can be decoded without it"
    )


def test_a_cut_stream_says_so_in_plain_words(stream, tmp_path, capsys):
    file = tmp_path / "a.bsm"
    file.write_bytes(stream[:-9])
    assert main(["verify", str(file)]) == 12
    assert "the stream ends too early; get the rest of it" in capsys.readouterr().err


@pytest.mark.parametrize(
    "payload", [b"\x80", b"\xdf\xff\xff\xff\xff", b"\x91" * 3000, b"\x81\xa1a" + b"\x91" * 3000]
)
def test_metadata_of_strangers_take_neither_memory_nor_a_traceback(
    stream, payload, tmp_path, capsys
):
    """A section with a right checksum may hold anything, deep lists and long maps included."""
    from bsm.bitstream.container.wire import write_frame

    where = places(stream)
    cut = with_damage(stream, where[FrameType.VALUES][0])
    end = (
        stream.index(bytes(list(sections_of(stream))[-1].payload), where[FrameType.METADATA][0]) - 1
    )
    file = tmp_path / "a.bsm"
    file.write_bytes(cut[:end] + write_frame(FrameType.METADATA, payload) + cut[end:])
    assert main(["decode", str(file), "-o", str(tmp_path / "a.ply"), "--tolerant"]) == 0
    assert "left out: the attribute uv\n" in capsys.readouterr().err
    assert Path(tmp_path / "a.ply").exists()
