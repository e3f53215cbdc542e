"""bsm view: the page with streams in it, and the server that has them beside it."""

import base64
import gzip
import hashlib
import json
import os
import re
import shutil
import socket
import subprocess
import sys
import threading
import time
import urllib.error
import urllib.request
from dataclasses import astuple
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bsm
from bsm.bitstream.container.wire import MAGIC
from bsm.cli import main
from bsm.evaluation.curve import encode_draco
from bsm.viewer.page import DRACO_LEVEL, Growing, PageServer, Ranged, Tiled, compared, written_to
from tests.bitstream.streams import frame_ends
from tests.shapes import curved, torus
from tests.streams import moving_events_of

needs_packages = pytest.mark.skipif(
    shutil.which("node") is None or not (Path(__file__).parents[2] / "tools/web/node_modules").is_dir(),
    reason="no packages: npm ci in tools/web, with node",
)
ROOT = Path(__file__).parents[2]
VECTORS = ROOT / "spec" / "vectors" / "1.0"
WEB = ROOT / "tools" / "web"
SLOT = re.compile(r'<script type="application/json" id="bsm-streams">(.*?)</script>', re.DOTALL)


def moving(frames: int) -> tuple[np.ndarray, np.ndarray]:
    """A torus that sways."""
    mesh = torus()
    turns = np.linspace(0.0, 1.0, frames)[:, None, None]
    sway = np.sin(3.0 * mesh.positions[None, :, 2:] + 6.0 * turns)
    return (mesh.positions[None] + 0.1 * sway * [1.0, 0.0, 0.0]).astype(np.float32), mesh.faces


def sent_to(growing: Growing) -> bytes:
    """What a page is sent of a stream that has ended meanwhile."""
    return b"".join(growing.chunks())


def frames_sent(data: bytes) -> tuple[list[np.ndarray], list[int]]:
    """Frames of a stream that may begin late, and how many are missing where."""
    events = moving_events_of(data, tolerant=True)
    lost = [len(event.frames) for event in events if isinstance(event, bsm.LossEvent)]
    return [event.positions for event in events if isinstance(event, bsm.FrameEvent)], lost


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


def test_meshes_are_encoded_on_the_way(tmp_path, capsys):
    mesh, source, page = torus(), tmp_path / "ball.ply", tmp_path / "page.html"
    bsm.save(mesh, source)
    assert main(["view", str(source), "--save", str(page)]) == 0
    (entry,) = listed(page.read_text("utf-8"))
    assert base64.b64decode(entry["data"]) == bsm.encode(source)
    assert f"{len(bsm.encode(source))} bytes as a stream" in capsys.readouterr().err


def test_server_has_the_page_and_its_streams():
    stream = VECTORS / "good-chain.bsm"
    command = [sys.executable, "-m", "bsm", "view", str(stream), str(stream), "--no-open"]
    with subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as server:
        try:
            assert server.stdout
            address = server.stdout.readline().strip()
            answer = urllib.request.urlopen(address)
            page = answer.read().decode()
            script = page.rpartition('<script type="module">')[2].rpartition("</script>")[0]
            digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
            assert f"'sha256-{digest}'" in answer.headers["Content-Security-Policy"]
            assert answer.headers["X-Frame-Options"] == "DENY"
            entries = listed(page)
            assert [entry["name"] for entry in entries] == ["good-chain.bsm", "good-chain.bsm (2)"]
            assert "AGFzbQ" not in page and int(answer.headers["Content-Length"]) == len(page.encode())
            for path, accepted, packed in (
                ("", "br, gzip", True),
                ("", "gzip;q=0", False),
                ("small.wasm", "gzip", True),
            ):
                request = urllib.request.Request(address + path, headers={"Accept-Encoding": accepted})
                answer = urllib.request.urlopen(request)
                data = answer.read()
                assert (answer.headers["Content-Encoding"] == "gzip") == packed
                assert len(data) == int(answer.headers["Content-Length"])
                data = gzip.decompress(data) if packed else data
                assert data == ((WEB / "built" / path).read_bytes() if path else page.encode())
            assert urllib.request.urlopen(address + entries[1]["url"].lstrip("/")).read() == stream.read_bytes()
            with pytest.raises(urllib.error.HTTPError, match="404"):
                urllib.request.urlopen(address + "2")
            elsewhere = urllib.request.Request(address, headers={"Host": "example.org"})
            with pytest.raises(urllib.error.HTTPError, match="403"):
                urllib.request.urlopen(elsewhere)
        finally:
            server.terminate()


