"""3MF by lib3mf, the library of the 3MF Consortium: objects where the build places them, read as one mesh; a mesh is
written as an object for each part, with the colors of its materials, or of corners."""

import ctypes
import io
import math
import re
import zipfile
from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import chain
from typing import Any, Literal

import numpy as np

from bsm.bitstream.errors import MeshError, counted, imported
from bsm.bitstream.limits import Limits
from bsm.codec.arrays import Mask
from bsm.codec.geometry.attributes import Attribute, at_corners
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.files import conventions
from bsm.files.conventions import placement
from bsm.files.formats import metadata as formats
from bsm.files.formats.appearance import (
    Material,
    appearance,
    as_text,
    held_by,
    lost,
    one_line,
    within,
)
from bsm.files.formats.polygons import Array, Column, Part, Polygons, joined_parts
from bsm.files.parsing import NO_DOUBLES, Doubles, Ints, as_library_error, single_suffices
from bsm.files.unread import Said, Taken, rows_of
from bsm.ground.lengths import metres, unit_named

_SIZES = (1e-6, 0.001, 0.01, 0.0254, 0.3048, 1.0)  # of the units in meters, as lib3mf counts them
_KNOWN = (
    "Title",
    "Designer",
    "Description",
    "Copyright",
    "LicenseTerms",
    "Rating",
    "CreationDate",
    "Application",
)
_TAKEN = Taken(rows_of("3mf"))
# Those of each package.
_FILES = re.compile(r"\[Content_Types\]\.xml|(.*/)?_rels/.*|.*\.model|.*/", re.IGNORECASE)
_ELSE = "write PLY, OBJ or OFF"
_MOST_OBJECTS, _MOST_COLORS = 1 << 10, 1 << 18
_Painted = Literal["color", "texcoord"]


def read_3mf(data: bytes, limits: Limits) -> Polygons:
    library = imported("lib3mf", "3MF is read with lib3mf", "formats")
    library_model = library.get_wrapper().CreateModel()
    reader = library_model.QueryReader("3mf")
    buffer = ctypes.cast(ctypes.c_char_p(data), ctypes.POINTER(ctypes.c_uint8))
    with as_library_error("lib3mf", "this 3MF file"):
        _call(reader, "reader_readfrombuffer", ctypes.c_uint64(len(data)), buffer)
        model = _Model(library, library_model, limits)
        joined = model.joined(len(data))
    # lib3mf does not tell what it passes over, so the names in the package are looked at once more.
    said: list[Said] = []
    with as_library_error("zipfile", "this 3MF file"), zipfile.ZipFile(io.BytesIO(data)) as package:
        names = package.namelist()
        for name in names:
            if name.lower().endswith(".model"):
                said += _TAKEN.in_xml(package.read(name))
    for name in names:
        if f"/{name}" not in model.files and not _FILES.fullmatch(name):
            said.append(("", f"the file {name}", ""))
    return replace(joined, dropped=(*joined.dropped, *_TAKEN.unread_names(said)))


def _call(owner: Any, name: str, *arguments: Any) -> None:
    """Call lib3mf without the lists of its binding, which take a hundred times the memory of an array."""
    wrapper = owner._wrapper
    function = getattr(wrapper.lib, f"lib3mf_{name}")
    wrapper.checkError(owner, function(owner._handle, *arguments))


def _table(owner: Any, name: str, kind: Any) -> Array:
    # Asked twice, as all of lib3mf: first for the size with no table, then with one of that size.
    needed = ctypes.c_uint64(0)
    _call(owner, name, ctypes.c_uint64(0), needed, None)
    table = (kind * needed.value)()
    _call(owner, name, needed, needed, table)
    return np.frombuffer(table, np.dtype(kind))


def _items(iterator: Any) -> Iterator[Any]:
    while iterator.MoveNext():
        yield iterator.GetCurrent()


