"""The pixels of Blender's images, in the working space."""

import numpy as np

from .color import bytes_to_working, is_data
from .picture_files import file_pixels, note_header, with_alpha


def working_pixels(image, notes, beside_alpha=False):
    """[height x width x 4] float32, row 0 at the bottom, for any image source; None if it has no pixels.

    Colors are multiplied by alpha, as in Cycles, unless the alpha is unrelated to them (channel packed, or
    data). `beside_alpha`: the image's alpha is used too, so colors are not multiplied.
    """
    note_header(image, notes)
    of_file = file_pixels(image)
    values = _blender_pixels(image) if of_file is None else of_file
    if values is None:
        return None
    is_float = of_file is not None or image.is_float
    space = image.colorspace_settings.name
    if image.alpha_mode == "NONE":
        values[..., 3] = 1
    elif image.alpha_mode != "CHANNEL_PACKED" and not is_data(space):
        _apply_alpha(values, is_float, beside_alpha)
    if not is_float:
        values, known = bytes_to_working(values, space)
        if not known:
            notes.add(f"Image '{image.name}': its color space '{space}' is not supported; read as sRGB.")
    return values


def _blender_pixels(image):
    width, height = image.size
    if width == 0 or height == 0:
        return None
    values = np.empty(width * height * image.channels, np.float32)
    image.pixels.foreach_get(values)
    return with_alpha(values.reshape(height, width, image.channels))


def _apply_alpha(values, is_float, beside_alpha):
    """Blender returns float colors premultiplied by alpha, and byte colors unmultiplied.

    Cycles multiplies the stored bytes and truncates the result.
    """
    color, alpha = values[..., :3], values[..., 3:]
    if is_float and beside_alpha:
        np.divide(color, alpha, out=color, where=alpha != 0)
    elif not is_float and not beside_alpha:
        color[:] = np.floor(np.rint(255 * color) * np.rint(255 * alpha) / 255) / 255
