"""Adds a procedural tile of mesostructure as an ordinary mesh."""

import bpy
import numpy as np
from bpy.props import EnumProperty, FloatProperty, IntProperty
from bpy_extras.object_utils import AddObjectHelper, object_data_add

from ..core.quads import joined
from ..export.color import rec709_to_working
from ..export.nodes import first_input
from ..export.units import metres_per_unit
from ..native import Tile, VelourError
from .slots import takes_materials

_TYPES = (
    ("WEAVE", "Plain Weave", "Each yarn passes over one, then under one", 0),
    ("TWILL", "Twill", "Each yarn passes over two, then under two, shifted by one in each row", 1),
    ("NET", "Net", "Crossed cords around square holes", 2),
    ("CHAINMAIL", "Chain Mail", "Wire rings, each linked with four others", 3),
    ("GRAVEL", "Gravel", "Bed of pebbles on a floor", 4),
    ("CORDUROY", "Corduroy", "Ribs of pile with grooves between them", 5),
    ("SATIN", "Satin", "Each warp yarn passes over four, then under one", 6),
    ("KNIT", "Knit", "Loops of a three-ply yarn, each hanging in the next", 7),
    ("VELVET", "Velvet", "Upright fibers on a ground", 8),
    ("LEATHER", "Leather", "Cushions with creases between them", 9),
)
_SHAPE = ("size", "count", "thickness", "gap", "irregularity", "resolution", "seed")


def _forget_shape(operator, _context):
    """Resets the shape to the defaults of another type."""
    for name in _SHAPE:
        operator.property_unset(name)


class VELOUR_OT_add_mesostructure(bpy.types.Operator, AddObjectHelper):
    bl_idname = "velour.add_mesostructure"
    bl_label = "Add Mesostructure"
    bl_description = "Add one tile of a small structure in real size that repeats seamlessly"
    bl_options = {"REGISTER", "UNDO"}

    # Properties that are not set use the type's defaults, which are filled in once the tile is made.
    type: EnumProperty(
        name="Type", description="Kind of structure", items=_TYPES, default="WEAVE", update=_forget_shape
    )
    size: FloatProperty(
        name="Size",
        description="Length of the sides of the tile",
        min=1e-6,
        default=0.002,
        subtype="DISTANCE",
        precision=5,
        options={"SKIP_SAVE"},
    )
    count: IntProperty(
        name="Count",
        description="Number of yarns, cords, rings, ribs, wales, fibers or cushions along a side."
        " Gravel: rough number of pebbles",
        min=1,
        max=170,
        default=4,
        options={"SKIP_SAVE"},
    )
    thickness: FloatProperty(
        name="Thickness",
        description="Thickness of a yarn, cord, wire, rib or cushion, as a share of the distance between"
        " neighbors. Gravel, velvet: depth of the bed or pile in pebbles or fibers",
        min=0.01,
        max=20.0,
        default=0.3,
        options={"SKIP_SAVE"},
    )
    gap: FloatProperty(
        name="Gap",
        description="Gap between neighbors, as a share of their distance",
        min=0.0,
        max=0.95,
        default=0.1,
        options={"SKIP_SAVE"},
    )
    irregularity: FloatProperty(
        name="Irregularity",
        description="Random deviation of the parts from their ideal shape",
        min=0.0,
        max=1.0,
        default=0.1,
        subtype="FACTOR",
        options={"SKIP_SAVE"},
    )
    resolution: IntProperty(
        name="Resolution",
        description="Number of points around a yarn, wire, pebble or rib. Must be even",
        min=6,
        max=256,
        default=16,
        step=2,
        options={"SKIP_SAVE"},
    )
    seed: IntProperty(name="Seed", description="Random seed of the deviations", min=0, options={"SKIP_SAVE"})

    @classmethod
    def poll(cls, context):
        return context.mode == "OBJECT"

    def draw(self, _context):
        layout = self.layout
        layout.use_property_split = True
        layout.prop(self, "type")
        taken = {"seed", *_own_shape(self.type)}
        column = layout.column(align=True)
        for name in _SHAPE:
            if name in taken:
                column.prop(self, name)
        for name in ("align", "location", "rotation"):
            layout.column().prop(self, name)

    def execute(self, context):
        unit = metres_per_unit(context.scene)
        try:
            with Tile.create(self.type, **self._given(unit)) as tile:
                info, mesh = tile.info(), tile.mesh()
        except VelourError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        worn_by = _wearer(context.object)
        name = next(label for key, label, *_ in _TYPES if key == self.type)
        data = _mesh_data(name, mesh, unit)
        for material in info["materials"]:
            data.materials.append(_material(name, material))
        obj = object_data_add(context, data, operator=self)
        obj.velour.is_tile = True
        obj.velour.target = worn_by
        obj.velour.period = [side / unit for side in info["period"]]
        self._fill_in(info["shape"], unit)
        return {"FINISHED"}

    def _given(self, unit):
        """Shape properties that were set, as keywords of Tile.create."""
        taken = {"seed", *_own_shape(self.type)}
        given = {n: getattr(self, n) for n in _SHAPE if n in taken and self.properties.is_property_set(n)}
        if "size" in given:
            given["size"] *= unit
        return given

    def _fill_in(self, shape, unit):
        """Sets the properties to the values used, for the Adjust Last Operation panel."""
        for name in {"seed", *_own_shape(self.type)}:
            setattr(self, name, shape[name] / unit if name == "size" else shape[name])


def _wearer(obj):
    """The object that a new tile is for: the selected one, unless it is a tile itself."""
    is_one = takes_materials(obj) and obj.select_get() and not obj.velour.is_shown()
    return obj if is_one else None


def _own_shape(kind):
    return next(k["defaults"] for k in Tile.kinds() if k["name"].upper() == kind)


def _mesh_data(name, mesh, unit):
    """Smooth mesh in Blender units, with a UV map and material slots."""
    faces = joined(mesh)
    data = bpy.data.meshes.new(name)
    data.from_pydata((mesh.positions / unit).tolist(), [], faces.corners)
    data.uv_layers.new(name="UVMap").data.foreach_set("uv", faces.uvs.ravel())
    data.polygons.foreach_set("material_index", faces.slots.astype(np.int32))
    data.polygons.foreach_set("use_smooth", np.ones(len(faces.slots), bool))
    data.update()
    return data


def _material(tile_name, values):
    """A Principled material; `values` as in the info of a tile."""
    material = bpy.data.materials.new(f"{tile_name} {values['name'].title()}")
    if material.node_tree is None:
        material.use_nodes = True
    node = next(n for n in material.node_tree.nodes if n.bl_idname == "ShaderNodeBsdfPrincipled")
    color = (*(rec709_to_working() @ values["base_color"]), 1.0)
    node.inputs["Base Color"].default_value = material.diffuse_color = color
    node.inputs["Metallic"].default_value = material.metallic = values["metallic"]
    node.inputs["Roughness"].default_value = material.roughness = values["roughness"]
    first_input(node, "Specular IOR Level", "Specular").default_value = values["specular"]
    return material
