"""Placement of a material's tiles, or of its anisotropy, on objects."""

import bpy
from bpy.props import EnumProperty, FloatProperty, FloatVectorProperty, StringProperty

from .changed import look_changed, uv_map_changed
from .look_settings import stored_or_input

_OVERRIDE = {"LIBRARY_OVERRIDABLE"}

MODES = (
    ("REPEATS", "Repeats", "Number of tiles per unit of texture coordinates", 0),
    (
        "REAL_SIZE",
        "Real Size",
        "Tiles in their real size, from the median density of the object's texture coordinates",
        1,
    ),
)
KEEP = ("KEEP", "Keep Size", "Scaling the object changes the number of tiles, not their size", 0)
STRETCH = ("STRETCH", "Stretch", "Tiles scale with the object", 1)


class VelourPlacementSettings(bpy.types.PropertyGroup):
    """`node.velour.placement`."""

    mode: EnumProperty(
        name="Placement",
        description="How the size of the tiles on objects is set",
        items=MODES,
        default="REPEATS",
        update=look_changed,
        override=_OVERRIDE,
    )
    repeats: FloatVectorProperty(
        name="Repeats",
        description="Number of tiles per unit of texture coordinates, along the tile's x and y axes",
        size=2,
        default=(1.0, 1.0),
        min=0.0001,
        soft_max=1000.0,
        max=1e6,
        update=look_changed,
        override=_OVERRIDE,
    )
    tile_size: FloatVectorProperty(
        name="Tile Size",
        description="Width and height of a tile in millimeters. 0: size stored in the BTF",
        size=2,
        default=(0.0, 0.0),
        min=0.0,
        max=1e9,
        precision=3,
        update=look_changed,
        override=_OVERRIDE,
    )
    uv_density: FloatVectorProperty(
        name="UV Density",
        description="Texture coordinates per meter along u and v, without the object's scale. Set it for"
        " deforming meshes, where tiles would creep. 0: measured on each object in each frame",
        size=2,
        default=(0.0, 0.0),
        min=0.0,
        max=1e9,
        precision=3,
        update=look_changed,
        override=_OVERRIDE,
    )
    uv_map: StringProperty(
        name="UV Map",
        description="Name of the UV map that places the material. Empty: the active render UV map",
        update=uv_map_changed,
        override=_OVERRIDE,
    )
    rotation: FloatProperty(
        name="Rotation",
        description="Counterclockwise rotation of the tiles, or of the direction of anisotropy",
        subtype="ANGLE",
        default=0.0,
        update=look_changed,
        override=_OVERRIDE,
        **stored_or_input("rotation", 0.0),
    )
    offset: FloatVectorProperty(
        name="Offset",
        description="Texture coordinates of the lower left corner of the first tile",
        size=2,
        default=(0.0, 0.0),
        update=look_changed,
        override=_OVERRIDE,
    )
    # Each mode has its own default: real sizes must not stretch with the object, repeats should.
    real_size_scale: EnumProperty(
        name="Object Scale",
        description="Effect of the object's scale on tiles in real size",
        items=(KEEP, STRETCH),
        default="KEEP",
        update=look_changed,
        override=_OVERRIDE,
    )
    repeats_scale: EnumProperty(
        name="Object Scale",
        description="Effect of the object's scale on repeats",
        items=(KEEP, STRETCH),
        default="STRETCH",
        update=look_changed,
        override=_OVERRIDE,
    )

    @property
    def scale_property(self):
        """The name of the mode's property for the scale of objects."""
        return {"REPEATS": "repeats_scale", "REAL_SIZE": "real_size_scale"}[self.mode]

    @property
    def keeps_size(self):
        return getattr(self, self.scale_property) == "KEEP"

    def tile_metres(self, own):
        """Width and height of a tile in meters: the entered ones, or else `own`, the BTF's or None."""
        entered = tuple(1e-3 * side for side in self.tile_size)
        return entered if min(entered) > 0 else own

    def density(self, measured=(1.0, 1.0)):
        """UV density without the object's scale, 1/m: the entered one, or else `measured`. Without an object,
        as in nodes for other engines, a unit of texture coordinates is a meter."""
        return tuple(self.uv_density) if min(self.uv_density) > 0 else tuple(measured)
