"""`python -m tools.attack doors`: do others read in a file what comes back from a stream of it?

Each file is read, encoded with `lossless` (or `grid14`, where single precision is too coarse), decoded and compared
with what trimesh, meshio, PyMeshLab and usd-core read: area, orientation, places, colors, texture coordinates
and normals as moments, which do not depend on the order of faces; the number of triangles; names of materials; their
colors, and whether they have an image, metal, roughness and sides, as far as trimesh, pycollada, lib3mf and usd-core
know these.
The polygons of OBJ, OFF and USD are also read here. Their area vectors do not depend on the cut, and if ours are the
same, another reader's triangles are not a finding. Polygons that are not flat, and quads whose edges cross, have a
tolerance: what their heights and the milder cut add.
A difference is right if a note of ours names it, or explained in `doors.json`, or a finding.

Files are those of packages of Debian and PyPI, listed in `doors.json` with licence and SHA-256, and of folders.
"""

import fnmatch
import hashlib
import importlib
import json
import re
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import BrokenExecutor, ProcessPoolExecutor
from dataclasses import dataclass, field, replace
from multiprocessing import get_context
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
import numpy.typing as npt

import bsm
from bsm.bitstream.errors import imported
from bsm.codec.geometry.attributes import at_corners
from bsm.files.conventions import to_linear
from bsm.files.formats.appearance import appearance, within
from bsm.files.formats.metadata import materials_in, names_in, rgba
from bsm.gltf.compress import compress, restore
from bsm.gltf.document import read_document
from tools.attack.acts import Acts
from tools.command import parser_of
from tools.replicate.fetch import unpacked

Array = npt.NDArray[Any]
LIST = Path(__file__).parent / "doors.json"
EXACT, ON_GRID = 1e-5, 1e-3  # by how much moments may differ, relative to what they add up
OF_LOOKS = 0.02  # by how much linear colors may differ: others round them to bytes
UNSAID = (102, 102, 102, 255)  # the color that trimesh gives to materials that say none
UNEVEN = 0.05  # the most that polygons which are not flat, or cross themselves, add to that
LARGEST = 3_000_000  # bytes of a file
USD = ("usd", "usda", "usdc", "usdz")
KINDS = ("ply", "obj", "stl", "off", "dae", "3mf", "glb", "gltf", "vtp", *USD)
SECONDS = 120  # that a reader may take for a file


@dataclass
class Read:
    """Triangles, shape (m, 3, 3), values of their corners, shape (m, 3, c), and names of materials and groups.

    With `normals`, shape (m, 3), the triangles are fans of polygons, and areas are counted along these.
    """

    triangles: Array
    values: dict[str, Array] = field(default_factory=dict)
    materials: set[str] = field(default_factory=set)
    groups: set[str] = field(default_factory=set)
    normals: Array | None = None
    uneven: float = 0.0
    looks: list[tuple[float, ...]] = field(default_factory=list)
    """Of materials: linear color, 1 if it has an image, metal, roughness, 1 for double sides; NaN is not known."""

    def count(self) -> int:
        """The number of triangles with an area."""
        a, b, c = self.triangles[:, 0], self.triangles[:, 1], self.triangles[:, 2]
        return int((np.cross(b - a, c - a) != 0).any(axis=1).sum())

    def moments(self) -> dict[str, Array]:
        """Sums over the surface, divided by what they could be at most."""
        corners = self.triangles.astype(np.float64)
        if not len(corners):
            return {}
        low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
        corners = (corners - (low + high) / 2) / (float(np.linalg.norm(high - low)) or 1.0)
        vectors = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        areas = (
            np.linalg.norm(vectors, axis=1)
            if self.normals is None
            else (vectors * self.normals).sum(axis=1)
        )
        middles = corners.mean(axis=1)
        area = areas.sum() or 1.0
        sums = {
            "area": np.array([area]),
            "place": areas @ middles / area,
            "turn": vectors.T @ middles / area,
        }
        sums |= {"bounds": np.concatenate([low, high]) / (np.abs([low, high]).max() or 1.0)}
        for name, values in self.values.items():
            of_faces = values.astype(np.float64).mean(axis=1)
            weight = area * (np.abs(of_faces).max(initial=0.0) or 1.0)
            moved = (areas[:, None] * of_faces).T @ middles
            sums[name] = np.concatenate([areas @ of_faces, moved.ravel()]) / weight
        return sums


