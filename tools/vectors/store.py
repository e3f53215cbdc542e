"""The vectors in their folder: streams, expected meshes, and a manifest that says what each is for."""

import io
import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from bsm.bitstream.container.header import HEADER_FIELDS
from bsm.bitstream.container.wire import FrameType
from bsm.bitstream.errors import BsmError
from bsm.codec.geometry.attributes import Attribute
from tools.surgery import frames_of, header_entries, is_brief

FOLDER = Path(__file__).parents[2] / "spec" / "vectors" / "1.0"
"""The vectors of 1.0, which stay what they are."""
NEXT = FOLDER.parent / "1.3"
"""Those of this minor version, which stay from the next one on."""
NEEDS = FOLDER.parent / "needs.json"
"""The documents that each vector needs, of all versions."""
FRAME_NEEDS = {
    FrameType.ORDER: "order",
    FrameType.PARTITION: "paper",
    FrameType.ATTRIBUTE: "attributes",
}
FIELD_NEEDS = (
    "light",
    "congruence",
    "turn",
    "base",
    "swift",
    "repeats",
    "paper",
    "attributes",
    "sequence",
)
MANIFEST = "manifest.json"
ROUNDING = 1e-6
"""How far floats of attributes may be, for ones above 1 relatively."""
Arrays = dict[str, npt.NDArray[Any]]


@dataclass(frozen=True)
class Vector:
    """One stream of the test vectors.

    Parameters
    ----------
    name : str
        The stream is `name`.bsm; what it decodes to `name`.npz.
    probes : str
        One sentence.
    error : str, optional
        Class of the error with which a decoder must refuse it; None: it must be decoded.
    folder : Path, optional
        Where it is.
    """

    name: str
    probes: str
    error: str | None = None
    folder: Path = FOLDER

    @property
    def stream(self) -> Path:
        """File of the stream."""
        return self.folder / f"{self.name}.bsm"

    @property
    def expected(self) -> Path:
        """File with `positions`, shape (n, 3) or for a sequence (T, n, 3), `faces`, shape (m, 3), and attributes."""
        return self.folder / f"{self.name}.npz"

    def complaint(
        self, positions: npt.NDArray[Any], faces: npt.NDArray[Any], attributes: Arrays
    ) -> str | None:
        """What is wrong with a decoded mesh, or None."""
        with np.load(self.expected) as file:
            right, connected = file["positions"], file["faces"]
            expected = {name: file[name] for name in file if name not in ("positions", "faces")}
        if faces.shape != connected.shape or not np.array_equal(faces, connected):
            return "the faces differ"
        if positions.shape != right.shape:
            return f"positions of shape {positions.shape} instead of {right.shape}"
        if set(attributes) != set(expected):
            return f"attributes {sorted(attributes)} instead of {sorted(expected)}"
        for name, values in expected.items():
            if not alike(attributes[name], values):
                return f"{name} differs"
        if not np.array_equal(positions, right):
            return f"positions are off by up to {np.abs(positions - right).max():.1e}"
        return None


def arrays_of(attributes: Iterable[Attribute]) -> Arrays:
    """Attributes as the arrays that spec/vectors/README.md tells of."""
    arrays: Arrays = {}
    for index, attribute in enumerate(attributes):
        arrays[f"attribute {index} {attribute.semantic} {attribute.domain} {attribute.name}"] = (
            attribute.values
        )
        if attribute.indices is not None:
            arrays[f"indices {index}"] = attribute.indices
    return arrays


def arrays_of_frames(
    attributes: Sequence[Attribute], shown: Sequence[Sequence[Attribute]]
) -> Arrays:
    """Attributes of a run as such arrays, of all frames that have `shown` them where they move."""
    arrays = arrays_of(attributes)
    for name, *frames in zip(
        arrays_of(shown[0]) if shown else (), *(arrays_of(each).values() for each in shown)
    ):
        if any(values is not frames[0] for values in frames):
            arrays[name] = np.array(frames)
    return arrays


def alike(found: npt.NDArray[Any], expected: npt.NDArray[Any]) -> bool:
    """Whether two arrays of an attribute are the same, floats but for what rounding may do."""
    if found.dtype != expected.dtype or found.shape != expected.shape:
        return False
    return np.array_equal(found, expected) or (
        found.dtype.kind == "f" and np.allclose(found, expected, rtol=ROUNDING, atol=ROUNDING)
    )


def read_manifest() -> list[Vector]:
    """All vectors of all folders.

    Raises
    ------
    FileNotFoundError
        If a stream or an expected mesh is missing.
    """
    manifests = sorted(FOLDER.parent.glob(f"*/{MANIFEST}"))
    entries = [
        (each.parent, vector)
        for each in manifests
        for vector in json.loads(each.read_text())["vectors"]
    ]
    vectors = [Vector(**vector, folder=folder) for folder, vector in entries]
    for vector in vectors:
        for path in [vector.stream] if vector.error else [vector.stream, vector.expected]:
            if not path.is_file():
                raise FileNotFoundError(f"{path} is missing")
    return vectors


def needs_of(stream: bytes) -> list[str]:
    """Return the documents that a decoder of a stream needs, as far as its frames and header can be read."""
    found = {"core"}
    try:
        found |= {"brief"} if is_brief(stream) else set()
        frames = frames_of(stream)
        found |= {
            name for kind, name in FRAME_NEEDS.items() if kind in {kind for kind, _ in frames}
        }
        fields = set().union(
            *(header_entries(payload) for kind, payload in frames if kind == FrameType.HEADER)
        )
    except (BsmError, TypeError, ValueError):
        return sorted(found)
    return sorted(found | {name for name in FIELD_NEEDS if HEADER_FIELDS[name].key in fields})


def write_needs() -> None:
    """Write which documents each vector needs, of all folders."""
    needs = {vector.name: needs_of(vector.stream.read_bytes()) for vector in read_manifest()}
    lines = (
        f" {json.dumps(name)}: {json.dumps(documents)}" for name, documents in sorted(needs.items())
    )
    NEEDS.write_text("{\n" + ",\n".join(lines) + "\n}\n")


def write_vectors(
    streams: dict[Vector, bytes], meshes: dict[Vector, tuple[Any, Any, Arrays]]
) -> None:
    """Add to the next version's folder."""
    for vector, stream in streams.items():
        vector.stream.write_bytes(stream)
    for vector, (positions, faces, attributes) in meshes.items():
        buffer = io.BytesIO()
        np.savez_compressed(buffer, positions=positions, faces=faces, **attributes)  # type: ignore[arg-type]
        vector.expected.write_bytes(buffer.getvalue())
    manifest = json.loads((NEXT / MANIFEST).read_text())
    manifest["vectors"] += [
        {"name": v.name, "probes": v.probes} | ({"error": v.error} if v.error else {})
        for v in streams
    ]
    (NEXT / MANIFEST).write_text(json.dumps(manifest, indent=1) + "\n")
