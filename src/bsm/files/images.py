"""Images written anew by a rule, where that makes them smaller."""

import io
import re
from dataclasses import dataclass
from pathlib import PurePath
from typing import Any, Self

from bsm.bitstream.errors import OptionError, imported
from bsm.codec.geometry.mesh import Metadata
from bsm.files.formats.metadata import images_in

_MOST_PIXELS = 1 << 26  # of an image that is written anew


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
        if not match or not 1 <= int(match[2] or 85) <= 100:
            raise OptionError(f"images are written as webp, webp:85 or webp:85@1024 (jpeg, png, too), not as {text!r}")
        return cls(match[1], int(match[2] or 85), int(match[3] or 0))


def smaller(data: bytes, rule: ImageRule) -> bytes | None:
    """An image by a rule; None if that would not be smaller, or Pillow cannot read it."""
    pillow = imported("PIL.Image", "images are written with Pillow", "formats")
    try:  # what Pillow does not know is an OSError
        image = pillow.open(io.BytesIO(data))
        if image.width * image.height > _MOST_PIXELS:
            return None
        found = _written(image, rule, pillow.Resampling.LANCZOS)
    except (OSError, ValueError, SyntaxError, pillow.DecompressionBombError):
        return None
    return found if found and len(found) < len(data) else None


def _written(image: Any, rule: ImageRule, how: Any) -> bytes | None:
    """The file of an image; None if the format would lose what shows through."""
    if rule.kind == "jpeg" and image.mode not in ("RGB", "L"):
        if "A" in image.getbands() or "transparency" in image.info:
            return None
        image = image.convert("RGB")
    if rule.side and max(image.size) > rule.side:
        factor = rule.side / max(image.size)
        size = (max(1, round(image.width * factor)), max(1, round(image.height * factor)))
        image = image.resize(size, how)
    written = io.BytesIO()
    image.save(written, rule.kind, quality=rule.quality, **({"method": 6} if rule.kind == "webp" else {}))
    return written.getvalue()


def with_smaller_images(metadata: Metadata, rule: ImageRule) -> Metadata:
    """Metadata with its images by a rule; their names get the suffix of their format."""
    found, images = dict(metadata), images_in(metadata)
    names = {name for name, _ in images.values()}
    for number, (name, data) in images.items():
        if not data or (written := smaller(data, rule)) is None:
            continue
        found[f"image.{number}.data"] = written
        if name:
            other = str(PurePath(name).with_suffix(f".{rule.kind}"))
            found[f"image.{number}.name"] = other if other not in names - {name} else f"{name}.{rule.kind}"
    return found
