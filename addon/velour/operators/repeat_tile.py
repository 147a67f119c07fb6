"""Shows a tile repeated: copies around it that follow every change of it."""

import bpy
from bpy.props import StringProperty
from mathutils import Vector

from ..export import ExportError
from .tiles import find_tile

_AROUND = [(x, y) for y in (-1, 0, 1) for x in (-1, 0, 1) if (x, y) != (0, 0)]


class VELOUR_OT_repeat_tile(bpy.types.Operator):
    bl_idname = "velour.repeat_tile"
    bl_label = "Show Repeated"
    bl_description = (
        "Show the tile 3 x 3 times, as a capture sees it: copies around it that follow its changes and cannot"
        " be selected. Press again to take them away"
    )
    bl_options = {"REGISTER", "UNDO"}

    collection: StringProperty(
        name="Collection", description="The tile; empty: the active object is it", options={"SKIP_SAVE"}
    )

    @classmethod
    def poll(cls, context):
        return context.mode == "OBJECT"

    def execute(self, context):
        try:
            tile = find_tile(context, self.collection)
        except ExportError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        if not _take_away(tile.owner):
            _show(context, tile)
        return {"FINISHED"}


def is_repeated(owner):
    return any(_repeats(owner))


def _repeats(owner):
    """The empties that stand for copies of the object or collection `owner`."""
    shown = _holders(owner)
    return [o for o in bpy.data.objects if o.velour.is_repeat and o.instance_collection in shown]


def _holders(owner):
    """What the empties instance: the collection itself; or one that holds the object and lies in no scene."""
    if isinstance(owner, bpy.types.Collection):
        return [owner]
    return [c for c in bpy.data.collections if c.velour.is_repeat and owner.name in c.objects]


def _take_away(owner):
    """True where there were copies."""
    repeats = _repeats(owner)
    made = {c for empty in repeats for c in empty.users_collection} | set(_holders(owner))
    for empty in repeats:
        bpy.data.objects.remove(empty)
    for collection in made:
        if collection.velour.is_repeat:
            bpy.data.collections.remove(collection)
    return bool(repeats)


def _show(context, tile):
    holder = _holder(tile.owner)
    to_world = tile.to_tile.inverted().to_3x3()
    home = _new_collection(f"{tile.owner.name} Repeats")
    context.scene.collection.children.link(home)
    for x, y in _AROUND:
        empty = bpy.data.objects.new(f"{tile.owner.name} Repeat", None)
        empty.velour.is_repeat = empty.hide_select = True
        empty.empty_display_size = 0
        empty.instance_type, empty.instance_collection = "COLLECTION", holder
        empty.location = to_world @ Vector((x * tile.period[0], y * tile.period[1], 0))
        home.objects.link(empty)


def _holder(owner):
    if isinstance(owner, bpy.types.Collection):
        return owner
    holder = _new_collection(f"{owner.name} Tile")
    holder.objects.link(owner)
    return holder


def _new_collection(name):
    collection = bpy.data.collections.new(name)
    collection.velour.is_repeat = True
    return collection
