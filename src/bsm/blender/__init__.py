"""Meshes and sequences in Blender, by its module `bpy`: what the extension in tools/blender does, for scripts as well.

import bsm.blender
moving = bsm.blender.import_file("samba.bsm")[0]
bsm.blender.export_object("again.bsm", moving, preset="fine")
"""

from bsm.blender.exporting import export_object as export_object
from bsm.blender.importing import import_file as import_file
from bsm.blender.importing import restore_caches as restore_caches
