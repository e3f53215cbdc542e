"""Readers in processes of their own: the same meshes and errors, and a system that ends what takes too much."""

import functools
import os
import signal
import struct
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import bsm
from bsm import FormatError, LimitError, Limits, MeshFile, read_mesh
from bsm.cli import main
from bsm.files import isolation
from bsm.files.answer import FRAMES, MESH, found_in, leave
from bsm.files.landlock import lack
from bsm.files.motion.frames import Frames, Shared, Wanted
from bsm.files.sequence import open_sequence, sequence_writer
from bsm.files.table import MESH_FORMATS
from tests.shapes import torus
from tools.attack.readers import chained_objects, three_mf
from tools.attack.uses import of_size, uses

pytestmark = pytest.mark.skipif(lack() is not None, reason=f"no isolation here: it needs {lack()}")
TRIANGLE = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"


def same(first, second):
    one, other = first.mesh, second.mesh
    assert np.array_equal(one.positions, other.positions) and np.array_equal(one.faces, other.faces)
    assert dict(one.metadata) == dict(other.metadata) and (first.notes, first.dropped) == (
        second.notes,
        second.dropped,
    )
    for a, b in zip(one.attributes, other.attributes, strict=True):
        assert (a.name, a.domain, a.semantic, a.values.dtype) == (
            b.name,
            b.domain,
            b.semantic,
            b.values.dtype,
        )
        assert np.array_equal(a.values, b.values)
        assert (a.indices is None and b.indices is None) or np.array_equal(a.indices, b.indices)


@pytest.mark.parametrize("kind", [*MESH_FORMATS, "glb"])
def test_the_mesh_is_the_same(kind, tmp_path):
    colors = bsm.Attribute(
        "color", np.arange(3 * 2400, dtype=np.uint8).reshape(-1, 3), "vertex", "color"
    )
    places = bsm.Attribute(
        "texcoord", np.random.default_rng(0).random((7200, 2)), "corner", "texcoord"
    )
    mesh = torus(40, 30)
    attributes = (
        replace(colors, values=colors.values[: len(mesh.positions)]),
        replace(places, indices=None),
    )
    mesh = replace(mesh, attributes=attributes if kind != "off" else (), metadata={"unit": "mm"})
    bsm.save(mesh, tmp_path / f"a.{kind}")
    same(read_mesh(tmp_path / f"a.{kind}", isolated=True), read_mesh(tmp_path / f"a.{kind}"))
    data = (tmp_path / f"a.{kind}").read_bytes()
    same(read_mesh(data, kind, isolated=True), read_mesh(data, kind))


def test_errors_are_the_same(tmp_path):
    for bad in (
        b"",
        b"v 0 0 0\n",
        b"solid",
        b"BSM",
        TRIANGLE + b"f 9 9 9\n",
        tmp_path / "none.ply",
        tmp_path,
    ):
        with pytest.raises((bsm.BsmError, OSError)) as plain:
            read_mesh(bad)
        with pytest.raises(type(plain.value)) as apart:
            read_mesh(bad, isolated=True)
        assert str(apart.value) == str(plain.value)


def test_files_beside_are_read_and_others_are_not(tmp_path):
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "a.obj").write_bytes(b"mtllib a.mtl\nusemtl red\n" + TRIANGLE)
    (tmp_path / "in" / "a.mtl").write_text("newmtl red\nKd 1 0 0\n")
    found = read_mesh(tmp_path / "in" / "a.obj", isolated=True)
    same(found, read_mesh(tmp_path / "in" / "a.obj"))
    assert any("red" in str(value) for value in found.mesh.metadata.values())


def acting(monkeypatch, tmp_path, act, before=""):
    """What reading does if a library in an isolated process is taken over by a file."""
    (tmp_path / "library").mkdir(exist_ok=True)
    (tmp_path / "library" / "evil.py").write_text(f"import os, socket\ndef act(here):\n    {act}\n")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path / "library"))
    code = (
        "from bsm.files import mesh, isolation, landlock; import evil\n"
        "plain, known = mesh.read_mesh, landlock.libraries\n"
        "def taken(source, *given, **more):\n"
        "    if not isinstance(source, bytes): evil.act(source)\n"
        "    return plain(source, *given, **more)\n"
        f"{before}mesh.read_mesh = taken; isolation.serve({{number}})"
    )
    monkeypatch.setattr(isolation, "_COMMAND", code)
    isolation._server.cache_clear()


