"""The option `--reader` of all commands that read mesh files."""

from __future__ import annotations

import argparse

from bsm.files.mesh import READERS


def add_reader_flag(parser: argparse.ArgumentParser) -> None:
    """Add it; `args.reader` goes to `read_mesh` and `open_sequence`."""
    parser.add_argument(
        "--reader",
        choices=READERS,
        help="who reads mesh files (default: bsm for OBJ, OFF, PLY, STL, VTP and npz, trimesh for GLB, 3MF, DAE, ...)",
    )