def of_ours(mesh: bsm.TriangleMesh) -> Read:
    values: dict[str, Array] = {}
    for attribute in mesh.attributes:
        if (
            attribute.semantic in ("color", "normal", "texcoord")
            and attribute.semantic not in values
        ):
            table = (
                rgba(attribute)[:, :3] / 255 if attribute.semantic == "color" else attribute.values
            )
            width = {"texcoord": 2}.get(attribute.semantic, 3)
            if table.shape[1] >= width:
                plain = bsm.Attribute(
                    "x", table[:, :width], attribute.domain, indices=attribute.indices
                )
                values[attribute.semantic] = at_corners(plain, mesh.faces)
    names = {str(material.get("name", "")) for material in materials_in(mesh.metadata).values()}
    groups = {
        name
        for what in ("part", "group", "object")
        for name in names_in(mesh.metadata, what).values()
    }
    groups |= {str(mesh.metadata.get("name", ""))}
    looks_of_materials = (
        within(appearance(words))[0] for words in (*materials_in(mesh.metadata).values(), {})
    )
    looks = [
        (
            *look.color,
            look.color_texture is not None,
            look.metallic,
            look.roughness,
            look.double_sided,
        )
        for look in looks_of_materials
    ]
    return Read(mesh.positions[mesh.faces], values, names - {""}, groups - {""}, looks=looks)


def of_trimesh(path: Path) -> Read:
    library = imported("trimesh", "files are compared with trimesh", "formats")
    scene = library.load_scene(path, process=False)
    triangles, values, names = [np.zeros((0, 3, 3))], dict[str, list[Array]](), set[str]()
    looks = list[tuple[float, ...]]()
    parts = [
        (scene.graph[node][0], scene.geometry[scene.graph[node][1]])
        for node in scene.graph.nodes_geometry
    ]
    for matrix, part in parts:
        if not hasattr(part, "faces"):
            continue
        faces = part.faces[:, ::-1] if np.linalg.det(matrix[:3, :3]) < 0 else part.faces
        triangles.append((np.asarray(part.vertices) @ matrix[:3, :3].T + matrix[:3, 3])[faces])
        if part.visual.kind == "texture":
            uv = part.visual.uv
            if uv is not None and np.shape(uv) == (len(part.vertices), 2):
                values.setdefault("texcoord", []).append(np.asarray(uv)[faces])
            names.add(str(getattr(part.visual.material, "name", "") or ""))
            looks += (
                _looks_of_trimesh(part.visual.material)
                if path.suffix.lower() in (".glb", ".gltf", ".obj")
                else []
            )
        elif part.visual.kind == "vertex":
            values.setdefault("color", []).append(part.visual.vertex_colors[faces][..., :3] / 255)
        if "vertex_normals" in part._cache and np.array_equal(matrix, np.eye(4)):
            values.setdefault("normal", []).append(part.vertex_normals[faces])
    complete = {
        name: np.concatenate(tables)
        for name, tables in values.items()
        if len(tables) == len(triangles) - 1
    }
    several = path.suffix.lower() == ".3mf" and len(parts) == len(scene.geometry) > 1
    # A number is its own, for no name.
    groups = {name for name in scene.geometry if several and not name.isdigit()}
    return Read(
        np.concatenate(triangles),
        complete,
        names - {"", "default", "material_0"},
        groups,
        looks=looks,
    )


def _looks_of_trimesh(material: Any) -> list[tuple[float, ...]]:
    """Its material of glTF, or of MTL where that says a color, which is in sRGB."""
    if hasattr(material, "baseColorFactor"):
        color = (
            (1.0, 1.0, 1.0)
            if material.baseColorFactor is None
            else (material.baseColorFactor[:3] / 255).tolist()
        )
        factors = (
            1.0 if f is None else f for f in (material.metallicFactor, material.roughnessFactor)
        )
        return [
            (*color, material.baseColorTexture is not None, *factors, bool(material.doubleSided))
        ]
    color = to_linear(np.asarray(getattr(material, "diffuse", UNSAID))[None, :3] / 255)[0].tolist()
    has_look = not np.array_equal(getattr(material, "diffuse", UNSAID), UNSAID)
    return [(*color, 1.0 if material.image else np.nan, *3 * [np.nan])] if has_look else []


