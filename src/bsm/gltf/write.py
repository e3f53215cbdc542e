"""Meshes and sequences as GLB: one mesh; frames as morph targets, which play wherever glTF does; a whole stream."""

import io
import re
import tempfile
from collections import Counter
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import IO, Any

import numpy as np

from bsm.bitstream.errors import LimitError, MeshError, UnsupportedError
from bsm.codec.arrays import Faces, Positions
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import Metadata, TriangleMesh
from bsm.codec.geometry.metrics import face_normals
from bsm.codec.geometry.welding import split_with_origin
from bsm.files import conventions
from bsm.files.formats import metadata as formats
from bsm.files.formats.appearance import (
    Material,
    Texture,
    appearance,
    as_numbers,
    held_by,
    in_gltf,
    lost,
    within,
)
from bsm.files.formats.polygons import unit_rows
from bsm.files.motion.frames import USUAL_RATE, FrameWriter, Shared
from bsm.files.parsing import NO_DOUBLES, Doubles, Ints, single_suffices
from bsm.files.stream import SequenceStream
from bsm.gltf.coding import (
    COMPONENTS,
    EXTENSION,
    FLOAT,
    MATTE,
    STRENGTH,
    UINT,
    UNLIT,
    Array,
    Tree,
    drawn,
    words_of,
)
from bsm.gltf.document import WEBP, Growing, bounds_of, mime_of

MOST_FRAMES = 2048
"""Viewers keep targets as the layers of one texture, of which graphics cards have 2,048, and some old ones 256."""
# Single precision tells times of frames apart up to there, at any usual rate.
_LATEST = 1 << 14  # number of a frame whose time is exact enough in single precision
_SORTING = ("part", "material")  # attributes of faces that only sort these
_HALF = 0.5**0.5
_TURNS = {"x": [0.0, 0.0, _HALF, _HALF], "z": [-_HALF, 0.0, 0.0, _HALF]}
"""The rotations from the axis that a mesh calls up to that of glTF."""


