"""Materials and their images in a mesh's metadata, and in the library of an OBJ.

The metadata "material.0.name", "material.0.Kd", ... hold the properties of material 0, under the names of the file:
those of MTL, or of glTF; numbers that belong together are a text of numbers. What refers to an image holds its number:
the file's name is "image.0.name", its bytes are "image.0.data". Which face has which material is the attribute
"material".
"""

import json
import os
import re
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from itertools import count
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import FormatError, LimitError
from bsm.bitstream.limits import Limits
from bsm.codec.geometry.attributes import Attribute, Domain, Semantic
from bsm.codec.geometry.mesh import Metadata, TriangleMesh
from bsm.codec.geometry.welding import first_of, group_rows, split_with_origin
from bsm.files.conventions import shares_of
from bsm.files.formats.appearance import (
    Material,
    held_by,
    is_black_beside_image,
    lost,
    one_line,
    parse_mtl,
)
from bsm.files.pipes import file_beside

Value: TypeAlias = "str | int | float | bytes"

_ENTRY = re.compile(r"(material|image)\.(\d{1,9})\.(.+)", re.DOTALL)
_NAMES = re.compile(r"(.+?)\.(?:names|\d{1,9}\.name)")
CALLED, COMPONENTS = "called.", "components."
"""What begins the metadata with the name of an attribute in its file, and with those of its components, a line each."""
NONE = ".none"  # what ends the name of an attribute that marks where another one has no value
_NAMED_APART = 16  # names that have an entry each; there can be 256 in all
_SIGNATURES = {
    b"\x89PNG\r\n\x1a\n": "png",
    b"\xff\xd8\xff": "jpg",
    b"GIF8": "gif",
    b"BM": "bmp",
    b"II*\0": "tif",
    b"MM\0*": "tif",
    b"RIFF": "webp",
    b"DDS ": "dds",
    b"\xabKTX": "ktx",
    b"v/1\x01": "exr",
    b"#?RADIANCE": "hdr",
}
_TILES = re.compile(r"<(UDIM|UVTILE)>")  # stand for the numbers of several images
_TGA = re.compile(
    rb".[\0\1][\1-\3\x09-\x0b].{9}(?!\0\0)..(?!\0\0)..[\x08\x0f\x10\x18\x20].", re.DOTALL
)
"""A TGA has no signature: kinds of its colors, width, height, and bits of a pixel."""


def without_materials(metadata: Metadata) -> Metadata:
    """What does not say how the mesh looks."""
    plain_metadata = without_names(metadata, ("material",))
    return {name: value for name, value in plain_metadata.items() if not _ENTRY.fullmatch(name)}


def without_names(metadata: Metadata, attributes: Collection[str]) -> Metadata:
    """Metadata without the names of the values of attributes."""
    matches = {name: _NAMES.fullmatch(name) for name in metadata}
    return {
        name: metadata[name]
        for name, match in matches.items()
        if match is None or match[1] not in attributes
    }


def kind_of_image(data: bytes) -> str | None:
    """Return the suffix of an image by its first bytes; None for unknown formats."""
    for signature, kind in _SIGNATURES.items():
        if data.startswith(signature):
            return kind
    if _TGA.match(data):
        return "tga"
    return None


def named(names: Sequence[str], what: str) -> dict[str, str]:
    """The metadata that call the things 0, 1, ... so: "<what>.<number>.name", or, of many, one text "<what>.names"."""
    if len(names) <= _NAMED_APART:
        return {f"{what}.{number}.name": name for number, name in enumerate(names)}
    return {f"{what}.names": "\n".join(map(one_line, names))}


def names_in(metadata: Metadata, what: str) -> dict[int, str]:
    together = metadata.get(f"{what}.names")
    names: dict[int, str] = {}
    if isinstance(together, str):
        names = dict(enumerate(together.split("\n")))
    for key, name in metadata.items():
        if match := re.fullmatch(rf"{what}\.(\d{{1,9}})\.name", key):
            names[int(match[1])] = str(name)
    return names


def materials_in(metadata: Metadata) -> dict[int, Material]:
    materials: dict[int, Material] = {
        number: {"name": name} for number, name in names_in(metadata, "material").items()
    }
    for kind, number, name, value in _entries(metadata):
        if kind == "material" and not isinstance(value, bytes):
            materials.setdefault(number, {})[name] = value
    return dict(sorted(materials.items()))


