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
from itertools import chain
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
    wrap: tuple[str, ...] = ("repeat", "repeat")  # beyond the image, across and up; or clamp, mirror
    set: int = 0  # of texture coordinates

    def in_words(self, word: str) -> Material:
        """The entries of a material that say this: the number of the image, options as in MTL, and others."""
        scale, offset = (" ".join(f"{number:.9g}" for number in pair) for pair in (self.scale, self.offset))
        options = [f"-s {scale} 1 -o {offset} 0"] * ((scale, offset) != ("1 1", "0 0"))
        options += ["-clamp on"] * (both := self.wrap == ("clamp", "clamp"))
        wrap = "" if both or self.wrap == ("repeat", "repeat") else " ".join(self.wrap)
        more: Material = {"options": " ".join(options), "rotation": self.rotation, "wrap": wrap, "set": self.set}
        return {word: self.image, **{f"{word}.{name}": value for name, value in more.items() if value}}


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
    stated: Mapping[str, tuple[str, ...]] = field(default_factory=dict, compare=False)  # fields by the words for them

    def says(self, name: str) -> bool:
        """Whether a word says this field, or it is unusual."""
        return any(name in fields for fields in self.stated.values()) or getattr(self, name) != getattr(USUAL, name)


USUAL = Appearance()
_ROWS = [*csv.DictReader(Path(__file__).with_suffix(".csv").read_text().splitlines())]
"""A row for each field with its words in each format, those after ~ converted; rows with * have
the entries about each texture; the last row has the words of no field."""


def fields_of(kind: str) -> dict[str, list[str]]:
    """Return the fields that each word of a format says."""
    rows = [row for row in _ROWS[:-1] if "*" not in row["field"]]
    words_and_fields = [(word, row["field"]) for row in rows for word in row[kind].replace("~", "").split()]
    return {
        word: [name for word_of_field, name in words_and_fields if word_of_field == word]
        for word, _ in words_and_fields
    }


def held_by(kind: str) -> set[str]:
    """Return the fields that a format holds, and the entries about those that are textures."""
    fields = [row["field"] for row in _ROWS[:-1] if row[kind]]
    return {entry.replace("*", name) for name in fields if "*" not in name for entry in fields}


_GLTF, _MTL = fields_of("glTF"), fields_of("MTL")
_OF_MTL = {word.lower(): word for word in {**_MTL, **dict.fromkeys(_ROWS[-1]["MTL"].split())} if word != "name"}
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
    return word in _OF_MTL.values() or MTL_IMAGES.fullmatch(word.removesuffix(".options")) is not None


def refers_to_image(word: str) -> bool:
    return word.endswith("Texture") or MTL_IMAGES.fullmatch(word) is not None


def as_numbers(value: object) -> list[float]:
    try:
        numbers = [float(word) for word in str(value).split()]
    except ValueError:
        return []
    return numbers if all(map(math.isfinite, numbers)) else []


def appearance(words: Material) -> Appearance:
    """Read the words of a material; where both say a field, that of glTF counts."""
    fields, fields_by_word = dict[str, Any](), dict[str, tuple[str, ...]]()
    for word, names in (*_GLTF.items(), *_MTL.items()):
        if word in words and (values := _read(word, names, words)):
            fields_by_word[word] = tuple(values)
            fields = values | fields
            fields_by_word |= {f"{word}.{entry}": (f"{names[0]}.{entry}",) for entry in _about(words, word)}
    metal, rough = (words.get(f"map_{word}") for word in ("Pm", "Pr"))
    if isinstance(rough, int) and (metal == rough or (metal is None and not any(as_numbers(words.get("Pm", 0))))):
        fields.setdefault("surface_texture", Texture(rough))  # gray: green is the roughness, blue counts as metal
        fields_by_word |= dict.fromkeys(("map_Pr", "map_Pm"), ("surface_texture",))
    if any(map(is_mtl, words)):  # what MTL means where it says nothing
        fields.setdefault("metallic", 1.0 if metal is not None and "map_Pr" in fields_by_word else 0.0)
        if "map_Ke" in words and not any(fields.get("emission", ())):
            fields["emission"] = (1.0, 1.0, 1.0)
    if "map_d" in words and words["map_d"] == words.get("map_Kd"):  # the image of the color also holds the opacity
        fields_by_word["map_d"] = ("mode",)
    if fields.get("opacity", 1.0) < 1 or "map_d" in fields_by_word:
        fields.setdefault("mode", "BLEND")
    if not fields_by_word:
        fields |= {"metallic": 0.0, "roughness": 0.9}  # matte, as in files without a material
    return Appearance(**fields, stated=fields_by_word)


