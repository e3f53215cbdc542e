"""Check that three.js and usd-core show our files as meant: size, up axis, colors, opacity and times.

Each mesh is written as GLB and as USD, still and moving, and its numbers are compared with those that the table of
conventions asks for (`src/bsm/files/conventions.py`). Expected values are computed here, not by the writers.
"""

import importlib
import json
import re
import subprocess
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

import bsm
from bsm.files.formats.metadata import face_numbers, images_in, materials_in
from bsm.files.mesh import write_mesh
from bsm.files.motion.frames import Shared
from bsm.files.sequence import sequence_writer
from bsm.ground.lengths import metres

Array = npt.NDArray[Any]
WEB = Path(__file__).parents[2] / "web"
START, RATE = 48.0, 24.0
UP = {"x": 0, "y": 1, "z": 2}
OF_USD = 6  # numbers of a row of surfaces that USD has of its own
SHOWN = rb"\x89PNG|\xff\xd8\xff|RIFF....WEBP"  # images that GLB holds
NEAR = 2e-3  # relative, for sizes and colors
THREE = """
import { readFileSync } from "node:fs";
globalThis.self = globalThis;
const THREE = await import("three");
const { GLTFLoader } = await import("three/examples/jsm/loaders/GLTFLoader.js");
for (const path of process.argv.slice(1)) {
    const file = readFileSync(path);
    const data = file.buffer.slice(file.byteOffset, file.byteOffset + file.byteLength);
    const loader = new GLTFLoader();
    loader.register(() => ({ name: "blank", loadTexture: () => Promise.resolve(new THREE.Texture()) }));
    try {
        const gltf = await new Promise((resolve, reject) => loader.parse(data, "", resolve, reject));
        gltf.scene.updateMatrixWorld(true);
        const box = new THREE.Box3().setFromObject(gltf.scene, true);
        const surfaces = [], low = [1e9, 1e9, 1e9], high = [-1e9, -1e9, -1e9];
        gltf.scene.traverse((node) => {
            if (!node.isMesh) return;
            const { color, opacity, transparent, metalness, roughness, side, map, normalMap } = node.material;
            const sets = [map, normalMap].map((image) => (image ? 1 + image.channel : 0));
            surfaces.push([...color.toArray(), transparent ? opacity : 1, metalness, roughness, side ? 1 : 0, ...sets]);
            const shades = node.geometry.attributes.color;
            for (let row = 0; row < (shades ? shades.count : 0); row++)
                for (let axis = 0; axis < 3; axis++) {
                    low[axis] = Math.min(low[axis], shades.getComponent(row, axis));
                    high[axis] = Math.max(high[axis], shades.getComponent(row, axis));
                }
        });
        const times = gltf.animations.flatMap(({ tracks }) => tracks.map(({ times }) => times[0]));
        const extents = box.max.sub(box.min).toArray();
        const shades = low[0] > high[0] ? [] : [low, high];
        const start = times.length ? Math.min(...times) : null;
        console.log(JSON.stringify({ extents, up: 1, surfaces, shades, start }));
    } catch (error) {
        console.log(JSON.stringify({ error: String(error) }));
    }
}
"""
"""A module for Node that prints what three.js makes of each GLB as a line."""


@dataclass
class Seen:
    """Extents in meters and the axis that is up; rows of surfaces (as of `_surface`); ends of colors of vertices."""

    extents: Array
    up: int
    surfaces: Array
    shades: Array
    start: float | None = None
    error: str = ""

    def differences(self, expected: "Seen", *, moving: bool) -> Iterator[str]:
        if self.error:
            yield self.error
            return
        compared: tuple[tuple[str, Array, Array], ...] = (
            ("height in meters", self.extents[self.up], expected.extents[expected.up]),
            (
                "width",
                np.sort(np.delete(self.extents, self.up)),
                np.sort(np.delete(expected.extents, expected.up)),
            ),
            ("colors of vertices", self.shades, expected.shades),
            ("looks of materials", _rows(self.surfaces), _rows(expected.surfaces)),
        )
        size = float(expected.extents.max(initial=0.0))
        for what, value, expected_value in compared:
            if np.shape(value) != np.shape(expected_value) or not np.allclose(
                value,
                expected_value,
                NEAR,
                NEAR * (size if what in ("height in meters", "width") else 1.0),
            ):
                yield f"{what}: {np.round(value, 5).tolist()}, not {np.round(expected_value, 5).tolist()}"
        if moving and (self.start is None or abs(self.start - START / RATE) > 1e-3):
            yield f"the first frame is shown at {self.start} s, not {START / RATE}"


