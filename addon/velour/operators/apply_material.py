"""Puts the material of a tile on objects, and chooses how often it repeats."""

import math

import bpy
from bpy.props import FloatProperty, StringProperty

from ..core.placement import tiles_along
from ..export import ExportError
from ..export.files import StoredFile
from ..export.measured_look import constant_look
from ..export.nodes import first_input, velour_node
from ..export.objects import GEOMETRY
from ..export.placement import Tile, place_tiles, placed_side, uv_problem
from ..export.shown_surface import ShownSurface
from ..export.uv_maps import linked_uv_map
from . import measured
from .job_target import key_of
from .reads_first import ReadsFirst
from .slots import takes_materials
from .tiles import OfTile, find_tile


class VELOUR_OT_apply_material(OfTile, ReadsFirst, bpy.types.Operator):
    bl_idname = "velour.apply_material"
    bl_label = "Apply Material"
    bl_description = "Put the material of the tile on its target, or on the other selected objects"
    bl_options = {"REGISTER", "UNDO"}

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
    tiles: FloatProperty(
        name="Tiles",
        description="Number of tiles along the longest side of the object. 0: as placed in the material, or"
        " else chosen by the size of the object",
        min=0.0,
        soft_max=1000.0,
        max=1e6,
        precision=1,
        options={"SKIP_SAVE"},
    )

    def draw(self, _context):
        self.layout.use_property_split = True
        self.layout.prop(self, "tiles")

    def _read(self, context):
        material, objects = self._asked(context)
        if self.tiles > 0:
            measured.refuse_linked(material)
        self._subject, self._keys = material.name, (key_of(material), [key_of(obj) for obj in objects])
        node = velour_node(material)
        if node is None or node.image is None:
            return dict
        return StoredFile.of(node.image, f"Material '{material.name}'").model_info

    def _use(self, context, info):
        material = bpy.data.materials.get(self._keys[0])
        objects = [obj for obj in map(bpy.data.objects.get, self._keys[1]) if takes_materials(obj)]
        objects.sort(key=lambda obj: obj.type not in GEOMETRY)  # tiles are counted on the first
        if material is None or not objects:
            raise ExportError(f"Material '{self._subject}' or its object no longer exists.")
        for obj in objects:
            obj.active_material = material
        self._place(context, material, objects, info)
        names = ", ".join(f"'{obj.name}'" for obj in objects)
        size = f", {self.tiles:.4g} tiles along the longest side of '{objects[0].name}'"
        self.report({"INFO"}, f"Material '{material.name}' is on {names}{size if self.tiles else ''}.")
        return {"FINISHED"}

    def _place(self, context, material, objects, info):
        """Chooses the repeats for the first object, since all objects share them; fills in `tiles`."""
        node, objects = velour_node(material), [obj for obj in objects if obj.type in GEOMETRY]
        tile = Tile.of(material, node, constant_look(node), info) if node is not None and objects else None
        if tile is None:
            self.tiles = 0.0
            return
        depsgraph = context.evaluated_depsgraph_get()
        surfaces = [ShownSurface.of(depsgraph, obj, material) for obj in objects]
        for obj, shown in zip(objects, surfaces, strict=True):
            if problem := uv_problem(obj, shown, material.name):
                self.report({"WARNING"}, problem)
        try:
            self.tiles = _tiles_on(surfaces[0], tile, self.tiles, _is_placed(material, node))
        except ExportError as error:
            self.report({"WARNING"}, str(error))

    def _asked(self, context):
        """The material, and the objects that get it; raises ExportError."""
        if self.material and self.object:
            return measured.wanted_material(context, self.material), [_named(self.object)]
        tile = find_tile(context, self.collection)
        objects = [_named(self.object)] if self.object else [*map(_checked, targets(context, tile.owner))]
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
    return [o for o in selected if o not in parts and hasattr(o.data, "materials") and o.library is None]


def _tiles_on(shown, tile, asked, is_placed):
    """Number of tiles along the longest side of a ShownSurface's object; 0 without texture coordinates.

    Places `asked` tiles; if that is 0, as many as the object's size suggests, unless they are placed."""
    if shown.metrics is None:
        return 0.0
    extent = max(shown.obj.dimensions) * shown.metres
    if is_placed and not asked:
        return extent / placed_side(tile, shown.metrics)
    metres = tile.metres
    count = asked or tiles_along(extent, math.sqrt(math.prod(metres)) if metres else None)
    place_tiles(tile, shown.metrics, extent / count)
    return count


def _is_placed(material, node):
    """Whether the material's tiles have a size already, by its settings or by nodes, or cannot get one."""
    if material.library is not None:
        return True
    settings, group = node.velour.placement, node.group
    if settings.is_property_set("mode") or settings.is_property_set("repeats"):
        return True
    if group is None:
        return False
    scale, vector = (first_input(group, name) for name in ("Scale", "Vector"))
    is_scaled = scale is not None and (scale.is_linked or scale.default_value != 1.0)
    return is_scaled or (vector is not None and vector.is_linked and linked_uv_map(node) is None)


def _named(name):
    obj = bpy.data.objects.get(name)
    if obj is None:
        raise ExportError(f"There is no object '{name}'; check its name.")
    return _checked(obj)


def _checked(obj):
    if not takes_materials(obj):
        is_linked = obj.library is not None or getattr(obj.data, "library", None) is not None
        reason = "is linked from a library" if is_linked else "cannot have materials"
        raise ExportError(f"Object '{obj.name}' {reason}; choose another.")
    return obj