class _Scene(Growing):
    """A scene that grows."""

    def __init__(self, file: IO[bytes]) -> None:
        super().__init__(file)
        self._images: dict[bytes, int] = {}
        self.left_out: tuple[str, ...] = ()

    def numbers(self, values: Array, *, bounds: bool = False, shares: bool = False) -> int:
        more: Tree = {}
        if shares and values.dtype.kind == "u":
            more["normalized"] = True
        if bounds:
            more |= bounds_of(values)
        rows, width = values.shape
        return self.accessor(COMPONENTS[values.dtype.name], rows, width, self.table(values), **more)

    # A weight of one at its own frame and zero elsewhere: a table of T x T numbers, nearly all of them zero. Sparse, it
    # takes bytes in proportion to T.
    def ones(self, places: Ints, count: int) -> int:
        """Add an accessor of zeros, with ones at some places: the bytes grow with the places only."""
        index_view = self.view(places.astype(np.uint32).tobytes())
        value_view = self.view(np.ones(len(places), np.float32).tobytes())
        indices = {"bufferView": index_view, "componentType": UINT}
        sparse = {"count": len(places), "indices": indices, "values": {"bufferView": value_view}}
        return self.accessor(FLOAT, count, 1, sparse=sparse)

    def place(self, mesh: Tree, **more: Any) -> None:
        node = self.add("nodes", {"mesh": self.add("meshes", mesh), **more})
        self.tree["scenes"][0]["nodes"].append(node)

    def write(self, file: IO[bytes]) -> None:
        self.tree["buffers"] = [{"byteLength": self.size}, *self.tree.get("buffers", [])]
        super().write(file)

    def show(self, mesh: TriangleMesh, stem: str) -> None:
        """Place a mesh; its `primitives` come with the vertices of the mesh that theirs are."""
        origin = np.zeros(3)
        if not single_suffices(mesh.positions):
            origin = np.rint(mesh.positions.mean(axis=0))
        # Nodes have double precision, in which they place meshes that lie far away.
        if origin.any():
            mesh = replace(mesh, positions=mesh.positions - origin)
        if not single_suffices(mesh.positions):
            raise MeshError(NO_DOUBLES.format("GLB"))
        # glTF has one index for all attributes of a vertex.
        split, vertex_origins = split_with_origin(mesh)
        material, part = (
            formats.face_numbers(split, "material"),
            formats.face_numbers(split, "part"),
        )
        sorting: list[Array] = []
        for numbers in (part, material):
            if numbers is None:
                sorting.append(np.zeros(len(split.faces), np.int64))
            else:
                sorting.append(numbers.values)
        # A primitive has one material and a node one name, so faces are sorted by both.
        kinds, kind_of_face = np.unique(np.column_stack(sorting), axis=0, return_inverse=True)
        arrays, vertex_attributes = _at_vertices(split)
        node, expressed = placed_node(mesh.metadata, origin)
        names = formats.names_in(mesh.metadata, "part")
        written = {*expressed, "part.names", *(f"part.{number}.name" for number in names)}
        self._sets = sum(name.startswith("TEXCOORD_") for name in arrays)
        materials = self._materials(mesh.metadata, kinds[:, 1].tolist(), written)
        self._blend_opacity(
            vertex_attributes, {materials[number] for number in kinds[:, 1].tolist()}
        )
        self.primitives: list[tuple[Tree, Ints]] = []
        node_names: set[str] = set()
        for place, (part_number, material_number) in enumerate(kinds.tolist()):
            vertices, corners = np.unique(
                split.faces[kind_of_face.reshape(-1) == place], return_inverse=True
            )
            accessors: Tree = {}
            for name, values in arrays.items():
                is_color = name.startswith("COLOR_")
                accessors[name] = self.numbers(
                    values[vertices], bounds=name == "POSITION", shares=is_color
                )
            primitive: Tree = {"attributes": accessors}
            primitive["indices"] = self.numbers(corners.reshape(-1, 1).astype(np.uint32))
            primitive["material"] = materials[material_number]
            name_of_part: object = names.get(part_number)
            if not name_of_part and len(kinds) == 1:
                name_of_part = mesh.metadata.get("name")
            node_name = _unused_name(str(name_of_part or stem), node_names)
            node_names.add(node_name)
            self.place({"name": node_name, "primitives": [primitive]}, name=node_name, **node)
            self.primitives.append((primitive, vertex_origins[vertices]))
        rest = {name: value for name, value in mesh.metadata.items() if name not in written}
        extras = {
            name: value
            for name, value in rest.items()
            if isinstance(value, str) or as_numbers(value)
        }
        if extras:
            self.tree["scenes"][0]["extras"] = extras
        # Extras come back, but no other program looks for a material there.
        in_extras = [name for name in extras if name.startswith("material.")]
        lost = [name for name in rest if name not in extras]
        self.left_out += formats.left_out(
            mesh, [*vertex_attributes, material, part], lost, in_extras
        )

    def _materials(
        self, metadata: Metadata, numbers: list[int], written: set[str]
    ) -> dict[int, int]:
        """Add the materials of a mesh and, for faces without one, a matte one; return their places by number."""
        images = formats.images_in(metadata)
        materials: dict[int, int] = {}
        for number, words in formats.materials_in(metadata).items():
            place = self._material(number, words, images, written)
            if place is not None:
                materials[number] = place
        # The default material of glTF is white metal, which reflects a black room: viewers draw it black.
        bare_numbers = [number for number in numbers if number not in materials]
        if bare_numbers:
            materials |= dict.fromkeys(bare_numbers, self.add("materials", dict(MATTE)))
        return materials

    def _blend_opacity(self, attributes: list[Attribute], materials: set[int]) -> None:
        """Let materials show the opacity of vertices, which viewers ignore otherwise."""
        color = next((attribute for attribute in attributes if attribute.semantic == "color"), None)
        if color is None or color.components < 4 or not len(color.values):
            return
        if conventions.shares_of(color.values[:, 3:]).min() < 1:
            for place in materials:
                self.tree["materials"][place].setdefault("alphaMode", "BLEND")

    def _material(
        self,
        number: int,
        words: Material,
        images: Mapping[int, tuple[str, bytes]],
        written: set[str],
    ) -> int | None:
        """Add a material; None if glTF can express nothing of it. `written` gets the names of expressed properties."""
        look, _ = within(appearance(words))
        material: Tree = {}
        surface: Tree = {}
        extensions: Tree = {}
        extensions_used: set[str] = set()
        absent: list[Texture] = []
        gltf_words = in_gltf(look)
        if gltf_words.pop("unlit", False):
            extensions[UNLIT] = {}
        for name, value in gltf_words.items():
            if isinstance(value, Texture):
                texture = value
                if texture.set >= self._sets:
                    texture = replace(texture, set=0)
                info, sampler = words_of(texture)
                index = self._texture(*images.get(value.image, ("", b"")), sampler)
                if index is None:
                    absent.append(value)
                    continue
                written |= {f"image.{value.image}.data", f"image.{value.image}.name"}
                extensions_used |= info.get("extensions", {}).keys()
                value = {"index": index, **info}
            elif name == "emissiveFactor" and max(value) > 1:
                # Factors of glTF end at 1; brighter ones need this extension.
                strength = max(value)
                extensions[STRENGTH] = {"emissiveStrength": strength}
                value = [share / strength for share in value]
            if name.startswith(("baseColor", "metallic", "roughness")):
                surface[name] = value
            else:
                material[name] = value
        if surface:
            material["pbrMetallicRoughness"] = surface
        if extensions:
            material["extensions"] = extensions
        for extension in sorted(extensions_used | extensions.keys()):
            self.use(extension, required=False)
        fields = {
            name for name in held_by("glTF") if getattr(look, name.partition(".")[0]) not in absent
        }
        for name, value in vars(look).items():
            if isinstance(value, Texture) and value.set >= self._sets:
                fields.discard(f"{name}.set")
        written |= {f"material.{number}.{name}" for name in words.keys() - {*lost(words, fields)}}
        if not material:
            return None
        return self.add("materials", material)

    def _texture(self, name: str, data: bytes, sampler: Tree) -> int | None:
        kind = mime_of(data)
        # glTF and its extension for WebP allow no others, and viewers would show nothing.
        if kind not in ("image/png", "image/jpeg", "image/webp"):
            return None
        # Materials often share an image, and it should be in the file once.
        if data not in self._images:
            image: Tree = {"bufferView": self.view(data), "mimeType": kind}
            if name:
                image["name"] = name
            self._images[data] = self.add("images", image)
        texture: Tree = {"source": self._images[data]}
        if kind == "image/webp":
            texture = {"extensions": {WEBP: texture}}
            self.use(WEBP, required=True)
        if sampler:
            texture["sampler"] = self.add("samplers", sampler)
        return self.add("textures", texture)


