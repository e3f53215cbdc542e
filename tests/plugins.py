"""The entry points of the package, for tests that run without installing it."""

import tomllib
from importlib.metadata import entry_points
from pathlib import Path

ROOT = Path(__file__).parents[1]


def declare_entry_points(folder: Path) -> Path:
    """Make a folder that declares the entry points of pyproject.toml once it is on the path, if nothing else does."""
    folder.mkdir(parents=True, exist_ok=True)
    if entry_points(group="pyvista.readers", name=".bsm"):
        return folder
    declared = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["entry-points"]
    info = folder / "bsm_codec_here-0.1.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: bsm-codec-here\nVersion: 0.1\n")
    lines = [f"[{group}]\n" + "".join(f"{k} = {v}\n" for k, v in points.items()) for group, points in declared.items()]
    (info / "entry_points.txt").write_text("\n".join(lines))
    return folder
