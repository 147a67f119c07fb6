"""The pixels of Blender's images, in the working space."""

import numpy as np

from .color import bytes_to_working


def working_pixels(image, notes):
    """[height x width x 4] float32, row 0 at the bottom, whatever the image comes from; None: it has none."""
    width, height = image.size
    if width == 0 or height == 0:
        return None
    values = np.empty(width * height * image.channels, np.float32)
    image.pixels.foreach_get(values)
    values = _four_channels(values.reshape(height, width, image.channels))
    if not image.is_float:
        space = image.colorspace_settings.name
        values, known = bytes_to_working(values, space)
        if not known:
            notes.add(f"Image '{image.name}': its colour space '{space}' is read as sRGB.")
    return values


def _four_channels(values):
    """Grey thrice, with an alpha of 1 where there is none."""
    channels = values.shape[2]
    if channels == 4:
        return values
    opaque = np.ones((*values.shape[:2], 4), np.float32)
    opaque[..., :3] = values[..., :3] if channels == 3 else values[..., :1]
    if channels == 2:
        opaque[..., 3] = values[..., 1]
    return opaque
