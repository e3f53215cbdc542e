"""The scene of a glTF: curves, nodes, skins and morph targets, at rest or at any time of an animation."""

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import chain
from types import MappingProxyType
from typing import Any
from urllib.parse import unquote

import numpy as np

from bsm.bitstream.errors import FormatError, LimitError, OptionError
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.welding import first_of, group_rows
from bsm.files import conventions, table
from bsm.files.formats import polygons as shapes
from bsm.files.formats.appearance import Material, appearance
from bsm.files.formats.metadata import Value, described
from bsm.files.motion.frames import LIKELY_RATES, Frames, Wanted, between, painted_like, rate_of_times
from bsm.files.parsing import Doubles, Ints, as_format_error, require_counts
from bsm.gltf.coding import INSTANCING, MATTE, STRENGTH, TRIANGLES, TRIANGULAR, UNLIT, Array, Tree, texture_of
from bsm.gltf.document import MOST_NUMBERS, PER_NUMBER, Document, read_document, triangles_of

PER_INSTANCE = 2000  # bytes of the node of an instance, at most
_REST = {"translation": (0, 0, 0), "rotation": (0, 0, 0, 1), "scale": (1, 1, 1)}
_OF_INSTANCES = tuple(map(str.upper, _REST))


@dataclass(frozen=True, eq=False)
class Keyframes:
    """Values at keys, and how they go on between them."""

    times: Doubles
    values: Doubles
    way: str
    turns: bool = False

    def __post_init__(self) -> None:
        each = 3 if self.way == "CUBICSPLINE" else 1
        if not len(self.times) or len(self.values) != each * len(self.times) or (np.diff(self.times) < 0).any():
            raise FormatError(f"a curve has {len(self.values)} values for {len(self.times)} keys, or keys out of order")
        if not (np.isfinite(self.times).all() and np.isfinite(self.values).all()):
            raise FormatError("a curve has a number that is not finite")

    def at(self, time: float) -> Doubles:
        """The value at a time, shape (c,); before the first key and after the last, that of the key."""
        # Times are single precision in files and double here.
        late = 1e-5 if self.way == "STEP" else 0.0  # in single precision a key may lie a little behind its frame
        after = int(np.searchsorted(self.times, time + late, side="right"))
        before, after = max(after - 1, 0), min(after, len(self.times) - 1)
        span = float(self.times[after] - self.times[before])
        part = min(max((time - float(self.times[before])) / span, 0.0), 1.0) if span > 0 else 0.0
        earlier: Doubles = self.values[before]
        later: Doubles = self.values[after]
        if self.way == "CUBICSPLINE":
            keys = self.values.reshape(len(self.times), 3, -1)
            # The Hermite spline of the glTF specification, whose tangents are scaled by the time between keys.
            square, cube = part * part, part * part * part
            mixed: Doubles = (2 * cube - 3 * square + 1) * keys[before, 1] + (3 * square - 2 * cube) * keys[after, 1]
            mixed += span * ((cube - 2 * square + part) * keys[before, 2] + (cube - square) * keys[after, 0])
        elif self.way == "STEP" or part == 0.0:
            return earlier
        # Nearly equal quaternions are mixed linearly: the arc between them divides by a sine that is almost zero.
        elif not self.turns or abs(cosine := float(earlier @ later)) > 1 - 1e-9:
            mixed = earlier + part * ((-later if self.turns and cosine < 0 else later) - earlier)
        else:  # between two quaternions, along the shorter arc
            angle = float(np.arccos(abs(cosine)))
            mixed = np.sin((1 - part) * angle) * earlier + np.sign(cosine) * np.sin(part * angle) * later
        # Splines of quaternions leave the unit sphere.
        return mixed / (float(np.linalg.norm(mixed)) or 1.0) if self.turns else mixed


def matrix_of(translation: Array, rotation: Array, scale: Array) -> Doubles:
    """The 4 x 4 matrix of a translation, a quaternion (x, y, z, w) and a scale."""
    x, y, z, w = (float(number) for number in rotation)
    turn = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
    matrix = np.eye(4)
    matrix[:3, :3] = turn * np.asarray(scale, np.float64)
    matrix[:3, 3] = translation
    return matrix


Curves = Mapping[tuple[int, str], Keyframes]
"""Those of an animation: the node and the property that each moves."""