def _rows(surfaces: Array) -> Array:
    return np.unique(np.round(np.atleast_2d(surfaces), 3), axis=0)


def _linear(color: Sequence[float]) -> list[float]:
    return [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in color]


def wanted_of(mesh: bsm.TriangleMesh, *, faces: bool = False) -> Seen:
    """Return what another program should see, by the words of the metadata.

    With `faces`, as in USD, faces have colors, and points that no face uses count.
    """
    size = metres(str(mesh.metadata.get("unit", ""))) or 1.0
    numbers = face_numbers(mesh, "material")
    used = [0] if numbers is None else np.unique(numbers.values).tolist()
    attributes = [
        a for a in mesh.attributes if a.components in (3, 4) and (faces or a.domain != "face")
    ]
    color = next((a for a in attributes if a.semantic == "color"), None)
    bright = next(
        (a for a in attributes if a.name == "color" and a.values.dtype == np.float32), None
    )  # above 1, and linear
    kinds = materials_in(mesh.metadata)
    images = {
        number
        for number, (_, data) in images_in(mesh.metadata).items()
        if re.match(SHOWN, data, re.DOTALL)
    }
    surfaces = np.array(
        [_surface(kinds.get(number, {}), images)[: OF_USD if faces else None] for number in used]
    )
    shades = np.zeros(0)
    if color is None and bright is not None and bright.domain == "vertex":
        values = bright.values[np.unique(mesh.faces), :3]
        shades = np.array([values.min(axis=0), values.max(axis=0)])
    elif color is not None:
        every = np.arange(len(color.values)) if faces else mesh.faces
        rows = every if color.indices is None else color.indices
        values = color.values[np.unique(rows), :3] / (
            1 if color.values.dtype.kind == "f" else np.iinfo(color.values.dtype).max
        )
        shades = np.array([_linear(values.min(axis=0)), _linear(values.max(axis=0))])
    used_points = mesh.positions if faces else mesh.positions[np.unique(mesh.faces)]
    return Seen(
        np.ptp(used_points, axis=0) * size,
        UP.get(str(mesh.metadata.get("up", "y")).lower(), 1),
        surfaces,
        shades,
    )


def _surface(words: dict[str, Any], images: set[int]) -> list[float]:
    """Color, opacity, metal, roughness, double sides, and one more than the set of the images of color and normals."""
    number_words = [
        "Kd",
        "d",
        "Tr",
        "Pm",
        "Pr",
        "baseColorFactor",
        "metallicFactor",
        "roughnessFactor",
    ]
    numbers = {
        n: [float(word) for word in str(words[n]).removeprefix("-halo").split()]
        for n in number_words
        if n in words
    }
    of_gltf = any(
        re.match("name|base|metal|rough|emissive|normalT|occl|alpha|double", name) for name in words
    )
    of_mtl = any(re.match("[A-Z][a-z]|d$|illum|map_|norm$|bump", name) for name in words)
    both = "map_Pr" in words and words.get("map_Pm") == words["map_Pr"]
    metal = numbers.get(
        "metallicFactor", numbers.get("Pm", [float(both or (of_gltf and not of_mtl))])
    )
    rough = numbers.get("roughnessFactor", numbers.get("Pr", [1.0 if of_gltf or of_mtl else 0.9]))
    maps = (("baseColorTexture", "map_Kd"), ("normalTexture", "norm", "map_Bump"))
    sets = [float(any(words.get(name, -1) in images for name in names)) for names in maps]
    rest = [
        *np.clip([*metal, *rough], 0.0, 1.0).tolist(),
        float(bool(words.get("doubleSided"))),
        *sets,
    ]
    if "baseColorFactor" in numbers:
        *color, opacity = numbers["baseColorFactor"]
        return [*color, opacity if words.get("alphaMode", "BLEND") == "BLEND" else 1.0, *rest]
    opacity = (
        numbers["d"][0] if "d" in numbers else 1 - numbers["Tr"][0] if "Tr" in numbers else 1.0
    )
    # As some write where an image has the colors.
    black = "map_Kd" in words and not any(numbers.get("Kd", [1.0]))
    color = [1.0] * 3 if black else numbers.get("Kd", [1.0] * 3)
    return [*np.clip(_linear(color), 0.0, 1.0).tolist(), min(max(opacity, 0.0), 1.0), *rest]


