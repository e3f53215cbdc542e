"""Meshes and sequences in Blender, by its module `bpy`."""

import math
import os
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import chain, groupby
from pathlib import Path
from typing import Any

import bpy
import numpy as np

from bsm.api import encode
from bsm.bitstream.errors import MeshError, OptionError
from bsm.codec.arrays import Faces, Positions
from bsm.codec.geometry.attributes import Attribute, Domain, Semantic
from bsm.codec.geometry.mesh import Metadata, TriangleMesh
from bsm.encoding.given import Wishes, given_frames
from bsm.files.conventions import shares_of
from bsm.files.formats.appearance import Appearance, appearance
from bsm.files.formats.metadata import images_in, kind_of_image, materials_in
from bsm.files.formats.polygons import Array, unused_name
from bsm.files.inspection import inspect_stream
from bsm.files.libraries import warn
from bsm.files.motion.caches import write_cache
from bsm.files.motion.frames import Frames
from bsm.files.output import open_output
from bsm.files.pipes import read_chunks
from bsm.files.stream import SequenceStream, decode_whole, peek_header
from bsm.ground.lengths import metres, unit_of

_DOMAINS = {"vertex": "POINT", "corner": "CORNER", "face": "FACE"}
_TYPES = {
    1: ("FLOAT", "value"),
    2: ("FLOAT2", "vector"),
    3: ("FLOAT_VECTOR", "vector"),
    4: ("FLOAT_COLOR", "color"),
}
_WIDTHS = {
    "FLOAT": 1,
    "INT": 1,
    "INT8": 1,
    "BOOLEAN": 1,
    "FLOAT2": 2,
    "FLOAT_VECTOR": 3,
    "FLOAT_COLOR": 4,
}
_OWN = ("position", "sharp_face", "material_index", "custom_normal")


def data_of(mesh: TriangleMesh, name: str) -> Any:
    made = bpy.data.meshes.new(name)
    made.vertices.add(len(mesh.positions))
    made.vertices.foreach_set("co", mesh.positions.astype(np.float32).reshape(-1))
    made.loops.add(3 * len(mesh.faces))
    made.loops.foreach_set("vertex_index", mesh.faces.reshape(-1))
    made.polygons.add(len(mesh.faces))
    made.polygons.foreach_set("loop_start", np.arange(0, 3 * len(mesh.faces), 3, dtype=np.int32))
    made.update(calc_edges=True)
    made.shade_smooth()
    for attribute in mesh.attributes:
        _add(made, attribute)
    known = materials_in(mesh.metadata)
    for number in range(max(known) + 1 if known else 0):
        made.materials.append(_material(appearance(known.get(number, {})), mesh.metadata, number))
    return made


def _add(made: Any, attribute: Attribute) -> None:
    values = (
        attribute.values
        if attribute.indices is None
        else attribute.values[attribute.indices.reshape(-1)]
    )
    domain, width = _DOMAINS[attribute.domain], attribute.components
    if (
        attribute.name == "material"
        and domain == "FACE"
        and width == 1
        and values.dtype.kind in "iu"
    ):
        made.polygons.foreach_set("material_index", np.maximum(values[:, 0], 0).astype(np.int32))
        return
    if attribute.semantic == "normal" and width == 3 and domain != "FACE":
        split = (
            made.normals_split_custom_set_from_vertices
            if domain == "POINT"
            else made.normals_split_custom_set
        )
        split(values.astype(np.float64).tolist())
        return
    if attribute.semantic == "texcoord" and width == 2 and domain != "FACE":
        corners = np.empty(len(made.loops), np.int32)
        made.loops.foreach_get("vertex_index", corners)
        at_corners = values if domain == "CORNER" else values[corners]
        layer = made.uv_layers.new(name=attribute.name)
        layer.uv.foreach_set("vector", np.ascontiguousarray(at_corners, np.float32).reshape(-1))
        return
    if attribute.semantic == "color" and width >= 3:
        _add_color(made, attribute.name, values, domain)
        return
    whole = width == 1 and values.dtype.kind in "iu" and values.dtype != np.uint32
    kind, field = ("INT", "value") if whole else _TYPES[width]
    table = np.ascontiguousarray(values, np.int32 if whole else np.float32).reshape(-1)
    made.attributes.new(attribute.name, kind, domain).data.foreach_set(field, table)