class _Model:
    """The objects of a model by their numbers, and what their triangles refer to."""

    def __init__(self, library: Any, model: Any, limits: Limits) -> None:
        self._library, self._model, self._limits = library, model, limits
        self._objects = {item.GetUniqueResourceID(): item for item in _items(model.GetObjects())}
        self._uses = {number: [*_components(item)] for number, item in self._objects.items()}
        # An object is often placed a thousand times: its tables are read once.
        self._shapes: dict[int, Part] = {}
        self._materials: dict[tuple[int, int], int] = {}
        self._words: dict[int, Material] = {}
        self._images: dict[str, formats.Value] = {}
        self._lost: dict[str, None] = {}
        self.files = set[str]()

    def joined(self, size: int) -> Polygons:
        placed = [*_items(self._model.GetBuildItems())]
        visible = list(chain.from_iterable(map(self._below, placed)))
        if not placed:
            raise MeshError("this 3MF file places no object: its build has no item")
        counts: list[tuple[int, int]] = []
        for number, _, _ in visible:
            item = self._objects[number]
            counts.append((item.GetVertexCount(), item.GetTriangleCount()))
        parts = (self._part(number, name).placed(matrix) for number, matrix, name in visible)
        joined = joined_parts(parts, counts, self._limits, size)
        unit = unit_named(_SIZES[int(self._model.GetUnit())])
        metadata: dict[str, formats.Value] = {"up": "z", "unit": unit}
        group = self._model.GetMetaDataGroup()
        for place in range(group.GetMetaDataCount()):
            entry = group.GetMetaData(place)
            metadata[str(entry.GetName())] = str(entry.GetValue())
        if str(metadata.get("Application")).startswith("bsm "):
            metadata["provenance"] = metadata.pop("Application")
        if any(self._words.values()):
            metadata |= formats.described(self._words)
        metadata |= {**self._images, **joined.metadata}
        return replace(joined, dropped=tuple(self._lost), metadata=metadata)

    def _below(self, item: Any) -> Iterator[tuple[int, Doubles, str]]:
        """The meshes of an item of the build, each with its place and its name."""
        # A stack and no recursion: a file may nest objects deeper than Python can call.
        waiting = [
            (item.GetObjectResource().GetUniqueResourceID(), _matrix(item.GetObjectTransform()), "")
        ]
        while waiting:
            number, matrix, assembly = waiting.pop()
            item = self._objects[number]
            name = str(item.GetName()) or assembly
            if assembly and name != assembly:
                self._lost[f"the assembly {assembly}"] = None
            if item.IsMeshObject():
                yield number, matrix, name
            elif item.IsComponentsObject():
                for used, transform in reversed(self._uses[number]):
                    waiting.append((used, matrix @ _matrix(transform), name))
            else:
                self._lost["objects that are not meshes (level sets)"] = None

    def _part(self, number: int, name: str) -> Part:
        if number not in self._shapes:
            item, kinds = self._objects[number], self._library
            points = _table(item, "meshobject_getvertices", kinds.Position)["Coordinates"]
            corners = _table(item, "meshobject_gettriangleindices", kinds.Triangle)["Indices"]
            use = item.GetType().name
            if use not in ("Model", "Other"):
                self._lost[f"the object type {use}"] = None
            columns, materials = self._painted(item, len(corners))
            sizes = np.full(len(corners), 3)
            flat = corners.astype(np.int64).reshape(-1)
            self._shapes[number] = Part(
                points.astype(np.float64), sizes, flat, columns, materials, ""
            )
        return replace(self._shapes[number], name=name)

    def _painted(self, item: Any, count: int) -> tuple[list[Column], Ints]:
        """The colors and texture coordinates of the corners of an object, and the materials of its triangles."""
        properties = _table(
            item, "meshobject_getalltriangleproperties", self._library.TriangleProperties
        )
        owners = properties["ResourceID"].astype(np.int64)
        places = properties["PropertyIDs"].astype(np.int64)
        object_owner, object_place, has_property = item.GetObjectLevelProperty()
        if has_property:
            is_bare = owners == 0
            places[is_bare] = object_place
            owners[is_bare] = object_owner
        materials = np.zeros(count, np.int64)
        if (owners == 0).any() or not len(owners):
            materials[:] = self._number((0, 0), {})
        tables: dict[_Painted, tuple[Array, Ints]] = {}
        for owner in filter(None, np.unique(owners).tolist()):
            rows = np.flatnonzero(owners == owner)
            used, inverse = np.unique(places[rows], return_inverse=True)
            corner_numbers = inverse.reshape(-1, 3)
            kind = self._model.GetPropertyTypeByID(owner).name
            if kind == "BaseMaterial":
                group = self._model.GetBaseMaterialGroupByID(owner)
                numbers = [
                    self._number((owner, place), _material(group, place)) for place in used.tolist()
                ]
                # Corners of a triangle may have several base materials by the file, but the specification only lets the
                # first count.
                materials[rows] = np.array(numbers)[corner_numbers[:, 0]]
                continue
            if kind in ("Composite", "Multi", "NoPropertyType"):
                materials[rows] = self._number((0, 0), {})
                continue
            name: _Painted
            if kind == "Colors":
                name = "color"
                values, blank = self._colors(owner, used.tolist())
                materials[rows] = self._number((0, 0), {})
            else:
                name = "texcoord"
                group = self._model.GetTexture2DGroupByID(owner)
                values, blank = _texcoords(group, used.tolist())
                materials[rows] = self._textured(owner, group)
            table, indices = tables.get(name, (blank, np.zeros((count, 3), np.int64)))
            indices[rows] = len(table) + corner_numbers
            tables[name] = np.concatenate([table, values]), indices
        columns: list[Column] = []
        for name, (table, indices) in tables.items():
            columns.append(Column(name, table, "corner", name, indices.reshape(-1)))
        return columns, materials

    def _colors(self, owner: int, places: list[int]) -> tuple[Array, Array]:
        """The colors of a group at some places, and that of corners without any."""
        group = self._model.GetColorGroupByID(owner)
        data = b"".join(bytes(group.GetColor(place)) for place in places)
        return np.frombuffer(data, np.uint8).reshape(-1, 4), np.full((1, 4), 255, np.uint8)

    def _number(self, key: tuple[int, int], words: Material) -> int:
        number = self._materials.setdefault(key, len(self._materials))
        self._words.setdefault(number, words)
        return number

    def _textured(self, owner: int, group: Any) -> int:
        """The material of a texture, with its image; the library hands over the image as a list."""
        if (owner, -1) in self._materials:
            return self._materials[owner, -1]
        attachment = group.GetTexture2D().GetAttachment()
        self.files.add(str(attachment.GetPath()))
        data = _table(attachment, "attachment_writetobuffer", ctypes.c_uint8).tobytes()
        if formats.kind_of_image(data) is None:
            self._lost["a texture of an unknown format"] = None
            return self._number((owner, -1), {})
        image = len(self._images) // 2
        name = str(attachment.GetPath()).rpartition("/")[2]
        self._images |= {f"image.{image}.name": name, f"image.{image}.data": data}
        return self._number((owner, -1), {"name": name, "map_Kd": image})


