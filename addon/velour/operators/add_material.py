"""A new, empty measured material on the active object."""

import bpy
from bpy.props import StringProperty

from ..export import ExportError
from . import measured
from .slots import SlotTarget


class VELOUR_OT_add_material(bpy.types.Operator):
    bl_idname = "velour.add_material"
    bl_label = "Use Measured Material"
    bl_description = "Turn the active material into a measured material. Adds a material if there is none"
    bl_options = {"REGISTER", "UNDO"}

    name: StringProperty(name="Name", default="Measured", description="Name of the material, if one is added")

    def execute(self, context):
        material = measured.find_material(context, "")
        if material is None:
            material = measured.new_material(self.name)
            SlotTarget(context).put(material, self.report)
        try:
            measured.refuse_linked(material)
        except ExportError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        measured.ensure_node(material)
        return {"FINISHED"}
