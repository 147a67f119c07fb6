"""Passes of a view layer beyond Blender's own."""

import bpy
from bpy.props import BoolProperty


def _update_passes(settings, _context):
    """Updates the compositor's sockets, as Blender's own switches do."""
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
        "Denoising Normal and Denoising Albedo passes, inputs of the compositor's Denoise node",
    )
    use_pass_albedo: _switch("Albedo", "Share of light that surfaces reflect toward the camera, from 0 to 1")
    use_pass_error: _switch("Error", "Standard error of the color of each pixel")
    use_pass_sample_count: _switch("Sample Count", "Number of light directions sampled in each pixel")
