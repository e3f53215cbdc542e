"""bsm view: the page with streams in it, and the server that has them beside it."""

import base64
import gzip
import hashlib
import json
import multiprocessing
import os
import re
import select
import shutil
import socket
import stat
import subprocess
import sys
import threading
import time
import urllib.error
import urllib.parse
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import replace
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bsm
from bsm.cli import main
from bsm.codec.geometry.metrics import distances_to_surface
from bsm.codec.static.presets import SEQUENCE_ROWS
from bsm.evaluation.curve import decode_draco, encode_draco
from bsm.viewer.contents import DRACO_BITS, DRACO_LEVEL, Content, Shown, compared, uploaded
from bsm.viewer.page import MOST_BYTES, UPLOAD, Arrival, PageServer, Ranged, Tiled, written_to
from tests.motion import bending, sequence_in
from tests.shapes import curved, torus
from tests.streams import all_events, frame_ends, moving_events_of
from tools.pictures import pages

needs_packages = pytest.mark.skipif(
    shutil.which("node") is None or not (Path(__file__).parents[2] / "web/node_modules").is_dir(),
    reason="no packages: npm ci in web, with node",
)
ROOT = Path(__file__).parents[2]
VECTORS = ROOT / "spec" / "vectors" / "1.0"
WEB = ROOT / "web"
SLOT = re.compile(r'<script type="application/json" id="bsm-streams">(.*?)</script>', re.DOTALL)


def frames_sent(data: bytes) -> tuple[list[np.ndarray], list[int]]:
    """Frames of a stream that may begin late, and how many are missing where."""
    events = moving_events_of(data, tolerant=True)
    lost = [len(event.frames) for event in events if isinstance(event, bsm.LossEvent)]
    return [event.positions for event in events if isinstance(event, bsm.FrameEvent)], lost


@contextmanager
def serving(*content: Any) -> Iterator[PageServer]:
    """A server of a page, in a thread of its own."""
    with PageServer([*content]) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield server
        server.shutdown()


@contextmanager
def viewed(*words: str, source: int | None = None) -> Iterator[str]:
    """The address that `bsm view` prints, in a process of its own."""
    command = [sys.executable, "-m", "bsm", "view", "--no-open", *words]
    quiet: Any = {
        "stdin": source,
        "stdout": subprocess.PIPE,
        "stderr": subprocess.DEVNULL,
        "text": True,
    }
    with subprocess.Popen(command, cwd=ROOT, **quiet) as server:
        try:
            assert server.stdout
            yield server.stdout.readline().strip()
        finally:
            server.terminate()


def listed(page: str) -> list[dict[str, Any]]:
    found = SLOT.search(page)
    assert found
    return list(json.loads(found[1]))


def test_saved_page_holds_the_streams(tmp_path):
    stream = tmp_path / "<script>.bsm"
    shutil.copy(VECTORS / "good-chain.bsm", stream)
    page = tmp_path / "page.html"
    assert (
        main(["view", str(stream), str(VECTORS / "good-tetrahedron.bsm"), "--save", str(page)]) == 0
    )
    first, second = listed(page.read_text("utf-8"))
    assert first["name"] == stream.name and second["name"] == "good-tetrahedron.bsm"
    assert base64.b64decode(first["layers"][0]["data"]) == stream.read_bytes()


def test_meshes_are_encoded_and_shown_beside_their_original(tmp_path, capsys):
    mesh, source, page = torus(), tmp_path / "ball.ply", tmp_path / "page.html"
    bsm.save(mesh, source)
    assert main(["view", str(source), "--preset", "fine", "--save", str(page)]) == 0
    (entry,) = listed(page.read_text("utf-8"))
    first, ours = entry["layers"][:2]
    stream = base64.b64decode(ours["data"])
    assert (
        entry["main"] == 1
        and ours["title"] == "BSM"
        and stream == bsm.encode(source, preset="fine")
    )
    assert first["size"] == source.stat().st_size
    exact = bsm.decode(base64.b64decode(first["data"]))
    assert sorted(map(tuple, exact.positions)) == sorted(
        map(tuple, mesh.positions.astype(np.float32).astype(float))
    )
    assert entry["facts"]["promised"] == {"look": 0.5, "farthest": 0.005}
    assert entry["facts"]["look"] <= 0.5 and 0.0 < entry["facts"]["farthest"] <= 0.005
    assert f"{len(stream)} bytes as a stream" in capsys.readouterr().err


def test_scenes_of_ours_are_shown_as_they_are_and_not_encoded_again(tmp_path, capsys):
    source, small, page = tmp_path / "ball.glb", tmp_path / "small.glb", tmp_path / "page.html"
    bsm.save(torus(), source)
    assert main(["glb", str(source), "-o", str(small)]) == 0
    plain, obj = tmp_path / "plain.glb", tmp_path / "plain.obj"
    capsys.readouterr()
    for output in (plain, obj):
        assert main(["decode", str(small), "-o", str(output)]) == 0
    assert main(["view", str(small), "--save", str(page)]) == 0
    words = capsys.readouterr().err
    # Nothing is encoded, so no errors add up.
    assert "errors add up" not in words and "as a stream" not in words
    (entry,) = listed(page.read_text("utf-8"))
    (layer,) = entry["layers"]
    assert (entry["main"], layer["title"], layer["size"]) == (0, "GLB", small.stat().st_size)
    shown, decoded = bsm.decode(base64.b64decode(layer["data"])), bsm.load(plain)
    assert sorted(map(tuple, shown.positions)) == sorted(map(tuple, decoded.positions))
    *_, content = uploaded([("small.glb", small.read_bytes())], "small")
    assert [each.title for each in content.layers] == ["GLB"] and content.layers[0].size == layer[
        "size"
    ]


