"""PLY: a header that declares elements and their properties, then the elements, binary or as text."""

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from bsm import _core as _kernels
from bsm.bitstream.errors import FormatError, LimitError, MeshError, TruncatedError
from bsm.bitstream.limits import Limits
from bsm.codec.geometry.attributes import MOST_COMPONENTS, Attribute, Domain, Semantic, at_corners
from bsm.codec.geometry.mesh import Metadata, NoFacesError, TriangleMesh
from bsm.files.formats import metadata as formats
from bsm.files.formats.appearance import appearance, one_line, refers_to_image, text_of
from bsm.files.formats.polygons import (
    PLURALS,
    Array,
    Column,
    Polygons,
    color_column,
    meaning_of,
    unused_name,
)
from bsm.files.parsing import (
    Doubles,
    Ints,
    Rows,
    as_integers,
    ranges,
    require_counts,
    require_lines,
    single_suffices,
)

_WRITTEN_TYPES = {
    "char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4", "float": "f4",
    "double": "f8",
}  # fmt: skip
_TYPES = _WRITTEN_TYPES | {
    "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4",
    "float32": "f4", "float64": "f8", "int64": "i8", "uint64": "u8", "long": "i8", "ulong": "u8",
}  # fmt: skip
_NAMES_OF_TYPES = {kind: name for name, kind in _WRITTEN_TYPES.items()}
_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
MOST_HEADER = 1 << 20
_MAX_ELEMENTS = 64
_LONGEST = 1 << 53  # items of a list in a text
_COUNTED = {"vertex": "vertices", "face": "faces"}
_MAX_PROPERTIES = 256  # of one element: rows are walked once for each list
COMMENTS = ("comment", "obj_info")  # what a line begins with that anybody may write anything in
# A comment that begins so names an image; their numbers are those of the property texnumber.
IMAGE = "TextureFile"


@dataclass(frozen=True)
class Property:
    """One column of an element: a number, or a list of numbers after its length (of the type `length`)."""

    name: str
    type: str
    length: str | None = None


@dataclass(frozen=True)
class Element:
    """A table of `count` rows."""

    name: str
    count: int
    properties: tuple[Property, ...]

    def index(self, *names: str) -> int:
        return next(
            (place for place, column in enumerate(self.properties) if column.name in names), -1
        )

    @property
    def repeated(self) -> list[str]:
        """The names of properties that are there several times."""
        counts = Counter(column.name for column in self.properties)
        return [name for name, count in counts.items() if count > 1]


@dataclass(frozen=True)
class PlyHeader:
    """The order of the bytes ("" for text), the elements, where the body begins, and the comments."""

    order: str
    elements: tuple[Element, ...]
    size: int
    comments: tuple[tuple[str, str], ...] = ()

    @property
    def images(self) -> dict[int, str]:
        """The names of images by their numbers, in the order of the file."""
        numbers = {name: number for number, (name, _) in formats.images_in(self._remarks).items()}
        images: dict[int, str] = {}
        for _, line in self.comments:
            if line.startswith(f"{IMAGE} "):
                images[len(images)] = line.removeprefix(IMAGE).strip()
        return {numbers.get(name, place): name for place, name in images.items()}

    @property
    def _remarks(self) -> dict[str, formats.Value]:
        return formats.parse_remarks(line for _, line in self.comments)

    @property
    def metadata(self) -> Metadata:
        """Return the metadata in the comments; images are those of materials."""
        contents = self._remarks
        for keyword in COMMENTS:
            lines: list[str] = []
            for line_keyword, line in self.comments:
                is_free = (
                    line and not line.startswith(f"{IMAGE} ") and not formats.parse_remarks([line])
                )
                if line_keyword == keyword and is_free:
                    lines.append(line)
            if lines:
                contents.setdefault(keyword, "\n".join(lines))
        image_numbers: set[object] = set()
        for material in formats.materials_in(contents).values():
            image_numbers |= {value for name, value in material.items() if refers_to_image(name)}
        for number, name in self.images.items():
            contents[f"image.{number}.name"] = name
            if number not in image_numbers:
                contents |= {f"material.{number}.name": name, f"material.{number}.map_Kd": number}
        return contents