def _unused_name(name: str, taken_names: set[str]) -> str:
    """Return a name that no node has: programs rename nodes of equal names, each in its own way."""
    number = 0
    unused_name = name
    while unused_name in taken_names:
        number += 1
        unused_name = f"{name}_{number}"
    return unused_name


def placed_node(metadata: Metadata, origin: Doubles | None = None) -> tuple[Tree, frozenset[str]]:
    """Return the properties of a node that holds a mesh around an origin, and the metadata that they express."""
    placement = conventions.placement(metadata, "glb")
    node: Tree = {}
    rotation = _TURNS.get(str(metadata.get("up")).lower())
    if rotation:
        node["rotation"] = rotation
    if origin is not None and origin.any():
        node["translation"] = (placement.matrix @ origin).tolist()
    if placement.scale != 1.0:
        node["scale"] = [placement.scale] * 3
    return node, placement.expressed


def write_glb(mesh: TriangleMesh, stem: str) -> formats.Written:
    scene = _Scene(io.BytesIO())
    scene.show(mesh, stem)
    return formats.Written(scene.glb(), scene.left_out)


def _at_vertices(mesh: TriangleMesh) -> tuple[dict[str, Array], list[Attribute]]:
    """Return the arrays that glTF has of each vertex, by its names, and the attributes that these are."""
    arrays: dict[str, Array] = {"POSITION": mesh.positions.astype(np.float32)}
    vertex_attributes: list[Attribute] = []
    counts: Counter[str] = Counter()
    for attribute in mesh.attributes:
        values, width = attribute.values, attribute.components
        if attribute.domain != "vertex":
            continue
        name = _NAMES.get((attribute.semantic, width), "")
        if name == "NORMAL":
            values = unit_rows(values.astype(np.float64), _UP).astype(np.float32)
            if name in arrays:
                name = ""
        elif name == "TEXCOORD":  # glTF counts from the top, we from the bottom
            # This turns the picture over; the image itself stays as it is.
            values = np.column_stack([values[:, 0], 1 - values[:, 1]]).astype(np.float32)
        elif name == "COLOR":
            values = conventions.linear_colors(values)
        elif (
            re.fullmatch(r"color\d?", attribute.name)
            and width in (3, 4)
            and values.dtype == np.float32
        ):
            name = "COLOR"  # above 1, as glTF had them
        if name in ("TEXCOORD", "COLOR"):
            number = counts[name]
            counts[name] += 1
            name = f"{name}_{number}"
        if not name:
            name = f"_{attribute.name}"
            values = attribute.values.astype(np.float32)
            # Custom attributes may be floats of 32 bits only. One that would be rounded is left out, and a note names
            # it.
            if not (values == attribute.values).all():
                continue
        arrays[name] = values
        vertex_attributes.append(attribute)
    return arrays, vertex_attributes