def images_in(metadata: Metadata) -> dict[int, tuple[str, bytes]]:
    """Return the name and the bytes of every image, by number; unknown ones are empty."""
    images: dict[int, tuple[str, bytes]] = {}
    for kind, number, name, value in _entries(metadata):
        if kind == "image":
            image_name, data = images.get(number, ("", b""))
            if name == "name" and isinstance(value, str):
                images[number] = (value, data)
            elif name == "data" and isinstance(value, bytes):
                images[number] = (image_name, value)
    return dict(sorted(images.items()))


def _entries(metadata: Metadata) -> Iterable[tuple[str, int, str, Value]]:
    for key, value in metadata.items():
        if match := _ENTRY.fullmatch(key):
            yield match[1], int(match[2]), match[3], value


def described(materials: Mapping[int, Material]) -> dict[str, Value]:
    entries: dict[str, Value] = {}
    for number, material in materials.items():
        for word, value in material.items():
            entries[f"material.{number}.{word}"] = value
    return entries


# --------------------------------------------------------------------------------------------------- the files beside


def fetched(
    metadata: Metadata, read: Callable[[str], bytes | str]
) -> tuple[dict[str, Value], list[str], tuple[str, ...]]:
    """Return metadata with the contents of the files that they name, notes on those that `read` has not, and losses."""
    contents = dict(metadata)
    notes: list[str] = []
    images: dict[str, int] = {}
    libraries: list[dict[str, Material]] = []
    folders: dict[str, str] = {}
    for line in str(contents.get("mtllib", "")).split("\n"):
        names = [line]
        if len(line.split()) > 1 and not isinstance(read(line), bytes):
            names = line.split()
        for name in names:
            library = read(name)
            if isinstance(library, bytes):
                known_images = {*images}
                libraries.append(parse_mtl(library, images))
                folder = name.replace("\\", "/").rpartition("/")[0]
                if folder:
                    folders |= dict.fromkeys(images.keys() - known_images, folder)
            elif name:
                notes.append(f"the materials in {name} were left out: {library}")
    library_notes, lost = _add_libraries(contents, libraries)
    notes += library_notes
    contents |= {f"image.{number}.name": name for name, number in images.items()}
    for key in [key for key in contents if key.startswith("image.") and key.endswith(".name")]:
        name = str(contents[key])
        place = key.removesuffix("name") + "data"
        if place in contents:
            continue
        if _TILES.search(name):
            lost.append(f"the images {name}, of which a material has one")
            continue
        image = _read_image(name, folders.get(name), read)
        if isinstance(image, bytes):
            contents[place] = image
        else:
            notes.append(f"the image {name} was left out, its name was kept: {image}")
    return contents, notes, tuple(lost)


def _read_image(name: str, folder: str | None, read: Callable[[str], bytes | str]) -> bytes | str:
    """Return an image beside its library, or else beside the mesh, or why there is none."""
    image: bytes | str = ""
    if folder is not None:
        image = read(f"{folder}/{name}")
    if isinstance(image, str):
        image = read(name)
    if isinstance(image, bytes) and kind_of_image(image) is None:
        return "its format is not known"
    return image


def _add_libraries(
    contents: dict[str, Value], libraries: Sequence[Mapping[str, Material]]
) -> tuple[list[str], list[str]]:
    """Add the materials of libraries, the first of each name, those that faces name first; return notes and losses."""
    numbers = {
        str(material.get("name", "")): number for number, material in materials_in(contents).items()
    }
    materials: dict[str, Material] = {}
    for library in reversed(libraries):
        materials |= library
    notes: list[str] = []
    absent = [name for name in numbers if name and name not in materials]
    if libraries and absent:
        notes.append(f"no library has these materials: {', '.join(absent[:_MOST_NAMED])}")
    black = [name for name, material in materials.items() if is_black_beside_image(material)]
    if black:
        notes.append(
            f"black beside an image, which other formats get white: {', '.join(black[:_MOST_NAMED])}"
        )
    free = count(max(numbers.values(), default=-1) + 1)
    for name, material in materials.items():
        if name not in numbers:
            numbers[name] = next(free)
        contents |= described({numbers[name]: {"name": name, **material}})
    repeated: dict[str, None] = {}
    for library in libraries:
        repeated |= dict.fromkeys(name for name in library if library[name] != materials[name])
    return notes, [f"the material {name} of a later library" for name in repeated]