def parse_header(data: bytes) -> PlyHeader:
    begin = re.match(rb"ply[ \t]*[\r\n]", data)
    if begin is None:
        raise FormatError("this is not a PLY file: it does not begin with ply")
    # A line that ends in \r\n may be the first of the header to do so; old Macintosh files have only \r.
    end = re.compile(rb"[\r\n][ \t]*end_header[ \t]*(?:\r?\n|\r|\Z)").search(
        data, begin.end() - 1, MOST_HEADER
    )
    if end is None:
        raise TruncatedError(f"the PLY header has no end_header in its first {MOST_HEADER} bytes")
    size = end.end()
    # Where all lines before end in \r, \n after the last one is the first byte of the body.
    if end[0].endswith(b"\r\n") and b"\n" not in data[: end.start() + 1]:
        size -= 1
    order: str | None = None
    elements: list[Element] = []
    comments: list[tuple[str, str]] = []
    for line in re.split("[\r\n]+", text_of(data[begin.end() : end.start()])):
        try:
            match line.split():
                case []:
                    pass
                case ["comment" | "obj_info" as keyword, *_]:
                    comments.append((keyword, line.strip().removeprefix(keyword).strip()))
                case ["format", name, *_]:
                    order = _ORDERS[name]
                case ["element", name, count] if re.fullmatch(r"\d{1,18}", count):
                    elements.append(Element(name, int(count), ()))
                case ["property", "list", length, kind, name]:
                    _extend(elements, Property(name, _TYPES[kind], _TYPES[length]))
                case ["property", kind, name]:
                    _extend(elements, Property(name, _TYPES[kind]))
                # A comment, to other programs.
                case [word, *_] if word not in ("format", "element", "property"):
                    comments.append(("comment", line.strip()))
                case _:
                    raise KeyError
        except (KeyError, IndexError, ValueError):
            raise FormatError(f"the PLY header has an invalid line: {line[:80]!r}") from None
    if order is None or len(elements) > _MAX_ELEMENTS:
        raise FormatError("the PLY header names no format, or too many elements")
    return PlyHeader(order, tuple(elements), size, tuple(comments))


def _extend(elements: list[Element], column: Property) -> None:
    last = elements[-1]
    if len(last.properties) >= _MAX_PROPERTIES:
        raise LimitError(f"an element of the PLY file has over {_MAX_PROPERTIES} properties")
    elements[-1] = Element(last.name, last.count, (*last.properties, column))


def tables_of(header: PlyHeader, body: bytes) -> "dict[str, _Table]":
    """The elements of a file by their names; those of a text as integers of eight bytes, lengths among them."""
    tables: dict[str, _Table] = {}
    raw, text = np.frombuffer(body, np.uint8), None
    if not header.order:
        lines = [line for line in body.splitlines() if line.strip()]
        require_lines(len(lines), sum(element.count for element in header.elements))
        text = Rows(lines, "row").values
        # The numbers of a text as integers of eight bytes, so that one walk over rows serves binary files and texts.
        integers = np.where(text == np.rint(text), text, -1).clip(-1, _LONGEST)
        raw = integers.astype("<i8").view(np.uint8)
    begin = 0
    for element in header.elements:
        table = _Table(element, header.order, raw, begin, text)
        tables[element.name] = table
        begin = table.walk(0)[2]
    if text is not None and begin < raw.size:
        raise MeshError(
            f"the rows of this PLY file have {(raw.size - begin) // 8} numbers more than its header says"
        )
    return tables


def _typed(values: Array, kind: str) -> Array:
    """Numbers of a text in the type that the header declares, if they fit into it."""
    with np.errstate(all="ignore"):
        converted = values.astype(kind)
        same = np.dtype(kind).kind == "f" or np.array_equal(converted, values)
    if not same:
        return values
    return converted


