"""One model of how a surface looks, and the tables between it and the words of formats.

The model is glTF's metallic-roughness. Metadata keep the words of their file, those of MTL or of glTF: `appearance`
reads both, `in_mtl` and `in_gltf` write them, and `lost` has the words that say more than a format holds. Words in no
field are the source's own, which no other format gets.
"""

import csv
import math
import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

from bsm.files.conventions import to_linear, to_srgb
from bsm.files.parsing import continued, plain_text

Material: TypeAlias = dict[str, "str | int | float"]
Numbers: TypeAlias = tuple[float, ...]


@dataclass(frozen=True)
class Texture:
    """An image by its number; coordinates, which count from the bottom, are scaled, then turned, and then moved."""

    image: int
    scale: Numbers = (1.0, 1.0)
    offset: Numbers = (0.0, 0.0)
    rotation: float = 0.0  # in radians, counterclockwise
    # Beyond the image, across and up; or clamp, mirror.
    wrap: tuple[str, ...] = ("repeat", "repeat")
    set: int = 0  # of texture coordinates

    def in_words(self, word: str) -> Material:
        """Return the entries of a material that say this: the number of the image, options as in MTL, and others."""
        words: Material = {word: self.image}
        scale = " ".join(f"{number:.9g}" for number in self.scale)
        offset = " ".join(f"{number:.9g}" for number in self.offset)
        options: list[str] = []
        if scale != "1 1" or offset != "0 0":
            options.append(f"-s {scale} 1 -o {offset} 0")
        if self.wrap == ("clamp", "clamp"):
            options.append("-clamp on")
        if options:
            words[f"{word}.options"] = " ".join(options)
        if self.rotation:
            words[f"{word}.rotation"] = self.rotation
        if self.wrap not in (("clamp", "clamp"), ("repeat", "repeat")):
            words[f"{word}.wrap"] = " ".join(self.wrap)
        if self.set:
            words[f"{word}.set"] = self.set
        return words


@dataclass(frozen=True)
class Appearance:
    """Linear colors, shares from 0 to 1, and textures, by which these are multiplied."""

    name: str = ""
    color_texture: Texture | None = None
    emission_texture: Texture | None = None
    normal_texture: Texture | None = None
    occlusion_texture: Texture | None = None
    surface_texture: Texture | None = None  # roughness in green, metal in blue
    mode: str = "OPAQUE"  # or MASK, BLEND
    color: Numbers = (1.0, 1.0, 1.0)
    opacity: float = 1.0
    emission: Numbers = (0.0, 0.0, 0.0)
    metallic: float = 1.0
    roughness: float = 1.0
    cutoff: float = 0.5
    double_sided: bool = False
    unlit: bool = False
    # Fields by the words for them.
    stated: Mapping[str, tuple[str, ...]] = field(default_factory=dict, compare=False)

    def says(self, name: str) -> bool:
        """Whether a word says this field, or it is unusual."""
        return any(name in fields for fields in self.stated.values()) or getattr(
            self, name
        ) != getattr(USUAL, name)


USUAL = Appearance()
_ROWS = [*csv.DictReader(Path(__file__).with_suffix(".csv").read_text().splitlines())]
"""A row for each field with its words in each format, those after ~ converted; rows with * have
the entries about each texture; the last row has the words of no field."""


def fields_of(kind: str) -> dict[str, list[str]]:
    """Return the fields that each word of a format says."""
    fields: dict[str, list[str]] = {}
    for row in _ROWS[:-1]:
        if "*" in row["field"]:
            continue
        for word in row[kind].replace("~", "").split():
            fields.setdefault(word, []).append(row["field"])
    return fields


def held_by(kind: str) -> set[str]:
    """Return the fields that a format holds, and the entries about those that are textures."""
    fields = [row["field"] for row in _ROWS[:-1] if row[kind]]
    return {entry.replace("*", name) for name in fields if "*" not in name for entry in fields}


