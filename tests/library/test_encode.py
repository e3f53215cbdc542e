"""The encoder in C: the bytes of Python's, promises, errors, memory."""

import ctypes
import re
import shutil
import subprocess
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import bsm
from bsm import Attribute, FrameEvent, TriangleMesh
from tests.library.conftest import linked
from tests.motion import bending
from tests.shapes import boxes, patch, soup, tetrahedron, together, torus
from tests.streams import all_events
from tools import bsmenc
from tools.amalgamate import ROOT
from tools.bsmdec import Entry
from tools.bsmenc import (
    CELLS,
    LOSSLESS,
    PROGRESS,
    STOPPED,
    UNREACHABLE,
    Allocator,
    compiled_whole,
    encode,
    library,
)
from tools.vectors.good_attributes import charts, creases, with_attributes
from tools.vectors.good_repeats import plaited
from tools.vectors.good_swift import tangents

TOUCHING = soup(
    together(torus(9, 7), boxes(*np.ndindex(1, 2, 3)), soup(patch(3, 3)), boxes((1, 0, 0)))
)
PLAITED = plaited(torus(20, 12), 1)
MIXED = TriangleMesh(TOUCHING.positions, np.random.default_rng(2).permutation(TOUCHING.faces))


@pytest.fixture(scope="module")
def encoder():
    return library()


def dressed(mesh):
    """A mesh with an attribute of each kind, some with seams, and metadata."""
    n, m = len(mesh.positions), len(mesh.faces)
    rng = np.random.default_rng(3)
    corners = mesh.positions[mesh.faces].reshape(-1, 3)[:, :2]
    normals = rng.standard_normal((n, 3)).astype(np.float32)
    attributes = (
        Attribute("color", rng.integers(0, 255, (n, 4)).astype(np.uint8), semantic="color"),
        Attribute("normal", normals, semantic="normal"),
        Attribute(
            "uv",
            np.where(corners > 0, corners, corners + 3).astype(np.float32),
            "corner",
            "texcoord",
        ),
        Attribute("uv2", np.where(corners > 0, corners, corners + 5), "corner", "texcoord"),
        Attribute("part", rng.integers(0, 3, m).astype(np.int32), "face"),
        Attribute("heat", rng.standard_normal(n)),
        Attribute("label", np.arange(n, dtype=np.float64) % 7),
    )
    metadata = {
        "unit": "mm",
        "count": -70000,
        "scale": 0.1,
        "image.0.data": bytes(range(256)),
        "name": "Ü" * 40,
    }
    return replace(mesh, attributes=attributes, metadata=metadata)


def filmed(positions, faces, *attributes):
    """Frames, shape (T, n, 3), one below the other, as a mesh that the encoder in C takes for them."""
    return TriangleMesh(positions.reshape(-1, 3), faces, attributes)


@pytest.mark.parametrize("keep", [False, True])
@pytest.mark.parametrize("preset", ["grid14", "lossless"])
@pytest.mark.parametrize(
    "mesh", [tetrahedron(), torus(20, 12), MIXED, dressed(torus(20, 12)), TOUCHING, PLAITED]
)
def test_c_and_python_write_the_same_bytes(encoder, mesh, preset, keep):
    found = encode(encoder, mesh, positions=LOSSLESS * (preset == "lossless"), keep_order=keep)
    assert (found.status, found.message) == (0, "")
    assert found.data == bsm.encode(mesh, preset=preset, keep_order=keep)


QUALITIES = "heat bits 9 9bits, heat exact 0 exact, heat bound .01 0.01, heat share 2 2%, normal angle 1.5 1.5deg, "
QUALITIES += "normal recompute 0 recompute, normal none 0 none, color bits 5 5bits, color share 3 3%, uv bits 27 27bits"


@pytest.mark.parametrize("quality", QUALITIES.split(", "))
def test_qualities_are_those_of_python(encoder, quality):
    mesh, (name, word, amount, text) = dressed(torus(20, 12)), quality.split()
    found = encode(encoder, mesh, {name: (word, float(amount))}, bits=11)
    assert found.data == bsm.encode(mesh, grid=11, attributes={name: text}), found.message


