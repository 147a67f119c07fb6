"""Which tile an operator is for."""

import bpy

from ..export import ExportError
from ..export.tiles import collection_tile, object_tile


def find_tile(context, collection_name):
    """The TileSource of the collection of that name, or of the active object when it is empty."""
    depsgraph = context.evaluated_depsgraph_get()
    if collection_name:
        collection = bpy.data.collections.get(collection_name)
        if collection is None:
            raise ExportError(f"There is no collection '{collection_name}' to take as a tile.")
        return collection_tile(collection, depsgraph)
    if context.object is None:
        raise ExportError("There is no active object to take as a tile.")
    return object_tile(context.object, depsgraph)