def _add_color(made: Any, name: str, values: Array, domain: str) -> None:
    table = np.ones((len(values), 4), np.float32)
    table[:, : values.shape[1]] = shares_of(values)
    kind = "BYTE_COLOR" if values.dtype == np.uint8 else "FLOAT_COLOR"
    layer = made.attributes.new(name, kind, domain)
    layer.data.foreach_set("color_srgb" if kind == "BYTE_COLOR" else "color", table.reshape(-1))
    if domain != "FACE":
        made.color_attributes.active_color_name = layer.name
        made.color_attributes.render_color_index = made.color_attributes.find(layer.name)


def _material(look: Appearance, metadata: Metadata, number: int) -> Any:
    made = bpy.data.materials.new(look.name or f"material {number}")
    made.use_nodes = True
    shader = next(node for node in made.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    if look.says("color") or look.says("opacity"):
        shader.inputs["Base Color"].default_value = (*look.color, 1.0)
        shader.inputs["Alpha"].default_value = look.opacity
    for name in ("metallic", "roughness"):
        if look.says(name):
            shader.inputs[name.capitalize()].default_value = getattr(look, name)
    data = images_in(metadata).get(
        look.color_texture.image if look.color_texture else -1, ("", b"")
    )[1]
    if kind := kind_of_image(data):
        node = made.node_tree.nodes.new("ShaderNodeTexImage")
        name = f"{made.name}.{kind}"
        # Packed into the project, from the bytes of its file.
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, name.replace(os.sep, "_"))
            path.write_bytes(data)
            node.image = bpy.data.images.load(str(path))
            node.image.pack()
        node.image.filepath = f"//{name}"
        made.node_tree.links.new(node.outputs["Color"], shader.inputs["Base Color"])
    return made


def triangles_of(data: Any) -> tuple[Faces, Array]:
    """The triangles of a mesh of Blender's, polygons cut by it: vertices and corners, each of shape (m, 3)."""
    data.calc_loop_triangles()
    count = len(data.loop_triangles)
    vertices, corners = np.empty(3 * count, np.int32), np.empty(3 * count, np.int32)
    data.loop_triangles.foreach_get("vertices", vertices)
    data.loop_triangles.foreach_get("loops", corners)
    return vertices.reshape(-1, 3), corners.reshape(-1, 3)


def attributes_of(data: Any, corners: Array) -> tuple[Attribute, ...]:
    """Return the attributes of a Blender mesh: texture coordinates, colors, numbers, and the materials of faces."""
    found: dict[str, Attribute] = {}
    left: list[str] = []
    owner = np.empty(len(corners), np.int32)
    data.loop_triangles.foreach_get("polygon_index", owner)
    for layer in data.attributes:
        kind = "FLOAT_COLOR" if layer.data_type == "BYTE_COLOR" else layer.data_type
        if layer.name in _OWN or layer.name.startswith(".") or layer.is_internal:
            continue
        if kind not in _WIDTHS or layer.domain == "EDGE":
            left.append(layer.name)
            continue
        values, semantic = _values(layer, kind)
        domain: Domain = {"POINT": "vertex", "CORNER": "corner", "FACE": "face"}[layer.domain]  # type: ignore[assignment]
        name = unused_name(layer.name, domain, found)
        indices = corners if domain == "corner" else None
        found[name] = Attribute(
            name, values[owner] if domain == "face" else values, domain, semantic, indices
        )
    slots = np.empty(len(data.polygons), np.int32)
    data.polygons.foreach_get("material_index", slots)
    if slots.any() and "material" not in found:
        found["material"] = Attribute("material", slots[owner], "face")
    if left:
        warn([f"left out: {', '.join(left)}"])
    return tuple(found.values())


