"""Runs inside Blender's Python: python in_blender.py FOLDER; the tests in test_blender.py tell what it must find."""

import json
import sys
import warnings
from pathlib import Path

import bpy
import numpy as np

import bsm
from bsm import MeshError, OptionError
from plugins.blender import extension as addon
from plugins.blender.extension import objects

folder = Path(sys.argv[-1])
found = {}


def seen(moving):
    """The positions that Blender shows of an object."""
    evaluated = moving.evaluated_get(bpy.context.evaluated_depsgraph_get())
    data = evaluated.to_mesh()
    points = np.empty(3 * len(data.vertices), np.float32)
    data.vertices.foreach_get("co", points)
    evaluated.to_mesh_clear()
    return points.reshape(-1, 3)


def all_frames(moving):
    scene, shown = bpy.context.scene, []
    for number in range(scene.frame_start, scene.frame_end + 1):
        scene.frame_set(number)
        shown.append(seen(moving))
    return np.array(shown)


def fresh():
    bpy.ops.wm.read_factory_settings(use_empty=True)


def sequence():
    """Every frame of a stream, scrubbed in Blender; then saved, moved, opened again."""
    fresh()
    decoded, _ = bsm.decode_sequence(folder / "moving.bsm")
    (moving,) = objects.import_file(str(folder / "moving.bsm"))
    scene = bpy.context.scene
    found["exact"] = bool(np.array_equal(all_frames(moving), decoded.astype(np.float32)))
    found["scene"] = [scene.frame_start, scene.frame_end, scene.render.fps / scene.render.fps_base]
    found["uv"] = [layer.name for layer in moving.data.uv_layers]
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "project" / "a.blend"))
    (folder / "bsm_cache" / "moving.pc2").unlink()
    bpy.ops.wm.open_mainfile(filepath=str(folder / "project" / "a.blend"))
    found["restored"] = objects.restore_caches()
    found["cache"] = bpy.data.objects["moving"].modifiers[0].filepath
    found["exact again"] = bool(
        np.array_equal(all_frames(bpy.data.objects["moving"]), decoded.astype(np.float32))
    )


def rig():
    """PC2 and MDD of streams, played on the OBJ that they were made of."""
    fresh()
    given = np.load(folder / "rig.npy")
    bpy.ops.wm.obj_import(filepath=str(folder / "rig.obj"))
    own, scene = bpy.context.object, bpy.context.scene
    scene.frame_start, scene.frame_end, found["rig"] = 1, len(given), []
    for kind in ("PC2", "MDD"):
        cache = own.modifiers.new("cache", "MESH_CACHE")
        cache.cache_format, cache.filepath, cache.frame_start = (
            kind,
            str(folder / f"out.{kind.lower()}"),
            1,
        )
        shown = all_frames(own)
        near = np.abs(shown - given).max() < 0.01 * np.linalg.norm(np.ptp(given[0], axis=0))
        found["rig"] += [list(shown.shape), bool(near)]
        own.modifiers.clear()
    (made,) = objects.import_file(str(folder / "pc2.bsm"))
    turns = {"own": own.rotation_euler, "stream": made.rotation_euler}
    found["axes"] = {
        name: [round(np.degrees(angle)) for angle in turn] for name, turn in turns.items()
    }


def runs():
    """Frames of other faces: objects that take turns, also in a project that has lost their caches."""
    fresh()
    scene, shown = bpy.context.scene, []
    names = [made.name for made in objects.import_file(str(folder / "runs.bsm"))]
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "project" / "runs.blend"))
    for path in (folder / "bsm_cache").glob("runs*"):
        path.unlink()
    bpy.ops.wm.open_mainfile(filepath=str(folder / "project" / "runs.blend"))
    found["runs"] = [names, sorted(objects.restore_caches())]
    scene = bpy.context.scene
    for number in range(scene.frame_start, scene.frame_end + 1):
        scene.frame_set(number)
        (now,) = [object for object in bpy.data.objects if not object.hide_viewport]
        assert not now.hide_render
        shown.append(np.ptp(seen(now), axis=0).tolist())
    found["turns"] = shown


