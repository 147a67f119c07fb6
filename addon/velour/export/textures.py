"""Images of materials as the library's textures."""

import numpy as np

from ..native import Texture, TextureSlot, VelourError
from .color import luminance_weights, rec709_to_working
from .files import FIND, absolute_path
from .pixels import Pixels, interpolated_pixels

# What Cycles shows in place of an image that is missing.
_MAGENTA = Pixels(np.array((((1.0, 0.0, 1.0, 1.0),),), np.float32), srgb=False, premultiplied=False)


class TextureTable:
    """Creates each texture once."""

    def __init__(self, scene, notes):
        self._scene = scene
        self._notes = notes
        self._textures = {}

    def slot(self, picture, is_color, owner, uv_maps):
        """TextureSlot of a Picture for a material's UvMaps; magenta, with a note, if it cannot be read."""
        number = uv_maps.number(picture.coordinates)
        return TextureSlot(self.texture(picture, is_color, owner), picture.uv_map, number)

    def texture(self, picture, is_color, owner):
        """The Texture of a Picture, as slot()."""
        channels = (picture.alpha, picture.beside_alpha, is_color)
        image = picture.image.as_pointer() if picture.image else None
        key = (image, *channels, picture.wrap, picture.filter)
        if key not in self._textures:
            pixels = picture.image and self._read(picture, owner)
            self._textures[key] = self._created(pixels or _MAGENTA, picture, is_color)
        return self._textures[key]

    def of_corners(self, color_set):
        """TextureSlot of a set of corner colors."""
        if color_set not in self._textures:
            self._textures[color_set] = Texture.of_corners(color_set)
        return TextureSlot(self._textures[color_set])

    def _read(self, picture, owner):
        """The image's Pixels; None, with a note, if it cannot be read."""
        name = picture.image.name
        try:
            pixels = interpolated_pixels(picture.image, self._notes, picture.beside_alpha)
        except VelourError as error:
            self._notes.add(f"{owner}: image '{name}' is replaced by magenta, as in Cycles: {error}")
            return None
        if pixels is None:
            path = absolute_path(picture.image) or "no file"
            self._notes.add(
                f"{owner}: image '{name}' ({path}) cannot be read and is replaced by magenta, as in Cycles;"
                f" {FIND}."
            )
        return pixels

    def _created(self, pixels, picture, is_color):
        options = {"wrap": picture.wrap, "filter": picture.filter, "channel": -1 if is_color else 0}
        if picture.alpha:
            return self._scene.texture(np.ascontiguousarray(pixels.values[..., 3:]), **options)
        if not (pixels.srgb or pixels.premultiplied or is_color):
            number = pixels.values[..., :3] @ luminance_weights()
            return self._scene.texture(np.ascontiguousarray(number[..., None], np.float32), **options)
        colors = rec709_to_working() if pixels.srgb else np.eye(3)
        if not is_color:
            colors = np.outer((1, 0, 0), luminance_weights() @ colors)
        options |= {
            "srgb": pixels.srgb,
            "premultiplied": pixels.premultiplied,
            "colors": tuple(colors.ravel()),
        }
        return self._scene.texture(pixels.values, **options)