def _values(layer: Any, kind: str) -> tuple[Array, Semantic]:
    width, count = _WIDTHS[kind], len(layer.data)
    if layer.data_type == "BYTE_COLOR":
        table = np.empty(4 * count, np.float32)
        layer.data.foreach_get("color_srgb", table)
        return np.rint(table.reshape(-1, 4) * 255).astype(np.uint8), "color"
    whole = kind in ("INT", "INT8", "BOOLEAN")
    table = np.empty(width * count, np.int32 if whole else np.float32)
    layer.data.foreach_get({1: "value", 4: "color"}.get(width, "vector"), table)
    values = table.reshape(-1, width)
    if width == 4:
        in_range = count and values.min() >= 0 and values.max() <= 1
        return values, "color" if in_range else "generic"
    return values, "texcoord" if width == 2 and layer.domain == "CORNER" else "generic"


def materials_of(slots: Any) -> dict[str, str | int | float | bytes]:
    """The metadata of an object's materials: names, colors, and the images of base colors."""
    found: dict[str, str | int | float | bytes] = {}
    images = 0
    for number, slot in enumerate(slots):
        material = slot.material
        if material is None:
            continue
        found[f"material.{number}.name"] = material.name
        nodes = material.node_tree.nodes if material.use_nodes and material.node_tree else ()
        shader = next((node for node in nodes if node.type == "BSDF_PRINCIPLED"), None)
        if shader is None:
            continue
        color = [*shader.inputs["Base Color"].default_value][:3]
        found[f"material.{number}.baseColorFactor"] = " ".join(
            f"{component:.6g}" for component in (*color, 1.0)
        )
        for name, socket in (("metallicFactor", "Metallic"), ("roughnessFactor", "Roughness")):
            found[f"material.{number}.{name}"] = float(shader.inputs[socket].default_value)
        shown = [
            socket.name for socket in shader.inputs if socket.links and socket.name != "Base Color"
        ]
        links = shader.inputs["Base Color"].links
        image = (
            links[0].from_node.image if links and links[0].from_node.type == "TEX_IMAGE" else None
        )
        packed = bytes(image.packed_file.data) if image is not None and image.packed_file else b""
        shown += ["Base Color"] if links and not kind_of_image(packed) else []
        if shown:
            warn(
                [
                    f"material {material.name}: left out, only packed images of colors are kept: {', '.join(shown)}"
                ]
            )
        if kind_of_image(packed):
            found[f"material.{number}.baseColorTexture"] = images
            found[f"image.{images}.data"] = packed
            images += 1
    return found


# ------------------------------------------------------------------------------------------------------------------- in


# Of an object, what it plays, or the object that has it: a project keeps it, packed or moved.
STREAM = "bsm_stream"
RUN = "bsm_run"  # the run that it plays
MOST_STREAM_BYTES = 1 << 28
_MODIFIER = "BSM"
Progress = Callable[[int, int], None]


def import_file(
    path: str,
    *,
    frame_start: int | None = None,
    set_scene: bool = True,
    up: str = "",
    progress: Progress | None = None,
) -> list[Any]:
    """Import a stream; the objects, selected, the first active; `up` ("y", "z") is its axis, where it says none."""
    header, chunks = peek_header(read_chunks(path))
    name = Path(path).stem
    if header is None or not header.gop_frames:
        found = [_placed(name, decode_whole(chunks), up)]
    else:
        found = _sequence(name, b"".join(chunks), path, frame_start, set_scene, up, progress)
    for other in bpy.context.selected_objects:
        other.select_set(False)
    for made in found:
        bpy.context.collection.objects.link(made)
        made.select_set(True)
    bpy.context.view_layer.objects.active = found[0]
    return found


def _placed(name: str, mesh: TriangleMesh, up: str) -> Any:
    """Return an object with its metadata, turned upright if its y axis points up, and as large as its unit says."""
    made = bpy.data.objects.new(name, data_of(mesh, name))
    if str(mesh.metadata.get("up", up)).lower() == "y":
        made.rotation_euler = (math.pi / 2, 0.0, 0.0)
    size = metres(unit_of(mesh.metadata)) or bpy.context.scene.unit_settings.scale_length
    made.scale = 3 * (size / bpy.context.scene.unit_settings.scale_length,)
    for key, value in mesh.metadata.items():
        if not isinstance(value, bytes) and not key.startswith(("material.", "image.", "part.")):
            made[key] = value
    return made