@pytest.fixture(autouse=True)
def _fresh():
    yield
    isolation._server.cache_clear()


@pytest.mark.parametrize(
    ("act", "error", "words"),
    [
        ("x = bytearray(3 << 30)", LimitError, "bytes of memory"),
        ("[0 for _ in iter(int, 1)]", LimitError, "s of processor time"),
        ("os.kill(os.getpid(), 11)", FormatError, "Segmentation fault"),
        ("os.abort()", FormatError, "Aborted"),
        ("os.write(2, b'std::bad_alloc'); os.abort()", LimitError, "bytes of memory"),
        ("os._exit(3)", FormatError, "left no mesh"),
        ("raise KeyError(here)", FormatError, "KeyError"),
        ("import time; time.sleep(99)", LimitError, "more than 1 s$"),
        (
            "import time; __import__('signal').signal(14, 1); time.sleep(99)  # sleep",
            LimitError,
            "more than 1 s$",
        ),
        ("os.kill(os.getpid(), 19)  # a sleep without end", LimitError, "more than 1 s$"),
    ],
)
def test_the_parent_goes_on(act, error, words, monkeypatch, tmp_path):
    acting(monkeypatch, tmp_path, act)
    monkeypatch.setattr(isolation, "_PATIENCE", 1 if "sleep" in act else 1000)
    for _ in range(2):
        with pytest.raises(error, match=words):
            read_mesh(
                TRIANGLE, limits=replace(Limits.service(), most_work=0.0 if "sleep" in act else 1e8)
            )


def multiplied(kind):
    """A file of a few bytes that its library makes much of."""
    if kind == "3mf":
        return three_mf(chained_objects(39), '<item objectid="39"/>')
    if kind == "dae":  # each node has the one before it twice
        return of_size(dict(uses())["dae, nodes of nodes"], 4000).data
    level = 'def "a{0}" {{\ndef "l" (references = </a{1}>) {{}}\ndef "r" (references = </a{1}>) {{}}\n}}\n'.format
    return (
        "#usda 1.0\n" + 'def "a0" {}\n' + "".join(level(n, n - 1) for n in range(1, 20))
    ).encode()


@pytest.mark.parametrize(
    ("kind", "library"), [("3mf", "lib3mf"), ("dae", "collada"), ("usda", "pxr")]
)
def test_what_a_library_multiplies_is_ended(kind, library, tmp_path):
    pytest.importorskip(library)
    (tmp_path / f"a.{kind}").write_bytes(multiplied(kind))
    little = replace(Limits.service(), most_work=5e8, most_memory=200 << 20)
    # Usd-core ends itself where memory ends.
    with pytest.raises((LimitError, FormatError)) as refused:
        read_mesh(tmp_path / f"a.{kind}", limits=little)
    assert any(
        words in str(refused.value) for words in ("takes more than", "limit for its", "crashed")
    ), refused.value


SOCKETS = (
    ("AF_INET", "STREAM"),
    ("AF_INET6", "DGRAM"),
    ("AF_UNIX", "STREAM"),
    ("AF_NETLINK", "RAW"),
)