def by_three(paths: Sequence[Path]) -> list[Seen]:
    command = ["node", "--input-type=module", "-e", THREE, *map(str, paths)]
    output = subprocess.run(
        command, cwd=WEB, capture_output=True, text=True, check=True, timeout=600
    ).stdout
    return [
        Seen(np.zeros(3), 1, np.zeros(0), np.zeros(0), None, line["error"]) if "error" in line
        else Seen(np.array(line["extents"]), 1, np.array(line["surfaces"]), np.array(line["shades"]), line["start"])
        for line in map(json.loads, output.splitlines())
    ]  # fmt: skip


def by_usd(path: Path) -> Seen:
    usd, geom, shade = (
        importlib.import_module(f"pxr.{name}") for name in ("Usd", "UsdGeom", "UsdShade")
    )
    stage = usd.Stage.Open(str(path))
    code = usd.TimeCode(stage.GetStartTimeCode())
    box = (
        geom.BBoxCache(code, [geom.Tokens.default_])
        .ComputeWorldBound(stage.GetPseudoRoot())
        .ComputeAlignedRange()
    )
    surfaces, shades = [], np.zeros(0)
    for prim in stage.Traverse():
        if prim.IsA(shade.Material):
            surface = shade.Material(prim).ComputeSurfaceSource()[0]
            inputs = map(surface.GetInput, ("diffuseColor", "opacity", "metallic", "roughness"))
            input_values = (
                value.Get() if value and not value.HasConnectedSource() else None
                for value in inputs
            )
            color, opacity, *rough = input_values
            surfaces.append([*(color or [1.0] * 3), 1.0 if opacity is None else opacity, *rough])
        elif (
            prim.IsA(geom.Mesh)
            and (var := geom.Mesh(prim).GetDisplayColorPrimvar())
            and var.HasValue()
        ):
            values = np.array(var.ComputeFlattened(code))
            shades = np.array([values.min(axis=0), values.max(axis=0)])
    extents = np.array(box.GetSize()) * geom.GetStageMetersPerUnit(stage)
    up = UP[str(geom.GetStageUpAxis(stage)).lower()]
    return Seen(
        extents,
        up,
        np.array(surfaces),
        shades,
        stage.GetStartTimeCode() / stage.GetTimeCodesPerSecond(),
    )


@dataclass
class Acts:
    """Meshes to write into a folder, with the values that readers must find."""

    folder: Path
    waiting: list[tuple[str, Path, Seen, bool]] = field(default_factory=list)

    def add(self, name: str, mesh: bsm.TriangleMesh) -> Iterator[tuple[str, str]]:
        """Write a mesh; yield what usd-core finds wrong. A mesh that a format cannot hold is none of its files."""
        expected = wanted_of(mesh)
        about = {**mesh.metadata, "frame_rate": RATE, "frame_start": START}
        shared = Shared(lambda: mesh.attributes, lambda: about)
        for kind in ("glb", "moving.glb", "usdc"):
            path = self.folder / f"{len(self.waiting)}.{kind}"
            try:
                if kind == "glb":
                    write_mesh(path, mesh)
                else:
                    with sequence_writer(
                        str(path), path.suffix[1:], mesh.faces, 2, overwrite=True, shared=shared
                    ) as write:
                        write(mesh.positions)
                        write(mesh.positions)
            except bsm.BsmError:
                continue
            if kind != "usdc":
                self.waiting.append((f"{name}, {kind}", path, expected, kind != "glb"))
                continue
            result = by_usd(path)
            expected = wanted_of(mesh, faces=True)
            is_expected = [
                (np.abs(expected.surfaces - row).max(axis=1) < NEAR).any()
                for row in np.reshape(result.surfaces, (-1, OF_USD))
            ]
            result.surfaces = (
                result.surfaces[is_expected] if any(is_expected) else result.surfaces
            )  # it also has those that no face has
            numbers, kinds = face_numbers(mesh, "material"), materials_in(mesh.metadata)
            if not all(
                map(kinds.get, [0] if numbers is None else np.unique(numbers.values).tolist())
            ):
                bare = np.array([_surface({}, set())[:OF_USD]])  # faces without a material
                result.surfaces = np.concatenate([np.reshape(result.surfaces, (-1, OF_USD)), bare])
            yield from (
                (f"{name}, usdc", what) for what in result.differences(expected, moving=True)
            )
            path.unlink()

    def finish(self) -> Iterator[tuple[str, str]]:
        """Yield what three.js finds wrong."""
        for begin in range(0, len(self.waiting), 100):
            batch = self.waiting[begin : begin + 100]
            for (name, path, expected, moving), result in zip(
                batch, by_three([path for _, path, _, _ in batch]), strict=True
            ):
                yield from ((name, what) for what in result.differences(expected, moving=moving))
                path.unlink()
