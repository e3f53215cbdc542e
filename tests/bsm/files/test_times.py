"""When frames are shown: numbers in names, times in files and lists; in and out."""

import json

import numpy as np
import pytest

from bsm import FormatError, MeshError, TriangleMesh, save
from bsm.files.motion.frames import Shared
from bsm.files.sequence import sequence_writer
from bsm.files.table import FORMATS, MESH_FORMATS
from tests.bsm.program import run as bsm
from tests.gltf import glb, unpack
from tests.motion import sequence_in
from tests.shapes import tetrahedron

COUNT = 4
SHAPE = tetrahedron()


def opened(path, **keywords):
    return sequence_in(str(path), **keywords)


def written(path, kind, metadata):
    shared = Shared(metadata=lambda: metadata)
    with sequence_writer(
        str(path), kind, SHAPE.faces, COUNT, overwrite=True, shared=shared
    ) as write:
        for number in range(COUNT):
            write(SHAPE.positions + number)
    return shared.left_out


def timing(source):
    """The time of each frame in seconds at 24 frames per second, if no rate is known."""
    known = Shared(metadata=lambda: {**source.metadata, "frame_rate": source.frame_rate or 24.0})
    return [known.code(number) / known.frame_rate for number in range(source.count)]


@pytest.mark.parametrize("kind", [kind for kind in MESH_FORMATS if not FORMATS[kind].frames])
@pytest.mark.parametrize(("start", "step"), [(997, 1), (0, 2), (-3, 5)])
def test_numbers_of_frames_go_in_and_out(kind, start, step, tmp_path):
    (tmp_path / "in").mkdir()
    for number in range(COUNT):
        save(SHAPE, tmp_path / f"in/f_{start + number * step:04d}.{kind}")
    source = opened(tmp_path / "in")
    assert (
        source.metadata.get("frame_start", 0) == start
        and source.metadata.get("frame_step", 1) == step
    )
    assert written(tmp_path / f"out/g_%04d.{kind}", kind, source.metadata) == []
    assert {path.stem[2:] for path in (tmp_path / "out").iterdir()} == {
        path.stem[2:] for path in (tmp_path / "in").iterdir()
    }
    assert timing(opened(tmp_path / "out")) == timing(source)


@pytest.mark.parametrize("times", [(2.0, 2.5, 3.0, 3.5), (0.0, 0.5, 3.0, 7.0)])
@pytest.mark.parametrize("form", ["vtp", "pvd", "series"])
def test_times_of_files_and_of_lists_go_in_and_out(form, times, tmp_path):
    (tmp_path / "in").mkdir()
    for number, time in enumerate(times):
        known = {"TimeValue": time} if form == "vtp" else {}
        save(
            TriangleMesh(SHAPE.positions + number, SHAPE.faces, (), known),
            tmp_path / f"in/f_{number}.vtp",
        )
    rows = [(f"in/f_{number}.vtp", time) for number, time in enumerate(times)][::-1]
    sets = "".join(f'<DataSet timestep="{time}" part="0" file="{name}"/>' for name, time in rows)
    (tmp_path / "a.pvd").write_text(
        f'<VTKFile type="Collection"><Collection>{sets}</Collection></VTKFile>'
    )
    listed = [{"name": name, "time": time} for name, time in rows]
    (tmp_path / "a.vtp.series").write_text(
        json.dumps({"file-series-version": "1.0", "files": listed})
    )
    source = opened(tmp_path / {"vtp": "in", "pvd": "a.pvd", "series": "a.vtp.series"}[form])
    assert timing(source) == pytest.approx(times) and "TimeValue" not in source.metadata
    assert [frame[0, 0] for frame in source.frames] == pytest.approx(
        SHAPE.positions[0, 0] + np.arange(COUNT)
    )
    metadata = {
        **source.metadata,
        **({"frame_rate": source.frame_rate} if source.frame_rate else {}),
    }
    assert written(tmp_path / "out", "vtp", metadata) == []
    assert timing(opened(tmp_path / "out")) == pytest.approx(times)


