"""The metadata entry that records how a stream was made: version, promise, and hash of the input."""

import re
from collections.abc import Mapping
from hashlib import sha256
from pathlib import Path
from typing import Any

from bsm import __version__
from bsm.codec.geometry.mesh import Metadata
from bsm.codec.static.targets import ANY_ANGLE
from bsm.files.pipes import read_chunks
from bsm.libraries import PROVENANCE, has_provenance

_GENERATION = re.compile(r" generation=(\d{1,6})")
_BOUNDS = ("farthest", "angle", "visual", "look")


def with_provenance(
    metadata: Metadata, asked: bool | None, path: str, given: Mapping[str, Any], options: Any
) -> tuple[Metadata, list[str]]:
    """Return metadata with a provenance entry, if it is requested or the input has one, and notes."""
    if not has_provenance(metadata):
        return {**metadata, **({PROVENANCE: _words(path, given, options, 1)} if asked else {})}, []
    found = _GENERATION.search(str(metadata[PROVENANCE]))
    generation = 1 + int(found[1] if found else 1)
    exact = getattr(options, "is_grid", False)
    notes = [
        f"the mesh was decoded from a stream, so this is generation {generation}"
        + ("" if exact else ": errors add up, so encode the original if you have it")
    ]
    kept = {name: value for name, value in metadata.items() if name != PROVENANCE}
    return kept if asked is False else {**kept, PROVENANCE: _words(path, given, options, generation)}, notes


def _words(path: str, given: Mapping[str, Any], options: Any, generation: int) -> str:
    promise, target = options.promise, options.target
    parts = [f"bsm {__version__}", given.get("preset") or ("balanced" if promise else "none")]
    bounds = {name: getattr(promise, name, None) for name in _BOUNDS} if promise else {}
    if promise and not promise.absolute:
        bounds["farthest"] = f"{100 * promise.farthest:g}%"
    shown = {name: f"{value:g}" if isinstance(value, float) else value for name, value in bounds.items()}
    parts += [f"{name}={value}" for name, value in shown.items() if value not in (None, "inf", f"{ANY_ANGLE:g}")]
    parts += [f"{target.kind}={target.value:g}"] if target else []
    parts += [f"generation={generation}"] if generation > 1 else []
    if Path(path).is_file():
        digest = sha256()
        for chunk in read_chunks(path):
            digest.update(chunk)
        parts.append(f"sha256={digest.hexdigest()}")
    return " ".join(parts)
