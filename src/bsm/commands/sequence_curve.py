"""bsm curve, where the input is a sequence."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from bsm.bitstream.errors import DependencyError
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.console import Console
from bsm.files.sequence import open_sequence


def run_sequence(path: str, folder: Path, console: Console) -> bool:
    """Measure and draw a sequence; False if `path` is a mesh."""
    source = open_sequence(path)
    if source is None:
        return False

    from bsm.evaluation.sequences import draw_lines, measure_lines, table_of, write_lines

    frames = np.array(list(source.frames))
    mesh, kept = TriangleMesh(frames[0], source.faces).without_isolated_vertices()
    name = Path(path).stem
    with console.progress(name) as progress:
        result = measure_lines(frames[:, kept], mesh.faces, name, progress)
    written = write_lines(result, folder)
    console.note(str(written))
    print(table_of(result))
    try:
        for picture in draw_lines(written):
            console.note(str(picture))
    except DependencyError as missing:
        console.note(f"no pictures: {missing}")
    return True
