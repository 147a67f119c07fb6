"""Files of Blender's images that the library, like Cycles, reads itself; notes on unsupported headers."""

import os

import numpy as np

from ..core.srgb import encoded
from ..core.warning_table import sentences
from ..native import VelourError, images
from .color import is_data, is_linear_rec709, is_srgb
from .files import absolute_path

_FLOATS = (".exr", ".hdr")


def linear_file(image):
    """Path of a file whose values are in the working space; None: use Blender's pixels.

    Cycles reads such files itself, too. Blender's reader supports neither lowercase channel names nor files
    with passes, and reorients Radiance images that Cycles shows as stored.
    """
    is_read = has_own_file(image, _FLOATS) and is_linear_rec709(image.colorspace_settings.name)
    return _own_file(image) if is_read else None


def float_pixels(image):
    """[height x width x 4] float32 of an OpenEXR or Radiance file, row 0 at the bottom, as stored.

    None: use Blender's pixels. Raises VelourError if Blender has none either.
    """
    space = image.colorspace_settings.name
    if not has_own_file(image, _FLOATS) or not (is_linear_rec709(space) or is_data(space) or is_srgb(space)):
        return None
    try:
        return with_alpha(images.read_picture(_own_file(image), as_stored=True))
    except VelourError:
        if image.size[0] == 0:
            raise
        return None


def png_pixels(image):
    """[height x width x 4] float32 of a PNG file as stored, row 0 at the bottom; None: there is none."""
    if not has_own_file(image, ".png"):
        return None
    try:
        values = with_alpha(images.read_picture(_own_file(image), as_stored=True))
    except VelourError:
        return None
    values[..., :3] = encoded(values[..., :3])  # the library decodes sRGB, whatever the space is
    return values


def note_header(image, notes):
    """Notes header fields that Blender ignores, and parts of the file that are left out."""
    path = _own_file(image)
    if path is None:
        return
    try:
        found = images.picture_warnings(path, as_stored=True)
    except VelourError:
        return  # reported when the pixels are read, unless Blender can read them
    is_read_as_srgb = is_srgb(image.colorspace_settings.name)
    noted = [each for each in found if is_read_as_srgb or each["code"] != "color_space_ignored"]
    for sentence in sentences(noted):
        notes.add(f"Image '{image.name}': {sentence}")


def has_own_file(image, endings=("",)):
    """Whether Cycles reads the image's file itself, and its name has one of the endings."""
    path = _own_file(image)
    return path is not None and not image.is_dirty and path.lower().endswith(endings)


def _own_file(image):
    if image.source != "FILE" or image.packed_file is not None:
        return None
    path = absolute_path(image)
    return path if os.path.isfile(path) else None


def with_alpha(values):
    """Expands gray to RGB, and adds an alpha of 1 if there is none."""
    channels = values.shape[2]
    if channels == 4:
        return values
    opaque = np.ones((*values.shape[:2], 4), np.float32)
    opaque[..., :3] = values[..., :3] if channels == 3 else values[..., :1]
    if channels == 2:
        opaque[..., 3] = values[..., 1]
    return opaque