def plain_fields(fields: Mapping[str, Any]) -> tuple[dict[str, Value], list[str]]:
    """Return the field data of VTK that are one text, one number, or bytes each, and the names of all others."""
    plain: dict[str, Value] = {}
    others: list[str] = []
    for name, table in fields.items():
        values = np.asarray(table)
        if values.dtype == np.uint8:
            plain[name] = values.tobytes()
        elif values.size == 1 and isinstance(
            value := values.reshape(-1)[0].item(), str | int | float
        ):
            plain[name] = value
        else:
            others.append(name)
    return plain, others


_READ = 4  # times the largest section of a stream that all files beside a mesh may have together


class Beside:
    """The files in the folder of a mesh, each read once; each of them must fit into a section of a stream."""

    def __init__(self, folder: Path | None, limits: Limits) -> None:
        self._folder, self._most, self._left = (
            folder,
            limits.frame_bytes,
            _READ * limits.frame_bytes,
        )
        self._read: dict[Path, bytes] = {}

    def find(self, name: str) -> Path | str:
        """Return where a file is, by its path or its name alone, in any case, or why it is not there."""
        if self._folder is None:
            return "the mesh did not come from a file"
        relative, reason = name.replace("\\", "/"), ""
        for candidate in (relative, relative.rpartition("/")[2]):
            for spelled in (candidate, _in_other_case(self._folder, candidate)):
                try:
                    return file_beside(self._folder, spelled)
                except FormatError as error:
                    reason = reason or str(error)
        return reason

    def read(self, name: str) -> bytes | str:
        """Return the bytes of a file, or why there are none."""
        path = self.find(name)
        if isinstance(path, str):
            return path
        if path not in self._read:
            size = path.stat().st_size
            if size > min(self._most, self._left):
                raise LimitError(
                    f"{name} has {size:,} bytes, over the limit of {min(self._most, self._left):,} for a section "
                    "of a stream (Limits.frame_bytes); make it smaller, or take it away from the mesh"
                )
            self._left -= size
            self._read[path] = path.read_bytes()
        return self._read[path]


def _in_other_case(folder: Path, name: str) -> str:
    """A path below a folder as its files are spelled."""
    spelled_path = Path()
    for part in Path(name).parts:
        names: list[str] = []
        if ".." not in (part, *spelled_path.parts):
            with suppress(OSError):
                names = os.listdir(folder / spelled_path)
        part = next((spelling for spelling in names if spelling.lower() == part.lower()), part)
        spelled_path /= part
    return str(spelled_path)


# Characters of a comment; readers of PLY look for the end of a header in its first 64 KiB.
MOST_TEXT = 1 << 13
_MOST_BYTES = 1 << 15  # of the remarks of one file
_MOST_ENTRIES = 1 << 15  # that are taken from a file: a decoder charges work for each
_ENTRY_BYTES = 16
_REMARK = re.compile(r"meta ([\w.-]{1,255}): (.+)")


def remarks(metadata: Metadata, written: Iterable[str] = ()) -> tuple[list[str], tuple[str, ...]]:
    """Return the lines with metadata, and the names of entries that they cannot hold."""
    lines: list[str] = []
    left_out: list[str] = []
    free = _MOST_BYTES
    elsewhere = set(written)
    for name, value in metadata.items():
        if name in elsewhere:
            continue
        if isinstance(value, bytes):
            left_out.append(name)
            continue
        line = f"meta {name}: {json.dumps(value)}"
        size = len(line.encode(errors="replace")) + _ENTRY_BYTES
        if size > free or not _REMARK.fullmatch(line):
            left_out.append(name)
        else:
            free -= size
            lines.append(line)
    return lines, tuple(left_out)


def parse_remarks(lines: Iterable[str]) -> dict[str, Value]:
    entries: dict[str, Value] = {}
    for match in filter(None, (_REMARK.fullmatch(line.strip()) for line in lines)):
        try:
            value = json.loads(match[2])
            if isinstance(value, str):
                value.encode()  # a lone surrogate cannot be encoded
        except (ValueError, RecursionError):
            continue
        number = isinstance(value, int | float) and not isinstance(value, bool)
        if isinstance(value, str) or (number and abs(value) < 1 << 63):
            entries[match[1]] = value
    return entries