def test_late_joiners_enter_at_the_newest_group():
    whole = bsm.encode_sequence(*moving(18), gop=6, low_delay=6)
    *_, second, third, _ = frame_ends(whole)
    growing = Growing("sway.bsm")
    growing.take(whole[: second + 3])
    late = growing.chunks()
    head = next(late)
    assert len(head) < second
    growing.receive([whole[second + 3 : third], whole[third:]])
    everything, lost = frames_sent(whole)
    assert lost == []
    frames, lost = frames_sent(head + b"".join(late))
    assert lost == [6]
    np.testing.assert_array_equal(frames, everything[6:])
    assert sent_to(growing) == whole


def test_late_joiners_enter_at_the_run_of_a_mesh_of_its_own():
    positions, faces = moving(4)
    kept = faces[(positions[0][faces, 2] > 0.0).all(axis=1)]
    half, few = np.unique(kept, return_inverse=True)
    small, few = positions[:, half], few.reshape(-1, 3).astype(np.int32)
    meshes = [bsm.TriangleMesh(p.astype(float), f) for ps, f in ((positions, faces), (small, few)) for p in ps]
    whole = bsm.encode_frames(meshes, frame_rate=12, step=0.002)
    growing = Growing("halves.bsm")
    growing.take(whole[:-1])
    late = growing.chunks()
    head = next(late)
    growing.take(whole[-1:])
    frames, lost = frames_sent(head + b"".join(late))
    assert 0 < len(half) < positions.shape[1]
    assert [len(frame) for frame in frames] == [len(half)] * 4
    assert lost == [4]
    assert b"frame_rate" in head


def test_pages_that_have_gone_are_let_go_of(monkeypatch):
    monkeypatch.setattr("bsm.viewer.page._PATIENCE", 0.05)
    growing = Growing("sway.bsm")
    growing.take(MAGIC)
    with PageServer([growing]) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        before = threading.active_count()
        pages = [socket.create_connection(server.server_address) for _ in range(5)]
        for page in pages:
            page.sendall(f"GET /0 HTTP/1.0\r\nHost: {server.host}\r\n\r\n".encode())
            assert page.recv(15) == b"HTTP/1.0 200 OK"
        assert threading.active_count() == before + 5
        for page in pages[1:]:
            page.close()
        end = time.monotonic() + 30
        while threading.active_count() > before + 1 and time.monotonic() < end:
            time.sleep(0.05)
        assert threading.active_count() == before + 1, "one is still there"
        pages[0].close()
        server.shutdown()


def test_what_is_damaged_is_sent_from_its_beginning():
    whole = bytearray(bsm.encode_sequence(*moving(18), gop=6, step=0.002))
    place = frame_ends(bytes(whole))[-3]
    whole[place : place + 5] = b"\xff" * 5  # a tag that none can be
    growing = Growing("sway.bsm")
    growing.take(bytes(whole))
    assert next(growing.chunks()) == bytes(whole)


def test_a_file_that_is_begun_again_has_ended(tmp_path):
    path = tmp_path / "sway.bsm"
    path.write_bytes(b"abcdef")
    chunks = written_to(path.open("rb"))
    assert next(chunks) == b"abcdef"
    with path.open("ab") as file:
        file.write(b"gh")
    assert next(chunks) == b"gh"
    path.write_bytes(b"ab")
    assert list(chunks) == []


def test_following_needs_no_whole(tmp_path, capsys):
    for more in (["--save", str(tmp_path / "page.html")], ["--original", "ball.ply"]):
        assert main(["view", "--follow", str(VECTORS / "good-chain.bsm"), *more]) == 2
        assert "--follow" in capsys.readouterr().err


@pytest.mark.slow
@needs_packages
@pytest.mark.parametrize("way", ["file", "pipe"])
def test_what_is_still_being_written_is_watched(way, tmp_path):
    whole = bsm.encode_sequence(*moving(18), gop=6, low_delay=6, frame_rate=30)
    stream, growing = tmp_path / "whole.bsm", tmp_path / "growing.bsm"
    stream.write_bytes(whole)
    *_, first, _, _, _ = frame_ends(whole)
    os.mkfifo(growing) if way == "pipe" else growing.write_bytes(whole[:first])
    inputs = ["-"] if way == "pipe" else ["--follow", str(growing)]
    command = [sys.executable, "-m", "bsm", "view", "--no-open", *inputs]
    source = os.open(growing, os.O_RDWR) if way == "pipe" else None
    quiet: Any = {"stdin": source, "stdout": subprocess.PIPE, "stderr": subprocess.DEVNULL, "text": True}
    with subprocess.Popen(command, **quiet) as server:
        try:
            if source is not None:
                os.write(source, whole[:first])
            assert server.stdout
            address = server.stdout.readline().strip()
            live = {"address": address, "whole": str(stream), "growing": str(growing), "ends": frame_ends(whole)[-4:]}
            javascript("live", BSM_LIVE=json.dumps(live))
        finally:
            server.terminate()
            if source is not None:
                os.close(source)


