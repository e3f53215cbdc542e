"""Every notebook and script of examples/, run as users run them."""

import os
import re
import subprocess
import sys
import urllib.error
import urllib.request
from pathlib import Path

import numpy as np
import pytest

import bsm
from bsm.evaluation.sample import knot
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
    nbclient.NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(tmp_path)}}).execute()
    shown = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    assert shown and not any(output.output_type == "error" for output in shown)
    assert any("image/png" in output.get("data", {}) for output in shown) or path.stem == "first_mesh"
    if path.stem == "first_mesh":
        assert any("application/vnd.jupyter.widget-view+json" in output.get("data", {}) for output in shown)


def test_all_are_listed():
    text = (EXAMPLES / "README.md").read_text()
    names = {path.relative_to(EXAMPLES).as_posix() for path in (*NOTEBOOKS, *EXAMPLES.glob("*.py"))}
    assert names == set(re.findall(r"^\| `(.*?)` \|", text, flags=re.MULTILINE))


def script(name, *words, **more):
    command = [sys.executable, EXAMPLES / name, *map(str, words)]
    return subprocess.run(command, capture_output=True, text=True, env=ENVIRONMENT, timeout=300, check=False, **more)


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
    assert len(rows) == 3 and rows[1].startswith("broken.ply,11,,,") and f",{stream.stat().st_size}," in rows[2]
    assert "was there" in script("scans.py", tmp_path / "in", tmp_path / "out").stdout


def test_a_corpus_behind_urls(capsys, monkeypatch):
    fsspec = pytest.importorskip("fsspec")
    pytest.importorskip("distributed")
    import runpy

    memory = fsspec.filesystem("memory")
    for number in range(3):
        with memory.open(f"/raw/{number}.off", "wb") as file:
            file.write(off(knot(300 + 50 * number)))
    monkeypatch.setattr(sys, "argv", ["corpus.py", "memory://raw/*.off", "memory://bsm/"])
    with pytest.raises(SystemExit) as ended:
        runpy.run_path(str(EXAMPLES / "corpus.py"), run_name="__main__")
    assert ended.value.code == 0 and "3 of 3 meshes" in capsys.readouterr().out
    with memory.open("/bsm/1.bsm") as file:
        assert len(bsm.decode(file.read()).positions) == len(knot(350).positions)


def off(mesh):
    lines = ["OFF", f"{len(mesh.positions)} {len(mesh.faces)} 0"]
    lines += [" ".join(map(str, row)) for row in mesh.positions.tolist()]
    lines += [" ".join(map(str, (3, *row))) for row in mesh.faces.tolist()]
    return "\n".join(lines).encode()


@pytest.fixture
def service():
    command = [sys.executable, EXAMPLES / "service.py", "--port", "0", "--jobs", "1"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=ENVIRONMENT) as running:
        try:
            yield running.stdout.readline().strip()
        finally:
            running.terminate()


def post(url, data):
    try:
        with urllib.request.urlopen(urllib.request.Request(url, data), timeout=120) as answer:
            return answer.status, answer.read()
    except urllib.error.HTTPError as error:
        return error.code, error.read()


def test_a_service_that_takes_uploads(service):
    mesh = knot(500)
    status, stream = post(f"{service}/encode?preset=small", off(mesh))
    assert status == 200 and bsm.compare(mesh, stream).max_error_relative < 0.05
    status, ply = post(f"{service}/decode", stream)
    assert status == 200 and ply.startswith(b"ply")
    assert post(f"{service}/encode", b"this is no mesh")[0] == 422
    assert post(f"{service}/decode", stream[: len(stream) // 2])[0] == 422
    assert post(f"{service}/other", b"")[0] == 404
    many = off(bsm.TriangleMesh(np.zeros((3, 3)), [[0, 1, 2]])).replace(b"3 1 0", b"99999999999 1 0")
    assert post(f"{service}/encode", many)[0] in (413, 422)
