"""The header of a PLY file: elements, their properties, and comments."""

from __future__ import annotations

import re
from dataclasses import dataclass

from bsm.bitstream.errors import FormatError, LimitError, TruncatedError
from bsm.codec.geometry.mesh import Metadata
from bsm.files.formats.materials import materials_in, refers_to_image
from bsm.files.formats.remarks import parse_remarks

_TYPES = {
    "char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4", "float": "f4",
    "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4",
    "double": "f8", "float32": "f4", "float64": "f8",
}  # fmt: skip
_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
_MAX_ELEMENTS = 64
_MAX_PROPERTIES = 256
"""Of one element: rows are walked once for each list."""
IMAGE = "TextureFile"
"""A comment that begins so names an image; their numbers are those of the property texnumber."""


@dataclass(frozen=True)
class Property:
    """One column of an element: a number, or a list of numbers behind its length (of the type `length`)."""

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
        """The place of the first property that has one of the names, or -1."""
        return next((i for i, column in enumerate(self.properties) if column.name in names), -1)


@dataclass(frozen=True)
class Header:
    """The order of the bytes ("" for text), the elements, where the body begins, and the comments."""

    order: str
    elements: tuple[Element, ...]
    size: int
    comments: tuple[str, ...] = ()

    @property
    def metadata(self) -> Metadata:
        """What the comments say; images are those of materials."""
        images = [line.removeprefix(IMAGE).strip() for line in self.comments if line.startswith(f"{IMAGE} ")]
        found = parse_remarks(line for line in self.comments if not line.startswith(f"{IMAGE} "))
        shown = {
            value
            for material in materials_in(found).values()
            for name, value in material.items()
            if refers_to_image(name)
        }
        for number, name in enumerate(images):
            found[f"image.{number}.name"] = name
            if number not in shown:
                found |= {f"material.{number}.name": name, f"material.{number}.map_Kd": number}
        return found


def parse_header(data: bytes) -> Header:
    """Parse the lines up to `end_header`."""
    begin = re.match(rb"ply[ \t]*(\r\n|\n|\r)", data)
    if begin is None:
        raise FormatError("this is not a PLY file: it does not begin with ply")
    line_end = begin[1]  # old Macintosh files have \r alone
    end = re.compile(rb"[\r\n][ \t]*end_header[ \t]*(?:" + line_end + rb"|\Z)").search(data, begin.end() - 1, 1 << 16)
    if end is None:
        raise TruncatedError("the PLY header has no end_header")
    order: str | None = None
    elements: list[Element] = []
    comments: list[str] = []
    for line in re.split("[\r\n]+", _decoded(data[begin.end() : end.start()])):
        words = line.split()
        try:
            match words:
                case []:
                    pass
                case ["comment" | "obj_info" as keyword, *_]:
                    comments.append(line.strip().removeprefix(keyword).strip())
                case ["format", name, *_]:
                    order = _ORDERS[name]
                case ["element", name, count]:
                    elements.append(Element(name, _count(count), ()))
                case ["property", "list", length, kind, name]:
                    _extend(elements, Property(name, _TYPES[kind], _TYPES[length]))
                case ["property", kind, name]:
                    _extend(elements, Property(name, _TYPES[kind]))
                case _:
                    raise KeyError
        except (KeyError, IndexError, ValueError):
            raise FormatError(f"the PLY header has a line that makes no sense: {line[:80]!r}") from None
    if order is None or len(elements) > _MAX_ELEMENTS:
        raise FormatError("the PLY header names no format, or too many elements")
    return Header(order, tuple(elements), end.end(), tuple(comments))


def _decoded(text: bytes) -> str:
    try:
        return text.decode()
    except UnicodeDecodeError:
        return text.decode("latin-1")


def _count(text: str) -> int:
    if not re.fullmatch(r"\d{1,18}", text):
        raise ValueError
    return int(text)


def _extend(elements: list[Element], column: Property) -> None:
    last = elements[-1]
    if len(last.properties) >= _MAX_PROPERTIES:
        raise LimitError(f"an element of the PLY file has over {_MAX_PROPERTIES} properties")
    elements[-1] = Element(last.name, last.count, (*last.properties, column))
