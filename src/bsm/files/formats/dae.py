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
from bsm.files.formats.polygons import Array, Column, Part, Polygons, color_column, compact, cut_holes, joined_parts
from bsm.files.parsing import Doubles, Ints, as_library_error, in_words
from bsm.files.unread import Taken, rows_of
from bsm.ground.lengths import unit_named

_SEMANTICS: dict[str, Semantic] = {"NORMAL": "normal", "TEXCOORD": "texcoord", "COLOR": "color"}
_MOST_ERRORS = 8  # of pycollada that notes name
_NUMBERS = {"diffuse": "Kd", "ambient": "Ka", "specular": "Ks", "emission": "Ke", "shininess": "Ns"}
_NUMBERS["index_of_refraction"] = "Ni"
_IMAGES = {"diffuse": "map_Kd", "ambient": "map_Ka", "specular": "map_Ks", "emission": "map_Ke", "bumpmap": "map_Bump"}
_IMAGES["transparent"] = "map_d"
"""Properties of effects, and what libraries of OBJ call them."""
_TAKEN = Taken(rows_of("dae"))
_DRAWN = ("triangles", "tristrips", "trifans", "polylist", "polygons")
_WAYS = {"WRAP": "repeat", "MIRROR": "mirror", "CLAMP": "clamp"}
_OTHER_WAYS = ("BORDER", "NONE", "NEAREST")  # of textures
_LUMINANCE = (0.212671, 0.715160, 0.072169)  # as COLLADA has it


def read_dae(data: bytes, path: str | None, limits: Limits) -> Polygons:
    collada = imported("collada", "DAE is read with pycollada", "formats")
    beside = Beside(Path(path).resolve().parent if path else None, limits)
    with as_library_error("pycollada"), np.errstate(all="ignore"):  # a later check refuses infinite values
        prepared, unread = _prepared(data)
        document = collada.Collada(io.BytesIO(prepared), ignore=[collada.common.DaeError])
        scene = _Nodes(collada, beside)
        nodes = document.scene.nodes if document.scene is not None else ()
        surfaces = [*_placed(collada, nodes)]
        shapes = [scene.shape(primitive) for primitive, _, _ in surfaces]
        counts = [(len(shape.positions), max(len(shape.corners) - 2 * len(shape.sizes), 0)) for shape in shapes]
        joined = joined_parts(starmap(scene.part, surfaces), counts, limits, len(data))
        about = document.assetInfo
        metadata: dict[str, Value] = {"up": str(about.upaxis or "Y_UP")[0].lower()}
        metadata["unit"] = unit_named(float(about.unitmeter or 1.0))
        tools = [str(contributor.authoring_tool or "") for contributor in about.contributors]
        own_tool = next((tool for tool in tools if tool.startswith("bsm ")), None)
        metadata |= {"provenance": own_tool} if own_tool else {}
        metadata |= described(dict(enumerate(scene.materials.values()))) | scene.images
        errors = [f"unreadable elements ({in_words(error)[:80]})" for error in document.errors[:_MOST_ERRORS]]
        dropped = (*unread, *errors, *scene.absent)
        return replace(joined, metadata={**metadata, **joined.metadata}, dropped=dropped)


def _prepared(data: bytes) -> tuple[bytes, list[str]]:
    """Return a document without what pycollada cannot read, holes of polygons marked, and the names not taken."""
    root, changed = ElementTree.fromstring(data), False
    unread = _TAKEN.unread_names(_TAKEN.in_xml(data))
    for mesh in [element for element in root.iter() if _tag(element) == "mesh"]:
        for drawn in list(mesh):
            for place, holed in enumerate(drawn):
                if _tag(holed) == "ph":
                    rings = [(ring.text or "").split() for ring in holed]
                    ends = " ".join(map(str, accumulate(map(len, rings))))
                    drawn[place] = ElementTree.Element(holed.tag[:-1], {"ends": ends} if len(rings) > 1 else {})
                    drawn[place].text = " ".join(chain.from_iterable(rings))
                    changed = True
            filled = any(_tag(element) == "p" and (element.text or "").strip() for element in drawn)
            if _tag(drawn) in ("lines", "linestrips") or (_tag(drawn) in _DRAWN and not filled):
                mesh.remove(drawn)
                changed = True
    return (ElementTree.tostring(root) if changed else data), unread


def _tag(element: Any) -> str:
    return str(element.tag).rpartition("}")[2]


