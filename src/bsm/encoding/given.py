"""A mesh or frames with the wishes of a user: the recipe of every stream, for every door.

Python, the command line, batches, scenes, tiles, the viewer and plugins all come here, so that a wish means the same
everywhere. First the metadata of mesh and user are joined, for they name the unit. Lengths are read by this unit, once,
and the options are made of the result. A mesh with images gets a bound on its texture coordinates in texels. The
provenance comes last: it names the wishes, and the generation if the mesh was decoded from a stream. What follows is
the work of the encoders, which check each promise on the decoded mesh.
"""

import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from bsm import __version__
from bsm.bitstream.errors import BsmError
from bsm.codec.geometry.mesh import Metadata, TriangleMesh
from bsm.codec.sequence.options import SequenceOptions
from bsm.codec.static.options import EncodeOptions
from bsm.encoding.options import chosen_options, encode_options, sequence_options
from bsm.encoding.simplification import Chosen, encode_source
from bsm.files.conventions import TIME_VALUE
from bsm.files.formats.metadata import without_materials, without_names
from bsm.files.images import largest_side
from bsm.files.libraries import PROVENANCE
from bsm.files.motion.frames import Frames
from bsm.files.parsing import PRECISION, is_single_and_far
from bsm.files.pipes import digest_of
from bsm.ground.console import Progress
from bsm.ground.lengths import as_said, asked_unit, in_own_unit, known_unit, metres, unit_of

if TYPE_CHECKING:
    # A single mesh never needs it, and it loads scipy.
    from bsm.codec.sequence.encoder import SequenceEncoder

_GENERATION = re.compile(r" generation=(\d{1,6})")
# A quarter of a texel cannot be seen: filters of textures mix whole ones.
_TEXELS = 0.25  # how far texture coordinates may be off


@dataclass(frozen=True, kw_only=True)
class Wishes:
    """Wishes of a user: keywords of `bsm.encoding.options`, or `options` that are made, metadata and others."""

    keywords: Mapping[str, Any] = field(default_factory=dict)
    options: Any = None
    metadata: Metadata = field(default_factory=dict)
    simplify: bool = False
    provenance: bool | None = None
    source: str = ""  # the file whose digest the provenance has
    images: Callable[[Metadata], Metadata] = dict

    def check(self) -> None:
        """Raise errors that no mesh could avoid; a sequence and a mesh have different options."""
        # An unknown unit would make a GLB a thousand times too large, without a word.
        if unit := self.metadata.get("unit"):
            known_unit(unit, "metadata")
        if self.options is not None:
            return
        said = as_said(self.keywords)
        try:
            encode_options(**said)
        # It is not known yet whether the input is a mesh or a sequence. Only wishes that are wrong for both are errors
        # here; the message is that for meshes, which are more frequent.
        except BsmError as error:
            try:
                sequence_options(**said)
            except BsmError:
                raise error from None

    def made(
        self, build: Callable[..., Any], kind: type[Any], known: Metadata, mesh: TriangleMesh | None
    ) -> Any:
        """Return the options for a mesh with this metadata."""
        return chosen_options(self.options, kind, in_own_unit(self.keywords, known, mesh), build)

    def joined(self, metadata: Metadata) -> tuple[dict[str, Any], list[str]]:
        """Return the metadata of a mesh with those of the user, and a note on a unit that is not known."""
        # What the user says counts more than what a file says: files are often wrong about their unit.
        known = {**metadata, **self.metadata}
        own = unit_of(known)
        if not own or metres(own) is not None:
            return known, []
        doubt = f"its unit {own} is not known, so sizes stay as they are; --meta unit=mm names it"
        return known, [doubt]

    def signed(self, metadata: Metadata, options: Any) -> tuple[Metadata, list[str]]:
        """Return metadata with a provenance entry, if it is requested or the input has one, and notes."""
        said = str(metadata.get(PROVENANCE, ""))
        # Provenance of other programs is kept, but not counted.
        if not said.startswith("bsm "):
            signed_metadata = dict(metadata)
            if self.provenance:
                signed_metadata[PROVENANCE] = self._words(options, 1)
            return signed_metadata, []
        generation = 2
        found = _GENERATION.search(said)
        if found:
            generation = 1 + int(found[1])
        note = f"the mesh was decoded from a stream, so this is generation {generation}"
        # On one grid, encoding again changes nothing. Otherwise each generation adds its error.
        if not getattr(options, "is_grid", False):
            note += ": errors add up, so encode the original if you have it"
        signed_metadata = {name: value for name, value in metadata.items() if name != PROVENANCE}
        whole = self.provenance or " sha256=" in said
        if self.provenance is not False:
            words = f"bsm {__version__} generation={generation}"
            if whole:
                words = self._words(options, generation)
            signed_metadata[PROVENANCE] = words
        return signed_metadata, [note]

    def _words(self, options: Any, generation: int) -> str:
        # The number of threads changes no byte, and values that are not plain cannot be written down.
        given = {**self.keywords, "simplify": self.simplify}
        preset = given.pop("preset", None)
        if not preset:
            preset = "balanced" if options.promise else "none"
        parts = [f"bsm {__version__}", preset]
        plain = {
            n: v for n, v in given.items() if n != "threads" and isinstance(v, str | int | float)
        }
        parts += [f"{name}={value}" for name, value in plain.items() if value is not False]
        if generation > 1:
            parts.append(f"generation={generation}")
        if Path(self.source).is_file():
            parts.append(f"sha256={digest_of(self.source)}")
        return " ".join(parts)


