"""Streams in VTK, sequences with their times: what `bsm.pyvista.SequenceReader` and ParaView's plug-in are made of.

>>> from bsm.vtk import StreamSource
>>> source = StreamSource()
>>> source.SetFileName("dance.bsm")
>>> made = source.Update()
>>> source.GetOutputDataObject(0).GetNumberOfPolys() > 1000
True
"""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

from bsm.bitstream.errors import OptionError
from bsm.codec.arrays import Faces, Positions
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.welding import split_by_attributes, split_with_origin
from bsm.files.motion.frames import USUAL_RATE
from bsm.files.pipes import read_chunks
from bsm.files.stream import SequenceStream, decode_through, decode_whole, peek_header

__all__ = ["Playback", "StreamSource"]


class Playback:
    """The frames of a stream in any order; going on by one costs one frame, going back begins anew."""

    def __init__(self, path: str) -> None:
        self._path = path
        header, chunks = peek_header(read_chunks(path))
        self._mesh: TriangleMesh | None = None
        if header is None or not header.gop_frames:
            self._mesh = split_by_attributes(decode_whole(chunks))
            self.count, self.rate = 1, 0.0
            return
        self.count = header.frames or decode_through(read_chunks(path))
        self._stream, self._frames = self._opened(0)
        self._shown, self._here = next(self._frames)
        self._faces: Faces | None = None  # of the frame that was split last
        rate = self._stream.metadata.get("frame_rate")
        self.rate = (
            float(rate) if isinstance(rate, int | float) and 0 < rate < float("inf") else USUAL_RATE
        )

    def _opened(self, start: int) -> tuple[SequenceStream, Iterator[tuple[int, Positions]]]:
        stream = SequenceStream(read_chunks(self._path), start=start)
        return stream, stream.changing_frames()

    def positions(self, number: int) -> Positions:
        """Positions of a frame of a sequence, shape (n, 3), in the stream's order."""
        if not 0 <= number < self.count:
            raise OptionError(f"frame {number} does not exist; the stream has {self.count}")
        # Groups of frames before the one with this frame are passed over, and not decoded.
        if number < self._shown:
            self._stream, self._frames = self._opened(number)
        if number != self._shown:
            self._shown, self._here = next(frame for frame in self._frames if frame[0] == number)
        return self._here

    def mesh(self, number: int) -> TriangleMesh:
        """A frame, whose vertices are split where corners differ."""
        if self._mesh is not None:
            return self._mesh
        positions, stream = self.positions(number), self._stream
        # Splitting vertices takes longer than decoding a frame, and only depends on faces and corners.
        if stream.faces is not self._faces:
            self._faces = stream.faces
            mesh = TriangleMesh(positions, stream.faces, stream.attributes, stream.metadata)
            self._split, self._origin = split_with_origin(mesh)
        return replace(self._split, positions=positions[self._origin])

    @property
    def times(self) -> tuple[float, ...]:
        """When each frame is shown, in seconds; nothing for a mesh."""
        return tuple(number / self.rate for number in range(self.count)) if self.rate else ()

    def number_at(self, time: float) -> int:
        return min(max(round(time * self.rate), 0), self.count - 1)


def fill(output: Any, mesh: TriangleMesh) -> None:
    """Put a mesh, whose attributes are of vertices and faces, into a `vtkPolyData`."""
    points = vtkPoints()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(mesh.positions), deep=True))
    cells = vtkCellArray()
    offsets = np.arange(0, 3 * len(mesh.faces) + 1, 3, dtype=np.int64)
    corners = np.ascontiguousarray(mesh.faces.reshape(-1), np.int64)
    # Offsets and corners, as VTK 9 holds cells; its older form would be converted on every use.
    cells.SetData(
        numpy_to_vtkIdTypeArray(offsets, deep=True), numpy_to_vtkIdTypeArray(corners, deep=True)
    )
    output.SetPoints(points)
    output.SetPolys(cells)
    for attribute in mesh.attributes:
        data = output.GetCellData() if attribute.domain == "face" else output.GetPointData()
        array = numpy_to_vtk(np.ascontiguousarray(attribute.values), deep=True)
        array.SetName(attribute.name)
        data.AddArray(array)
        if (
            attribute.domain == "vertex"
            and attribute.semantic == "texcoord"
            and attribute.components == 2
        ):
            data.SetActiveTCoords(attribute.name)
        if (
            attribute.domain == "vertex"
            and attribute.semantic == "normal"
            and attribute.components == 3
        ):
            data.SetActiveNormals(attribute.name)


class StreamSource(VTKPythonAlgorithmBase):  # type: ignore[misc]
    """A source for pipelines of VTK: a stream's mesh, or that of the time that is asked for."""

    def __init__(self) -> None:
        super().__init__(nInputPorts=0, nOutputPorts=1, outputType="vtkPolyData")
        self._name = ""
        self._playback: Playback | None = None

    def SetFileName(self, name: str) -> None:
        """Name the stream."""
        if name != self._name:
            self._name, self._playback = name, None
            self.Modified()

    def GetFileName(self) -> str:
        return self._name

    def GetTimestepValues(self) -> list[float] | None:
        """The times of a sequence; None for a mesh."""
        times = self._opened().times if self._name else ()
        return list(times) or None

    def RequestInformation(self, request: Any, inputs: Any, outputs: Any) -> int:
        """Tell the times."""
        executive, about = self.GetExecutive(), outputs.GetInformationObject(0)
        # ParaView keeps the times of the file before otherwise.
        for key in (executive.TIME_STEPS(), executive.TIME_RANGE()):
            about.Remove(key)
        if times := self.GetTimestepValues():
            about.Set(executive.TIME_STEPS(), times, len(times))
            about.Set(executive.TIME_RANGE(), (times[0], times[-1]), 2)
        return 1

    def RequestData(self, request: Any, inputs: Any, outputs: Any) -> int:
        """Give the mesh of the time that is asked for."""
        about, key = outputs.GetInformationObject(0), self.GetExecutive().UPDATE_TIME_STEP()
        playback = self._opened()
        time = about.Get(key) if about.Has(key) else 0.0
        output = vtkPolyData.GetData(about)
        fill(output, playback.mesh(playback.number_at(time)))
        if playback.rate:
            output.GetInformation().Set(output.DATA_TIME_STEP(), time)
        return 1

    def _opened(self) -> Playback:
        if self._playback is None:
            self._playback = Playback(self._name)
        return self._playback