def parents_of(document: Document) -> dict[int, int]:
    """The nodes of the scene, parents before children, and the parent of each; -1: none."""
    nodes = document.items("nodes")
    children = {int(child) for node in nodes for child in node.get("children", [])}
    roots = [number for number in range(len(nodes)) if number not in children]
    if document.items("scenes"):
        roots = list(document.item("scenes", document.tree.get("scene", 0)).get("nodes", []))
    parents: dict[int, int] = {}
    waiting = [(int(root), -1) for root in reversed(roots)]
    # A list and not recursion: a chain of ten thousand nodes is legal, and Python's stack is shorter.
    while waiting:
        node, parent = waiting.pop()
        # Two parents, or a circle, which would go on for ever.
        if node in parents:
            raise FormatError(f"node {node} of this glTF stands in two places")
        parents[node] = parent
        found = document.item("nodes", node).get("children", [])
        waiting += [(int(child), node) for child in reversed(found)]
    return parents


_AT_REST: Curves = MappingProxyType({})


def places_of(
    document: Document, parents: Mapping[int, int], curves: Curves = _AT_REST, time: float = 0.0
) -> dict[int, Doubles]:
    """The matrix of each node of the scene."""
    places: dict[int, Doubles] = {}
    for node, parent in parents.items():
        tree = document.item("nodes", node)
        moved = {name: curves[node, name].at(time) for name in _REST if (node, name) in curves}
        rest = {name: np.asarray(tree.get(name, usual), np.float64).reshape(-1) for name, usual in _REST.items()}
        local = matrix_of(**{**rest, **moved})
        # glTF forbids to animate a node that has a matrix. Files that do it mean the properties.
        if "matrix" in tree and not moved:
            local = np.asarray(tree["matrix"], np.float64).reshape(4, 4).T
        places[node] = places[parent] @ local if parent >= 0 else local
    return places


def place_instances(document: Document, limits: Limits) -> None:
    """Give a node whose mesh is drawn in several places a child for each of them."""
    nodes, count = document.items("nodes"), 0
    for node in list(nodes):
        given = node.get("extensions", {}).get(INSTANCING, {}).get("attributes", {})
        named = {name.lower(): index for name, index in given.items() if name in _OF_INSTANCES}
        if "mesh" not in node or "skin" in node or not named:
            continue
        count += max(map(document.count, named.values()))
        # A few bytes of JSON can ask for a million instances, without bytes behind them.
        limits.check_memory(PER_INSTANCE * count, 0, document.received)
        tables = {name: document.numbers(index).astype(np.float64) for name, index in named.items()}
        rows = next(iter(tables.values()))
        if any(table.shape != (len(rows), len(_REST[name])) for name, table in tables.items()):
            raise FormatError("the places of a mesh that is drawn several times are not as many, or of other sizes")
        same: Tree = {name: node[name] for name in ("name", "weights") if name in node}
        same |= {"mesh": node.pop("mesh")}
        begin = len(nodes)
        nodes += [same | {name: table[row] for name, table in tables.items()} for row in range(len(rows))]
        node["children"] = [*node.get("children", []), *range(begin, len(nodes))]


@dataclass(frozen=True, eq=False)
class Skin:
    joints: list[int]
    inverse: Doubles


@dataclass(frozen=True, eq=False)
class Primitive:
    node: int
    points: Doubles  # of the vertices, and what each target adds to them, shape (1 + targets, n, 3)
    colors: Doubles  # as well; of no rows where no target adds anything
    faces: Ints
    skin: Skin | None
    joints: Ints
    weights: Doubles
    columns: tuple[shapes.Column, ...]
    normals: Doubles  # as well, of a scene at rest; of no rows where there are none
    material: int
    name: str


