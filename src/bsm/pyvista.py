"""pyvista opens and writes .bsm: ``pyvista.read("a.bsm")``, ``mesh.save("b.bsm", preset="fine")``.

Nothing need be imported for that (pyvista 0.48 or later); `to_pyvista` and `from_pyvista` convert meshes. Attributes
are point data and cell data, metadata field data.
"""

from bsm.libraries.pyvista import SequenceReader, from_pyvista, read, to_pyvista, write

__all__ = ["SequenceReader", "from_pyvista", "read", "to_pyvista", "write"]