def test_a_scene_that_wraps_a_sequence_is_shown_by_its_own_stream(tmp_path):
    positions, faces = bending(4)
    stream = bsm.encode_sequence(positions, faces)
    (tmp_path / "sway.bsm").write_bytes(stream)
    assert main(["glb", str(tmp_path / "sway.bsm"), "-o", str(tmp_path / "sway.glb")]) == 0
    assert main(["view", str(tmp_path / "sway.glb"), "--save", str(tmp_path / "page.html")]) == 0
    (entry,) = listed((tmp_path / "page.html").read_text("utf-8"))
    assert [base64.b64decode(layer["data"]) for layer in entry["layers"]] == [stream]


@pytest.mark.parametrize(
    ("scale", "offset"),
    [
        (1.0, (500123.0, 4649776.0, 1600.0)),
        (1e-3, (2e7, 0.0, -3e7)),
        (1e29, (0.0, 0.0, 0.0)),
        (1e-41, (0.0, 0.0, 0.0)),
    ],
)
def test_what_encode_takes_is_shown_beside_an_original_finer_than_single_precision(
    scale, offset, tmp_path
):
    mesh = torus()
    mesh = replace(mesh, positions=mesh.positions * scale + offset)
    content = compared("far", bsm.encode(mesh), mesh)
    original = bsm.decode(content.layers[0].stream)
    apart = np.abs(np.sort(original.positions, axis=0) - np.sort(mesh.positions, axis=0)).max()
    assert apart <= 2.0**-20 * np.ptp(mesh.positions, axis=0).max()
    source, page = tmp_path / "far.npz", tmp_path / "page.html"
    np.savez(source, positions=[mesh.positions, mesh.positions], faces=mesh.faces)
    assert main(["view", str(source), "--save", str(page)]) == 0


def test_a_stream_by_name_alone_is_refused_as_one(tmp_path, capsys):
    path = tmp_path / "junk.bsm"
    path.write_bytes(b"junk")
    assert main(["view", str(path), "--save", str(tmp_path / "page.html")]) != 0
    assert "not a BSM stream" in capsys.readouterr().err


def test_crease_angle_is_told_to_every_page(tmp_path, capsys):
    stream, saved, site = str(VECTORS / "good-chain.bsm"), tmp_path / "page.html", tmp_path / "site"
    with viewed(stream, "--crease-angle", "30") as address:
        pages = [urllib.request.urlopen(address).read().decode()]
    for output in ("--save", str(saved)), ("--static", str(site)):
        assert main(["view", stream, "--crease-angle", "30", *output]) == 0
    pages += [saved.read_text("utf-8"), (site / "index.html").read_text("utf-8")]
    assert all('"creaseAngle": 30.0' in page for page in pages)
    assert main(["view", stream, "-f", "--save", str(saved)]) == 0
    assert '"creaseAngle":' not in saved.read_text("utf-8")


@pytest.mark.parametrize("angle", ["-1", "180.5", "nan"])
def test_crease_angles_without_a_meaning_are_refused(angle, tmp_path, capsys):
    stream = str(VECTORS / "good-chain.bsm")
    assert (
        main(["view", stream, f"--crease-angle={angle}", "--save", str(tmp_path / "page.html")])
        == 2
    )
    assert "the crease angle must be from 0" in capsys.readouterr().err


def test_the_page_offers_the_presets_that_its_server_takes():
    with viewed() as address:
        page = urllib.request.urlopen(address).read().decode()
    (names,) = re.findall(r'"presets": (\[[^]]*\])', page)
    first, *others = json.loads(names)
    assert first == "balanced"
    assert {first, *others} == {row.name for row in SEQUENCE_ROWS}


def test_server_has_the_page_and_its_streams():
    stream = VECTORS / "good-chain.bsm"
    with viewed(str(stream), str(stream)) as address:
        answer = urllib.request.urlopen(address)
        page = answer.read().decode()
        script = page.partition('<script type="module">')[2].rpartition("</script>")[0]
        digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
        assert f"'sha256-{digest}'" in answer.headers["Content-Security-Policy"]
        assert answer.headers["X-Frame-Options"] == "DENY"
        entries = listed(page)
        assert [entry["name"] for entry in entries] == ["good-chain.bsm", "good-chain.bsm (2)"]
        assert "AGFzbQ" not in page and int(answer.headers["Content-Length"]) == len(page.encode())
        for path, accepted, packed in (
            ("", "br, gzip", True),
            ("", "gzip;q=0", False),
            ("grid.wasm", "gzip", True),
        ):
            request = urllib.request.Request(address + path, headers={"Accept-Encoding": accepted})
            answer = urllib.request.urlopen(request)
            data = answer.read()
            assert (answer.headers["Content-Encoding"] == "gzip") == packed
            assert len(data) == int(answer.headers["Content-Length"])
            data = gzip.decompress(data) if packed else data
            assert data == ((WEB / "built" / path).read_bytes() if path else page.encode())
        assert (
            urllib.request.urlopen(address + entries[1]["layers"][0]["url"]).read()
            == stream.read_bytes()
        )
        with pytest.raises(urllib.error.HTTPError, match="404"):
            urllib.request.urlopen(address + "2")
        elsewhere = urllib.request.Request(address, headers={"Host": "example.org"})
        root = address[: address.index("/", 8) + 1]
        for strange in (
            elsewhere,
            root,
            f"{root}0",
            f"{root}%C3%A4/",
            address.rstrip("/")[:-1] + "/",
        ):
            with pytest.raises(urllib.error.HTTPError, match="403"):
                urllib.request.urlopen(strange)


def test_late_joiners_enter_at_the_newest_group():
    whole = bsm.encode_sequence(*bending(18), gop=6, low_delay=6)
    *_, second, third, _ = frame_ends(whole)
    growing = Arrival("sway.bsm")
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
    assert b"".join(growing.chunks()) == whole


