"""Calls with nonsensical arguments or sizes: each succeeds, or raises one of our errors with the reason."""

import math
import warnings
from dataclasses import fields
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest

import bsm
from bsm import Attribute, MeshError, TriangleMesh
from bsm.bitstream.limits import NAMED_LIMITS
from bsm.cli import main
from bsm.files.table import MESH_FORMATS
from tools.vectors.meshes import torus


def file_of(piece):
    """A file that gives the same piece for ever."""
    return SimpleNamespace(read=lambda size=-1: piece)


WRONG = [
    None, 5, -1, 1.5, math.nan, math.inf, "text", "a\0b", b"", [], {}, object(), True, print, np.full(3, np.nan),
    np.array([None]), file_of(5), file_of("x"), 1j, (1, 2, 3),
]  # fmt: skip


@cache
def stream():
    return bsm.encode(torus(5, 5), grid=8)


@cache
def arrays():
    mesh = torus(5, 5)
    return np.asarray(mesh.positions), np.asarray(mesh.faces)


CALLS = {
    "encode": lambda wrong: bsm.encode(wrong),
    "encode with options": lambda wrong: (
        bsm.encode(torus(5, 5), wrong) if wrong is not None else None
    ),
    "encode positions": lambda wrong: bsm.encode((wrong, arrays()[1])),
    "encode faces": lambda wrong: bsm.encode((arrays()[0], wrong)),
    "encode metadata": lambda wrong: bsm.encode(torus(5, 5), grid=8, metadata=wrong),
    "decode": lambda wrong: bsm.decode(wrong),
    "decode limits": lambda wrong: bsm.decode(stream(), limits=wrong),
    "decode threads": lambda wrong: bsm.decode(stream(), threads=wrong),
    "decode a sequence": lambda wrong: bsm.decode_sequence(wrong),
    "sequence of positions": lambda wrong: bsm.encode_sequence(wrong, arrays()[1]),
    "sequence with attributes": lambda wrong: bsm.encode_sequence(
        np.zeros((0, 25, 3)), arrays()[1], mesh_attributes=wrong
    ),
    "sequence metadata": lambda wrong: bsm.encode_sequence(
        np.zeros((0, 25, 3)), arrays()[1], metadata=wrong
    ),
    "encode_frames": lambda wrong: bsm.encode_frames(wrong),
    "encode_frames of one": lambda wrong: bsm.encode_frames([torus(5, 5), wrong]),
    "encode_frames metadata": lambda wrong: bsm.encode_frames([], metadata=wrong),
    "decode_frames": lambda wrong: list(bsm.decode_frames(wrong)),
    "decode_frames limits": lambda wrong: list(bsm.decode_frames(stream(), limits=wrong)),
    "load": lambda wrong: bsm.load(wrong),
    "load limits": lambda wrong: bsm.load(stream(), limits=wrong),
    "save": lambda wrong: bsm.save(wrong, "nothing.obj"),
    "save to": lambda wrong: bsm.save(torus(5, 5), wrong),
    "compare": lambda wrong: bsm.compare(torus(5, 5), wrong),
    "compare order": lambda wrong: bsm.compare(torus(5, 5), torus(5, 5), order=wrong),
    "denoise": lambda wrong: bsm.denoise(wrong),
    "denoise strength": lambda wrong: bsm.denoise(torus(5, 5), strength=wrong),
    "denoise goal": lambda wrong: bsm.denoise(torus(5, 5), goal=wrong),
    "progress": lambda wrong: (
        bsm.encode(torus(5, 5), grid=8, progress=wrong) if wrong is not print else None
    ),
    "encode_many progress": lambda wrong: bsm.encode_many(["missing.obj"], progress=wrong),
    "open_tiles": lambda wrong: bsm.open_tiles(wrong),
    "Decoder limits": lambda wrong: bsm.Decoder(wrong),
    "Decoder threads": lambda wrong: bsm.Decoder(threads=wrong),
    "Decoder layers": lambda wrong: bsm.Decoder(layers=wrong),
    "SequenceDecoder limits": lambda wrong: bsm.SequenceDecoder(wrong),
    "SequenceDecoder threads": lambda wrong: bsm.SequenceDecoder(threads=wrong),
    "SequenceDecoder start": lambda wrong: bsm.SequenceDecoder(start=wrong),
    "receive_data": lambda wrong: bsm.Decoder().receive_data(wrong),
    "encode_many": lambda wrong: bsm.encode_many(wrong),
    "encode_many into": lambda wrong: bsm.encode_many(["missing.obj"], wrong),
    "encode_many report": lambda wrong: bsm.encode_many(["missing.obj"], report=wrong),
    "encode_many jobs": lambda wrong: (
        bsm.encode_many(["missing.obj"], jobs=wrong) if wrong != 5 else None
    ),
    "mesh attributes": lambda wrong: bsm.TriangleMesh(*arrays(), wrong),
    "mesh metadata": lambda wrong: bsm.TriangleMesh(*arrays(), (), wrong),
    "attribute name": lambda wrong: bsm.Attribute(wrong, np.ones(3)),
    "attribute values": lambda wrong: bsm.Attribute("a", wrong),
    "attribute domain": lambda wrong: bsm.Attribute("a", np.ones(3), wrong),
    "attribute indices": lambda wrong: bsm.Attribute("a", np.ones(3), "corner", "generic", wrong),
    **{
        f"{kind.__name__} {field.name}": (
            lambda wrong, kind=kind, name=field.name: kind(**{name: wrong})
        )
        for kind in (bsm.Limits, bsm.EncodeOptions)
        for field in fields(kind)
    },
}