_GLTF, _MTL = fields_of("glTF"), fields_of("MTL")
_OF_MTL = {
    word.lower(): word
    for word in {**_MTL, **dict.fromkeys(_ROWS[-1]["MTL"].split())}
    if word != "name"
}
"""Words of MTL as most files write them, by those in lower case."""
MTL_IMAGES = re.compile(r"map_\w+|bump|disp|decal|norm|refl")
_MOVE = r"\s*-([so])((?:\s+[-+]?[\d.]+(?:e[-+]?\d+)?){1,3})|\s*-clamp\s+(on)\b"
WAYS = ("repeat", "clamp", "mirror")
_MTL_COLORS = ("Ka", "Kd", "Ks", "Ke", "Tf")
_MTL_OPTIONS = re.compile(
    r"((?:-(?:type|colorspace)\s+\w+\s+|-[a-z]+(?:\s+(?:on|off|[lrgbmz]|[-+]?[\d.]+(?:e[-+]?\d+)?))+\s+)*)(\S.*)",
    re.IGNORECASE,
)


def is_mtl(word: str) -> bool:
    return (
        word in _OF_MTL.values() or MTL_IMAGES.fullmatch(word.removesuffix(".options")) is not None
    )


def refers_to_image(word: str) -> bool:
    return word.endswith("Texture") or MTL_IMAGES.fullmatch(word) is not None


def as_numbers(value: object) -> list[float]:
    try:
        numbers = [float(word) for word in str(value).split()]
    except ValueError:
        return []
    if not all(map(math.isfinite, numbers)):
        return []
    return numbers


def appearance(words: Material) -> Appearance:
    """Read the words of a material; where both say a field, that of glTF counts."""
    fields: dict[str, Any] = {}
    fields_by_word: dict[str, tuple[str, ...]] = {}
    for word, names in (*_GLTF.items(), *_MTL.items()):
        if word not in words:
            continue
        values = _read(word, names, words)
        if values:
            fields_by_word[word] = tuple(values)
            fields = values | fields
            for entry in _texture_fields(words, word):
                fields_by_word[f"{word}.{entry}"] = (f"{names[0]}.{entry}",)
    metal, roughness = words.get("map_Pm"), words.get("map_Pr")
    is_metal = any(as_numbers(words.get("Pm", 0)))
    if isinstance(roughness, int) and (metal == roughness or (metal is None and not is_metal)):
        # Gray: green is the roughness, blue counts as metal.
        fields.setdefault("surface_texture", Texture(roughness))
        fields_by_word |= dict.fromkeys(("map_Pr", "map_Pm"), ("surface_texture",))
    if any(map(is_mtl, words)):  # what MTL means where it says nothing
        if metal is not None and "map_Pr" in fields_by_word:
            fields.setdefault("metallic", 1.0)
        fields.setdefault("metallic", 0.0)
        if "map_Ke" in words and not any(fields.get("emission", ())):
            fields["emission"] = (1.0, 1.0, 1.0)
    # The image of the color also holds the opacity.
    if "map_d" in words and words["map_d"] == words.get("map_Kd"):
        fields_by_word["map_d"] = ("mode",)
    if fields.get("opacity", 1.0) < 1 or "map_d" in fields_by_word:
        fields.setdefault("mode", "BLEND")
    if not fields_by_word:
        fields |= {"metallic": 0.0, "roughness": 0.9}  # matte, as in files without a material
    return Appearance(**fields, stated=fields_by_word)


