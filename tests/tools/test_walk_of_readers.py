"""A part of the walk over all readers of files, ours and others; `python -m tools.attack readers` is the whole."""

import json
import os
import sys
from functools import partial
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from bsm import Limits
from bsm.files.landlock import lack
from bsm.files.table import FORMATS, MESH_FORMATS, SEQUENCES_READ, XDMF
from tests.gltf import unpack
from tools.attack.calls import recorded
from tools.attack.doors import EVEN, OTHERS, Apart, attempt, compared, of_polygons
from tools.attack.growth import growth
from tools.attack.readers import (
    Sample,
    grown,
    numbers,
    problems,
    read_all,
    samples,
    warm_up,
    written,
)
from tools.attack.taken import Case, Taken
from tools.attack.uses import cases, of_size, uses

linux = pytest.mark.skipif(sys.platform != "linux", reason="memory is measured as Linux tells it")

USES = dict(uses())


def test_the_walk_visits_every_format_that_is_read_here():
    suffixes = {sample.suffix for sample in samples().values()}
    apart = (kind for kind, row in FORMATS.items() if row.apart)
    others = {"gltf", "usd", "usda", "usdc", "usdz", *XDMF, *apart}
    assert {*MESH_FORMATS, *SEQUENCES_READ} - suffixes <= others
    names = {case.name.partition(",")[0] for case in numbers()}
    assert set(samples()) <= names


def test_the_recorder_follows_processes_from_their_filter_to_their_end():
    lines = """7 openat(AT_FDCWD, "a") = 3
        7 prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, 0x1) = 0
        7 mkdir( <unfinished ...>
        8 wait4(7, <unfinished ...>
        7 <... mkdir resumed>"b") = -1 (errno 3083)
        7 clone(child_stack=0x7f) = -1 (errno 3056)
        7 +++ exited with 0 +++
        7 socket(AF_UNIX) = 4"""
    calls, refused = recorded(line.strip() for line in lines.splitlines())
    assert calls == refused == {"clone": 1, "mkdir": 1}