@pytest.mark.parametrize(
    "before", ["", "landlock.close_files = lambda folders: None; "], ids=["all", "calls alone"]
)
def test_nothing_is_written_and_no_other_folder_read(before, monkeypatch, tmp_path):
    """By the filter of calls alone, too, since old kernels have a Landlock that knows less."""
    victim = tmp_path / "victim"
    victim.write_bytes(b"secret")
    mode, here, name = victim.stat().st_mode, os.getpid(), str(victim)
    probes = [
        *(
            f"os.open({name!r}, os.{flags})"
            for flags in ("O_WRONLY", "O_RDWR", "O_RDONLY | os.O_TRUNC")
        ),
        f"os.open({str(tmp_path / 'new')!r}, os.O_RDONLY | os.O_CREAT)",
        *(f"socket.socket(socket.{family}, socket.SOCK_{kind})" for family, kind in SOCKETS),
        *(
            "os.execv('/bin/true', ['true'])",
            "os.fork()",
            "os.pipe()",
            "os.memfd_create('x')",
            "os.setsid()",
        ),
        *(
            f"os.{call}({name!r}{more})"
            for call, more in (("chmod", ", 0o777"), ("utime", ""), ("truncate", ", 0"))
        ),
        *(
            f"os.{call}({name!r}{more})"
            for call, more in (("chown", ", 1, 1"), ("unlink", ""), ("mkdir", "+'x'"))
        ),
        f"os.setxattr({name!r}, 'user.x', b'1')",
        *(
            f"os.{call}"
            for call in (
                f"setpriority(0, {here}, 5)",
                f"sched_setaffinity({here}, [0])",
                "kill(0, 0)",
            )
        ),
        *(f"os.kill({number}, 0)" for number in (here, "os.getppid()", -1)),
        f"resource.prlimit({here}, resource.RLIMIT_CORE, (0, 0))",
        *(
            f"number({numbers})"
            for numbers in ("29, 0, 4096, 0o1600", f"234, {here}, {here}, 0", "56, 17, 0, 0, 0, 0")
        ),
        *(
            f"number(56, {flags}, 0, 0, 0, 0)"
            for flags in (0x3D0F00, 0x10900, 0x40010900, 0x50010900)
        ),
        *(
            f"number({numbers})"
            for numbers in (f"72, 0, 8, {here}", "101, 16, 1", "425, 4, 0", "435, 0, 0")
        ),
        "number(200, 1, 0)",
    ]
    probes += [] if before else [f"open({name!r}).read()"]
    acts = (
        "import ctypes, resource",
        "def number(*given):",
        "    if ctypes.CDLL(None).syscall(*given) >= 0: raise KeyError(given)",
        f"for probe in {probes!r}:",
        "    try: exec(probe, globals() | locals())",
        "    except OSError: continue",
        "    if not probe.startswith('number'): raise KeyError(probe)",
        "raise KeyError('all were refused', dict(os.environ))",
    )
    monkeypatch.setenv("SECRET", "a key")
    acting(
        monkeypatch,
        tmp_path,
        "\n    ".join(acts),
        f"landlock.libraries = lambda: ('/gone', *known()); {before}",
    )
    with pytest.raises(FormatError, match="all were refused") as refused:
        read_mesh(TRIANGLE, isolated=True)
    assert "SECRET" not in str(refused.value)
    assert (
        victim.read_bytes() == b"secret"
        and not (tmp_path / "new").exists()
        and victim.stat().st_mode == mode
    )


def test_a_refused_call_is_named(monkeypatch, tmp_path):
    acting(monkeypatch, tmp_path, "os.sched_setaffinity(0, [0])")
    with pytest.raises(FormatError, match="may not call sched_setaffinity of the kernel"):
        read_mesh(TRIANGLE, isolated=True)


def test_nothing_stays(monkeypatch, tmp_path):
    acting(monkeypatch, tmp_path, "raise KeyError('ran')")
    with pytest.raises(FormatError, match="ran"):
        read_mesh(TRIANGLE, isolated=True)
    server = isolation._server().process
    os.kill(server.pid, signal.SIGKILL)
    with pytest.raises(FormatError, match="ran"):
        read_mesh(TRIANGLE, isolated=True)
    assert server.returncode == -signal.SIGKILL  # waited for: no zombie


@pytest.mark.parametrize(
    "number", sorted(signal.valid_signals() - {signal.SIGKILL, signal.SIGSTOP})
)
def test_any_signal_that_ends_a_process_is_an_error(number):
    assert isinstance(
        isolation._end_of(int(number), b"", {"seconds": 1, "memory": 1}), FormatError | LimitError
    )


