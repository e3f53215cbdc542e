"""The scene of a glTF: curves, nodes, skins and morph targets, at rest or at any time of an animation."""

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Any
from urllib.parse import unquote

import numpy as np

from bsm.bitstream.errors import FormatError, LimitError, OptionError
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.welding import first_of, group_rows
from bsm.files import conventions, table
from bsm.files.formats import polygons
from bsm.files.formats.appearance import Material, appearance
from bsm.files.formats.metadata import Value, described
from bsm.files.motion.frames import (
    LIKELY_RATES,
    Frames,
    Wanted,
    between,
    painted_like,
    rate_of_times,
)
from bsm.files.parsing import Doubles, Ints, as_format_error, require_counts
from bsm.gltf.coding import (
    INSTANCING,
    MATTE,
    STRENGTH,
    TRIANGLES,
    TRIANGULAR,
    UNLIT,
    Array,
    Tree,
    texture_of,
)
from bsm.gltf.document import MOST_NUMBERS, PER_NUMBER, Document, read_document, triangles_of

PER_INSTANCE = 2000  # bytes of the node of an instance, at most
_REST = {"translation": (0, 0, 0), "rotation": (0, 0, 0, 1), "scale": (1, 1, 1)}
_OF_INSTANCES = tuple(map(str.upper, _REST))


@dataclass(frozen=True, eq=False)
class Keyframes:
    """Values at keys, and how they go on between them."""

    times: Doubles
    values: Doubles
    interpolation: str
    is_rotation: bool = False

    def __post_init__(self) -> None:
        keys = len(self.times)
        if (
            not keys
            or len(self.values) != values_per_key(self.interpolation) * keys
            or (np.diff(self.times) < 0).any()
        ):
            raise FormatError(
                f"a curve has {len(self.values)} values for {keys} keys, or keys out of order"
            )
        if not (np.isfinite(self.times).all() and np.isfinite(self.values).all()):
            raise FormatError("a curve has a number that is not finite")

    def at(self, time: float) -> Doubles:
        """Return the value at a time, shape (c,); before the first key and after the last, that of the key."""
        # Times are single precision in files and double here: a key may lie a little after its frame.
        tolerance = 0.0
        if self.interpolation == "STEP":
            tolerance = 1e-5
        following = int(np.searchsorted(self.times, time + tolerance, side="right"))
        before = max(following - 1, 0)
        after = min(following, len(self.times) - 1)
        span = float(self.times[after] - self.times[before])
        share = 0.0
        if span > 0:
            share = min(max((time - float(self.times[before])) / span, 0.0), 1.0)
        earlier: Doubles = self.values[before]
        if self.interpolation == "CUBICSPLINE":
            value = self._on_spline(before, after, span, share)
        elif self.interpolation == "STEP" or share == 0.0:
            return earlier
        elif self.is_rotation:
            value = _between_rotations(earlier, self.values[after], share)
        else:
            value = earlier + share * (self.values[after] - earlier)
        if not self.is_rotation:
            return value
        # Splines of quaternions leave the unit sphere.
        length = float(np.linalg.norm(value)) or 1.0
        return value / length

    def _on_spline(self, before: int, after: int, span: float, share: float) -> Doubles:
        """Return a value on the Hermite spline of glTF, whose tangents are scaled by the time between keys."""
        keys = self.values.reshape(len(self.times), 3, -1)
        square = share * share
        cube = share * share * share
        value: Doubles = (2 * cube - 3 * square + 1) * keys[before, 1] + (
            3 * square - 2 * cube
        ) * keys[after, 1]
        value += span * (
            (cube - 2 * square + share) * keys[before, 2] + (cube - square) * keys[after, 0]
        )
        return value


def values_per_key(interpolation: str) -> int:
    """Return how many values a curve has for each key: splines have two tangents, too."""
    if interpolation == "CUBICSPLINE":
        return 3
    return 1


def _between_rotations(earlier: Doubles, later: Doubles, share: float) -> Doubles:
    """Return a quaternion between two others, along the shorter arc."""
    cosine = float(earlier @ later)
    # Nearly equal quaternions are mixed linearly: the arc between them divides by a sine that is almost zero.
    if abs(cosine) > 1 - 1e-9:
        nearer = later
        if cosine < 0:
            nearer = -later
        return earlier + share * (nearer - earlier)
    angle = float(np.arccos(abs(cosine)))
    arc: Doubles = (
        np.sin((1 - share) * angle) * earlier + np.sign(cosine) * np.sin(share * angle) * later
    )
    return arc


def matrix_of(translation: Array, rotation: Array, scale: Array) -> Doubles:
    """Return the 4 x 4 matrix of a translation, a quaternion (x, y, z, w) and a scale."""
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
    """Return the nodes of the scene, parents before children, and the parent of each; -1: none."""
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
        node_children = document.item("nodes", node).get("children", [])
        waiting += [(int(child), node) for child in reversed(node_children)]
    return parents