def test_late_joiners_enter_at_the_run_of_a_mesh_of_its_own():
    positions, faces = bending(4)
    kept = faces[(positions[0][faces, 2] > 0.0).all(axis=1)]
    half, few = np.unique(kept, return_inverse=True)
    small, few = positions[:, half], few.reshape(-1, 3).astype(np.int32)
    meshes = [
        bsm.TriangleMesh(p.astype(float), f)
        for ps, f in ((positions, faces), (small, few))
        for p in ps
    ]
    whole = bsm.encode_frames(meshes, frame_rate=12, step=0.002)
    growing = Arrival("halves.bsm")
    growing.take(whole[:-1])
    late = growing.chunks()
    head = next(late)
    growing.take(whole[-1:])
    frames, lost = frames_sent(head + b"".join(late))
    assert 0 < len(half) < positions.shape[1]
    assert [len(frame) for frame in frames] == [len(half)] * 4
    assert lost == [4]
    assert b"frame_rate" in head


def test_pages_that_have_gone_are_let_go_of():
    growing = Arrival("sway.bsm")
    growing.take(b"\x89BSM")
    with serving(growing) as server:
        before = threading.active_count()
        pages = [socket.create_connection(server.server_address) for _ in range(5)]
        for page in pages:
            page.sendall(f"GET /{server.token}/0 HTTP/1.0\r\nHost: {server.host}\r\n\r\n".encode())
            assert page.recv(15) == b"HTTP/1.0 200 OK"
        assert threading.active_count() == before + 5
        for page in pages[1:]:
            page.close()
        end = time.monotonic() + 30
        while threading.active_count() > before + 1 and time.monotonic() < end:
            time.sleep(0.05)
        assert threading.active_count() == before + 1, "one is still there"
        pages[0].close()


def test_what_is_damaged_is_sent_from_its_beginning():
    whole = bytearray(bsm.encode_sequence(*bending(18), gop=6, step=0.002))
    place = frame_ends(bytes(whole))[-3]
    whole[place : place + 5] = b"\xff" * 5  # a tag that none can be
    growing = Arrival("sway.bsm")
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


def test_command_line_of_the_browser_has_no_token(tmp_path):
    (folder := tmp_path / os.fsdecode(b'a b#?%20"\xff')).mkdir()
    browser = tmp_path / "browser"
    browser.write_text(
        f'#!/bin/sh\necho "$1" > {tmp_path}/asked\ncp -p "$TMPDIR"/*/view.html {tmp_path}\n'
    )
    browser.chmod(0o700)
    code = (
        "from bsm.viewer.page import in_browser\nwith in_browser('http://127.0.0.1:1/token/'): pass"
    )
    variables = {**os.environ, "BROWSER": f"{browser} %s", "TMPDIR": str(folder)}
    subprocess.run([sys.executable, "-c", code], env=variables, check=True)
    asked = (tmp_path / "asked").read_text().strip()
    assert stat.S_IMODE((tmp_path / "view.html").stat().st_mode) == 0o600 and "token" not in asked
    place = urllib.parse.unquote_to_bytes(asked)
    assert place.startswith(b"file://" + os.fsencode(folder)) and place.endswith(b"/view.html")
    assert 'url=http://127.0.0.1:1/token/"' in (tmp_path / "view.html").read_text()
    assert not list(folder.iterdir())


@pytest.mark.parametrize(
    "more", [("--save", "page.html"), ("--original", "ball.ply"), ("--follow",)]
)
def test_what_grows_and_tiles_are_looked_at_alone(tmp_path, capsys, more):
    if more != ("--follow",):
        assert main(["view", "--follow", str(VECTORS / "good-chain.bsm"), *more]) == 2
        assert "--follow" in capsys.readouterr().err
    (tmp_path / "manifest.json").write_text("{}")
    assert main(["view", "--no-open", str(tmp_path), *more]) == 2
    assert "loaded on demand" in capsys.readouterr().err


@pytest.mark.slow
@needs_packages
@pytest.mark.parametrize("way", ["file", "pipe"])
def test_what_is_still_being_written_is_watched(way, tmp_path):
    whole = bsm.encode_sequence(*bending(18), gop=6, low_delay=6, frame_rate=30)
    stream, growing = tmp_path / "whole.bsm", tmp_path / "growing.bsm"
    stream.write_bytes(whole)
    *_, first, _, _, _ = frame_ends(whole)
    os.mkfifo(growing) if way == "pipe" else growing.write_bytes(whole[:first])
    inputs = ["-"] if way == "pipe" else ["--follow", str(growing)]
    source = os.open(growing, os.O_RDWR) if way == "pipe" else None
    if source is not None:
        os.write(source, whole[:first])
    with viewed(*inputs, source=source) as address:
        live = {
            "address": address,
            "whole": str(stream),
            "growing": str(growing),
            "ends": frame_ends(whole)[-4:],
        }
        javascript("live", BSM_LIVE=json.dumps(live))
    if source is not None:
        os.close(source)


def test_tiles_are_files_of_a_page_for_any_server(tmp_path):
    bsm.save(torus(30, 20), tmp_path / "a.ply")
    folder, site = tmp_path / "tiles", tmp_path / "site"
    assert (
        main(
            [
                "tile",
                str(tmp_path / "a.ply"),
                "-o",
                str(folder),
                "--grid-cell",
                "0.01",
                "--triangles",
                "400",
            ]
        )
        == 0
    )
    assert main(["view", str(folder), "--static", str(site)]) == 0
    assert '"tiles": "0"' in (site / "index.html").read_text()
    shards = [path.name for path in folder.glob("*.tiles")]
    assert shards and all(
        (site / "0" / name).read_bytes() == (folder / name).read_bytes() for name in shards
    )
    assert json.loads((site / "0/manifest.json").read_text()) == json.loads(
        (folder / "manifest.json").read_text()
    )