@dataclass
class _Table:
    """The rows of an element in bytes, from one of them on, and all numbers of a text."""

    element: Element
    order: str
    raw: npt.NDArray[np.uint8]
    begin: int
    text: Doubles | None

    def numbers(self, place: int) -> Array:
        return self.lists(place)[1]

    def lists(self, place: int) -> tuple[Ints, Array]:
        starts, sizes, _ = self.walk(place)
        kind = np.dtype(self.order + self.element.properties[place].type)
        if self.text is not None:
            return sizes, _typed(self.text[ranges(starts // 8, sizes)], kind.str)
        steps = np.diff(starts)
        step = int(steps[:1].sum())
        # A view of the bytes: indices of all of them would take eight times the memory of the file.
        if len(starts) and (steps == step).all() and (sizes == sizes[0]).all():  # as of most files
            shape = (len(starts), int(sizes[0]))
            values = np.ndarray(
                shape, kind, self.raw.data, int(starts[0]), (step, kind.itemsize)
            ).reshape(-1)
        else:
            items: npt.NDArray[np.uint8] = self.raw[ranges(starts, sizes * kind.itemsize)]
            values = items.view(kind)
        return sizes, values.astype(kind.newbyteorder("="))

    def walk(self, place: int) -> tuple[Ints, Ints, int]:
        """Where each row's property begins, how many items it has, and where the last row ends."""
        # The bytes of the length of each property's lists (0: it is a number), and of an item.
        widths = [
            (self._size(column.length), self._size(column.type))
            for column in self.element.properties
        ]
        count = self.element.count
        # Rows without properties take no bytes, however many they are.
        if not widths:
            count = 0
        # Every row is at least as long as its numbers and the lengths of its lists.
        least = sum(length or width for length, width in widths)
        missing = self.begin + count * least - len(self.raw)
        if missing > 0:
            raise TruncatedError(
                f"the PLY file is cut short: its header claims {missing} bytes more than there are"
            )
        if not any(length for length, _ in widths):
            first = self.begin + sum(width for _, width in widths[:place])
            return (
                first + least * np.arange(count),
                np.ones(count, np.int64),
                self.begin + least * count,
            )
        starts, sizes = np.zeros((2, count), np.int64)
        end = _kernels.walk_rows(
            self.raw, self.begin, np.array(widths), place, self.order == ">", starts, sizes
        )
        if end < 0:
            raise TruncatedError("the PLY file is cut short: a list runs over its end", offset=-end)
        return starts, sizes, end

    def _size(self, kind: str | None) -> int:
        """The bytes of a number; those of a text have eight, and an absent one none."""
        if not kind:
            return 0
        if self.text is not None:
            return 8
        return np.dtype(kind).itemsize


# -------------------------------------------------------------------------------------------------- reading and writing


_GROUPS: tuple[tuple[Semantic, tuple[str, ...]], ...] = (
    ("normal", ("nx", "ny", "nz")),
    ("color", ("red", "green", "blue", "alpha")),
    ("color", ("red", "green", "blue")),
    ("color", ("diffuse_red", "diffuse_green", "diffuse_blue")),
    ("color", ("r", "g", "b")),
    ("texcoord", ("u", "v")),
    ("texcoord", ("s", "t")),
    ("texcoord", ("texture_u", "texture_v")),
    ("texcoord", ("texture_s", "texture_t")),
)
"""Properties that are one value together."""
_USUAL = [group for group in _GROUPS if group[1][0] in ("nx", "red", "s")]
"""Those that are written, unless a file had others."""
_TEXTURE = "texnumber"  # the number of the image of a face, by OpenMVS, MeshLab and VCG
_NAMES = {_TEXTURE: "material", "material_index": "material", "material": "material"}
"""What properties are called here, unless by their own names."""
_WEDGES = "texcoord"  # the list of texture coordinates of corners, by MeshLab, OpenMVS and VTK


def read_ply(data: bytes, limits: Limits) -> Polygons:
    """Read a PLY with points and faces, of any byte order, and whatever numbers they have."""
    header = parse_header(data)
    _require_mesh([element.name for element in header.elements])
    counts = {
        _COUNTED[element.name]: element.count
        for element in header.elements
        if element.name in _COUNTED
    }
    require_counts(limits, **counts)
    tables = tables_of(header, data[header.size :])
    vertex, face = tables["vertex"], tables["face"]
    positions = _positions(vertex)
    corners = face.element.index("vertex_indices", "vertex_index")
    if corners < 0 or face.element.properties[corners].length is None:
        raise MeshError("the faces of this PLY file have no list vertex_indices")
    sizes, items = face.lists(corners)
    textured = bool(header.images)
    wedges, dropped, notes = _wedges(face, corners, sizes, textured)
    columns = [
        *_columns(vertex, "vertex", "xyz", textured),
        *_columns(face, "face", (), textured),
        *wedges,
    ]
    dropped += [
        f"the list {column.name} of vertices"
        for column in vertex.element.properties
        if column.length
    ]
    for element in (vertex.element, face.element):
        dropped += [f"the first {name}, of which there are several" for name in element.repeated]
    dropped += [
        element.name
        for element in header.elements
        if element.name not in _COUNTED and element.count
    ]
    flat = as_integers(items, "a vertex index")
    plain_columns = tuple(_without_textures(columns, header))
    return Polygons(
        positions, sizes, flat, tuple(notes), tuple(dropped), plain_columns, header.metadata
    )


def _require_mesh(names: list[str]) -> None:
    """Refuse a file whose elements are not those of a mesh."""
    if "tristrips" in names:
        raise MeshError(
            "this PLY file holds triangle strips; convert it to faces (MeshLab does when it saves)"
        )
    for name in _COUNTED:
        if names.count(name) > 1:
            raise MeshError(f"this PLY file has the element {name} several times; save it with one")
    if "range_grid" in names and "face" not in names:
        raise NoFacesError(
            "this PLY file is a range grid; mesh it first, for instance with MeshLab"
        )
    if not {*_COUNTED} <= {*names}:
        raise NoFacesError("this PLY file has no faces; point clouds are not supported")


def _positions(vertex: _Table) -> Doubles:
    places = [vertex.element.index(name) for name in "xyz"]
    if min(places) < 0 or any(vertex.element.properties[place].length for place in places):
        raise MeshError("the vertices of this PLY file have no numbers x, y and z")
    with np.errstate(invalid="ignore"):  # a later check refuses NaN
        positions: Doubles = np.column_stack(
            [vertex.numbers(place).astype(np.float64) for place in places]
        )
    return positions


def _columns(
    table: _Table, domain: Domain, needed: Sequence[str], textured: bool
) -> Iterator[Column]:
    """The properties that are numbers, those together that are one value."""
    types: dict[str, str] = {}
    places: dict[str, int] = {}
    for place, column in enumerate(table.element.properties):
        if column.length is None and column.name not in needed:
            types[column.name] = column.type
            places[column.name] = place

    def values_of(names: Sequence[str]) -> Array:
        return np.column_stack([table.numbers(places[name]) for name in names])

    for semantic, names in _GROUPS:
        if not {*names} <= types.keys() or len({types[name] for name in names}) != 1:
            continue
        group = Column(semantic, values_of(names), domain, semantic)
        if semantic == "color":
            group = color_column(_narrow(group.values), domain)
        if group.semantic != semantic:
            continue  # numbers that are not colors keep their names
        for name in names:
            del types[name]
        is_usual = (semantic, names) in _USUAL and not (textured and semantic == "texcoord")
        if not is_usual:
            group = replace(group, components=names)
        yield group
    material_names = [name for name in types if name in _NAMES]
    for name, members in _series(types):
        short_name = _NAMES.get(name, name)
        if name == _TEXTURE and len(material_names) > 1:
            short_name = name  # another property has the materials
        file_name = ""
        if short_name != name:
            file_name = name
        yield Column(short_name, values_of(members), domain, file_name=file_name)


def _narrow(colors: Array) -> Array:
    """Whole numbers as bytes or words if all of them fit: VCG and trimesh show colors of any type of integers."""
    if colors.dtype.kind not in "iu" or not colors.size or colors.min() < 0:
        return colors
    for kind in (np.uint8, np.uint16):
        if colors.max() <= np.iinfo(kind).max:
            return colors.astype(kind)
    return colors


def _without_textures(columns: Sequence[Column], header: PlyHeader) -> list[Column]:
    """Return columns without the numbers of images that `write_ply` adds, which follow from the materials."""
    of_faces = {column.name: column.values for column in columns if column.domain == "face"}
    materials, textures = of_faces.get("material"), of_faces.get(_TEXTURE)
    if materials is None or textures is None:
        return list(columns)
    numbers = _texture_numbers(header.metadata, list(header.images))
    expected = [numbers.get(number, -1) for number in materials[:, 0].tolist()]
    if not np.array_equal(textures[:, 0], expected):
        return list(columns)
    return [column for column in columns if column.name != _TEXTURE]


def _texture_numbers(metadata: Metadata, order: Sequence[int]) -> dict[int, int]:
    """The place of the color image of each material among the images in this order; -1 for none."""
    numbers: dict[int, int] = {}
    for number, words in formats.materials_in(metadata).items():
        texture = appearance(words).color_texture
        numbers[number] = -1
        if texture is not None and texture.image in order:
            numbers[number] = order.index(texture.image)
    return numbers


def _series(types: dict[str, str]) -> Iterator[tuple[str, list[str]]]:
    """Names of properties, those that only differ in a number at the end together: a_0, a_1, ... are a."""
    remaining = dict(types)
    while remaining:
        name, kind = next(iter(remaining.items()))
        stem = name.removesuffix("_0")
        members = [name]
        if stem != name:
            while remaining.get(f"{stem}_{len(members)}") == kind:
                members.append(f"{stem}_{len(members)}")
        if not 2 <= len(members) <= MOST_COMPONENTS:
            stem, members = name, [name]
        yield stem, members
        for member in members:
            del remaining[member]


def _wedges(
    table: _Table, corners: int, sizes: Ints, textured: bool
) -> tuple[list[Column], list[str], list[str]]:
    """Values of corners: lists as long as that of the vertices, or twice, ...; the lists that are not; and notes."""
    columns, dropped, notes = [], [], []
    for place, column in enumerate(table.element.properties):
        name = column.name
        if column.length is None or place == corners:
            continue
        lengths, values = table.lists(place)
        width = int(lengths.max(initial=0)) // max(int(sizes.max(initial=0)), 1)
        if name == _WEDGES:
            width = 2
        is_full = lengths == width * sizes
        if (
            not 1 <= width <= MOST_COMPONENTS
            or not (is_full | (lengths == 0)).all()
            or not is_full.any()
        ):
            dropped.append(name)
            continue
        rows = np.zeros((int(sizes.sum()), width), values.dtype)  # a face without any gets zeros
        rows[np.repeat(is_full, sizes)] = values.reshape(-1, width)
        file_name = ""
        if name == _WEDGES and not textured:
            file_name = _WEDGES
        columns.append(Column(name, rows, "corner", meaning_of(name, width), file_name=file_name))
        if not is_full.all():
            notes.append(
                f"faces without {PLURALS.get(name, name)} were given zeros: {int((~is_full).sum())}"
            )
    return columns, dropped, notes


# ------------------------------------------------------------------------------------------------------------ writing


def write_ply(mesh: TriangleMesh, stem: str) -> formats.Written:
    """The binary PLY of a mesh; values of corners are those of vertices where all corners of each have the same."""
    library = formats.Library(mesh, stem)
    metadata, original = mesh.metadata, mesh
    order = _image_order(library)
    comments, omitted = _comments(metadata, library, order)
    textures = _texture_numbers(metadata, order)
    has_several = len({*textures.values()}) > 1
    wedges = _wedge_texcoords(mesh, textured=bool(order), several=has_several)
    mesh = formats.split_at_seams(
        mesh, *(attribute for attribute in mesh.attributes if attribute is not wedges)
    )
    positions: Array = mesh.positions
    if single_suffices(positions):
        positions = positions.astype(np.float32)
    columns: dict[str, list[tuple[str, Array]]] = {
        "vertex": list(zip("xyz", positions.T)),
        "face": [("vertex_indices", mesh.faces)],
    }
    values = formats.with_none(mesh.attributes)
    for attribute in mesh.attributes:
        if attribute is wedges:
            corner_values = at_corners(attribute, mesh.faces)
            columns["face"].append((_WEDGES, corner_values.reshape(len(mesh.faces), -1)))
        elif attribute.name in values:
            fields = columns[attribute.domain]
            names = _property_names(attribute, metadata, [name for name, _ in fields])
            fields += zip(names, values[attribute.name].T)
    material = formats.face_numbers(mesh, "material")
    if material is not None and has_several and _TEXTURE not in dict(columns["face"]):
        numbers = [textures.get(number, -1) for number in material.values[:, 0].tolist()]
        columns["face"].append((_TEXTURE, np.array(numbers, np.int32)))
    lines = ["ply", "format binary_little_endian 1.0", *comments]
    body: list[bytes] = []
    for element, fields in columns.items():
        properties, rows = table_of(fields)
        lines += [f"element {element} {len(rows)}", *properties]
        body.append(rows.tobytes())
    header = "\n".join([*lines, "end_header", ""])
    in_remarks = [word for word in formats.unsaid(metadata, "PLY") if word not in omitted]
    lost = formats.left_out(original, mesh.attributes, omitted, in_remarks)
    return formats.Written(header.encode() + b"".join(body), lost, library.beside)


def _image_order(library: formats.Library) -> list[int]:
    """The numbers of the images in the order in which they are written: first those of colors, which readers show."""
    color_images: set[int] = set()
    for words in library.materials.values():
        texture = appearance(words).color_texture
        if texture is not None:
            color_images.add(texture.image)
    return sorted(library.images, key=lambda number: number not in color_images)


def _comments(
    metadata: Metadata, library: formats.Library, order: list[int]
) -> tuple[list[str], tuple[str, ...]]:
    """Return the lines with comments, images and metadata, and the names of entries that they cannot hold."""
    lines: list[str] = []
    held = set(library.written)
    for keyword in COMMENTS:
        text = metadata.get(keyword)
        if isinstance(text, str) and len(text) < formats.MOST_TEXT:
            lines += [f"{keyword} {one_line(line)}" for line in text.split("\n")]
            held.add(keyword)
    remarks = [f"{IMAGE} {library.images[number]}" for number in order]
    # Comments of other programs have no numbers, so images count from 0 in their order; ours are named where that
    # fails.
    if order != [*range(len(order))]:
        remarks += formats.remarks(
            {f"image.{number}.name": library.images[number] for number in order}
        )[0]
    held |= {name for name in metadata if name.startswith((formats.CALLED, formats.COMPONENTS))}
    entries, omitted = formats.remarks(metadata, held)
    lines += [f"comment {line}" for line in (*remarks, *entries)]
    return lines, omitted


def table_of(columns: Sequence[tuple[str, Array]]) -> tuple[list[str], Array]:
    """The lines that declare columns, numbers or lists that are as long in each row, and the rows as bytes."""
    lines: list[str] = []
    row: list[Array] = []
    for name, values in columns:
        kind = _NAMES_OF_TYPES[values.dtype.str[1:]]
        table = values
        if values.ndim == 2:
            kind = f"list uchar {kind}"
            row.append(np.full((len(values), 1), values.shape[1], np.uint8))
        else:
            table = values[:, None]
        lines.append(f"property {kind} {name}")
        little = np.ascontiguousarray(table, values.dtype.newbyteorder("<"))
        row.append(little.view(np.uint8))
    return lines, np.hstack(row)


def _wedge_texcoords(mesh: TriangleMesh, *, textured: bool, several: bool) -> Attribute | None:
    """Return the texture coordinates that are written at corners, where programs that show images look for them."""
    texcoord = formats.first(mesh, "texcoord", (2,), "vertex", "corner")
    if texcoord is None or formats.components_in_file(mesh.metadata, texcoord):
        return None
    if mesh.metadata.get(f"{formats.CALLED}{texcoord.name}") == _WEDGES:
        return texcoord
    has_seams = formats.without_seams(texcoord, mesh).domain == "corner"
    if not textured or not (several or has_seams):
        return None
    return texcoord


def _property_names(attribute: Attribute, metadata: Metadata, names_taken: list[str]) -> list[str]:
    """The names of an attribute's properties: those of its file, those that everybody knows, or its own."""
    candidates = [
        [re.sub(r"\s", "_", name) for name in formats.components_in_file(metadata, attribute)]
    ]
    for meaning, usual_names in _USUAL:
        if meaning == attribute.semantic and len(usual_names) == attribute.components:
            candidates.append([*usual_names])
            break
    for names in candidates:
        if names and not {*names} & {*names_taken}:
            return names
    file_name = re.sub(r"\s", "_", formats.name_in_file(metadata, attribute))
    property_names: list[str] = []
    for place in range(attribute.components):
        wished_name = file_name
        if attribute.components > 1:
            wished_name = f"{file_name}_{place}"
        property_names.append(
            unused_name(wished_name, attribute.domain, [*names_taken, *property_names])
        )
    return property_names