class Scene:
    """Everything of a document that is seen, and one animation of it; None: at rest, with all vertices as they are."""

    def __init__(self, document: Document, animation: Tree | None, limits: Limits) -> None:
        self._document, self._limits, self._still = document, limits, animation is None
        self._made: dict[tuple[int, int, int], Primitive] = {}
        self._skins: dict[int, Skin] = {}
        place_instances(document, limits)
        self._nodes = document.items("nodes")
        self._parents = parents_of(document)
        targets = (target for primitive in document.primitives() for target in primitive.get("targets", []))
        self._painted = any("COLOR_0" in target for target in targets)
        # Exporters often write one table for a whole model, of which each primitive uses a part. Those are cut out.
        self._tables = Counter(str(primitive["attributes"]) for primitive in document.primitives())
        self._check_sizes()
        self.notes: list[str] = []
        self._curves = self._animated(animation or {})
        self.parts = [part for node in self._parents for part in self._parts(node)]
        if not self.parts:
            raise FormatError("this glTF has no triangles in its scene")

    # The same mesh may stand in a thousand places. What all uses take together is bounded before the first is made.
    def _check_sizes(self) -> None:
        """Bound what every use of every primitive takes before anything is allocated; zeros have no bytes."""
        document = self._document
        seen = numbers = characters = 0
        sizes: dict[object, tuple[int, int, int]] = {}
        made = set[tuple[object, object]]()
        for tree in (self._nodes[node] for node in self._parents if "mesh" in self._nodes[node]):
            mesh = document.item("meshes", used := tree["mesh"])
            characters += len(str(tree.get("name") or mesh.get("name", "")))
            if used not in sizes:  # only once, however many nodes use it
                sizes[used] = self._size(mesh)
            vertices, given, moved = sizes[used]
            seen += vertices
            # A mesh is made once for each skin; the rest shares its arrays.
            numbers += given if (key := (used, tree.get("skin"))) in made else given + moved
            made.add(key)
        require_counts(self._limits, vertices=seen)
        if numbers > MOST_NUMBERS:
            raise LimitError(f"the meshes of this glTF have {numbers} numbers; the limit is {MOST_NUMBERS}")
        self._limits.check_memory(PER_NUMBER * numbers + 4 * characters, seen, document.received)

    def _size(self, mesh: Tree) -> tuple[int, int, int]:
        """Return the vertices of a mesh, the numbers of its attributes and indices, and those of its targets."""
        primitives, claimed = mesh["primitives"], self._document.claimed
        given = [index for p in primitives for index in (*p["attributes"].values(), p.get("indices"))]
        moved = [index for p in primitives for target in p.get("targets", []) for index in target.values()]
        numbers = sum(claimed(index) for index in given if index is not None)
        return sum(map(self._rows, primitives)), numbers, sum(map(claimed, moved))

    def _rows(self, primitive: Tree) -> int:
        """How many vertices a primitive takes: of a table that others share only those that it uses, at most."""
        count = self._document.count(primitive["attributes"].get("POSITION", 0))
        shared = self._tables[str(primitive["attributes"])] > 1 and "indices" in primitive
        return min(count, self._document.count(primitive["indices"])) if shared else count

    @property
    def vertices(self) -> int:
        return sum(part.points.shape[1] for part in self.parts)

    @property
    def work(self) -> float:
        """Nanoseconds that a frame takes, at most."""
        joints = sum(len(part.skin.joints) for part in self.parts if part.skin is not None)
        tables = [table for part in self.parts for table in (part.points, part.colors, part.joints)]
        numbers = sum(table.size for table in tables) + sum(len(part.points) for part in self.parts)
        return 3e4 * (len(self._parents) + len(self.parts)) + 1e3 * joints + 100.0 * numbers

    @property
    def moves(self) -> bool:
        moved = {node for node, _ in self._curves}
        # A node moves with its parent, and a skinned mesh with any of its joints.
        for node, parent in self._parents.items():  # parents come first
            if parent in moved:
                moved.add(node)
        skins = {id(part.skin): part.skin.joints for part in self.parts if part.skin is not None}
        return not moved.isdisjoint(chain((part.node for part in self.parts), *skins.values()))

    @property
    def keys(self) -> Doubles:
        # One table of times often serves a hundred curves.
        times = {id(curve.times): curve.times for curve in self._curves.values()}  # samplers serve many channels
        # Rounded to microseconds, because exporters compute equal times in different ways.
        return np.unique(np.round(np.concatenate([np.empty(0), *times.values()]), 6))

    def at(self, time: float) -> Doubles:
        """The positions of all parts' vertices, one part after the other."""
        with np.errstate(over="ignore", invalid="ignore"):  # a later check refuses infinite values
            placed = [
                np.einsum("...ij,...j->...i", matrix[..., :3, :3], points) + matrix[..., :3, 3]
                for _, matrix, points in self._placed(time)
            ]
        return np.concatenate(placed)

    def _placed(self, time: float) -> Iterator[tuple[Primitive, Doubles, Doubles]]:
        """Each part with the matrix, or that of each vertex, which places it, and its vertices before that."""
        places = places_of(self._document, self._parents, self._curves, time)
        for part in self.parts:
            points = self._shown(part, part.points, time)
            matrix = places[part.node]
            if part.skin is not None:
                # The node of a skinned mesh does not move it; its joints do, as the specification has it.
                bones = np.array([places[joint] for joint in part.skin.joints]) @ part.skin.inverse
                matrix = np.zeros((len(points), 4, 4))
                for joint, weight in zip(part.joints.T, part.weights.T, strict=True):
                    matrix += weight[:, None, None] * bones[joint]
            yield part, matrix, points

    def turned(self, time: float) -> list[Primitive]:
        """The parts with their faces as they are placed, which mirrors turn around, and with their normals."""
        found = []
        for part, matrix, _ in self._placed(time):
            columns, faces = part.columns, part.faces
            if len(part.normals):
                normals = self._shown(part, part.normals, time)
                values = shapes.compact(shapes.turned_normals(normals, matrix[..., :3, :3]))
                columns = (shapes.Column("normal", values, semantic="normal"), *columns)
            # A mirrored node shows the other side of its faces, so their corners are exchanged.
            sides = np.broadcast_to(np.linalg.det(matrix[..., :3, :3]), part.points.shape[1])
            mirrored = np.median(sides[faces], axis=1) < 0
            turned = np.where(mirrored[:, None], np.arange(3)[::-1], np.arange(3)) + 3 * np.arange(len(faces))[:, None]
            faces = faces.reshape(-1)[turned]
            rows = turned.reshape(-1)
            columns = tuple(c if c.indices is None else replace(c, indices=c.indices[rows]) for c in columns)
            found.append(replace(part, faces=faces, columns=columns))
        return found

    def colors(self, time: float) -> Doubles:
        """The colors of all parts' vertices, white where a part has none; of no rows if no target changes any."""
        if not self._painted:
            return np.zeros((0, 4))
        moved = (self._shown(part, part.colors, time) for part in self.parts)
        found: Doubles = np.clip(np.concatenate(list(moved)), 0.0, 1.0)
        return found

    def _shown(self, part: Primitive, tables: Doubles, time: float) -> Doubles:
        """The first table, and of each of the others as much as its target has weight."""
        targets = tables[1:]
        found: Doubles = tables[0]
        if not len(targets):
            return found
        node = self._nodes[part.node]
        given = node.get("weights", self._document.item("meshes", node["mesh"]).get("weights", [0.0] * len(targets)))
        curve = self._curves.get((part.node, "weights"))
        weights = np.asarray(given, np.float64).reshape(len(targets)) if curve is None else curve.at(time)
        # Of hundreds of targets, a face uses a handful at a time.
        used = np.flatnonzero(weights)
        return found + np.asarray(np.tensordot(weights[used], targets[used], 1))

    def _animated(self, animation: Tree) -> dict[tuple[int, str], Keyframes]:
        document, found, numbers = self._document, {}, 0
        samplers = animation.get("samplers", [])
        tables: dict[int, tuple[Doubles, Doubles]] = {}
        for channel in animation.get("channels", []):
            node, path = channel["target"].get("node"), channel["target"]["path"]
            # Extensions animate materials and visibility, which a mesh has not.
            if node is None or path not in (*_REST, "weights"):
                self.notes.append(f"channels of {str(path)[:40]} were left out")
                continue
            sampler = samplers[channel["sampler"]]
            if channel["sampler"] not in tables:
                numbers += document.claimed(sampler["input"]) + document.claimed(sampler["output"])
                self._limits.check_memory(PER_NUMBER * numbers, 0, document.received)
                tables[channel["sampler"]] = (
                    document.numbers(sampler["input"])[:, 0].astype(np.float64),
                    document.numbers(sampler["output"]).astype(np.float64),
                )
            times, values = tables[channel["sampler"]]
            way = sampler.get("interpolation", "LINEAR")
            each = 3 if way == "CUBICSPLINE" else 1
            if path == "weights":
                values = values.reshape(each * len(times), -1)
                mesh = document.item("meshes", document.item("nodes", node).get("mesh"))
            width = len(_REST[path] if path in _REST else mesh["primitives"][0].get("targets", []))
            if values.shape[1] != width:
                raise FormatError(f"the {path} of node {node} is animated by {values.shape[1]} numbers, not {width}")
            found[int(node), path] = Keyframes(times, values, way, path == "rotation")
        return found

    def _parts(self, node: int) -> list[Primitive]:
        tree, document = self._nodes[node], self._document
        if "mesh" not in tree:
            return []
        mesh = document.item("meshes", tree["mesh"])
        skin = self._skin(tree["skin"]) if "skin" in tree else None
        bound = int(tree["skin"]) if "skin" in tree else -1
        name = str(tree.get("name") or mesh.get("name") or "")
        found = []
        for number, primitive in enumerate(mesh["primitives"]):
            mode = primitive.get("mode", TRIANGLES)
            if mode not in TRIANGULAR or "POSITION" not in primitive["attributes"]:
                self.notes.append(_NO_SURFACES)
                continue
            # A forest has a thousand trees of one mesh.
            made = self._made.get((tree["mesh"], number, bound))  # one that stands in several places is made once
            part = self._part(node, primitive, skin, name) if made is None else replace(made, node=node, name=name)
            self._made[tree["mesh"], number, bound] = part
            found.append(part)
        return found

    def _skin(self, index: object) -> Skin:
        skin = self._document.item("skins", index)
        assert isinstance(index, int)
        if index in self._skins:
            return self._skins[index]
        joints = [int(joint) for joint in skin["joints"]]
        self._limits.check_memory(PER_NUMBER * 16 * len(joints), 0, self._document.received)
        missing = [joint for joint in joints if joint not in self._parents]
        if missing:
            raise FormatError(f"joint {missing[0]} of skin {index} is not in the scene")
        inverse = np.tile(np.eye(4).reshape(16), (len(joints), 1))
        if "inverseBindMatrices" in skin:
            claimed = self._document.claimed(skin["inverseBindMatrices"])
            self._limits.check_memory(PER_NUMBER * claimed, 0, self._document.received)
            inverse = self._document.numbers(skin["inverseBindMatrices"]).astype(np.float64)
        if inverse.shape[0] < len(joints) or inverse.shape[1] != 16:
            raise FormatError(f"skin {index} has {len(inverse)} matrices for {len(joints)} joints")
        self._skins[index] = Skin(joints, inverse[: len(joints)].reshape(-1, 4, 4).transpose(0, 2, 1).copy())
        return self._skins[index]

    def _part(self, node: int, primitive: Tree, skin: Skin | None, name: str) -> Primitive:
        given, document = primitive["attributes"], self._document
        count = document.count(given["POSITION"])
        holders = (given, *primitive.get("targets", []))
        points = np.array([self._of(one.get("POSITION"), count, 3, "positions") for one in holders])
        colors = np.zeros((0, count, 4))
        if self._painted:
            usual = (1.0, *[0.0] * len(holders[1:]))
            colors = np.array([self._shade(one.get("COLOR_0"), count, own) for one, own in zip(holders, usual)])
            given = {name: index for name, index in given.items() if name != "COLOR_0"}
        faces = triangles_of(document, primitive, count)
        joints, weights = np.zeros((count, 0), np.int64), np.zeros((count, 0))
        if skin is not None:
            joints, weights = self._weighed(given, count, f"node {node}", len(skin.joints))
        columns = self._columns(given, count)
        normals = np.zeros((0, count, 3))
        rows: Any = slice(None)
        if not self._still:
            corners = faces.reshape(-1)
            columns = tuple(replace(column, domain="corner", indices=corners) for column in columns)
            # For sequences, vertices that are equal in everything that moves them are one. At rest the encoder does
            # that itself.
            origin = group_rows(np.column_stack([*points, joints, weights, *colors]))
            rows, faces = first_of(origin), origin[faces].astype(np.int64)
        elif "NORMAL" in given:
            normals = np.array([self._of(one.get("NORMAL"), count, 3, "normals") for one in holders])
        if self._still and self._tables[str(primitive["attributes"])] > 1:
            rows, faces = np.unique(faces, return_inverse=True)
            columns = tuple(replace(column, values=column.values[rows]) for column in columns)
            faces = faces.reshape(-1, 3)
        number = int(primitive.get("material", -1))
        # Our own files have this material where a mesh has none, since viewers draw glTF without one as black metal.
        number = number if document.items("materials")[number : number + 1] != [MATTE] else -1
        moved = points[:, rows], colors[:, rows], faces, skin, joints[rows], weights[rows], columns, normals[:, rows]
        return Primitive(node, *moved, number, name)

    def _weighed(self, given: Tree, count: int, what: str, most: int) -> tuple[Ints, Doubles]:
        """The joints of each vertex, all sets side by side, and their weights, whose sum is 1."""
        sets = [number for number in range(len(given)) if {f"JOINTS_{number}", f"WEIGHTS_{number}"} <= given.keys()]
        if not sets:
            raise FormatError(f"the mesh of {what} has a skin, and its vertices name no joints")
        joints = np.hstack([self._of(given[f"JOINTS_{n}"], count, 4, "joints") for n in sets]).astype(np.int64)
        weights = np.hstack([self._of(given[f"WEIGHTS_{n}"], count, 4, "weights") for n in sets])
        if joints.size and joints.max() >= most:
            raise FormatError(f"a vertex of {what} depends on joint {joints.max()} of {most}")
        total = weights.sum(axis=1, keepdims=True)
        # Weights of integers often sum to 254 or 256 of 255.
        return joints, np.divide(weights, total, out=np.zeros_like(weights), where=total > 0)

    def _of(self, index: object, count: int, width: int, what: str) -> Doubles:
        """An accessor for each vertex; zeros where there is none."""
        if index is None:
            return np.zeros((count, width))
        found = self._document.numbers(index).astype(np.float64)
        if found.shape != (count, width):
            raise FormatError(f"{what} of {found.shape} numbers for {count} vertices")
        return found

    def _shade(self, index: object, count: int, usual: float) -> Doubles:
        """Colors as red, green, blue and opacity."""
        found = np.full((count, 4), usual)
        if index is not None:
            values = self._document.numbers(index)
            if len(values) != count or values.shape[1] not in (3, 4):
                raise FormatError(f"COLOR_0 has {values.shape} numbers for {count} vertices")
            found[:, : values.shape[1]] = values
        return found

    def _columns(self, given: Tree, count: int) -> tuple[shapes.Column, ...]:
        found: list[shapes.Column] = []
        # In the order of the file, but sets of a kind by their numbers: TEXCOORD_1 may come before TEXCOORD_0.
        kinds = [name.partition("_")[0] for name in given]
        for name in sorted(given, key=lambda name: (kinds.index(kind := name.partition("_")[0]), name * bool(kind))):
            index, (kind, _, number) = given[name], name.partition("_")  # sets are counted by their order
            if not name.startswith(("TEXCOORD_", "COLOR_", "_")):
                continue
            values: Any = self._document.numbers(index, whole=kind == "COLOR")
            if len(values) != count or values.shape[1] > 4:
                raise FormatError(f"{name} has {values.shape} numbers for {count} vertices")
            later = number if number not in ("", "0") else ""
            if kind == "COLOR":
                found.append(_color(values, f"color{later}", self.notes))
            elif kind == "TEXCOORD":
                upright = values.astype(np.float64)
                upright[:, 1] = 1 - upright[:, 1]  # glTF counts from the top, we from the bottom
                found.append(shapes.Column(f"texcoord{later}", shapes.compact(upright), "vertex", "texcoord"))
            else:
                meaning = shapes.meaning_of(number, values.shape[1])
                found.append(shapes.Column(number, shapes.compact(values), "vertex", meaning))
        return tuple(found)


