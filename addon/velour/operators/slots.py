"""The material slot that an operator puts its material into: a named one or the active one."""

from typing import NamedTuple

import bpy
from bpy.props import IntProperty, StringProperty
from bpy_extras import view3d_utils
from mathutils import Vector

from .job_target import JobOwner

_MOST_HIDDEN = 256  # consecutive faces of objects outside of a local view
_STEP, _LEAST_STEP = 1e-5, 1e-6  # behind a face: relative to its distance, and minimum in scene units


class Slot(NamedTuple):
    """Slot of an object, by name. An object without slots gets its first one."""

    object: str
    slot: int


def slot_under(context, event) -> Slot | None:
    """The slot of the face under the cursor; None outside of a 3D viewport, or if there is no object."""
    region, view = context.region, context.region_data  # a quad view has one per region; a toolbar has none
    if view is None:
        return None
    cursor = event.mouse_x - region.x, event.mouse_y - region.y
    origin = view3d_utils.region_2d_to_origin_3d(region, view, cursor)
    return slot_along(context, origin, view3d_utils.region_2d_to_vector_3d(region, view, cursor))


def slot_along(context, origin: Vector, direction: Vector) -> Slot | None:
    """The slot of the first drawn face that a ray hits, with modifiers and instances."""
    depsgraph = context.evaluated_depsgraph_get()
    for _ in range(_MOST_HIDDEN):
        hit, place, _normal, face, obj, matrix = context.scene.ray_cast(depsgraph, origin, direction)
        if not hit:
            return None
        if _is_drawn(context, depsgraph, obj, matrix):
            return _slot_of(obj.evaluated_get(depsgraph), face) if takes_materials(obj) else None
        origin = place + direction * max(_STEP * (place - origin).length, _LEAST_STEP)
    return None


def _slot_of(evaluated, face: int) -> Slot:
    mesh = evaluated.data
    polygons = mesh.polygons if isinstance(mesh, bpy.types.Mesh) else ()
    number = polygons[face].material_index if 0 <= face < len(polygons) else 0
    return Slot(evaluated.name, min(number, max(len(evaluated.material_slots) - 1, 0)))


def _is_drawn(context, depsgraph, obj, matrix) -> bool:
    """Whether the viewport draws this object or instance; in local view, parents of instances decide."""
    space = context.space_data
    if getattr(space, "local_view", None) is None:
        return True
    return any(
        (instance.parent or instance.object).local_view_get(space)
        for instance in depsgraph.object_instances
        if instance.object.original == obj.original and instance.matrix_world == matrix
    )


def takes_materials(obj) -> bool:
    """Whether the active slot of an object can get a material: the object or its mesh may be linked."""
    is_one = obj is not None and hasattr(obj.data, "materials")
    return is_one and not obj.is_property_readonly("active_material")


class PutsInSlot:
    """Mixin for an operator that puts its material into a slot; whether it does is its property `assign`."""

    object: StringProperty(
        name="Object",
        description="Object that gets the material. Empty: the active one",
        options={"HIDDEN", "SKIP_SAVE"},
    )
    slot: IntProperty(
        name="Slot", description="Index of the material slot, from 0", min=0, options={"HIDDEN", "SKIP_SAVE"}
    )


class SlotTarget:
    """A slot that is fixed when a job begins, regardless of selection, renaming and undo until it ends."""

    def __init__(self, context, slot: Slot | None = None):
        """`slot`: None, or a number beyond the object's slots, means the active slot."""
        obj = bpy.data.objects.get(slot.object) if slot else context.object
        self._owner = self._number = None
        self._why_none = _why_none(obj, slot)
        if obj is None:
            return
        count = len(obj.material_slots)
        is_there = slot is not None and (slot.slot < count or count == 0)
        number = slot.slot if is_there else obj.active_material_index
        if _takes(obj, number):
            self._owner, self._number = JobOwner(obj), number

    @classmethod
    def asked(cls, context, operator):
        """Uses the properties of a PutsInSlot; None: no slot is wanted."""
        if not operator.assign:
            return None
        name = operator.object
        if not name and operator.properties.is_property_set("slot") and context.object:
            name = context.object.name
        return cls(context, Slot(name, operator.slot) if name else None)

    def take(self):
        """The object and the slot's number; None if there is none, or it is gone. Call once."""
        obj = self._owner.take() if self._owner else None
        return (obj, self._number) if _takes(obj, self._number) else None

    def put(self, material, report) -> None:
        """Puts the material into the slot; without a slot, a fake user keeps the material."""
        taken = self.take()
        if taken is not None:
            _put(material, *taken)
            return
        material.use_fake_user = True  # otherwise it would be lost on saving
        self.tell(f"material '{material.name}'", report)

    def tell(self, what, report) -> None:
        """Reports why `what`, a material, is not put into the slot."""
        why = self._why_none
        if self._owner:
            why = f"Slot {self._number + 1} of object '{self._owner.name}' no longer exists"
        report({"WARNING"}, f"{why}; {what} is kept without an object; assign it.")


def _why_none(obj, slot: Slot | None) -> str:
    """Reason why there is no slot."""
    if obj is not None:
        if not hasattr(obj.data, "materials"):
            return f"Object '{obj.name}' cannot have materials"
        if obj.library is not None:
            return f"Object '{obj.name}' is linked from a library"
        return f"The materials of object '{obj.name}' are linked from a library"
    return f"There is no object '{slot.object}'" if slot else "There is no active object"


def _takes(obj, number) -> bool:
    """Whether an object has a slot with this number, or none yet, and it can get a material."""
    slots = obj.material_slots if obj is not None else ()
    if not slots:
        return takes_materials(obj)
    return number < len(slots) and not slots[number].is_property_readonly("material")


def _put(material, obj, number):
    if obj.material_slots:
        obj.material_slots[number].material = material
    else:
        obj.active_material = material
