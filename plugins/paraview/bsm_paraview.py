"""ParaView opens .bsm, sequences with their times: Tools > Manage Plugins > Load New, and choose this file.

ParaView's Python must find the package: start it with PYTHONPATH set to where `pip install --target FOLDER .` in this
repository put it, with a Python of the version that ParaView has.
"""

from paraview.util.vtkAlgorithm import smdomain, smhint, smproperty, smproxy

from bsm.vtk import StreamSource


@smproxy.reader(
    name="BSMReader", label="BSM", extensions="bsm", file_description="BSM meshes and sequences"
)
class BSMReader(StreamSource):
    """The source, registered with ParaView."""

    @smproperty.stringvector(name="FileName")  # type: ignore[untyped-decorator]
    @smdomain.filelist()  # type: ignore[untyped-decorator]
    @smhint.filechooser(extensions="bsm", file_description="BSM meshes and sequences")  # type: ignore[untyped-decorator]
    def SetFileName(self, name: str) -> None:
        """Name the stream."""
        super().SetFileName(name)

    @smproperty.doublevector(  # type: ignore[untyped-decorator]
        name="TimestepValues", information_only="1", si_class="vtkSITimeStepsProperty"
    )
    def GetTimestepValues(self) -> list[float] | None:
        """The times of a sequence."""
        return super().GetTimestepValues()