def of_lib3mf(path: Path) -> Read:
    """The triangles of the objects of a 3MF where its build places them, and the materials that they use."""
    model = (
        imported("lib3mf", "3MF files are compared with lib3mf", "formats")
        .get_wrapper()
        .CreateModel()
    )
    model.QueryReader("3mf").ReadFromFile(str(path))
    items, waiting, triangles, used = (
        model.GetBuildItems(),
        list[Any](),
        [np.zeros((0, 3, 3))],
        set[tuple[int, int]](),
    )

    def placed(transform: Any) -> Array:
        return np.array(
            [[*row, end] for row, end in zip(transform.Fields, (0, 0, 0, 1), strict=True)]
        )

    while items.MoveNext():
        waiting.append(
            (
                items.GetCurrent().GetObjectResource(),
                placed(items.GetCurrent().GetObjectTransform()),
            )
        )
    while waiting:
        item, matrix = waiting.pop()
        if item.IsComponentsObject():
            parts = map(item.GetComponent, range(item.GetComponentCount()))
            waiting += [
                (part.GetObjectResource(), placed(part.GetTransform()) @ matrix) for part in parts
            ]
            continue
        points = np.array([[*vertex.Coordinates, 1.0] for vertex in item.GetVertices()]) @ matrix
        faces = np.array([triangle.Indices[:] for triangle in item.GetTriangleIndices()])
        triangles.append(points[faces[:, ::-1] if np.linalg.det(matrix) < 0 else faces][..., :3])
        usual, of_usual, _ = item.GetObjectLevelProperty()
        properties = [
            (one.ResourceID, one.PropertyIDs[0]) for one in item.GetAllTriangleProperties()
        ]
        used |= {one if one[0] else (usual, of_usual) for one in properties}
    plain = [
        one for one in used if one[0] and model.GetPropertyTypeByID(one[0]).name == "BaseMaterial"
    ]
    colors = [
        model.GetBaseMaterialGroupByID(owner).GetDisplayColor(place) for owner, place in plain
    ]
    linear = [to_linear(np.array([[c.Red, c.Green, c.Blue]]) / 255)[0].tolist() for c in colors]
    return Read(np.concatenate(triangles), looks=[(*color, 0.0, *3 * [np.nan]) for color in linear])


def of_collada(path: Path) -> Read:
    """The colors of the effects that a DAE uses."""
    library = imported("collada", "DAE files are compared with pycollada", "formats")
    document = library.Collada(str(path), ignore=[library.common.DaeError])
    parts = [part for node in document.scene.objects("geometry") for part in node.primitives()]
    drawn = [part for part in parts if part.material and "Line" not in type(part).__name__]
    looks = []
    for effect in (part.material.effect for part in drawn):
        plain = isinstance(effect.diffuse, tuple)
        color = to_linear(np.array([effect.diffuse[:3]]))[0].tolist() if plain else 3 * [1.0]
        looks.append(
            (
                *color,
                not plain and effect.diffuse is not None,
                np.nan,
                np.nan,
                bool(effect.double_sided),
            )
        )
    return Read(np.zeros((min(len(drawn), 1), 3, 3)), looks=looks)


def of_meshio(path: Path) -> Read:
    library = imported("meshio", "files are compared with meshio", "test")
    mesh = library.read(path)
    cut = [rows[:, [0, i, i + 1]] for kind, rows in mesh.cells_dict.items() if kind in ("triangle", "quad", "polygon")
           for i in range(1, rows.shape[1] - 1)]  # fmt: skip
    faces = np.concatenate([np.zeros((0, 3), np.int64), *cut])
    values, data = {}, mesh.point_data
    if all(name in data for name in ("red", "green", "blue")):
        color = np.column_stack([data[name] for name in ("red", "green", "blue")])
        values["color"] = color[faces] / (255 if color.dtype.kind == "u" else 1)
    if all(name in data for name in ("nx", "ny", "nz")):
        values["normal"] = np.column_stack([data[name] for name in ("nx", "ny", "nz")])[faces]
    if mesh.points.ndim != 2 or mesh.points.shape[1] != 3:
        raise ValueError("meshio returns points that are not in space")
    return Read(mesh.points[faces], values)


