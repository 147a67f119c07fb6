"""Base color textures."""

from __future__ import annotations

import numpy as np

from ..core.srgb import decoded
from ..native import Texture
from ..native.table import FILTERS, WRAPS
from .kept_tables import digest
from .textures import half_texture, texture

_MOST = 2048  # maximum pixels along a side


class GpuTexture(Texture):
    """A texture of the library whose colors can also be drawn on the GPU."""

    colors = None  # [height x width x 4]; None: it is not a color

    @classmethod
    def from_pixels(cls, pixels, **options):
        made = super().from_pixels(pixels, **options)
        if options.get("channel", -1) < 0:
            made.colors = _colors(_decoded(pixels, **options))
            made.terms = (
                WRAPS.index(options.get("wrap", "repeat")),
                FILTERS.index(options.get("filter", "linear")),
            )
            made.key = digest(made.colors), made.colors.shape, made.terms
        return made


def _decoded(pixels, srgb=False, premultiplied=False, colors=None, **_options):
    """Colors in the working space of pixels that the ray tracer decodes after it has interpolated them."""
    if not (srgb or premultiplied):
        return pixels
    color, alpha = pixels[..., :3].copy(), pixels[..., 3:]
    if premultiplied:
        np.divide(color, alpha, out=color, where=alpha != 0)
    if srgb:
        color = decoded(color)
    return (color @ np.reshape(colors, (3, 3)).T).astype(np.float32)


class Picture:
    """Image of a TextureSlot with a GpuTexture on the first set of texture coordinates."""

    def __init__(self, slot):
        self._texture, self._uv_map = slot.texture, np.asarray(slot.uv_map, np.float32)
        self._on_gpu = None
        self.key = *slot.texture.key, self._uv_map.tobytes()

    @staticmethod
    def can_be(slot):
        return slot.uv_set == 0 and getattr(slot.texture, "colors", None) is not None

    def bind(self, gpu, shader):
        if self._on_gpu is None:
            terms = np.zeros((1, 2, 4), np.float32)
            terms[0, :, :3], terms[0, :, 3] = self._uv_map, self._texture.terms
            self._on_gpu = half_texture(gpu, self._texture.colors), texture(gpu, terms)
        shader.uniform_sampler("picture", self._on_gpu[0])
        shader.uniform_sampler("picture_terms", self._on_gpu[1])


def _colors(pixels):
    """RGBA of [height x width x channels]; gray is the first channel. Downsampled to at most _MOST."""
    channels = 3 if pixels.shape[2] >= 3 else 1
    means = _means(pixels[..., :channels])
    found = np.ones((*means.shape[:2], 4), np.float32)
    found[..., :3] = means
    return found


def _means(pixels):
    rows, columns = (-(-size // _MOST) for size in pixels.shape[:2])  # of each mean
    if rows == columns == 1:
        return pixels
    height, width = pixels.shape[0] // rows, pixels.shape[1] // columns
    cells = pixels[: height * rows, : width * columns]
    return cells.reshape(height, rows, width, columns, -1).mean(axis=(1, 3))
