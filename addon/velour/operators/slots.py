"""The material slot that an operator puts its material into: a named one, or the active one."""

from __future__ import annotations

from typing import NamedTuple

import bpy
from bpy_extras import view3d_utils
from mathutils import Vector


class Slot(NamedTuple):
    """By name, since undo may replace any datablock. An object without slots gets its first one."""

    object: str
    slot: int


def slot_under(context, event) -> Slot | None:
    """The slot of the face under the cursor; None outside of a 3D viewport, and where there is no object."""
    region = next((region for region in context.area.regions if region.type == "WINDOW"), None)
    view = context.space_data.region_3d if context.area.type == "VIEW_3D" else None
    if region is None or view is None:
        return None
    cursor = event.mouse_x - region.x, event.mouse_y - region.y
    origin = view3d_utils.region_2d_to_origin_3d(region, view, cursor)
    return slot_along(context, origin, view3d_utils.region_2d_to_vector_3d(region, view, cursor))


def slot_along(context, origin: Vector, direction: Vector) -> Slot | None:
    """The slot of the first face that a ray meets: what is drawn, with modifiers and instances."""
    depsgraph = context.evaluated_depsgraph_get()
    hit, _place, _normal, face, obj, _matrix = context.scene.ray_cast(depsgraph, origin, direction)
    if not hit or not takes_materials(obj):
        return None
    mesh = obj.evaluated_get(depsgraph).data
    polygons = mesh.polygons if isinstance(mesh, bpy.types.Mesh) else ()
    number = polygons[face].material_index if 0 <= face < len(polygons) else 0
    return Slot(obj.name, min(number, max(len(obj.material_slots) - 1, 0)))


def takes_materials(obj) -> bool:
    return obj is not None and hasattr(obj.data, "materials") and obj.library is None


def assign(context, material, slot: Slot | None = None) -> bool:
    """Puts `material` into `slot`, or else into the active slot of the active object.

    False, and the material kept by a fake user, where no such object takes materials.
    """
    obj = bpy.data.objects.get(slot.object) if slot else context.object
    if not takes_materials(obj):
        material.use_fake_user = True  # or it would be gone after saving
        return False
    if slot is None or slot.slot >= len(obj.material_slots):
        obj.active_material = material
    else:
        obj.material_slots[slot.slot].material = material
    return True