def _components(item: Any) -> Iterator[tuple[int, Any]]:
    """The objects that an assembly is made of, each with its transform; none of other objects."""
    if item.IsComponentsObject():
        for place in range(item.GetComponentCount()):
            component = item.GetComponent(place)
            yield component.GetObjectResource().GetUniqueResourceID(), component.GetTransform()


def _texcoords(group: Any, places: list[int]) -> tuple[Array, Array]:
    """The texture coordinates of a group at some places, and those of corners without any."""
    coordinates = [group.GetTex2Coord(place) for place in places]
    values = np.array([(at.U, at.V) for at in coordinates], np.float32)
    return values.reshape(-1, 2), np.zeros((1, 2), np.float32)


def _material(group: Any, place: int) -> Material:
    color = group.GetDisplayColor(place)
    rgba = np.array([color.Red, color.Green, color.Blue, color.Alpha]) / 255
    material: Material = {"name": str(group.GetName(place)), "Kd": as_text(rgba[:3])}
    if color.Alpha < 255:
        material["d"] = as_text(rgba[3])
    return material


def _matrix(transform: Any) -> Doubles:
    matrix = np.eye(4)
    matrix[:3] = np.frombuffer(bytes(transform), np.float32).reshape(4, 3).T
    return matrix


# -------------------------------------------------------------------------------------------------------------- writing


