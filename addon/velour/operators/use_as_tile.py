"""Shows the settings of a mesostructure for an object or a collection."""

import bpy

from ..export import ExportError
from ..export.objects import GEOMETRY
from .tiles import OfTile


class VELOUR_OT_use_as_tile(OfTile, bpy.types.Operator):
    bl_idname = "velour.use_as_tile"
    bl_label = "Use as Mesostructure"
    bl_description = "Show the settings that capture this geometry as the tile of a material"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        try:
            owner = _owner(context, self.collection)
            if owner.library is not None:
                raise ExportError(f"'{owner.name}' is linked from a library; make it local.")
            owner.velour.is_tile = True
        except ExportError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


def _owner(context, collection):
    if collection:
        found = bpy.data.collections.get(collection)
        if found is None:
            raise ExportError(f"There is no collection {collection!r}.")
        return found
    if context.object is None or context.object.type not in GEOMETRY:
        raise ExportError("The active object has no geometry; select the object that is one tile.")
    return context.object
