"""DAE (COLLADA): the surfaces of a scene where it places them, read with pycollada."""

import io
from collections.abc import Iterator
from dataclasses import replace
from itertools import accumulate, chain, starmap
from pathlib import Path
from typing import Any
from urllib.parse import unquote
from xml.etree import ElementTree

import numpy as np

from bsm.bitstream.errors import FormatError, imported
from bsm.bitstream.limits import Limits
from bsm.codec.geometry.attributes import Semantic
from bsm.files.formats.appearance import Material, Texture, as_text
from bsm.files.formats.metadata import Beside, Value, described, kind_of_image
from bsm.files.formats.polygons import (
    Array,
    Column,
    Part,
    Polygons,
    color_column,
    compact,
    cut_holes,
    joined_parts,
)
from bsm.files.parsing import Doubles, Ints, as_library_error, in_words
from bsm.files.unread import Taken, rows_of
from bsm.ground.lengths import unit_named

_SEMANTICS: dict[str, Semantic] = {"NORMAL": "normal", "TEXCOORD": "texcoord", "COLOR": "color"}
_MOST_ERRORS = 8  # of pycollada that notes name
_NUMBERS = {"diffuse": "Kd", "ambient": "Ka", "specular": "Ks", "emission": "Ke", "shininess": "Ns"}
_NUMBERS["index_of_refraction"] = "Ni"
_IMAGES = {
    "diffuse": "map_Kd",
    "ambient": "map_Ka",
    "specular": "map_Ks",
    "emission": "map_Ke",
    "bumpmap": "map_Bump",
}
_IMAGES["transparent"] = "map_d"
"""Properties of effects, and what libraries of OBJ call them."""
_TAKEN = Taken(rows_of("dae"))
_DRAWN = ("triangles", "tristrips", "trifans", "polylist", "polygons")
_WAYS = {"WRAP": "repeat", "MIRROR": "mirror", "CLAMP": "clamp"}
_OTHER_WAYS = ("BORDER", "NONE", "NEAREST")  # of textures
_LUMINANCE = (0.212671, 0.715160, 0.072169)  # as COLLADA has it


def read_dae(data: bytes, path: str | None, limits: Limits) -> Polygons:
    collada = imported("collada", "DAE is read with pycollada", "formats")
    folder: Path | None = None
    if path:
        folder = Path(path).resolve().parent
    beside = Beside(folder, limits)
    # A later check refuses infinite values.
    with as_library_error("pycollada"), np.errstate(all="ignore"):
        prepared, unread = _prepared(data)
        document = collada.Collada(io.BytesIO(prepared), ignore=[collada.common.DaeError])
        scene = _Nodes(collada, beside)
        surfaces: list[Any] = []
        if document.scene is not None:
            surfaces += _placed(collada, document.scene.nodes)
        counts: list[tuple[int, int]] = []
        for primitive, _, _ in surfaces:
            shape = scene.shape(primitive)
            triangles = max(len(shape.corners) - 2 * len(shape.sizes), 0)
            counts.append((len(shape.positions), triangles))
        joined = joined_parts(starmap(scene.part, surfaces), counts, limits, len(data))
        metadata = _asset_metadata(document.assetInfo)
        materials_by_number = dict(enumerate(scene.materials.values()))
        metadata |= described(materials_by_number) | scene.images
        errors = [
            f"unreadable elements ({in_words(error)[:80]})"
            for error in document.errors[:_MOST_ERRORS]
        ]
        dropped = (*unread, *errors, *scene.absent)
        return replace(joined, metadata={**metadata, **joined.metadata}, dropped=dropped)


def _asset_metadata(asset: Any) -> dict[str, Value]:
    """Return the axis and the unit of a document, and the provenance of one of ours."""
    metadata: dict[str, Value] = {"up": str(asset.upaxis or "Y_UP")[0].lower()}
    metadata["unit"] = unit_named(float(asset.unitmeter or 1.0))
    for contributor in reversed(asset.contributors):
        tool = str(contributor.authoring_tool or "")
        if tool.startswith("bsm "):
            metadata["provenance"] = tool
    return metadata


