"""The npm package: packed, taken by a publication that is not done, and used by Node."""

from __future__ import annotations

import os
import subprocess
import tempfile
from pathlib import Path

from tools.release.wheels import clean

DECODE = """
import { readFile } from "node:fs/promises";
import { decode, loadKernels } from "bsm-decoder";
const { positions, faces } = decode(await loadKernels(), new Uint8Array(await readFile(process.argv[2])));
if (positions.length !== 12 || faces.length !== 12) throw new Error("a tetrahedron is expected");
console.log("npm: Node decodes with the package");
"""


def make_npm(sources: Path, root: Path, output: Path) -> Path:
    """Pack the package, have npm check what it would publish, install it and decode with it in Node."""
    web, installed = sources / "tools/web", root / "tools/web/node_modules"
    if installed.exists():
        (web / "node_modules").symlink_to(installed.resolve())
    else:
        _npm(["ci", "--no-audit", "--no-fund"], web)
    _npm(["pack", "--silent", "--pack-destination", str(output)], web)
    package = max(output.glob("bsm-decoder-*.tgz"), key=os.path.getmtime)
    _npm(["publish", "--dry-run", "--silent", str(package)], web)
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "package.json").write_text('{"private": true, "type": "module"}')
        _npm(["install", "--silent", "--no-audit", "--no-fund", "--omit=peer", str(package)], Path(folder))
        Path(folder, "decode.mjs").write_text(DECODE)
        stream = sources / "spec/vectors/1.0/good-tetrahedron.bsm"
        subprocess.run(["node", "decode.mjs", stream], cwd=folder, check=True, env=clean())
    return package


def _npm(words: list[str], folder: Path) -> None:
    subprocess.run(["npm", *words], cwd=folder, check=True, env=clean())
