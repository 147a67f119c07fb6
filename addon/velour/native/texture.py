"""Textures for parameters of a material."""

from __future__ import annotations

import os
from ctypes import byref
from typing import NamedTuple

import numpy as np

from . import library, structs, table
from .arrays import checked, pointer
from .handle import Handle, choice, path_bytes, set_fields

IDENTITY = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0))


class Texture(Handle):
    """Immutable. (0, 0) is the picture's lower left corner, (1, 1) its upper right.

    wrap: repeat, extend, clip, mirror; filter: closest, linear. channel: -1: a color from the first three
    channels (of one or two: from the first); otherwise a number from that channel.
    """

    _free_name = "vlr_texture_free"

    @classmethod
    def from_pixels(cls, pixels: np.ndarray, **options) -> Texture:
        """[height x width x channels] float32, row 0 at the bottom, linear; colors in the working space.

        srgb, premultiplied: 1: RGBA that is interpolated as stored, then divided by alpha, decoded, and
        multiplied by `colors` [3 x 3], as in Cycles.
        """
        pixels = checked("pixels", pixels, (None, None, None))
        height, width, channels = pixels.shape
        return cls._create("vlr_texture_create", width, height, channels, pointer(pixels), _options(options))

    @classmethod
    def of_corners(cls, color_set: int) -> Texture:
        """The colors of the mesh's corners, from one of its sets; numbers use the first channel."""
        return cls._create("vlr_texture_of_corners", color_set)

    @classmethod
    def load(cls, path: str | os.PathLike, **options) -> Texture:
        """raw: 1 reads integer values as numbers from 0 to 1, not as sRGB colors."""
        return cls._create("vlr_texture_load", path_bytes(path), _options(options))


class TextureSlot(NamedTuple):
    """A texture of a parameter; `uv_map` [2 x 3] takes the surface's (u, v, 1) to the picture's.

    uv_set: index of the mesh's texture coordinates, below VLR_MOST_UV_SETS.
    """

    texture: Texture
    uv_map: object = IDENTITY
    uv_set: int = 0


def _options(values: dict):
    options = structs.TextureOptions()
    library.load().vlr_texture_options_init(byref(options))
    names = {"wrap": table.WRAPS, "filter": table.FILTERS}
    set_fields(options, {n: choice(n, v, names[n]) if n in names else v for n, v in values.items()})
    return byref(options)