def calling(monkeypatch, tmp_path, *lines):
    """What reading does if a taken-over process runs these lines in place of a reader."""
    code = "\n".join(f"    {line}" for line in lines)
    acting(
        monkeypatch, tmp_path, "pass", f"def called(asked):\n{code}\nisolation._called = called; "
    )


TETRAHEDRON = "numpy.eye(4, 3), numpy.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]], 'int32')"
ANSWERS = {
    "return None": (FormatError, "left no mesh"),
    f"return Frames(({TETRAHEDRON})[1], 1, iter([({TETRAHEDRON})[0]]))": (
        FormatError,
        "left no mesh",
    ),
    "raise errors.OptionError('no')": (FormatError, "left no mesh"),
    "raise errors.FormatError('one' + chr(10) + chr(8232) + 'two' + chr(13) + 'three')": (
        FormatError,
        "^one  two three$",
    ),
    "raise errors.FormatError('x' * 70000)": (FormatError, "^x{4096}$"),
    "raise errors.FormatError('x' * (90 << 20))": (FormatError, "left no mesh"),
    "raise errors.DependencyError('pip install evil')": (
        bsm.DependencyError,
        "^a package .*: pip install 'bsm-codec",
    ),
}


@pytest.mark.parametrize("answer", ANSWERS)
def test_only_what_was_asked_for_is_accepted(answer, monkeypatch, tmp_path):
    imports = (
        "import numpy; from bsm.bitstream import errors; from bsm.files.motion.frames import Frames"
    )
    calling(monkeypatch, tmp_path, imports, answer)
    error, words = ANSWERS[answer]
    with pytest.raises(error, match=words) as refused:
        read_mesh(TRIANGLE, isolated=True)
    assert len(str(refused.value).splitlines()) == 1
    (tmp_path / "a.obj").write_bytes(TRIANGLE)
    assert main(["encode", str(tmp_path / "a.obj"), "--untrusted", "-q"]) == (
        8 if error is bsm.DependencyError else 3
    )


def test_a_sequence_is_no_answer_where_a_mesh_is_asked_for_nor_a_mesh_for_a_sequence(
    monkeypatch, tmp_path
):
    with sequence_writer(
        str(tmp_path / "a.npz"), "npz", torus(4, 3).faces, 2, overwrite=True
    ) as write:
        for _ in range(2):
            write(torus(4, 3).positions)
    plain = "import numpy; from bsm import MeshFile, TriangleMesh"
    calling(monkeypatch, tmp_path, plain, f"return MeshFile(TriangleMesh({TETRAHEDRON}))")
    with pytest.raises(FormatError, match="left no mesh"):
        open_sequence(tmp_path / "a.npz", isolated=True)


@pytest.mark.parametrize(
    ("written", "kept", "fits"), [(300, 200, True), (300, 450, False), (420, 0, False)]
)
def test_an_answer_counts_as_memory(written, kept, fits, monkeypatch, tmp_path):
    """Of 700 MB, an answer takes half at most, and the process has so much less from then on."""
    lines = (
        "import os, stat",
        "def found(kind): return next(n for n in range(3, 64) if kind(n))",
        "def mode(n): return os.fstat(n).st_mode if os.path.exists(n) else 0",
        "room, memory = found(lambda n: stat.S_ISSOCK(mode(n))), found(lambda n: stat.S_ISREG(mode(n)))",
        f"size = {written << 20}",
        "isolation._ask(room, size)",
        "os.lseek(memory, 0, 0)",
        "piece = bytes(1 << 20)",
        "while os.lseek(memory, 0, 1) < size: os.write(memory, piece)",
        "try: os.write(memory, piece)",
        "except OSError: pass",
        "else: raise KeyError('more than was granted')",
        f"kept = bytearray({kept << 20})",
        "raise KeyError('had both')",
    )
    calling(monkeypatch, tmp_path, *lines)
    with pytest.raises((FormatError, LimitError)) as refused:
        read_mesh(TRIANGLE, limits=replace(Limits.service(), most_memory=float(700 << 20)))
    assert isinstance(refused.value, LimitError) == (not fits), refused.value
    assert ("had both" in str(refused.value)) == fits