def of_pymeshlab(path: Path) -> Read:
    library = imported("pymeshlab", "files are compared with PyMeshLab", "replicate")
    everything = library.MeshSet()
    everything.load_new_mesh(str(path))
    colored = path.suffix.lower() != ".obj" or re.search(
        rb"^v([ \t]+\S+){6}", path.read_bytes(), re.M
    )
    triangles, values = [np.zeros((0, 3, 3))], dict[str, list[Array]]()
    for mesh in everything:
        faces = mesh.face_matrix()
        triangles.append(mesh.transformed_vertex_matrix()[faces])
        if mesh.has_vertex_color() and colored:  # in others, it makes colors of those of materials
            values.setdefault("color", []).append(mesh.vertex_color_matrix()[faces][..., :3])
        # Zeros: it has not read them.
        if mesh.has_wedge_tex_coord() and mesh.wedge_tex_coord_matrix().any():
            values.setdefault("texcoord", []).append(
                mesh.wedge_tex_coord_matrix().reshape(-1, 3, 2)
            )
    complete = {
        name: np.concatenate(tables)
        for name, tables in values.items()
        if len(tables) == len(triangles) - 1
    }
    return Read(np.concatenate(triangles), complete)


def of_polygons(points: Array, sizes: Sequence[int], corners: Array) -> Read:
    """Cut polygons into fans from their first corners; a fan's area vectors add up to the polygon's in any cut."""
    counts, corners = np.asarray(sizes, np.int64), np.asarray(corners, np.int64)
    first = np.cumsum(counts) - counts
    faces = np.repeat(np.arange(len(counts)), np.maximum(counts - 2, 0))
    step = np.arange(len(faces)) - np.searchsorted(faces, faces) + 1
    begin = first[faces]
    triangles = points[corners[np.stack([begin, begin + step, begin + step + 1], axis=1)]]
    vectors = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    sums = np.zeros((len(counts), 3))
    np.add.at(sums, faces, vectors)
    normals = sums / np.maximum(np.linalg.norm(sums, axis=1), 1e-300)[:, None]
    heights = np.abs(((triangles - triangles[:, :1]) * normals[faces][:, None]).sum(axis=2)).max(
        axis=1, initial=0.0
    )
    areas = np.linalg.norm(vectors, axis=1)
    size = (
        float(np.linalg.norm(np.ptp(triangles.reshape(-1, 3), axis=0))) if len(triangles) else 1.0
    )
    added = areas * heights / (size or 1.0) + areas - np.abs((vectors * normals[faces]).sum(axis=1))
    quads = np.flatnonzero(counts == 4)
    turned = points[corners[first[quads][:, None] + [[1, 2, 3, 1, 3, 0]]]].reshape(-1, 2, 3, 3)
    other_areas = np.linalg.norm(
        np.cross(turned[:, :, 1] - turned[:, :, 0], turned[:, :, 2] - turned[:, :, 0]), axis=2
    )
    # More where edges cross.
    cut = np.minimum(np.bincount(faces, areas, len(counts))[quads], other_areas.sum(axis=1))
    crossed = (cut - np.linalg.norm(sums, axis=1)[quads]).sum()
    return Read(
        triangles,
        normals=normals[faces],
        uneven=2 * float((added.sum() + crossed) / (areas.sum() or 1.0)),
    )


def of_off(path: Path) -> Read:
    """Read the points and polygons of a text OFF, a line each."""
    lines = [line.split("#")[0].split() for line in path.read_text("latin1").splitlines()]
    lines = [line for line in lines if line]
    if re.fullmatch("(ST)?C?N?OFF", lines[0][0]):
        lines[0] = lines[0][1:]
    lines = [line for line in lines if line]
    points, faces = map(int, lines[0][:2])
    rows = [
        [int(word) for word in line]
        for line in (line[: int(line[0]) + 1] for line in lines[1 + points :][:faces])
    ]
    positions = np.array([line[:3] for line in lines[1 : points + 1]], np.float64)
    return of_polygons(
        positions, [len(row) - 1 for row in rows], np.array([v for row in rows for v in row[1:]])
    )


def of_obj(path: Path) -> Read:
    """Read the points and polygons of an OBJ."""
    points, sizes, corners = list[list[float]](), list[int](), list[int]()
    for line in path.read_text("latin1").replace("\\\n", " ").splitlines():
        first, *words = line.split("#")[0].split() or [""]
        if first == "v":
            points.append([float(word) for word in words[:3]])
        elif first == "f":
            rows = [int(word.split("/")[0]) for word in words]
            corners += [row - 1 if row > 0 else len(points) + row for row in rows]
            sizes.append(len(rows))
    return of_polygons(np.array(points), sizes, np.array(corners))


