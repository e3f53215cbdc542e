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
from bsm.codec.geometry.attributes import Attribute, at_corners
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.files import conventions
from bsm.files.conventions import placement
from bsm.files.formats import metadata as formats
from bsm.files.formats.appearance import Material, appearance, as_text, held_by, lost, one_line, within
from bsm.files.formats.polygons import Array, Column, Part, Polygons, joined_parts
from bsm.files.parsing import NO_DOUBLES, Doubles, Ints, as_library_error, single_suffices
from bsm.files.unread import Taken, rows_of
from bsm.ground.lengths import metres, unit_named

_SIZES = (1e-6, 0.001, 0.01, 0.0254, 0.3048, 1.0)  # of the units in meters, as lib3mf counts them
_KNOWN = ("Title", "Designer", "Description", "Copyright", "LicenseTerms", "Rating", "CreationDate", "Application")
_TAKEN = Taken(rows_of("3mf"))
_FILES = re.compile(r"\[Content_Types\]\.xml|(.*/)?_rels/.*|.*\.model|.*/", re.IGNORECASE)  # those of each package
_ELSE = "write PLY, OBJ or OFF"
_MOST_OBJECTS, _MOST_COLORS = 1 << 10, 1 << 18
_Painted = Literal["color", "texcoord"]


def read_3mf(data: bytes, limits: Limits) -> Polygons:
    library = imported("lib3mf", "3MF is read with lib3mf", "formats")
    model = library.get_wrapper().CreateModel()
    reader = model.QueryReader("3mf")
    buffer = ctypes.cast(ctypes.c_char_p(data), ctypes.POINTER(ctypes.c_uint8))
    with as_library_error("lib3mf", "this 3MF file"):
        _call(reader, "reader_readfrombuffer", ctypes.c_uint64(len(data)), buffer)
        joined = (read := _Model(library, model, limits)).joined(len(data))
    # lib3mf does not tell what it passes over, so the names in the package are looked at once more.
    with as_library_error("zipfile", "this 3MF file"), zipfile.ZipFile(io.BytesIO(data)) as package:
        names = package.namelist()
        models = (package.read(name) for name in names if name.lower().endswith(".model"))
        others = [name for name in names if f"/{name}" not in read.files and not _FILES.fullmatch(name)]
        unread = _TAKEN.unread_names(
            chain(*map(_TAKEN.in_xml, models), (("", f"the file {name}", "") for name in others))
        )
    return replace(joined, dropped=(*joined.dropped, *unread))