def _color(values: Array, name: str, notes: list[str]) -> shapes.Column:
    """Colors, which are linear in glTF, as sRGB; numbers above 1 stay as they are, as colors they mean nothing."""
    # Such numbers are data under the name of a color. To clip them would lose them.
    if values.dtype.kind == "f" and values.size and not 0 <= values.min() <= values.max() <= 1:
        notes.append(f"parts whose {name} has values above 1, kept as linear numbers and not as a color")
        return shapes.Column(name, shapes.compact(values))
    return shapes.Column(name, conventions.srgb_colors(values), semantic="color")


# --------------------------------------------------------------------------------------------------------------- frames


USUAL_RATE = 30.0
_NO_SURFACES = "points and lines were left out"


def read_gltf_mesh(document: Document) -> shapes.MeshFile:
    """Read a scene at rest as one mesh: vertices and faces in the order of the file."""
    with as_format_error("glTF"), np.errstate(all="ignore"):  # a later check refuses infinite values
        # At rest all vertices come back as they are; of an animation only those that move apart.
        scene = Scene(document, None, document.limits)
        document.limits.check_work(3 * scene.work, scene.vertices, document.received)
        found = _joined(scene, document, 0.0, document.limits)
        lost = Counter(scene.notes)
        points = lost.pop(_NO_SURFACES, 0)
        counts = [f"{note}: {count}" for note, count in lost.items()]
        counts += map(shapes.compression_note, document.compressed)
        dropped = (*_unread(document, still=True), *([f"points and lines ({points})"] if points else []))
        found = replace(found, notes=(*found.notes, *counts), dropped=dropped)
        return found.checked(document.limits, document.received)


