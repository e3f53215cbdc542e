"""BSM in Blender: File > Import and Export, and dropping a .bsm onto the viewport."""

import os
from contextlib import contextmanager

import bpy
from bpy.app.handlers import persistent
from bpy.props import (
    BoolProperty,
    CollectionProperty,
    EnumProperty,
    FloatProperty,
    IntProperty,
    StringProperty,
)
from bpy_extras.io_utils import ExportHelper, ImportHelper

from bsm.codec.static.presets import DEFAULT, SEQUENCE_ROWS

PRESETS = [(row.name, row.name.capitalize(), row.use) for row in SEQUENCE_ROWS]


@contextmanager
def progress_of(context):
    """A number at the pointer while frames are read or written."""
    manager = context.window_manager
    manager.progress_begin(0, 100)
    try:
        yield lambda done, total: manager.progress_update(100 * done // max(total, 1))
    finally:
        manager.progress_end()


class BSM_OT_import(bpy.types.Operator, ImportHelper):
    """Import compressed meshes and moving meshes"""

    bl_idname = "import_scene.bsm"
    bl_label = "Import BSM"
    bl_options = {"REGISTER", "UNDO", "PRESET"}  # noqa: RUF012

    filename_ext = ".bsm"
    filter_glob: StringProperty(default="*.bsm", options={"HIDDEN"})
    directory: StringProperty(subtype="DIR_PATH", options={"SKIP_SAVE", "HIDDEN"})
    files: CollectionProperty(
        type=bpy.types.OperatorFileListElement, options={"SKIP_SAVE", "HIDDEN"}
    )
    own_start: BoolProperty(
        name="Own First Frame", default=True, description="The number that the stream gives, or 1"
    )
    frame_start: IntProperty(
        name="First Frame", default=1, description="Frame of the scene that shows the first one"
    )
    up: EnumProperty(
        name="Up",
        items=[("z", "Z", ""), ("y", "Y", "")],
        description="The axis that points up, where the stream does not say",
    )
    set_scene: BoolProperty(
        name="Set Scene",
        default=True,
        description="Let the scene have the frames per second and the end of the sequence",
    )

    def execute(self, context):
        from bsm.bitstream.errors import BsmError

        from .objects import import_file

        names = [os.path.join(self.directory, file.name) for file in self.files if file.name] or [
            self.filepath
        ]
        given = {
            "frame_start": None if self.own_start else self.frame_start,
            "set_scene": self.set_scene,
            "up": self.up,
        }
        with progress_of(context) as progress:
            for name in names:
                try:
                    import_file(name, **given, progress=progress)
                except (BsmError, OSError) as error:
                    self.report({"ERROR"}, f"{os.path.basename(name)}: {error}")
                    return {"CANCELLED"}
        return {"FINISHED"}

    def invoke(self, context, event):
        return (
            self.invoke_popup(context) if self.files else ImportHelper.invoke(self, context, event)
        )


class BSM_OT_export(bpy.types.Operator, ExportHelper):
    """Export the active object, with its modifiers and its motion"""

    bl_idname = "export_scene.bsm"
    bl_label = "Export BSM"
    bl_options = {"PRESET"}  # noqa: RUF012

    filename_ext = ".bsm"
    filter_glob: StringProperty(default="*.bsm", options={"HIDDEN"})
    animation: BoolProperty(
        name="Animation", default=True, description="All frames of the scene, not only this one"
    )
    preset: EnumProperty(name="Preset", items=PRESETS, default=DEFAULT)
    look: FloatProperty(
        name="Look",
        default=0.0,
        min=0.0,
        soft_max=3.0,
        description="Largest look distance from the original; at 1, both look the same; 0: the preset's promise",
    )

    @classmethod
    def poll(cls, context):
        return context.active_object is not None

    def execute(self, context):
        from bsm.bitstream.errors import BsmError

        from .objects import export_object

        quality = {"preset": self.preset} | ({"look": self.look} if self.look else {})
        with progress_of(context) as progress:
            try:
                done = export_object(
                    self.filepath, animation=self.animation, progress=progress, **quality
                )
            except (BsmError, OSError) as error:
                self.report({"ERROR"}, str(error))
                return {"CANCELLED"}
        self.report(
            {"INFO"},
            f"{done['frames']} frames of {done['vertices']} vertices in {done['bytes']} bytes",
        )
        return {"FINISHED"}


class BSM_FH_import(bpy.types.FileHandler):
    """Takes streams that are dropped"""

    bl_idname = "BSM_FH_import"
    bl_label = "BSM"
    bl_import_operator = "import_scene.bsm"
    bl_export_operator = "export_scene.bsm"
    bl_file_extensions = ".bsm"

    @classmethod
    def poll_drop(cls, context):
        return context.area is None or context.area.type in ("VIEW_3D", "OUTLINER")


@persistent
def restore(*_):
    """Write caches again that a project has lost on its way."""
    from .objects import restore_caches

    restore_caches()


def add_import(menu, _):
    menu.layout.operator(BSM_OT_import.bl_idname, text="BSM (.bsm)")


def add_export(menu, _):
    menu.layout.operator(BSM_OT_export.bl_idname, text="BSM (.bsm)")


CLASSES = (BSM_OT_import, BSM_OT_export, BSM_FH_import)


def register():
    """What Blender calls when the extension is enabled."""
    for kind in CLASSES:
        bpy.utils.register_class(kind)
    bpy.types.TOPBAR_MT_file_import.append(add_import)
    bpy.types.TOPBAR_MT_file_export.append(add_export)
    bpy.app.handlers.load_post.append(restore)


def unregister():
    """What Blender calls when it is disabled."""
    bpy.app.handlers.load_post.remove(restore)
    bpy.types.TOPBAR_MT_file_export.remove(add_export)
    bpy.types.TOPBAR_MT_file_import.remove(add_import)
    for kind in reversed(CLASSES):
        bpy.utils.unregister_class(kind)
