"""What a BTF's placement comes to on an object, told and kept."""

import bpy
from bpy.props import StringProperty

from ..export import ExportError
from ..export.files import read_model
from ..export.nodes import velour_node
from ..export.placement import Tile
from ..export.placement_report import report_on
from ..native import VelourError
from . import measured


class PlacementOperator:
    object: StringProperty(name="Object", description="Empty: the active one", options={"SKIP_SAVE"})
    material: StringProperty(
        name="Material", description="Empty: the object's active one", options={"SKIP_SAVE"}
    )

    def execute(self, context):
        try:
            self._use(context)
        except (ExportError, VelourError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}

    def _measured(self, context):
        """The node of the material, and the PlacementReport of it on the object."""
        obj = bpy.data.objects.get(self.object) if self.object else context.object
        if obj is None:
            raise ExportError(
                f"There is no object '{self.object}'." if self.object else "There is no active object."
            )
        material = measured.find_material(context, self.material) if self.material else obj.active_material
        node = velour_node(material)
        if node is None or node.image is None:
            raise ExportError(f"Object '{obj.name}': there is no material with a model to place on it.")
        owner = f"Material '{material.name}'"
        with read_model(node.image, owner) as model:
            tile = Tile.of(material, model.info())
        if tile is None:
            raise ExportError(f"{owner} is the same all over; it has no tiles to place.")
        return node, report_on(context.evaluated_depsgraph_get(), obj, material, tile)


class VELOUR_OT_describe_placement(PlacementOperator, bpy.types.Operator):
    bl_idname = "velour.describe_placement"
    bl_label = "Describe Placement"
    bl_description = "Say how large the tiles of the material are on the object, and what is wrong with that"
    bl_options = {"REGISTER"}

    def _use(self, context):
        _node, report = self._measured(context)
        for name, value in report.rows:
            self.report({"INFO"}, f"{name}: {value}")
        for sentence in report.warnings:
            self.report({"WARNING"}, sentence)


class VELOUR_OT_keep_uv_density(PlacementOperator, bpy.types.Operator):
    bl_idname = "velour.keep_uv_density"
    bl_label = "Keep UV Density"
    bl_description = (
        "Take the density of the object's texture coordinates as they are in this frame for all objects and"
        " frames, so that tiles do not creep over a mesh that deforms"
    )
    bl_options = {"REGISTER", "UNDO"}

    def _use(self, context):
        node, report = self._measured(context)
        if report.uv_density is None:
            raise ExportError(report.warnings[0])
        node.velour.placement.uv_density = report.uv_density