@pytest.mark.slow
@needs_packages
def test_tiles_are_seen_coarse_first_and_fine_from_near(tmp_path):
    bsm.save(curved(torus(300, 200)), tmp_path / "a.ply")
    folder = tmp_path / "tiles"
    options = ["--grid-cell", "1e-5", "--triangles", "4000"]
    assert main(["tile", str(tmp_path / "a.ply"), "-o", str(folder), *options]) == 0
    for name, content in (("plain", "plain"), ("coded", "bsm")):
        (folder / name).mkdir()
        tileset = str(folder / name / "tileset.json")
        assert main(["untile", str(folder), "-o", tileset, "--content", content]) == 0
    levels = bsm.open_tiles(str(folder)).manifest["levels"]
    with viewed(str(folder)) as address:
        seen = {
            "address": address,
            "folder": str(folder),
            "coarsest": levels[0]["faces"],
            "faces": 120_000,
        }
        javascript("tiles", BSM_TILES=json.dumps(seen))


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
    files = {"manifest.json": b"{}", "a": Ranged(str(tmp_path), "a", 16)}
    with serving(Tiled("some", files)) as server:
        request = urllib.request.Request(
            f"{server.address}0/a", headers={"Range": asked} if asked else {}
        )
        try:
            with urllib.request.urlopen(request) as answer:
                assert (answer.status, answer.read()) == (code, b"0123456789")
        except urllib.error.HTTPError as error:
            assert error.code == code
        (tmp_path / "a").unlink()
        with pytest.raises(
            urllib.error.HTTPError, match="No such file" if code == 206 else str(code)
        ):
            urllib.request.urlopen(request)


