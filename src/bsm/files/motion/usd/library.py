"""The library usd-core, and the shaders that materials are read from and written to."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple

from bsm.bitstream.errors import imported
from bsm.files.formats.appearance import fields_of

COORDINATES = "st"  # the usual primvar of texture coordinates
SURFACE, TEXTURE, READER = "UsdPreviewSurface", "UsdUVTexture", "UsdPrimvarReader_float2"
TRANSFORM = "UsdTransform2d"
SIDES = ("wrapS", "wrapT")
NO_TIME = float("nan")  # as usd-core has it
# Others are Float.
_KINDS = {"diffuseColor": "Color3f", "emissiveColor": "Color3f", "normal": "Normal3f"}
_MODULES = ("Ar", "Gf", "Sdf", "Tf", "Usd", "UsdGeom", "UsdShade", "UsdSkel", "UsdUtils", "Vt")


class SurfaceInput(NamedTuple):
    """An input of a surface, and the fields of an appearance that are its number and its texture."""

    kind: str
    number_field: str | None
    texture_field: str | None


def _surface_inputs() -> dict[str, SurfaceInput]:
    inputs = {}
    for name, fields in fields_of("USD").items():
        if name in ("prim", "opacity"):
            continue
        by_texture = {field.endswith("_texture"): field for field in fields}
        inputs[name] = SurfaceInput(
            _KINDS.get(name, "Float"), by_texture.get(False), by_texture.get(True)
        )
    return inputs


INPUTS = _surface_inputs()
DEFAULTS = {"diffuseColor": [0.18] * 3, "metallic": [0.0], "roughness": [0.5]}
"""The values of inputs that a surface does not set."""


def import_usd() -> Any:
    """Return the modules of usd-core; raise `DependencyError` where they are missing."""
    for name in _MODULES:
        # One by one: `import pxr` alone loads none of them.
        imported(f"pxr.{name}", "USD files are read and written with usd-core", "usd")
    return sys.modules["pxr"]


@contextmanager
def silence_usd(pxr: Any) -> Iterator[None]:
    """Keep usd-core from printing what our notes say, in versions that allow it."""
    if not hasattr(pxr.Tf, "DiagnosticTrap"):
        yield
        return
    with pxr.Tf.DiagnosticTrap() as trap:
        yield
        trap.Clear()