def test_a_file_that_a_list_names_for_many_times_is_read_once(tmp_path):
    save(SHAPE, tmp_path / "a.ply")
    rows = [{"name": "a.ply", "time": time} for time in range(50)]
    (tmp_path / "a.series").write_text(json.dumps({"files": rows}))
    frames = list(opened(tmp_path / "a.series").frames)
    assert len(frames) == 50 and all(np.shares_memory(frame, frames[0]) for frame in frames)
    assert np.array_equal(frames[0], SHAPE.positions)


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.pvd", "<VTKFile"),
        ("a.pvd", "<Collection><DataSet timestep='1'/></Collection>"),
        ("a.series", "{}"),
        ("a.pvd", "<Collection><DataSet timestep='inf' file='a.vtp'/></Collection>"),
        ("a.series", '{"files": [{"name": "a.vtp", "time": NaN}]}'),
        ("a.series", '{"files": [{"name": "a.vtp", "time": 1' + 400 * "0" + "}]}"),
        ("b.series", "[1]"),
    ],
)
def test_a_list_that_is_broken_is_refused(name, text, tmp_path):
    (tmp_path / name).write_text(text)
    with pytest.raises(FormatError, match="this is not a"):
        opened(tmp_path / name)


def test_a_list_of_parts_or_of_other_folders_is_refused(tmp_path):
    save(SHAPE, tmp_path / "a.ply")
    (tmp_path / "in").mkdir()
    parts = "".join(f'<DataSet timestep="1" part="{part}" file="a.ply"/>' for part in range(2))
    (tmp_path / "a.pvd").write_text(f"<Collection>{parts}</Collection>")
    with pytest.raises(MeshError, match="two for one time"):
        opened(tmp_path / "a.pvd")
    (tmp_path / "in/b.series").write_text(json.dumps({"files": [{"name": "../a.ply", "time": 0}]}))
    with pytest.raises(FormatError, match="not in the folder"):
        opened(tmp_path / "in/b.series")


@pytest.mark.parametrize(("start", "kept"), [(48.0, 2.0), (-5.0, 0.0), (1e6, 0.0)])
def test_a_clip_begins_when_it_did(start, kept, tmp_path):
    left = written(tmp_path / "a.glb", "glb", {"frame_start": start, "frame_rate": 24.0})
    assert left == ([] if kept else ["the number of the first frame"])
    source = opened(tmp_path / "a.glb")
    assert timing(source) == pytest.approx(kept + np.arange(COUNT) / 24) and not FORMATS[
        "glb"
    ].times - {"frame_start", "frame_step", "frame_times", "frame_rate"}


def test_the_shell_keeps_the_numbers_of_frames(tmp_path, capsys):
    (tmp_path / "in").mkdir()
    for number in (997, 999, 1001):
        save(TriangleMesh(SHAPE.positions + number, SHAPE.faces), tmp_path / f"in/f_{number}.ply")
    assert bsm("encode", tmp_path / "in", "-o", tmp_path / "a.bsm") == 0
    assert bsm("decode", tmp_path / "a.bsm", "-o", f"{tmp_path}/out/") == 0
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == [
        "00997.ply",
        "00999.ply",
        "01001.ply",
    ]
    assert "other meshes" not in capsys.readouterr().err
    assert bsm("decode", tmp_path / "a.bsm", "-f", "-o", f"{tmp_path}/out/", "--frames", "0:2") == 0
    assert "1 other meshes are there" in capsys.readouterr().err


def test_pointers_are_named(tmp_path):
    written(tmp_path / "a.glb", "glb", {})
    tree, numbers = unpack((tmp_path / "a.glb").read_bytes())
    for channel in tree["animations"][0]["channels"]:
        channel["target"] = {"path": "pointer"}
    (tmp_path / "c.glb").write_bytes(glb(tree, numbers))
    with pytest.raises(FormatError, match="channels of pointer were left out"):
        opened(tmp_path / "c.glb")