@pytest.mark.slow
@needs_packages
def test_tiles_are_seen_coarse_first_and_fine_from_near(tmp_path):
    bsm.save(curved(torus(300, 200)), tmp_path / "a.ply")
    folder = tmp_path / "tiles"
    options = ["--grid-cell", "1e-5", "--triangles", "4000"]
    assert main(["tile", str(tmp_path / "a.ply"), "-o", str(folder), *options]) == 0
    for name, content in (("plain", "none"), ("coded", "bsm")):
        (folder / name).mkdir()
        tileset = str(folder / name / "tileset.json")
        assert main(["untile", str(folder), "-o", tileset, "--content", content]) == 0
    levels = bsm.open_tiles(str(folder)).manifest["levels"]
    command = [sys.executable, "-m", "bsm", "view", "--no-open", str(folder)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as server:
        try:
            assert server.stdout
            seen = {"address": server.stdout.readline().strip(), "folder": str(folder)}
            seen |= {"coarsest": levels[0]["faces"], "faces": 120_000}
            javascript("tiles", BSM_TILES=json.dumps(seen))
        finally:
            server.terminate()


@pytest.mark.parametrize(
    ("asked", "code"),
    [
        ("bytes=0-9", 206),
        ("bytes=5-2", 416),
        ("", 416),
        ("bytes=0-99999999", 416),
        ("bytes=-5", 416),
        ("lines=1-2", 416),
    ],
)
def test_files_are_sent_by_ranges(tmp_path, asked, code):
    (tmp_path / "a").write_bytes(b"0123456789abcdef")
    files = {"manifest.json": b"{}", "a": Ranged(str(tmp_path / "a"), 16)}
    with PageServer([Tiled("some", files)]) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        request = urllib.request.Request(f"http://{server.host}/0/a", headers={"Range": asked} if asked else {})
        try:
            with urllib.request.urlopen(request) as answer:
                assert (answer.status, answer.read()) == (code, b"0123456789")
        except urllib.error.HTTPError as error:
            assert error.code == code
        (tmp_path / "a").unlink()
        with pytest.raises(urllib.error.HTTPError, match="No such file" if code == 206 else str(code)):
            urllib.request.urlopen(request)
        server.shutdown()


def test_tiles_are_looked_at_alone(tmp_path, capsys):
    (tmp_path / "manifest.json").write_text("{}")
    for more in (["--save", str(tmp_path / "page.html")], ["--original", "ball.ply"], ["--follow"]):
        assert main(["view", "--no-open", str(tmp_path), *more]) == 2
        assert "come by ranges" in capsys.readouterr().err


def javascript(tests: str, **environment: str) -> None:
    command = ["node", "scripts/test.mjs", tests]
    run = subprocess.run(
        command, cwd=WEB, env=os.environ | environment, capture_output=True, text=True, timeout=300, check=False
    )
    assert run.returncode == 0, run.stdout + run.stderr


def test_original_is_numbered_as_the_stream(tmp_path):
    mesh = torus()
    source, stream, page = tmp_path / "ball.ply", tmp_path / "ball.bsm", tmp_path / "page.html"
    bsm.save(mesh, source)
    stream.write_bytes(bsm.encode(mesh))
    assert main(["view", str(stream), "--original", str(source), "--save", str(page)]) == 0
    (entry,) = listed(page.read_text("utf-8"))
    original = np.frombuffer(base64.b64decode(entry["original"]["data"]), "<f4").reshape(-1, 3)
    decoded = bsm.decode(stream)
    here, there = bsm.compare((original, decoded.faces), decoded), bsm.compare(mesh, decoded)
    assert astuple(here)[:-1] == pytest.approx(astuple(there)[:-1], rel=1e-3)  # attributes aside: there are none


def test_draco_beside_it_keeps_the_normals_as_well(tmp_path):
    pytest.importorskip("DracoPy")
    mesh = torus()
    data = bsm.encode(mesh, theta=5)
    draco = compared("ball", data, mesh).draco
    assert draco
    assert draco.theta <= bsm.compare(mesh, data).theta_deg
    assert 100 < draco.bytes == len(encode_draco(in_order(data, mesh), draco.bits, DRACO_LEVEL))


def test_what_draco_does_not_take_is_shown_without_it():
    pytest.importorskip("DracoPy")
    line = bsm.TriangleMesh(np.eye(3), np.array([[0, 1, 1]], np.int32))
    with pytest.raises(bsm.MeshError, match="Draco does not take"):
        encode_draco(line, 11, DRACO_LEVEL)
    assert compared("line", bsm.encode(line), line).draco is None


def in_order(data: bytes, mesh: bsm.TriangleMesh) -> bsm.TriangleMesh:
    original = compared("ball", data, mesh).original
    assert original is not None
    return bsm.TriangleMesh(original.astype(float), bsm.decode(data).faces)


def test_what_is_neither_stream_nor_mesh_is_refused(tmp_path, capsys):
    (tmp_path / "ball.txt").write_text("round")
    assert main(["view", str(tmp_path / "ball.txt"), "--save", str(tmp_path / "page.html")]) != 0
    assert "ball.txt" in capsys.readouterr().err
    assert not (tmp_path / "page.html").exists()


def test_original_of_a_sequence_is_refused(tmp_path, capsys):
    stream, mesh = str(VECTORS / "good-sequence-one.bsm"), str(tmp_path / "ball.ply")
    bsm.save(torus(), mesh)
    assert main(["view", stream, "--original", mesh, "--save", "unused.html"]) != 0
    assert "sequence" in capsys.readouterr().err
    assert main(["view", stream, stream, "--original", mesh, "--save", "unused.html"]) != 0
    assert "one input" in capsys.readouterr().err


def told_by_python(data: bytes, kind: type[bsm.Decoder | bsm.SequenceDecoder]) -> dict[str, Any]:
    """Events of a tolerant decoder, as far as it comes, and the name of the error that it ends with."""
    events: list[list[Any]] = []
    with kind(bsm.Limits(work=1e10), tolerant=True) as decoder:
        decoder.receive_data(data)
        decoder.receive_eof()
        try:
            while (event := decoder.next_event()) is not bsm.END_OF_STREAM:
                if not isinstance(event, bsm.AttributeEvent):
                    events.append(essence(event))
        except bsm.BsmError as error:
            return {"events": events, "error": type(error).__name__}
    return {"events": events, "error": None}


def essence(event: Any) -> list[Any]:
    match event:
        case bsm.ConnectivityEvent():
            return ["connectivity", len(event.faces), event.vertices]
        case bsm.BlockEvent():
            return ["block", event.index, len(event.vertices)]
        case bsm.RefinementEvent():
            return ["refinement", len(event.vertices)]
        case bsm.FrameEvent():
            return ["frame", event.index]
        case bsm.LossEvent():
            frames = event.frames
            return ["loss", event.block, frames.start, len(frames), type(event.error).__name__]
        case bsm.EndEvent():
            return ["end", *(sorted(map(int, part)) for part in (event.losses.missing, event.losses.degraded))]
    return [type(event).__name__.removesuffix("Event").lower()]


DAMAGED = {
    bsm.Decoder: [
        "labels",
        "keys",
        "layer-chunks",
        "refined",
        "grid-chunks",
        "smoothing",
        "splits-seams",
        "attribute-colors",
        "attribute-uv-blocks",
        "attribute-split",
        "skippable",
    ],
    bsm.SequenceDecoder: [
        "sequence-overlap",
        "sequence-learnt",
        "sequence-low-delay",
        "sequence-runs",
        "sequence-runs-low-delay",
        "sequence-runs-many",
    ],
}


@needs_packages
def test_damage_is_survived_as_in_python(tmp_path):
    random = np.random.default_rng(16)
    for number in range(160):
        kind = bsm.SequenceDecoder if number % 4 == 0 else bsm.Decoder
        whole = (VECTORS / f"good-{random.choice(DAMAGED[kind])}.bsm").read_bytes()
        data, starts = bytearray(whole), frame_ends(whole)[1:-1]
        for _ in range(random.integers(1, 3)):
            at = random.integers(20, len(data))
            if random.random() < 0.2 and len(data) == len(whole):
                at = random.choice(starts)  # a frame that seems to be one of another type
                data[at] = data[at] & 0xF0 | random.integers(16)
            elif random.random() < 0.2:
                del data[at : at + random.integers(1, 30)]
            elif at < len(data):
                data[at] ^= random.integers(1, 256)
        (tmp_path / f"{number}.bsm").write_bytes(data)
        (tmp_path / f"{number}.json").write_text(json.dumps(told_by_python(bytes(data), kind)))
    javascript("recovery", BSM_DAMAGED=str(tmp_path))


@pytest.mark.slow
@needs_packages
@pytest.mark.real
def test_real_sequence_plays(meshes, tmp_path):
    with np.load(meshes / "dynamic" / "horse_gallop.npz") as arrays:
        positions, faces = arrays["positions"][:16], arrays["faces"]
    stream = tmp_path / "horse.bsm"
    stream.write_bytes(bsm.encode_sequence(positions, faces, gop=8, frame_rate=25))
    javascript("browser", BSM_SEQUENCE=str(stream))
