"""Sizes on the screen."""


def button_height(system):
    """Pixels, as Blender rounds them."""
    return round(18 * system.ui_scale) + 2 * int(system.pixel_size)
