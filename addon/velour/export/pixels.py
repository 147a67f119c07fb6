"""The pixels of Blender's images, in the working space."""

from typing import NamedTuple

import bpy
import numpy as np

from .color import bytes_to_working, is_data, is_linear_rec709, is_srgb
from .picture_files import (
    float_pixels,
    has_own_file,
    is_gray,
    note_header,
    png_or_tiff_pixels,
    size_of,
    with_alpha,
)

# Cycles multiplies colors by alpha where the alpha mode says so; before, where the kind of values does.
_MODE_COUNTS = bpy.app.version >= (5, 2)


class _Stored(NamedTuple):
    """What Cycles starts from."""

    values: np.ndarray  # [height x width x 4] float32
    largest: int  # of integers, 0: floats
    is_encoded: bool  # not yet decoded from the image's color space
    is_straight: bool  # Cycles multiplies colors by alpha, if the alpha belongs to them


class Pixels(NamedTuple):
    """What Cycles interpolates."""

    values: np.ndarray  # [height x width x 4] float32, row 0 at the bottom
    srgb: bool  # interpolated colors are decoded from sRGB; else they are in the working space
    premultiplied: bool  # and divided by alpha before


def working_pixels(image, notes):
    """[height x width x 4] float32, row 0 at the bottom, for any image source; None if it has no pixels.

    Colors are multiplied by alpha, as in Cycles, unless the alpha is unrelated to them (channel packed, or
    data).
    """
    pixels = interpolated_pixels(image, notes)
    if pixels is not None and pixels.srgb:
        return bytes_to_working(pixels.values, image.colorspace_settings.name)[0]
    return pixels and pixels.values


def interpolated_pixels(image, notes, beside_alpha=False):
    """Pixels of any image source; None if it has none.

    `beside_alpha`: the image's alpha is used too, so Cycles divides colors by it.
    """
    size_of(image)  # refuses what Blender would wait for
    note_header(image, notes)
    space = image.colorspace_settings.name
    has_alpha = image.alpha_mode in ("STRAIGHT", "PREMUL") and not is_data(space)
    stored = _stored(image, has_alpha, notes)
    if stored is None:
        return None
    values = stored.values
    if image.alpha_mode == "NONE":
        values[..., 3] = 1
    if has_alpha and stored.is_straight:
        _multiply(values, stored.largest)
    divided = has_alpha and beside_alpha
    if not stored.is_encoded:
        return Pixels(values, False, divided)
    if is_srgb(space):
        return Pixels(values, True, divided)
    if divided:  # other spaces than sRGB are decoded before
        _divide(values)
    values, known = bytes_to_working(values, space)
    if not known:
        notes.add(f"Image '{image.name}': its color space '{space}' is not supported; read as sRGB.")
    return Pixels(values, False, False)


def multiplies_floats(image):
    """Whether Cycles multiplies the float colors of an image by alpha, if it belongs to them."""
    return _MODE_COUNTS and image.alpha_mode == "STRAIGHT"


def _stored(image, has_alpha, notes):
    """Blender returns float colors multiplied by alpha and byte colors divided by it, whatever is stored."""
    space = image.colorspace_settings.name
    of_file = float_pixels(image, notes)
    if of_file is not None:
        return _Stored(of_file, 0, is_srgb(space), multiplies_floats(image))
    multiplies_integers = image.alpha_mode == "STRAIGHT" or not _MODE_COUNTS
    needs_file = image.is_float or (has_alpha and (image.alpha_mode == "PREMUL" or is_gray(image)))
    knows_space = is_srgb(space) or is_linear_rec709(space) or is_data(space)
    of_file = png_or_tiff_pixels(image, notes) if needs_file and knows_space else None
    if of_file is not None:
        is_straight = of_file.is_straight
        if of_file.is_float:
            return _Stored(of_file.values, 0, is_srgb(space), multiplies_floats(image) or is_straight)
        largest = 65535 if image.is_float else 255
        return _Stored(of_file.values, largest, True, is_straight and multiplies_integers)
    values = _blender_pixels(image)
    if values is None:
        return None
    if not image.is_float:
        return _Stored(values, 255, True, multiplies_integers)
    return _Stored(values, 0, False, multiplies_floats(image) and not has_own_file(image))


def _blender_pixels(image):
    width, height = size_of(image)
    if width == 0 or height == 0:
        return None
    values = np.empty(width * height * image.channels, np.float32)
    image.pixels.foreach_get(values)
    return with_alpha(values.reshape(height, width, image.channels))


def _multiply(values, largest):
    color, alpha = values[..., :3], values[..., 3:]
    if largest:  # Cycles truncates the product
        whole = np.rint(largest * color.astype(np.float64)) * np.rint(largest * alpha.astype(np.float64))
        color[:] = np.floor(whole / largest) / largest
    else:
        color *= alpha


def _divide(values):
    color, alpha = values[..., :3], values[..., 3:]
    np.divide(color, alpha, out=color, where=alpha != 0)
