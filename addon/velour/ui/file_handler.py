"""Drag and drop of files into a window, in Blender 4.1 and newer."""

import bpy

from ..core.measurement_files import SUFFIXES
from ..operators.load_material import VELOUR_OT_load_material

CLASSES = ()

if hasattr(bpy.types, "FileHandler"):

    class VELOUR_FH_measured(bpy.types.FileHandler):
        bl_idname = "VELOUR_FH_measured"
        bl_label = "Measured Material"
        bl_import_operator = VELOUR_OT_load_material.bl_idname
        bl_file_extensions = ";".join(SUFFIXES)

        @classmethod
        def poll_drop(cls, context):
            """Only editors that show materials; not image or text editors."""
            return context.area is not None and context.area.type in {"VIEW_3D", "PROPERTIES"}

    CLASSES = (VELOUR_FH_measured,)