def _read(word: str, names: Sequence[str], words: Material) -> dict[str, Any]:
    """Return the fields that a word says; none where it makes no sense."""
    value = words[word]
    name, usual = names[0], getattr(USUAL, names[0])
    if usual is None:
        if not isinstance(value, int):
            return {}
        texture = Texture(value)
        for fields in _texture_fields(words, word).values():
            texture = replace(texture, **fields)
        return {name: texture}
    if isinstance(usual, str):
        if name != "name" and value not in ("OPAQUE", "MASK", "BLEND"):
            return {}
        return {name: str(value)}
    if isinstance(usual, bool):
        return {name: bool(value)}
    numbers = as_numbers(str(value).removeprefix("-halo"))
    if len(numbers) != len(np.atleast_1d(usual)) + len(names) - 1:
        return {}
    if word == "Kd" and is_black_beside_image(words):
        return {name: usual}
    if isinstance(usual, tuple):
        color = numbers[:3]
        if word in _MTL:
            color = as_numbers(as_text(to_linear(np.array(numbers))))
        return dict(zip(names, (tuple(color), *numbers[3:])))
    if word == "Tr":  # which is the transparency
        return {name: as_numbers(as_text(1 - numbers[0]))[0]}
    return {name: numbers[0]}


def is_black_beside_image(words: Material) -> bool:
    """Whether a color is black only because an image has the colors, as some programs write."""
    return "map_Kd" in words and as_numbers(words.get("Kd")) == [0.0] * 3


def _texture_fields(words: Material, word: str) -> dict[str, dict[str, Any]]:
    """Return the fields of a texture by the entries that say them, but for entries that make no sense."""
    fields: dict[str, dict[str, Any]] = {}
    wrap = tuple(str(words.get(f"{word}.wrap", "")).split())
    if len(wrap) == 2 and {*wrap} <= {*WAYS}:
        fields["wrap"] = {"wrap": wrap}
    rotation = as_numbers(words.get(f"{word}.rotation"))
    if len(rotation) == 1:
        fields["rotation"] = {"rotation": rotation[0]}
    coordinate_set = words.get(f"{word}.set")
    if isinstance(coordinate_set, int) and coordinate_set >= 0:
        fields["set"] = {"set": coordinate_set}
    options = str(words.get(f"{word}.options", ""))
    if re.fullmatch(f"(?:{_MOVE})+", options):
        values = {
            option: tuple(as_numbers(numbers)[:2])
            for option, numbers, _ in re.findall(_MOVE, options)
        }
        scale = (*values.get("s", ()), 1.0, 1.0)[:2]
        offset = (*values.get("o", ()), 0.0, 0.0)[:2]
        fields["options"] = {"scale": scale, "offset": offset}
        if "" in values:
            fields["options"]["wrap"] = ("clamp", "clamp")
    return fields


def within(look: Appearance) -> tuple[Appearance, list[str]]:
    """Return an appearance in the ranges that formats have, and the fields that lay beyond; only light may exceed 1."""
    most = {
        "color": 1.0,
        "opacity": 1.0,
        "metallic": 1.0,
        "roughness": 1.0,
        "emission": math.inf,
        "cutoff": math.inf,
    }
    inside: dict[str, Any] = {}
    for name, limit in most.items():
        value = np.clip(getattr(look, name), 0.0, limit).tolist()
        if isinstance(value, list):
            value = tuple(value)
        inside[name] = value
    return replace(look, **inside), [
        name for name, value in inside.items() if value != getattr(look, name)
    ]


def in_gltf(look: Appearance) -> dict[str, Any]:
    """Return the fields of an appearance that are stated or unusual, in the words of glTF."""
    words: dict[str, Any] = {}
    for word, names in _GLTF.items():
        first, *more = (getattr(look, name) for name in names)
        if first is None or not any(map(look.says, names)):
            continue
        words[word] = first
        if isinstance(first, tuple):
            words[word] = [*first, *more]
    return words