def _call(owner: Any, name: str, *arguments: Any) -> None:
    """Call lib3mf without the lists of its binding, which take a hundred times the memory of an array."""
    owner._wrapper.checkError(owner, getattr(owner._wrapper.lib, f"lib3mf_{name}")(owner._handle, *arguments))


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
        self._uses: dict[int, list[tuple[int, Any]]] = {
            number: [
                ((part := item.GetComponent(i)).GetObjectResource().GetUniqueResourceID(), part.GetTransform())
                for i in range(item.GetComponentCount() if item.IsComponentsObject() else 0)
            ]
            for number, item in self._objects.items()
        }
        # An object is often placed a thousand times: its tables are read once.
        self._made: dict[int, Part] = {}
        self._materials: dict[tuple[int, int], int] = {}
        self._words: dict[int, Material] = {}
        self._images: dict[str, formats.Value] = {}
        self._left: dict[str, None] = {}
        self.files = set[str]()

    def joined(self, size: int) -> Polygons:
        placed = [*_items(self._model.GetBuildItems())]
        visible = [joined for item in placed for joined in self._below(item)]
        if not placed:
            raise MeshError("this 3MF file places no object: its build has no item")
        counts = [((mesh := self._objects[n]).GetVertexCount(), mesh.GetTriangleCount()) for n, *_ in visible]
        parts = (self._part(number, name).placed(matrix) for number, matrix, name in visible)
        joined = joined_parts(parts, counts, self._limits, size)
        group = self._model.GetMetaDataGroup()
        entries = [group.GetMetaData(i) for i in range(group.GetMetaDataCount())]
        metadata: dict[str, formats.Value] = {"up": "z", "unit": unit_named(_SIZES[int(self._model.GetUnit())])}
        metadata |= {str(entry.GetName()): str(entry.GetValue()) for entry in entries}
        if str(metadata.get("Application")).startswith("bsm "):
            metadata["provenance"] = metadata.pop("Application")
        has_words = any(self._words.values())
        metadata |= {**(formats.described(self._words) if has_words else {}), **self._images, **joined.metadata}
        return replace(joined, dropped=tuple(self._left), metadata=metadata)

    def _below(self, item: Any) -> Iterator[tuple[int, Doubles, str]]:
        """The meshes of an item of the build, each with its place and its name."""
        # A stack and no recursion: a file may nest objects deeper than Python can call.
        waiting = [(item.GetObjectResource().GetUniqueResourceID(), _matrix(item.GetObjectTransform()), "")]
        while waiting:
            number, matrix, above = waiting.pop()
            item = self._objects[number]
            name = str(item.GetName()) or above
            self._left |= {f"the assembly {above}": None} if above and name != above else {}
            if item.IsMeshObject():
                yield number, matrix, name
            elif item.IsComponentsObject():
                waiting += [(used, matrix @ _matrix(moved), name) for used, moved in reversed(self._uses[number])]
            else:
                self._left["objects that are not meshes (level sets)"] = None

    def _part(self, number: int, name: str) -> Part:
        if number not in self._made:
            item, kinds = self._objects[number], self._library
            points = _table(item, "meshobject_getvertices", kinds.Position)["Coordinates"].astype(np.float64)
            corners = _table(item, "meshobject_gettriangleindices", kinds.Triangle)["Indices"].astype(np.int64)
            if (use := item.GetType().name) not in ("Model", "Other"):
                self._left[f"the object type {use}"] = None
            columns, materials = self._painted(item, len(corners))
            sizes = np.full(len(corners), 3)
            self._made[number] = Part(points, sizes, corners.reshape(-1), columns, materials, "")
        return replace(self._made[number], name=name)

    def _painted(self, item: Any, count: int) -> tuple[list[Column], Ints]:
        """The colors and texture coordinates of the corners of an object, and the materials of its triangles."""
        properties = _table(item, "meshobject_getalltriangleproperties", self._library.TriangleProperties)
        owners, places = properties["ResourceID"].astype(np.int64), properties["PropertyIDs"].astype(np.int64)
        usual, its, has = item.GetObjectLevelProperty()
        if has:
            places = np.where((owners == 0)[:, None], its, places)
            owners = np.where(owners == 0, usual, owners)
        materials = np.full(count, self._number((0, 0), {}) if (owners == 0).any() or not len(owners) else 0)
        tables: dict[_Painted, tuple[Array, Ints]] = {}
        name: _Painted
        for owner in filter(None, np.unique(owners).tolist()):
            rows = np.flatnonzero(owners == owner)
            used, where = np.unique(places[rows], return_inverse=True)
            kind = self._model.GetPropertyTypeByID(owner).name
            if kind == "BaseMaterial":
                group = self._model.GetBaseMaterialGroupByID(owner)
                numbers = [self._number((owner, p), _material(group, p)) for p in used.tolist()]
                # Corners of a triangle may have several base materials by the file, but the specification only lets the
                # first count.
                materials[rows] = np.array(numbers)[where.reshape(-1, 3)[:, 0]]
                continue
            if kind in ("Composite", "Multi", "NoPropertyType"):
                materials[rows] = self._number((0, 0), {})
                continue
            if kind == "Colors":
                group = self._model.GetColorGroupByID(owner)
                values: Array = np.array([bytes(group.GetColor(p)) for p in used.tolist()])
                values, name, blank = values.view(np.uint8).reshape(-1, 4), "color", np.full((1, 4), 255, np.uint8)
                materials[rows] = self._number((0, 0), {})
            else:
                group = self._model.GetTexture2DGroupByID(owner)
                coordinates = [group.GetTex2Coord(p) for p in used.tolist()]
                values = np.array([(at.U, at.V) for at in coordinates], np.float32).reshape(-1, 2)
                name, blank = "texcoord", np.zeros((1, 2), np.float32)
                materials[rows] = self._textured(owner, group)
            table, indices = tables.get(name, (blank, np.zeros((count, 3), np.int64)))
            indices[rows] = len(table) + where.reshape(-1, 3)
            tables[name] = np.concatenate([table, values]), indices
        columns = [Column(name, table, "corner", name, at.reshape(-1)) for name, (table, at) in tables.items()]
        return columns, materials

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
            self._left["a texture of an unknown format"] = None
            return self._number((owner, -1), {})
        image = len(self._images) // 2
        name = str(attachment.GetPath()).rpartition("/")[2]
        self._images |= {f"image.{image}.name": name, f"image.{image}.data": data}
        return self._number((owner, -1), {"name": name, "map_Kd": image})


