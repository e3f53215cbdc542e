"""Every notebook and script of examples/, run as users run them."""

import os
import re
import select
import shutil
import signal
import socket
import subprocess
import sys
import urllib.error
import urllib.request
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from urllib.parse import urlsplit

import numpy as np
import pytest

import bsm
from tests.shapes import file_of, knot
from tools.noise import gaussian_along_normals

ROOT = Path(__file__).parents[1]
EXAMPLES = ROOT / "examples"
NOTEBOOKS = sorted((EXAMPLES / "notebooks").glob("*.ipynb"))
ENVIRONMENT = {**os.environ, "PYTHONPATH": f"{ROOT / 'src'}:{ROOT}", "MPLBACKEND": "agg"}


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebooks(path, tmp_path, monkeypatch):
    nbformat, nbclient = pytest.importorskip("nbformat"), pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    for name, value in ENVIRONMENT.items():
        monkeypatch.setenv(name, value)
    monkeypatch.delenv("MPLBACKEND")
    notebook = nbformat.read(path, as_version=4)
    nbformat.validate(notebook)
    assert not any(cell.get("outputs") for cell in notebook.cells), "outputs are not committed"
    nbclient.NotebookClient(
        notebook, timeout=300, resources={"metadata": {"path": str(tmp_path)}}
    ).execute()
    shown = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    assert shown and not any(output.output_type == "error" for output in shown)
    assert (
        any("image/png" in output.get("data", {}) for output in shown) or path.stem == "first_mesh"
    )
    if path.stem == "first_mesh":
        assert any(
            "application/vnd.jupyter.widget-view+json" in output.get("data", {}) for output in shown
        )


def test_all_are_listed():
    text = (EXAMPLES / "README.md").read_text()
    names = {path.relative_to(EXAMPLES).as_posix() for path in (*NOTEBOOKS, *EXAMPLES.glob("*.py"))}
    assert names == set(re.findall(r"^\| `(.*?)` \|", text, flags=re.MULTILINE))


def script(name, *words, **more):
    command = [sys.executable, EXAMPLES / name, *map(str, words)]
    return subprocess.run(
        command, capture_output=True, text=True, env=ENVIRONMENT, timeout=300, check=False, **more
    )