def _read(word: str, names: Sequence[str], words: Material) -> dict[str, Any]:
    """Return the fields that a word says; none where it makes no sense."""
    value, numbers = words[word], as_numbers(str(words[word]).removeprefix("-halo"))
    name, usual = names[0], getattr(USUAL, names[0])
    if usual is None:
        about = {key: value for fields in _about(words, word).values() for key, value in fields.items()}
        return {name: Texture(value, **about)} if isinstance(value, int) else {}
    if isinstance(usual, str):
        return {name: str(value)} if name == "name" or value in ("OPAQUE", "MASK", "BLEND") else {}
    if isinstance(usual, bool):
        return {name: bool(value)}
    if len(numbers) != len(np.atleast_1d(usual)) + len(names) - 1:
        return {}
    if word == "Kd" and is_black_beside_image(words):
        return {name: usual}
    if isinstance(usual, tuple):
        color = tuple(as_numbers(as_text(to_linear(np.array(numbers)))) if word in _MTL else numbers[:3])
        return dict(zip(names, (color, *numbers[3:])))
    return {name: as_numbers(as_text(1 - numbers[0]))[0] if word == "Tr" else numbers[0]}


def is_black_beside_image(words: Material) -> bool:
    """Whether a color is black only because an image has the colors, as some programs write."""
    return "map_Kd" in words and as_numbers(words.get("Kd")) == [0.0] * 3


def _about(words: Material, word: str) -> dict[str, dict[str, Any]]:
    """Return the fields of a texture that the entries about it say, but for entries that make no sense."""
    options, wrap = str(words.get(f"{word}.options", "")), tuple(str(words.get(f"{word}.wrap", "")).split())
    rotation, which = as_numbers(words.get(f"{word}.rotation")), words.get(f"{word}.set")
    entries: dict[str, dict[str, Any]] = {"wrap": {"wrap": wrap}} if len(wrap) == 2 and {*wrap} <= {*WAYS} else {}
    entries |= {"rotation": {"rotation": rotation[0]}} if len(rotation) == 1 else {}
    entries |= {"set": {"set": which}} if isinstance(which, int) and which >= 0 else {}
    if re.fullmatch(f"(?:{_MOVE})+", options):
        options_given = {name: tuple(as_numbers(numbers)[:2]) for name, numbers, _ in re.findall(_MOVE, options)}
        moved = {
            "scale": (*options_given.get("s", ()), 1.0, 1.0)[:2],
            "offset": (*options_given.get("o", ()), 0.0, 0.0)[:2],
        }
        entries["options"] = moved | ({"wrap": ("clamp", "clamp")} if "" in options_given else {})
    return entries


def within(look: Appearance) -> tuple[Appearance, list[str]]:
    """Return an appearance in the ranges that formats have, and the fields that lay beyond; only light may exceed 1."""
    most = {"color": 1.0, "opacity": 1.0, "metallic": 1.0, "roughness": 1.0, "emission": math.inf, "cutoff": math.inf}
    clipped = ((name, np.clip(getattr(look, name), 0.0, limit).tolist()) for name, limit in most.items())
    inside: dict[str, Any] = {name: tuple(value) if isinstance(value, list) else value for name, value in clipped}
    return replace(look, **inside), [name for name, value in inside.items() if value != getattr(look, name)]