_AT_REST: Curves = MappingProxyType({})


def places_of(
    document: Document, parents: Mapping[int, int], curves: Curves = _AT_REST, time: float = 0.0
) -> dict[int, Doubles]:
    """Return the matrix of each node of the scene."""
    places: dict[int, Doubles] = {}
    for node, parent in parents.items():
        tree = document.item("nodes", node)
        properties: dict[str, Array] = {}
        animated = False
        for name, default in _REST.items():
            if (node, name) in curves:
                properties[name] = curves[node, name].at(time)
                animated = True
            else:
                properties[name] = np.asarray(tree.get(name, default), np.float64).reshape(-1)
        local = matrix_of(**properties)
        # glTF forbids to animate a node that has a matrix. Files that do it mean the properties.
        if "matrix" in tree and not animated:
            local = np.asarray(tree["matrix"], np.float64).reshape(4, 4).T
        places[node] = local
        if parent >= 0:
            places[node] = places[parent] @ local
    return places


def _instance_attributes(node: Tree) -> Tree:
    """Return the accessors that a node has for the instances of its mesh, by their names."""
    attributes: Tree = node.get("extensions", {}).get(INSTANCING, {}).get("attributes", {})
    return attributes


def place_instances(document: Document, limits: Limits) -> None:
    """Give a node whose mesh is drawn in several places a child for each of them."""
    nodes = document.items("nodes")
    count = 0
    for node in list(nodes):
        accessors = {
            name.lower(): i
            for name, i in _instance_attributes(node).items()
            if name in _OF_INSTANCES
        }
        if "mesh" not in node or "skin" in node or not accessors:
            continue
        count += max(map(document.count, accessors.values()))
        # A few bytes of JSON can ask for a million instances, without bytes behind them.
        limits.check_memory(PER_INSTANCE * count, 0, document.received)
        tables = {
            name: document.numbers(index).astype(np.float64) for name, index in accessors.items()
        }
        instances = len(next(iter(tables.values())))
        if any(table.shape != (instances, len(_REST[name])) for name, table in tables.items()):
            raise FormatError(
                "the places of a mesh that is drawn several times are not as many, or of other sizes"
            )
        shared: Tree = {name: node[name] for name in ("name", "weights") if name in node}
        shared["mesh"] = node.pop("mesh")
        children = range(len(nodes), len(nodes) + instances)
        for row in range(instances):
            place = {name: table[row] for name, table in tables.items()}
            nodes.append(shared | place)
        node["children"] = [*node.get("children", []), *children]


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
    columns: tuple[polygons.Column, ...]
    normals: Doubles  # as well, of a scene at rest; of no rows where there are none
    material: int
    name: str

    @property
    def vertices(self) -> int:
        return int(self.points.shape[1])


def _turn_columns(columns: tuple[polygons.Column, ...], order: Ints) -> tuple[polygons.Column, ...]:
    """Return columns whose corners are in another order."""
    turned: list[polygons.Column] = []
    for column in columns:
        if column.indices is not None:
            column = replace(column, indices=column.indices[order])
        turned.append(column)
    return tuple(turned)