def test_a_folder_of_scans(tmp_path):
    mesh = knot(1200)
    noisy = bsm.TriangleMesh(gaussian_along_normals(mesh.positions, mesh.faces, 0.2, 0), mesh.faces)
    (tmp_path / "in/deep").mkdir(parents=True)
    bsm.save(noisy, tmp_path / "in/deep/scan.ply")
    (tmp_path / "in/broken.ply").write_bytes(b"ply\nno more")
    done = script("scans.py", tmp_path / "in", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    stream = tmp_path / "out/deep/scan.bsm"
    assert bsm.compare(mesh, stream).theta_deg < bsm.compare(mesh, noisy).theta_deg
    rows = (tmp_path / "out/report.csv").read_text().splitlines()
    assert (
        len(rows) == 3
        and rows[1].startswith("broken.ply,11,,,")
        and f",{stream.stat().st_size}," in rows[2]
    )
    assert "was there" in script("scans.py", tmp_path / "in", tmp_path / "out").stdout


def test_scans_of_one_name_and_links_to_nothing(tmp_path):
    (tmp_path / "in").mkdir()
    bsm.save(knot(300), tmp_path / "in/a.ply")
    bsm.save(knot(400), tmp_path / "in/a.obj")
    (tmp_path / "in/b.ply").symlink_to("nothing")
    done = script("scans.py", tmp_path / "in", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == [
        "a.obj.bsm",
        "a.ply.bsm",
        "report.csv",
    ]
    rows = (tmp_path / "out/report.csv").read_text().splitlines()
    assert "was there" not in done.stdout and "No such file" in rows[3]


def test_a_corpus_behind_urls(capsys, monkeypatch):
    fsspec = pytest.importorskip("fsspec")
    pytest.importorskip("distributed")
    import runpy

    memory = fsspec.filesystem("memory")
    for number in range(3):
        with memory.open(f"/raw/{number}.off", "wb") as file:
            file.write(off(knot(150 + 50 * number)))
    monkeypatch.setattr(sys, "argv", ["corpus.py", "memory://raw/*.off", "memory://bsm/"])
    with pytest.raises(SystemExit) as ended:
        runpy.run_path(str(EXAMPLES / "corpus.py"), run_name="__main__")
    assert ended.value.code == 0 and "3 of 3 meshes" in capsys.readouterr().out
    with memory.open("/bsm/1.bsm") as file:
        assert len(bsm.decode(file.read()).positions) == len(knot(200).positions)


def off(mesh):
    return file_of(mesh, "off")


SECONDS = 10.0


@pytest.fixture(scope="module")
def server():
    """A service with one worker and one that stands by, which gives a request ten seconds."""
    command = [
        sys.executable,
        EXAMPLES / "service.py",
        "--port",
        "0",
        "--jobs",
        "1",
        "--seconds",
        str(SECONDS),
    ]
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, env=ENVIRONMENT
    ) as running:
        try:
            yield running, running.stdout.readline().strip()
        finally:
            running.terminate()


@pytest.fixture
def service(server):
    return server[1]


def post(url, data):
    try:
        with urllib.request.urlopen(urllib.request.Request(url, data), timeout=120) as answer:
            return answer.status, answer.read()
    except urllib.error.HTTPError as error:
        return error.code, error.read()


def send(url, text, more=False):
    """What is answered to these very bytes; with `more` the connection, which stays open."""
    connection = socket.create_connection((urlsplit(url).hostname, urlsplit(url).port), timeout=60)
    connection.sendall(text)
    if more:
        return connection
    with connection, connection.makefile("rb") as file:
        return int(file.readline().split()[1])


def workers_of(process):
    """The processes that do the work."""
    found = Path(f"/proc/{process.pid}/task").glob("*/children")
    children = [int(word) for path in found for word in path.read_text().split()]
    return [pid for pid in children if b"spawn_main" in Path(f"/proc/{pid}/cmdline").read_bytes()]


def answers(service):
    return post(f"{service}/encode?preset=small", off(knot(200)))[0] == 200


def test_a_service_that_takes_uploads(service):
    mesh = knot(300)
    status, stream = post(f"{service}/encode?preset=small", off(mesh))
    assert status == 200 and bsm.compare(mesh, stream).max_error_relative < 0.05
    status, ply = post(f"{service}/decode", stream)
    assert status == 200 and ply.startswith(b"ply")
    status, answer = post(f"{service}/encode", b"this is no mesh")
    assert status == 422 and answer.startswith(b"FormatError: ")
    status, answer = post(f"{service}/decode", stream[: len(stream) // 2])
    assert status == 422 and answer.startswith(b"TruncatedError: ") and b"/" not in answer
    assert post(f"{service}/other", b"")[0] == 404
    many = off(bsm.TriangleMesh(np.zeros((3, 3)), [[0, 1, 2]])).replace(
        b"3 1 0", b"99999999999 1 0"
    )
    assert post(f"{service}/encode", many)[0] in (413, 422)


def test_a_service_takes_forms_says_its_health_and_sends_warnings(service):
    mesh = knot(300)
    loose = bsm.TriangleMesh(np.vstack([mesh.positions, [9.0, 9.0, 9.0]]), mesh.faces)
    # The bytes of a binary file may be line breaks, and look like the end of a part.
    file = file_of(loose, "ply")
    parts = (
        b'--x1\r\nContent-Disposition: form-data; name="preset"\r\n\r\nsmall\r\n'
        b'--x1\r\nContent-Disposition: form-data; name="file"; filename="a.ply"\r\n'
        b"Content-Type: application/octet-stream\r\n\r\n" + file + b"\r\n--x1--\r\n"
    )
    kind = {"Content-Type": "multipart/form-data; boundary=x1"}
    with urllib.request.urlopen(
        urllib.request.Request(f"{service}/encode", parts, kind), timeout=120
    ) as answer:
        stream, notes = answer.read(), answer.headers.get_all("X-BSM-Warning")
    assert bsm.compare(mesh, stream).max_error_relative < 0.05
    assert notes == ["left out 1 vertex that no face uses"]
    for wrong in (parts.replace(b"filename", b"nofile"), parts[:-9], b"--x1", b""):
        request = urllib.request.Request(f"{service}/encode", wrong, kind)
        with pytest.raises(urllib.error.HTTPError, match="400"):
            urllib.request.urlopen(request, timeout=120)
    with urllib.request.urlopen(f"{service}/health", timeout=60) as answer:
        assert (answer.status, answer.read()) == (200, b"ok\n")


@pytest.mark.skipif(shutil.which("curl") is None, reason="no curl")
def test_a_service_takes_what_curl_sends_as_a_form(service, tmp_path):
    bsm.save(knot(300), tmp_path / "a.obj")
    command = [
        "curl",
        "-sf",
        "-F",
        f"file=@{tmp_path}/a.obj",
        f"{service}/encode",
        "-o",
        tmp_path / "a.bsm",
    ]
    subprocess.run(command, check=True, timeout=120)
    assert len(bsm.decode(tmp_path / "a.bsm").faces) == len(knot(300).faces)


@pytest.mark.parametrize(
    ("lines", "status"),
    [
        (b"POST /encode HTTP/1.0", 411),
        *(
            (b"POST /encode HTTP/1.0\r\nContent-Length: " + length, 400)
            for length in (
                b"9" * 5000,
                b"-1",
                b"+5",
                b"0x5",
                b"5, 5",
                b"5\r\nContent-Length: 6",
                b"\xb2",
            )
        ),
        (b"POST /encode HTTP/1.0\r\nContent-Length: 99999999999", 413),
        (b"POST http://[/ HTTP/1.0\r\nContent-Length: 5", 400),
    ],
)
def test_a_service_takes_no_odd_heads(service, lines, status):
    assert send(service, lines + b"\r\n\r\n") == status


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="workers are looked for as on Linux")
def test_a_service_goes_on_whatever_hangs_dies_or_never_comes(server):
    process, service = server
    assert answers(service)
    for pid in workers_of(process):
        os.kill(pid, signal.SIGSTOP)
    with ThreadPoolExecutor(2) as clients:
        hanging = [clients.submit(post, f"{service}/encode", off(knot(200))) for _ in range(2)]
    # The second one may find a process that took the place of the first's.
    results = [c.result() for c in hanging]
    assert any(text.startswith(b"TimeoutError: ") for _, text in results)
    assert {status for status, _ in results} <= {200, 503}
    for pid in workers_of(process):
        os.kill(pid, signal.SIGKILL)
    assert answers(service) and answers(service)
    head = b"POST /encode HTTP/1.0\r\nContent-Length: 1000\r\n\r\n"
    silent = [send(service, words, more=True) for words in (head, head + b"OFF", b"POST /enc")]
    assert answers(service) and not select.select(silent, [], [], 0)[0], (
        "no silent one was waited for"
    )
    for connection, status in zip(silent, (b" 408 ", b" 408 ", b"")):
        with connection, connection.makefile("rb") as file:
            assert status in file.read(), "it is let go of"
    assert answers(service)
    crowd = [send(service, b"POST", more=True) for _ in range(40)]
    assert all(b" 503 " in connection.makefile("rb").readline() for connection in crowd[20:])
    for connection in crowd:
        connection.close()
