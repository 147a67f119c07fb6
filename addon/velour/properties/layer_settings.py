"""Passes of a view layer beyond Blender's own."""

import bpy
from bpy.props import BoolProperty


class VelourLayerSettings(bpy.types.PropertyGroup):
    """`view_layer.velour`."""

    use_pass_sample_count: BoolProperty(
        name="Sample Count",
        description="How many light directions each pixel received",
        default=False,
        override={"LIBRARY_OVERRIDABLE"},
    )
