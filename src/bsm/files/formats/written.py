"""What comes out when a mesh is written in a format."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from bsm.codec.geometry.attributes import Attribute, Domain, Semantic
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.files.formats.metadata import Material, images_in, kind_of_image, materials_in, one_line


@dataclass(frozen=True)
class Written:
    """A mesh file as it will be written."""

    data: bytes
    left_out: tuple[str, ...] = ()
    beside: Mapping[str, bytes] = field(default_factory=dict)


def left_out(mesh: TriangleMesh, held: Iterable[Attribute | None], metadata: Collection[str]) -> tuple[str, ...]:
    """The names of the attributes that are not among those held, and of metadata."""
    names = {attribute.name for attribute in held if attribute is not None}
    return (*(a.name for a in mesh.attributes if a.name not in names), *metadata)


def first(mesh: TriangleMesh, semantic: Semantic, components: Collection[int], *domains: Domain) -> Attribute | None:
    """The first attribute of a meaning that is of one of the domains, and has one of the numbers of components."""
    fits = (a for a in mesh.attributes if a.semantic == semantic and a.domain in domains and a.components in components)
    return next(fits, None)


def face_numbers(mesh: TriangleMesh, name: str) -> Attribute | None:
    """The attribute of this name, if it is a whole number for each face."""
    fits = (a for a in mesh.attributes if a.name == name and a.domain == "face" and a.components == 1)
    found = next(fits, None)
    return found if found is not None and found.values.dtype.kind in "iu" else None


def shown_at_vertices(mesh: TriangleMesh) -> tuple[Attribute | None, Attribute | None, Attribute | None]:
    """The normals, colours and texture coordinates of vertices that other programs show."""
    return (
        first(mesh, "normal", (3,), "vertex"),
        first(mesh, "color", (3, 4), "vertex"),
        first(mesh, "texcoord", (2, 3), "vertex"),
    )


def rgba(color: Attribute) -> npt.NDArray[np.uint8]:
    """Colours as bytes, with an opaque alpha where there is none."""
    values = color.values
    if values.dtype == np.uint16:
        values = values / 65535
    if values.dtype != np.uint8:
        values = np.rint(np.clip(values, 0, 1) * 255).astype(np.uint8)
    return np.hstack([values, np.full((len(values), 4 - values.shape[1]), 255, np.uint8)])


class Library:
    """The materials of a mesh as files beside it; their names begin with that of the mesh."""

    def __init__(self, mesh: TriangleMesh, stem: str) -> None:
        self.materials: dict[int, Material] = materials_in(mesh.metadata)
        self.images: dict[int, str] = {}
        self.beside: dict[str, bytes] = {}
        self.said: set[str] = set()
        """The metadata that these files hold."""
        for number, (name, data) in images_in(mesh.metadata).items():
            if not data:
                self.images[number] = one_line(name)
                self.said.add(f"image.{number}.name")
            elif kind := kind_of_image(data):
                self.images[number] = f"{stem}.{number}.{kind}"
                self.beside[self.images[number]] = data
                self.said |= {f"image.{number}.data", f"image.{number}.name"}
