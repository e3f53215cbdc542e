"""What to type for a missing library, wherever this package came from."""

import json
from importlib import metadata
from pathlib import Path

import pytest

from bsm.bitstream.errors import how_to_install


class Installed:
    def __init__(self, origin):
        self.origin = origin

    def read_text(self, name):
        assert name == "direct_url.json"
        return None if self.origin is None else json.dumps(self.origin)


@pytest.mark.parametrize(
    ("origin", "command"),
    [
        (None, "pip install 'bsm-codec[eval]'"),
        ({"url": "file:///a%20b/bsm", "dir_info": {}}, "pip install '/a b/bsm[eval]'"),
        ({"url": "file:///bsm", "dir_info": {"editable": True}}, "pip install -e '/bsm[eval]'"),
        ({"url": "file:///x/b.whl", "archive_info": {}}, "pip install 'bsm-codec[eval] @ file:///x/b.whl'"),
        (
            {"url": "https://a.example/b.git", "vcs_info": {"vcs": "git", "commit_id": "123"}},
            "pip install 'bsm-codec[eval] @ git+https://a.example/b.git@123'",
        ),
    ],
)
def test_the_extra_is_had_where_the_package_was_had(origin, command, monkeypatch):
    monkeypatch.setattr(metadata, "distribution", lambda name: Installed(origin))
    assert how_to_install("eval") == command


def test_a_checkout_is_named(monkeypatch):
    def missing(name):
        raise metadata.PackageNotFoundError(name)

    monkeypatch.setattr(metadata, "distribution", missing)
    folder = Path(how_to_install("eval").removeprefix("pip install '").removesuffix("[eval]'"))
    assert (folder / "pyproject.toml").exists()