def _placed(collada: Any, nodes: Any) -> Iterator[tuple[Any, Any, Doubles]]:
    """The primitives with polygons of nodes and of all nodes below them, each with its node and matrix."""
    waiting = [(node, np.eye(4)) for node in reversed(nodes)]
    while waiting:
        node, matrix = waiting.pop()
        if isinstance(node, collada.scene.GeometryNode):
            yield from ((one, node, matrix) for one in node.geometry.primitives if one.vertex is not None)
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
            sizes = np.asarray(getattr(primitive, "vcounts", np.full(len(primitive.index), 3)), np.int64)
            index = np.asarray(primitive.index, np.int64).reshape(-1, primitive.index.shape[-1])
            sizes, corner_rows = _without_holes(primitive, sizes, index.shape[1])
            index = index[corner_rows]
            rows, corners = np.unique(np.asarray(primitive.vertex_index).reshape(-1)[corner_rows], return_inverse=True)
            if rows.size and rows[0] < 0:  # numpy would count from the end
                raise FormatError(f"a corner has the index {rows[0]}, which no vertex has")
            points = np.asarray(primitive.vertex, np.float64)[rows]
            part = Part(points, sizes, corners.reshape(-1), _columns(primitive, index), np.zeros_like(sizes), "")
            self._shapes[id(primitive)] = part
        return self._shapes[id(primitive)]

    def part(self, primitive: Any, node: Any, matrix: Doubles) -> Part:
        bound = {material.symbol: material.target for material in node.materials}
        material = bound.get(primitive.material)
        name = None if material is None else str(material.id)
        if name not in self.materials:
            first = str(next((source[3] for source in primitive.sources.get("TEXCOORD", ())), 0) or 0)
            others = {symbol for use in node.materials for symbol, _, number in use.inputs if str(number or 0) != first}
            self.materials[name] = {} if material is None else self._words(material, others)
        shape, number = self.shape(primitive), list(self.materials).index(name)
        named_part = replace(
            shape, materials=shape.materials + number, name=str(node.geometry.name or node.geometry.id)
        )
        return named_part.placed(matrix)

    def _words(self, material: Any, others: set[str]) -> Material:
        """A material in the words of libraries of OBJ, which are those of COLLADA."""
        effect, fields = material.effect, dict[str, Any](name=str(material.name or material.id))
        for attribute, word in _NUMBERS.items():
            value = getattr(effect, attribute)
            if isinstance(value, tuple | list):
                fields[word] = as_text(value[:3])
            elif isinstance(value, int | float):
                fields[word] = float(value)
        for attribute, word in _IMAGES.items():
            if isinstance(value := getattr(effect, attribute), self._collada.material.Map):
                name = str(value.sampler.surface.image.path)
                image = self._beside.read(unquote(name))
                ways = {_tag(one): str(one.text).strip() for one in value.sampler.xmlnode.iter()}
                self.absent |= {f"{name} {way} of textures": None for name, way in ways.items() if way in _OTHER_WAYS}
                self.absent |= {"the texcoord set of textures": None} if value.texcoord in others else {}
                why = image if isinstance(image, str) else "" if kind_of_image(image) else "its format is not known"
                if why:
                    self.absent[f"the image {name[:80]} ({why})"] = None
                    continue
                number = self._numbers.setdefault(name, len(self._numbers))
                wrap = tuple(_WAYS.get(ways.get(side, ""), "repeat") for side in ("wrap_s", "wrap_t"))
                fields |= Texture(number, wrap=wrap).in_words(word)
                self.images |= {f"image.{number}.name": name, f"image.{number}.data": image}
        if (opacity := _opacity(effect)) != 1:
            fields["d"] = opacity
        return fields | ({"doubleSided": 1} if effect.double_sided else {})


def _without_holes(primitive: Any, sizes: Ints, width: int) -> tuple[Ints, Any]:
    """Return the sizes of polygons, and the places of their corners, where those with holes are cut into triangles."""
    drawn = [element for element in primitive.xmlnode if _tag(element) == "p"]
    if not any("ends" in element.attrib for element in drawn):
        return sizes, slice(None)
    points = np.asarray(primitive.vertex, np.float64)[np.asarray(primitive.vertex_index).reshape(-1)]
    counts, places = [], []
    for element, size, end in zip(drawn, sizes.tolist(), np.cumsum(sizes).tolist(), strict=True):
        corners = np.arange(end - size, end)
        ends = [int(number) // width for number in element.get("ends", "").split()]
        if ends:
            corners = corners[cut_holes(points[corners], ends).reshape(-1)]
        counts += [3] * (len(corners) // 3) if ends else [size]
        places.append(corners)
    return np.array(counts, np.int64), np.concatenate(places)


def _opacity(effect: Any) -> float:
    """Return the opacity by the color of <transparent> and the number of <transparency>, which is 1 by default."""
    marks = {_tag(element): element for element in effect.xmlnode.iter()}
    mode = marks["transparent"].get("opaque") if "transparent" in marks else None
    color = effect.transparent if isinstance(effect.transparent, tuple | list) else (1.0,) * 4
    share = effect.transparency if "transparency" in marks and isinstance(effect.transparency, int | float) else 1.0
    if str(mode).startswith("RGB"):
        share *= sum(weight * number for weight, number in zip(_LUMINANCE, color))
    else:
        share *= color[3] if len(color) > 3 else 1.0
    return float(1 - share if str(mode).endswith("ZERO") else share)


def _columns(primitive: Any, index: Array) -> list[Column]:
    """Normals, texture coordinates and colors of the corners; of most kinds there may be several."""
    columns = []
    for kind, semantic in _SEMANTICS.items():
        for number, (offset, _, _, _, source) in enumerate(primitive.sources.get(kind, ())):
            values = np.asarray(source.data, np.float64)
            column = Column(semantic, compact(values), "corner", semantic)
            column = color_column(values[:, :4], "corner") if semantic == "color" else column
            columns.append(replace(column, name=f"{semantic}{number or ''}", indices=index[:, offset]))
    return columns