def _unread(document: Document, *, still: bool) -> tuple[str, ...]:
    """Return notes on data of a document that a mesh cannot hold."""
    tree, nodes, placed = document.tree, document.items("nodes"), parents_of(document)
    held = {"animations (--animation encodes one)": "animations", "skins": "skins"} if still else {}
    found = [what for what, name in held.items() if tree.get(name)]
    found += ["morph targets"] if still and any(one.get("targets") for one in document.primitives()) else []
    of_skins = ("JOINTS_", "WEIGHTS_") if tree.get("skins") else ()
    found += [name for name in document.unread if not (of_skins and name.startswith(of_skins))]
    if any("mesh" in node for number, node in enumerate(nodes) if number not in placed):
        found.append("other scenes" if len(document.items("scenes")) > 1 else "nodes outside of the scene")
    found += [f"extras ({name})" for name, value in _all_extras(document) if not isinstance(value, str | int | float)]
    for node in nodes:
        given = node.get("extensions", {}).get(INSTANCING, {}).get("attributes", {})
        found += [f"{name} of instances" for name in given if "skin" in node or name not in _OF_INSTANCES]
    return tuple(dict.fromkeys(found))


@as_format_error("glTF")
@np.errstate(over="ignore", invalid="ignore")  # a later check refuses infinite values
def read_gltf(path: str, wanted: Wanted, limits: Limits = DEFAULT_LIMITS) -> Frames:
    document = read_document(path, limits)
    number, animation = _chosen(document, wanted.animation)
    scene = Scene(document, animation, limits)
    if not scene.moves:
        raise FormatError(
            f"animation {number} of this glTF moves nothing that is read"
            f"{''.join(f' ({note})' for note in dict.fromkeys(scene.notes))}; leave out --animation for the mesh"
        )
    # The first key is the first frame: animations often begin late on the time line.
    keys = scene.keys
    rate = wanted.rate or _rate(keys)
    # The little more keeps the last frame, whose time may be rounded down.
    count = int(np.floor((keys[-1] - keys[0]) * rate + 1e-3)) + 1
    require_counts(limits, frames=count)
    # A short file can ask for a million frames of a large mesh.
    limits.check_work(scene.work * count, scene.vertices * count, document.received)
    times = keys[0] + np.arange(count) / rate
    still = _joined(scene, document, float(times[0]), limits).checked(limits)

    others = len(document.items("animations")) - 1
    called = str(animation.get("name") or number)
    notes = [f"animation {called}, {count} frames at {rate:g} per second", *scene.notes, *still.notes]
    notes += [f"{others} other {'animation was' if others == 1 else 'animations were'} left out"] if others else []
    moving = any("NORMAL" in primitive["attributes"] for primitive in document.primitives())
    notes += ["left out, for they move: normals"] if moving else []
    notes += [f"left out: {', '.join(unread)}"] if (unread := _unread(document, still=False)) else []
    notes += between("key times", (keys - keys[0]) * rate, rate)
    start = {table.START: round(float(keys[0]) * rate, 3)} if keys[0] else {}
    known = {n: v for n, v in still.mesh.metadata.items() if n not in table.FORMATS["glb"].times}
    mesh = replace(still.mesh, metadata=known | start)
    frames = map(scene.at, times.tolist())
    shared = mesh.attributes, tuple(dict.fromkeys(notes)), rate, mesh.metadata
    meshes = (painted_like(mesh, _painted(scene, mesh, time)) for time in times.tolist())
    return Frames(mesh.faces, count, frames, *shared, meshes if len(scene.colors(0.0)) else None)


