"""pyvista opens and writes .bsm: ``pyvista.read("a.bsm")``, ``mesh.save("b.bsm", preset="fine")``.

Nothing need be imported for that (pyvista 0.48 or later); `to_pyvista` and `from_pyvista` convert meshes. Attributes
are point data and cell data, metadata field data.

>>> import bsm.pyvista, pyvista
>>> bsm.pyvista.from_pyvista(pyvista.Sphere())
TriangleMesh(842 vertices, 1680 faces, Normals)
>>> bsm.pyvista.write(pyvista.Sphere(), "sphere.bsm", preset="fine")
>>> reader = bsm.pyvista.SequenceReader("dance.bsm")
>>> reader.number_time_points, reader.at(0.1).n_points > 1000
(6, True)
"""

import os
from typing import Any

import numpy as np

from bsm.api import decode, save
from bsm.bitstream.errors import OptionError, imported
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.welding import split_by_attributes
from bsm.files.libraries import as_mesh

__all__ = ["SequenceReader", "from_pyvista", "read", "to_pyvista", "write"]


def to_pyvista(mesh: Any) -> Any:
    """A mesh as a `pyvista.PolyData`.

    Vertices are split where corners differ, in texture coordinates for instance. Normals and texture coordinates are
    the active ones.
    """
    # Here and not above: without pyvista the module can be imported, and this call says what is missing.
    pyvista = imported("pyvista", "pyvista is not installed", "pyvista")
    from bsm.vtk import fill

    mesh = split_by_attributes(as_mesh(mesh))
    found = pyvista.PolyData()
    fill(found, mesh)
    for name, value in mesh.metadata.items():
        # Numbers, as an array of bytes would be a text to numpy, which loses zeros at its end.
        found.field_data[name] = (
            np.frombuffer(value, np.uint8) if isinstance(value, bytes) else [value]
        )
    return found


def from_pyvista(mesh: Any) -> TriangleMesh:
    """A surface of pyvista as a mesh, with point data, cell data and field data."""
    return as_mesh(mesh)


def read(path: str, **keywords: Any) -> Any:
    """What `pyvista.read` calls for a stream."""
    return to_pyvista(decode(path, **keywords))


def write(mesh: Any, path: str | os.PathLike[str], **keywords: Any) -> None:
    """What `save` of a `pyvista.PolyData` calls for a stream."""
    save(from_pyvista(mesh), path, **keywords)


class SequenceReader:
    """A sequence for pyvista, with its times, as readers of pyvista have them."""

    def __init__(self, path: str | os.PathLike[str]) -> None:
        from bsm.vtk import Playback

        self._playback = Playback(os.fspath(path))
        self._active = 0

    @property
    def number_time_points(self) -> int:
        """Number of frames."""
        return self._playback.count

    @property
    def time_values(self) -> list[float]:
        """When each frame is shown, in seconds."""
        return list(self._playback.times) or [0.0]

    @property
    def active_time_value(self) -> float:
        """The time that `read` gives."""
        return self.time_values[self._active]

    def set_active_time_point(self, number: int) -> None:
        """Choose a frame by its number."""
        if not 0 <= number < self.number_time_points:
            raise OptionError(
                f"frame {number} does not exist; the stream has {self.number_time_points}"
            )
        self._active = number

    def set_active_time_value(self, time: float) -> None:
        """Choose the frame that is shown at a time."""
        self._active = self._playback.number_at(time)

    def read(self) -> Any:
        return to_pyvista(self._playback.mesh(self._active))

    def at(self, time: float) -> Any:
        """The frame that is shown at a time."""
        self.set_active_time_value(time)
        return self.read()