class Scene:
    """The visible contents of a document, and one animation of it; None: at rest, with all vertices as they are."""

    def __init__(self, document: Document, animation: Tree | None, limits: Limits) -> None:
        self._document = document
        self._limits = limits
        self._at_rest = animation is None
        self._primitives: dict[tuple[int, int, int], Primitive] = {}
        self._skins: dict[int, Skin] = {}
        place_instances(document, limits)
        self._nodes = document.items("nodes")
        self._parents = parents_of(document)
        self._painted = False
        for primitive in document.primitives():
            if any("COLOR_0" in target for target in primitive.get("targets", [])):
                self._painted = True
        # Exporters often write one table for a whole model, of which each primitive uses a part. Those are cut out.
        self._tables = Counter(str(primitive["attributes"]) for primitive in document.primitives())
        self._check_sizes()
        self.notes: list[str] = []
        self._curves = self._read_curves(animation or {})
        self.parts: list[Primitive] = []
        for node in self._parents:
            self.parts += self._parts(node)
        if not self.parts:
            raise FormatError("this glTF has no triangles in its scene")

    # The same mesh may stand in a thousand places. What all uses take together is bounded before the first is made.
    def _check_sizes(self) -> None:
        """Bound what every use of every primitive takes before anything is allocated; zeros have no bytes."""
        document = self._document
        vertices = numbers = characters = 0
        sizes: dict[object, tuple[int, int, int]] = {}
        skinned_meshes = set[tuple[object, object]]()
        for node in self._parents:
            tree = self._nodes[node]
            if "mesh" not in tree:
                continue
            index = tree["mesh"]
            mesh = document.item("meshes", index)
            characters += len(str(tree.get("name") or mesh.get("name", "")))
            if index not in sizes:  # only once, however many nodes use it
                sizes[index] = self._size(mesh)
            mesh_vertices, attribute_numbers, target_numbers = sizes[index]
            vertices += mesh_vertices
            numbers += attribute_numbers
            # A mesh is made once for each skin; the rest shares its arrays.
            key = (index, tree.get("skin"))
            if key not in skinned_meshes:
                skinned_meshes.add(key)
                numbers += target_numbers
        require_counts(self._limits, vertices=vertices)
        if numbers > MOST_NUMBERS:
            raise LimitError(
                f"the meshes of this glTF have {numbers} numbers; the limit is {MOST_NUMBERS}"
            )
        self._limits.check_memory(
            PER_NUMBER * numbers + 4 * characters, vertices, document.received
        )

    def _size(self, mesh: Tree) -> tuple[int, int, int]:
        """Return the vertices of a mesh, the numbers of its attributes and indices, and those of its targets."""
        count_numbers = self._document.claimed
        vertices = attribute_numbers = target_numbers = 0
        for primitive in mesh["primitives"]:
            vertices += self._rows(primitive)
            attribute_numbers += sum(map(count_numbers, primitive["attributes"].values()))
            if primitive.get("indices") is not None:
                attribute_numbers += count_numbers(primitive["indices"])
            for target in primitive.get("targets", []):
                target_numbers += sum(map(count_numbers, target.values()))
        return vertices, attribute_numbers, target_numbers

    def _rows(self, primitive: Tree) -> int:
        """Return the vertices that a primitive takes: of a shared table only those that it uses, at most."""
        count = self._document.count(primitive["attributes"].get("POSITION", 0))
        if self._shares_table(primitive) and "indices" in primitive:
            return min(count, self._document.count(primitive["indices"]))
        return count

    def _shares_table(self, primitive: Tree) -> bool:
        return self._tables[str(primitive["attributes"])] > 1

    @property
    def vertices(self) -> int:
        return sum(part.vertices for part in self.parts)

    @property
    def work(self) -> float:
        """Nanoseconds that a frame takes, at most."""
        joints = numbers = 0
        for part in self.parts:
            numbers += part.points.size + part.colors.size + part.joints.size + len(part.points)
            if part.skin is not None:
                joints += len(part.skin.joints)
        return 3e4 * (len(self._parents) + len(self.parts)) + 1e3 * joints + 100.0 * numbers

    @property
    def moves(self) -> bool:
        moving_nodes = {node for node, _ in self._curves}
        # A node moves with its parent, and a skinned mesh with any of its joints.
        for node, parent in self._parents.items():  # parents come first
            if parent in moving_nodes:
                moving_nodes.add(node)
        skins = {id(part.skin): part.skin.joints for part in self.parts if part.skin is not None}
        nodes_of_parts = {part.node for part in self.parts}.union(*skins.values())
        return not moving_nodes.isdisjoint(nodes_of_parts)

    @property
    def keys(self) -> Doubles:
        # One table of times often serves a hundred curves.
        # Samplers serve many channels.
        times = {id(curve.times): curve.times for curve in self._curves.values()}
        # Rounded to microseconds, because exporters compute equal times in different ways.
        keys = np.concatenate([np.empty(0), *times.values()])
        return np.unique(np.round(keys, 6))

    def at(self, time: float) -> Doubles:
        """Return the positions of all parts' vertices, one part after the other."""
        tables: list[Doubles] = []
        with np.errstate(over="ignore", invalid="ignore"):  # a later check refuses infinite values
            for _, matrix, points in self._placed(time):
                turned_points = np.einsum("...ij,...j->...i", matrix[..., :3, :3], points)
                tables.append(turned_points + matrix[..., :3, 3])
        return np.concatenate(tables)

    def _placed(self, time: float) -> Iterator[tuple[Primitive, Doubles, Doubles]]:
        """Yield each part with the matrix, or that of each vertex, which places it, and its vertices before that."""
        places = places_of(self._document, self._parents, self._curves, time)
        for part in self.parts:
            points = self._add_targets(part, part.points, time)
            matrix = places[part.node]
            if part.skin is not None:
                # The node of a skinned mesh does not move it; its joints do, as the specification has it.
                bones = np.array([places[joint] for joint in part.skin.joints]) @ part.skin.inverse
                matrix = np.zeros((len(points), 4, 4))
                for joint, weight in zip(part.joints.T, part.weights.T, strict=True):
                    matrix += weight[:, None, None] * bones[joint]
            yield part, matrix, points

    def placed_parts(self, time: float) -> list[Primitive]:
        """Return the parts with their faces as they are placed, which mirrors turn around, and with their normals."""
        placed_parts = []
        for part, matrix, _ in self._placed(time):
            linear = matrix[..., :3, :3]
            columns = part.columns
            if len(part.normals):
                normals = self._add_targets(part, part.normals, time)
                values = polygons.compact(polygons.turned_normals(normals, linear))
                columns = (polygons.Column("normal", values, semantic="normal"), *columns)
            # A mirrored node shows the other side of its faces, so their corners are exchanged.
            sides = np.broadcast_to(np.linalg.det(linear), part.vertices)
            mirrored = np.count_nonzero(sides[part.faces] < 0, axis=1) > 1  # of three
            corners = np.arange(part.faces.size).reshape(-1, 3)
            corners = np.where(mirrored[:, None], corners[:, ::-1], corners)
            faces = part.faces.reshape(-1)[corners]
            columns = _turn_columns(columns, corners.reshape(-1))
            placed_parts.append(replace(part, faces=faces, columns=columns))
        return placed_parts

    def colors(self, time: float) -> Doubles:
        """Return the colors of all parts' vertices, white where a part has none; none if no target changes any."""
        if not self._painted:
            return np.zeros((0, 4))
        tables = [self._add_targets(part, part.colors, time) for part in self.parts]
        colors: Doubles = np.clip(np.concatenate(tables), 0.0, 1.0)
        return colors

    def _add_targets(self, part: Primitive, tables: Doubles, time: float) -> Doubles:
        """Return the first table, and of each of the others as much as its target has weight."""
        targets = tables[1:]
        base: Doubles = tables[0]
        if not len(targets):
            return base
        curve = self._curves.get((part.node, "weights"))
        if curve is not None:
            weights = curve.at(time)
        else:
            node = self._nodes[part.node]
            mesh = self._document.item("meshes", node["mesh"])
            default_weights = mesh.get("weights", [0.0] * len(targets))
            weights = np.asarray(node.get("weights", default_weights), np.float64).reshape(
                len(targets)
            )
        # Of hundreds of targets, a face uses a handful at a time.
        used = np.flatnonzero(weights)
        return base + np.asarray(np.tensordot(weights[used], targets[used], 1))

    def _read_curves(self, animation: Tree) -> Curves:
        document = self._document
        curves: dict[tuple[int, str], Keyframes] = {}
        numbers = 0
        samplers = animation.get("samplers", [])
        tables: dict[int, tuple[Doubles, Doubles]] = {}
        for channel in animation.get("channels", []):
            node, path = channel["target"].get("node"), channel["target"]["path"]
            # Extensions animate materials and visibility, which a mesh has not.
            if node is None or path not in (*_REST, "weights"):
                self.notes.append(f"channels of {str(path)[:40]} were left out")
                continue
            index = channel["sampler"]
            sampler = samplers[index]
            if index not in tables:
                numbers += document.claimed(sampler["input"]) + document.claimed(sampler["output"])
                self._limits.check_memory(PER_NUMBER * numbers, 0, document.received)
                tables[index] = (
                    document.numbers(sampler["input"])[:, 0].astype(np.float64),
                    document.numbers(sampler["output"]).astype(np.float64),
                )
            times, values = tables[index]
            interpolation = sampler.get("interpolation", "LINEAR")
            if path == "weights":
                values = values.reshape(values_per_key(interpolation) * len(times), -1)
                mesh = document.item("meshes", document.item("nodes", node).get("mesh"))
                width = len(mesh["primitives"][0].get("targets", []))
            else:
                width = len(_REST[path])
            if values.shape[1] != width:
                raise FormatError(
                    f"the {path} of node {node} is animated by {values.shape[1]} numbers, not {width}"
                )
            curves[int(node), path] = Keyframes(times, values, interpolation, path == "rotation")
        return curves

    def _parts(self, node: int) -> list[Primitive]:
        tree = self._nodes[node]
        if "mesh" not in tree:
            return []
        mesh = self._document.item("meshes", tree["mesh"])
        skin, skin_number = None, -1
        if "skin" in tree:
            skin, skin_number = self._skin(tree["skin"]), int(tree["skin"])
        name = str(tree.get("name") or mesh.get("name") or "")
        parts = []
        for number, primitive in enumerate(mesh["primitives"]):
            mode = primitive.get("mode", TRIANGLES)
            if mode not in TRIANGULAR or "POSITION" not in primitive["attributes"]:
                self.notes.append(_NO_SURFACES)
                continue
            # A forest has a thousand trees of one mesh, which is made once.
            key = (tree["mesh"], number, skin_number)
            if key in self._primitives:
                part = replace(self._primitives[key], node=node, name=name)
            else:
                part = self._part(node, primitive, skin, name)
            self._primitives[key] = part
            parts.append(part)
        return parts

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
            numbers = self._document.claimed(skin["inverseBindMatrices"])
            self._limits.check_memory(PER_NUMBER * numbers, 0, self._document.received)
            inverse = self._document.numbers(skin["inverseBindMatrices"]).astype(np.float64)
        if inverse.shape[0] < len(joints) or inverse.shape[1] != 16:
            raise FormatError(f"skin {index} has {len(inverse)} matrices for {len(joints)} joints")
        self._skins[index] = Skin(
            joints, inverse[: len(joints)].reshape(-1, 4, 4).transpose(0, 2, 1).copy()
        )
        return self._skins[index]

    def _part(self, node: int, primitive: Tree, skin: Skin | None, name: str) -> Primitive:
        document = self._document
        accessors = primitive["attributes"]
        count = document.count(accessors["POSITION"])
        holders = (accessors, *primitive.get("targets", []))
        points = np.array(
            [self._table(holder.get("POSITION"), count, 3, "positions") for holder in holders]
        )
        colors = np.zeros((0, count, 4))
        if self._painted:
            # White, to which targets add nothing.
            shades = [self._color_table(accessors.get("COLOR_0"), count, 1.0)]
            shades += [
                self._color_table(target.get("COLOR_0"), count, 0.0) for target in holders[1:]
            ]
            colors = np.array(shades)
            accessors = {
                semantic: index for semantic, index in accessors.items() if semantic != "COLOR_0"
            }
        faces = triangles_of(document, primitive, count)
        joints, weights = np.zeros((count, 0), np.int64), np.zeros((count, 0))
        if skin is not None:
            joints, weights = self._joints_and_weights(
                accessors, count, f"node {node}", len(skin.joints)
            )
        columns = self._columns(accessors, count)
        normals = np.zeros((0, count, 3))
        rows: Any = slice(None)
        if not self._at_rest:
            corners = faces.reshape(-1)
            columns = tuple(replace(column, domain="corner", indices=corners) for column in columns)
            # For sequences, vertices that are equal in everything that moves them are one. At rest the encoder does
            # that itself.
            origin = group_rows(np.column_stack([*points, joints, weights, *colors]))
            rows = first_of(origin)
            faces = origin[faces].astype(np.int64)
        elif "NORMAL" in accessors:
            normals = np.array(
                [self._table(holder.get("NORMAL"), count, 3, "normals") for holder in holders]
            )
        if self._at_rest and self._shares_table(primitive):
            rows, faces = np.unique(faces, return_inverse=True)
            columns = tuple(replace(column, values=column.values[rows]) for column in columns)
            faces = faces.reshape(-1, 3)
        material = int(primitive.get("material", -1))
        # Our own files have this material where a mesh has none, since viewers draw glTF without one as black metal.
        if document.items("materials")[material : material + 1] == [MATTE]:
            material = -1
        return Primitive(
            node,
            points[:, rows],
            colors[:, rows],
            faces,
            skin,
            joints[rows],
            weights[rows],
            columns,
            normals[:, rows],
            material,
            name,
        )

    def _joints_and_weights(
        self, accessors: Tree, count: int, owner: str, most: int
    ) -> tuple[Ints, Doubles]:
        """Return the joints of each vertex, all sets side by side, and their weights, whose sum is 1."""
        joint_sets: list[Doubles] = []
        weight_sets: list[Doubles] = []
        for number in range(len(accessors)):
            joints_name, weights_name = f"JOINTS_{number}", f"WEIGHTS_{number}"
            if joints_name in accessors and weights_name in accessors:
                joint_sets.append(self._table(accessors[joints_name], count, 4, "joints"))
                weight_sets.append(self._table(accessors[weights_name], count, 4, "weights"))
        if not joint_sets:
            raise FormatError(f"the mesh of {owner} has a skin, and its vertices name no joints")
        joints = np.hstack(joint_sets).astype(np.int64)
        weights = np.hstack(weight_sets)
        if joints.size and joints.max() >= most:
            raise FormatError(f"a vertex of {owner} depends on joint {joints.max()} of {most}")
        # Weights of integers often sum to 254 or 256 of 255.
        total = weights.sum(axis=1, keepdims=True)
        return joints, np.divide(weights, total, out=np.zeros_like(weights), where=total > 0)

    def _table(self, index: object, count: int, width: int, name: str) -> Doubles:
        """Return an accessor for each vertex; zeros where there is none."""
        if index is None:
            return np.zeros((count, width))
        values = self._document.numbers(index).astype(np.float64)
        if values.shape != (count, width):
            raise FormatError(f"{name} of {values.shape} numbers for {count} vertices")
        return values

    def _color_table(self, index: object, count: int, default: float) -> Doubles:
        """Return colors as red, green, blue and opacity."""
        colors = np.full((count, 4), default)
        if index is not None:
            values = self._document.numbers(index)
            if len(values) != count or values.shape[1] not in (3, 4):
                raise FormatError(f"COLOR_0 has {values.shape} numbers for {count} vertices")
            colors[:, : values.shape[1]] = values
        return colors

    def _columns(self, accessors: Tree, count: int) -> tuple[polygons.Column, ...]:
        columns: list[polygons.Column] = []
        # In the order of the file, but sets of a kind by their numbers: TEXCOORD_1 may come before TEXCOORD_0.
        kinds = [name.partition("_")[0] for name in accessors]

        def place(name: str) -> tuple[int, str]:
            kind = name.partition("_")[0]
            if not kind:
                return kinds.index(kind), ""
            return kinds.index(kind), name

        names = [name for name in accessors if name.startswith(("TEXCOORD_", "COLOR_", "_"))]
        for name in sorted(names, key=place):
            kind, _, number = name.partition("_")  # sets are counted by their order
            values: Any = self._document.numbers(accessors[name], unscaled=kind == "COLOR")
            if len(values) != count or values.shape[1] > 4:
                raise FormatError(f"{name} has {values.shape} numbers for {count} vertices")
            suffix = number
            if number == "0":
                suffix = ""
            if kind == "COLOR":
                columns.append(_color_column(values, f"color{suffix}", self.notes))
            elif kind == "TEXCOORD":
                coordinates = values.astype(np.float64)
                # glTF counts from the top, we from the bottom.
                coordinates[:, 1] = 1 - coordinates[:, 1]
                compact = polygons.compact(coordinates)
                columns.append(polygons.Column(f"texcoord{suffix}", compact, "vertex", "texcoord"))
            else:
                meaning = polygons.meaning_of(number, values.shape[1])
                columns.append(polygons.Column(number, polygons.compact(values), "vertex", meaning))
        return tuple(columns)