def _painted(scene: Scene, mesh: TriangleMesh, time: float) -> TriangleMesh:
    """The mesh at a time, its colors, too."""
    color = _color(scene.colors(time), "color", [])
    given = mesh.attributes
    now = (replace(a, values=color.values) if (a.name, a.domain) == ("color", "vertex") else a for a in given)
    return replace(mesh, positions=scene.at(time), attributes=tuple(now))


def _chosen(document: Document, wish: str) -> tuple[int, Tree]:
    animations = document.items("animations")
    if not animations:
        raise FormatError("this glTF has no animation; leave out --animation to encode it as one mesh")
    names = [str(animation.get("name", "")) for animation in animations]
    if wish in names:
        return names.index(wish), animations[names.index(wish)]
    if not wish.isdecimal() and wish:
        raise OptionError(f"no animation {wish}; there are {', '.join(filter(None, names)) or len(names)}")
    number = int(wish or 0)
    if number >= len(animations):
        raise OptionError(f"no animation {number}; there are {len(animations)}, counted from 0")
    return number, animations[number]


def _rate(keys: Doubles) -> float:
    # Keys at even times tell the rate. Sparse ones do not, and then the usual rates are tried.
    rate = rate_of_times(keys)
    if 5 <= rate <= 240:
        return rate
    since = keys - keys[0]
    fits = [rate for rate in LIKELY_RATES if np.abs(since * rate - np.rint(since * rate)).max() < 0.02]
    return float(fits[0]) if fits else USUAL_RATE