def static():
    """A mesh with attributes and a material, in and out."""
    fresh()
    (made,) = objects.import_file(str(folder / "still.bsm"))
    found["still"] = sorted(
        f"{a.name} {a.data_type} {a.domain}" for a in made.data.attributes if a.name[0] != "."
    )
    found["material"] = [slot.material.name for slot in made.material_slots]
    found["color"] = [
        round(component, 3) for component in shader(made).inputs["Base Color"].default_value
    ]
    objects.export_object(
        str(folder / "still_again.bsm"), made, animation=False, preset="near-lossless"
    )


def shader(made):
    nodes = made.material_slots[0].material.node_tree.nodes
    return next(node for node in nodes if node.type == "BSDF_PRINCIPLED")


def export():
    """An animated object with a modifier and quads; and one whose faces change."""
    fresh()
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end, scene.render.fps = 5, 16, 24
    bpy.ops.mesh.primitive_monkey_add(location=(1, 2, 3))
    monkey = bpy.context.object
    monkey.modifiers.new("smooth", "SUBSURF").levels = 1
    monkey.keyframe_insert("location", frame=5)
    monkey.location = (4, 2, 3)
    monkey.keyframe_insert("location", frame=16)
    found["exported"] = objects.export_object(str(folder / "monkey.bsm"), preset="fine")
    shown = []
    for number in range(5, 17):
        scene.frame_set(number)
        place = np.array(monkey.matrix_world)
        shown.append(seen(monkey).astype(np.float64) @ place[:3, :3].T + place[:3, 3])
    np.save(folder / "monkey.npy", np.array(shown))
    build = monkey.modifiers.new("build", "BUILD")
    build.frame_start, build.frame_duration = 0, 12
    try:
        objects.export_object(str(folder / "x.bsm"), monkey)
    except MeshError as error:
        found["changing"] = str(error)
    bpy.ops.object.delete()
    try:
        objects.export_object(str(folder / "x.bsm"))
    except OptionError as error:
        found["nothing"] = str(error)
    fresh()
    bpy.ops.mesh.primitive_cube_add()
    cube = bpy.context.object
    cube.data.attributes.new("crease", "FLOAT", "EDGE")
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always", bsm.BsmWarning)
        objects.export_object(str(folder / "cube.bsm"), cube, animation=False)
    found["left out"] = [str(note.message) for note in told if note.category is bsm.BsmWarning]


def extension():
    """The extension's operators, menus and handler for files that are dropped."""
    fresh()
    addon.register()
    done = bpy.ops.import_scene.bsm(
        filepath=str(folder / "moving.bsm"), directory=str(folder), files=[{"name": "moving.bsm"}]
    )
    found["operator"] = [list(done), bpy.context.object.name, bpy.context.scene.frame_end]
    done = bpy.ops.export_scene.bsm(filepath=str(folder / "out.bsm"), preset="fine", animation=True)
    found["written"] = [list(done), (folder / "out.bsm").stat().st_size > 100]
    looks = []
    for name, look in (("near", 0.3), ("far", 2.5)):
        bpy.ops.export_scene.bsm(
            filepath=str(folder / f"{name}.bsm"), preset="small", look=look, animation=False
        )
        looks.append((folder / f"{name}.bsm").stat().st_size)
    found["looks"] = looks
    (folder / "broken.bsm").write_bytes((folder / "moving.bsm").read_bytes()[:200])
    try:
        bpy.ops.import_scene.bsm(filepath=str(folder / "broken.bsm"))
    except RuntimeError as error:
        found["broken"] = str(error)
    found["handler"] = bpy.types.FileHandler.bl_rna_get_subclass_py(
        "BSM_FH_import"
    ).bl_file_extensions
    addon.unregister()


sequence()
rig()
runs()
static()
export()
extension()
print("FOUND " + json.dumps(found))
