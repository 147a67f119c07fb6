"""Shows a tile repeated: copies around it that follow every change of it.

Around an object, drivers place the copies, so that they follow its rotation and scale, animated or not. The
drivers are simple expressions, which work even if files may not run Python. A new Period places them again.
"""

import contextlib

import bpy
from mathutils import Vector

from ..export import ExportError
from ..properties import changed
from .tiles import OfTile, find_tile, tile_of

_AROUND = [(x, y) for y in (-1, 0, 1) for x in (-1, 0, 1) if (x, y) != (0, 0)]


class VELOUR_OT_repeat_tile(OfTile, bpy.types.Operator):
    bl_idname = "velour.repeat_tile"
    bl_label = "Show Repeats"
    bl_description = (
        "Show the tile 3 x 3 times, as it is captured, or hide the copies again. Without a Period, they are"
        " spaced by the current bounding box"
    )
    bl_options = {"REGISTER", "UNDO"}

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
    """The empties that instance the object or collection `owner`."""
    shown = set(_holders(owner))
    return [o for o in bpy.data.objects if o.instance_collection in shown and _is_repeat(o)] if shown else []


def _holders(owner):
    """Collections that the empties instance: `owner` itself, or one outside all scenes that holds it."""
    if isinstance(owner, bpy.types.Collection):
        return [owner]
    return [c for c in bpy.data.collections if _is_repeat(c) and owner.name in c.objects]


def _is_repeat(datablock):
    """Reading settings would create them, and panels ask about all of the file."""
    return datablock.is_property_set("velour") and datablock.velour.is_repeat


def _take_away(owner):
    """Removes the copies; returns whether there were any."""
    repeats = _repeats(owner)
    made = {c for empty in repeats for c in empty.users_collection} | set(_holders(owner))
    for empty in repeats:
        bpy.data.objects.remove(empty)
    for collection in made:
        if _is_repeat(collection):
            bpy.data.collections.remove(collection)
    return bool(repeats)


def _show(context, tile):
    holder = _holder(tile.owner)
    home = _new_collection(f"{tile.owner.name} Repeats")
    context.scene.collection.children.link(home)
    for _ in _AROUND:
        empty = bpy.data.objects.new(f"{tile.owner.name} Repeat", None)
        empty.velour.is_repeat = empty.hide_select = True
        empty.empty_display_size = 0
        empty.instance_type, empty.instance_collection = "COLLECTION", holder
        home.objects.link(empty)
    _place(home, tile)


def _place(home, tile):
    """Places the copies in the collection `home`, each in its cell."""
    is_object = isinstance(tile.owner, bpy.types.Object)
    axes = tile.to_tile.inverted().to_3x3()
    for empty, (x, y) in zip(home.objects, _AROUND, strict=False):
        empty.location = axes @ Vector((x * tile.period[0], y * tile.period[1], 0))
        for axis in range(3) if is_object else ():
            _drive(empty, axis, (x, y), tile)


def _drive(empty, axis, cell, tile):
    """Drives a coordinate of the copy by the first two columns of the object's matrix."""
    empty.driver_remove("location", axis)
    driver = empty.driver_add("location", axis).driver
    terms = []
    for k in (0, 1):
        variable = driver.variables.new()
        variable.name = f"along{k}"
        variable.targets[0].id = tile.owner
        variable.targets[0].data_path = f"matrix_world[{k}][{axis}]"  # column, row
        unscaled = tile.period[k] / (tile.stretch[k] or 1.0)
        terms.append(f"along{k} * {cell[k] * unscaled:.9g}")
    driver.type, driver.expression = "SCRIPTED", " + ".join(terms)


def _follow_period(owner):
    for home in {collection for empty in _repeats(owner) for collection in empty.users_collection}:
        with contextlib.suppress(ExportError):  # the tile has no geometry left
            _place(home, tile_of(bpy.context, owner))


def attach():
    changed.period_listeners.append(_follow_period)


def detach():
    changed.period_listeners.remove(_follow_period)


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