_UP = (0.0, 0.0, 1.0)  # a normal where there is none
_NAMES = {("normal", 3): "NORMAL", ("texcoord", 2): "TEXCOORD", ("texcoord", 3): "TEXCOORD"}
_NAMES |= {("color", width): "COLOR" for width in (3, 4)}


# -------------------------------------------------------------------------------------------------------------- frames


@contextmanager
def write_frames(file: IO[bytes], path: str, first: Faces, shared: Shared) -> Iterator[FrameWriter]:
    """Write a GLB in which each frame is a morph target; where faces change, meshes take turns, by their scale."""
    with tempfile.TemporaryFile() as spool:
        moving = _Moving(spool)

        def write(frame: Positions, faces: Faces | None = None) -> None:
            # The first frame is the mesh, and all others are differences from it.
            if not moving.frames:
                moving.begin(shared.mesh(frame, first), Path(path).stem)
            elif faces is not None:
                moving.begin(shared.mesh(frame, faces), f"{Path(path).stem}_{moving.frames:05d}")
            else:
                moving.add_frame(shared.mesh(frame, moving.faces, with_metadata=False))
            moved = shared.moved(anew=faces is not None)
            shared.loses(
                f"how {attribute.name} changes"
                for attribute in moved
                if attribute is not moving.painted
            )

        yield write
        shared.loses(moving.left_out)
        codes = np.array([shared.code(number) for number in range(moving.frames)])
        # Time codes that are too large for single precision begin at zero instead.
        if not 0 <= codes[0] <= codes[-1] < _LATEST:
            codes -= codes[0]
            shared.loses(["the number of the first frame"])
        moving.animate(codes / (shared.frame_rate or USUAL_RATE))
        moving.write(file)


@dataclass(frozen=True, eq=False)
class _Run:
    """Frames that share their faces: the first of them, and the nodes and primitives that show it."""

    begun: int
    first: tuple[Array, ...]
    nodes: range
    primitives: list[tuple[Tree, Ints]]


