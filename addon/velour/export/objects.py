"""The objects and instances of an evaluated depsgraph."""

from typing import NamedTuple

import bpy

from .axes import affine
from .corner_colors import colors_of_slots, missing_colors
from .instances import InstanceGroups
from .kept_meshes import KeptMeshes
from .lights import add_light
from .meshes import has_colors, has_uv_map, has_uv_maps, object_arrays
from .notes import listed
from .placement import Placements, missing_coordinates, projected_onto
from .units import metres_per_unit
from .unused_settings import note_pencil
from .uv_maps import maps_of_slots, missing_map
from .visibility import Visibility, has_extent, hidden, hidden_light

_FLAT = 1e-36  # the library skips instances up to this determinant, and does not count them
_TERMINATOR = {"geometry": 0.1, "shading": 0.0}  # Cycles' defaults, without its add-on
_PENCIL = "Grease Pencil strokes"
GEOMETRY = {"MESH", "CURVE", "SURFACE", "FONT", "META"}
_UNSUPPORTED = {
    "CURVES": "hair curves",
    "POINTCLOUD": "point clouds",
    "VOLUME": "volumes",
    "GPENCIL": _PENCIL,
    "GREASEPENCIL": _PENCIL,
    "LIGHT_PROBE": None,  # an EEVEE helper; not noted
}


class Owner(NamedTuple):
    """The object that an instance belongs to."""

    name: str
    asset: str  # name of its topmost parent, or its own
    index: int
    uv_set: int  # see InstanceLabel


class _Shown(NamedTuple):
    """Data shared by all instances of an object."""

    owner: Owner
    mesh: int  # index in the MeshQueue
    slots: list
    look: tuple  # arguments of Scene.add_instances besides meshes and matrices
    is_placed: bool  # rotation and placement of tiles are set per instance


class _Mesh(NamedTuple):
    place: int  # index in the MeshQueue
    slot_count: int
    has_uvs: bool  # its texture coordinates come from UV maps
    uv_set: int  # set of the active render UV map if a UV pass needs it, else -1


class _Slots(NamedTuple):
    """Data shared by all meshes with the same number of slots and the same materials."""

    materials: list
    numbers: tuple  # material numbers in the scene
    is_placed: bool
    look_at_uvs: list  # materials that need texture coordinates
    uv_maps: list  # pairs of a material and the names of its UV maps
    colors: list  # pairs of a material and its CornerColors


