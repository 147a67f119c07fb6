"""A file that changed on disk, accepted on purpose."""

import bpy
from bpy.props import StringProperty

from ..export import ExportError
from ..export.files import content, measurement_info, sha256
from ..export.nodes import velour_node
from . import measured


class VELOUR_OT_accept_file(bpy.types.Operator):
    bl_idname = "velour.accept_file"
    bl_label = "Accept Changed File"
    bl_description = "Take the model and the measurement as they are on disk now"
    bl_options = {"REGISTER", "UNDO"}

    material: StringProperty(name="Material", description="Empty: the active one", options={"SKIP_SAVE"})

    def execute(self, context):
        material = measured.find_material(context, self.material)
        node = velour_node(material)
        if node is None:
            self.report({"ERROR"}, "There is no measured material.")
            return {"CANCELLED"}
        try:
            self._accept(node, f"Material '{material.name}'")
        except ExportError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}

    def _accept(self, node, owner):
        for image in filter(None, (node.image, node.velour.scene_model)):
            image.velour.sha256 = sha256(content(image, owner))
        raw = node.velour.measurement
        if raw is not None:
            raw.velour.sha256 = measurement_info(raw, owner)["sha256"]
