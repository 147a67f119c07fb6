"""Blender's units of length in meters."""


def metres_per_unit(scene):
    """Meters per unit of coordinates; 1 without a unit system, as in Blender's exporters."""
    units = scene.unit_settings
    return 1.0 if units.system == "NONE" else units.scale_length
