"""A plot of a few hundred pixels from numpy alone: Blender's Python brings no matplotlib."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np

_BACKGROUND, _GRID, _LINE, _CHOSEN = (0.11, 0.11, 0.11), (0.24, 0.24, 0.24), (0.6, 0.6, 0.6), (1.0, 0.6, 0.2)
_MARGIN = 0.08  # of the side


def order_picture(order: dict, side: int = 192, against: str = "lobes", tolerance: bool = True) -> np.ndarray:
    """Error over tolerance against lobes, logarithmic: RGBA [side x side x 4] float32, row 0 at the bottom.

    `order` is the library's: lists `lobes` (or what it is drawn `against`) and `worst`, and `chosen`, the
    point that is marked. The dashed line is the `tolerance`, where there is one. Opaque, so that it reads on
    light and dark themes.
    """
    x = _logarithms(order[against])
    y = _logarithms(order["worst"])
    # The tolerance, log 1, is always in view.
    low, high = (min(0.0, *y), max(0.0, *y)) if tolerance else (min(y), max(y))
    picture = _Canvas(side)
    points = [(picture.place(a, x[0], x[-1]), picture.place(b, low, high)) for a, b in zip(x, y, strict=True)]
    if tolerance:
        level = picture.place(0.0, low, high)
        for dash in range(0, side, 8):
            picture.line((dash, level), (dash + 3, level), _GRID, 1.0)
    for start, end in pairwise(points):
        picture.line(start, end, _LINE, 1.5)
    for number, point in enumerate(points):
        chosen = number == order["chosen"]
        picture.line(point, point, _CHOSEN if chosen else _LINE, 6.0 if chosen else 3.0)
    return picture.pixels


def _logarithms(values: Sequence[float]) -> list[float]:
    """Of positive numbers; what is 0 (a black material) lies a decade under the smallest of them."""
    positive = [value for value in values if value > 0]
    least = min(positive, default=1.0) / 10
    return [math.log(value if value > 0 else least) for value in values]


class _Canvas:
    def __init__(self, side: int):
        self.side = side
        self.pixels = np.ones((side, side, 4), np.float32)
        self.pixels[..., :3] = _BACKGROUND

    def place(self, value: float, low: float, high: float) -> float:
        """Where `value` of [low, high] lies along a side, in pixels."""
        share = (value - low) / (high - low) if high > low else 0.5
        return self.side * (_MARGIN + (1 - 2 * _MARGIN) * share)

    def line(self, start, end, color, radius: float) -> None:
        """A line with round ends, smooth over a pixel; a dot where both ends are the same."""
        (ax, ay), (bx, by) = start, end
        columns, rows = (self._touched(a, b, radius) for a, b in ((ax, bx), (ay, by)))
        y, x = np.mgrid[rows, columns] + 0.5
        dx, dy = bx - ax, by - ay
        along = ((x - ax) * dx + (y - ay) * dy) / max(dx * dx + dy * dy, 1e-12)
        along = along.clip(0.0, 1.0)
        distance = np.hypot(x - ax - along * dx, y - ay - along * dy)
        cover = (radius + 0.5 - distance).clip(0.0, 1.0)[..., None]
        below = self.pixels[rows, columns, :3]
        below += cover * (np.array(color, np.float32) - below)

    def _touched(self, a: float, b: float, radius: float) -> slice:
        low, high = min(a, b) - radius - 1, max(a, b) + radius + 2
        return slice(max(0, int(low)), min(self.side, int(high)))
