"""What images have lost: pixels, kind, bytes, and the peak signal-to-noise ratio where their bytes differ."""

import math
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import PurePath
from typing import Any

import numpy as np

from bsm.bitstream.errors import DependencyError
from bsm.codec.geometry.mesh import Metadata
from bsm.files.formats.metadata import images_in, kind_of_image
from bsm.files.images import LANCZOS, opened, size_of_image


@dataclass(frozen=True)
class ImageFile:
    """The file of an image: width and height in pixels, 0 if they are not known."""

    width: int
    height: int
    kind: str
    bytes: int

    def __str__(self) -> str:
        size = ""
        if self.width:
            size = f"{self.width} x {self.height} pixels, "
        return f"{size}{self.kind}, {self.bytes} bytes"


@dataclass(frozen=True)
class ImageComparison:
    """An image before and after; None: it is missing. The ratio is None where the files are equal or unreadable."""

    name: str
    before: ImageFile
    after: ImageFile | None
    psnr_db: float | None = None

    def __str__(self) -> str:
        if self.after is None:
            return f"{self.name}: {self.before}; missing"
        if self.before == self.after and self.psnr_db is None:
            return f"{self.name}: {self.before}; unchanged"
        if self.psnr_db is None:
            ratio = ""
        elif self.psnr_db < math.inf:
            ratio = f", PSNR {self.psnr_db:.1f} dB"
        else:
            ratio = ", exact"
        return f"{self.name}: {self.before} -> {self.after}{ratio}"

    def facts(self) -> dict[str, Any]:
        facts = asdict(self)
        if self.psnr_db == math.inf:
            facts |= {"psnr_db": None, "exact": True}
        return facts


def compare_images(before: Metadata, after: Metadata) -> list[ImageComparison]:
    """Compare the images in the metadata of a mesh with those of another one, by their numbers."""
    there = {number: data for number, (_, data) in images_in(after).items() if data}
    given = {number: (name, data) for number, (name, data) in images_in(before).items() if data}
    names = {PurePath(name).stem: data for name, data in images_in(after).values() if name and data}
    return [
        compare_image(
            name or f"image {number}", data, there.get(number, names.get(PurePath(name).stem, b""))
        )
        for number, (name, data) in given.items()
    ]


def compare_image(name: str, before: bytes, after: bytes) -> ImageComparison:
    """Compare the files of an image; empty bytes: it is missing."""
    first = file_of(before)
    if not after:
        return ImageComparison(name, first, None)
    ratio = None
    if before != after:
        ratio = _ratio(before, after)
    return ImageComparison(name, first, file_of(after), ratio)


def file_of(data: bytes) -> ImageFile:
    return ImageFile(*size_of_image(data), kind_of_image(data) or "image", len(data))


def changed(images: list[ImageComparison]) -> Iterator[str]:
    """Say what images have lost, without those that are unchanged."""
    yield from (str(image) for image in images if image.after is None or image.psnr_db is not None)


def _ratio(before: bytes, after: bytes) -> float | None:
    """The peak signal-to-noise ratio in dB, of the smaller image enlarged; None if Pillow cannot read them."""
    images: list[Any] = []
    with suppress(DependencyError):
        images = [image for data in (before, after) if (image := opened(data))]
    if len(images) < 2:
        return None
    clear = any("A" in image.getbands() or "transparency" in image.info for image in images)
    mode = "RGB"
    if clear:
        mode = "RGBA"
    first, second = (image.convert(mode) for image in images)
    if first.size != second.size:
        second = second.resize(first.size, LANCZOS)
    apart = np.asarray(first, np.int16) - np.asarray(second, np.int16)
    wrong = float(np.square(apart, dtype=np.int32).mean(dtype=np.float64))
    if not wrong:
        return math.inf
    return 10.0 * math.log10(255.0**2 / wrong)
