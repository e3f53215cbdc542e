"""Files that become much more than their bytes: counted in triangles and vertices before these are made."""

import sys

import pytest

from bsm import LimitError, Limits, MeshError
from bsm.files.mesh import read_mesh
from tests.bsm.program import bsm
from tools.attack.readers import Case, _grown, chained_objects, problems, three_mf, warm_up

LARGE = (
    *("ply, quads of bytes", "ply, long polygons of bytes", "glb, accessors of no bytes"),
    *("3mf, items", "3mf, components", "3mf, some components", "3mf, a chain"),
)


@pytest.mark.skipif(sys.platform != "linux", reason="memory is measured as Linux tells it")
@pytest.mark.parametrize("limits", ["service", "default"])
def test_what_multiplies_is_refused_or_within_the_promised_memory_and_time(limits):
    pytest.importorskip("trimesh")
    warm_up()
    made = _grown(1 << 19)
    assert not list(problems([Case(name, made[name]) for name in LARGE], limits))


def test_a_3mf_file_is_read_as_a_whole_or_not_at_all(tmp_path):
    pytest.importorskip("trimesh")
    path = tmp_path / "a.3mf"
    path.write_bytes(three_mf(chained_objects(3), '<item objectid="3"/>'))
    assert len(read_mesh(path).mesh.faces) == 8
    path.write_bytes(three_mf(chained_objects(3), '<item objectid="3"/><item objectid="0"/>'))
    assert len(read_mesh(path).mesh.faces) == 9
    path.write_bytes(three_mf(chained_objects(39), '<item objectid="39"/>'))
    with pytest.raises(LimitError, match="vertices"):
        read_mesh(path, limits=Limits.service())
    loop = '<object id="1"><components><component objectid="1"/></components></object>'
    path.write_bytes(three_mf(loop, '<item objectid="1"/>'))
    with pytest.raises(MeshError, match="component of itself"):
        read_mesh(path)


def test_a_part_of_a_3mf_file_is_an_error(tmp_path, monkeypatch):
    trimesh = pytest.importorskip("trimesh")
    path = tmp_path / "a.3mf"
    path.write_bytes(three_mf(chained_objects(2), '<item objectid="2"/>'))
    whole = trimesh.load_scene(path, file_type="3mf")

    def part(*_, **__):
        whole.delete_geometry(next(iter(whole.geometry)))
        return whole

    monkeypatch.setattr(trimesh, "load_scene", part)
    with pytest.raises(MeshError, match="0 of the 4 triangles"):
        read_mesh(path)


def test_an_element_without_properties_is_no_obstacle_to_tiles(tmp_path):
    head = (
        "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    )
    body = bytes(12) + b"\0\0\x80?" + bytes(12) + b"\0\0\x80?" + bytes(4) + b"\3\0\1\2"
    lists = "element nothing 7\nelement face 1\nproperty list uchar uchar vertex_indices\nend_header\n"
    (tmp_path / "a.ply").write_bytes((head + lists).encode() + body)
    done = bsm("tile", tmp_path / "a.ply", "-o", tmp_path / "t")
    assert done.returncode == 0, done.stderr
