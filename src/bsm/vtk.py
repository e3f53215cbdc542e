"""Streams in VTK, sequences with their times: what `bsm.pyvista.SequenceReader` and ParaView's plug-in are made of."""

from bsm.libraries.vtk import Playback, StreamSource

__all__ = ["Playback", "StreamSource"]
