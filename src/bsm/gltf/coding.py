"""Arrays of glTF that an extension holds compressed: by BSM streams, Draco, or meshoptimizer."""

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import DependencyError, FormatError, UnsupportedError, imported
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.files.conventions import shares_of, to_linear
from bsm.files.formats.appearance import Texture
from bsm.files.parsing import as_library_error

Array = npt.NDArray[Any]
Tree = dict[str, Any]
KINDS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
COMPONENTS = {np.dtype(kind).name: number for number, kind in KINDS.items()}
FLOAT, UINT = COMPONENTS["float32"], COMPONENTS["uint32"]
TRIANGLES, STRIP, FAN = TRIANGULAR = 4, 5, 6
EXTENSION, DRACO = "EXT_bsm_compression", "KHR_draco_mesh_compression"
INSTANCING, STRENGTH = "EXT_mesh_gpu_instancing", "KHR_materials_emissive_strength"
TRANSFORM, UNLIT = "KHR_texture_transform", "KHR_materials_unlit"
_WRAPS = {10497: "repeat", 33071: "clamp", 33648: "mirror"}
MESHOPT = ("EXT_meshopt_compression", "KHR_meshopt_compression")
MATTE: Tree = {"pbrMetallicRoughness": {"metallicFactor": 0.0, "roughnessFactor": 0.9}}
"""The material that we write where a mesh has none; reading passes over it."""
PIECE = "material"  # the attribute of faces by which decoders sort them
_SEMANTICS = {"TEXCOORD_0": ("texcoord", 0), "TEXCOORD_1": ("texcoord", 1), "COLOR_0": ("color", 0)}


@dataclass(frozen=True, eq=False)
class Drawn:
    """Three vertices for each face of a stream, and the arrays of each vertex by their names in glTF."""

    index: npt.NDArray[np.uint32]
    arrays: dict[str, Array]
    labels: npt.NDArray[np.integer[Any]]

    @property
    def pieces(self) -> list[tuple[int, int]]:
        """For each primitive the first of its corners, and how many these are."""
        starts = np.searchsorted(self.labels, np.unique(self.labels))
        return [
            (int(start), int(end - start)) for start, end in pairwise([*starts, len(self.labels)])
        ]


def drawn(mesh: TriangleMesh) -> Drawn:
    """Draw as the extension defines: a vertex for each vertex and values of attributes that meet at a corner."""
    labels = np.zeros(len(mesh.faces), np.int64)
    attributes: list[Attribute] = []
    for attribute in mesh.attributes:
        if attribute.name == PIECE and attribute.domain == "face":
            labels = attribute.values[:, 0]
        else:
            attributes.append(attribute)
    # Primitives are parts of the index list, so faces of one material must follow each other.
    order = np.argsort(labels, kind="stable")
    corners = mesh.faces[order].ravel()
    seams = {a.name: a.indices[order].ravel() for a in attributes if a.indices is not None}
    vertices: npt.NDArray[np.integer[Any]] = np.arange(len(mesh.positions))
    rows: npt.NDArray[np.integer[Any]] = corners
    if seams:
        # glTF has one index for all attributes: a vertex is split wherever any of them differs.
        different, rows = np.unique(
            np.stack([corners, *seams.values()], axis=1), axis=0, return_inverse=True
        )
        vertices, *value_rows = different.T
        seams = dict(zip(seams, value_rows))
    arrays = {"POSITION": mesh.positions.astype(np.float32)[vertices]}
    for attribute in attributes:
        arrays[attribute.name] = attribute.values[seams.get(attribute.name, vertices)]
    return Drawn(rows.ravel().astype(np.uint32), arrays, np.repeat(labels[order], 3))


def stored(name: str, values: Array, component: int) -> Array:
    """The numbers of an array of a stream in a component type of accessors; integers of colors are shares."""
    if name == "COLOR_0" and component == FLOAT and values.dtype.kind == "u":
        values = shares_of(values)
    return values.astype(KINDS[component])


def array_of(decoded: tuple[TriangleMesh, Drawn], name: str, component: int | None) -> Array:
    """The array of a stream that the extension calls so."""
    mesh, shape = decoded
    if name == "indices":
        return stored(name, shape.index, component or UINT)
    array_name = name
    semantic, place = _SEMANTICS.get(name, ("", 0))
    alike = [attribute.name for attribute in mesh.attributes if attribute.semantic == semantic]
    if name not in shape.arrays and place < len(alike):
        array_name = alike[place]
    if array_name not in shape.arrays:
        raise FormatError(f"a stream of this glTF has no {name[:80]}")
    values = shape.arrays[array_name]
    # In glTF, colors of vertices are linear; meshes have them in sRGB, as all other formats do.
    if name == "COLOR_0" != array_name:  # a stream of a mesh has colors in sRGB
        values = to_linear(shares_of(values))
    return stored(name, values, component or FLOAT)


