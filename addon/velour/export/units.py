"""Blender's units of length in metres."""


def metres_per_unit(scene):
    """Of coordinates. Without a unit system a unit is a metre, as to Blender's exporters."""
    units = scene.unit_settings
    return 1.0 if units.system == "NONE" else units.scale_length