@pytest.mark.parametrize("keep", [False, True])
@pytest.mark.parametrize("effort", ["normal", "quick"])
@pytest.mark.parametrize("bits", [4, 9, 15])
def test_tangents_are_those_of_python(encoder, bits, effort, keep):
    mesh = with_attributes(torus(20, 12), creases, charts, tangents)
    asked = {"normal": ("bits", 10.0), "tangent": ("bits", float(bits))}
    found = encode(encoder, mesh, asked, bits=11, quick=effort == "quick", keep_order=keep)
    texts = {"normal": "10bits", "uv": "14bits", "tangent": f"{bits}bits"}
    wanted = bsm.encode(mesh, grid=11, effort=effort, keep_order=keep, attributes=texts)
    assert (found.message, found.data == wanted) == ("", True)


def test_cells_fit_those_of_python(encoder):
    mesh = torus(20, 12)
    found = encode(encoder, mesh, positions=CELLS, cell=0.01, origin=(5.0, 0.003, -1.0), quick=1)
    assert found.data == bsm.encode(
        mesh, grid_cell=0.01, grid_origin=(5.0, 0.003, -1.0), effort="quick"
    )


PAGE = """
import { readFileSync, writeFileSync } from "node:fs";
const { encodeHere } = await import(process.argv[2]);
const [positions, faces] = ["positions", "faces"].map((name) => Uint8Array.from(readFileSync(name)).buffer);
const mesh = { positions: new Float64Array(positions), faces: new Uint32Array(faces) };
const cells = { cell: 0.01, origin: [1, 2, 3] };
const options = [{}, { lossless: true }, { bits: 11, keepOrder: true }, { quick: true }, cells];
for (const [i, each] of options.entries()) writeFileSync(`${i}.bsm`, await encodeHere(mesh, each));
"""


@pytest.mark.skipif(shutil.which("node") is None, reason="no Node here")
def test_webassembly_writes_the_same_bytes(encoder, tmp_path):
    module = ROOT / "web/built/encode.js"
    if not module.with_suffix(".wasm").exists() or not module.exists():
        pytest.skip("npm run kernels and npm run build have not built the encoder")
    mesh = torus(60, 40)
    (tmp_path / "faces").write_bytes(mesh.faces.astype(np.uint32).tobytes())
    (tmp_path / "positions").write_bytes(mesh.positions.tobytes())
    (tmp_path / "page.mjs").write_text(PAGE)
    subprocess.run(["node", "page.mjs", module], cwd=tmp_path, check=True)
    cells = {"positions": CELLS, "cell": 0.01, "origin": (1.0, 2.0, 3.0)}
    for i, options in enumerate(
        ({}, {"positions": LOSSLESS}, {"bits": 11, "keep_order": 1}, {"quick": 1}, cells)
    ):
        assert (tmp_path / f"{i}.bsm").read_bytes() == encode(encoder, mesh, **options).data


@pytest.mark.real
@pytest.mark.parametrize(
    "name", ["assets/duck_uv.obj", "assets/monkey.glb", "hostile/cgal_blobby_3cc.off"]
)
def test_real_meshes_give_the_same_bytes(encoder, name, meshes):
    mesh = bsm.load(meshes / name)
    for preset, positions in (("grid14", 0), ("lossless", LOSSLESS)):
        assert encode(encoder, mesh, positions=positions).data == bsm.encode(mesh, preset=preset)


def test_orders_and_counts_say_what_became_of_the_mesh(encoder):
    mesh = soup(torus(9, 7))
    mesh = TriangleMesh(np.concatenate([mesh.positions, [[9.0, 9.0, 9.0]]]), mesh.faces)
    found = encode(encoder, mesh, bits=16)
    decoded = bsm.decode(found.data)
    vertices, faces = map(np.array, found.orders)
    assert found.counts[:3] == (len(mesh.faces) * 3 - 63, 1, 0)
    assert np.abs(decoded.positions - mesh.positions[vertices]).max() == pytest.approx(found.error)
    corners = mesh.positions[mesh.faces[faces]]
    assert min(
        np.abs(corners - np.roll(decoded.positions[decoded.faces], k, 1)).max(2).max(1).max()
        for k in (0, 1, 2)
    )
    assert encode(encoder, mesh, keep_order=1).counts[:3] == (0, 0, 0)


