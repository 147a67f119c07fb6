"""Writes Suzanne, subdivided and smooth, as OBJ, y up."""

import bpy

from . import scene as build


def main(task):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    build.monkey(levels=task["levels"])
    options = {"export_materials": False, "export_uv": False, "export_triangulated_mesh": True}
    bpy.ops.wm.obj_export(filepath=task["path"], forward_axis="NEGATIVE_Z", up_axis="Y", **options)
