"""The picture of all presets in the documents: their previews with names."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import plots

_COLUMNS = 6
_CELL = 1.35  # width of a preview in inches, at 100 dots per inch
_NAME = 0.2  # height of a name in inches


def draw(path: Path, pictures: Mapping[str, np.ndarray]) -> None:
    """`pictures`: previews by name, in the order of the table; sRGB, row 0 at the bottom."""
    rows = -(-len(pictures) // _COLUMNS)
    figure, axes = plots.sheet(rows, _COLUMNS, (_COLUMNS * _CELL, rows * (_CELL + _NAME)))
    for cell, (name, pixels) in zip(axes.flat, pictures.items(), strict=False):
        cell.imshow(pixels, origin="lower")
        cell.set_title(name, fontsize=8, pad=3)
    plots.save(figure, path, dpi=100)
