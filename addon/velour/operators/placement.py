"""Operators that report a BTF's placement on an object, and store its UV density."""

import bpy
from bpy.props import StringProperty

from ..export import ExportError
from ..export.files import StoredFile
from ..export.measured_look import constant_look
from ..export.nodes import velour_node
from ..export.placement import Tile
from ..export.placement_report import report_on, uv_density_on
from . import measured
from .job_target import key_of
from .reads_first import ReadsFirst


class PlacementOperator(ReadsFirst):
    """Operator mixin; `_use_on(depsgraph, obj, material, tile)` does the work."""

    object: StringProperty(
        name="Object", description="Name of the object. Empty: the active one", options={"SKIP_SAVE"}
    )
    material: StringProperty(
        name="Material",
        description="Name of the material. Empty: the object's active one",
        options={"SKIP_SAVE"},
    )

    def _read(self, context):
        obj = bpy.data.objects.get(self.object) if self.object else context.object
        if obj is None:
            missing = f"There is no object '{self.object}'; check its name."
            raise ExportError(missing if self.object else "There is no active object; select one.")
        material = measured.find_material(context, self.material) if self.material else obj.active_material
        node = velour_node(material)
        if node is None or node.image is None:
            raise ExportError(
                f"Object '{obj.name}' has no material with a model to place; fit or import one."
            )
        self._subject, self._keys = material.name, (key_of(obj), key_of(material))
        return StoredFile.of(node.image, f"Material '{material.name}'").model_info

    def _use(self, context, info):
        obj_key, material_key = self._keys
        obj, material = bpy.data.objects.get(obj_key), bpy.data.materials.get(material_key)
        if obj is None or velour_node(material) is None:
            raise ExportError(f"The object or its material '{self._subject}' no longer exists.")
        node = velour_node(material)
        tile = Tile.of(material, node, constant_look(node), info)
        if tile is None:
            raise ExportError(f"Material '{material.name}' is uniform and has no tiles to place.")
        self._use_on(context.evaluated_depsgraph_get(), obj, material, tile)
        return {"FINISHED"}


class VELOUR_OT_describe_placement(PlacementOperator, bpy.types.Operator):
    bl_idname = "velour.describe_placement"
    bl_label = "Describe Placement"
    bl_description = (
        "Report the size of the material's tiles on the object, and problems with their placement"
    )

    def _use_on(self, *where):
        report = report_on(*where)
        for name, value in report.rows:
            self.report({"INFO"}, f"{name}: {value}")
        for sentence in report.warnings:
            self.report({"WARNING"}, sentence)


class VELOUR_OT_keep_uv_density(PlacementOperator, bpy.types.Operator):
    bl_idname = "velour.keep_uv_density"
    bl_label = "Keep UV Density"
    bl_description = (
        "Use the object's UV density in this frame for all objects and frames, so that tiles do not creep"
        " over deforming meshes"
    )
    bl_options = {"UNDO"}

    def _use_on(self, depsgraph, obj, material, _tile):
        measured.refuse_linked(material)
        velour_node(material).velour.placement.uv_density = uv_density_on(depsgraph, obj, material)
