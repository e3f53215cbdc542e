"""One version in every place, and what the change log says of it."""

import re
import tomllib
from pathlib import Path

OTHERS = {
    "web/package.json": r'^  "version": "(.+?)"',
    "library/bsmdec.h": r'^#define BSMDEC_VERSION "(.+)"',
    "library/CMakeLists.txt": r"^project\(bsmdec VERSION (\S+)",
    "library/rust/Cargo.toml": r'^version = "(.+)"',
}


def check_versions(root: Path) -> str:
    """The version of a checkout."""
    match = re.search(
        r'^__version__ = "(.+)"', (root / "src/bsm/__init__.py").read_text(), flags=re.MULTILINE
    )
    if match is None:
        raise SystemExit("src/bsm/__init__.py has no version")
    version = match.group(1)
    found = {"src/bsm/__init__.py": version, "CHANGELOG.md": sections(root)[0][0]}
    for name, pattern in OTHERS.items():
        stated = re.search(pattern, (root / name).read_text(), flags=re.MULTILINE)
        found[name] = stated.group(1) if stated else "no version"
    if len(set(found.values())) > 1:
        raise SystemExit(
            "versions differ: " + ", ".join(f"{stated} in {name}" for name, stated in found.items())
        )
    return version


def sections(root: Path) -> list[tuple[str, str]]:
    """The versions of the change log, latest first, each with its text."""
    parts = re.split(r"^## ", (root / "CHANGELOG.md").read_text(), flags=re.MULTILINE)[1:]
    found = [part.partition("\n") for part in parts]
    return [(heading.split()[0], text.strip() + "\n") for heading, _, text in found]


def notes(root: Path, version: str) -> str:
    """What the change log says of a version."""
    return dict(sections(root))[version]


_IMAGES = (".png", ".jpg", ".webp", ".svg", ".gif")


def address(root: Path) -> str:
    """Where the sources are published, as pyproject.toml says."""
    urls: dict[str, str] = tomllib.loads((root / "pyproject.toml").read_text())["project"]["urls"]
    source = urls["Source"].rstrip("/")
    if strange := [
        name for name in ("Documentation", "Changelog") if not urls[name].startswith(f"{source}/")
    ]:
        raise SystemExit(f"pyproject.toml: {', '.join(strange)} is not below the Source, {source}")
    return source


def with_absolute_links(text: str, source: str) -> str:
    """A page whose links and pictures are found from everywhere."""

    def absolute(found: re.Match[str]) -> str:
        kind = "raw" if found[1].partition("#")[0].endswith(_IMAGES) else "blob"
        return f"]({source}/{kind}/main/{found[1]})"

    return re.sub(r"\]\((?![a-z]+:|#)([^)\s]+)\)", absolute, text)