@pytest.mark.parametrize("name", CALLS)
def test_wrong_arguments_end_in_our_errors(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    foreign = []
    for wrong in WRONG:
        if name.startswith("encode_many jobs") and isinstance(wrong, np.ndarray):
            continue
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                CALLS[name](wrong)
        except (bsm.BsmError, OSError):
            pass
        except Exception as error:
            foreign.append(f"{wrong!r}: {type(error).__name__}: {error}")
    assert not foreign


@pytest.mark.parametrize("value", [math.nan, -1, -math.inf])
def test_limits_that_bound_nothing_are_refused(value):
    for field in fields(bsm.Limits):
        with pytest.raises(bsm.OptionError, match=field.name):
            bsm.Limits(**{field.name: value})


REFUSED = {
    "jobs": (bsm.OptionError, lambda: bsm.encode_many(["missing.obj"], jobs=-3)),
    "threads": (bsm.OptionError, lambda: bsm.decode(stream(), threads=0)),
    "threads must": (bsm.ArgumentError, lambda: bsm.decode(stream(), threads="2")),
    "start must": (bsm.OptionError, lambda: bsm.SequenceDecoder(start=1 << 70)),
    "expected, not NoneType": (bsm.ArgumentError, lambda: bsm.load(None)),
    r"unknown goal 'typo'.*shading": (
        bsm.OptionError,
        lambda: bsm.denoise(torus(5, 5), goal="typo"),
    ),
}


@pytest.mark.parametrize("message", REFUSED)
def test_what_is_out_of_range_is_named(message):
    error, call = REFUSED[message]
    with pytest.raises(error, match=message):
        call()


@pytest.mark.parametrize("metadata", [{"a\0b": "cut"}, {"a": 1 << 63}, {"a": -(1 << 63) - 1}])
def test_metadata_that_would_not_come_back_are_refused(metadata):
    positions, faces = arrays()
    for call, given in (
        (bsm.encode, (positions, faces)),
        (bsm.encode_frames, [(positions, faces)]),
    ):
        with pytest.raises(bsm.OptionError, match="metadata 'a"):
            call(given, metadata=metadata)
    kept = {"a": "b\0c", "b": (1 << 63) - 1, "c": np.float64(2), "d": np.int64(3)}
    assert bsm.decode(bsm.encode((positions, faces), grid=8, metadata=kept)).metadata == kept
    mesh = bsm.TriangleMesh(positions, faces, metadata=kept)
    assert [type(value) for value in mesh.metadata.values()] == [str, int, float, int]


def test_numbers_too_large_for_any_float():
    for call in (bsm.encode, lambda mesh: bsm.encode_sequence([mesh[0]], mesh[1])):
        with pytest.raises(bsm.MeshError, match="not an array of numbers"):
            call(([[10**400, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]))


@pytest.mark.parametrize("scale", [1e307, 1e300, 1e31, 1e-43, 1e-320])
@pytest.mark.parametrize("options", [{}, {"preset": "near-lossless"}])
def test_a_size_that_no_promise_can_be_kept_for_is_reported(scale, options):
    mesh = torus(6, 6)
    with warnings.catch_warnings(), pytest.raises(MeshError, match="scale it"):
        warnings.simplefilter("error")
        bsm.encode((mesh.positions * scale, mesh.faces), **options)


@pytest.mark.parametrize("scale", [1e29, 1e-41])
def test_large_and_small_meshes_come_back(scale):
    mesh = torus(6, 6)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        decoded = bsm.decode(
            bsm.encode((mesh.positions * scale, mesh.faces), preset="near-lossless")
        )
    assert np.abs(decoded.positions).max() == pytest.approx(
        scale * np.abs(mesh.positions).max(), rel=0.01
    )


def test_too_many_attributes_are_refused_before_any_is_coded():
    shape = torus(8, 6)
    many = [
        Attribute(f"a{number}", np.zeros(len(shape.positions), np.uint8), "vertex")
        for number in range(256)
    ]
    with pytest.raises(bsm.OptionError, match="255 attributes at most, not 256"):
        bsm.encode(TriangleMesh(shape.positions, shape.faces, tuple(many)))


def test_attributes_that_decoders_would_refuse_are_not_written(monkeypatch):
    monkeypatch.setitem(NAMED_LIMITS, "default", lambda: bsm.Limits(memory=6e6))
    shape = torus(12, 10)
    values = np.random.default_rng(0).normal(size=(3 * len(shape.faces), 4))
    many = tuple(Attribute(f"a{number}", values, "corner") for number in range(60))
    with pytest.raises(
        bsm.OptionError, match="decoders with default limits would refuse this stream"
    ):
        bsm.encode(TriangleMesh(shape.positions, shape.faces, many), grid=8)
    bsm.encode(TriangleMesh(shape.positions, shape.faces, many[:2]), grid=8)


def _one_far(scale):
    positions = torus(6, 6).positions.copy()
    positions[3, 1] = scale
    return positions


USES = {
    "compare": lambda mesh, good: bsm.compare(good, mesh),
    "compare with": lambda mesh, good: bsm.compare(mesh, good),
    "look with": lambda mesh, good: bsm.look(mesh, good),
    "denoise": lambda mesh, good: bsm.denoise(mesh),
    "encode": lambda mesh, good: bsm.encode(mesh, preset="lossless"),
    "encode frames": lambda mesh, good: bsm.encode_sequence(
        np.stack([good[0], mesh[0], good[0]]), good[1]
    ),
}


@pytest.mark.parametrize("use", USES)
@pytest.mark.parametrize(
    "positions", [torus(6, 6).positions * 3e307, _one_far(1e308), _one_far(-1e300)]
)
def test_coordinates_that_overflow_are_reported_wherever_they_come(use, positions):
    faces = torus(6, 6).faces
    with np.errstate(all="raise", under="ignore"), pytest.raises(MeshError, match="scale"):
        USES[use]((positions, faces), (torus(6, 6).positions, faces))


@pytest.mark.parametrize("name", [f"a.{kind}" for kind in MESH_FORMATS if kind != "stl"])
def test_coordinates_that_overflow_are_read_and_neither_cut_nor_compared_nor_encoded(
    tmp_path, name, capsys
):
    path, positions = tmp_path / name, _one_far(1e308)
    bsm.save((positions, torus(6, 6).faces), str(path))
    # A format without vertices may have them in another order.
    assert np.array_equal(np.unique(bsm.load(path).positions, axis=0), np.unique(positions, axis=0))
    with np.errstate(all="raise", under="ignore"):
        tile = [["tile", "-o", tmp_path / "tiles"]] if path.suffix in (".ply", ".obj") else []
        for words in (
            *tile,
            ["compare", path],
            ["denoise", "-o", tmp_path / "b.ply"],
            ["encode", "-o", tmp_path / "a.bsm"],
        ):
            assert main([words[0], str(path), *map(str, words[1:])]) == 3
            assert "scale it" in capsys.readouterr().err