class ObjectExport:
    """Adds visible objects to `scene`; instances share the geometry of their evaluated datablock.

    `to_scene`: 4 x 4 matrix from Blender's world space to that of `scene`; None: identity.
    `motion`: Motion of the frame; None: nothing moves.
    `meshes`: KeptMeshes of earlier exports into the same scene. `shows_uvs`: meshes include the texture
    coordinates of a UV pass.
    """

    def __init__(
        self, scene, materials, notes, check_break, to_scene=None, meshes=None, shows_uvs=False, motion=None
    ):
        self._scene = scene
        self._materials = materials
        self._notes = notes
        self._check_break = check_break  # called once per instance; raises to cancel
        self._to_scene = to_scene
        self._motion = motion
        self._meshes = KeptMeshes() if meshes is None else meshes
        self._queue = self._meshes.queue(scene, notes)
        self._asked = {}  # UV maps and colors of a mesh, by the materials of its slots
        self._slots = {}
        self._shown = {}
        self._groups = InstanceGroups(scene, notes)
        self._placements = Placements(materials, notes)
        self._shows_uvs = shows_uvs
        self._cycles = None  # Cycles' settings of the scene, if it is enabled
        self._drawn = None  # the evaluated view layer, whose image Blender may draw strokes over
        self.owners = []  # Owners of the instances in the scene
        self.shines = False  # whether any light emits
        self._seen = []  # queue indices of meshes that are not hidden from the camera
        self.is_seen = False  # whether any of them has triangles
        self._shading = []  # names of objects that only shadow rays see
        self._some_are_wide = False  # whether some lights have a size, besides suns

    def add_all(self, depsgraph):
        self.add_shown(depsgraph, lambda _instance: True)

    def add_shown(self, depsgraph, is_shown):
        """Adds the instances for which `is_shown` is true."""
        self._add(depsgraph, is_shown)

    def add_geometry(self, depsgraph, is_wanted):
        """Adds only the geometry, visible to all rays, of instances for which `is_wanted` is true."""
        self._add(depsgraph, is_wanted, geometry_alone=True)

    def _add(self, depsgraph, is_wanted, geometry_alone=False):
        metres = metres_per_unit(depsgraph.scene)
        layer = depsgraph.view_layer_eval
        override = layer.material_override
        self._drawn = None if geometry_alone else layer
        self._cycles = getattr(depsgraph.scene_eval, "cycles", None)
        visibility = None if geometry_alone else Visibility(depsgraph.view_layer, self._notes)
        for instance in depsgraph.object_instances:
            self._check_break()
            # The instance is only valid within this iteration.
            if not is_wanted(instance):
                continue
            obj = instance.object
            if not instance.show_self:
                if instance.show_particles:
                    self._note_hair(obj)  # which renderers show without the surface that it grows on
                continue
            kind = obj.type
            if kind == "LIGHT" and not geometry_alone:
                instancer = instance.parent if instance.is_instance else None
                rays = hidden_light(obj, instancer, self._notes)
                self.shines |= add_light(self._scene, obj, instance.matrix_world, self._notes, rays)
                self._some_are_wide |= obj.data.type != "SUN" and has_extent(obj.data)
                continue
            shown = self._look_once(instance, obj, override, visibility)
            if shown:
                self._add_instance(instance, shown, metres)
        numbers = self._queue.numbers()
        self.is_seen = any(numbers[place] is not None for place in self._seen)
        self.owners += self._groups.add_to_scene(numbers)

    def note_partial_shadows(self, sky_shines, surfaces_glow):
        """Notes objects that block light which Cycles also finds by rays that pass through them."""
        sources = ["the world"] if sky_shines else []
        sources += ["lights with a size"] if self._some_are_wide else []
        sources += ["emissive surfaces"] if surfaces_glow else []
        for name in self._shading if sources else ():
            self._notes.add(
                f"Object '{name}': it is hidden from diffuse and glossy rays but blocks light of"
                f" {listed(sources)}, which Cycles finds through it in part; disable Shadow in its Ray"
                " Visibility to let it pass."
            )

    def owner(self, instance):
        """Name of the object that an instance of the scene belongs to; None for None."""
        return None if instance is None else self.owners[instance].name

    def _look_once(self, instance, obj, override, visibility):
        if not instance.is_instance:  # it occurs only once
            return self._look_at(obj, override, visibility)
        instancer = visibility.instancer_limits(instance.parent) if visibility else None
        key = (*_identity(obj), instancer)
        if key not in self._shown:
            self._shown[key] = self._look_at(obj, override, visibility, instancer)
        return self._shown[key]

    def _look_at(self, obj, override, visibility, instancer=None):
        """The _Shown of an object; None if it is not geometry. `visibility` None: visible to all rays."""
        if not is_mesh(obj):
            self._note_unsupported(obj)
            return None
        if obj.modifiers:
            self._note_hair(obj)
            if _is_diced(obj, self._cycles):
                self._notes.add(f"Object '{obj.name}': adaptive subdivision is not supported; ignored.")
        data = obj.data
        materials = (override,) if override else tuple(_materials(obj, data))
        mesh = self._mesh(obj, data, materials)
        if mesh is None:
            return None
        slots = self._slots_of(materials, mesh.slot_count)
        if slots.is_placed and self._queue.numbers()[mesh.place] is None:
            return None
        self._note_missing(obj, mesh, slots)
        hidden_from = hidden(visibility.limits(obj), instancer) if visibility else ()
        if "camera" not in hidden_from:
            self._seen.append(mesh.place)
        if "bounces" in hidden_from and "shadows" not in hidden_from:
            self._shading.append(obj.name)
        owner = Owner(obj.name, _asset(obj), obj.pass_index, mesh.uv_set)
        look = (slots.numbers, hidden_from, self._terminator(obj))
        return _Shown(owner, mesh.place, slots.materials, look, slots.is_placed)

    def _terminator(self, obj):
        """Geometry offset of its shadow terminator; notes a shading offset, which is not supported."""
        shading = _terminator(obj, "shading", "shadow_terminator_offset")
        if shading:
            self._notes.add(
                f"Object '{obj.name}': the shading offset {shading:.2g} of its shadow terminator is not"
                " supported; ignored. The geometry offset is used."
            )
        return _terminator(obj, "geometry", "shadow_terminator_geometry_offset")

    def _add_instance(self, instance, shown, metres):
        matrix = instance.matrix_world.copy()  # a copy, to query Blender only once
        if abs(matrix.to_3x3().determinant()) <= _FLAT:
            self._notes.add(f"Object '{shown.owner.name}': its scale is zero along an axis; left out.")
            return
        motion = self._motion and self._motion.places(instance)
        if self._motion and self._motion.is_hidden(instance):
            return
        placements = None
        if shown.is_placed:
            placements = self._placements.of(instance, shown.mesh, shown.slots, metres)
        if self._to_scene is not None:
            matrix = self._to_scene @ matrix
        if placements is None:
            self._groups.add(shown.mesh, shown.look, matrix, shown.owner, motion)
        else:
            numbers, hidden_from, terminator = shown.look
            mesh = self._queue.numbers()[shown.mesh]
            place = affine(matrix) if motion is None else motion
            self._scene.add_instance(mesh, place, numbers, placements, hidden_from, terminator)
            self.owners.append(shown.owner)

    def _mesh(self, obj, data, materials):
        """The _Mesh of an object; None if it has no faces."""
        if materials not in self._asked:
            uv_maps = maps_of_slots(tuple(map(self._materials.uv_maps, materials)))
            self._asked[materials] = uv_maps, colors_of_slots(tuple(map(self._materials.colors, materials)))
        asked = self._asked[materials]
        key = (data.as_pointer(), asked)
        if not self._meshes.has(key, obj):
            arrays = object_arrays(obj, *asked, self._queue.empty, self._shows_uvs)
            if arrays and self._motion:
                arrays = arrays._replace(**self._motion.shapes(obj, arrays))
            self._meshes[key] = arrays and _Mesh(
                self._queue.add(arrays, obj.name),
                arrays.slot_count,
                _has_own_uvs(obj, arrays, asked[0]),
                _shown_uv_set(obj, arrays, asked[0]) if self._shows_uvs else -1,
            )
        return self._meshes[key]

    def _slots_of(self, materials, count):
        key = (materials, count)
        if key not in self._slots:
            shown = _shown_materials(materials, count)
            self._slots[key] = _Slots(
                shown,
                tuple(map(self._materials.number, shown)),
                any(self._materials.tile(m) or self._materials.turn(m) for m in shown),
                [material for material in shown if self._materials.needs_coordinates(material)],
                [
                    (material, sorted(self._materials.uv_maps(material).all_names - {""}))
                    for material in shown
                ],
                [(material, self._materials.colors(material)) for material in shown],
            )
        return self._slots[key]

    def _note_missing(self, obj, mesh, slots):
        if not mesh.has_uvs:
            for material in slots.look_at_uvs:
                is_projected = self._materials.uv_maps(material).projects
                sentence = projected_onto if is_projected else missing_coordinates
                self._notes.add(sentence(obj, material.name))
        for material, names in slots.uv_maps:
            for name in names:
                if not has_uv_map(obj, name):
                    self._notes.add(missing_map(obj, name, material.name))
        for material, colors in slots.colors:
            for asked in colors:
                if not has_colors(obj, asked):
                    self._notes.add(missing_colors(obj, asked, material.name))

    def _note_hair(self, obj):
        for modifier in obj.modifiers:
            if modifier.type != "PARTICLE_SYSTEM" or not modifier.show_render:
                continue
            system = modifier.particle_system
            if system.settings.type == "HAIR" and system.settings.render_type == "PATH":
                self._notes.add(f"Object '{obj.name}': hair '{system.name}' is not supported; left out.")

    def _note_unsupported(self, obj):
        kind = _UNSUPPORTED.get(obj.type)
        if kind == _PENCIL and self._drawn:
            note_pencil(obj, self._drawn, self._notes)
        elif kind:
            self._notes.add(f"Object '{obj.name}': {kind} are not supported; left out.")