SIZE, HEAD = 1 << 20, 1 << 14  # bytes of shared memory, and those that are changed
ROW = struct.Struct("<IIQQ")  # kind, type, size and place of a part of an answer
WIDE = st.integers(0, 15) | st.sampled_from(
    (255, 1 << 16, SIZE, SIZE // 24, (1 << 31) - 1, 1 << 40, 1 << 63, (1 << 64) - 1)
)


@functools.cache
def sound_answers():
    """What processes leave: a mesh, frames with one mesh and with several, and errors."""
    bare = torus(4, 3)
    rows = np.arange(len(bare.positions))
    corners = bsm.Attribute(
        "texcoord", np.linspace(0, 1, 10).reshape(5, 2), "corner", "texcoord", bare.faces % 5
    )
    attributes = (bsm.Attribute("color", rows[:, None].astype(np.uint8), semantic="color"), corners)
    mesh = replace(
        bare,
        attributes=attributes,
        metadata={"unit": "mm", "n": -(1 << 40), "x": 0.5, "b": b"\xff\0"},
    )
    frames = [bare.positions + number for number in range(3)]
    meshes = [replace(mesh, positions=positions) for positions in frames]
    answers = [
        *(None, MeshFile(bare), MeshFile(mesh, ("a note", "\udcff"), ("lines",))),
        Frames(bare.faces, 3, iter(frames), attributes, ("a note",), 24.0, {"unit": "mm"}),
        Frames(bare.faces, 3, iter(()), attributes, (), 24.0, {}, iter(meshes), 7),
        *(FormatError("no"), LimitError("much", offset=3), bsm.MeshError("a mesh")),
    ]
    found = []
    with isolation.shared(b"") as memory:
        for answer in answers:
            leave(memory, answer)
            found.append(os.pread(memory, HEAD, 0).ljust(HEAD, b"\0"))
    return found


@st.composite
def mutated_answers(draw):
    """An answer with numbers of rows, a row, or a byte changed."""
    data = bytearray(draw(st.sampled_from(sound_answers())))
    rows = int.from_bytes(data[:8], "little")
    for _ in range(draw(st.integers(1, 4))):
        place = 8 + ROW.size * draw(st.integers(0, min(max(rows - 1, 0), 200)))
        change = draw(st.sampled_from(["count", "byte", "repeat", "delete", "field", "field"]))
        if change == "count":
            data[:8] = draw(WIDE | st.just(rows + 1)).to_bytes(8, "little")
        elif change == "byte":
            data[draw(st.integers(0, HEAD - 1))] = draw(st.integers(0, 255))
        elif change == "repeat":
            data[8 : 8 + ROW.size] = data[place : place + ROW.size]
        elif change == "delete":
            del data[place : place + ROW.size]
        else:
            row = list(ROW.unpack(data[place : place + ROW.size]))
            field = draw(st.integers(0, 3))
            row[field] = draw(WIDE) & (0xFFFFFFFF if field < 2 else (1 << 64) - 1)
            data[place : place + ROW.size] = ROW.pack(*row)
        data.extend(bytes(HEAD - len(data)))
    return bytes(data)


@given(data=mutated_answers())
def test_mutated_answers_end_in_results_or_errors_of_ours(data):
    """100,000 of them: `BSM_EXAMPLES=100000 pytest tests/bsm/files/test_isolation.py -k mutated`."""
    limits = replace(Limits.service(), vertices=10_000)
    with isolation.shared(bytes(SIZE)) as memory:
        os.pwrite(memory, data, 0)
        try:
            found = found_in(memory, 2 * SIZE, limits, (*MESH, *FRAMES))
            if isinstance(found, Frames):
                for _ in found.meshes or found.frames:
                    pass
        except bsm.BsmError as error:
            assert len(str(error)) < 1 << 17


def test_lies_are_refused():
    with isolation.shared(bytes(SIZE)) as memory:
        for number in (0, 9, 400):
            os.pwrite(memory, b"\xff" * 8 + bytes(number), 0)
            with pytest.raises(FormatError, match="left no mesh"):
                found_in(memory, 2 * SIZE, Limits(), MESH)
    with isolation.shared(bytes(SIZE)) as memory, pytest.raises(FormatError, match="left no mesh"):
        found_in(memory, 2 * SIZE, Limits(), MESH)


def test_what_a_process_leaves_is_within_limits():
    mesh = torus(40, 30)

    def frames():
        return Frames(mesh.faces, 2, iter([mesh.positions] * 2), meshes=iter([mesh] * 2))

    with isolation.shared(b"") as memory:
        for found, name in (
            (MeshFile(mesh), "vertices"),
            (frames(), "vertices"),
            (frames(), "frames"),
        ):
            leave(memory, found)
            with pytest.raises(LimitError, match=name):
                found_in(memory, 1 << 24, replace(Limits(), **{name: 1}), (*MESH, *FRAMES))


def test_many_threads_read_at_a_time():
    with ThreadPoolExecutor(12) as pool:
        found = list(pool.map(lambda _: read_mesh(TRIANGLE, isolated=True), range(12)))
    assert [len(one.mesh.faces) for one in found] == [1] * 12


def frames(found):
    meshes = None if found.meshes is None else list(found.meshes)
    return meshes, [mesh.positions for mesh in meshes] if meshes else list(found.frames)


@pytest.mark.parametrize(
    ("name", "runs"), [("a.npz", False), ("a.glb", False), ("a/", False), ("a/", True)]
)
def test_sequences_are_the_same(name, runs, tmp_path):
    mesh = torus(12, 8)
    shades = [np.full((len(mesh.positions), 3), 20 * number, np.uint8) for number in range(4)]
    shared = (
        Shared(lambda: (bsm.Attribute("color", shades.pop(), "vertex", "color"),))
        if name == "a/"
        else Shared()
    )
    path = str(tmp_path / name)
    with sequence_writer(
        path, Path(name).suffix[1:] or "ply", mesh.faces, 4, overwrite=True, shared=shared
    ) as write:
        for number in range(4):
            write(mesh.positions * (1.0 + number))
    wanted = Wanted(runs=runs)
    plain, apart = (open_sequence(path, request=wanted, isolated=apart) for apart in (None, True))
    for one, other in zip(*map(frames, (plain, apart))):
        assert (one is None) == (other is None) and len(one or ()) == len(other or ())
        for first, second in zip(one or (), other or ()):
            if isinstance(first, bsm.TriangleMesh):
                same(MeshFile(first), MeshFile(second))
            else:
                assert np.array_equal(first, second)
    for name in ("notes", "count", "frame_rate", "rigged"):
        assert getattr(plain, name) == getattr(apart, name)
    assert np.array_equal(plain.faces, apart.faces) and dict(plain.metadata) == dict(apart.metadata)
    if not runs:
        assert main(["encode", path, "--kg", "1", "-o", str(tmp_path / "p.bsm"), "-q"]) == 0
        assert (
            main(["encode", path, "--kg", "1", "-o", str(tmp_path / "u.bsm"), "-q", "--untrusted"])
            == 0
        )
        assert (tmp_path / "p.bsm").read_bytes() == (tmp_path / "u.bsm").read_bytes()
    with pytest.raises(LimitError):
        open_sequence(path, request=wanted, limits=replace(Limits.service(), vertices=10))


def test_what_is_no_sequence_is_told(tmp_path):
    bsm.save(torus(12, 8), tmp_path / "a.npz")
    assert open_sequence(tmp_path / "a.npz", isolated=True) is None
    with pytest.raises(FormatError):
        open_sequence(b"PK\x03\x04", isolated=True)


def test_the_command_reads_untrusted_files_behind_the_wall(tmp_path):
    bsm.save(torus(20, 16), tmp_path / "a.ply")
    assert main(["encode", str(tmp_path / "a.ply"), "--untrusted", "-q"]) == 0
    assert bsm.decode(tmp_path / "a.bsm").faces.shape == (640, 3)
    (tmp_path / "b.ply").write_bytes(
        b"ply\nformat ascii 1.0\nelement vertex 2000000\nelement face 1\nend_header\n"
    )
    assert main(["encode", str(tmp_path / "b.ply"), "--untrusted", "-q"]) == 6
