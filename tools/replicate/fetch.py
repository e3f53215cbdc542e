"""Gets the meshes of meshes.json out of packages, with the ordinary clients of their registries, and checks each."""

import hashlib
import importlib.util
import json
import os
import subprocess
import sys
import tarfile
import zipfile
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from bsm.codec.geometry.mesh import TriangleMesh
from tools.measure.grids import welded

LIST = Path(__file__).parent / "meshes.json"
LARGEST = 2_000_000
"""Bytes of a mesh file of one's own."""
MESHOPT = "meshoptimizer@1.3.0"


@dataclass(frozen=True)
class Source:
    """A mesh file that was fetched."""

    name: str
    path: Path
    group: str
    vertices: int

    def mesh(self) -> TriangleMesh:
        """The mesh, with vertices at one position merged and degenerate faces left out."""
        positions, faces = welded(str(self.path))
        return TriangleMesh(positions.astype(np.float64), faces)


def fetch_meshes(folder: Path, note: Callable[[str], None], listing: Path = LIST) -> list[Source]:
    """All that can be had, by size; what is missing or another file is named."""
    found = []
    for package in json.loads(listing.read_text())["packages"]:
        root = folder / package["package"]
        try:
            unpacked(package, root)
        except (OSError, subprocess.SubprocessError, tarfile.TarError, zipfile.BadZipFile) as error:
            note(f"missing: {package['package']} with {len(package['meshes'])} meshes ({error})")
            continue
        for row in package["meshes"]:
            path = root / row["path"]
            if not path.exists() or hashlib.sha256(path.read_bytes()).hexdigest() != row["sha256"]:
                note(
                    f"missing: {package['package']}: {row['path']}, or another file than that of the list"
                )
                continue
            found.append(Source(row["name"], path, row["group"], row["vertices"]))
    return sorted(found, key=lambda source: (source.vertices, source.name))


def own_meshes(folder: Path) -> list[Source]:
    """Meshes of the folder that BSM_MESHES names; they were in use here before."""
    found = [*folder.glob("static/*.ply"), *folder.glob("assets/*.STL")]
    return sources_of([path for path in sorted(found) if path.stat().st_size < LARGEST], "tuned")


def sources_of(paths: Iterable[Path], group: str) -> list[Source]:
    """Files of one's own."""
    return [Source(path.stem, path, group, len(welded(str(path))[0])) for path in paths]


def unpacked(package: dict[str, Any], root: Path) -> None:
    """A package's files at `root`; they are not installed, and nothing of them runs."""
    if root.exists():
        return
    beside = root.with_name(root.name + ".part")
    beside.mkdir(parents=True, exist_ok=True)
    name, version = package["package"], package["version"]
    if package["registry"] == "pypi":
        pip = [sys.executable, "-m", "pip"] if importlib.util.find_spec("pip") else ["pip"]
        _run(
            [
                *pip,
                "download",
                "-q",
                "--no-deps",
                "--only-binary",
                ":all:",
                "-d",
                beside,
                f"{name}=={version}",
            ]
        )
        with zipfile.ZipFile(next(beside.glob("*.whl"))) as wheel:
            wheel.extractall(beside)
    elif package["registry"] == "npm":
        _run(["npm", "pack", "--silent", f"{name}@{version}"], cwd=beside)
        with tarfile.open(next(beside.glob("*.tgz"))) as pack:
            pack.extractall(beside, filter="data")
    else:
        _run(["apt-get", "download", name], cwd=beside)
        _run(["dpkg-deb", "-x", next(beside.glob("*.deb")), beside])
        if "archive" in package:
            with tarfile.open(beside / package["archive"]) as archive:
                archive.extractall(beside, filter="data")
    os.replace(beside, root)


def meshopt_package(folder: Path, note: Callable[[str], None]) -> Path | None:
    """Meshoptimizer's own npm package; there is no wheel of it on PyPI by its authors. None without Node."""
    name, version = MESHOPT.split("@")
    try:
        unpacked({"package": name, "version": version, "registry": "npm"}, folder / name)
        _run(["node", "--version"])
    except (OSError, subprocess.SubprocessError) as error:
        note(f"missing: meshoptimizer ({error})")
        return None
    return folder / name / "package"


def _run(words: list[Any], cwd: Path | None = None) -> None:
    subprocess.run(list(map(str, words)), cwd=cwd, check=True, capture_output=True, timeout=600)


def listed() -> Iterator[dict[str, Any]]:
    """The rows of the list, with their packages."""
    for package in json.loads(LIST.read_text())["packages"]:
        for row in package["meshes"]:
            yield {**row, "package": package["package"], "licence": package["licence"]}