def test_wrong_meshes_and_options_are_refused(encoder):
    mesh = dressed(torus(9, 7))
    for options, pattern in (
        ({"bits": 21}, "20 bits"),
        ({"positions": 3}, "unknown"),
        ({"positions": CELLS}, "from 1e-290"),
        ({"positions": CELLS, "cell": 1e300}, "from 1e-290"),
        ({"positions": LOSSLESS, "quick": 1}, "exclude each other"),
        ({"size": 8}, "options.size"),
        ({"frames": -3}, "-3 frames"),
        ({"frames": 1, "positions": LOSSLESS}, "to the bit"),
    ):
        found = encode(encoder, mesh, **options)
        assert (found.status, found.data) == (2, b"")
        assert re.search(pattern, found.message)
    assert "'heat'" in encode(encoder, mesh, {"heat": ("angle", 1.0)}).message
    far = TriangleMesh(mesh.positions + 1e7, mesh.faces)
    assert encode(encoder, far, positions=LOSSLESS).status == UNREACHABLE
    assert encode(encoder, far, frames=1, positions=CELLS, cell=1e-14).status == UNREACHABLE
    broken = replace(mesh)
    object.__setattr__(broken, "faces", np.where(mesh.faces == 5, 63, mesh.faces).astype(np.int32))
    assert "vertex 63 of 63" in encode(encoder, broken).message


def test_misuse_is_told(encoder):
    positions, corners = np.eye(3), np.arange(3, dtype=np.uint32)
    heat, long = (
        bsmenc.Given(name, 0, 0, 7, 1, 3, positions.ctypes.data) for name in (b"heat", b"x" * 256)
    )
    entries = [Entry(b"m%d" % number, 1, number) for number in range(40_000)]
    for what, count, rows, words in (
        *(
            ("attribute", 2, (heat, heat), "two attributes have the name 'heat'"),
            ("attribute", 1, (long,), "1 to 255"),
        ),
        *(
            ("metadata", 40_001, (*entries, entries[7]), "the name 'm7'"),
            ("attribute", 2**64 - 1, (heat,), "255"),
        ),
        *(
            ("metadata", 1, (Entry(long.name, 1),), "short name"),
            ("metadata", 2**64 - 1, entries, "too long"),
        ),
        *((what, 1, (), "is NULL") for what in ("attribute", "metadata")),
    ):
        mesh = bsmenc.Mesh(
            ctypes.sizeof(bsmenc.Mesh), 3, 1, positions.ctypes.data, None, corners.ctypes.data
        )
        kept = (type(rows[0]) * len(rows))(*rows) if rows else None
        setattr(mesh, f"{what}_count", count)
        setattr(mesh, what.replace("bute", "butes"), kept and ctypes.addressof(kept))
        found = bsmenc.run(encoder, mesh, bsmenc.Options(ctypes.sizeof(bsmenc.Options)))
        assert found.status == 2 and words in found.message
    endless = bsmenc.Mesh(
        ctypes.sizeof(bsmenc.Mesh), 3, 1, positions.ctypes.data, None, corners.ctypes.data
    )
    endless.frames = 2**63 - 1
    found = bsmenc.run(encoder, endless, bsmenc.Options(ctypes.sizeof(bsmenc.Options)))
    assert found.status == 2 and "9223372036854775807 frames" in found.message
    assert encoder.bsmenc_encode(ctypes.byref(mesh), None, None) == 2


def test_progress_ascends_and_can_stop(encoder):
    mesh, seen = dressed(torus(20, 12)), []
    listener = PROGRESS(lambda _, part: seen.append(part) or 0)
    assert encode(encoder, mesh, progress=listener).status == 0
    assert seen == sorted(seen) and seen[-1] == 1.0 and len(seen) > 5
    for stop in range(len(seen) - 1):
        left = iter([0] * stop)
        stopped = encode(encoder, mesh, progress=PROGRESS(lambda _, __, left=left: next(left, 1)))
        assert (stopped.status, stopped.data) == (STOPPED, b"")


@pytest.mark.parametrize(("mesh", "frames"), [(dressed(torus(5, 4)), 0), (filmed(*bending(9)), 9)])
def test_no_memory_at_any_place_is_an_error_and_everything_is_given_back(encoder, mesh, frames):
    allocator = Allocator()
    at = ctypes.addressof(allocator)
    expected = encode(encoder, mesh, allocator=at, keep_order=1, frames=frames)
    assert expected.status == 0 and not allocator.held
    for refused in range(1, allocator.calls + 1):
        hungry = Allocator([refused])
        found = encode(
            encoder, mesh, allocator=ctypes.addressof(hungry), keep_order=1, frames=frames
        )
        assert (found.status, found.data) == (8, b""), refused
        assert not hungry.held


