"""Conversion of linear pixels for display."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
from velour.native import images


def display(pixels: np.ndarray) -> np.ndarray:
    """sRGB as the library writes it, row 0 on top."""
    from matplotlib import image

    with tempfile.TemporaryDirectory(prefix="velour-sheet-") as folder:
        path = Path(folder) / "picture.png"
        images.write(path, np.ascontiguousarray(pixels))
        return image.imread(path)
