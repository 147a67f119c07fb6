"""How a material lies on the objects that show it: its tiles, or what is anisotropic."""

import bpy
from bpy.props import EnumProperty, FloatProperty, FloatVectorProperty, StringProperty

from .changed import look_changed

_OVERRIDE = {"LIBRARY_OVERRIDABLE"}

MODES = (
    ("REPEATS", "Repeats", "So many tiles over a unit of the texture coordinates", 0),
    (
        "REAL_SIZE",
        "Real Size",
        "Tiles as large as they are, by the median density of the object's texture coordinates",
        1,
    ),
)
KEEP = ("KEEP", "Keeps Size", "Tiles keep their size when the object is scaled: there are more of them", 0)
STRETCH = ("STRETCH", "Stretches", "Tiles are scaled with the object", 1)


class VelourPlacementSettings(bpy.types.PropertyGroup):
    """`node.velour.placement`."""

    mode: EnumProperty(
        name="Placement",
        description="How large the tiles of the BTF are on objects",
        items=MODES,
        default="REPEATS",
        update=look_changed,
        override=_OVERRIDE,
    )
    repeats: FloatVectorProperty(
        name="Repeats",
        description="Tiles over a unit of the texture coordinates, along the tile's own x and y",
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
        description="Width and height of a tile in millimetres. 0: as the BTF says",
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
        description="How much texture coordinates grow a metre along u and v, on objects without their scale."
        " 0: measured on each object in each frame. Give it where a mesh deforms, or tiles would creep",
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
        description="Of the objects that show the material. Empty: the one that renders",
        update=look_changed,
        override=_OVERRIDE,
    )
    rotation: FloatProperty(
        name="Rotation",
        description="Turns tiles, and the direction that the material has, counter-clockwise",
        subtype="ANGLE",
        default=0.0,
        update=look_changed,
        override=_OVERRIDE,
    )
    offset: FloatVectorProperty(
        name="Offset",
        description="Texture coordinates of the first tile's lower left corner",
        size=2,
        default=(0.0, 0.0),
        update=look_changed,
        override=_OVERRIDE,
    )
    # Each mode has its own: a real size that a scale stretches is none, repeats are of the object as it is.
    real_size_scale: EnumProperty(
        name="Object Scale",
        description="What scaling an object does to tiles of real size",
        items=(KEEP, STRETCH),
        default="KEEP",
        update=look_changed,
        override=_OVERRIDE,
    )
    repeats_scale: EnumProperty(
        name="Object Scale",
        description="What scaling an object does to repeats",
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