def _has_own_uvs(obj, arrays, uv_maps):
    """Whether the texture coordinates of its MeshArrays come from UV maps."""
    if arrays.corner_uvs is None:
        return False
    return not any(maps.projects for maps in uv_maps or ()) or has_uv_maps(obj)


def _shown_uv_set(obj, arrays, uv_maps):
    """The set of its MeshArrays that a UV pass shows; -1 if it has no UV map."""
    if not has_uv_maps(obj):
        return -1
    return len(arrays.more_uvs) if uv_maps else 0


def _is_diced(obj, cycles):
    """Whether Cycles subdivides an object adaptively. `cycles`: its settings of the scene, or None."""
    last = obj.modifiers[-1]
    if last.type != "SUBSURF" or not last.show_render:
        return False
    if hasattr(last, "use_adaptive_subdivision"):  # 5.0 and newer
        return last.use_adaptive_subdivision
    is_experimental = getattr(cycles, "feature_set", "") == "EXPERIMENTAL"
    return is_experimental and getattr(getattr(obj, "cycles", None), "use_adaptive_subdivision", False)


def _asset(obj):
    while obj.parent:
        obj = obj.parent
    return obj.name


def _identity(obj):
    """Key shared by all instances of an object; geometry nodes may put several meshes under one object."""
    data = obj.data
    return obj.original.as_pointer(), data.as_pointer() if data else 0


