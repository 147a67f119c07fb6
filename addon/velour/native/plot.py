"""Plots of models."""

from __future__ import annotations

import math
import os
from ctypes import byref, c_uint32

import numpy as np

from . import library, structs, table
from .arrays import pointer, small
from .handle import Handle, choice, path_bytes
from .measurement import Measurement
from .model import Model

_COLORS = ("background", "foreground", "model", "measured", "red", "green", "blue")


class Plot(Handle):
    """The data of one plot of a model, immutable; drawn at any size and in any colors.

    Styles: side (pixels), text (em, pixels), and the sRGB colors background, foreground, model, measured,
    red, green, blue, each three numbers from 0 to 1. The library has defaults for all.
    """

    _free_name = "vlr_plot_free"

    @classmethod
    def of(
        cls,
        model: Model,
        kind: str,
        measurement: Measurement | None = None,
        view: float = math.radians(30),
        azimuth: float = 0.0,
    ) -> Plot:
        """`kind`: one of table.PLOTS. Angles in radians. Raises VelourError if the model has no such plot."""
        return cls._create("vlr_plot_create", *plot_arguments(model, kind, measurement, view, azimuth))

    def data(self) -> dict:
        """plot, polar, x and y {column, label, logarithmic, range}, series [{name, x, y, chosen}]."""
        return library.json_of(self._lib.vlr_plot_json, self.pointer)

    def draw(self, **style) -> np.ndarray:
        """RGBA [side x side x 4] float32, row 0 at the bottom, sRGB from 0 to 1, opaque."""
        chosen = _style(style)
        pixels = np.empty((chosen.side, chosen.side, 4), np.float32)
        self._lib.vlr_plot_draw(self.pointer, byref(chosen), pointer(pixels), pixels.size)
        return pixels

    def save(self, path: str | os.PathLike, **style) -> None:
        """Writes .png, .svg or .csv, by extension. Atomic."""
        self._lib.vlr_plot_save(self.pointer, byref(_style(style)), path_bytes(path))


def text_coverage(text: str, em: float) -> np.ndarray:
    """Coverage [height x width] of a line of text, 0 to 1, in the font of the plots; row 0 at the bottom.

    `em` in pixels, 4 to 512. The baseline is a third of the height above the bottom.
    """
    width, height = c_uint32(), c_uint32()
    draw = library.load().vlr_text_draw
    draw(text.encode(), em, byref(width), byref(height), None, 0)
    coverage = np.empty((height.value, width.value), np.float32)
    draw(text.encode(), em, byref(width), byref(height), pointer(coverage), coverage.size)
    return coverage


def plot_arguments(
    model: Model,
    kind: str,
    measurement: Measurement | None = None,
    view: float = math.radians(30),
    azimuth: float = 0.0,
) -> tuple:
    """Arguments of vlr_plot_create()."""
    measured = None if measurement is None else measurement.pointer
    return model.pointer, measured, choice("kind", kind, table.PLOTS), view, azimuth


def _style(values: dict) -> structs.PlotStyle:
    style = structs.PlotStyle()
    library.load().vlr_plot_style_init(byref(style))
    for name, value in values.items():
        if name in _COLORS:
            value = small(name, value, 3)
        elif name not in ("side", "text"):
            raise TypeError(f"plots have no style {name!r}; the styles are side, text, {', '.join(_COLORS)}")
        setattr(style, name, value)
    return style