def fitting(metadata: Metadata, limit: int) -> tuple[dict[str, Value], dict[str, str]]:
    """Drop the largest entries until metadata but images fit into `limit` bytes; say why each is left out."""
    refused: dict[str, str] = {}
    images_first = sorted(metadata, key=lambda name: not isinstance(metadata[name], bytes))
    if beyond := images_first[_MOST_ENTRIES:]:
        refused[f"{len(beyond)} entries of metadata, {beyond[0]} and others"] = (
            f"there can be {_MOST_ENTRIES}"
        )
    sizes = {name: _size(name, metadata[name]) for name in images_first[:_MOST_ENTRIES]}
    rising = sorted(sizes, key=sizes.__getitem__)
    for name in rising[int((np.cumsum([sizes[name] for name in rising]) <= limit).sum()) :]:
        refused[name] = (
            f"with its {sizes.pop(name)} bytes the metadata would take more than {limit}"
        )
    return {name: value for name, value in metadata.items() if name in sizes}, refused


def _size(name: str, value: Value) -> int:
    content = b""  # Images: the input pays for them.
    if isinstance(value, str):
        content = value.encode(errors="replace")
    return len(name.encode(errors="replace")) + len(content) + _ENTRY_BYTES


# -------------------------------------------------------------------------------------------------------------- writing


@dataclass(frozen=True)
class Written:
    data: bytes
    left_out: tuple[str, ...] = ()
    beside: Mapping[str, bytes] = field(default_factory=dict)


def unsaid(metadata: Metadata, kind: str) -> list[str]:
    """The names of the words of materials that say more to other programs than a format holds."""
    names: list[str] = []
    for number, material in materials_in(metadata).items():
        names += [f"material.{number}.{word}" for word in lost(material, held_by(kind))]
    return names


def left_out(
    mesh: TriangleMesh,
    attributes: Iterable[Attribute | None],
    metadata: Collection[str],
    in_remarks: Collection[str] = (),
) -> tuple[str, ...]:
    """The names of the attributes that are not among those held, and metadata in words.

    `in_remarks`: metadata that this library reads back, from remarks or extras, and no other program.
    """
    names = {attribute.name for attribute in attributes if attribute is not None}
    missing_attributes = [
        attribute.name for attribute in mesh.attributes if attribute.name not in names
    ]
    for_others = [
        f"{phrase} (for programs other than bsm)" for phrase in in_words(in_remarks, mesh.metadata)
    ]
    return (*missing_attributes, *in_words(metadata, mesh.metadata), *for_others)


_IN_WORDS = {
    "d": "opacity",
    "Tr": "opacity",
    "map_d": "opacity map",
    "alphaMode": "kind of opacity",
}
_MOST_NAMED = 3


def in_words(names: Iterable[str], metadata: Metadata) -> list[str]:
    """Return metadata as a user knows them: "opacity of material Glass", "the image oak.png"."""
    phrases: list[str] = []
    words_of_materials: dict[str, dict[str, None]] = {}
    for name in names:
        if name.startswith((CALLED, COMPONENTS)):
            continue
        match = _ENTRY.fullmatch(name)
        if match is None:
            phrases.append(name)
            continue
        kind, number, entry = match.groups()
        thing_name = str(metadata.get(f"{kind}.{number}.name") or number)
        if kind == "material":
            words_of_materials.setdefault(thing_name, {})[_IN_WORDS.get(entry, entry)] = None
        elif entry == "data" or f"image.{number}.data" not in metadata:
            phrases.append(f"the image {thing_name}")
    materials_by_words: dict[str, list[str]] = {}
    for material, words in words_of_materials.items():
        materials_by_words.setdefault(", ".join(words), []).append(material)
    for words_text, materials in materials_by_words.items():
        plural, ending = "", ""
        if len(materials) > 1:
            plural = "s"
        more = len(materials) - _MOST_NAMED
        if more > 0:
            ending = f" and {more} more"
        named_materials = ", ".join(materials[:_MOST_NAMED])
        phrases.append(f"{words_text} of material{plural} {named_materials}{ending}")
    return phrases


def name_in_file(metadata: Metadata, attribute: Attribute) -> str:
    """The name that the file of a mesh has for an attribute."""
    return str(metadata.get(f"{CALLED}{attribute.name}") or attribute.name)


def components_in_file(metadata: Metadata, attribute: Attribute) -> list[str]:
    """The names that the file of a mesh has for the components of an attribute; none if it has none."""
    names = str(metadata.get(f"{COMPONENTS}{attribute.name}", "")).split("\n")
    if len(names) != attribute.components or not all(names):
        return []
    return names