@settings(max_examples=60)
@given(st.integers(0, 2**32 - 1))
def test_random_meshes_with_attributes_come_back(encoder, seed):
    rng = np.random.default_rng(seed)
    n, m = int(rng.integers(3, 40)), int(rng.integers(1, 60))
    positions = rng.standard_normal((n, 3)) * 10.0 ** rng.integers(-20, 20)
    positions[rng.random(n) < 0.3] = positions[0]
    kind = rng.choice(["uint8", "int16", "int32", "uint32", "float32", "float64"])
    domain = rng.choice(["vertex", "corner", "face"])
    rows = {"vertex": n, "corner": 3 * m, "face": m}[str(domain)]
    shape = rows, int(rng.integers(1, 5))
    values = rng.standard_normal(shape) * 10.0 ** rng.integers(-9, 9)
    if "float" not in kind:
        info = np.iinfo(kind)
        values = rng.integers(info.min, info.max, shape, np.int64, endpoint=True)
    semantic = str(rng.choice(["generic", "color", "normal", "texcoord"]))
    mesh = TriangleMesh(
        positions,
        rng.integers(0, n, (m, 3)),
        [Attribute("a", values.astype(kind), domain, semantic)],
    )
    keep, positions_as = int(rng.integers(2)), int(rng.choice([0, LOSSLESS]))
    found = encode(encoder, mesh, keep_order=keep, positions=positions_as)
    if not positions_as or found.status != UNREACHABLE:
        assert (found.status, found.message) == (0, "")
        assert len(bsm.decode(found.data).faces) == len(found.orders[1])


def test_the_program_of_the_documents_writes_a_stream(tmp_path):
    text = (ROOT / "docs/guides/encode.md").read_text()
    program = re.search(r"```c\n(.*?)```", text, re.DOTALL)[1]
    (tmp_path / "write.c").write_text(program)
    write = linked(
        compiled_whole(), tmp_path / "write.c", tmp_path / "write", "-O0", "-Wall", "-Werror"
    )
    subprocess.run([write], cwd=tmp_path, check=True)
    assert len(bsm.load(tmp_path / "tetrahedron.bsm").faces) == 4


@pytest.mark.parametrize("keep", [0, 1])
def test_frames_come_back_within_half_a_cell_and_colors_stay(encoder, keep):
    positions, faces = bending(19)
    color = Attribute("color", np.arange(len(faces), dtype=np.uint8)[:, None], "face", "color")
    # Which are merged, but with their order.
    doubled = np.concatenate([positions, positions[:, faces[0]]], axis=1)
    again = faces.copy()
    again[0] = positions.shape[1] + np.arange(3)
    found = encode(encoder, filmed(doubled, again, color), frames=19, bits=9, keep_order=keep)
    assert found.status == 0 and found.counts[0] == (0 if keep else 3)
    with bsm.SequenceDecoder() as decoder:
        frames = [
            event for event in all_events(decoder, [found.data]) if isinstance(event, FrameEvent)
        ]
    assert all(
        np.array_equal(frame.attributes[0].values, color.values[found.orders[1]])
        for frame in frames
    )
    decoded, decoded_faces = bsm.decode_sequence(found.data)
    given = doubled[:, found.orders[0]]
    cell = np.ptp(doubled, axis=(0, 1)).max() / (2**9 - 1)
    assert (
        np.abs(decoded - given).max() == pytest.approx(found.error, rel=1e-9)
        and found.error <= cell / 2
    )
    corners = np.sort(given[0][decoded_faces].reshape(len(faces), -1), axis=1)
    assert np.array_equal(
        corners, np.sort(doubled[0][again[found.orders[1]]].reshape(len(faces), -1), axis=1)
    )


def test_frames_without_extent_or_with_loose_vertices(encoder):
    positions, faces = bending(3)
    loose = np.concatenate([positions, positions[:, :1]], axis=1)
    assert encode(encoder, filmed(loose, faces), frames=3).counts[1] == 1
    assert "no face" in encode(encoder, filmed(loose, faces), frames=3, keep_order=1).message
    # All at one place.
    assert encode(encoder, filmed(np.zeros_like(positions), faces), frames=3).status == 0