def _material(group: Any, place: int) -> Material:
    color = group.GetDisplayColor(place)
    kd, d = (as_text(np.array(numbers) / 255) for numbers in ((color.Red, color.Green, color.Blue), color.Alpha))
    return {"name": str(group.GetName(place)), "Kd": kd, **({} if d == "1" else {"d": d})}


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
    place, size = placement(mesh.metadata, "3mf"), metres(str(mesh.metadata.get("unit", "")))
    unit = next((number for number, unit_size in enumerate(_SIZES) if size and math.isclose(unit_size, size)), None)
    scale = size / _SIZES[1] if unit is None and size else 1.0
    model.SetUnit(library.ModelUnit(1 if unit is None else unit))
    if not single_suffices(positions := scale * mesh.positions @ place.turn.T):
        raise MeshError(NO_DOUBLES.format("3MF"))
    # lib3mf would refuse the whole mesh with a number in place of a reason.
    if repeated := int((mesh.faces == np.roll(mesh.faces, 1, axis=1)).any(axis=1).sum()):
        raise MeshError(f"{counted(faces=repeated)} with one vertex twice, which 3MF does not have; {_ELSE}")
    metadata_held = {"up", "unit"} & ({*place.expressed} | ({"unit"} if size else set()))
    numbers, materials = formats.face_numbers(mesh, "material"), formats.materials_in(mesh.metadata)
    which = np.zeros(len(mesh.faces), np.int64) if numbers is None else numbers.values[:, 0]
    sorting, objects = _objects(mesh)
    metadata_held |= {f"{sorting.name}.names", *(f"{sorting.name}.{n}.name" for n in objects)} if sorting else {"name"}
    painted = _colored(library, model, which, materials, metadata_held) if materials else None
    color = formats.first(mesh, "color", (3, 4), "vertex", "corner", "face")
    shades = None if color is None else _bytes_of(at_corners(color, mesh.faces))
    looks = [number for number, words in materials.items() if words.keys() - {"name"}]
    hidden = np.isin(which, looks)  # a triangle has the color of its material, or of its corners
    tinted = None if shades is None else _tinted(library, model, shades)
    if shades is None or tinted is None or (shades[hidden] != 255).any():
        color = None
    else:
        painted = tinted if painted is None else np.where(hidden, painted, tinted)
    for name, rows in objects.values():
        item, used = model.AddMeshObject(), np.unique(mesh.faces[rows]) if sorting else np.arange(len(positions))
        corners = np.searchsorted(used, mesh.faces[rows]).astype(np.uint32)
        kinds = ((positions[used].astype(np.float32), library.Position), (corners, library.Triangle))
        _call(item, "meshobject_setgeometry", *chain.from_iterable(_counted(table, kind) for table, kind in kinds))
        if painted is not None:
            first = painted[rows[0]]
            item.SetObjectLevelProperty(int(first["ResourceID"]), int(first["PropertyIDs"][0]))
            _call(item, "meshobject_setalltriangleproperties", *_counted(painted[rows], library.TriangleProperties))
        item.SetName(one_line(name))
        model.AddBuildItem(item, library.get_wrapper().GetIdentityTransform())
    entries = {"Application": mesh.metadata.get("provenance"), **mesh.metadata}
    for name in _KNOWN:
        if isinstance(value := entries.get(name), str):
            model.GetMetaDataGroup().AddMetaData("", name, value.encode(errors="replace").decode(), "xs:string", True)
            metadata_held |= {key for key in (name, "provenance") if mesh.metadata.get(key) == value}
    writer = model.QueryWriter("3mf")
    largest = max(float(np.abs(positions).max(initial=0)), 1e-30)
    # Coordinates become text. As many decimals as single precision has digits, counted from the largest coordinate.
    writer.SetDecimalPrecision(int(np.clip(8 - math.floor(math.log10(largest)), 0, 15)))  # more of them go wrong
    data = _table(writer, "writer_writetobuffer", ctypes.c_uint8).tobytes()
    attributes_written = [numbers if materials else None, sorting, color]
    finer = () if color is None or color.values.dtype == np.uint8 else (f"{color.name} beyond 8 bits",)
    lost = formats.left_out(mesh, attributes_written, [name for name in mesh.metadata if name not in metadata_held])
    return formats.Written(data, (*lost, *finer))


