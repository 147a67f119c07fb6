"""Sizes on the screen."""


def button_height(system):
    """Height of a button in pixels, rounded as in Blender."""
    return round(18 * system.ui_scale) + 2 * int(system.pixel_size)