def of_usd(path: Path) -> Read:
    """Read the polygons of a stage at its first time, as its skeletons move them."""
    pxr = imported("pxr", "USD files are compared with usd-core", "usd")
    names = ("Usd", "UsdGeom", "UsdSkel", "UsdShade")
    usd, geom, skel, shade = (importlib.import_module(f"{pxr.__name__}.{name}") for name in names)
    looks, prim_of = set[tuple[float, ...]](), lambda schema: schema.GetPrim()
    stage = usd.Stage.Open(str(path))
    stage.SetEditTarget(stage.GetSessionLayer())
    skel.BakeSkinning(stage.Traverse())
    forward = stage.GetStartTimeCode() <= stage.GetEndTimeCode()
    code = usd.TimeCode(stage.GetStartTimeCode()) if forward else usd.TimeCode.EarliestTime()
    points = [np.zeros((0, 3))]
    sizes, corners, many = [np.zeros(0, np.int64)], [np.zeros(0, np.int64)], 0
    cache = geom.XformCache(code)
    purposes = {
        geom.Imageable(prim).ComputePurpose() for prim in stage.Traverse() if geom.Mesh(prim)
    }
    left_out = {
        geom.Tokens.guide,
        geom.Tokens.proxy if geom.Tokens.render in purposes else geom.Tokens.guide,
    }
    for prim in usd.PrimRange(
        stage.GetPseudoRoot(), usd.TraverseInstanceProxies(usd.PrimDefaultPredicate)
    ):
        mesh, imageable = geom.Mesh(prim), geom.Imageable(prim)
        if (
            not mesh
            or imageable.ComputeVisibility(code) == geom.Tokens.invisible
            or imageable.ComputePurpose() in left_out
        ):
            continue
        matrix = np.array(cache.GetLocalToWorldTransform(prim))
        points.append(
            np.asarray(mesh.GetPointsAttr().Get(code), np.float64) @ matrix[:3, :3] + matrix[3, :3]
        )
        rows = np.asarray(mesh.GetFaceVertexIndicesAttr().Get(code))
        counts = np.asarray(mesh.GetFaceVertexCountsAttr().Get(code))
        if (mesh.GetOrientationAttr().Get() == geom.Tokens.leftHanded) != (
            np.linalg.det(matrix[:3, :3]) < 0
        ):
            begin = np.repeat(2 * (np.cumsum(counts) - counts) + counts - 1, counts)
            rows = rows[begin - np.arange(len(rows))]
        is_kept = ~np.isin(np.arange(len(counts)), mesh.GetHoleIndicesAttr().Get(code) or [])
        sizes.append(counts[is_kept])
        corners.append(rows[np.repeat(is_kept, counts)] + many)
        many += len(points[-1])
        sets = geom.Subset.GetAllGeomSubsets(imageable)
        for bound in (
            shade.MaterialBindingAPI(p).ComputeBoundMaterial()[0]
            for p in map(prim_of, sets or [mesh])
        ):
            surface = bound.ComputeSurfaceSource()[0] if bound else None
            if surface and surface.GetIdAttr().Get() == "UsdPreviewSurface":
                looks.add((*_inputs_of_usd(surface), bool(mesh.GetDoubleSidedAttr().Get())))
    polygons = of_polygons(
        np.concatenate(points), np.concatenate(sizes).tolist(), np.concatenate(corners)
    )
    return replace(polygons, looks=[*looks])


def _inputs_of_usd(surface: Any) -> Iterator[float]:
    """The color, 1 if that is an image, metal and roughness of a surface; NaN where these are images."""
    for name, usual in (("diffuseColor", [0.18] * 3), ("metallic", [0.0]), ("roughness", [0.5])):
        shader_input = surface.GetInput(name)
        sources = shader_input.GetValueProducingAttributes() if shader_input else []
        painted = (
            bool(sources)
            and sources[0].GetPrim() != surface.GetPrim()
            and "rgb" in sources[0].GetName()
        )
        value = sources[0].Get() if sources else usual
        yield from [np.nan] * len(usual) if value is None else np.reshape(value, -1).tolist()
        if name == "diffuseColor":
            yield float(painted)


