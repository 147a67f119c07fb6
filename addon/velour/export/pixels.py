"""The pixels of Blender's images, in the working space."""

from typing import NamedTuple

import bpy
import numpy as np

from .color import bytes_to_working, is_data, is_srgb, to_srgb
from .picture_files import file_pixels, has_own_file, is_png, note_header, with_alpha

_MODE_COUNTS = bpy.app.version >= (5, 2)  # Cycles multiplies by the alpha mode; before, by the kind of values


class _Stored(NamedTuple):
    """What Cycles starts from."""

    values: np.ndarray  # [height x width x 4] float32
    is_encoded: bool  # not yet decoded from the image's color space
    is_straight: bool  # Cycles multiplies colors by alpha, if the alpha belongs to them


def working_pixels(image, notes, beside_alpha=False):
    """[height x width x 4] float32, row 0 at the bottom, for any image source; None if it has no pixels.

    Colors are multiplied by alpha, as in Cycles, unless the alpha is unrelated to them (channel packed, or
    data). `beside_alpha`: the image's alpha is used too, so Cycles divides by it afterwards.
    """
    note_header(image, notes)
    space = image.colorspace_settings.name
    has_alpha = image.alpha_mode in ("STRAIGHT", "PREMUL") and not is_data(space)
    stored = _stored(image, has_alpha)
    if stored is None:
        return None
    values = stored.values
    if image.alpha_mode == "NONE":
        values[..., 3] = 1
    if has_alpha and stored.is_straight:
        _multiply(values, not image.is_float)
    if has_alpha and beside_alpha:
        _divide(values)
    if stored.is_encoded:
        values, known = bytes_to_working(values, space)
        if not known:
            notes.add(f"Image '{image.name}': its color space '{space}' is not supported; read as sRGB.")
    return values


def _stored(image, has_alpha):
    is_straight = image.alpha_mode == "STRAIGHT"
    is_srgb_space = is_srgb(image.colorspace_settings.name)
    of_file = file_pixels(image)
    if of_file is not None:
        return _Stored(of_file, is_srgb_space, is_straight and _MODE_COUNTS)
    values = _blender_pixels(image)
    if values is None:
        return None
    # Blender returns float colors multiplied by alpha, and byte colors divided, whatever the file has.
    if not image.is_float:
        if has_alpha and not is_straight and has_own_file(image):
            values[..., :3] = np.rint(255 * values[..., :3] * values[..., 3:]) / 255
        return _Stored(values, True, is_straight or not _MODE_COUNTS)
    if not has_own_file(image):
        return _Stored(values, False, is_straight and _MODE_COUNTS)
    if not (has_alpha and is_png(image)):
        return _Stored(values, False, False)
    if is_srgb_space:  # Cycles multiplies before it decodes
        _divide(values)
        values[..., :3] = to_srgb(values[..., :3])
        _multiply(values)
    return _Stored(values, is_srgb_space, not (is_straight or _MODE_COUNTS))


def _blender_pixels(image):
    width, height = image.size
    if width == 0 or height == 0:
        return None
    values = np.empty(width * height * image.channels, np.float32)
    image.pixels.foreach_get(values)
    return with_alpha(values.reshape(height, width, image.channels))


def _multiply(values, are_bytes=False):
    color, alpha = values[..., :3], values[..., 3:]
    if are_bytes:  # Cycles truncates the product
        color[:] = np.floor(np.rint(255 * color) * np.rint(255 * alpha) / 255) / 255
    else:
        color *= alpha


def _divide(values):
    color, alpha = values[..., :3], values[..., 3:]
    np.divide(color, alpha, out=color, where=alpha != 0)