def _objects(mesh: TriangleMesh) -> tuple[Attribute | None, dict[int, tuple[str, Ints]]]:
    """Return the attribute of faces that tells objects apart, if one does, and the name and the faces of each."""
    for sorting in filter(None, (formats.face_numbers(mesh, what) for what in ("part", "object"))):
        kinds, names = np.unique(sorting.values), formats.names_in(mesh.metadata, sorting.name)
        if 1 < len(kinds) <= _MOST_OBJECTS:
            return sorting, {n: (names.get(n, ""), np.flatnonzero(sorting.values == n)) for n in kinds.tolist()}
    return None, {0: (str(mesh.metadata.get("name") or ""), np.arange(len(mesh.faces)))}


def _counted(rows: Array, kind: Any) -> tuple[Any, Any]:
    """The number of rows, and a table of them, as lib3mf takes it."""
    return ctypes.c_uint64(len(rows)), (kind * len(rows)).from_buffer_copy(rows.tobytes())


def _bytes_of(colors: Array) -> Array:
    """Return colors of corners, shape (m, 3, c), as bytes with an opacity."""
    shares = conventions.shares_of(colors).clip(0, 1)
    opaque = np.pad(shares, ((0, 0), (0, 0), (0, 4 - colors.shape[2])), constant_values=1.0)
    return np.asarray(np.rint(255 * opaque), np.uint8)


def _tinted(library: Any, model: Any, colors: Array) -> Array | None:
    """Return the colors of the corners of each triangle as properties; None for more of them than are written."""
    used, where = np.unique(colors.reshape(-1, 4).view(np.uint32)[:, 0], return_inverse=True)
    if len(used) > _MOST_COLORS:
        return None
    group = model.AddColorGroup()
    places = [group.AddColor(library.Color(*rgba)) for rgba in used.view(np.uint8).reshape(-1, 4).tolist()]
    properties = np.zeros(len(colors), np.dtype(library.TriangleProperties))
    properties["ResourceID"], properties["PropertyIDs"] = (
        group.GetUniqueResourceID(),
        np.array(places)[where].reshape(-1, 3),
    )
    return properties


def _colored(
    library: Any, model: Any, numbers: Ints, materials: Mapping[int, Material], fields_held: set[str]
) -> Array:
    """Return the color of each triangle by its material; `held` gets the metadata that this holds."""
    used, where = np.unique(numbers, return_inverse=True)
    group = model.AddBaseMaterialGroup()
    places = np.full(len(used), group.AddMaterial("none", library.Color(255, 255, 255, 255)), np.uint32)
    for place in np.flatnonzero(np.isin(used, [*materials])).tolist():
        number, words = int(used[place]), materials[int(used[place])]
        look, _ = within(appearance(words))
        shares = conventions.to_srgb(np.array([*look.color, look.opacity]))
        rgba = library.Color(*np.rint(255 * shares).astype(int).tolist())
        places[place] = group.AddMaterial(one_line(str(words.get("name") or f"material {number}")), rgba)
        fields_held |= {f"material.{number}.{word}" for word in words.keys() - {*lost(words, held_by("3MF"))}}
    properties = np.zeros(len(numbers), np.dtype(library.TriangleProperties))
    properties["ResourceID"], properties["PropertyIDs"] = group.GetUniqueResourceID(), places[where][:, None]
    return properties
