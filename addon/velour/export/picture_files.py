"""Picture files behind Blender's images: those that the library reads itself, as Cycles does, and what their
headers say that neither follows."""

import os

import numpy as np

from ..native import VelourError, images
from .color import is_data, is_linear_rec709
from .files import absolute_path

_FLOATS = (".exr", ".hdr")


def linear_file(image):
    """The path of a file whose numbers are those of the working space; None: Blender's pixels are taken.

    Cycles reads the file itself, too. Blender's own reader knows neither channels in small letters nor files
    with passes, and turns Radiance pictures that Cycles shows as they are stored.
    """
    path = _own_file(image)
    if path is None or image.is_dirty or not path.lower().endswith(_FLOATS):
        return None
    return path if is_linear_rec709(image.colorspace_settings.name) else None


def file_pixels(image):
    """[height x width x 4] float32 of an OpenEXR or Radiance file, row 0 at the bottom, alpha multiplied in.

    None where Blender's pixels are to be taken. Raises VelourError where Blender has none either.
    """
    path = _own_file(image)
    space = image.colorspace_settings.name
    if path is None or image.is_dirty or not path.lower().endswith(_FLOATS):
        return None
    if not (is_linear_rec709(space) or is_data(space)):
        return None
    try:
        return with_alpha(images.read_picture(path, as_stored=True))
    except VelourError:
        if image.size[0] == 0:
            raise
        return None


def note_header(image, notes):
    """What the file's header says that Blender does not follow, and what of the file is left out."""
    path = _own_file(image)
    if path is None:
        return
    try:
        found = images.picture_notes(path, as_stored=True)
    except VelourError:
        return  # said where its pixels are read, if nobody else can
    for sentence in found:
        notes.add(f"Image '{image.name}': {sentence}")


def _own_file(image):
    if image.source != "FILE" or image.packed_file is not None:
        return None
    path = absolute_path(image)
    return path if os.path.isfile(path) else None


def with_alpha(values):
    """Gray three times, with an alpha of 1 where there is none."""
    channels = values.shape[2]
    if channels == 4:
        return values
    opaque = np.ones((*values.shape[:2], 4), np.float32)
    opaque[..., :3] = values[..., :3] if channels == 3 else values[..., :1]
    if channels == 2:
        opaque[..., 3] = values[..., 1]
    return opaque