def _color_column(values: Array, name: str, notes: list[str]) -> polygons.Column:
    """Return colors, which are linear in glTF, as sRGB; numbers above 1 mean nothing as colors and stay as they are."""
    # Such numbers are data under the name of a color. To clip them would lose them.
    if values.dtype.kind == "f" and values.size and not 0 <= values.min() <= values.max() <= 1:
        notes.append(
            f"parts whose {name} has values above 1, kept as linear numbers and not as a color"
        )
        return polygons.Column(name, polygons.compact(values))
    return polygons.Column(name, conventions.srgb_colors(values), semantic="color")


# --------------------------------------------------------------------------------------------------------------- frames


USUAL_RATE = 30.0
_NO_SURFACES = "points and lines were left out"


def read_gltf_mesh(document: Document) -> polygons.MeshFile:
    """Read a scene at rest as one mesh: vertices and faces in the order of the file."""
    # A later check refuses infinite values.
    with as_format_error("glTF"), np.errstate(all="ignore"):
        # At rest all vertices come back as they are; of an animation only those that move apart.
        scene = Scene(document, None, document.limits)
        document.limits.check_work(3 * scene.work, scene.vertices, document.received)
        joined = _joined(scene, document, 0.0, document.limits)
        counts = Counter(scene.notes)
        without_surface = counts.pop(_NO_SURFACES, 0)
        notes = [*joined.notes, *(f"{note}: {count}" for note, count in counts.items())]
        notes += map(polygons.compression_note, document.compressed)
        dropped = _unread(document, at_rest=True)
        if without_surface:
            dropped = (*dropped, f"points and lines ({without_surface})")
        joined = replace(joined, notes=tuple(notes), dropped=dropped)
        return joined.checked(document.limits, document.received)


