"""Images written anew by a rule, where that makes them smaller, and images beside streams, which link to them."""

import io
import re
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path, PurePath
from typing import Any, Self

from bsm.bitstream.errors import OptionError, imported
from bsm.codec.geometry.mesh import Metadata, TriangleMesh
from bsm.files.formats.metadata import images_in, kind_of_image

_PNG_OR_JPEG = re.compile(
    rb"\A\x89PNG.{12}(.{4})(.{4})|\xff[\xc0-\xc2]\0[\x0b\x11\x14]\x08(..)(..)", re.DOTALL
)
_WEBP = re.compile(
    rb"RIFF.{4}WEBP(?:VP8X.{8}(...)(...)|VP8 .{7}\x9d\x01\x2a(..)(..)|VP8L.{4}/(.{4}))", re.DOTALL
)
LANCZOS = 1  # of Pillow: how images become smaller or larger
WORTH = 0.9  # of the bytes of an image: above, its loss of quality buys too little
MOST_PIXELS = 1 << 26  # of an image that is written anew
_LINK = re.compile(r"(?:\.\./)*images/([0-9a-f]{32})\.\w{1,5}")


@dataclass(frozen=True)
class ImageRule:
    """How images are written: format, quality from 1 to 100, and the most pixels of a side (0: any number)."""

    kind: str
    quality: int = 85
    side: int = 0

    @classmethod
    def parse(cls, text: str) -> Self:
        """The rule that "webp", "webp:85" or "webp:85@1024" says."""
        match = re.fullmatch(r"(webp|jpeg|png)(?::(\d{1,3}))?(?:@(\d{1,5}))?", text)
        if match and not 1 <= int(match[2] or 85) <= 100:
            raise OptionError(
                f"the quality of images is from 1 to 100, not {match[2]}: {match[1]}:85 is usual"
            )
        if not match:
            raise OptionError(
                f"images are written as webp, webp:85 or webp:85@1024 (jpeg, png, too), not as {text!r}"
            )
        return cls(match[1], int(match[2] or 85), int(match[3] or 0))


def smaller(data: bytes, rule: ImageRule) -> bytes | None:
    """An image by a rule; None if that would not save a tenth of it, or Pillow cannot read it."""
    image, smallest = opened(data), None
    if image is None:
        return None
    with suppress(OSError, ValueError):  # what Pillow does not write
        smallest = _written(image, rule)
    if not smallest or len(smallest) > WORTH * len(data):
        return None
    return smallest


def opened(data: bytes) -> Any | None:
    """An image as Pillow reads it; None if it cannot, or if there are too many pixels."""
    pillow = imported("PIL.Image", "images are read and written with Pillow", "formats")
    try:  # what Pillow does not know is an OSError
        image = pillow.open(io.BytesIO(data))
        # Before load: opening reads the head only, and the pixels of a hostile image may take gigabytes.
        if image.width * image.height > MOST_PIXELS:
            return None
        image.load()
    except (OSError, ValueError, SyntaxError, pillow.DecompressionBombError):
        return None
    return image


def _written(image: Any, rule: ImageRule) -> bytes | None:
    """The file of an image; None if the format would lose what shows through."""
    # JPEG has no opacity: leaving it out would show what the artist has cut away.
    if rule.kind == "jpeg" and image.mode not in ("RGB", "L"):
        if "A" in image.getbands() or "transparency" in image.info:
            return None
        image = image.convert("RGB")
    if rule.side and max(image.size) > rule.side:
        factor = rule.side / max(image.size)
        size = (max(1, round(image.width * factor)), max(1, round(image.height * factor)))
        image = image.resize(size, LANCZOS)
    written = io.BytesIO()
    options = {"quality": rule.quality}
    if rule.kind == "webp":
        options["method"] = 6
    image.save(written, rule.kind, **options)
    return written.getvalue()


def with_smaller_images(metadata: Metadata, rule: ImageRule) -> Metadata:
    """Metadata with its images by a rule; their names get the suffix of their format."""
    entries, images = dict(metadata), images_in(metadata)
    names = {name for name, _ in images.values()}
    for number, (name, data) in images.items():
        if not data or (written := smaller(data, rule)) is None:
            continue
        entries[f"image.{number}.data"] = written
        if name:
            new_name = str(PurePath(name).with_suffix(f".{rule.kind}"))
            if new_name in names - {name}:
                new_name = f"{name}.{rule.kind}"
            entries[f"image.{number}.name"] = new_name
    return entries