@linux
def test_the_walk_finds_what_is_beyond_the_bounds(monkeypatch):
    """A reader that inflates whatever it is given, one that ends its process, and one that lets errors out."""
    warm_up()
    good = samples()["obj.gz"]
    cases = [Case("a", lambda: good), Case("b", lambda: Sample("obj", b"v 0 0 0\nf 1 1 1\n"))]
    assert not list(problems(cases, "default"))
    for fault, message in (
        (lambda: bytearray(1 << 28), "of 64 MiB"),
        (lambda: 1 // 0, "ZeroDivision"),
        (os.abort, "died"),
    ):
        with monkeypatch.context() as patch:
            patch.setattr(
                "tools.attack.readers.read_all",
                lambda path, limits, fault=fault: (fault(), Taken("read"))[1],
            )
            found = list(problems(cases, "default"))
        assert len(found) == 2 and all(message in problem for problem in found)


def test_a_usd_file_that_is_nested_too_deep_for_its_library_ends_only_its_process(tmp_path):
    pytest.importorskip("pxr")
    if lack() is not None:
        pytest.skip(f"needs {lack()}")
    (tmp_path / "a.usda").write_bytes(b"#usda 1.0\n" + b'def "a" {\n' * 300_000 + b"}\n" * 300_000)
    # How deep the library comes before it crashes hangs on its release and on the stack that it is given.
    outcome = read_all(tmp_path / "a.usda", Limits.service()).outcome
    assert "crashed the library" in outcome or "over 65,536 prims" in outcome


@linux
def test_what_takes_longer_than_its_size_grows_is_found(monkeypatch):
    def spaces(size):
        return Sample("off", b"OFF" + b"\n" * size + b"x")

    assert growth(spaces) is None

    def quadratic(path, limits):
        size = path.stat().st_size
        return (sum(range((size >> 5) ** 2)), Taken("read"))[1]

    monkeypatch.setattr("tools.attack.readers.read_all", quadratic)
    assert "times as long" in growth(spaces, times=1)


@linux
def test_nodes_of_a_gltf_that_are_nested_deep_are_read(tmp_path):
    for sample in (
        grown(1 << 17)["glb, a chain of nodes"](),
        of_size(USES["glb, materials"], 1 << 17),
    ):
        (tmp_path / "a.glb").write_bytes(sample.data)
        assert "read" in read_all(tmp_path / "a.glb", Limits()).outcome
    tree = unpack(samples()["glb"].data)[0]
    tree["accessors"][0]["count"] = 10**400
    (tmp_path / "a.gltf").write_text(json.dumps(tree))
    assert "Error: " in read_all(tmp_path / "a.gltf", Limits()).outcome


@pytest.mark.parametrize("name", USES)
def test_a_few_uses_are_read(name, tmp_path):
    taken = read_all(written(USES[name](2000, 3), Path(tmp_path))[0], Limits())
    refused = (
        "instancing" in name,
        "PointInstancer" in taken.outcome,
        "name in directory" in taken.outcome,
    )
    assert taken.outcome == "read" or any(refused), taken.outcome


@linux
@pytest.mark.parametrize("name", ["glb, skins", "glb, nodes_of_primitives"])
def test_uses_are_counted_once_and_before_they_are_made(name):
    warm_up()
    assert not list(
        problems([Case(name, partial(of_size, USES[name], 400_000, 0.1))], "default", 1.25)
    )


def test_files_have_the_size_that_is_asked_for():
    sizes = {case.name: len(case.make().data) for case in cases(20_000, (0.5,))}
    assert all(2000 < size < 40_000 for size in sizes.values()), sizes


MOVING = Path(__file__).parents[1] / "bsm" / "files" / "moving"


def test_usd_core_reads_our_samples_as_we_do():
    pytest.importorskip("pxr")
    apart = Apart()
    try:
        for name in ("skinned.usdc", "morphing.usdc", "painted.usdz"):
            assert list(compared(MOVING / name, ["usd"], apart)) == [("usd", "same", "")]
        assert apart.read("usd", MOVING / "three.mjs") is None
    finally:
        apart.close()


def test_a_reader_that_is_missing_or_fails_reads_nothing(tmp_path):
    (tmp_path / "a.ply").write_bytes(b"no mesh")
    assert attempt("trimesh", tmp_path / "a.ply") is None


L_SHAPE = ("0 0 0", "2 0 0", "2 1 0", "1 1 0", "1 2 0", "0 2 0")
LS = {
    "off": "OFF\n6 1 0\n" + "\n".join(L_SHAPE) + "\n6 5 0 1 2 3 4\n",
    "obj": "".join(f"v {point}\n" for point in L_SHAPE) + "f 6 1 2 3 4 5\n",
    "usda": f"""#usda 1.0
def Mesh "a" {{
    point3f[] points = [{", ".join(f"({point.replace(' ', ',')})" for point in L_SHAPE)}]
    int[] faceVertexCounts = [6]
    int[] faceVertexIndices = [5, 0, 1, 2, 3, 4]
}}
""",
}


@pytest.mark.parametrize("kind", LS)
def test_polygons_settle_what_their_cuts_do_not(kind, tmp_path, monkeypatch):
    """A polygon that is not convex, whose fan has another area, is judged by its area vector."""
    if kind == "usda":
        pytest.importorskip("pxr")
    path = tmp_path / f"a.{kind}"
    path.write_text(LS[kind])
    by_area = next(name for name in EVEN if name.startswith(kind[:3]))
    reader = OTHERS[by_area][0]
    fan = reader(path)
    fan.normals = None
    monkeypatch.setitem(OTHERS, "fan", (lambda path: fan, (kind,)))
    apart = SimpleNamespace(read=lambda name, path: OTHERS[name][0](path))
    found = list(compared(path, [by_area, "fan"], apart))
    assert found[0] == (by_area, "same", "")
    assert {result for name, result, _ in found if name == "fan"} == {"settled"}
    assert {result for _, result, _ in compared(path, ["fan"], apart)} <= {"differs", "noted"}
    fan.normals = reader(path).normals
    fan.triangles = fan.triangles * [1, 1.001, 1]
    found = list(compared(path, ["fan"], apart))
    assert ("fan", "differs") in {(name, result) for name, result, _ in found}


def test_a_quad_that_is_not_flat_may_differ_by_what_its_height_adds():
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
    corners = np.arange(4)
    assert of_polygons(square, [4], corners).uneven == 0
    bent = square + np.array([[0, 0, 0], [0, 0, 0.01], [0, 0, 0], [0, 0, 0]])
    both = [of_polygons(bent, [4], np.roll(corners, by)) for by in (0, 1)]
    away = max(
        np.abs(a - b).max()
        for a, b in zip(*(read.moments().values() for read in both), strict=True)
    )
    assert 1e-5 < away < both[0].uneven < 0.05
    tie = of_polygons(square, [4], np.array([0, 2, 1, 3]))
    assert tie.uneven > 0.05, "edges that cross"