def _unread(document: Document, *, at_rest: bool) -> tuple[str, ...]:
    """Return notes on data of a document that a mesh cannot hold."""
    tree, nodes = document.tree, document.items("nodes")
    notes: list[str] = []
    if at_rest and tree.get("animations"):
        notes.append("animations (--animation encodes one)")
    if at_rest and tree.get("skins"):
        notes.append("skins")
    if at_rest and any(primitive.get("targets") for primitive in document.primitives()):
        notes.append("morph targets")
    skin_names: tuple[str, ...] = ()
    if tree.get("skins"):
        skin_names = ("JOINTS_", "WEIGHTS_")
    notes += [name for name in document.unread if not name.startswith(skin_names)]
    nodes_placed = parents_of(document)
    if any("mesh" in node for number, node in enumerate(nodes) if number not in nodes_placed):
        if len(document.items("scenes")) > 1:
            notes.append("other scenes")
        else:
            notes.append("nodes outside of the scene")
    for name, value in _all_extras(document):
        if not isinstance(value, str | int | float):
            notes.append(f"extras ({name})")
    for node in nodes:
        names = _instance_attributes(node)
        notes += [
            f"{name} of instances" for name in names if "skin" in node or name not in _OF_INSTANCES
        ]
    return tuple(dict.fromkeys(notes))