def write_3mf(mesh: TriangleMesh, stem: str) -> formats.Written:
    library = imported("lib3mf", "3MF is written with lib3mf", "formats")
    try:
        return _written(library, mesh)
    except library.ELib3MFException as error:
        raise MeshError(f"lib3mf cannot write this mesh: {str(error)[:200]}; {_ELSE}") from error


def _written(library: Any, mesh: TriangleMesh) -> formats.Written:
    model = library.get_wrapper().CreateModel()
    place = placement(mesh.metadata, "3mf")
    size = metres(str(mesh.metadata.get("unit", "")))
    unit, scale = _unit_of(size)
    model.SetUnit(library.ModelUnit(unit))
    positions = scale * mesh.positions @ place.turn.T
    if not single_suffices(positions):
        raise MeshError(NO_DOUBLES.format("3MF"))
    # lib3mf would refuse the whole mesh with a number in place of a reason.
    repeated = int((mesh.faces == np.roll(mesh.faces, 1, axis=1)).any(axis=1).sum())
    if repeated:
        raise MeshError(
            f"{counted(faces=repeated)} with one vertex twice, which 3MF does not have; {_ELSE}"
        )
    metadata_held = {"up", "unit"} & {*place.expressed}
    if size:
        metadata_held.add("unit")
    numbers, materials = formats.face_numbers(mesh, "material"), formats.materials_in(mesh.metadata)
    sorting, objects = _objects(mesh)
    if sorting is None:
        metadata_held.add("name")
    else:
        metadata_held |= {
            f"{sorting.name}.names",
            *(f"{sorting.name}.{number}.name" for number in objects),
        }
    face_materials: Array = np.zeros(len(mesh.faces), np.int64)
    if numbers is not None:
        face_materials = numbers.values[:, 0]
    painted: Array | None = None
    if materials:
        painted = _colored(library, model, face_materials, materials, metadata_held)
    looks = [number for number, words in materials.items() if words.keys() - {"name"}]
    # A triangle has the color of its material, or of its corners.
    hidden = np.isin(face_materials, looks)
    color = formats.first(mesh, "color", (3, 4), "vertex", "corner", "face")
    tinted: Array | None = None
    if color is not None:
        colors = _bytes_of(at_corners(color, mesh.faces))
        tinted = _tinted(library, model, colors, hidden)
    if tinted is None:
        color = None
    elif painted is None:
        painted = tinted
    else:
        painted = np.where(hidden, painted, tinted)
    for name, rows in objects.values():
        item = model.AddMeshObject()
        used = np.arange(len(positions))
        if sorting is not None:
            used = np.unique(mesh.faces[rows])
        corners = np.searchsorted(used, mesh.faces[rows]).astype(np.uint32)
        points = positions[used].astype(np.float32)
        tables = (*_counted(points, library.Position), *_counted(corners, library.Triangle))
        _call(item, "meshobject_setgeometry", *tables)
        if painted is not None:
            first = painted[rows[0]]
            item.SetObjectLevelProperty(int(first["ResourceID"]), int(first["PropertyIDs"][0]))
            _call(
                item,
                "meshobject_setalltriangleproperties",
                *_counted(painted[rows], library.TriangleProperties),
            )
        item.SetName(one_line(name))
        model.AddBuildItem(item, library.get_wrapper().GetIdentityTransform())
    entries = {"Application": mesh.metadata.get("provenance"), **mesh.metadata}
    group = model.GetMetaDataGroup()
    for name in _KNOWN:
        value = entries.get(name)
        if isinstance(value, str):
            group.AddMetaData("", name, value.encode(errors="replace").decode(), "xs:string", True)
            metadata_held |= {
                key for key in (name, "provenance") if mesh.metadata.get(key) == value
            }
    writer = model.QueryWriter("3mf")
    largest = max(float(np.abs(positions).max(initial=0)), 1e-30)
    # Coordinates become text. As many decimals as single precision has digits, counted from the largest coordinate.
    decimals = 8 - math.floor(math.log10(largest))
    writer.SetDecimalPrecision(int(np.clip(decimals, 0, 15)))  # more of them go wrong
    data = _table(writer, "writer_writetobuffer", ctypes.c_uint8).tobytes()
    if not materials:
        numbers = None
    lost = [name for name in mesh.metadata if name not in metadata_held]
    left_out = formats.left_out(mesh, [numbers, sorting, color], lost)
    if color is not None and color.values.dtype != np.uint8:
        left_out = (*left_out, f"{color.name} beyond 8 bits")
    return formats.Written(data, left_out)