def _sequence(
    name: str,
    data: bytes,
    source: str,
    frame_start: int | None,
    set_scene: bool,
    up: str,
    progress: Progress | None,
) -> list[Any]:
    """An object for each run of frames that share their faces, seen while it plays."""
    found: list[tuple[Any, int, int]] = []
    known = inspect_stream(iter([data])).metadata.get("frame_start")
    if frame_start is None:
        frame_start = round(known) if isinstance(known, int | float) and abs(known) < 1e6 else 1
    for begun, mesh, frames, count in _runs(data):
        made = _placed(name if not found else f"{name}_{begun:05d}", mesh, up)
        path = _cache_path(made.name, source)
        count = _write(path, mesh.positions, frames, count, progress)
        made[RUN] = len(found)
        cache = made.modifiers.new(_MODIFIER, "MESH_CACHE")
        cache.cache_format, cache.filepath = "PC2", _relative(path)
        cache.frame_start = frame_start + begun
        found.append((made, begun, begun + count))
    for made, begun, end in found if len(found) > 1 else ():
        for hidden, at in ((True, begun - 1), (False, begun), (True, end))[
            begun == 0 : 2 + (end < found[-1][2])
        ]:
            for switch in ("hide_viewport", "hide_render"):
                setattr(made, switch, hidden)
                made.keyframe_insert(switch, frame=frame_start + at)
    if len(data) <= MOST_STREAM_BYTES:
        found[0][0][STREAM] = data
    for made, *_ in found[1:]:
        made[STREAM] = found[0][0]
    scene = bpy.context.scene
    if set_scene:
        rate = mesh.metadata.get("frame_rate")
        if isinstance(rate, int | float) and 0 < rate < 1e6:
            scene.render.fps = max(1, round(rate))
            scene.render.fps_base = scene.render.fps / rate
        scene.frame_start, scene.frame_end = frame_start, frame_start + found[-1][2] - 1
        scene.frame_set(frame_start)
    return [made for made, *_ in found]


def _runs(data: bytes) -> Iterator[tuple[int, TriangleMesh, Iterator[tuple[int, Positions]], int]]:
    """The number of the first frame of each run, that as a mesh, other frames, and how many, if that is known."""
    stream = SequenceStream(iter([data]))
    count = stream.header.frames if len(inspect_stream(iter([data])).runs) == 1 else 0
    for _, frames in groupby(stream.changing_frames(), lambda _: len(stream.run_starts)):
        begun, first = next(frames)
        mesh = TriangleMesh(first, stream.faces, stream.attributes, stream.metadata)
        yield begun, mesh, frames, count  # noqa: B031


def _write(
    path: str,
    first: Positions,
    others: Iterator[tuple[int, Positions]],
    count: int,
    progress: Progress | None,
) -> int:
    """A PC2 of all frames; how many there are. The stream need not say that beforehand."""
    if not count:
        frames = [first, *(frame for _, frame in others)]
        count, others = len(frames), enumerate(frames[1:], 1)
    Path(path).parent.mkdir(parents=True, exist_ok=True)

    def every() -> Iterator[Positions]:
        for number, frame in chain([(0, first)], others):
            yield frame
            if progress:
                progress(number + 1, count)

    with open_output(path, overwrite=True) as file:
        write_cache(file, "pc2", range(count), every())
    return count


def _cache_path(name: str, source: str) -> str:
    """Beside the project if it is saved, else beside the stream, else among temporary files."""
    file = f"{bpy.path.clean_name(name)}.pc2"
    folder = os.path.dirname(bpy.data.filepath or os.path.abspath(source))
    beside = bpy.data.filepath or (source and os.access(folder, os.W_OK))
    return os.path.join(folder if beside else tempfile.gettempdir(), "bsm_cache", file)


def _relative(path: str) -> str:
    return str(bpy.path.relpath(path)) if bpy.data.filepath else path