@as_format_error("glTF")
@np.errstate(over="ignore", invalid="ignore")  # a later check refuses infinite values
def read_gltf(path: str, request: Wanted, limits: Limits = DEFAULT_LIMITS) -> Frames:
    document = read_document(path, limits)
    number, animation = _choose_animation(document, request.animation)
    scene = Scene(document, animation, limits)
    if not scene.moves:
        scene_notes = "".join(f" ({note})" for note in dict.fromkeys(scene.notes))
        raise FormatError(
            f"animation {number} of this glTF moves nothing that is read{scene_notes}; leave out --animation for the "
            "mesh"
        )
    # The first key is the first frame: animations often begin late on the time line.
    keys = scene.keys
    rate = request.rate or _rate(keys)
    # The little more keeps the last frame, whose time may be rounded down.
    count = int(np.floor((keys[-1] - keys[0]) * rate + 1e-3)) + 1
    require_counts(limits, frames=count)
    # A short file can ask for a million frames of a large mesh.
    limits.check_work(scene.work * count, scene.vertices * count, document.received)
    times = (keys[0] + np.arange(count) / rate).tolist()
    first_frame = _joined(scene, document, times[0], limits).checked(limits)

    notes = [f"animation {animation.get('name') or number}, {count} frames at {rate:g} per second"]
    notes += [*scene.notes, *first_frame.notes]
    remaining = len(document.items("animations")) - 1
    if remaining == 1:
        notes.append("1 other animation was left out")
    elif remaining:
        notes.append(f"{remaining} other animations were left out")
    if any("NORMAL" in primitive["attributes"] for primitive in document.primitives()):
        notes.append("left out, for they move: normals")
    unread = _unread(document, at_rest=False)
    if unread:
        notes.append(f"left out: {', '.join(unread)}")
    notes += between("key times", (keys - keys[0]) * rate, rate)
    written_times = table.FORMATS["glb"].times
    metadata = {
        name: value
        for name, value in first_frame.mesh.metadata.items()
        if name not in written_times
    }
    if keys[0]:
        metadata[table.START] = round(float(keys[0]) * rate, 3)
    mesh = replace(first_frame.mesh, metadata=metadata)
    meshes = None
    if len(scene.colors(0.0)):
        meshes = (painted_like(mesh, _painted(scene, mesh, time)) for time in times)
    frames = map(scene.at, times)
    distinct_notes = tuple(dict.fromkeys(notes))
    return Frames(
        mesh.faces, count, frames, mesh.attributes, distinct_notes, rate, mesh.metadata, meshes
    )


