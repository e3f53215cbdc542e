"""Small sequences with known properties."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from bsm import Limits, TriangleMesh
from bsm.files.motion.caches import write_cache
from bsm.files.motion.frames import Frames, Shared, Wanted
from bsm.files.sequence import open_sequence, sequence_writer
from tests.shapes import torus
from tools.vectors import meshes as vectors


def bending(frames: int, rows: int = 30, columns: int = 16) -> tuple[np.ndarray, np.ndarray]:
    """A torus that turns, stretches and waves; shape (T, n, 3)."""
    mesh = torus(rows, columns)
    x, y, z = mesh.positions.T
    result = []
    for t in np.arange(frames) / 12:
        c, s = np.cos(t), np.sin(t)
        wave = 0.1 * np.sin(3 * x + 2 * t)
        result.append(
            np.stack([c * x - s * y, (s * x + c * y) * (1 + 0.2 * np.sin(t)), z + wave], axis=1)
        )
    return np.array(result), mesh.faces


def sequence_in(
    source: Any,
    file_format: str | None = None,
    *,
    limits: Limits | None = None,
    isolated: bool | None = None,
    **wanted: Any,
) -> Frames | None:
    """The sequence that commands read of a source."""
    return open_sequence(
        source, file_format, Wanted(**wanted), limits or Limits(), isolated=isolated
    )


def save_frames(
    path: Path, kind: str, positions: np.ndarray, faces: np.ndarray, shared: Shared | None = None
) -> None:
    """Write the frames of a sequence in the file or files of some program."""
    with sequence_writer(
        str(path), kind, faces, len(positions), overwrite=True, shared=shared
    ) as write:
        for frame in positions:
            write(frame)


def capture(*pieces: tuple[int, int]) -> list[TriangleMesh]:
    """Tori of several sizes that move: so many frames of each."""
    sizes = [size for size, count in pieces for _ in range(count)]
    meshes = [vectors.torus(size, 6, phase=0.15 * t) for t, size in enumerate(sizes)]
    return [
        replace(mesh, positions=mesh.positions * (1 + 0.01 * t)) for t, mesh in enumerate(meshes)
    ]


def turning(frames: int) -> tuple[np.ndarray, np.ndarray]:
    """A torus that turns about an axis and moves away, rigidly."""
    mesh = torus(30, 16)
    x, y, z = mesh.positions.T
    angles = np.arange(frames) / 7
    turned = [
        np.stack([np.cos(t) * x - np.sin(t) * z + t, y, np.sin(t) * x + np.cos(t) * z], axis=1)
        for t in angles
    ]
    return np.array(turned), mesh.faces


def animators_own(folder: Path, frames: int = 24, loose: int = 3) -> np.ndarray:
    """An OBJ with texture coordinates, vertices in no order, at one place, and in no face; and how it moves."""
    positions, faces = bending(frames)
    mixed = np.random.default_rng(1).permutation(positions.shape[1])
    positions, faces = positions[:, mixed], np.argsort(mixed)[faces]
    for copy in range(5):
        faces[tuple(np.argwhere(faces == copy)[0])] = positions.shape[1] + copy
    positions = np.concatenate([positions, positions[:, :5], 1.5 * positions[:, :loose]], axis=1)
    lines = [
        *(f"v {x!r} {y!r} {z!r}" for x, y, z in positions[0].tolist()),
        "vt 0 0",
        "vt 1 0",
        "vt 0 1",
    ]
    lines += [f"f {a}/1 {b}/2 {c}/3" for a, b, c in (faces + 1).tolist()]
    (folder / "rig.obj").write_text("\n".join(lines))
    for kind in ("pc2", "mdd"):
        with open(folder / f"rig.{kind}", "wb") as file:
            write_cache(file, kind, range(frames), positions, 24.0)
    return positions