def unpack_meshopt(data: bytes, extension: Tree) -> bytes:
    """The bytes of a bufferView that meshoptimizer has compressed."""
    count, stride, mode = extension["count"], extension["byteStride"], extension["mode"]
    filter_name = extension.get("filter", "NONE")
    try:
        # Not an extra of the package: few files need it, and the message names it.
        library = imported("meshoptimizer", "", "")
    except DependencyError:
        raise DependencyError(
            "the meshes are compressed with meshopt; run: pip install meshoptimizer"
        ) from None
    filters = {"OCTAHEDRAL": "oct", "QUATERNION": "quat", "EXPONENTIAL": "exp"}
    if mode not in ("ATTRIBUTES", "TRIANGLES", "INDICES") or filter_name not in ("NONE", *filters):
        raise UnsupportedError(
            f"meshopt of mode {str(mode)[:20]} with filter {str(filter_name)[:20]} is not read here"
        )
    unpacked: Array
    with as_library_error("meshoptimizer", "a bufferView of this glTF"):
        if mode == "ATTRIBUTES":
            unpacked = library.decode_vertex_buffer(count, stride, data, np.dtype(("V", stride)))
        elif mode == "TRIANGLES":
            unpacked = library.decode_index_buffer(count, 4, data)
        else:
            unpacked = library.decode_index_sequence(count, 4, data)
    if filter_name != "NONE":
        decode_filter = getattr(library, f"decode_filter_{filters[filter_name]}")
        unpacked = decode_filter(unpacked, count, stride)
    # The library gives four bytes for each index, and the bufferView may want two.
    if mode != "ATTRIBUTES":
        unpacked = unpacked.astype(f"<u{stride}")
    return unpacked.tobytes()


def unpack_draco(data: bytes) -> dict[int, Array]:
    """The arrays of a primitive that Draco has compressed, by their numbers; -1: its triangles."""
    draco = imported(
        "DracoPy", "the meshes are compressed with Draco, which DracoPy reads", "formats"
    )
    with as_library_error("DracoPy", "a primitive of this glTF"):
        mesh = draco.decode(data)
    # glTF refers to attributes of Draco by these numbers, and not by their order.
    tables = {
        int(attribute["unique_id"]): np.atleast_2d(attribute["data"])
        for attribute in mesh.attributes
    }
    return tables | {-1: np.asarray(mesh.faces).reshape(-1, 1)}


def texture_of(info: Tree, sampler: Tree, image: int) -> Texture:
    """A texture as a material refers to it; glTF counts coordinates from above."""
    transform = info.get("extensions", {}).get(TRANSFORM, {})
    across, up = transform.get("scale", (1.0, 1.0))
    right, down = transform.get("offset", (0.0, 0.0))
    turn = transform.get("rotation", 0.0)
    # glTF turns about the upper left corner, with coordinates that count downwards; ours count upwards.
    offset = right + up * math.sin(turn), 1 - up * math.cos(turn) - down
    wrap = tuple(_WRAPS.get(sampler.get(name, 0), "repeat") for name in ("wrapS", "wrapT"))
    return Texture(image, (across, up), offset, turn, wrap, set_of(info))


def set_of(info: Tree) -> int:
    """The number of the texture coordinates of a texture."""
    transform = info.get("extensions", {}).get(TRANSFORM, {})
    number: int = transform.get("texCoord", info.get("texCoord", 0))
    return number


def words_of(texture: Texture) -> tuple[Tree, Tree]:
    """Return the words of a material for a texture, without its number, and the sampler."""
    (across, up), (right, above), turn = texture.scale, texture.offset, texture.rotation
    info: Tree = {}
    if texture.set:
        info["texCoord"] = texture.set
    if (across, up, right, above, turn) != (1, 1, 0, 0, 0):
        offset = [right - up * math.sin(turn), 1 - up * math.cos(turn) - above]
        transform: Tree = {"scale": [across, up], "offset": offset}
        if turn:
            transform["rotation"] = turn
        info["extensions"] = {TRANSFORM: transform}
    if {*texture.wrap} == {"repeat"}:
        return info, {}
    codes = {way: code for code, way in _WRAPS.items()}
    return info, {name: codes[side] for name, side in zip(("wrapS", "wrapT"), texture.wrap)}