def _painted(scene: Scene, mesh: TriangleMesh, time: float) -> TriangleMesh:
    """Return the mesh at a time, with its colors then."""
    colors = _color_column(scene.colors(time), "color", []).values
    attributes: list[Attribute] = []
    for attribute in mesh.attributes:
        if (attribute.name, attribute.domain) == ("color", "vertex"):
            attribute = replace(attribute, values=colors)
        attributes.append(attribute)
    return replace(mesh, positions=scene.at(time), attributes=tuple(attributes))


def _choose_animation(document: Document, choice: str) -> tuple[int, Tree]:
    """Return the animation of a name or a number, which is counted from 0, and its number."""
    animations = document.items("animations")
    if not animations:
        raise FormatError(
            "this glTF has no animation; leave out --animation to encode it as one mesh"
        )
    names = [str(animation.get("name", "")) for animation in animations]
    if choice in names:
        number = names.index(choice)
        return number, animations[number]
    if choice and not choice.isdecimal():
        there_are = f"there are {len(names)} without names, 0 is the first"
        quoted = ", ".join(map(repr, filter(None, names)))
        if quoted:
            there_are = f"the names are {quoted}"
        raise OptionError(f"no animation {choice!r}; {there_are}")
    number = int(choice or 0)
    if number >= len(animations):
        raise OptionError(f"no animation {number}; there are {len(animations)}, counted from 0")
    return number, animations[number]


def _rate(keys: Doubles) -> float:
    # Keys at even times tell the rate. Sparse ones do not, and then the usual rates are tried.
    rate = rate_of_times(keys)
    if 5 <= rate <= 240:
        return rate
    for likely_rate in LIKELY_RATES:
        frames = (keys - keys[0]) * likely_rate
        if np.abs(frames - np.rint(frames)).max() < 0.02:
            return float(likely_rate)
    return USUAL_RATE


def _joined(scene: Scene, document: Document, time: float, limits: Limits) -> polygons.Polygons:
    """Return the parts of a scene as one mesh."""
    parts = scene.placed_parts(time)
    positions = scene.at(time)
    materials = sorted({part.material for part in parts})

    def placed_polygons() -> Iterator[polygons.Part]:
        begin = 0
        for part in parts:
            end = begin + part.vertices
            sizes = np.full(len(part.faces), 3)
            numbers = np.full(len(part.faces), materials.index(part.material))
            corners = part.faces.reshape(-1)
            yield polygons.Part(
                positions[begin:end], sizes, corners, part.columns, numbers, part.name
            )
            begin = end

    counts = [(part.vertices, len(part.faces)) for part in parts]
    joined = polygons.joined_parts(placed_polygons(), counts, limits, document.received)
    columns = joined.columns
    colors = scene.colors(time)
    if len(colors):
        columns = (*columns, _color_column(colors, "color", []))
    metadata = _metadata_of_extras(document)
    # By the specification, always.
    metadata |= {"up": "y", "unit": "meters"}
    opacities = [conventions.shares_of(c.values[:, 3:]) for c in columns if c.semantic == "color"]
    transparent = any(opacity.size and opacity.min() < 1 for opacity in opacities)
    # Only materials that are used come along: libraries of hundreds are common.
    if transparent or any(number >= 0 for number in materials):
        words, images = _Materials(document).read(materials, transparent)
        metadata |= described(words) | images
    reasons = {
        str(image.get("uri", "")): document.why_absent(image) for image in document.items("images")
    }
    notes = list(joined.notes)
    for uri, reason in reasons.items():
        if reason:
            notes.append(f"the image {unquote(uri)[:80]} was left out: {reason}")
    return replace(
        joined, notes=tuple(notes), columns=columns, metadata={**metadata, **joined.metadata}
    )