def is_mesh(obj):
    """Whether renderers show an evaluated object.

    Curves, surfaces, text and metaballs are themselves left out: the depsgraph also has an instance of the
    same object with the mesh made of them, if there is one.
    """
    return isinstance(obj.data, bpy.types.Mesh)


def all_materials(obj):
    """Materials of an object's slots; at least one, which may be None."""
    return _materials(obj, obj.data)


def _materials(obj, data):
    own = [slot.material for slot in obj.material_slots]
    of_data = getattr(data, "materials", ())
    # Instanced geometry of geometry nodes carries its own materials under an object with fewer slots.
    materials = own if len(own) >= len(of_data) else own + list(of_data)[len(own) :]
    return materials or [None]


def _shown_materials(materials, count):
    """Materials of slots 0..count-1; faces beyond the last slot use its material, as in Blender."""
    return [materials[min(slot, len(materials) - 1)] for slot in range(count)]


def slots_of(obj, arrays, material):
    """The slots of an evaluated object's MeshArrays that show `material`."""
    if arrays is None:
        return ()
    shown = _shown_materials(all_materials(obj), arrays.slot_count)
    return tuple(slot for slot, other in enumerate(shown) if other and other.original == material.original)


def _terminator(obj, offset, older):
    """Shadow terminator offset by name; before Blender 5.0, the Cycles setting `older`."""
    found = getattr(obj, f"shadow_terminator_{offset}_offset", None)
    return getattr(getattr(obj, "cycles", None), older, _TERMINATOR[offset]) if found is None else found