def in_mtl(words: Material) -> Material:
    """Return a material in the words of MTL: those that it has, and those for fields that the words of glTF say."""
    look, _ = within(appearance(words))
    mtl_words: Material = {
        word: value for word, value in words.items() if is_mtl(word) or word == "name"
    }
    fields: set[str] = set()
    for word, names in look.stated.items():
        if not is_mtl(word):
            fields.update(names)
    fields.difference_update(*(_MTL.get(word, ()) for word in mtl_words))
    for word, (name, *_) in _MTL.items():
        if name not in fields:
            continue
        fields.remove(name)
        value = getattr(look, name)
        if isinstance(value, Texture):
            mtl_words |= {
                key: entry
                for key, entry in value.in_words(word).items()
                if key == word or is_mtl(key)
            }
        elif name == "mode":
            if value != "OPAQUE" and "map_Kd" in mtl_words:
                mtl_words[word] = mtl_words["map_Kd"]
        elif isinstance(value, tuple):
            mtl_words[word] = as_text(to_srgb(np.array(value)))
        elif name != "opacity" or (value != 1 and look.mode == "BLEND"):
            mtl_words[word] = as_text(value)
    return mtl_words


def parse_mtl(data: bytes, images: dict[str, int]) -> dict[str, Material]:
    """Return the materials of a library by name; `images` numbers the files of their images."""
    materials: dict[str, Material] = {}
    current: Material = {}
    for line in continued(plain_text(data)).splitlines():
        first_word, rest = map(text_of, [*line.split(None, 1), b"", b""][:2])
        keyword = _OF_MTL.get(first_word.lower(), first_word)
        rest = re.sub(r"\s#(\s.*)?$", "", rest)
        value = rest.partition("#")[0].strip()
        if keyword.lower() == "newmtl":
            current = materials.setdefault(rest, {})
        elif rest and MTL_IMAGES.fullmatch(keyword):
            options, name = _MTL_OPTIONS.findall(rest)[0]
            name = re.sub(r"^([\"'])(.+)\1$", r"\2", name)
            current[keyword] = images.setdefault(name, len(images))
            if options:
                current[f"{keyword}.options"] = options.strip()
        elif value and not keyword.startswith("#"):
            if keyword in _MTL_COLORS:
                value = _color_words(value)
            current[keyword] = value
    return materials


def _color_words(value: str) -> str:
    """Return the three numbers of a color; one number is a gray."""
    numbers = value.replace(",", " ").split()
    if len(numbers) == 1:
        numbers *= 3
    return " ".join(numbers)


def write_mtl(
    materials: Mapping[int, Material], names: Mapping[int, str], images: Mapping[int, str]
) -> bytes:
    lines: list[str] = []
    for number, material in materials.items():
        lines.append(f"newmtl {names[number]}")
        statements = in_mtl(material)
        for keyword, value in statements.items():
            if keyword == "name" or keyword.endswith(".options"):
                continue
            if not refers_to_image(keyword):
                lines.append(f"{keyword} {value}")
            elif isinstance(value, int) and images.get(value):
                options = str(statements.get(f"{keyword}.options") or "")
                lines.append(" ".join(filter(None, [keyword, options, images[value]])))
    return "".join(one_line(line) + "\n" for line in lines).encode()


def text_of(data: bytes) -> str:
    """Return a name in UTF-8, or else in Latin-1, which maps different bytes to different names."""
    try:
        return data.strip().decode()
    except UnicodeDecodeError:
        return data.strip().decode("latin-1")


def one_line(text: str) -> str:
    """Text without what would end a line or hide in it."""
    return re.sub(r"[\x00-\x1f\x7f\ud800-\udfff]", " ", text)


def lost(words: Material, fields_held: Collection[str]) -> list[str]:
    """Return the words that say more than the fields that a format holds, or have numbers beyond its range."""
    look = appearance(words)
    expressed = {*fields_held}
    expressed |= {name for name in vars(USUAL) if getattr(look, name) == getattr(USUAL, name)}
    if look.mode == "BLEND" and look.opacity < 1:
        expressed.add("mode")
    expressed.difference_update(within(look)[1])
    return [word for word in words if not {*look.stated.get(word, ("",))} <= expressed]


def as_text(value: Any) -> str:
    return " ".join(f"{number:.6g}" for number in np.atleast_1d(value).tolist())
