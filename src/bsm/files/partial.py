"""Streams decoded in part: their first blocks, or what damage has left of them."""

import re
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import replace
from typing import Any

import msgpack
import numpy as np

from bsm.bitstream.container.header import Header
from bsm.bitstream.container.wire import MAX_ENTRIES, FrameType, Section, read_varint, sections_of
from bsm.bitstream.errors import MeshError, OptionError
from bsm.bitstream.limits import Limits
from bsm.codec.arrays import Faces
from bsm.codec.decoding import Decoder
from bsm.codec.events import (
    BlockEvent,
    ConnectivityEvent,
    EndEvent,
    HeaderEvent,
    LossEvent,
    RefinementEvent,
)
from bsm.codec.geometry.mesh import Metadata, TriangleMesh
from bsm.files.formats.appearance import refers_to_image
from bsm.files.formats.metadata import materials_in

Progress = Callable[[int, int], None]
_NAME = 1  # the key of a declaration (specification, D 1)
_KINDS_OF_METADATA = {"image": "images", "material": "materials", "mtllib": "materials"}
"""Kinds of metadata by the first word of the key; all others are other metadata."""
_IMAGE_DATA = re.compile(r"image\.(\d{1,9})\.data")
_MOST_NAMED = 3  # images in one note
_UNKNOWN = "metadata (names, materials or images)"
"""The contents of a section of metadata that cannot be read."""


def blocks_in_words(count: int, header: Header) -> str:
    """Say why a stream has fewer blocks than `count`; nothing if it has as many."""
    if header.grid:
        return "the stream has no blocks, and all of it was decoded"
    if count > header.blocks:
        return f"the stream has {header.blocks}, and all were decoded"
    return ""


def decode_blocks(
    chunks: Iterator[bytes], count: int, progress: Progress, limits: Limits
) -> TriangleMesh:
    """Decode the first `count` blocks, read no further, and return the faces whose vertices have all arrived."""
    if count < 1:
        raise OptionError(f"at least one block is decoded: give 1 or more, not {count}")
    most_blocks, blocks_done = count, 0

    def enough(event: Any) -> bool:
        nonlocal most_blocks, blocks_done
        if isinstance(event, HeaderEvent):
            most_blocks = count
            if not event.header.grid:
                most_blocks = min(count, event.header.blocks)
        elif isinstance(event, BlockEvent):
            blocks_done += 1
            progress(blocks_done, most_blocks)
        return blocks_done == most_blocks or isinstance(event, EndEvent)

    return _decode_until(Decoder(limits), chunks, enough)


def decode_what_is_left(
    chunks: Iterator[bytes], report: Callable[[str], None], limits: Limits
) -> TriangleMesh:
    """Decode every block of a damaged stream that does not depend on lost data; call `report` for each loss."""
    received = bytearray()
    declared = 0
    losses = 0

    def receive() -> Iterator[bytes]:
        for chunk in chunks:
            received.extend(chunk)
            yield chunk

    def reported(event: Any) -> bool:
        nonlocal declared, losses
        match event:
            case HeaderEvent(header):
                declared = header.attributes
            case LossEvent(_, error):
                losses += 1
                report(f"lost: {error}")
            case EndEvent(lost) if len(lost.missing) or len(lost.degraded):
                report(f"{len(lost.missing)} vertices missing, {len(lost.degraded)} degraded")
        return False

    mesh = _decode_until(Decoder(limits, tolerant=True), receive(), reported)
    if not losses and len(mesh.attributes) == declared:
        return mesh
    sections = list(sections_of(bytes(received)))
    lost_images = _lost_images(sections, mesh.metadata)
    for text in _lost_contents(sections, mesh, declared, lost_images):
        report(f"left out: {text}")
    # A file that names an image which is not written would look complete, and be drawn without it.
    return replace(mesh, metadata=_without_images(mesh.metadata, lost_images))


def _lost_contents(
    sections: Sequence[Section], mesh: TriangleMesh, declared: int, lost_images: Collection[int]
) -> Iterator[str]:
    """Name the attributes and the metadata that a stream has and the decoded mesh lacks."""
    present = {attribute.name for attribute in mesh.attributes}
    names = [_name_of(section) for section in sections if section.type == FrameType.ATTRIBUTE]
    lost = sorted({name for name in names if name} - present)
    if len(lost) > 1:
        yield f"the attributes {', '.join(lost)}"
    elif lost:
        yield f"the attribute {lost[0]}"
    # Sections that are damaged themselves, or were cut off, do not tell a name.
    unnamed = declared - len(present) - len(lost)
    if unnamed > 0:
        yield f"{unnamed} of {declared} attributes, whose values are missing"
    kinds: set[str] = set()
    for section in _metadata_sections(sections):
        kinds |= _lost_kinds(section, mesh)
    if lost_images:
        kinds.discard("images")
        yield _named_images(lost_images, mesh.metadata)
        if _UNKNOWN in kinds:
            kinds = {"other entries of the damaged metadata"}
    if kinds:
        yield " and ".join(sorted(kinds))


def _metadata_sections(sections: Sequence[Section]) -> list[Section]:
    return [section for section in sections if section.type == FrameType.METADATA]