def javascript(tests: str, **environment: str) -> None:
    command = ["node", "scripts/test.mjs", tests]
    run = subprocess.run(
        command,
        cwd=WEB,
        env=os.environ | environment,
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert run.returncode == 0, run.stdout + run.stderr


def test_any_two_inputs_are_compared_as_they_are(tmp_path):
    mesh, other = torus(), torus(60, 40)
    bsm.save(mesh, tmp_path / "a.ply")
    bsm.save(other, tmp_path / "b.obj")
    for name, preset in (("a", "fine"), ("b", "small")):
        (tmp_path / f"{name}.bsm").write_bytes(bsm.encode(mesh, preset=preset))

    def shown(which: str, original: str) -> dict[str, Any]:
        page = tmp_path / "page.html"
        assert (
            main(
                [
                    "view",
                    str(tmp_path / which),
                    "--original",
                    str(tmp_path / original),
                    "-f",
                    "--save",
                    str(page),
                ]
            )
            == 0
        )
        (entry,) = listed(page.read_text("utf-8"))
        assert entry["main"] == 1
        return dict(entry)

    two = shown("b.bsm", "a.bsm")
    assert base64.b64decode(two["layers"][0]["data"]) == (tmp_path / "a.bsm").read_bytes()
    there = bsm.compare(bsm.decode(tmp_path / "a.bsm"), tmp_path / "b.bsm")
    assert (
        two["facts"]["farthest"] == pytest.approx(there.max_error_relative, rel=1e-3)
        and "apart" not in two["facts"]
    )
    assert (
        two["facts"]["angle"] == pytest.approx(there.angle_deg, rel=1e-3)
        and "promised" not in two["facts"]
    )
    off = np.frombuffer(base64.b64decode(two["layers"][1]["off"]["data"]), "<f4")
    assert (off.max(), np.sqrt(np.mean(off**2))) == pytest.approx(
        (there.max_error, there.rms), rel=1e-3
    )
    apart = shown("b.obj", "a.ply")
    assert [layer["title"] for layer in apart["layers"]] == ["Original", "OBJ"]
    assert [layer["size"] for layer in apart["layers"]] == [
        (tmp_path / name).stat().st_size for name in ("a.ply", "b.obj")
    ]
    facts = apart["facts"]
    assert facts["before"] == [len(mesh.positions), len(mesh.faces)] and "angle" not in facts
    off = np.frombuffer(base64.b64decode(apart["layers"][1]["off"]["data"]), "<f4")
    assert (
        len(off) == len(other.positions)
        and 0.0 < off.max() <= facts["farthest"] * facts["diagonal"] * 1.001
    )
    tree = np.linalg.norm(other.positions[:, None] - mesh.positions[None], axis=2).min(axis=1)
    assert off.max() <= tree.max() and 0.0 < facts["apart"] < facts["farthest"]


def test_two_sequences_have_errors_of_vertices_in_each_frame(tmp_path):
    positions, faces = bending(12)
    np.savez(tmp_path / "a.npz", positions=positions, faces=faces)
    (tmp_path / "a.bsm").write_bytes(bsm.encode_sequence(positions, faces, step=0.01))
    page = tmp_path / "page.html"
    arguments = ["--original", str(tmp_path / "a.npz"), "--save", str(page)]
    assert main(["view", str(tmp_path / "a.bsm"), *arguments]) == 0
    (entry,) = listed(page.read_text("utf-8"))
    first, second = entry["layers"]
    off = np.frombuffer(base64.b64decode(second["off"]["data"]), "<f4").reshape(12, -1)
    assert off.max(axis=1) / entry["facts"]["diagonal"] == pytest.approx(
        entry["facts"]["errors"], rel=1e-3
    )
    carried, _ = bsm.decode_sequence(base64.b64decode(first["data"]))
    decoded, _ = bsm.decode_sequence(base64.b64decode(second["data"]))
    assert np.linalg.norm(carried - decoded, axis=2) == pytest.approx(
        off, abs=1e-3 * entry["facts"]["diagonal"]
    )
    fewer = faces[:-40]
    used, index = np.unique(fewer, return_inverse=True)
    cut = {"positions": positions[:, used], "faces": index.reshape(-1, 3).astype(np.int32)}
    np.savez(tmp_path / "b.npz", **cut)
    assert main(["view", str(tmp_path / "b.npz"), *arguments, "-f"]) == 0
    (entry,) = listed(page.read_text("utf-8"))
    assert (
        entry["facts"]["farthest"] == max(entry["facts"]["errors"]) > entry["facts"]["apart"] >= 0.0
    )


def test_draco_beside_it_has_as_many_bytes_and_needs_more_for_the_look():
    pytest.importorskip("DracoPy")
    mesh = torus()
    data = bsm.encode(mesh)
    content = compared("ball", data, mesh)
    assert [layer.title for layer in content.layers] == ["Original", "BSM", "Draco"]
    draco = content.layers[2]
    bits = int(draco.detail.split()[0])
    assert draco.size == len(encode_draco(mesh, bits, DRACO_LEVEL))
    assert draco.size <= len(data) or bits == DRACO_BITS[0]
    assert len(encode_draco(mesh, bits + 1, DRACO_LEVEL)) > len(data)
    carried = bsm.decode(draco.stream)
    assert draco.off is not None and len(draco.off) == len(carried.positions)
    tree = np.linalg.norm(carried.positions[:, None] - mesh.positions[None], axis=2).min(axis=1)
    assert np.all(draco.off >= tree - 1e-6) and draco.off.max() < 0.3
    good = content.facts["draco"]
    files = [encode_draco(mesh, good["bits"] - less, DRACO_LEVEL) for less in (0, 1)]
    looks = [bsm.look(mesh, decode_draco(file)).distance for file in files]
    assert good["bytes"] == len(files[0]) and looks[0] <= content.facts["look"] < looks[1]
    line = bsm.TriangleMesh(np.eye(3), np.array([[0, 1, 1]], np.int32))
    with pytest.raises(bsm.MeshError, match="Draco does not take"):
        encode_draco(line, 11, DRACO_LEVEL)
    assert len(compared("line", bsm.encode(line), line).layers) == 2


def test_notes_are_the_same_in_the_shell_in_python_and_in_the_page(tmp_path, capsys, recwarn):
    path, page = tmp_path / "lined.obj", tmp_path / "page.html"
    path.write_text("o body\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 3 4\nl 1 2\np 4\n")
    assert main(["view", str(path), "--save", str(page)]) == 0
    viewed = capsys.readouterr().err.splitlines()
    (entry,) = listed(page.read_text("utf-8"))
    assert main(["encode", str(path), "-o", str(tmp_path / "lined.bsm")]) == 0
    encoded = capsys.readouterr().err
    recwarn.clear()
    bsm.encode(path)
    warned = [str(warning.message) for warning in recwarn]
    notes = entry["facts"]["notes"]
    assert len(notes) > 0 and all(note in encoded for note in notes)
    assert [f"{path}: {note}" for note in notes] == warned and all(
        any(line in said for said in viewed) for line in warned
    )
    assert entry["facts"]["less"]
    bsm.save(bsm.decode(tmp_path / "lined.bsm"), tmp_path / "other.ply")
    assert (
        main(
            [
                "view",
                str(tmp_path / "other.ply"),
                "--original",
                str(path),
                "--save",
                str(page),
                "-f",
            ]
        )
        == 0
    )
    (entry,) = listed(page.read_text("utf-8"))
    said = capsys.readouterr().err
    assert (
        entry["facts"]["notes"] == [f"lined.obj: {note}" for note in notes]
        and entry["facts"]["less"]
    )
    assert all(note in said for note in entry["facts"]["notes"])


def test_two_files_that_are_sent_are_compared(tmp_path):
    mesh = torus()
    bsm.save(mesh, tmp_path / "a.ply")
    given, stream = (tmp_path / "a.ply").read_bytes(), bsm.encode(mesh, preset="small")
    expected = compared("b.bsm", stream, bsm.load(tmp_path / "a.ply"), size=len(given))
    with serving() as server:
        ours = {
            "Host": server.host,
            "Origin": f"http://{server.host}",
            "Content-Length": str(len(given + stream)),
        }
        query = f"?preset=small&name=a.ply&size={len(given)}&name=b.bsm&size={len(stream)}"
        answer = sent(server, ours, given + stream, query)
        entry = json.loads(answer.splitlines()[-1])["entry"]
        assert (entry["name"], entry["facts"]["look"]) == ("b.bsm", expected.facts["look"])
        shown = [(layer["title"], layer["detail"], layer["size"]) for layer in entry["layers"][:2]]
        assert shown == [("Original", "a.ply", len(given)), ("BSM", "b.bsm", len(stream))]
        assert urllib.request.urlopen(server.address + entry["layers"][1]["url"]).read() == stream
        assert (
            b" 411 " in sent(server, ours, query=query.replace("size=", "size=-")).splitlines()[0]
        )
        swapped = f"?preset=small&name=a.ply&size=9&name=b.bsm&size={len(given + stream) - 9}"
        assert [*json.loads(sent(server, ours, given + stream, swapped).splitlines()[-1])] == [
            "error"
        ]
    frames, faces = bending(5)
    np.savez(tmp_path / "sway.npz", positions=frames, faces=faces)
    *_, mixed = uploaded(
        [("sway.npz", (tmp_path / "sway.npz").read_bytes()), ("b.bsm", stream)], "small"
    )
    assert "both" in mixed["error"]


def test_files_that_belong_together_are_read_together():
    mesh = torus(8, 6)
    vertices = "".join(f"v {x} {y} {z}\n" for x, y, z in mesh.positions.tolist())
    corners = "".join(f"f {a + 1}/1 {b + 1}/1 {c + 1}/1\n" for a, b, c in mesh.faces.tolist())
    obj = f"mtllib looks/a.mtl\nvt 0 0\nusemtl red\n{vertices}{corners}".encode()
    png = base64.b64decode(
        "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNkYPhfDwAChwGA60e6kgAAAABJRU5ErkJggg=="
    )
    sides = [
        ("shop/looks/a.mtl", b"newmtl red\nmap_Kd p.png\n"),
        ("shop/looks/p.png", png),
        ("shop/notes.txt", b""),
    ]
    *_, whole = uploaded([("shop/a.obj", obj), *sides], "small")
    assert isinstance(whole, Content) and whole.name == "a.obj"
    assert (
        bsm.decode(whole.layers[1].stream).metadata["image.0.data"] == png
        and not whole.facts["less"]
    )
    files = {"used": ["a.obj", "a.mtl", "p.png"], "missing": [], "unused": ["notes.txt"]}
    assert {what: whole.facts[what] for what in files} == files
    assert whole.facts["attributes"]["texcoord"]["max_error"] == 0.0
    *_, lone = uploaded([("a.obj", obj), ("../../a.txt", b"")], "small")
    assert (
        isinstance(lone, Content)
        and "image.0.data" not in bsm.decode(lone.layers[1].stream).metadata
    )
    assert lone.facts["missing"] == ["looks/a.mtl"]


def test_frames_that_are_dropped_are_a_sequence(tmp_path):
    for name, count, paths, unused in sequences_to_drop(tmp_path):
        *_, content = uploaded(
            [(Path(path).name, Path(path).read_bytes()) for path in reversed(paths)], "small"
        )
        assert isinstance(content, Content) and content.name.partition("_")[0] == name
        assert len(bsm.decode_sequence(content.layers[1].stream)[0]) == count
        assert (content.facts["unused"], content.facts["missing"]) == ([unused], [])


def test_an_upload_is_encoded_in_a_process_of_its_own(tmp_path):
    bsm.save(torus(), tmp_path / "ball.ply")
    data = (tmp_path / "ball.ply").read_bytes()
    *before, content = uploaded([("../../ball.ply", data)], "small")
    assert (
        isinstance(content, Content)
        and content.name == "ball.ply"
        and content.facts["preset"] == "small"
    )
    assert content.layers[1].stream == bsm.encode(tmp_path / "ball.ply", preset="small")
    shares = [report["share"] for report in before]
    assert shares == sorted(shares) and len({report["stage"] for report in before}) > 2
    *_, last = uploaded([("ball.ply", data[:200])], "small")
    assert [*last] == ["error"] and str(tmp_path) not in last["error"]


def test_an_upload_ends_with_its_page(tmp_path):
    bsm.save(curved(torus(200, 100)), tmp_path / "ball.ply")
    reports = uploaded([("ball.ply", (tmp_path / "ball.ply").read_bytes())], "balanced")
    assert next(reports)["stage"] == "reading" and next(reports)
    (process,) = multiprocessing.active_children()
    reports.close()
    assert not process.is_alive()


def sent(
    server: PageServer,
    head: dict[str, str],
    body: bytes = b"",
    query: str = "?preset=small&name=a.ply",
) -> bytes:
    """What a server answers to an upload."""
    lines = [
        f"POST /{server.token}{UPLOAD}{query} HTTP/1.0",
        *(f"{name}: {value}" for name, value in head.items()),
        "",
        "",
    ]
    with socket.create_connection(server.server_address) as page:
        page.sendall("\r\n".join(lines).encode() + body)
        return b"".join(iter(lambda: page.recv(1 << 16), b""))


def test_uploads_come_from_this_page_alone_and_one_at_a_time(tmp_path, monkeypatch):
    monkeypatch.setattr("bsm.viewer.page._PATIENCE", 0.05)
    bsm.save(torus(), tmp_path / "ball.ply")
    data = (tmp_path / "ball.ply").read_bytes()
    with serving() as server:
        ours = {
            "Host": server.host,
            "Origin": f"http://{server.host}",
            "Content-Length": str(len(data)),
        }
        for changes, code in (
            ({"Origin": "http://example.org"}, 403),
            ({"Origin": "null"}, 403),
            ({"Host": "example.org"}, 403),
            ({"Content-Length": str(MOST_BYTES + 1)}, 413),
            ({"Content-Length": "-1"}, 411),
        ):
            assert f" {code} ".encode() in sent(server, ours | changes).splitlines()[0]
        assert (
            b" 403 "
            in sent(
                server, {name: text for name, text in ours.items() if name != "Origin"}
            ).splitlines()[0]
        )
        assert b" 404 " in sent(server, ours, query="?preset=../etc").splitlines()[0]
        with server.encoding:
            assert b" 503 " in sent(server, ours, data).splitlines()[0]
        # As the page asks.
        answer = sent(server, ours, data, f"?preset=small&size={len(data)}&name=a.ply")
        lines = [json.loads(line) for line in answer.partition(b"\r\n\r\n")[2].splitlines()]
        paths = [layer["url"] for layer in lines[-1]["entry"]["layers"]]
        stream = urllib.request.urlopen(server.address + paths[1]).read()
        assert stream == bsm.encode(tmp_path / "ball.ply", preset="small")
        assert "error" in json.loads(
            sent(server, ours | {"Content-Length": "9"}, b"no mesh, ").splitlines()[-1]
        )


def test_an_upload_that_arrives_slowly_keeps_no_other_one_waiting(tmp_path, monkeypatch):
    monkeypatch.setattr("bsm.viewer.page._UPLOAD_TIME", 1.5)
    bsm.save(torus(), tmp_path / "ball.ply")
    data = (tmp_path / "ball.ply").read_bytes()
    with serving() as server:
        ours = {"Host": server.host, "Origin": f"http://{server.host}"}
        head = [
            f"POST /{server.token}{UPLOAD}?preset=small&name=a.ply HTTP/1.0",
            "Content-Length: 1000",
        ]
        lines = [*head, *(f"{name}: {text}" for name, text in ours.items()), "", "ply"]
        slow = [socket.create_connection(server.server_address) for _ in range(3)]
        for page in slow:
            page.sendall("\r\n".join(lines).encode())
        answer = sent(server, ours | {"Content-Length": str(len(data))}, data)
        assert "entry" in json.loads(answer.splitlines()[-1])
        for page in slow:  # a byte now and then does not keep it alive
            page.settimeout(20)
            with suppress(OSError):
                while page.send(b".") and not select.select([page], [], [], 0.2)[0]:
                    pass
            assert page.recv(1) == b""
            page.close()


def sequences_to_drop(folder: Path) -> list[list[Any]]:
    """Files of a sequence, the name that a page gives it, its number of frames, and a file that it does not need."""
    positions, faces = bending(6)
    np.savez(source := folder / "sway.npz", positions=positions, faces=faces)
    (folder / "notes.txt").write_text("unused")
    assert main(["encode", str(source), "-o", str(folder / "sway.bsm"), "--preset", "fine"]) == 0
    for name in ("leap.glb", "sway.pc2"):
        assert main(["decode", str(folder / "sway.bsm"), "-o", str(folder / name), "-q"]) == 0
    frames = [folder / f"sway_{number}.ply" for number in range(8, 14)]
    for path, frame in zip(frames, positions, strict=True):
        bsm.save(bsm.TriangleMesh(frame.astype(float), faces), path)
    groups = {
        "sway": frames,
        "leap.glb": [folder / "leap.glb"],
        "sway.pc2": [folder / "sway.pc2", folder / "sway.obj"],
    }
    return [
        [name, 6, [*map(str, paths), f"{folder}/notes.txt"], "notes.txt"]
        for name, paths in groups.items()
    ]


def pairs_to_drop(folder: Path, mesh: bsm.TriangleMesh, source: Path) -> list[list[Any]]:
    """Files that a page is to compare, and the row and value of its table: a mesh and its stream, in any order, two
    meshes whose faces are in another order, and two with other faces."""
    stream, back, other = folder / "pair.bsm", folder / "back.ply", folder / "other.obj"
    stream.write_bytes(bsm.encode(mesh, preset="small"))
    bsm.save(bsm.decode(stream), back)
    coarse = torus(60, 40)
    bsm.save(coarse, other)
    far = 100 * bsm.compare(mesh, stream).max_error_relative
    apart = max(
        distances_to_surface(mesh.positions, coarse.positions, coarse.faces).max(),
        distances_to_surface(coarse.positions, mesh.positions, mesh.faces).max(),
    )
    return [
        [[str(source), str(stream)], "Largest vertex error", far],
        [[str(source), str(back)], "Largest vertex error", far],
        [[str(source), str(other)], "Largest surface distance", 100 * apart / mesh.diagonal],
    ]


@pytest.mark.slow
@needs_packages
def test_a_page_of_files_shows_its_mesh_and_encodes_in_browsers(tmp_path):
    mesh, folder = torus(), tmp_path / "dropped"
    folder.mkdir()
    name = "<img src=x onerror=alert(1)>.bsm"
    (tmp_path / name).write_bytes(bsm.encode(mesh))
    assert main(["view", str(tmp_path / name), "--static", str(tmp_path / "site")]) == 0
    assert main(["view", str(tmp_path / name), "--static", str(tmp_path / "site")]) == 9, (
        "nothing is replaced"
    )
    red = np.repeat(np.array([[255, 100, 7]], np.uint8), len(mesh.positions), 0)
    colored = replace(mesh, attributes=(bsm.Attribute("color", red, semantic="color"),))
    files = [tmp_path / f"{suffix}.{suffix}" for suffix in ("ply", "obj", "stl", "glb")]
    for path in files:
        bsm.save(colored if path.suffix in (".ply", ".glb") else mesh, path)
    serve = partial(SimpleHTTPRequestHandler, directory=tmp_path / "site")
    with ThreadingHTTPServer(("127.0.0.1", 0), serve) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        address = f"http://127.0.0.1:{server.server_port}/"
        pairs = pairs_to_drop(tmp_path, mesh, files[0])
        given = {
            "address": address,
            "name": name,
            "files": list(map(str, files)),
            "folder": str(folder),
            "pairs": pairs,
            "moving": sequences_to_drop(tmp_path),
        }
        javascript("static", BSM_STATIC=json.dumps(given))
        server.shutdown()
    for name, frames, *_ in given["moving"]:
        facts = compared(
            name, (folder / f"{name}.bsm").read_bytes(), sequence_in(str(tmp_path / "sway.npz"))
        ).facts
        assert len(facts["errors"]) == frames and 0.0 < facts["farthest"] < (
            1e-4 if name == "sway" else 5e-3
        )
    for path in files:
        decoded = bsm.decode(folder / f"{path.name}.bsm")
        there = bsm.compare(path, decoded)
        assert (
            len(decoded.positions) == len(mesh.positions) and 0.0 < there.max_error_relative < 1e-4
        ), path.name
        if path.suffix in (".ply", ".glb"):
            (ours, theirs) = (
                next(
                    attribute.values[:, :3]
                    for attribute in each.attributes
                    if attribute.name == "color"
                )
                for each in (decoded, bsm.decode(bsm.encode(path)))
            )
            assert {*map(tuple, ours)} == {*map(tuple, theirs)} and (
                path.suffix == ".glb" or (ours == red[0]).all()
            )


@pytest.mark.slow
@needs_packages
def test_a_mesh_that_is_dropped_is_encoded_and_shown(tmp_path):
    bsm.save(torus(), tmp_path / "ball.ply")
    first, _, last = pairs_to_drop(tmp_path, torus(), tmp_path / "ball.ply")
    positions, faces = bending(12)
    np.savez(tmp_path / "sway.npz", positions=positions, faces=faces)
    moving = tmp_path / "sway.bsm"
    moving.write_bytes(bsm.encode_sequence(positions, faces, step=0.01))
    content = compared("sway", moving.read_bytes(), sequence_in(str(tmp_path / "sway.npz")))
    still = compared("other", bsm.encode(tmp_path / "other.obj", preset="lossless"), torus())
    pairs = [
        [first[0][::-1], "pair.bsm", *first[1:]],
        [last[0], "other.obj", last[1], 100 * still.facts["farthest"]],
        [
            [str(moving), str(tmp_path / "sway.npz")],
            "sway.bsm",
            first[1],
            100 * content.facts["farthest"],
        ],
    ]
    with serving() as server:
        given = {"address": server.address, "mesh": str(tmp_path / "ball.ply"), "pairs": pairs}
        javascript("drop", BSM_DROP=json.dumps(given))


@pytest.mark.slow
@needs_packages
def test_a_foreign_page_reads_and_encodes_nothing():
    with serving(
        Content("a.bsm", (Shown("BSM", "", 1, (VECTORS / "good-keys.bsm").read_bytes()),))
    ) as server:
        javascript("foreign", BSM_FOREIGN=server.address)
        assert not [path for path in server.content if path.startswith(UPLOAD)]


def test_what_is_neither_stream_nor_mesh_is_refused(tmp_path, capsys):
    (tmp_path / "ball.txt").write_text("round")
    assert main(["view", str(tmp_path / "ball.txt"), "--save", str(tmp_path / "page.html")]) != 0
    assert "ball.txt" in capsys.readouterr().err
    assert not (tmp_path / "page.html").exists()


@pytest.mark.parametrize("end", [0, -20])
def test_no_page_is_saved_of_a_stream_that_ends_early(end, tmp_path):
    stream = tmp_path / "cut.bsm"
    stream.write_bytes((VECTORS / "good-chain.bsm").read_bytes()[:end])
    assert main(["view", str(stream), "--save", str(tmp_path / "page.html")]) == 12
    assert not (tmp_path / "page.html").exists()


def test_sequences_are_encoded_and_compared_frame_by_frame(tmp_path, capsys):
    frames, faces = bending(7)
    frames = frames.astype(np.float32)
    np.savez(tmp_path / "sway.npz", positions=frames, faces=faces)
    for number, frame in enumerate(frames):
        bsm.save(bsm.TriangleMesh(frame, faces), tmp_path / f"sway_{number}.ply")
    page = tmp_path / "page.html"
    stream = tmp_path / "sway.bsm"
    assert main(["view", str(tmp_path / "sway.npz"), "--save", str(page)]) == 0
    (entry,) = listed(page.read_text("utf-8"))
    stream.write_bytes(base64.b64decode(entry["layers"][1]["data"]))
    capsys.readouterr()
    assert main(["compare", str(tmp_path / "sway.npz"), str(stream), "--json"]) == 0
    expected = [
        frame["max_error_relative"] for frame in json.loads(capsys.readouterr().out)["frames"]
    ]
    facts = entry["facts"]
    assert main(["compare", str(tmp_path / "sway.npz"), str(stream), "--json", "--look"]) == 0
    worst = json.loads(capsys.readouterr().out)["look_worst"]
    assert facts["look"] == pytest.approx(worst, rel=1e-6) and facts["drawn"] == 7, (
        "so few frames are all drawn"
    )
    assert (
        0 < facts["look"] <= facts["promised"]["look"] == 1
        and facts["promised"]["farthest"] == 0.01
    )
    assert (
        facts["errors"] == pytest.approx(expected) and facts["farthest"] == max(facts["errors"]) > 0
    )
    original = str(tmp_path / "sway_%d.ply")
    assert main(["view", str(stream), "--original", original, "--save", str(page), "-f"]) == 0
    assert listed(page.read_text("utf-8"))[0]["facts"]["errors"] == pytest.approx(expected)
    np.savez(tmp_path / "short.npz", positions=frames[:5], faces=faces)
    unused = str(tmp_path / "unused.html")
    assert (
        main(["view", str(stream), "--original", str(tmp_path / "short.npz"), "--save", unused])
        != 0
    )
    assert "7 frames, and its original has 5" in capsys.readouterr().err


def test_original_of_a_sequence_is_refused(tmp_path, capsys):
    stream, mesh = str(VECTORS / "good-sequence-one.bsm"), str(tmp_path / "ball.ply")
    bsm.save(torus(), mesh)
    assert main(["view", stream, "--original", mesh, "--save", "unused.html"]) != 0
    assert "sequence" in capsys.readouterr().err
    assert main(["view", stream, stream, "--original", mesh, "--save", "unused.html"]) != 0
    assert "one input" in capsys.readouterr().err


def events_of_python(data: bytes, kind: type[bsm.Decoder | bsm.SequenceDecoder]) -> dict[str, Any]:
    """Events of a tolerant decoder, as far as it comes, and the name of the error that it ends with."""
    found: dict[str, Any] = {"events": [], "error": None}
    with kind(bsm.Limits(work=1e10), tolerant=True) as decoder:
        try:
            for event in all_events(decoder, [data]):
                found["events"] += [] if isinstance(event, bsm.AttributeEvent) else [essence(event)]
        except bsm.BsmError as error:
            found["error"] = type(error).__name__
    return found


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
            return [
                "end",
                *(sorted(map(int, part)) for part in (event.losses.missing, event.losses.degraded)),
            ]
    return [type(event).__name__.removesuffix("Event").lower()]


STILL = "labels keys layer-chunks refined grid-chunks smoothing splits-seams attribute-colors attribute-split skippable"
MOVING = ("overlap", "learnt", "low-delay", "runs", "runs-low-delay", "runs-many")
DAMAGED = {
    bsm.Decoder: [*STILL.split(), "attribute-uv-blocks"],
    bsm.SequenceDecoder: [f"sequence-{name}" for name in MOVING],
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
        (tmp_path / f"{number}.json").write_text(json.dumps(events_of_python(bytes(data), kind)))
    javascript("recovery", BSM_DAMAGED=str(tmp_path))


@pytest.mark.slow
@needs_packages
@pytest.mark.real
def test_pages_are_drawn_as_in_the_documents(meshes, tmp_path):
    assert all(path.stat().st_size > 10_000 for path in pages(meshes, tmp_path, tmp_path))


@pytest.mark.slow
@needs_packages
@pytest.mark.real
def test_real_sequence_plays(meshes, tmp_path):
    with np.load(meshes / "dynamic" / "horse_gallop.npz") as arrays:
        positions, faces = arrays["positions"][:16], arrays["faces"]
    stream = tmp_path / "horse.bsm"
    stream.write_bytes(bsm.encode_sequence(positions, faces, gop=8, frame_rate=25))
    javascript("browser", BSM_SEQUENCE=str(stream))
