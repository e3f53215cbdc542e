"""Systems that cannot keep files from readers refuse what other libraries read, and say what they need."""

import sys

import pytest

from bsm import DependencyError, LimitError, Limits, MeshError, UnsupportedError, read_mesh
from bsm.cli import main
from bsm.files import landlock
from tests.motion import sequence_in

pytest.importorskip("bsm.files.isolation")
TRIANGLE = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
SERVICE = Limits.service()


@pytest.fixture(params=["Linux", "landlockpy: pip install landlockpy", "a kernel with Landlock"])
def lacking(request, monkeypatch):
    if request.param == "Linux":
        monkeypatch.setattr(sys, "platform", "darwin")
    monkeypatch.setattr(landlock, "lack", lambda: request.param)
    return (
        DependencyError if "pip" in request.param else UnsupportedError
    ), f"needs {request.param}"


def test_what_other_libraries_read_is_refused(lacking, tmp_path):
    error, words = lacking
    (tmp_path / "a.obj").write_bytes(TRIANGLE)
    for name in ("a.dae", "a.3mf", "a.usda", "a.dae.gz"):
        (tmp_path / name).write_bytes(b"\x1f\x8b" if name.endswith("gz") else b"<COLLADA/>")
        with pytest.raises(error, match=words):
            read_mesh(tmp_path / name, limits=SERVICE)
    for name in ("a.usda", "a.pc2"):
        (tmp_path / name).write_bytes(b"#usda 1.0")
        with pytest.raises(error, match=words):
            sequence_in(tmp_path / name, limits=SERVICE)
    for given in (TRIANGLE, tmp_path / "a.obj", tmp_path / "a.dae"):
        with pytest.raises(error, match=words):
            read_mesh(given, isolated=True)
    with pytest.raises(error, match=words):
        sequence_in(tmp_path / "*.obj", isolated=True)
    assert main(["encode", str(tmp_path / "a.obj"), "--untrusted", "-q"]) == (
        8 if error is DependencyError else 5
    )
    assert not (tmp_path / "a.bsm").exists()


def test_what_we_read_ourselves_is_read(lacking, tmp_path):
    (tmp_path / "a.obj").write_bytes(TRIANGLE)
    for given in (TRIANGLE, tmp_path / "a.obj"):
        assert len(read_mesh(given, limits=SERVICE).mesh.faces) == 1
    assert sequence_in(tmp_path / "*.obj", limits=SERVICE).count == 1
    with pytest.raises(MeshError):
        read_mesh(b"v 0 0 0\n", limits=SERVICE)
    with pytest.raises(LimitError):
        read_mesh(
            b"ply\nformat ascii 1.0\nelement vertex 2000000\nelement face 1\nend_header\n",
            limits=SERVICE,
        )


def test_the_package_is_looked_for(monkeypatch):
    monkeypatch.setitem(sys.modules, "landlockpy", None)
    assert "pip install landlockpy" in landlock.lack.__wrapped__()