@dataclass(frozen=True, eq=False)
class Recipe:
    """A mesh, the options for the wishes, the unit of errors, and how many of it are one of the mesh's.

    `losses` are notes on unrequested changes, `notes` are all.
    """

    mesh: TriangleMesh
    options: EncodeOptions
    simplify: bool = False
    unit: tuple[str, float] = ("", 1.0)
    losses: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()

    def encode(self, progress: Progress) -> Chosen:
        return encode_source(self.mesh, self.options, progress, simplify=self.simplify)


def given_mesh(mesh: TriangleMesh, wishes: Wishes) -> Recipe:
    known, notes = wishes.joined(mesh.metadata)
    options: EncodeOptions = wishes.made(encode_options, EncodeOptions, known, mesh)
    qualities = dict(options.attributes)
    # Names of attributes that are left out would point to nothing.
    left = {
        a.name for a in mesh.attributes if qualities.get(a.name, qualities.get("*")) == "none"
    } - {"material"}
    bare = qualities.get("*") == "none" and set(qualities.values()) == {"none"}
    held = mesh.metadata
    if bare:
        held = without_materials(held)
    held = without_names(held, left)
    left_out = ["left out: materials, images"] * bool(mesh.metadata.keys() - held.keys())
    if is_single_and_far(mesh.positions):
        held = {**PRECISION, **held}
    # Images are changed before the provenance is written: it tells how the stream was made of the file, not of the
    # images.
    sent, generations = wishes.signed(wishes.images({**held, **wishes.metadata}), options)
    losses, unit = (*notes, *generations), asked_unit(wishes.keywords, known)
    sent_mesh, options = replace(mesh, metadata=sent), with_texels(options, mesh)
    return Recipe(sent_mesh, options, wishes.simplify, unit, losses, (*losses, *left_out))


def given_part(mesh: TriangleMesh, **keywords: Any) -> Recipe:
    """A part of a scene or of tiles, which name unit and provenance for all of their parts."""
    return Recipe(
        mesh, with_texels(encode_options(**in_own_unit(keywords, mesh.metadata, mesh)), mesh)
    )


@dataclass(frozen=True, eq=False)
class MovingRecipe:
    """Frames, the encoder for the wishes, the unit of errors, and how many of it are one of the mesh's; losses."""

    encoder: "SequenceEncoder"
    frames: Iterable[Any]
    unit: tuple[str, float]
    losses: tuple[str, ...]

    def chunks(self, progress: Callable[[int, int], None] | None) -> Iterator[bytes]:
        return self.encoder.chunks(self.frames, progress)


def given_frames(source: Frames, wishes: Wishes, shown: TriangleMesh | None = None) -> MovingRecipe:
    """Frames for the wishes; `shown`: one of them, for the words of errors."""
    metadata = {name: value for name, value in source.metadata.items() if name != TIME_VALUE}
    if source.frame_rate:
        metadata["frame_rate"] = source.frame_rate
    known, notes = wishes.joined(metadata)
    asked = wishes
    # Caches of animations have no faces. Their reader finds vertices by number, so the order is part of their meaning.
    if source.rigged and wishes.options is None:
        asked = replace(wishes, keywords={"keep_order": True, **wishes.keywords})
    options: SequenceOptions = asked.made(sequence_options, SequenceOptions, known, shown)
    # Which order faces have in such a file is an accident of its mesh; sorted ones take fewer bits.
    if source.rigged and options.keep_order:
        source = source.on_sorted_faces()
    sent, generations = wishes.signed(known, options)
    from bsm.codec.sequence.encoder import SequenceEncoder  # not for meshes

    encoder = SequenceEncoder(source.faces, options, source.count, sent, source.attributes)
    unit, losses = asked_unit(wishes.keywords, known), (*notes, *generations)
    return MovingRecipe(encoder, source.meshes or source.frames, unit, losses)


def with_texels(options: EncodeOptions, mesh: TriangleMesh) -> EncodeOptions:
    """Let texture coordinates be off by a quarter of a texel of the largest image, where looks choose their quality."""
    # Only where a look is promised: other options say themselves how exact attributes are.
    side, promise = largest_side(mesh.metadata), options.promise
    asked = dict(options.attributes)
    if not side or "*" in asked or promise is None or promise.look == math.inf:
        return options
    bounds = {
        a.name: repr(_TEXELS / side)
        for a in mesh.attributes
        if a.semantic == "texcoord" and a.values.dtype.kind == "f"
    }
    return replace(options, attributes={**bounds, **asked})
