"""What makes an object, or a collection, one tile of a mesostructure."""

import bpy
from bpy.props import BoolProperty, FloatVectorProperty


class VelourTileSettings(bpy.types.PropertyGroup):
    """`object.velour`, `collection.velour`."""

    period: FloatVectorProperty(
        name="Period",
        size=2,
        min=0.0,
        subtype="XYZ",
        unit="LENGTH",
        description="After this distance along its own x and y the structure repeats. What crosses the border"
        " of the tile is there once and sticks out. 0: the size of its bounding box",
        override={"LIBRARY_OVERRIDABLE"},
    )
    is_repeat: BoolProperty(
        name="Is a Repeat",
        description="A copy that shows how a tile goes on; never captured",
        options={"HIDDEN"},
        override={"LIBRARY_OVERRIDABLE"},
    )
