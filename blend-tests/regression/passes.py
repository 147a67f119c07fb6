"""What a render shows beside its colors, and which object and material each pixel has."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from support.judge import Estimate

MIXED, NOTHING = -1, 0  # labels of pixels with an edge in them, and of those where no surface is seen
MEASURED = ("shape", "coordinates", "albedo")


class Labels(NamedTuple):
    """Which of `names` fills each pixel."""

    numbers: np.ndarray  # [height x width] int32: MIXED, NOTHING, or 1 + index of the name
    names: tuple[str, ...]

    def where(self, name: str) -> np.ndarray:
        """[height x width] bool"""
        if name not in self.names:
            return np.zeros(self.numbers.shape, bool)
        return self.numbers == 1 + self.names.index(name)


@dataclass(frozen=True)
class Passes:
    """Means over renders, row 0 at the bottom."""

    shape: Estimate  # normal in world axes, and the root of the distance over 1000 m
    coordinates: Estimate  # U and V
    albedo: Estimate  # RGB
    objects: Labels
    materials: Labels
    world: Estimate | None  # RGB of a mirror ball in the world alone; None where there is no world
