"""Meshes and streams in a store of S3: a real server, of moto, in this process (`pip install 'moto[server]' s3fs`)."""

import json
import os
import subprocess
import sys
import urllib.request

import pytest

import bsm
from bsm.cli import main
from bsm.files.mesh import format_mesh
from tests.shapes import torus

pytestmark = pytest.mark.long
MESH = torus(24, 16)


@pytest.fixture
def store(monkeypatch):
    """A server with a bucket, and its file system."""
    s3fs, server = pytest.importorskip("s3fs"), pytest.importorskip("moto.server")
    running = server.ThreadedMotoServer(port=0, verbose=False)
    running.start()
    host, port = running.get_host_and_port()
    for name, value in {
        "AWS_ENDPOINT_URL": f"http://{host}:{port}",
        "AWS_ACCESS_KEY_ID": "key",
        "AWS_SECRET_ACCESS_KEY": "secret",
        "AWS_DEFAULT_REGION": "us-east-1",
        "AWS_MAX_ATTEMPTS": "1",
    }.items():
        monkeypatch.setenv(name, value)
    s3fs.S3FileSystem.clear_instance_cache()
    # What one server holds the next one in this process would have, too.
    urllib.request.urlopen(urllib.request.Request(f"http://{host}:{port}/moto-api/reset", method="POST")).close()
    files = s3fs.S3FileSystem()
    files.mkdir("meshes")
    yield files
    running.stop()
    s3fs.S3FileSystem.clear_instance_cache()


def put(store, name, mesh=MESH):
    with store.open(f"meshes/{name}", "wb") as file:
        file.write(format_mesh(mesh, "ply"))


def test_from_the_store_and_to_it(store, tmp_path):
    put(store, "a.ply")
    assert main(["encode", "-q", "s3://meshes/a.ply", "-o", "s3://meshes/out/a.bsm"]) == 0
    data = store.cat_file("meshes/out/a.bsm")
    assert data == bsm.encode(bsm.read_mesh(format_mesh(MESH, "ply")).mesh)
    assert main(["decode", "-q", "s3://meshes/out/a.bsm", "-o", str(tmp_path / "a.ply")]) == 0
    assert bsm.compare(MESH, bsm.load(tmp_path / "a.ply")).max_error_relative < 0.01
    assert main(["verify", "-q", "s3://meshes/out/a.bsm"]) == 0
    assert main(["encode", "-q", "s3://meshes/a.ply", "-o", "s3://meshes/out/a.bsm"]) != 0, "it is there already"


def test_a_run_goes_on_from_its_report(store, tmp_path):
    for name in "abc":
        put(store, f"in/{name}.ply")
    store.pipe_file("meshes/in/d.ply", b"ply\nno mesh")
    names = [f"s3://meshes/in/{name}.ply" for name in "abcd"]
    command = ["encode", "-q", *names, "-o", "s3://meshes/out/", "--report", str(tmp_path / "report.json")]
    assert main(command) != 0
    rows = json.loads((tmp_path / "report.json").read_text())["files"]
    assert sorted("error" in row for row in rows) == [False, False, False, True]
    before = {path: store.info(path)["ETag"] for path in store.ls("meshes/out")}
    assert len(before) == 3
    changed = store.info("meshes/out/a.bsm")["LastModified"]
    put(store, "in/d.ply")
    assert main([*command, "--resume"]) == 0
    store.invalidate_cache()
    assert {path: store.info(path)["ETag"] for path in before} == before
    assert store.info("meshes/out/a.bsm")["LastModified"] == changed
    assert store.exists("meshes/out/d.bsm")


def test_what_is_not_there_is_said(store, capsys):
    assert main(["encode", "-q", "s3://meshes/none.ply", "-o", "s3://meshes/none.bsm"]) != 0
    put(store, "a.ply")
    assert main(["encode", "-q", "s3://meshes/a.ply", "-o", "s3://no-such-bucket/a.bsm"]) != 0
    said = capsys.readouterr().err
    assert all(line.startswith("bsm: s3://") for line in said.splitlines()) and len(said.splitlines()) == 2


def test_a_store_that_fails_while_it_is_written_to(store, monkeypatch, capsys):
    import botocore.exceptions
    import s3fs

    put(store, "a.ply")

    def refused(self, method, *rest, **more):
        if method in ("put_object", "upload_part", "complete_multipart_upload"):
            raise botocore.exceptions.ClientError({"Error": {"Code": "500", "Message": "full"}}, method)
        return given(self, method, *rest, **more)

    given = s3fs.S3FileSystem.call_s3
    monkeypatch.setattr(s3fs.S3FileSystem, "call_s3", refused)
    assert main(["encode", "-q", "s3://meshes/a.ply", "-o", "s3://meshes/a.bsm"]) != 0
    assert "Traceback" not in capsys.readouterr().err
    store.invalidate_cache()
    assert not store.exists("meshes/a.bsm")


def test_a_server_that_goes_away_is_an_error_of_ours(store, capsys):
    put(store, "a.ply")
    address = os.environ["AWS_ENDPOINT_URL"]
    with urllib.request.urlopen(address) as answer:
        assert answer.status == 200
    os.environ["AWS_ENDPOINT_URL"] = "http://127.0.0.1:9"
    type(store).clear_instance_cache()
    assert main(["encode", "-q", "s3://meshes/a.ply", "-o", "s3://meshes/a.bsm"]) != 0
    said = capsys.readouterr().err
    assert said.startswith("bsm: ") and "Traceback" not in said


def test_a_process_that_is_killed_leaves_no_part_of_a_file(store, tmp_path):
    put(store, "a.ply")
    program = """
import os, signal
import bsm.files.remote as remote
from bsm.cli import main
import s3fs
def died(self, *rest, **more):
    os.kill(os.getpid(), signal.SIGKILL)
s3fs.core.S3File.close = died
main(["encode", "-q", "s3://meshes/a.ply", "-o", "s3://meshes/a.bsm"])
"""
    done = subprocess.run([sys.executable, "-c", program], timeout=120, check=False)
    assert done.returncode == -9
    store.invalidate_cache()
    assert not store.exists("meshes/a.bsm")
    assert main(["encode", "-q", "s3://meshes/a.ply", "-o", "s3://meshes/a.bsm"]) == 0
