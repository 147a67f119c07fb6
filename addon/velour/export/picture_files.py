"""Files of Blender's images that the library, like Cycles, reads itself; notes on unsupported headers."""

import os
import struct
from typing import NamedTuple

import numpy as np

from ..core.srgb import encoded
from ..core.warning_table import sentences
from ..native import VelourError, images
from ..native.errors import refuse
from .color import is_data, is_linear_rec709, is_srgb
from .files import absolute_path

_FLOATS = (".exr", ".hdr")
_TIFF = (".tif", ".tiff")
# Tags of TIFF files, and one value of each.
_EXTRA_SAMPLES, _UNASSOCIATED_ALPHA = 338, 2
_SAMPLE_FORMAT, _FLOAT = 339, 3


def linear_file(image):
    """Path of a file whose values are in the working space; None: use Blender's pixels.

    Cycles reads such files itself, too. Blender's reader supports neither lowercase channel names nor files
    with passes, and reorients Radiance images that Cycles shows as stored.
    """
    is_read = has_own_file(image, _FLOATS) and is_linear_rec709(image.colorspace_settings.name)
    return _own_file(image) if is_read else None


def float_pixels(image, notes):
    """[height x width x 4] float32 of an OpenEXR or Radiance file, row 0 at the bottom, as stored.

    None: use Blender's pixels. Raises VelourError if Blender has none either.
    """
    space = image.colorspace_settings.name
    if not has_own_file(image, _FLOATS) or not (is_linear_rec709(space) or is_data(space) or is_srgb(space)):
        return None
    try:
        return with_alpha(_read(image, notes))
    except VelourError:
        if size_of(image)[0] == 0:
            raise
        return None


def _read(image, notes):
    """The pixels of the image's file as stored; notes values that are not finite, which are replaced."""
    values = images.read_picture(_own_file(image), as_stored=True)
    replaced = [each for each in images.read_warnings() if each["code"] in ("infinite_values", "nan_values")]
    for sentence in sentences(replaced):
        notes.add(f"Image '{image.name}': {sentence}")
    return values


class FilePixels(NamedTuple):
    """The pixels of a PNG or TIFF file as stored."""

    values: np.ndarray  # [height x width x 4] float32, row 0 at the bottom
    is_float: bool  # otherwise integers, divided by their largest value
    is_straight: bool  # Cycles multiplies the colors by alpha if the image's settings say so


def is_gray(image):
    """Whether an image's PNG or TIFF file has no colors."""
    if not has_own_file(image, (".png", *_TIFF)):
        return False
    try:
        return images.picture_size(_own_file(image), as_stored=True)[2] < 3
    except VelourError:
        return False


def png_or_tiff_pixels(image, notes):
    """FilePixels of a PNG or TIFF file; None: use Blender's pixels.

    Blender 3.4 shows TIFF files of 16 bits and of floats wrongly. Cycles never multiplies gray by alpha.
    """
    is_tiff = has_own_file(image, _TIFF)
    if not is_tiff and not has_own_file(image, ".png"):
        return None
    path = _own_file(image)
    try:
        stored = _read(image, notes)
        tags = _tiff_tags(path) if is_tiff else {}
    except (VelourError, OSError, struct.error, KeyError):
        return None
    values, is_float = with_alpha(stored), tags.get(_SAMPLE_FORMAT) == _FLOAT
    if not is_float:
        values[..., :3] = encoded(values[..., :3])  # the library decodes sRGB, whatever the space is
    is_straight = stored.shape[2] == 4 and (not is_tiff or tags.get(_EXTRA_SAMPLES) == _UNASSOCIATED_ALPHA)
    return FilePixels(values, is_float, is_straight)


def _tiff_tags(path):
    """{tag: first value} of the tags of the first directory that hold 16-bit values.

    Raises KeyError, OSError or struct.error for a file that is no TIFF or a BigTIFF.
    """
    with open(path, "rb") as file:
        order = {b"II": "<", b"MM": ">"}[file.read(2)]
        version, offset = struct.unpack(order + "HI", file.read(6))
        if version != 42:
            raise struct.error("BigTIFF")
        file.seek(offset)
        (count,) = struct.unpack(order + "H", file.read(2))
        entries = [struct.unpack(order + "HHII", file.read(12)) for _ in range(count)]
        tags = {}
        for tag, kind, values, place in entries:
            if kind != 3:
                continue
            if values <= 2:  # stored in the place of the offset
                tags[tag] = struct.unpack(order + "HH", struct.pack(order + "I", place))[0]
            else:
                file.seek(place)
                (tags[tag],) = struct.unpack(order + "H", file.read(2))
        return tags


def size_of(image):
    """Width and height of an image; 0 if it cannot be read. Raises VelourError for pipes and devices.

    Blender itself would wait for a pipe's writer.
    """
    if image.source == "FILE" and image.packed_file is None and not image.has_data:
        path = absolute_path(image)
        if os.path.exists(path) and not os.path.isfile(path):
            raise refuse(f"image '{image.name}': '{path}' is not a regular file; choose a file.")
    return tuple(image.size)


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