class _Moving(_Scene):
    """The first frame of each run, and the additions of other frames."""

    def __init__(self, file: IO[bytes]) -> None:
        super().__init__(file)
        self.frames, self._runs = 0, list[_Run]()
        self.painted: Attribute | None = None  # of the last frame

    def begin(self, first: TriangleMesh, stem: str) -> None:
        normals = vertex_normals(first.positions, first.faces)
        attributes = [attribute for attribute in first.attributes if attribute.semantic != "normal"]
        normal = Attribute("normal", normals.astype(np.float32), "vertex", "normal")
        begin = len(self.tree.get("nodes", ()))
        self.show(replace(first, attributes=(*attributes, normal)), stem)
        for primitive, _ in self.primitives:
            primitive["targets"] = []
        nodes = range(begin, len(self.tree["nodes"]))
        first_arrays = (first.positions, normals, *self._painted(first))
        self._runs.append(_Run(self.frames, first_arrays, nodes, self.primitives))
        self.faces = first.faces
        self.frames += 1

    def _painted(self, mesh: TriangleMesh) -> list[Array]:
        self.painted = formats.shown_at_vertices(mesh)[1]
        if self.painted is None:
            return []
        shares = conventions.shares_of(self.painted.values)
        return [conventions.to_linear(shares)]

    def add_frame(self, mesh: TriangleMesh) -> None:
        run = self._runs[-1]
        # Refused rather than written: most viewers would show nothing, or crash.
        if self.frames - run.begun == MOST_FRAMES:
            raise LimitError(
                f"a GLB holds each frame as a morph target, of which viewers take {MOST_FRAMES}; "
                "take fewer with --frames A:B, or write USD"
            )
        arrays = (mesh.positions, vertex_normals(mesh.positions, self.faces), *self._painted(mesh))
        with np.errstate(over="ignore"):
            deltas = [
                (values - first).astype(np.float32)
                for values, first in zip(arrays, run.first, strict=True)
            ]
        # JSON has no infinity, and the bounds of an accessor are JSON.
        if not all(np.isfinite(delta).all() for delta in deltas):
            raise MeshError(f"frame {self.frames} is beyond single precision, which GLB has")
        self.frames += 1
        for primitive, rows in run.primitives:
            target: Tree = {}
            for name, delta in zip(("POSITION", "NORMAL", "COLOR_0"), deltas, strict=False):
                if name != "COLOR_0" or delta.any():
                    target[name] = self.numbers(delta[rows], bounds=True)
            primitive["targets"].append(target)

    def animate(self, frame_times: Doubles) -> None:
        """Show each frame from its time on, in seconds, shape (T,)."""
        samplers: list[Tree] = []
        channels: list[Tree] = []

        def move(nodes: range, path: str, frames: Array, values: int, interpolation: str) -> None:
            keys = self.numbers(frame_times[frames].astype(np.float32)[:, None], bounds=True)
            place = len(samplers)
            channels.extend(
                {"sampler": place, "target": {"node": node, "path": path}} for node in nodes
            )
            samplers.append({"input": keys, "output": values, "interpolation": interpolation})

        ends = [*(run.begun for run in self._runs[1:]), self.frames]
        for run, end in zip(self._runs, ends, strict=True):
            count = end - run.begun - 1
            self._complete_colors(run)
            if count:
                weights = self.ones(count + np.arange(count) * (count + 1), (count + 1) * count)
                move(run.nodes, "weights", np.arange(run.begun, end), weights, "LINEAR")
                for node in run.nodes:
                    # Viewers that play no animation show the first frame.
                    self.tree["meshes"][self.tree["nodes"][node]["mesh"]]["weights"] = [0.0] * count
            if len(self._runs) > 1:
                # glTF cannot hide a node. A scale of zero does, and every viewer plays it.
                frames, visibility = [run.begun], [1]
                if run.begun > 0:
                    frames, visibility = [0, *frames], [0, *visibility]
                if end < self.frames:
                    frames, visibility = [*frames, end], [*visibility, 0]
                scale = np.array(self.tree["nodes"][run.nodes[0]].get("scale", [1.0] * 3))
                scales = np.array(visibility)[:, None] * scale
                move(
                    run.nodes,
                    "scale",
                    np.array(frames),
                    self.numbers(scales.astype(np.float32)),
                    "STEP",
                )
        if channels:
            self.add("animations", {"name": "frames", "samplers": samplers, "channels": channels})

    def _complete_colors(self, run: _Run) -> None:
        """Give colors to all targets of a primitive if one has them: they must have the same attributes."""
        for primitive, rows in run.primitives:
            if any("COLOR_0" in target for target in primitive["targets"]):
                # An accessor without bytes is zero everywhere.
                zeros = self.accessor(FLOAT, len(rows), run.first[2].shape[1])
                primitive["targets"] = [
                    {"COLOR_0": zeros} | target for target in primitive["targets"]
                ]


