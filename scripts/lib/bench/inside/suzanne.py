"""Writes Suzanne, subdivided and smooth, as OBJ, y up."""

import bpy


def main(task):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.mesh.primitive_monkey_add(size=2.0)
    smooth = bpy.context.object.modifiers.new("Smooth", "SUBSURF")
    smooth.levels = smooth.render_levels = task["levels"]
    bpy.ops.object.shade_smooth()
    options = {"export_materials": False, "export_uv": False, "export_triangulated_mesh": True}
    bpy.ops.wm.obj_export(filepath=task["path"], forward_axis="NEGATIVE_Z", up_axis="Y", **options)
