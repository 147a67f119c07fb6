"""Settings of an object or a collection as one tile of a mesostructure."""

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
    ("AUTOMATIC", "Automatic", "Both sides if light can pass through the tile, otherwise the front", 0),
    ("ONE", "Front", "Seen and lit from above only", 1),
    ("TWO", "Both", "Seen and lit from above and below", 2),
)
_OVERRIDABLE = {"LIBRARY_OVERRIDABLE"}


def _takes_material(settings, obj):
    return hasattr(obj.data, "materials") and obj != settings.id_data


class VelourTileSettings(BtfFitSettings, bpy.types.PropertyGroup):
    """`object.velour`, `collection.velour`; includes the settings of the BTF fit."""

    saved_by: saved_by()
    is_tile: BoolProperty(
        name="Mesostructure",
        description="Show the settings of a mesostructure: one tile, its capture as a BTF and its material",
        override=_OVERRIDABLE,
    )
    period: FloatVectorProperty(
        name="Period",
        size=2,
        min=0.0,
        subtype="XYZ",
        unit="LENGTH",
        description="Distance after which the structure repeats along its x and y axes. Geometry beyond the"
        " border of the tile is kept and overlaps the next tile. 0: size of the bounding box",
        update=period_changed,
        override=_OVERRIDABLE,
    )
    is_repeat: BoolProperty(
        name="Repeat",
        description="Copy that shows the repeated tile. Never captured",
        options={"HIDDEN"},
        override=_OVERRIDABLE,
    )

    def is_shown(self):
        """Whether its panel is shown: on request, or because settings of a tile have been made."""
        return self.is_tile or any(self.period) or bool(self.directory) or self.material is not None

    # Marks of jobs with results for the tile, separated by blanks.
    jobs: StringProperty(options={"HIDDEN", "SKIP_SAVE"})

    # Settings of a capture. Smaller than the library's, so that a first cloth takes minutes.
    directory: StringProperty(
        name="Folder",
        description="Output folder of the capture. Empty: next to the .blend file, named after the tile",
        subtype="DIR_PATH",
        override=_OVERRIDABLE,
    )
    texels: IntProperty(
        name="Texels",
        description="Number of texels along each side",
        min=1,
        max=4096,
        default=64,
        override=_OVERRIDABLE,
    )
    views: IntProperty(
        name="Views",
        description="Number of view directions. 81: rings up to 75 degrees, as in measured BTFs; 105: also a"
        " ring at 85 degrees; other numbers: spread evenly over the hemisphere",
        min=1,
        max=4096,
        default=81,
        override=_OVERRIDABLE,
    )
    lights: IntProperty(
        name="Lights",
        description="Number of light directions, which are placed like the views",
        min=1,
        max=4096,
        default=81,
        override=_OVERRIDABLE,
    )
    samples: IntProperty(
        name="Samples",
        description="Number of paths per texel and view",
        min=1,
        max=65536,
        default=8,
        override=_OVERRIDABLE,
    )
    bounces: IntProperty(
        name="Bounces",
        description="Maximum number of light bounces within the tile. 0: direct light only",
        min=0,
        max=64,
        default=1,
        override=_OVERRIDABLE,
    )
    sides: EnumProperty(
        name="Sides",
        description="Sides of the tile that are captured",
        items=SIDES,
        default="ONE",
        override=_OVERRIDABLE,
    )
    use_approximate: BoolProperty(
        name="Approximate",
        description="Also capture materials that Velour can only approximate",
        override=_OVERRIDABLE,
    )
    held_out: IntProperty(
        name="Held-Out Pairs",
        description="Number of view-light pairs to capture in addition to the BTF. They are not fitted, but"
        " measure the error between the fitted directions. 0: none",
        min=0,
        max=4096,
        default=0,
        override=_OVERRIDABLE,
    )

    material: PointerProperty(
        name="Material",
        description="Material that was last made from the tile's BTF",
        type=bpy.types.Material,
        override=_OVERRIDABLE,
    )
    target: PointerProperty(
        name="Target",
        description="Object that gets the material of the tile. Empty: all other selected objects",
        type=bpy.types.Object,
        poll=_takes_material,
        override=_OVERRIDABLE,
    )
