"""Makes the moving files of this folder in Blender (`pip install bpy==5.0.1`), and what Blender itself shows of them.

python make.py FOLDER
"""

import math
import sys

import bpy
import numpy as np

FRAMES = range(1, 26)


def fresh():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.fps, scene.frame_start, scene.frame_end = 24, FRAMES[0], FRAMES[-1]
    return scene


def column():
    bpy.ops.mesh.primitive_cylinder_add(vertices=10, depth=4, radius=0.5, location=(0, 0, 2), end_fill_type="TRIFAN")
    made = bpy.context.object
    bpy.ops.object.transform_apply(location=True)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.subdivide(number_cuts=1)
    bpy.ops.mesh.quads_convert_to_tris()
    bpy.ops.uv.smart_project()
    bpy.ops.object.mode_set(mode="OBJECT")
    return made


def shown(scene, moving):
    frames = []
    for number in FRAMES:
        scene.frame_set(number)
        evaluated = moving.evaluated_get(bpy.context.evaluated_depsgraph_get())
        mesh = evaluated.to_mesh()
        points = np.empty(3 * len(mesh.vertices), np.float32)
        mesh.vertices.foreach_get("co", points)
        place = np.array(evaluated.matrix_world)
        frames.append(points.reshape(-1, 3).astype(np.float64) @ place[:3, :3].T + place[:3, 3])
        evaluated.to_mesh_clear()
    return np.array(frames, np.float32)


def save(folder, name, scene, moving):
    np.savez_compressed(f"{folder}/{name}.npz", positions=shown(scene, moving))
    bpy.ops.export_scene.gltf(
        filepath=f"{folder}/{name}.glb", export_format="GLB", export_force_sampling=True, export_frame_range=True
    )
    bpy.ops.wm.usd_export(
        filepath=f"{folder}/{name}.usdc",
        export_animation=True,
        export_armatures=False,
        export_shapekeys=False,
        export_materials=False,
        export_normals=False,
    )


def skinned(folder):
    scene, moving = fresh(), column()
    bpy.ops.object.armature_add(location=(0, 0, 0))
    armature = bpy.context.object
    bpy.ops.object.mode_set(mode="EDIT")
    lower = armature.data.edit_bones[0]
    lower.tail = (0, 0, 2)
    upper = armature.data.edit_bones.new("upper")
    upper.head, upper.tail, upper.parent, upper.use_connect = (0, 0, 2), (0, 0, 4), lower, True
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.ops.object.select_all(action="DESELECT")
    moving.select_set(True)
    armature.select_set(True)
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.parent_set(type="ARMATURE_AUTO")
    bone = armature.pose.bones["upper"]
    bone.rotation_mode = "XYZ"
    for number, angle in ((1, 0.0), (13, 1.2), (25, -0.4)):
        bone.rotation_euler = (angle, 0.2 * angle, 0)
        bone.keyframe_insert("rotation_euler", frame=number)
    for number, place in ((1, (0, 0, 0)), (25, (1, 2, 0))):
        armature.location = place
        armature.keyframe_insert("location", frame=number)
    save(folder, "skinned", scene, moving)


def morphing(folder):
    scene, moving = fresh(), column()
    moving.shape_key_add(name="Basis")
    fat, wave = moving.shape_key_add(name="fat"), moving.shape_key_add(name="wave")
    for number, vertex in enumerate(moving.data.vertices):
        x, y, z = vertex.co
        fat.data[number].co = (1.5 * x, 1.5 * y, 1.5 * z)
        wave.data[number].co = (x + 0.5 * math.sin(3 * z), y, z)
    for number, weight in ((1, 0.0), (9, 1.0), (25, 0.3)):
        fat.value, wave.value = weight, 1 - weight
        fat.keyframe_insert("value", frame=number)
        wave.keyframe_insert("value", frame=number)
    save(folder, "morphing", scene, moving)


def dressed(name, color=None, image=None, **inputs):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    surface = made.node_tree.nodes["Principled BSDF"]
    if color is not None:
        inputs["Base Color"] = color
    if image is not None:
        texture = made.node_tree.nodes.new("ShaderNodeTexImage")
        texture.image = image
        made.node_tree.links.new(texture.outputs["Color"], surface.inputs["Base Color"])
    for called, value in inputs.items():
        surface.inputs[called].default_value = value
    return made


def painted(folder):
    scene = fresh()
    scene.frame_end = 5
    image = bpy.data.images.new("checker", 4, 4)
    image.pixels = [c for i in range(16) for c in ((1, 0, 0, 1) if (i + i // 4) % 2 else (0, 1, 0, 1))]
    image.filepath_raw, image.file_format = f"{folder}/checker.png", "PNG"
    image.save()
    image = bpy.data.images.load(f"{folder}/checker.png")
    red = dressed("Red", (0.8, 0.1, 0.05, 1), Metallic=1.0)
    bpy.ops.mesh.primitive_cube_add()
    box = bpy.context.object
    box.name = "Box"
    for material in (dressed("Painted", image=image, Roughness=0.25), red):
        box.data.materials.append(material)
    for number, polygon in enumerate(box.data.polygons):
        polygon.material_index = int(number >= 4)
    for number, place in ((1, (0, 0, 0)), (5, (2, 0, 0))):
        box.location = place
        box.keyframe_insert("location", frame=number)
    bpy.ops.mesh.primitive_uv_sphere_add(segments=8, ring_count=5, location=(0, 0, 3))
    bpy.context.object.name = "Ball"
    bpy.context.object.data.materials.append(red)
    bpy.ops.wm.usd_export(filepath=f"{folder}/painted.usdz", export_animation=True)


if __name__ == "__main__":
    skinned(sys.argv[-1])
    morphing(sys.argv[-1])
    painted(sys.argv[-1])