def _metadata_of_extras(document: Document) -> dict[str, Value]:
    """Return the extras that are one text or number, the first of each name."""
    metadata: dict[str, Value] = {}
    for name, value in _all_extras(document):
        if not name or not isinstance(value, str | int | float):
            continue
        if isinstance(value, bool):
            value = int(value)
        metadata.setdefault(name, value)
    return metadata


def _all_extras(document: Document) -> Iterator[tuple[str, Any]]:
    """Yield the extras of the scene, of meshes and of the whole file, and its copyright."""
    scene: Tree = {}
    if document.items("scenes"):
        scene = document.item("scenes", document.tree.get("scene", 0))
    asset = document.tree["asset"]
    for entry in (scene, *document.items("meshes"), asset):
        extras = entry.get("extras")
        if isinstance(extras, dict):
            yield from extras.items()
        elif extras:
            yield "extras", extras
    if "copyright" in asset:
        yield "copyright", asset["copyright"]


class _Materials:
    """The materials of a document in glTF's words, and their images as metadata."""

    def __init__(self, document: Document) -> None:
        self._document = document
        self._numbers: dict[str, int] = {}  # of images, by the places of their bytes
        self._images: dict[str, Value] = {}
        self._image_bytes = 0

    def read(
        self, materials: list[int], transparent: bool
    ) -> tuple[dict[int, Material], dict[str, Value]]:
        """Return materials by place; what glTF draws opaque says so, where some colors are transparent."""
        words: dict[int, Material] = {}
        for place, index in enumerate(materials):
            tree: Tree = {}
            if index >= 0:
                tree = self._document.item("materials", index)
            words[place] = self._words(tree, transparent)
            # The default of glTF is metal, which most other formats do not have. Said here, it survives: others take a
            # material that says nothing for matte.
            if index >= 0 and not appearance(words[place]).stated:
                words[place]["metallicFactor"] = 1.0
        return words, self._images

    def _words(self, tree: Tree, transparent: bool) -> Material:
        words: Material = {}
        surface = tree.get("pbrMetallicRoughness", {})
        extensions = tree.get("extensions", {})
        opacity = surface.get("baseColorFactor", [1.0] * 4)[3]
        if "alphaMode" not in tree and (transparent or opacity < 1):
            words["alphaMode"] = "OPAQUE"
        strength = extensions.get(STRENGTH, {}).get("emissiveStrength", 1.0)
        if UNLIT in extensions:
            words["unlit"] = 1
        for name, value in {**tree, **surface}.items():
            if name.endswith("Texture"):
                words |= self._texture_words(name, value)
            elif isinstance(value, bool):
                words[name] = int(value)
            elif isinstance(value, str | int | float):
                words[name] = value
            elif isinstance(value, list) and all(isinstance(item, int | float) for item in value):
                factor = 1
                if name == "emissiveFactor":
                    factor = strength
                words[name] = " ".join(f"{item * factor:.6g}" for item in value)
        return words

    def _texture_words(self, name: str, info: Tree) -> Material:
        """Return the words for a texture; none where its image is absent."""
        source = self._document.source_of(info["index"])
        if source is None:
            return {}
        image = self._document.item("images", source)
        key = str(image.get("bufferView", image.get("uri")))
        if key not in self._numbers:
            self._numbers[key] = len(self._numbers)
            self._take_image(source, self._numbers[key])
        if f"image.{self._numbers[key]}.data" not in self._images:
            return {}
        sampler: Tree = {}
        sampler_index = self._document.item("textures", info["index"]).get("sampler")
        if sampler_index is not None:
            sampler = self._document.item("samplers", sampler_index)
        return texture_of(info, sampler, self._numbers[key]).in_words(name)

    def _take_image(self, source: int, number: int) -> None:
        """Add the bytes and the name of an image to the metadata, if they are there."""
        name, data = self._document.image(source)
        if data is None:
            return
        self._image_bytes += len(data)
        self._document.limits.check_memory(self._image_bytes, 0, self._document.received)
        self._images[f"image.{number}.data"] = data
        if name:
            self._images[f"image.{number}.name"] = name