def restore_caches() -> list[str]:
    """Write caches that are not there any more from the streams in the project; the names of their objects."""
    restored = []
    for moving in bpy.data.objects:
        cache, data = moving.modifiers.get(_MODIFIER), moving.get(STREAM)
        if cache is None or cache.type != "MESH_CACHE" or data is None:
            continue
        if os.path.isfile(bpy.path.abspath(cache.filepath)):
            continue
        data = bytes(data.get(STREAM, b"") if isinstance(data, bpy.types.Object) else data)
        path = _cache_path(moving.name, "")
        for run, (_, mesh, frames, count) in enumerate(_runs(data)):
            if run == moving.get(RUN, 0):
                _write(path, mesh.positions, frames, count, None)
        cache.filepath = _relative(path)
        restored.append(moving.name)
    return restored


# ------------------------------------------------------------------------------------------------------------------ out


def export_object(
    path: str,
    moving: Any = None,
    *,
    animation: bool = True,
    progress: Progress | None = None,
    **keywords: Any,
) -> dict[str, int]:
    """Write an object to a stream; how many frames, vertices, faces and bytes that are."""
    moving = moving or bpy.context.view_layer.objects.active
    if moving is None:
        raise OptionError("no object is active: select the one to export")
    scene = bpy.context.scene
    before = scene.frame_current
    numbers = (
        range(scene.frame_start, scene.frame_end + 1) if animation else range(before, before + 1)
    )
    metadata: dict[str, Any] = {
        "name": moving.name,
        "up": "z",
        **materials_of(moving.material_slots),
    }
    if scene.unit_settings.system != "NONE" and abs(scene.unit_settings.scale_length - 1.0) < 1e-6:
        metadata["unit"] = "meters"
    try:
        scene.frame_set(numbers[0])
        with _evaluated(moving) as (data, place):
            faces, corners = triangles_of(data)
            if not len(faces):
                raise MeshError(f"{moving.name} has no faces")
            attributes, first = attributes_of(data, corners), _points(data, place)
        if not animation:
            written = [
                encode(TriangleMesh(first, faces, attributes), metadata=metadata, **keywords)
            ]
        else:
            rate = scene.render.fps / scene.render.fps_base
            frames = _frames(scene, moving, numbers, progress)
            source = Frames(
                faces, len(numbers), frames, tuple(attributes), frame_rate=rate, metadata=metadata
            )
            shown = TriangleMesh(first, faces)
            written = given_frames(source, Wishes(keywords=keywords), shown).chunks(None)  # type: ignore[assignment]
        with open_output(path, overwrite=True) as file:
            size = sum(map(file.write, written))
    finally:
        scene.frame_set(before)
    return {"frames": len(numbers), "vertices": len(first), "faces": len(faces), "bytes": size}


def _frames(
    scene: Any, moving: Any, numbers: range, progress: Progress | None
) -> Iterator[Positions]:
    known: tuple[int, ...] = ()
    for done, number in enumerate(numbers, 1):
        scene.frame_set(number)
        with _evaluated(moving) as (data, place):
            # How polygons are cut into triangles may change when they bend; that is not another mesh.
            sizes = len(data.vertices), len(data.loops), len(data.polygons)
            known = known or sizes
            if sizes != known:
                raise MeshError(
                    f"{moving.name} has {sizes[0]} vertices and {sizes[2]} faces in frame {number} of the scene, and "
                    f"{known[0]} and {known[2]} in frame {numbers[0]}: the faces of a sequence stay"
                )
            points = _points(data, place)
        yield points
        if progress:
            progress(done, len(numbers))


def _points(data: Any, place: Any) -> Positions:
    points = np.empty(3 * len(data.vertices), np.float32)
    data.vertices.foreach_get("co", points)
    matrix = np.array(place, np.float64)
    found: Positions = points.reshape(-1, 3).astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
    return found


@contextmanager
def _evaluated(moving: Any) -> Iterator[tuple[Any, Any]]:
    found = moving.evaluated_get(bpy.context.evaluated_depsgraph_get())
    try:
        data = found.to_mesh()
    except RuntimeError as error:
        raise MeshError(f"{found.name} has no surface: {error}") from error
    try:
        yield data, found.matrix_world
    finally:
        found.to_mesh_clear()
