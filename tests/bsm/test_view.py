"""bsm view: the page with streams in it, and the server that has them beside it."""

import base64
import json
import re
import shutil
import subprocess
import sys
import urllib.error
import urllib.request
from pathlib import Path

import pytest

from bsm.cli import main

ROOT = Path(__file__).parents[2]
VECTORS = ROOT / "spec" / "vectors"
WEB = ROOT / "tools" / "web"
SLOT = re.compile(r'<script type="application/json" id="streams">(.*?)</script>', re.DOTALL)


def listed(page: str) -> list[dict[str, str]]:
    found = SLOT.search(page)
    assert found
    return list(json.loads(found[1]))


def test_saved_page_holds_the_streams(tmp_path):
    stream = tmp_path / "<script>.bsm"
    shutil.copy(VECTORS / "good-chain.bsm", stream)
    page = tmp_path / "page.html"
    assert main(["view", str(stream), str(VECTORS / "good-tetrahedron.bsm"), "--save", str(page)]) == 0
    first, second = listed(page.read_text("utf-8"))
    assert first["name"] == stream.name and second["name"] == "good-tetrahedron.bsm"
    assert base64.b64decode(first["data"]) == stream.read_bytes()


def test_page_is_not_overwritten_unasked(tmp_path):
    page = tmp_path / "page.html"
    page.write_text("mine")
    assert main(["view", str(VECTORS / "good-chain.bsm"), "--save", str(page)]) != 0
    assert page.read_text() == "mine"


def test_sequence_is_refused(capsys):
    assert main(["view", str(VECTORS / "good-sequence-one.bsm"), "--save", "unused.html"]) == 5
    assert "sequence" in capsys.readouterr().err


def test_server_has_the_page_and_its_streams():
    stream = VECTORS / "good-chain.bsm"
    command = [sys.executable, "-m", "bsm", "view", str(stream), str(stream), "--no-open"]
    with subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as server:
        try:
            assert server.stdout
            address = server.stdout.readline().strip()
            entries = listed(urllib.request.urlopen(address).read().decode())
            assert [entry["name"] for entry in entries] == ["good-chain.bsm", "good-chain.bsm (2)"]
            assert urllib.request.urlopen(address + entries[1]["url"].lstrip("/")).read() == stream.read_bytes()
            with pytest.raises(urllib.error.HTTPError, match="404"):
                urllib.request.urlopen(address + "2")
            elsewhere = urllib.request.Request(address, headers={"Host": "example.org"})
            with pytest.raises(urllib.error.HTTPError, match="403"):
                urllib.request.urlopen(elsewhere)
        finally:
            server.terminate()


@pytest.mark.skipif(shutil.which("node") is None, reason="no node")
@pytest.mark.skipif(not (WEB / "node_modules").is_dir(), reason="no packages: npm ci in tools/web")
@pytest.mark.parametrize("tests", ["vectors", "hostile", "browser"])
def test_javascript(tests):
    """The decoder in node, and the page in Chromium where there is one."""
    run = subprocess.run(["node", "scripts/test.mjs", tests], cwd=WEB, capture_output=True, text=True, timeout=300)
    assert run.returncode == 0, run.stdout + run.stderr


@pytest.mark.skipif(shutil.which("node") is None, reason="no node")
@pytest.mark.skipif(not (WEB / "node_modules").is_dir(), reason="no packages: npm ci in tools/web")
def test_what_is_built_is_what_the_sources_build():
    run = subprocess.run(["node", "scripts/build.mjs", "--check"], cwd=WEB, capture_output=True, text=True)
    assert run.returncode == 0, run.stdout + run.stderr
