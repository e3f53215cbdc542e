"""python -m tools.blender.picture STREAM PICTURE.png: four frames of a sequence, played and rendered by Blender."""

from __future__ import annotations

import math
import sys
from typing import Any

import bpy

import bsm.blender

FRAMES_APART = 5
SPACE = 2.25


def main(stream: str, picture: str) -> None:
    """Render the picture."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    coat = _material("coat", (0.36, 0.16, 0.07))
    for number in range(4):
        (one,) = bsm.blender.import_file(stream, frame_start=1 - FRAMES_APART * number, set_scene=False)
        one.rotation_euler = (math.pi / 2, 0, 0)
        one.location.y = SPACE * (1.5 - number)
        one.data.materials.append(coat)
    bpy.ops.mesh.primitive_plane_add(size=60)
    bpy.context.object.data.materials.append(_material("ground", (0.75, 0.72, 0.66)))
    bpy.ops.object.light_add(type="SUN", rotation=(math.radians(40), math.radians(25), math.radians(60)))
    bpy.context.object.data.energy, bpy.context.object.data.angle = 3.5, 0.1
    scene.world = bpy.data.worlds.new("sky")
    scene.world.use_nodes = True
    sky = scene.world.node_tree.nodes["Background"]
    sky.inputs["Color"].default_value, sky.inputs["Strength"].default_value = (0.72, 0.8, 0.9, 1), 0.6
    scene.camera = _camera()
    scene.frame_set(1)
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising = 24, False
    scene.render.resolution_x, scene.render.resolution_y = 960, 300
    scene.view_settings.view_transform = "Standard"
    scene.render.filepath = picture
    bpy.ops.render.render(write_still=True)


def _material(name: str, color: tuple[float, float, float]) -> Any:
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    shader = made.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value, shader.inputs["Roughness"].default_value = (*color, 1), 0.55
    return made


def _camera() -> Any:
    bpy.ops.object.camera_add(location=(13, -3.2, 2.6))
    camera = bpy.context.object
    aim = bpy.data.objects.new("aim", None)
    aim.location = (0, 0, 0.65)
    bpy.context.collection.objects.link(aim)
    look = camera.constraints.new("TRACK_TO")
    look.target, look.track_axis, look.up_axis = aim, "TRACK_NEGATIVE_Z", "UP_Y"
    camera.data.lens = 48
    return camera


if __name__ == "__main__":
    main(*sys.argv[-2:])