OTHERS: dict[str, tuple[Callable[[Path], Read], tuple[str, ...]]] = {
    "trimesh": (of_trimesh, ("ply", "obj", "stl", "off", "dae", "3mf", "glb", "gltf")),
    "meshio": (of_meshio, ("ply", "obj", "stl", "off", "vtp")),
    "pymeshlab": (of_pymeshlab, ("ply", "obj", "stl", "off", "dae", "3mf")),
    "pycollada": (of_collada, ("dae",)),
    "lib3mf": (of_lib3mf, ("3mf",)),
    "usd": (of_usd, USD),
    "off polygons": (of_off, ("off",)),
    "obj polygons": (of_obj, ("obj",)),
}
EVEN = ("usd", "off polygons", "obj polygons")
SHAPE = ("area", "place", "turn", "bounds", "triangles")


def attempt(name: str, path: Path) -> Read | None:
    """What a reader finds in a file; their own errors stay here, for with one comes the library."""
    try:
        return OTHERS[name][0](path)
    except (Exception, SystemExit):  # they promise nothing about files that they do not like
        return None


class Apart:
    """Readers in a process of their own, which may crash or hang; a crash is tried again, for it may be of before."""

    def __init__(self) -> None:
        self._pool: ProcessPoolExecutor | None = None

    def read(self, name: str, path: Path) -> Read | None:
        for _ in range(2):
            self._pool = self._pool or ProcessPoolExecutor(
                1, get_context("spawn"), max_tasks_per_child=40
            )
            try:
                return self._pool.submit(attempt, name, path).result(SECONDS)
            except (BrokenExecutor, TimeoutError):
                for process in (self._pool._processes or {}).values():
                    process.kill()
                self._pool.shutdown(wait=False)
                self._pool = None
        return None

    def close(self) -> None:
        if self._pool is not None:
            self._pool.shutdown()


_WORDS = {"color": "color", "texcoord": "texture", "normal": "normal", "looks": "image"}


def compared(path: Path, readers: Sequence[str], apart: Apart) -> Iterator[tuple[str, str, str]]:
    """Who was compared with, with which result, and the difference.

    Results are "same", "noted", "differs", "refused" for files over our limits, and "settled" where the polygons agree.
    """
    kind = path.suffix[1:].lower()
    theirs: dict[str, Read] = {}
    for name in (name for name in readers if kind in OTHERS[name][1]):
        if (read := apart.read(name, path)) and len(read.triangles):
            theirs[name] = read
    try:
        file = bsm.read_mesh(path)
        ours, notes, most = *coded(file.mesh), EXACT
    except bsm.BsmError as error:
        over = isinstance(error, bsm.LimitError) or "default limits would refuse" in str(error)
        for name in theirs or ["nobody"]:
            yield (
                name,
                "refused" if over else "differs" if theirs else "same",
                f"{type(error).__name__}: {error}",
            )
        return
    if notes and notes[0] == "grid14":
        most = ON_GRID
    words = " | ".join((*file.notes, *notes)).lower()
    differences_by_name = {
        name: dict(differences(name, ours, read, most, words)) for name, read in theirs.items()
    }
    right = any(
        name in EVEN and not {*differences_by_name[name]}.intersection(SHAPE)
        for name in differences_by_name
    )
    for name, wrong in differences_by_name.items():
        # Its triangles, and so its values, are others.
        is_settled = right and not {*wrong}.isdisjoint(SHAPE)
        for what, difference in wrong.items():
            result = "noted" if _WORDS.get(what, what) in words else "differs"
            settled = is_settled and what not in ("materials", "groups")
            yield name, "settled" if settled else result, f"{what} {difference}"
        if not wrong:
            yield name, "same", ""


def differences(
    name: str, ours: Read, read: Read, most: float, words: str
) -> Iterator[tuple[str, str]]:
    """In what ours differs from another reader's, and how."""
    moments, most = ours.moments(), most + min(read.uneven, UNEVEN)
    has_shape = name != "pycollada"  # which is asked for colors only
    for what, value in (read.moments() if has_shape else {}).items():
        mine = moments.get(what)
        off = (
            np.inf
            if mine is None or mine.shape != value.shape
            else float(np.abs(mine - value).max())
        )
        if not off <= most * (1 if what != "area" else float(value[0])):
            yield what, "is lost" if mine is None else f"differs by {off:.2g}"
    for what in ("materials", "groups"):
        if lost := getattr(read, what) - getattr(ours, what):
            yield what, f"lost: {', '.join(sorted(lost)[:5])}"
    for look in sorted({*read.looks}):
        if not any(np.nanmax(np.abs(np.subtract(look, mine))) < OF_LOOKS for mine in ours.looks):
            yield "looks", f"lost: {np.round(look, 3).tolist()}"
    # Corners in line have no area in one cut, and one in another.
    fans = read.normals is not None or not has_shape
    if (
        (mine_too := ours.count()) != (count := read.count())
        and "without area" not in words
        and not fans
    ):
        yield "triangles", f"{mine_too}, by {name} {count}"


