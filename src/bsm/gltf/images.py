"""Images of a scene, made smaller by Pillow."""

from __future__ import annotations

import io
import re
from dataclasses import dataclass
from typing import Any, Self

from bsm.bitstream.errors import DependencyError, OptionError
from bsm.bitstream.extras import how_to_install

MIME = {"webp": "image/webp", "jpeg": "image/jpeg", "png": "image/png"}


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
    try:
        from PIL import Image, UnidentifiedImageError
    except ImportError as error:
        raise DependencyError(f"images are written with Pillow; run: {how_to_install('formats')}") from error
    try:
        found = _written(Image.open(io.BytesIO(data)), rule)
    except (UnidentifiedImageError, OSError, ValueError, SyntaxError, Image.DecompressionBombError):
        return None
    return found if found and len(found) < len(data) else None


def _written(image: Any, rule: ImageRule) -> bytes | None:
    """The file of an image; None if the format would lose what shows through."""
    from PIL import Image

    if rule.kind == "jpeg" and image.mode not in ("RGB", "L"):
        if "A" in image.getbands() or "transparency" in image.info:
            return None
        image = image.convert("RGB")
    if rule.side and max(image.size) > rule.side:
        factor = rule.side / max(image.size)
        size = (max(1, round(image.width * factor)), max(1, round(image.height * factor)))
        image = image.resize(size, Image.Resampling.LANCZOS)
    written = io.BytesIO()
    image.save(written, rule.kind, quality=rule.quality, **({"method": 6} if rule.kind == "webp" else {}))
    return written.getvalue()
