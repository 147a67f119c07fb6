"""What a render shows beside its colors, and which object and material each pixel has."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from support.judge import Estimate

MIXED, NOTHING = -1, 0  # labels of pixels with an edge in them, and of those where no surface is seen
MEASURED = ("shape", "coordinates", "albedo")


class Labels(NamedTuple):
    """Which of `names` fills each pixel."""

    numbers: np.ndarray  # [height x width] int32: MIXED, NOTHING, or 1 + index of the name
    names: tuple[str, ...]
    mostly: np.ndarray  # likewise, of the name that fills at least half of the pixel

    def where(self, name: str) -> np.ndarray:
        """[height x width] bool"""
        if name not in self.names:
            return np.zeros(self.numbers.shape, bool)
        return self.numbers == 1 + self.names.index(name)

    def by_most(self, fewest: int) -> Labels:
        """`mostly` for the names of fewer than `fewest` pixels."""
        counts = np.bincount(self.numbers.clip(0).ravel(), minlength=len(self.names) + 1)
        taken = (self.mostly > NOTHING) & (counts[self.mostly.clip(0)] < fewest)
        return self._replace(numbers=np.where(taken, self.mostly, self.numbers))


@dataclass(frozen=True)
class Passes:
    """Means over renders, row 0 at the bottom."""

    shape: Estimate  # normal in world axes, and the root of the distance over 1000 m
    coordinates: Estimate  # U and V
    albedo: Estimate  # RGB
    objects: Labels
    materials: Labels
    world: Estimate | None  # RGB of a mirror ball in the world alone; None where there is no world
    # `shape` as depth of field and motion blur show it, which the other passes leave out; None without them
    blurred: Estimate | None = None

    def by_most(self, fewest: int) -> Passes:
        """Names that fill fewer than `fewest` pixels get those of which they fill half."""
        objects, materials = (each.by_most(fewest) for each in (self.objects, self.materials))
        return replace(self, objects=objects, materials=materials)
