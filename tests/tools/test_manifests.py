"""A sample of the mutated manifests of tiles; `python -m tools.attack manifests` is the whole."""

import json

import pytest

from tools.attack.manifests import Folder, used, walk


def test_mutated_manifests_end_in_results_or_errors_of_ours():
    assert not list(walk(60, "sample"))


@pytest.mark.slow
def test_many_mutated_manifests_end_in_results_or_errors_of_ours():
    assert not list(walk(2000, "many"))


def test_a_sound_folder_is_used_and_what_escapes_is_seen(tmp_path, monkeypatch):
    folder = Folder(tmp_path / "tiles")
    used(str(folder.path))
    assert json.loads((folder.path / "manifest.json").read_text()) == folder.manifest
    monkeypatch.setattr("tools.attack.manifests.used", lambda path: 1 // 0)
    (problem,) = walk(1, "a")
    assert "ZeroDivisionError" in problem
