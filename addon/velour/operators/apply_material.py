"""Puts the material of a tile on objects."""

import bpy
from bpy.props import StringProperty

from ..export import ExportError
from . import measured
from .slots import takes_materials
from .tiles import find_tile


class VELOUR_OT_apply_material(bpy.types.Operator):
    bl_idname = "velour.apply_material"
    bl_label = "Apply Material"
    bl_description = "Put the material of the tile on its target, or on the other selected objects"
    bl_options = {"REGISTER", "UNDO"}

    collection: StringProperty(
        name="Collection",
        description="Collection that is the tile. Empty: the active object",
        options={"SKIP_SAVE"},
    )
    material: StringProperty(
        name="Material",
        description="Name of the material. Empty: the material of the tile",
        options={"SKIP_SAVE"},
    )
    object: StringProperty(
        name="Object",
        description="Object that gets the material. Empty: the target of the tile, or the selected objects",
        options={"SKIP_SAVE"},
    )

    def execute(self, context):
        try:
            material, objects = self._asked(context)
        except ExportError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        for obj in objects:
            obj.active_material = material
            if obj.type == "MESH" and not obj.data.uv_layers:
                self.report({"WARNING"}, f"Object '{obj.name}' has no UV map to place the tiles; unwrap it.")
        names = ", ".join(f"'{obj.name}'" for obj in objects)
        self.report({"INFO"}, f"Material '{material.name}' is on {names}.")
        return {"FINISHED"}

    def _asked(self, context):
        """The material, and the objects that get it; raises ExportError."""
        if self.material and self.object:
            return measured.wanted_material(context, self.material), [_named(self.object)]
        tile = find_tile(context, self.collection)
        objects = [_named(self.object)] if self.object else targets(context, tile.owner)
        if self.material:
            material = measured.wanted_material(context, self.material)
        elif (material := tile.owner.velour.material) is None:
            raise ExportError(f"{tile.label} has no material yet; press Make Material.")
        if not objects:
            raise ExportError(f"{tile.label}: there is no object for the material; choose its Target.")
        return material, objects


def targets(context, owner):
    """Objects that get the material of a tile, an object or a collection. Safe in draw()."""
    if owner.velour.target is not None:
        return [owner.velour.target]
    parts = {owner} if isinstance(owner, bpy.types.Object) else {*owner.all_objects}
    selected = context.view_layer.objects.selected
    return [obj for obj in selected if obj not in parts and takes_materials(obj)]


def _named(name):
    obj = bpy.data.objects.get(name)
    if obj is None:
        raise ExportError(f"There is no object '{name}'; check its name.")
    if not takes_materials(obj):
        raise ExportError(f"Object '{name}' cannot have materials; choose another.")
    return obj
