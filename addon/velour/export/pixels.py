"""The pixels of Blender's images, in the working space."""

import numpy as np

from .color import bytes_to_working, is_data
from .picture_files import file_pixels, note_header, with_alpha


def working_pixels(image, notes, beside_alpha=False):
    """[height x width x 4] float32, row 0 at the bottom, whatever the image comes from; None: it has none.

    Colours are multiplied by alpha, as in Cycles, unless the image's alpha is none of theirs (a mask in a
    channel, or data); `beside_alpha`: of an image whose alpha is looked at too they are not.
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
            notes.add(f"Image '{image.name}': its colour space '{space}' is read as sRGB.")
    return values


def _blender_pixels(image):
    width, height = image.size
    if width == 0 or height == 0:
        return None
    values = np.empty(width * height * image.channels, np.float32)
    image.pixels.foreach_get(values)
    return with_alpha(values.reshape(height, width, image.channels))


def _apply_alpha(values, is_float, beside_alpha):
    """Blender has colours of floats multiplied by alpha, those of bytes not.

    Cycles multiplies bytes as they are stored, and drops what is less than one.
    """
    color, alpha = values[..., :3], values[..., 3:]
    if is_float and beside_alpha:
        np.divide(color, alpha, out=color, where=alpha != 0)
    elif not is_float and not beside_alpha:
        color[:] = np.floor(np.rint(255 * color) * np.rint(255 * alpha) / 255) / 255