def coded(mesh: bsm.TriangleMesh) -> tuple[Read, tuple[str, ...]]:
    """The mesh after a stream, and notes; the first is "grid14" if it had to be one."""
    first: tuple[str, ...] = ()
    exact = {"*": "exact"}
    try:
        encoder = bsm.Encoder(mesh, bsm.EncodeOptions(exact=True, attributes=exact))
        data = encoder.encode()
    except bsm.TargetError:
        first = ("grid14",)
        encoder = bsm.Encoder(mesh, bsm.EncodeOptions(grid=14, attributes=exact))
        data = encoder.encode()
    return of_ours(bsm.decode(data)), (*first, *encoder.notes)


def listed(folder: Path, names: Sequence[str], most: int) -> Iterator[tuple[str, Path]]:
    """The files of packages (all, without names), fetched into a folder; what is missing is named."""
    for package in json.loads(LIST.read_text())["packages"]:
        if names and package["package"] not in names:
            continue
        root = folder / package["package"]
        try:
            unpacked(package, root)
        except (OSError, subprocess.SubprocessError) as error:
            print(f"missing: {package['package']} ({error})", file=sys.stderr)
            continue
        for name, digest in list(package["files"].items())[
            :: max(1, len(package["files"]) // most) if most else 1
        ]:
            if hashlib.sha256((root / name).read_bytes()).hexdigest()[: len(digest)] == digest:
                yield f"{package['package']}/{name}", root / name
            else:
                print(f"missing: {package['package']}: {name} is another file", file=sys.stderr)


VALIDATOR = """
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";
import validator from "gltf-validator";
const files = process.argv.slice(1);
const read = (path) => new Uint8Array(readFileSync(path));
for (const file of files) {
    const options = { externalResourceFunction: async (uri) => read(new URL(uri, pathToFileURL(file))) };
    const rejected = () => ({ issues: { messages: [{ severity: 0, code: "REJECTED" }] } });
    const { issues } = await validator.validateBytes(read(file), options).catch(rejected);
    console.log(JSON.stringify(issues.messages.filter(({ severity }) => severity === 0).map(({ code }) => code)));
}
"""
"""A module for Node that prints the codes of all errors of each file as a line."""
WEB = Path(__file__).parents[2] / "web"


def errors_of(paths: Sequence[Path]) -> list[list[str]]:
    """The errors that the Khronos validator finds in glTF files; it must be installed (`npm ci` in web/)."""
    command = ["node", "--input-type=module", "-e", VALIDATOR, *map(str, paths)]
    output = subprocess.run(
        command, cwd=WEB, capture_output=True, text=True, check=True, timeout=600
    ).stdout
    return [json.loads(line) for line in output.splitlines()]


def rewritten(paths: Sequence[Path], folder: Path) -> Iterator[tuple[Path, str, Counter[str]]]:
    """Each scene after `bsm glb` and after `bsm decode` of that, "refused" or "read", and the errors that are new."""
    rewritten_files: list[tuple[Path, Path]] = []
    for number, path in enumerate(paths):
        for kind, preset in {"grid14": "grid14", "lossless": "lossless"}.items():
            small, plain = (folder / f"{number}.{kind}.{end}.glb" for end in ("small", "plain"))
            try:
                document = read_document(str(path))
                small.write_bytes(compress(document, {"preset": preset, "effort": "quick"}).data)
                plain.write_bytes(restore(read_document(str(small))))
            except bsm.BsmError as error:
                yield path, f"refused: {error}", Counter()
                break
            rewritten_files += [(path, small), (path, plain)]
    before = dict(zip(paths, errors_of(paths), strict=True))
    for (path, output), errors in zip(
        rewritten_files, errors_of([output for _, output in rewritten_files]), strict=True
    ):
        yield path, output.name.partition(".")[2], Counter(errors) - Counter(before[path])


def scenes_in(folders: Sequence[Path]) -> int:
    """Print how scenes in folders fare; return how many errors are new."""
    digests = {
        digest
        for source in json.loads(LIST.read_text())["scenes"]
        for digest in source["files"].values()
    }
    paths = [
        path
        for folder in folders
        for path in sorted(folder.rglob("*"))
        if path.suffix in (".glb", ".gltf")
    ]
    paths = [path for path in paths if path.stat().st_size <= LARGEST]
    listed_ones = sum(hashlib.sha256(path.read_bytes()).hexdigest() in digests for path in paths)
    refused, outputs, added = 0, 0, 0
    with tempfile.TemporaryDirectory() as folder:
        for path, what, errors in rewritten(paths, Path(folder)):
            refused += what.startswith("refused")
            outputs += not what.startswith("refused")
            added += errors.total()
            if errors or what.startswith("refused"):
                print(
                    f"{path}: {what}{': ' if errors else ''}{', '.join(sorted(errors))}", flush=True
                )
    print(
        f"{len(paths)} scenes, {listed_ones} of them listed, {refused} refused; {outputs} outputs, {added} new errors"
    )
    return added


def main() -> NoReturn:
    """Run the command."""
    parser = parser_of(__doc__)
    parser.add_argument("folders", nargs="*", type=Path, help="more files: folders that are walked")
    parser.add_argument(
        "--cache",
        type=Path,
        default=Path(tempfile.gettempdir(), "bsm-doors"),
        help="where packages lie",
    )
    parser.add_argument(
        "--packages",
        nargs="*",
        metavar="NAME",
        help="files of packages of doors.json (default: all)",
    )
    parser.add_argument(
        "--each", type=int, default=0, metavar="N", help="about N files of each package only"
    )
    parser.add_argument(
        "--readers", nargs="*", choices=OTHERS, default=list(OTHERS), help="who is compared with"
    )
    parser.add_argument(
        "--scenes",
        nargs="+",
        type=Path,
        metavar="FOLDER",
        help="rewrite the scenes there, and count new errors",
    )
    parser.add_argument(
        "--acts", action="store_true", help="also write GLB and USD, and ask three.js and usd-core"
    )
    args = parser.parse_args()
    if args.scenes:
        sys.exit(min(scenes_in(args.scenes), 1))
    files = list(listed(args.cache, args.packages, args.each)) if args.packages is not None else []
    for folder in args.folders:
        here = [path for path in sorted(folder.rglob("*")) if path.suffix[1:].lower() in KINDS]
        files += [
            (str(path.relative_to(folder)), path) for path in here if path.stat().st_size <= LARGEST
        ]
    explained = json.loads(LIST.read_text())["explained"]
    counts, findings, apart = Counter[str](), 0, Apart()
    written = tempfile.TemporaryDirectory()
    acts = Acts(Path(written.name))

    def wrong(differing: Iterator[tuple[str, str]]) -> int:
        texts = [
            text
            for text in (f"{n}: {d}" for n, d in differing)
            if not any(key in text for key in explained)
        ]
        print("\n".join(texts), end="\n" * bool(texts), flush=True)
        return len(texts)

    begun = time.monotonic()
    for number, (name, path) in enumerate(files):
        if time.monotonic() > begun + 60:
            begun = time.monotonic()
            print(f"{number} of {len(files)} files, {findings} findings", flush=True)
        try:
            findings += wrong(acts.add(name, bsm.read_mesh(path).mesh)) if args.acts else 0
        except bsm.BsmError:
            counts["refused"] += 1
        for reader, result, difference in compared(path, args.readers, apart):
            texts = f"{reader} {name}: {difference}"
            why = next(
                (why for key, why in explained.items() if fnmatch.fnmatchcase(texts, f"*{key}*")),
                "",
            )
            result = "explained" if result == "differs" and why else result
            counts[result] += 1
            if result == "differs":
                findings += 1
                print(f"{name}: {reader}: {difference}", flush=True)
    findings += wrong(acts.finish()) if args.acts else 0
    written.cleanup()
    print(f"{len(files)} files; comparisons: {dict(counts)}; {findings} findings", flush=True)
    apart.close()
    sys.exit(1 if findings else 0)