def _prepared(data: bytes) -> tuple[bytes, list[str]]:
    """Return a document without what pycollada cannot read, holes of polygons marked, and the names not taken."""
    root, changed = ElementTree.fromstring(data), False
    unread = _TAKEN.unread_names(_TAKEN.in_xml(data))
    for mesh in [element for element in root.iter() if _tag(element) == "mesh"]:
        for drawn in list(mesh):
            for place, element in enumerate(drawn):
                if _tag(element) == "ph":
                    drawn[place] = _with_ends(element)
                    changed = True
            if _is_empty(drawn):
                mesh.remove(drawn)
                changed = True
    if changed:
        data = ElementTree.tostring(root)
    return data, unread


def _with_ends(polygon: Any) -> Any:
    """Return a polygon with holes as one without, whose attribute tells where each ring ends."""
    rings = [(ring.text or "").split() for ring in polygon]
    element = ElementTree.Element(polygon.tag[:-1])
    element.text = " ".join(chain(*rings))
    if len(rings) > 1:
        ends = accumulate(map(len, rings))
        element.set("ends", " ".join(map(str, ends)))
    return element


def _is_empty(drawn: Any) -> bool:
    """Whether an element of a mesh draws no polygons."""
    if _tag(drawn) not in _DRAWN:
        return _tag(drawn) in ("lines", "linestrips")
    return not any(_tag(element) == "p" and (element.text or "").strip() for element in drawn)


def _tag(element: Any) -> str:
    return str(element.tag).rpartition("}")[2]


def _placed(collada: Any, nodes: Any) -> Iterator[tuple[Any, Any, Doubles]]:
    """The primitives with polygons of nodes and of all nodes below them, each with its node and matrix."""
    waiting = [(node, np.eye(4)) for node in reversed(nodes)]
    while waiting:
        node, matrix = waiting.pop()
        if isinstance(node, collada.scene.GeometryNode):
            for primitive in node.geometry.primitives:
                if primitive.vertex is not None:
                    yield primitive, node, matrix
        elif isinstance(node, collada.scene.Node):
            moved = matrix @ node.matrix
            waiting += [(child, moved) for child in reversed(node.children)]


class _Nodes:
    """The materials and images of the surfaces so far."""

    def __init__(self, collada: Any, beside: Beside) -> None:
        self._collada, self._beside = collada, beside
        self.materials: dict[str | None, Material] = {}
        self.images: dict[str, Value] = {}
        self.absent: dict[str, None] = {}
        self._numbers: dict[str, int] = {}
        self._shapes: dict[int, Part] = {}

    def shape(self, primitive: Any) -> Part:
        """The polygons of a primitive, which may stand in several places."""
        if id(primitive) not in self._shapes:
            index = np.asarray(primitive.index, np.int64).reshape(-1, primitive.index.shape[-1])
            of_triangles = np.full(len(primitive.index), 3)
            sizes = np.asarray(getattr(primitive, "vcounts", of_triangles), np.int64)
            sizes, places = _without_holes(primitive, sizes, index.shape[1])
            vertices = np.asarray(primitive.vertex_index).reshape(-1)[places]
            used, corners = np.unique(vertices, return_inverse=True)
            if used.size and used[0] < 0:  # numpy would count from the end
                raise FormatError(f"a corner has the index {used[0]}, which no vertex has")
            points = np.asarray(primitive.vertex, np.float64)[used]
            columns = _columns(primitive, index[places])
            self._shapes[id(primitive)] = Part(
                points, sizes, corners.reshape(-1), columns, np.zeros_like(sizes), ""
            )
        return self._shapes[id(primitive)]

    def part(self, primitive: Any, node: Any, matrix: Doubles) -> Part:
        targets = {material.symbol: material.target for material in node.materials}
        material = targets.get(primitive.material)
        name: str | None = None
        if material is not None:
            name = str(material.id)
        if name not in self.materials:
            self.materials[name] = {}
            if material is not None:
                self.materials[name] = self._words(material, _other_sets(primitive, node))
        shape, number = self.shape(primitive), list(self.materials).index(name)
        geometry_name = str(node.geometry.name or node.geometry.id)
        return replace(shape, materials=shape.materials + number, name=geometry_name).placed(matrix)

    def _words(self, material: Any, others: set[str]) -> Material:
        """A material in the words of libraries of OBJ, which are those of COLLADA."""
        effect = material.effect
        fields: Material = {"name": str(material.name or material.id)}
        for attribute, word in _NUMBERS.items():
            value = getattr(effect, attribute)
            if isinstance(value, tuple | list):
                fields[word] = as_text(value[:3])
            elif isinstance(value, int | float):
                fields[word] = float(value)
        for attribute, word in _IMAGES.items():
            value = getattr(effect, attribute)
            if isinstance(value, self._collada.material.Map):
                texture = self._texture(value, others)
                if texture is not None:
                    fields |= texture.in_words(word)
        opacity = _opacity(effect)
        if opacity != 1:
            fields["d"] = opacity
        if effect.double_sided:
            fields["doubleSided"] = 1
        return fields

    def _texture(self, value: Any, others: set[str]) -> Texture | None:
        """The texture of a property; None if its image is missing."""
        sampler = value.sampler
        name = str(sampler.surface.image.path)
        image = self._beside.read(unquote(name))
        ways = {_tag(element): str(element.text).strip() for element in sampler.xmlnode.iter()}
        for side, way in ways.items():
            if way in _OTHER_WAYS:
                self.absent[f"{side} {way} of textures"] = None
        if value.texcoord in others:
            self.absent["the texcoord set of textures"] = None
        if isinstance(image, bytes) and not kind_of_image(image):
            image = "its format is not known"
        if isinstance(image, str):
            self.absent[f"the image {name[:80]} ({image})"] = None
            return None
        number = self._numbers.setdefault(name, len(self._numbers))
        self.images |= {f"image.{number}.name": name, f"image.{number}.data": image}
        wrap = tuple(_WAYS.get(ways.get(side, ""), "repeat") for side in ("wrap_s", "wrap_t"))
        return Texture(number, wrap=wrap)


