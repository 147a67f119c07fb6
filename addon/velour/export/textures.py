"""Images of materials as the library's textures."""

import numpy as np

from ..native import Texture, TextureSlot, VelourError
from .color import luminance_weights, rec709_to_working
from .files import FIND, absolute_path
from .pixels import interpolated_pixels


class TextureTable:
    """Creates each texture once."""

    def __init__(self, scene, notes):
        self._scene = scene
        self._notes = notes
        self._textures = {}

    def slot(self, picture, is_color, owner, uv_maps, instead="the value of its input"):
        """TextureSlot of a Picture for a material's UvMaps, if any; None, with a note, if it cannot be read.

        `instead`: what is shown then.
        """
        channels = (picture.alpha, picture.beside_alpha, is_color)
        key = (picture.image.as_pointer(), *channels, picture.wrap, picture.filter)
        if key not in self._textures:
            self._textures[key] = self._read(picture, is_color, owner, instead)
        texture = self._textures[key]
        number = uv_maps.number(picture.coordinates) if uv_maps else 0
        return TextureSlot(texture, picture.uv_map, number) if texture else None

    def of_corners(self, color_set):
        """TextureSlot of a set of corner colors."""
        if color_set not in self._textures:
            self._textures[color_set] = Texture.of_corners(color_set)
        return TextureSlot(self._textures[color_set])

    def texture(self, picture, is_color, owner):
        """The Texture of a Picture in a program; if it cannot be read, magenta with a note, as in Cycles."""
        slot = self.slot(picture, is_color, owner, None, "magenta")
        if slot:
            return slot.texture
        pixels = np.array((((1.0, 0.0, 1.0),),), np.float32)
        return self._scene.texture(pixels, channel=-1 if is_color else 0)

    def _read(self, picture, is_color, owner, instead):
        try:
            pixels = interpolated_pixels(picture.image, self._notes, picture.beside_alpha)
        except VelourError as error:
            self._notes.add(f"{owner}: image '{picture.image.name}' is replaced by {instead}: {error}")
            return None
        if pixels is None:
            path = absolute_path(picture.image) or "no file"
            self._notes.add(
                f"{owner}: image '{picture.image.name}' ({path}) cannot be read and is replaced by"
                f" {instead}; {FIND}."
            )
            return None
        options = {"wrap": picture.wrap, "filter": picture.filter, "channel": -1 if is_color else 0}
        if picture.alpha:
            return self._scene.texture(np.ascontiguousarray(pixels.values[..., 3:]), **options)
        if not (pixels.srgb or pixels.premultiplied or is_color):
            number = pixels.values[..., :3] @ luminance_weights()
            return self._scene.texture(np.ascontiguousarray(number[..., None], np.float32), **options)
        colors = rec709_to_working() if pixels.srgb else np.eye(3)
        if not is_color:
            colors = np.outer((1, 0, 0), luminance_weights() @ colors)
        options |= {"srgb": pixels.srgb, "premultiplied": pixels.premultiplied, "colors": tuple(colors.ravel())}
        return self._scene.texture(pixels.values, **options)