def _joined(scene: Scene, document: Document, time: float, limits: Limits) -> shapes.Polygons:
    """The parts of a scene as one mesh."""
    parts, positions = scene.turned(time), scene.at(time)
    ends = np.cumsum([part.points.shape[1] for part in parts])
    used = sorted({part.material for part in parts})
    made = (
        shapes.Part(
            positions[end - part.points.shape[1] : end],
            np.full(len(part.faces), 3),
            part.faces.reshape(-1),
            part.columns,
            np.full(len(part.faces), used.index(part.material)),
            part.name,
        )
        for part, end in zip(parts, ends.tolist())
    )
    counts = [(part.points.shape[1], len(part.faces)) for part in parts]
    whole = shapes.joined_parts(made, counts, limits, document.received)
    metadata: dict[str, Value] = {}
    for name, value in _all_extras(document):
        if name and isinstance(value, str | int | float):
            metadata.setdefault(name, int(value) if isinstance(value, bool) else value)
    # By the specification, always.
    metadata |= {"up": "y", "unit": "meters"}
    colors = scene.colors(time)
    columns = (*whole.columns, *([_color(colors, "color", [])] if len(colors) else []))
    shades = (conventions.shares_of(c.values[:, 3:]) for c in columns if c.semantic == "color")
    transparent = any(opacity.size and opacity.min() < 1 for opacity in shades)
    # Only materials that are used come along: libraries of hundreds are common.
    if transparent or any(number >= 0 for number in used):
        words, images = _materials(document, used, transparent)
        metadata |= described(words) | images
    absent = {str(image.get("uri", "")): document.why_absent(image) for image in document.items("images")}
    lost = (f"the image {unquote(uri)[:80]} was left out: {why}" for uri, why in absent.items() if why)
    notes = (*whole.notes, *lost)
    return replace(whole, notes=notes, columns=columns, metadata={**metadata, **whole.metadata})