def vertex_normals(positions: Positions, faces: Faces) -> Doubles:
    """The mean of the normals of a vertex' faces, shape (n, 3); a vertex without any looks up."""
    normals = face_normals(positions, faces)
    sums = [
        np.bincount(faces.reshape(-1), np.repeat(axis, 3), minlength=len(positions))
        for axis in normals.T
    ]
    return unit_rows(np.column_stack(sums), _UP)


# ------------------------------------------------------------------------------------------------------------ a stream


def moving_scene(stream: bytes) -> bytes:
    """A .glb whose one mesh shows the frames of a stream, which is in it as it is (`spec/EXT_bsm_compression.md`)."""
    sequence = SequenceStream(iter([stream]))
    _, positions = next(sequence.changing_frames())
    # Those that sort faces are lost in one primitive; others would be lost without a word, and are refused.
    attributes = tuple(
        a for a in sequence.attributes if a.domain != "face" or a.name not in _SORTING
    )
    for attribute in attributes:
        if attribute.domain == "face":
            raise UnsupportedError(f"glTF has no place for {attribute.name}, which faces have")
    shape = drawn(TriangleMesh(positions, sequence.faces, attributes, {}))
    kinds = {"POSITION": (FLOAT, 3), "NORMAL": (FLOAT, 3)}
    for semantic, names in (("texcoord", ("TEXCOORD_0", "TEXCOORD_1")), ("color", ("COLOR_0",))):
        widths = [
            attribute.components for attribute in attributes if attribute.semantic == semantic
        ]
        kinds |= {name: (FLOAT, width) for name, width in zip(names, widths, strict=False)}
    kinds["indices"] = (UINT, 1)
    scene = _Scene(io.BytesIO())
    source = scene.view(stream)
    places: dict[str, int] = {}
    largest = 0
    for name, (component, width) in kinds.items():
        count = len(shape.arrays["POSITION"])
        if name == "indices":
            count = len(shape.index)
        size = 4 * width * count
        largest = max(largest, size)
        view: Tree = {
            "buffer": 1,
            "byteLength": size,
            "extensions": {EXTENSION: {"stream": source, "attribute": name}},
        }
        places[name] = scene.accessor(component, count, width, scene.add("bufferViews", view))
    scene.tree["accessors"][0] |= bounds_of(positions.astype(np.float32))
    # Filled by decoders from the stream, frame after frame, so it is as large as the largest array only.
    scene.add("buffers", {"byteLength": largest, "extensions": {EXTENSION: {"fallback": True}}})
    metadata: Metadata = sequence.metadata
    node: dict[str, str] = {}
    if "name" in metadata:
        node["name"] = str(metadata["name"])
    primitive = {"indices": places.pop("indices"), "attributes": places}
    mesh = {"primitives": [primitive], "extensions": {EXTENSION: {"stream": source}}}
    scene.place(mesh, **node, **placed_node(metadata)[0])
    scene.use(EXTENSION, required=True)
    return scene.glb()
