"""Finds the headers of panels in a picture of a Properties editor by their arrows."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

# The arrows as Blender 3.4 draws them at an interface scale of 1; digits are brightness, 0 the background.
_OPEN = ("054000000180", "019500001930", "001950019300", "000195193000", "000019930000", "000001300000")
_CLOSED = (
    "02700000",
    "00780000",
    "00078000",
    "00008800",
    "00000770",
    "00001940",
    "00019400",
    "00194000",
    "01940000",
    "02400000",
)
_ALIKE = 0.08  # maximum mean difference of brightness from an arrow
_CONTRAST = 60  # minimum contrast of arrow and background, of 255
STRIP = 44  # width in pixels, from the editor's left edge, that holds the arrows of panels and subpanels


class Header(NamedTuple):
    row: int  # the arrow's center, from the top
    x: int
    is_open: bool


def find(strip: np.ndarray) -> list[Header]:
    """The headers from top to bottom. `strip`: [height x width x 3] bytes, the top row first."""
    gray = strip.astype(np.float32).mean(axis=2)
    found = [Header(*place, is_open) for arrow, is_open in _ARROWS for place in _places(gray, arrow)]
    return sorted(found)


def _places(gray: np.ndarray, arrow: np.ndarray) -> list[tuple[int, int]]:
    windows = np.lib.stride_tricks.sliding_window_view(gray, arrow.shape)
    low = windows.min(axis=(2, 3))
    contrast = windows.max(axis=(2, 3)) - low
    likely = contrast > _CONTRAST
    rows, columns = np.nonzero(likely)
    shapes = (windows[likely] - low[likely][:, None, None]) / contrast[likely][:, None, None]
    alike = np.abs(shapes - arrow).mean(axis=(1, 2)) < _ALIKE
    return [(int(r) + arrow.shape[0] // 2, int(c)) for r, c in zip(rows[alike], columns[alike], strict=True)]


def _shape(rows: tuple[str, ...]) -> np.ndarray:
    shape = np.array([[int(digit) for digit in row] for row in rows], np.float32)
    return shape / shape.max()


_ARROWS = ((_shape(_OPEN), True), (_shape(_CLOSED), False))
