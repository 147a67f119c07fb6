"""Passes of a view layer beyond Blender's own."""

import bpy
from bpy.props import BoolProperty


def _update_passes(settings, _context):
    """The compositor's sockets follow, as they follow Blender's own switches."""
    for layer in settings.id_data.view_layers:
        layer.update_render_passes()


def _switch(name, description):
    return BoolProperty(
        name=name,
        description=description,
        default=False,
        override={"LIBRARY_OVERRIDABLE"},
        update=_update_passes,
    )


class VelourLayerSettings(bpy.types.PropertyGroup):
    """`view_layer.velour`."""

    use_pass_denoising: _switch(
        "Denoising Data",
        "Denoising Normal and Denoising Albedo: what the compositor's Denoise node takes beside the picture",
    )
    use_pass_albedo: _switch(
        "Albedo", "The share of light that surfaces reflect towards the camera, from 0 to 1"
    )
    use_pass_error: _switch("Error", "The standard error of the picture's colours, pixel by pixel")
    use_pass_sample_count: _switch("Sample Count", "How many light directions each pixel received")
