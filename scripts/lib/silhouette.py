"""Finds the pixels that show the object."""

from __future__ import annotations

import numpy as np
from renders import Renders
from scenes import Scene


def of(scene: Scene, renders: Renders, size: tuple[int, int]) -> np.ndarray:
    """[row, column]. Pixels of the environment alone are equal for strategies that share camera rays."""
    a, b = (renders.render(scene, 64, strategy=name, size=size).pixels for name in ("uniform", "cosine"))
    return (a != b).any(axis=-1)
