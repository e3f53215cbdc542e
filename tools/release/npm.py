"""The npm package: packed, taken by a publication that is not done, and used by Node."""

import os
import subprocess
from pathlib import Path

from tools.release.cross import clean
from tools.release.trial import try_newcomer


def make_npm(sources: Path, root: Path, output: Path) -> Path:
    """Pack the package, have npm check what it would publish, install it and decode with it in Node."""
    web, installed = sources / "web", root / "web/node_modules"
    if installed.exists():
        (web / "node_modules").symlink_to(installed.resolve())
    else:
        _npm(["ci", "--no-audit", "--no-fund"], web)
    _npm(["pack", "--silent", "--pack-destination", str(output)], web)
    package = max(output.glob("bsm-decoder-*.tgz"), key=os.path.getmtime)
    _npm(["publish", "--dry-run", "--silent", str(package)], web)
    try_newcomer(
        package, (web / "README.md").read_text(), sources / "spec/vectors/1.0/good-tetrahedron.bsm"
    )
    return package


def _npm(words: list[str], folder: Path) -> None:
    subprocess.run(["npm", *words], cwd=folder, check=True, env=clean())