def in_gltf(look: Appearance) -> dict[str, Any]:
    """Return the fields of an appearance that are stated or unusual, in the words of glTF."""
    words: dict[str, Any] = {}
    for word, names in _GLTF.items():
        first, *more = (getattr(look, name) for name in names)
        if first is not None and any(map(look.says, names)):
            words[word] = [*first, *more] if isinstance(first, tuple) else first
    return words


def in_mtl(words: Material) -> Material:
    """Return a material in the words of MTL: those that it has, and those for fields that the words of glTF say."""
    look, _ = within(appearance(words))
    mtl_words: Material = {word: value for word, value in words.items() if is_mtl(word) or word == "name"}
    fields = {name for word, names in look.stated.items() if not is_mtl(word) for name in names}
    fields -= {*chain.from_iterable(_MTL.get(word, ()) for word in mtl_words)}
    for word, (name, *_) in _MTL.items():
        value = getattr(look, name)
        if name not in fields:
            continue
        fields.remove(name)
        if isinstance(value, Texture):
            mtl_words |= {key: entry for key, entry in value.in_words(word).items() if key == word or is_mtl(key)}
        elif name == "mode":
            mtl_words |= {word: mtl_words["map_Kd"]} if value != "OPAQUE" and "map_Kd" in mtl_words else {}
        elif name != "opacity" or (value != 1 and look.mode == "BLEND"):
            mtl_words[word] = as_text(to_srgb(np.array(value)) if isinstance(value, tuple) else value)
    return mtl_words


def parse_mtl(data: bytes, images: dict[str, int]) -> dict[str, Material]:
    """Return the materials of a library by name; `images` numbers the files of their images."""
    materials, current = dict[str, Material](), Material()
    for line in continued(plain_text(data)).splitlines():
        keyword, rest = map(text_of, [*line.split(None, 1), b"", b""][:2])
        keyword, rest = _OF_MTL.get(keyword.lower(), keyword), re.sub(r"\s#(\s.*)?$", "", rest)
        if keyword.lower() == "newmtl":
            current = materials.setdefault(rest, {})
        elif rest and MTL_IMAGES.fullmatch(keyword):
            options, name = _MTL_OPTIONS.findall(rest)[0]
            name = re.sub(r"^([\"'])(.+)\1$", r"\2", name)
            current[keyword] = images.setdefault(name, len(images))
            current |= {f"{keyword}.options": options.strip()} if options else {}
        elif (value := rest.partition("#")[0].strip()) and not keyword.startswith("#"):
            numbers = value.replace(",", " ").split()  # one number is a gray
            value = " ".join(numbers * 3 if len(numbers) == 1 else numbers) if keyword in _MTL_COLORS else value
            current[keyword] = value
    return materials


def write_mtl(materials: Mapping[int, Material], names: Mapping[int, str], images: Mapping[int, str]) -> bytes:
    lines: list[str] = []
    for number, material in materials.items():
        lines.append(f"newmtl {names[number]}")
        for keyword, value in (statements := in_mtl(material)).items():
            if refers_to_image(keyword):
                options = statements.get(f"{keyword}.options")
                name = images.get(value) if isinstance(value, int) else None
                lines += [" ".join(filter(None, [keyword, str(options or ""), name]))] if name else []
            elif keyword != "name" and not keyword.endswith(".options"):
                lines.append(f"{keyword} {value}")
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
    usual = {name for name in vars(USUAL) if getattr(look, name) == getattr(USUAL, name)}
    usual |= {"mode"} if look.mode == "BLEND" and look.opacity < 1 else set()
    fine = {*fields_held, *usual}.difference(within(look)[1])
    return [word for word in words if not {*look.stated.get(word, ("",))} <= fine]


def as_text(value: Any) -> str:
    return " ".join(f"{number:.6g}" for number in np.atleast_1d(value).tolist())