def _all_extras(document: Document) -> Iterator[tuple[str, Any]]:
    """Extras of the scene, of meshes and of the whole file, and its copyright."""
    scene = document.item("scenes", document.tree.get("scene", 0)) if document.items("scenes") else {}
    asset = document.tree["asset"]
    for extras in (entry.get("extras") for entry in (scene, *document.items("meshes"), asset)):
        yield from (extras if isinstance(extras, dict) else {"extras": extras} if extras else {}).items()
    yield from [("copyright", asset["copyright"])] if "copyright" in asset else []


def _materials(document: Document, used: list[int], transparent: bool) -> tuple[dict[int, Material], dict[str, Value]]:
    """Materials by place, in glTF's words, and their images as metadata; what glTF draws opaque says so."""
    words, numbers, images, taken = dict[int, Material](), dict[str, int](), dict[str, Value](), 0
    for place, index in enumerate(used):
        found = words.setdefault(place, {})
        tree = document.item("materials", index) if index >= 0 else {}
        factor = tree.get("pbrMetallicRoughness", {}).get("baseColorFactor", [1.0] * 4)
        if "alphaMode" not in tree and (transparent or factor[3] < 1):
            found["alphaMode"] = "OPAQUE"
        shine = tree.get("extensions", {}).get(STRENGTH, {}).get("emissiveStrength", 1.0)
        found |= {"unlit": 1} if UNLIT in tree.get("extensions", {}) else {}
        for name, value in {**tree, **tree.get("pbrMetallicRoughness", {})}.items():
            if name.endswith("Texture"):
                if (source := document.source_of(value["index"])) is None:
                    continue
                image = document.item("images", source)
                key = str(image.get("bufferView", image.get("uri")))
                if key not in numbers:
                    numbers[key] = len(numbers)
                    called, data = document.image(source)
                    if data is None:
                        continue
                    taken += len(data)
                    document.limits.check_memory(taken, 0, document.received)
                    images[f"image.{numbers[key]}.data"] = data
                    images |= {f"image.{numbers[key]}.name": called} if called else {}
                if f"image.{numbers[key]}.data" in images:
                    sampler = document.item("textures", value["index"]).get("sampler")
                    how = document.item("samplers", sampler) if sampler is not None else {}
                    found |= texture_of(value, how, numbers[key]).in_words(name)
            elif isinstance(value, str | int | float):
                found[name] = int(value) if isinstance(value, bool) else value
            elif isinstance(value, list) and all(isinstance(item, int | float) for item in value):
                found[name] = " ".join(f"{item * (shine if name == 'emissiveFactor' else 1):.6g}" for item in value)
        # The default of glTF is metal, which most other formats do not have. Said here, it survives.
        if index >= 0 and not appearance(found).said:  # others take a material that says nothing for matte
            found["metallicFactor"] = 1.0
    return words, images