def with_none(attributes: Iterable[Attribute]) -> dict[str, npt.NDArray[Any]]:
    """The values of attributes by name, with NaN where others mark that there are none, and without the marks."""
    every = {attribute.name: attribute for attribute in attributes}
    values = {name: attribute.values for name, attribute in every.items()}
    for name, attribute in every.items():
        marks = every.get(f"{name}{NONE}")
        if (
            marks is not None
            and marks.domain == attribute.domain
            and attribute.values.dtype.kind == "f"
        ):
            values[name] = np.where(values.pop(marks.name) > 0, np.nan, attribute.values)
    return values


def split_at_seams(mesh: TriangleMesh, *seams: Attribute | None) -> TriangleMesh:
    """Split the vertices of a mesh where corners differ in some of its attributes; others of corners stay so.

    The vertices of the mesh keep their numbers, and copies follow them.
    """
    unsplit = [
        attribute
        for attribute in mesh.attributes
        if attribute.domain == "corner" and attribute not in seams
    ]
    parted = [attribute for attribute in mesh.attributes if attribute not in unsplit]
    split, origin = split_with_origin(replace(mesh, attributes=tuple(parted)))
    is_copy = np.diff(origin, prepend=-1) == 0
    order = np.argsort(is_copy, kind="stable")
    moved = [attribute.taken(order, np.arange(len(mesh.faces))) for attribute in split.attributes]
    faces = np.argsort(order)[split.faces].astype(np.int32)
    return replace(
        split, positions=split.positions[order], faces=faces, attributes=(*moved, *unsplit)
    )


def first(
    mesh: TriangleMesh, semantic: Semantic, components: Collection[int], *domains: Domain
) -> Attribute | None:
    """The first attribute of a meaning that is of one of the domains, and has one of the numbers of components."""
    fits = (
        a
        for a in mesh.attributes
        if a.semantic == semantic and a.domain in domains and a.components in components
    )
    return next(fits, None)


def without_seams(attribute: Attribute, mesh: TriangleMesh) -> Attribute:
    """An attribute of corners with each value once, or of vertices if all corners of each have the same value."""
    if attribute.indices is None:
        return attribute
    same = group_rows(attribute.values.astype(np.float64).view(np.int64))
    first, corners = first_of(same), same[attribute.indices]
    by_vertex = np.zeros(len(mesh.positions), np.int64)
    by_vertex[mesh.faces] = corners
    if np.array_equal(by_vertex[mesh.faces], corners):
        return replace(
            attribute, values=attribute.values[first[by_vertex]], domain="vertex", indices=None
        )
    return replace(attribute, values=attribute.values[first], indices=corners.astype(np.int32))


def face_numbers(mesh: TriangleMesh, name: str) -> Attribute | None:
    """The attribute of this name, if it is a whole number for each face."""
    fits = (
        a for a in mesh.attributes if a.name == name and a.domain == "face" and a.components == 1
    )
    attribute = next(fits, None)
    if attribute is None or attribute.values.dtype.kind not in "iu":
        return None
    return attribute


def shown_at_vertices(
    mesh: TriangleMesh,
) -> tuple[Attribute | None, Attribute | None, Attribute | None]:
    """The normals, colors and texture coordinates of vertices that other programs show."""
    return (
        first(mesh, "normal", (3,), "vertex"),
        first(mesh, "color", (3, 4), "vertex"),
        first(mesh, "texcoord", (2, 3), "vertex"),
    )


def rgba(color: Attribute) -> npt.NDArray[np.uint8]:
    """Colors as bytes, with an opaque alpha where there is none."""
    values = np.rint(shares_of(color.values).clip(0, 1) * 255).astype(np.uint8)
    return np.hstack([values, np.full((len(values), 4 - values.shape[1]), 255, np.uint8)])


class Library:
    """The materials of a mesh as files beside it; names begin with that of the mesh, or are those of linked images."""

    def __init__(self, mesh: TriangleMesh, stem: str) -> None:
        self.materials: dict[int, Material] = materials_in(mesh.metadata)
        self.images: dict[int, str] = {}
        self.beside: dict[str, bytes] = {}
        self.written: set[str] = set()
        """The metadata that these files hold."""
        for number, (name, data) in images_in(mesh.metadata).items():
            if not data:
                self.images[number] = one_line(name)
                self.written.add(f"image.{number}.name")
            elif kind := kind_of_image(data):
                shared = f"image.{number}.link" in mesh.metadata and re.fullmatch(
                    r"\w[\w .-]*", name
                )
                self.images[number] = f"{stem}.{number}.{kind}"
                if shared:
                    self.images[number] = name
                self.beside[self.images[number]] = data
                self.written |= {f"image.{number}.{what}" for what in ("data", "name", "link")}