def side_of_image(data: bytes) -> int:
    """Return the pixels of the longer side of a PNG, JPEG or WebP; 0 for others."""
    return max(size_of_image(data))


def size_of_image(data: bytes) -> tuple[int, int]:
    """Return the width and height of a PNG, JPEG or WebP in pixels; 0 for others."""
    if match := _WEBP.match(data):
        wide, high, *plain, packed = (
            int.from_bytes(number or b"", "little") for number in match.groups()
        )
        if match[3]:
            return plain[0] & 0x3FFF, plain[1] & 0x3FFF
        if match[1]:
            return wide + 1, high + 1
        return 1 + (packed & 0x3FFF), 1 + (packed >> 14 & 0x3FFF)
    if not data.startswith((b"\x89PNG", b"\xff\xd8")):
        return 0, 0
    segments = _PNG_OR_JPEG.findall(data)  # a JPEG may contain a smaller one
    sizes: list[tuple[int, int]] = []
    for wide, high, y, x in segments:
        sizes.append((int.from_bytes(wide, "big"), int.from_bytes(high, "big")))
        sizes.append((int.from_bytes(x, "big"), int.from_bytes(y, "big")))
    return max(sizes, default=(0, 0))


def largest_side(metadata: Metadata) -> int:
    return max((side_of_image(data) for _, data in images_in(metadata).values()), default=0)


def _digest(data: bytes) -> str:
    from hashlib import sha256  # which loads OpenSSL

    # Half of it, 128 bits: names stay short, and equal names of two images are still out of reach.
    return sha256(data).hexdigest()[:32]


def is_link(name: str) -> bool:
    return re.fullmatch(r"image\.\d+\.link", name) is not None


def digests_in(metadata: Metadata) -> set[str]:
    """Return the digests of the images that a mesh has, by which files of linked images are called."""
    return {_digest(data) for _, data in images_in(metadata).values() if data}


def with_links(
    metadata: Metadata, way: str, chosen: tuple[str, ...]
) -> tuple[Metadata, dict[str, bytes]]:
    """Return metadata that links to the chosen images, or to all, in a folder a way off, and these files by name."""
    entries, files = dict(metadata), dict[str, bytes]()
    for number, (_, data) in images_in(metadata).items():
        if data and (not chosen or _digest(data) in chosen):
            name = f"images/{_digest(data)}.{kind_of_image(data) or 'img'}"
            del entries[f"image.{number}.data"]
            entries[f"image.{number}.link"], files[name] = way + name, data
    return entries, files


@dataclass(frozen=True)
class LinkedImage:
    """An image that a stream names and does not contain."""

    key: str
    """Its entry in the metadata."""
    name: str
    """Its path from the folder of the stream."""
    data: bytes | None
    """Its bytes; None if there are none that the stream promised."""
    is_there: bool
    """Whether there is a file of that name; without data it is damaged."""

    @property
    def fault(self) -> str:
        """Say why the image cannot be used; empty if it is whole."""
        if self.data is not None:
            return ""
        if self.is_there:
            return "is damaged"
        return "is missing"

    @property
    def note(self) -> str:
        """Say that the image is left out, and why."""
        return f"left out: the image {self.name}, which {self.fault}"


def linked_images(metadata: Metadata, stream: str) -> list[LinkedImage]:
    """Return the images that a stream links to, and their bytes."""
    images = []
    for key, link in metadata.items():
        if not is_link(key):
            continue
        match = _LINK.fullmatch(str(link))
        path = Path(stream).parent / str(link)
        data, is_there = None, match is not None and path.is_file()
        # By the digest, too: the file of a link may have been changed since, and the stream promised these very bytes.
        if match and is_there and _digest(content := path.read_bytes()) == match[1]:
            data = content
        images.append(LinkedImage(key, str(link), data, is_there))
    return images


def with_linked_images(mesh: TriangleMesh, stream: str) -> TriangleMesh:
    """Return a mesh with the images that its stream links to, as far as they are whole."""
    metadata = dict(mesh.metadata)
    for image in linked_images(mesh.metadata, stream):
        if image.data is not None:
            metadata[image.key.removesuffix("link") + "data"] = image.data
    return replace(mesh, metadata=metadata)
