"""Remote files through stores that fail: a sentence, and nothing half written where nothing was."""

import pytest

import bsm
from tests.shapes import file_of
from tools.vectors.meshes import torus

fsspec = pytest.importorskip("fsspec")

FAILURES = {
    "opening": ("r", "open", PermissionError("no")),
    "opening, of no kind that is known": ("r", "open", RuntimeError("boo")),
    "reading": ("r", "read", TimeoutError("slow")),
    "writing": ("w", "write", OSError(28, "full")),
    "writing, of no kind that is known": ("w", "write", RuntimeError("boo")),
    "committing": ("w", "commit", ConnectionError("gone")),
}


@pytest.fixture
def store():
    files = fsspec.filesystem("memory")
    files.store.clear()
    with files.open("/in/mesh.ply", "wb") as file:
        file.write(file_of(torus(6, 6), "ply"))
    yield files
    files.store.clear()


def encode():
    (facts,) = bsm.encode_many(["memory://in/mesh.ply"], "memory://out/", grid=8)
    return facts


def fail(monkeypatch, how):
    mode, method, error = FAILURES[how]
    opened = fsspec.implementations.memory.MemoryFileSystem._open

    def refuse(*args, **more):
        raise error

    def open_it(self, path, wanted="rb", **more):
        if method == "open":
            refuse()
        file = opened(self, path, wanted, **more)
        if mode in wanted:
            setattr(file, method, refuse)
        return file

    monkeypatch.setattr(fsspec.implementations.memory.MemoryFileSystem, "_open", open_it)


@pytest.mark.parametrize("how", FAILURES)
def test_a_failure_is_reported_and_leaves_nothing(how, store, monkeypatch):
    with monkeypatch.context() as patched:
        fail(patched, how)
        facts = encode()
    assert "Traceback" not in facts["error"] and facts["exit"]
    assert not [name for name in store.find("/") if name.startswith("/out")]


def test_what_was_there_stays_another_time(store):
    first = encode()
    assert "error" not in first
    before = store.cat("/out/mesh.bsm")
    assert "exists already" in encode()["error"]
    assert store.cat("/out/mesh.bsm") == before


@pytest.mark.parametrize(
    "name", ["..ply", "%2e%2e%2fx.ply", "x\ny.ply", "\x1b[2J.ply", "ü網.ply", "a#b.ply"]
)
def test_malicious_names_stay_in_their_folder(name, store, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    store.pipe(f"/in/{name}", store.cat("/in/mesh.ply"))
    (facts,) = bsm.encode_many([f"memory://in/{name}"], "memory://out/", grid=8)
    assert "error" not in facts
    assert [found for found in store.find("/") if not found.startswith("/in/")] == [
        f"/out/{name[:-4]}.bsm"
    ]
    assert not list(tmp_path.iterdir())
