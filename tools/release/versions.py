"""One version in every place, and what the change log says of it."""

from __future__ import annotations

import json
import re
from pathlib import Path


def check_versions(root: Path) -> str:
    """The version of a checkout."""
    match = re.search(r'^__version__ = "(.+)"', (root / "src/bsm/__init__.py").read_text(), flags=re.MULTILINE)
    if match is None:
        raise SystemExit("src/bsm/__init__.py has no version")
    version = match.group(1)
    npm = json.loads((root / "tools/web/package.json").read_text())["version"]
    latest = sections(root)[0][0]
    if not version == npm == latest:
        raise SystemExit(f"versions differ: {version} in Python, {npm} for npm, {latest} first in CHANGELOG.md")
    return version


def sections(root: Path) -> list[tuple[str, str]]:
    """The versions of the change log, latest first, each with its text."""
    parts = re.split(r"^## ", (root / "CHANGELOG.md").read_text(), flags=re.MULTILINE)[1:]
    found = [part.partition("\n") for part in parts]
    return [(heading.split()[0], text.strip() + "\n") for heading, _, text in found]


def notes(root: Path, version: str) -> str:
    """What the change log says of a version."""
    return dict(sections(root))[version]