def _unit_of(size: float | None) -> tuple[int, float]:
    """Return the unit of a file, and the factor of positions, for a mesh whose unit has this size in meters."""
    millimeters = 1
    if not size:
        return millimeters, 1.0
    for number, unit_size in enumerate(_SIZES):
        if math.isclose(unit_size, size):
            return number, 1.0
    return millimeters, size / _SIZES[millimeters]


def _objects(mesh: TriangleMesh) -> tuple[Attribute | None, dict[int, tuple[str, Ints]]]:
    """Return the attribute of faces that tells objects apart, if one does, and the name and the faces of each."""
    for what in ("part", "object"):
        sorting = formats.face_numbers(mesh, what)
        if sorting is None:
            continue
        kinds = np.unique(sorting.values).tolist()
        if 1 < len(kinds) <= _MOST_OBJECTS:
            names = formats.names_in(mesh.metadata, what)
            return sorting, {
                n: (names.get(n, ""), np.flatnonzero(sorting.values == n)) for n in kinds
            }
    return None, {0: (str(mesh.metadata.get("name") or ""), np.arange(len(mesh.faces)))}


def _counted(rows: Array, kind: Any) -> tuple[Any, Any]:
    """The number of rows, and a table of them, as lib3mf takes it."""
    return ctypes.c_uint64(len(rows)), (kind * len(rows)).from_buffer_copy(rows.tobytes())


def _bytes_of(colors: Array) -> Array:
    """Return colors of corners, shape (m, 3, c), as bytes with an opacity."""
    shares = conventions.shares_of(colors).clip(0, 1)
    opaque = np.pad(shares, ((0, 0), (0, 0), (0, 4 - colors.shape[2])), constant_values=1.0)
    return np.asarray(np.rint(255 * opaque), np.uint8)


def _tinted(library: Any, model: Any, colors: Array, hidden: Mask) -> Array | None:
    """Return the colors of the corners of each triangle as properties.

    None if there are too many to be written, or if hidden ones are not white, which would be lost.
    """
    used, where = np.unique(colors.reshape(-1, 4).view(np.uint32)[:, 0], return_inverse=True)
    if len(used) > _MOST_COLORS:
        return None
    group = model.AddColorGroup()
    places = [
        group.AddColor(library.Color(*rgba)) for rgba in used.view(np.uint8).reshape(-1, 4).tolist()
    ]
    if (colors[hidden] != 255).any():
        return None
    properties = np.zeros(len(colors), np.dtype(library.TriangleProperties))
    properties["ResourceID"] = group.GetUniqueResourceID()
    properties["PropertyIDs"] = np.array(places)[where].reshape(-1, 3)
    return properties


def _colored(
    library: Any,
    model: Any,
    numbers: Ints,
    materials: Mapping[int, Material],
    fields_held: set[str],
) -> Array:
    """Return the color of each triangle by its material; `fields_held` gets the metadata that this holds."""
    used, where = np.unique(numbers, return_inverse=True)
    group = model.AddBaseMaterialGroup()
    white = group.AddMaterial("none", library.Color(255, 255, 255, 255))
    places = np.full(len(used), white, np.uint32)
    for place, number in enumerate(used.tolist()):
        if number not in materials:
            continue
        words = materials[number]
        look, _ = within(appearance(words))
        shares = conventions.to_srgb(np.array([*look.color, look.opacity]))
        rgba = np.rint(255 * shares).astype(int).tolist()
        name = one_line(str(words.get("name") or f"material {number}"))
        places[place] = group.AddMaterial(name, library.Color(*rgba))
        lost_words = lost(words, held_by("3MF"))
        fields_held |= {f"material.{number}.{word}" for word in words if word not in lost_words}
    properties = np.zeros(len(numbers), np.dtype(library.TriangleProperties))
    properties["ResourceID"] = group.GetUniqueResourceID()
    properties["PropertyIDs"] = places[where][:, None]
    return properties
