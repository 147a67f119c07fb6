"""Color conversion between Blender's scene-linear space and the library's Rec. 709."""

import bpy
import numpy as np
from mathutils import Color

from ..core.srgb import decoded

_LINEAR_REC709 = {"Linear", "Linear Rec.709", "linear", "scene_linear", "Utility - Linear - sRGB"}
# Names that contain sRGB may as well be of tone-mapped spaces, such as Filmic sRGB.
_SRGB = {"sRGB", "sRGB - Texture", "Utility - sRGB - Texture", "sRGB OETF", "sRGB Encoded Rec.709 (sRGB)"}
_DATA = {"Non-Color", "Raw", "Generic Data"}
# Weights of linear Rec. 709 in Cycles; those of 5.0 are of other primaries in its configuration of colors.
_LUMINANCE = np.array(
    (0.212639, 0.715169, 0.072192) if bpy.app.version >= (5, 0) else (0.212673, 0.715152, 0.072175)
)


def rec709_to_working():
    """3 x 3 numpy matrix from linear Rec. 709 to Blender's scene-linear working space."""
    columns = [_to_scene_linear(primary) for primary in ((1, 0, 0), (0, 1, 0), (0, 0, 1))]
    return np.array(columns, np.float64).T


def working_to_rec709(color):
    """Converts a working-space color, with or without alpha, to a linear Rec. 709 triple."""
    matrix = rec709_to_working()
    if np.allclose(matrix, np.eye(3), atol=1e-4):  # up to Blender's rounding
        return tuple(color[:3])
    return tuple(float(c) for c in np.linalg.inv(matrix) @ np.array(color[:3]))


def rec709_color_to_working(color):
    """Converts a linear Rec. 709 triple to the working space: the inverse of working_to_rec709()."""
    matrix = rec709_to_working()
    if np.allclose(matrix, np.eye(3), atol=1e-4):  # up to Blender's rounding
        return tuple(color)
    return tuple(float(c) for c in matrix @ np.array(color))


def rec709_pixels_to_working(pixels):
    """Converts linear Rec. 709 [... x channels], with or without alpha, to Blender's scene-linear space."""
    rgb = pixels[..., :3] @ rec709_to_working().T.astype(np.float32)
    return np.concatenate((rgb, pixels[..., 3:]), axis=-1)


def set_working_space(scene):
    """Sets the working color space of the library's `scene` unless it is Rec. 709."""
    working = rec709_to_working()
    if not np.allclose(working, np.eye(3), atol=1e-6):
        scene.set_working_space(working.astype(np.float32))


def luminance_weights():
    """[3] float32 weights of the luminance of a working-space color."""
    return (_LUMINANCE @ np.linalg.inv(rec709_to_working())).astype(np.float32)


def is_linear_rec709(space_name):
    """Whether the named color space is linear Rec. 709 and that is also the working space."""
    return space_name in _LINEAR_REC709 and np.allclose(rec709_to_working(), np.eye(3), atol=1e-4)


def is_data(space_name):
    """Whether the named color space holds non-color data."""
    return space_name in _DATA


def is_srgb(space_name):
    """Whether the named color space is sRGB, which Cycles decodes after it has used alpha."""
    return space_name == "sRGB"


def bytes_to_working(pixels, space_name):
    """Working-space values of an 8-bit image's pixels [... x channels], which Blender returns undecoded.

    The second value is False if the color space is unknown and sRGB was assumed.
    """
    if is_data(space_name):
        return pixels, True
    rgb = pixels[..., :3]
    if space_name not in _LINEAR_REC709:
        rgb = decoded(rgb)
    pixels[..., :3] = rec709_pixels_to_working(rgb)
    return pixels, space_name in _LINEAR_REC709 | _SRGB


def _to_scene_linear(primary):
    color = Color(primary)
    convert = getattr(color, "from_rec709_linear_to_scene_linear", None)
    return tuple(convert() if convert else color)
