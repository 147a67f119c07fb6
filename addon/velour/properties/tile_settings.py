"""What makes an object, or a collection, one tile of a mesostructure."""

import bpy
from bpy.props import (
    BoolProperty,
    EnumProperty,
    FloatVectorProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)

from .btf_fit_settings import BtfFitSettings
from .changed import period_changed
from .saved_by import saved_by

SIDES = (
    ("AUTOMATIC", "As Needed", "Both where light can pass through the tile", 0),
    ("ONE", "Front", "Seen and lit from above alone", 1),
    ("TWO", "Both", "Seen and lit from above and from below", 2),
)
_OVERRIDABLE = {"LIBRARY_OVERRIDABLE"}


class VelourTileSettings(BtfFitSettings, bpy.types.PropertyGroup):
    """`object.velour`, `collection.velour`; with what a material of the tile is asked for."""

    saved_by: saved_by()
    period: FloatVectorProperty(
        name="Period",
        size=2,
        min=0.0,
        subtype="XYZ",
        unit="LENGTH",
        description="After this distance along its own x and y the structure repeats. What crosses the border"
        " of the tile is there once and sticks out. 0: the size of its bounding box along that axis",
        update=period_changed,
        override=_OVERRIDABLE,
    )
    is_repeat: BoolProperty(
        name="Is a Repeat",
        description="A copy that shows how a tile goes on; never captured",
        options={"HIDDEN"},
        override=_OVERRIDABLE,
    )

    # Marks of those whose results come here, with blanks between.
    jobs: StringProperty(options={"HIDDEN", "SKIP_SAVE"})

    # What a capture is asked for.
    directory: StringProperty(
        name="Folder",
        description="Where the capture goes; empty: beside the .blend, under the tile's name",
        subtype="DIR_PATH",
        override=_OVERRIDABLE,
    )
    texels: IntProperty(
        name="Texels", description="Along each side", min=1, max=4096, default=128, override=_OVERRIDABLE
    )
    views: IntProperty(
        name="Views",
        description="Directions it is seen from. 81: rings to 75 degrees, as measured sets have; 105: also a"
        " ring at 85 degrees; other numbers: spread evenly over the hemisphere",
        min=1,
        max=4096,
        default=105,
        override=_OVERRIDABLE,
    )
    lights: IntProperty(
        name="Lights",
        description="Directions it is lit from; numbers as of the views",
        min=1,
        max=4096,
        default=105,
        override=_OVERRIDABLE,
    )
    samples: IntProperty(
        name="Samples",
        description="Paths a texel and view",
        min=1,
        max=65536,
        default=16,
        override=_OVERRIDABLE,
    )
    bounces: IntProperty(
        name="Bounces",
        description="Of light within the tile; 0: direct light only",
        min=0,
        max=64,
        default=1,
        override=_OVERRIDABLE,
    )
    sides: EnumProperty(name="Sides", items=SIDES, default="AUTOMATIC", override=_OVERRIDABLE)
    use_approximate: BoolProperty(
        name="Approximate",
        description="Also capture materials that Velour does not render as they are",
        override=_OVERRIDABLE,
    )
    held_out: IntProperty(
        name="Pairs to Judge By",
        description="So many pairs of a view and a light are captured beside the BTF, where no model looks:"
        " they tell how well a model does between the directions it was fitted to. 0: none",
        min=0,
        max=4096,
        default=0,
        override=_OVERRIDABLE,
    )

    model: PointerProperty(
        name="Model",
        description="That was made of the tile last",
        type=bpy.types.Image,
        override=_OVERRIDABLE,
    )