def _other_sets(primitive: Any, node: Any) -> set[str]:
    """The symbols of the texture coordinates of a node but for the first set of a primitive."""
    first = "0"
    for source in primitive.sources.get("TEXCOORD", ())[:1]:
        first = str(source[3] or 0)
    others: set[str] = set()
    for material in node.materials:
        others |= {symbol for symbol, _, number in material.inputs if str(number or 0) != first}
    return others


def _without_holes(primitive: Any, sizes: Ints, width: int) -> tuple[Ints, Any]:
    """Return the sizes of polygons, and the places of their corners, where those with holes are cut into triangles."""
    drawn = [element for element in primitive.xmlnode if _tag(element) == "p"]
    if not any("ends" in element.attrib for element in drawn):
        return sizes, slice(None)
    points = np.asarray(primitive.vertex, np.float64)[
        np.asarray(primitive.vertex_index).reshape(-1)
    ]
    counts: list[int] = []
    places: list[Ints] = []
    for element, size, end in zip(drawn, sizes.tolist(), np.cumsum(sizes).tolist(), strict=True):
        corners = np.arange(end - size, end)
        ends = [int(number) // width for number in element.get("ends", "").split()]
        if ends:
            corners = corners[cut_holes(points[corners], ends).reshape(-1)]
            counts += [3] * (len(corners) // 3)
        else:
            counts.append(size)
        places.append(corners)
    return np.array(counts, np.int64), np.concatenate(places)


def _opacity(effect: Any) -> float:
    """Return the opacity by the color of <transparent> and the number of <transparency>, which is 1 by default."""
    marks = {_tag(element): element for element in effect.xmlnode.iter()}
    mode = ""
    if "transparent" in marks:
        mode = str(marks["transparent"].get("opaque"))
    color, share = effect.transparent, 1.0
    if not isinstance(color, tuple | list):
        color = (1.0, 1.0, 1.0, 1.0)
    if "transparency" in marks and isinstance(effect.transparency, int | float):
        share = effect.transparency
    if mode.startswith("RGB"):
        share *= sum(weight * number for weight, number in zip(_LUMINANCE, color))
    elif len(color) > 3:
        share *= color[3]
    if mode.endswith("ZERO"):
        share = 1 - share
    return float(share)


def _columns(primitive: Any, index: Array) -> list[Column]:
    """Normals, texture coordinates and colors of the corners; of most kinds there may be several."""
    columns: list[Column] = []
    for kind, semantic in _SEMANTICS.items():
        for number, (offset, _, _, _, source) in enumerate(primitive.sources.get(kind, ())):
            values = np.asarray(source.data, np.float64)
            if semantic == "color":
                column = color_column(values[:, :4], "corner")
            else:
                column = Column(semantic, compact(values), "corner", semantic)
            columns.append(
                replace(column, name=f"{semantic}{number or ''}", indices=index[:, offset])
            )
    return columns
