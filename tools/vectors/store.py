"""The vectors in their folder: streams, expected meshes, and a manifest that says what each is for."""

from __future__ import annotations

import io
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

FOLDER = Path(__file__).parents[2] / "spec" / "vectors"
MANIFEST = "manifest.json"
RMS, PEAK = 1e-9, 1e-8
"""How far positions may be from the expected ones, in bounding-box diagonals of the expected mesh (or first frame)."""


@dataclass(frozen=True)
class Vector:
    """One stream.

    Parameters
    ----------
    name : str
        The stream is `name`.bsm; what it decodes to `name`.npz.
    probes : str
        One sentence.
    error : str, optional
        Class of the error with which a decoder must refuse it; None: it must be decoded.
    rms, peak : float
        Tolerances of positions.
    """

    name: str
    probes: str
    error: str | None = None
    rms: float = RMS
    peak: float = PEAK

    @property
    def stream(self) -> Path:
        """File of the stream."""
        return FOLDER / f"{self.name}.bsm"

    @property
    def expected(self) -> Path:
        """File with `positions`, shape (n, 3) or for a sequence (T, n, 3), and `faces`, shape (m, 3)."""
        return FOLDER / f"{self.name}.npz"

    def complaint(self, positions: npt.NDArray[Any], faces: npt.NDArray[Any]) -> str | None:
        """What is wrong with a decoded mesh, or None."""
        with np.load(self.expected) as file:
            right, connected = file["positions"], file["faces"]
        if faces.shape != connected.shape or not np.array_equal(faces, connected):
            return "the faces differ"
        if positions.shape != right.shape:
            return f"positions of shape {positions.shape} instead of {right.shape}"
        diagonal = float(
            np.linalg.norm(np.ptp(right.reshape(-1, len(right[0]), 3)[0] if right.ndim == 3 else right, 0))
        )
        distance = np.linalg.norm(positions - right, axis=-1) / diagonal
        rms, peak = float(np.sqrt((distance**2).mean())), float(distance.max())
        if not (rms <= self.rms and peak <= self.peak):
            return f"positions are off by {rms:.1e} (rms; {self.rms:g} is granted) and {peak:.1e} ({self.peak:g})"
        return None


def read_manifest() -> list[Vector]:
    """All vectors.

    Raises
    ------
    FileNotFoundError
        If a stream or an expected mesh is missing.
    """
    entries = json.loads((FOLDER / MANIFEST).read_text())["vectors"]
    vectors = [Vector(**entry) for entry in entries]
    for vector in vectors:
        for path in [vector.stream] if vector.error else [vector.stream, vector.expected]:
            if not path.is_file():
                raise FileNotFoundError(f"{path} is missing")
    return vectors


def write_vectors(streams: dict[Vector, bytes], meshes: dict[Vector, tuple[Any, Any]]) -> None:
    """Replace what is in the folder, but an expected mesh only where it is not within its tolerance."""
    for vector, stream in streams.items():
        vector.stream.write_bytes(stream)
    for vector, (positions, faces) in meshes.items():
        if not vector.expected.is_file() or vector.complaint(positions, faces):
            buffer = io.BytesIO()
            np.savez_compressed(buffer, positions=positions, faces=faces)
            vector.expected.write_bytes(buffer.getvalue())
    for path in FOLDER.iterdir():
        left = path.suffix == ".bsm" and path not in {vector.stream for vector in streams}
        if left or (path.suffix == ".npz" and path not in {vector.expected for vector in meshes}):
            path.unlink()
    entries = [{key: value for key, value in vars(vector).items() if value is not None} for vector in streams]
    (FOLDER / MANIFEST).write_text(json.dumps({"version": 0, "vectors": entries}, indent=1) + "\n")
