"""What MkDocs cannot find in files: the command line, the exit codes, and pictures, made when the site is built.

pip install -e '.[docs,denoise]' && mkdocs build --strict
"""

from __future__ import annotations

import io
import subprocess
import sys
from inspect import getdoc, isclass, isfunction
from pathlib import Path
from typing import Any

import numpy as np

import bsm
from bsm.cli import COMMANDS, command_parser
from bsm.exits import EXITS

ROOT = Path(__file__).parents[1]
PICTURES = ROOT / "build" / "gallery"
MODULES = {
    "bsm.research": "One's own dictionary, prediction or partition in place of ours",
    "bsm.trimesh": "Streams in trimesh",
    "bsm.pyvista": "Streams in pyvista",
    "bsm.vtk": "Streams in pipelines of VTK, and ParaView",
}
"""Modules that are public beside `bsm` itself."""


def on_config(config: Any) -> Any:
    """Put the pages of public names behind those of Python that are written by hand."""
    for section in config.nav:
        if "Reference" in section:
            section["Reference"].insert(
                1, {"Python": ["api/python.md", *({name: f"api/{name}.md"} for name in reference())]}
            )
    return config


def on_files(files: Any, config: Any) -> Any:
    """Add the pages and pictures that are made here."""
    from mkdocs.structure.files import File

    files.append(File.generated(config, "api/python.md", content=contents()))
    for name, page in reference().items():
        files.append(File.generated(config, f"api/{name}.md", content=page))
    files.append(File.generated(config, "cli.md", content=command_line()))
    for path in pictures(PICTURES):
        files.append(File.generated(config, f"gallery/{path.name}", abs_src_path=str(path)))
    return files


def on_page_markdown(markdown: str, *, page: Any, **_: Any) -> str:
    """a[i][j] of the specification is no link."""
    return markdown.replace("][", "]\\[") if page.file.src_uri.startswith("format/") else markdown


def reference() -> dict[str, str]:
    """A page for each public function, type and module, by its name."""
    found = {f"bsm.{name}": getattr(bsm, name) for name in bsm.__all__}
    names = [name for name, value in found.items() if isclass(value) or isfunction(value)]
    return {name: f"::: {name}\n    options:\n      heading_level: 1\n" for name in (*names, *MODULES)}


def contents() -> str:
    """The page that says in a sentence what each of them is."""
    rows = []
    for name in reference():
        text = MODULES.get(name) or (getdoc(getattr(bsm, name.partition(".")[2])) or "").partition("\n")[0]
        rows.append(f"| [`{name}`]({name}.md) | {text.rstrip('.')} |")
    return "\n".join(["# Python", "", "| name | what it is |", "|---|---|", *rows, ""])


def command_line() -> str:
    """The page of all commands, as `--help` prints them."""
    parts = ["# Command line\n"]
    for name, summary in COMMANDS.items():
        parser = command_parser(name)
        parts.append(f"## bsm {name}\n\nTo {summary}.\n\n```text\n{parser.format_help().rstrip()}\n```\n")
    return "\n".join(parts)


def exit_codes() -> str:
    """The table of exit codes."""
    rows = [f"| {row.code} | {row.meaning} |" for row in sorted(EXITS, key=lambda row: row.code)]
    return "\n".join(["| code | meaning |", "|---:|---|", *rows])


def pictures(folder: Path) -> list[Path]:
    """Make the gallery's pictures, unless they are there."""
    folder.mkdir(parents=True, exist_ok=True)
    demo, denoised, motion = (folder / name for name in ("demo.png", "denoised.png", "motion.gif"))
    if not demo.exists():
        command = [sys.executable, "-m", "bsm", "demo", "-q", "-f", "--vertices", "4000", "-o", str(folder)]
        subprocess.run(command, check=True)
        (folder / "bsm_demo.png").replace(demo)
    if not denoised.exists():
        denoised.write_bytes(_denoised())
    if not motion.exists():
        motion.write_bytes(_motion())
    return [demo, denoised, motion]


def _denoised() -> bytes:
    """A noisy sample beside what denoising makes of it."""
    import bsm
    from bsm.evaluation.sample import knot
    from bsm.pictures import bounds_of, render

    sys.path.append(str(ROOT))  # mkdocs runs this file alone
    from tools.noise import gaussian_along_normals

    sample = knot(8000)
    noisy = gaussian_along_normals(sample.positions, sample.faces, 0.3, 0)
    clean = bsm.denoise((noisy, sample.faces))
    bounds = bounds_of(sample.positions)
    sides = [render(positions, sample.faces, bounds=bounds) for positions in (noisy, clean.positions)]
    return _encoded([np.concatenate(sides, axis=1)], "PNG")


def _motion() -> bytes:
    """A moving sample, after encoding and decoding."""
    import bsm
    from bsm.evaluation.sample import knot
    from bsm.pictures import bounds_of, render

    sample = knot(3000)
    angles = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    height = sample.positions[:, 2] - sample.positions[:, 2].min()
    frames = np.stack([sample.positions + np.outer(height, (np.sin(t), np.cos(t), 0)) * 0.5 for t in angles])
    positions, faces = bsm.decode_sequence(bsm.encode_sequence(frames, sample.faces))
    bounds = bounds_of(positions.reshape(-1, 3))
    return _encoded([render(frame, faces, bounds=bounds) for frame in positions], "GIF")


def _encoded(images: list[Any], kind: str) -> bytes:
    """Pictures of values from 0 to 1 as a file."""
    from PIL import Image

    frames = [Image.fromarray(np.uint8(255 * np.clip(image, 0, 1))) for image in images]
    file = io.BytesIO()
    more = {"save_all": True, "append_images": frames[1:], "duration": 60, "loop": 0} if kind == "GIF" else {}
    frames[0].save(file, kind, **more)
    return file.getvalue()