def _named_images(numbers: Collection[int], metadata: Metadata) -> str:
    """Return images by their names, or by their numbers where the names are lost."""
    names = [str(metadata.get(f"image.{number}.name", number)) for number in sorted(numbers)]
    if len(names) == 1:
        return f"the image {names[0]}"
    words = f"the images {', '.join(names[:_MOST_NAMED])}"
    if len(names) > _MOST_NAMED:
        words += f" and {len(names) - _MOST_NAMED} more"
    return words


def _lost_images(sections: Sequence[Section], metadata: Metadata) -> set[int]:
    """Return the numbers of the images whose bytes were lost."""
    lost: set[int] = set()
    for section in _metadata_sections(sections):
        if not section.is_sound:
            continue
        matches = [_IMAGE_DATA.fullmatch(key) for key in _keys_of(section) if key not in metadata]
        lost |= {int(match[1]) for match in matches if match}
    is_whole = all(section.is_sound for section in _metadata_sections(sections))
    if is_whole and any(section.type == FrameType.END for section in sections):
        return lost
    # Damaged sections do not tell their contents, but the materials tell which images there were.
    for number in _images_of_materials(metadata):
        if f"image.{number}.data" not in metadata and f"image.{number}.link" not in metadata:
            lost.add(number)
    return lost


def _images_of_materials(metadata: Metadata) -> set[int]:
    numbers: set[int] = set()
    for words in materials_in(metadata).values():
        numbers |= {
            value
            for word, value in words.items()
            if refers_to_image(word) and isinstance(value, int)
        }
    return numbers


def _without_images(metadata: Metadata, numbers: Collection[int]) -> Metadata:
    """Return metadata without some images, and without what materials say about them."""
    if not numbers:
        return metadata
    dropped = [f"image.{number}." for number in numbers]
    for material, words in materials_in(metadata).items():
        for word, value in words.items():
            if refers_to_image(word) and value in numbers:
                dropped.append(f"material.{material}.{word}.")
    prefixes = tuple(dropped)
    return {key: value for key, value in metadata.items() if not f"{key}.".startswith(prefixes)}


def _name_of(section: Section) -> str:
    """Return the name of the attribute that a section declares, if its checksum is right."""
    if not section.is_sound:
        return ""
    rest = section.payload
    for _ in ("number of the attribute", "length of the map"):
        _, size = read_varint(rest)
        rest = rest[size:]
    unpacker = _unpacker(rest)
    try:
        entries = {unpacker.unpack(): unpacker.unpack() for _ in range(unpacker.read_map_header())}
    except (ValueError, msgpack.UnpackException):
        return ""
    return str(entries.get(_NAME, ""))


def _unpacker(data: memoryview) -> msgpack.Unpacker:
    """Return a reader of small maps, which neither builds lists nor takes more memory than the bytes."""
    unpacker = msgpack.Unpacker(
        max_array_len=MAX_ENTRIES, max_map_len=MAX_ENTRIES, max_buffer_size=len(data)
    )
    unpacker.feed(data)
    return unpacker


def _lost_kinds(section: Section, mesh: TriangleMesh) -> set[str]:
    """Return the kinds of metadata, such as images, that a section holds and the mesh lacks."""
    if not section.is_sound:
        return {_UNKNOWN}
    lost = [key for key in _keys_of(section) if key not in mesh.metadata]
    return {_KINDS_OF_METADATA.get(key.partition(".")[0], "other metadata") for key in lost}


def _keys_of(section: Section) -> list[str]:
    """Return the names of the entries that a section of metadata holds; none if it is not a map."""
    unpacker = _unpacker(section.payload)
    keys = list[str]()
    try:
        for _ in range(unpacker.read_map_header()):
            keys.append(str(unpacker.unpack()))
            unpacker.skip()
    except (ValueError, msgpack.UnpackException):
        return []
    return keys


def _decode_until(
    decoder: Decoder, chunks: Iterator[bytes], enough: Callable[[Any], bool]
) -> TriangleMesh:
    """Decode until an event is enough, or to the end; the faces whose vertices have all arrived."""
    faces: Faces = np.empty((0, 3), np.int32)
    positions, is_known = np.empty((0, 3)), np.empty(0, np.bool_)
    with decoder:
        for event in decoder.events(chunks):
            match event:
                case ConnectivityEvent(faces, vertices):
                    positions, is_known = np.zeros((vertices, 3)), np.zeros(vertices, np.bool_)
                case BlockEvent() | RefinementEvent():
                    positions[event.vertices] = event.positions
                    is_known[event.vertices] = True
            if enough(event):
                break
        # Faces at the edge of what has come would reach to the origin, where vertices lie that have not.
        complete = np.flatnonzero(is_known[faces].all(axis=1))
        if len(complete) == 0:
            raise MeshError("no face is complete in the blocks that are there")
        known_attributes = tuple(
            attribute.taken(np.arange(len(is_known)), complete) for attribute in decoder.attributes
        )
        return TriangleMesh(
            positions, faces[complete], known_attributes, decoder.metadata
        ).without_isolated_vertices()[0]
