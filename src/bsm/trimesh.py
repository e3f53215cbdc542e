"""trimesh opens and writes .bsm: ``import bsm.trimesh``, then ``trimesh.load("a.bsm")`` and ``mesh.export("b.bsm")``.

What a mesh shows goes along: texture coordinates, materials and their images as `TextureVisuals`, colours as
`ColorVisuals`, normals, and other values as `vertex_attributes` and `face_attributes`.
"""

from bsm.libraries.trimesh import from_trimesh, to_scene, to_trimesh

__all__ = ["from_trimesh", "to_scene", "to_trimesh"]
