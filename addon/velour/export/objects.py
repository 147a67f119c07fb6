"""The objects and instances of an evaluated depsgraph."""

import numpy as np

from .axes import affine
from .lights import add_light
from .meshes import has_uv_map, object_arrays
from .placement import Placements
from .units import metres_per_unit
from .uv_maps import missing_map, uv_map_names
from .visibility import hidden_from, note_visibility

GEOMETRY = {"MESH", "CURVE", "SURFACE", "FONT", "META"}
_UNSUPPORTED = {
    "CURVES": "hair curves",
    "POINTCLOUD": "point clouds",
    "VOLUME": "volumes",
    "GPENCIL": "Grease Pencil",
    "GREASEPENCIL": "Grease Pencil",
    "LIGHT_PROBE": None,  # a helper of EEVEE's: nothing to say
}


class ObjectExport:
    """Adds visible objects to `scene`; instances share the geometry of their evaluated datablock.

    `to_scene`: the 4 x 4 matrix from Blender's world to that of `scene`; None: they are the same.
    """

    def __init__(self, scene, materials, notes, check_break, to_scene=None):
        self._scene = scene
        self._materials = materials
        self._notes = notes
        self._check_break = check_break  # called once an instance; raises to stop
        self._to_scene = to_scene
        self._meshes = {}
        self._placements = Placements(materials, notes)

    def add_all(self, depsgraph):
        override, metres = depsgraph.view_layer_eval.material_override, metres_per_unit(depsgraph.scene)
        for instance in depsgraph.object_instances:
            self._check_break()
            # The instance is only valid within this turn of the loop.
            if not instance.show_self:
                continue
            note_visibility(instance.object, self._notes)
            if instance.object.type in GEOMETRY:
                self._add_geometry(
                    instance, override, metres, hidden_from(instance.object, depsgraph.view_layer)
                )
            elif instance.object.type == "LIGHT":
                add_light(self._scene, instance.object, instance.matrix_world, self._notes)
            else:
                self._note_unsupported(instance.object)

    def add_geometry(self, depsgraph, is_wanted):
        """Of the instances for which `is_wanted` is true; no lights."""
        override, metres = depsgraph.view_layer_eval.material_override, metres_per_unit(depsgraph.scene)
        for instance in depsgraph.object_instances:
            self._check_break()
            if not instance.show_self or not is_wanted(instance):
                continue
            if instance.object.type in GEOMETRY:
                self._add_geometry(instance, override, metres)
            else:
                self._note_unsupported(instance.object)

    def _add_geometry(self, instance, override, metres, hidden=()):
        self._note_extras(instance.object)
        if instance.matrix_world.to_3x3().determinant() == 0:
            self._notes.add(f"Object '{instance.object.name}': its scale is zero along an axis; left out.")
            return
        mesh, slots = self._mesh(instance.object, override)
        if mesh is None:
            return
        numbers = [self._materials.number(material) for material in slots]
        placements = self._placements.of(instance, mesh, slots, metres)
        matrix = instance.matrix_world if self._to_scene is None else self._to_scene @ instance.matrix_world
        self._scene.add_instance(mesh, affine(matrix), numbers, placements, hidden)

    def _mesh(self, obj, override):
        """The mesh's number in the scene (None: there is nothing to see) and the materials of its slots."""
        uv_maps = uv_map_names([override] if override else all_materials(obj))
        key = (obj.type, (obj.data or obj).as_pointer(), uv_maps)
        if key not in self._meshes:
            self._meshes[key] = self._add_mesh(obj, uv_maps)
        number, count = self._meshes[key]
        slots = [override] * count if override else slot_materials(obj, count)
        for material, name in zip(slots, uv_map_names(slots), strict=False):
            if name and not has_uv_map(obj, name):
                self._notes.add(missing_map(obj, name, material.name))
        return number, slots

    def _add_mesh(self, obj, uv_maps):
        arrays = object_arrays(obj, uv_maps)
        if arrays is None:
            return None, 0
        number, dropped = self._scene.add_mesh(**arrays._asdict())
        if dropped:
            self._notes.add(
                f"Object '{obj.name}': {dropped} triangles without area or with NaN are left out."
            )
        return number, int(np.max(arrays.material_slots)) + 1

    def _note_extras(self, obj):
        """What a renderer would add to the evaluated mesh."""
        for system in obj.particle_systems:
            if system.settings.type == "HAIR" and system.settings.render_type == "PATH":
                self._notes.add(f"Object '{obj.name}': hair '{system.name}' is not supported; left out.")
        if getattr(getattr(obj, "cycles", None), "use_adaptive_subdivision", False):
            self._notes.add(f"Object '{obj.name}': adaptive subdivision is not supported; ignored.")

    def _note_unsupported(self, obj):
        kind = _UNSUPPORTED.get(obj.type)
        if kind:
            self._notes.add(f"Object '{obj.name}': {kind} are not supported; left out.")


def all_materials(obj):
    """Of the slots of an object; at least one, which may be None."""
    own = [slot.material for slot in obj.material_slots]
    of_data = list(obj.data.materials) if hasattr(obj.data, "materials") else []
    # Instanced geometry of geometry nodes carries its own materials under an object with fewer slots.
    materials = own if len(own) >= len(of_data) else own + of_data[len(own) :]
    return materials or [None]


def slot_materials(obj, count):
    """The materials of slots 0..count-1; a face beyond the last slot shows the last one, as in Blender."""
    materials = all_materials(obj)
    return [materials[min(slot, len(materials) - 1)] for slot in range(count)]


def slots_of(obj, arrays, material):
    """The slots of an evaluated object's MeshArrays that show a material of the .blend."""
    if arrays is None:
        return ()
    shown = slot_materials(obj, int(np.max(arrays.material_slots)) + 1)
    return tuple(slot for slot, other in enumerate(shown) if other and other.original == material.original)
