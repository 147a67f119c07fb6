"""The objects and instances of an evaluated depsgraph."""

from typing import NamedTuple

import numpy as np

from .axes import affine
from .instances import InstanceGroups
from .kept_meshes import KeptMeshes
from .lights import add_light
from .meshes import has_uv_map, object_arrays
from .placement import Placements
from .units import metres_per_unit
from .uv_maps import maps_of_slots, missing_map
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


class _Shown(NamedTuple):
    """What all instances of an object have in common."""

    owner: str  # its name
    mesh: int | None  # its number in the scene; None: there is nothing to see
    slots: list
    look: tuple  # the arguments of Scene.add_instances beside mesh and matrices
    is_tiled: bool  # how tiles lie may depend on the matrix


class ObjectExport:
    """Adds visible objects to `scene`; instances share the geometry of their evaluated datablock.

    `to_scene`: the 4 x 4 matrix from Blender's world to that of `scene`; None: they are the same.
    `meshes`: KeptMeshes of exports into the same scene before.
    """

    def __init__(self, scene, materials, notes, check_break, to_scene=None, meshes=None):
        self._scene = scene
        self._materials = materials
        self._notes = notes
        self._check_break = check_break  # called once an instance; raises to stop
        self._to_scene = to_scene
        self._meshes = KeptMeshes() if meshes is None else meshes
        self._shown = {}
        self._groups = InstanceGroups(scene, notes)
        self._placements = Placements(materials, notes)
        self._owners = []  # of the instances in the scene, by name
        self.shines = False  # a lamp has power
        self.is_seen = False  # the camera sees an instance, if it looks there

    def add_all(self, depsgraph):
        self.add_shown(depsgraph, lambda instance: instance.show_self)

    def add_shown(self, depsgraph, is_shown):
        """The instances for which `is_shown` is true."""
        self._add(depsgraph, is_shown)

    def add_geometry(self, depsgraph, is_wanted):
        """Of the instances for which `is_wanted` is true, visible to all; no lights."""
        self._add(depsgraph, lambda instance: instance.show_self and is_wanted(instance), geometry_alone=True)

    def _add(self, depsgraph, is_wanted, geometry_alone=False):
        metres = metres_per_unit(depsgraph.scene)
        for instance in depsgraph.object_instances:
            self._check_break()
            # The instance is only valid within this turn of the loop.
            if not is_wanted(instance):
                continue
            obj = instance.object
            if obj.type == "LIGHT" and not geometry_alone:
                note_visibility(obj, self._notes)
                self.shines |= add_light(self._scene, obj, instance.matrix_world, self._notes)
                continue
            key = _identity(obj)
            if key not in self._shown:
                self._shown[key] = self._look_at(obj, depsgraph, geometry_alone)
            if self._shown[key]:
                self._add_instance(instance, self._shown[key], metres)
        self._owners += self._groups.add_to_scene()

    def owner(self, instance):
        """The name of the object that an instance of the scene is of; None of None."""
        return None if instance is None else self._owners[instance]

    def _look_at(self, obj, depsgraph, geometry_alone):
        """The _Shown of an object; None of what is no geometry."""
        if not geometry_alone:
            note_visibility(obj, self._notes)
        if obj.type not in GEOMETRY:
            self._note_unsupported(obj)
            return None
        self._note_extras(obj)
        mesh, slots = self._mesh(obj, depsgraph.view_layer_eval.material_override)
        if mesh is None:
            return None
        numbers = tuple(self._materials.number(material) for material in slots)
        hidden = () if geometry_alone else hidden_from(obj, depsgraph.view_layer)
        is_tiled = any(self._materials.tile(material) for material in slots)
        if not is_tiled:
            self._placements.note_missing(obj, mesh, slots)
        self.is_seen |= "camera" not in hidden
        return _Shown(obj.name, mesh, slots, (numbers, hidden), is_tiled)

    def _add_instance(self, instance, shown, metres):
        matrix = instance.matrix_world
        if matrix.to_3x3().determinant() == 0:
            self._notes.add(f"Object '{shown.owner}': its scale is zero along an axis; left out.")
            return
        placements = None
        if shown.is_tiled:
            placements = self._placements.of(instance, shown.mesh, shown.slots, metres)
        if self._to_scene is not None:
            matrix = self._to_scene @ matrix
        if placements is None:
            self._groups.add(shown.mesh, shown.look, matrix, shown.owner)
        else:
            numbers, hidden = shown.look
            self._scene.add_instance(shown.mesh, affine(matrix), numbers, placements, hidden)
            self._owners.append(shown.owner)

    def _mesh(self, obj, override):
        """The mesh's number in the scene (None: there is nothing to see) and the materials of its slots."""
        materials = [override] if override else all_materials(obj)
        uv_maps = maps_of_slots(tuple(map(self._materials.uv_maps, materials)))
        key = (obj.type, (obj.data or obj).as_pointer(), uv_maps)
        if not self._meshes.has(key, obj):
            self._meshes[key] = self._add_mesh(obj, uv_maps)
        number, count = self._meshes[key]
        slots = [override] * count if override else slot_materials(obj, count)
        if uv_maps:
            self._note_missing_maps(obj, slots)
        return number, slots

    def _note_missing_maps(self, obj, slots):
        for material in slots:
            for name in sorted(self._materials.uv_maps(material).all_names):
                if name and not has_uv_map(obj, name):
                    self._notes.add(missing_map(obj, name, material.name))

    def _add_mesh(self, obj, uv_maps):
        arrays = object_arrays(obj, uv_maps)
        if arrays is None:
            return None, 0
        number, dropped = self._scene.add_mesh(**arrays._asdict())
        if dropped:
            self._notes.add(
                f"Object '{obj.name}': {dropped} triangles without area or with NaN are left out."
            )
        if dropped == len(arrays.triangles):
            return None, 0
        return number, int(np.max(arrays.material_slots)) + 1

    def _note_extras(self, obj):
        """What a renderer would add to the evaluated mesh."""
        for system in obj.particle_systems:
            if system.settings.type == "HAIR" and system.settings.render_type == "PATH":
                self._notes.add(f"Object '{obj.name}': hair '{system.name}' is not supported; left out.")
        # Of the object before Blender 5.0, of its modifier since.
        adaptive = (getattr(obj, "cycles", None), *obj.modifiers)
        if any(getattr(place, "use_adaptive_subdivision", False) for place in adaptive):
            self._notes.add(f"Object '{obj.name}': adaptive subdivision is not supported; ignored.")

    def _note_unsupported(self, obj):
        kind = _UNSUPPORTED.get(obj.type)
        if kind:
            self._notes.add(f"Object '{obj.name}': {kind} are not supported; left out.")


def _identity(obj):
    """What all instances of an evaluated object share; meshes of geometry nodes come under that object."""
    data = obj.data
    return obj.original.as_pointer(), data.as_pointer() if data else 0


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
