"""Saves a model from the .blend to a file."""

import bpy
from bpy.props import BoolProperty, StringProperty
from bpy_extras.io_utils import ExportHelper

from ..core.files import write_atomic
from ..export import ExportError
from ..export.files import content
from ..export.nodes import velour_node
from . import measured


class VELOUR_OT_save_model(measured.OfMaterial, bpy.types.Operator, ExportHelper):
    bl_idname = "velour.save_model"
    bl_label = "Save Model"
    bl_description = "Save the material's model to a file. The material keeps its own copy"

    filename_ext = ".velour"
    filter_glob: StringProperty(default="*.velour", options={"HIDDEN"})
    for_scene: BoolProperty(
        name="Scene Model",
        description="Save the scene model instead of the full model",
        options={"SKIP_SAVE"},
    )

    def invoke(self, context, event):
        """Stores the material's name, since the file browser has no active material."""
        material = measured.find_material(context, self.material)
        self.material = material.name if material else ""
        return ExportHelper.invoke(self, context, event)

    def execute(self, context):
        material = measured.find_material(context, self.material)
        node = velour_node(material)
        image = None
        if node is not None:
            image = node.velour.scene_model if self.for_scene else node.image
        if image is None:
            self.report({"ERROR"}, "There is no model to save; fit or import one first.")
            return {"CANCELLED"}
        if not self.filepath:
            self.report({"ERROR"}, "There is no path to save to; set filepath.")
            return {"CANCELLED"}
        path = bpy.path.abspath(self.filepath)
        try:
            data = content(image, f"Material '{material.name}'")
            write_atomic(path, lambda temporary: temporary.write_bytes(data))
        except ExportError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        except OSError as error:
            self.report({"ERROR"}, f"{path} cannot be written ({error.strerror}); choose another folder.")
            return {"CANCELLED"}
        return {"FINISHED"}
