"""trimesh opens and writes .bsm: ``import bsm.trimesh``, then ``trimesh.load("a.bsm")`` and ``mesh.export("b.bsm")``.

What a mesh shows goes along: texture coordinates, materials and their images as `TextureVisuals`, colours as
`ColorVisuals`, normals, and other values as `vertex_attributes` and `face_attributes`.
"""

from __future__ import annotations

from typing import IO, Any

from bsm.api import decode, encode
from bsm.bitstream.limits import DEFAULT_LIMITS
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.files.formats.for_trimesh import arguments_of, parts_of
from bsm.files.formats.with_trimesh import import_trimesh, joined, polygons_of
from bsm.meshes import as_mesh

__all__ = ["from_trimesh", "to_scene", "to_trimesh"]
_library = import_trimesh(".bsm files are opened by trimesh only")


def to_trimesh(mesh: Any) -> Any:
    """A mesh as a `trimesh.Trimesh`.

    Vertices are split where corners differ, in texture coordinates for instance; nothing is merged.

    Parameters
    ----------
    mesh : mesh, pair of arrays, or path
        As `bsm.encode` takes it.

    Returns
    -------
    trimesh.Trimesh

    Raises
    ------
    ArgumentError
        If this is no mesh.

    Examples
    --------
    >>> import bsm.trimesh
    >>> bsm.trimesh.to_trimesh("bunny.bsm").is_watertight
    True
    """
    return _library.Trimesh(**arguments_of(as_mesh(mesh)))


def to_scene(mesh: Any) -> Any:
    """A mesh as a `trimesh.Scene`, with a geometry for each part that it was made of, under its name.

    Parts are what the whole numbers of the face attribute ``part`` say; without it all is one part.

    Parameters
    ----------
    mesh : mesh, pair of arrays, or path
        As `bsm.encode` takes it.

    Returns
    -------
    trimesh.Scene

    Raises
    ------
    ArgumentError
        If this is no mesh.

    Examples
    --------
    >>> import bsm.trimesh, trimesh
    >>> scene = trimesh.Scene({"box": trimesh.creation.box(), "ball": trimesh.creation.icosphere()})
    >>> sorted(bsm.trimesh.to_scene(bsm.decode(bsm.encode(scene))).geometry)
    ['ball', 'box']
    """
    whole = as_mesh(mesh)
    scene = _library.Scene()
    for name, part in parts_of(whole):
        scene.add_geometry(_library.Trimesh(**arguments_of(part)), geom_name=name)
    of_parts = ("material.", "image.", "part.")
    scene.metadata.update({name: value for name, value in whole.metadata.items() if not name.startswith(of_parts)})
    return scene


def from_trimesh(mesh: Any) -> TriangleMesh:
    """A mesh of trimesh, or the parts of a scene where it shows them, with what they show.

    Parameters
    ----------
    mesh : trimesh.Trimesh or trimesh.Scene
        Colours, texture coordinates, materials and other values go along.

    Returns
    -------
    TriangleMesh

    Raises
    ------
    MeshError
        If it has no faces.

    Examples
    --------
    >>> import bsm.trimesh, trimesh
    >>> bsm.trimesh.from_trimesh(trimesh.creation.box())
    TriangleMesh(8 vertices, 12 faces)
    """
    found = joined(mesh, DEFAULT_LIMITS) if isinstance(mesh, _library.Scene) else polygons_of(mesh)
    return found.checked(DEFAULT_LIMITS).mesh


def _load(file_obj: IO[bytes], file_type: str | None = None, **keywords: Any) -> dict[str, Any]:
    return arguments_of(decode(file_obj.read())) | {name: keywords[name] for name in ("process",) if name in keywords}


def _export(mesh: Any, **keywords: Any) -> bytes:
    return encode(from_trimesh(mesh), **keywords)


def register() -> None:
    """Tell trimesh of .bsm; importing this module does it."""
    from trimesh.exchange import export, load

    load.mesh_loaders["bsm"] = _load
    export._mesh_exporters["bsm"] = _export


register()
