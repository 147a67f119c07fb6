"""A tile's pictures at equal bytes beside the reference, with the region where they differ most magnified."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import plots
from btf_chart_numbers import Results, relative_error, widest_spread
from display import display
from flip_metric import exposure

_CELL, _COLUMNS = 2.0, 5  # width of a picture in inches, at 100 dots per inch
_FAR = 0.5  # pictures with a larger error differ everywhere and do not influence the choice of the crop
_CROP = 28  # side of a crop, in pixels


def draw(path: Path, tile, pictures: dict[str, np.ndarray], results: Results, ratio: int) -> None:
    """`pictures`: linear, the reference first."""
    names = list(pictures)
    reference = pictures[names[0]]
    scale = exposure(reference, np.ones(reference.shape[:2], bool))
    side = min(_CROP, *reference.shape[:2])
    close = [p for p in pictures.values() if relative_error(p, reference) < _FAR]
    top, left = widest_spread([scale * p for p in close], side)
    rows = -(-len(names) // _COLUMNS)
    sheet, axes = plots.sheet(2 * rows, _COLUMNS, (_CELL * _COLUMNS, rows * _CELL * 1.95))
    for i, name in enumerate(names):
        above, below = (axes[2 * (i // _COLUMNS) + k, i % _COLUMNS] for k in range(2))
        entry = results.get(tile.name, name, ratio)
        error = "" if entry is None else f", {entry.bytes / 1000:.0f} KB, {entry.picture:.3f}"
        above.imshow(display(scale * pictures[name]), interpolation="none")
        above.set_title(name + error, fontsize=7)
        crop = pictures[name][top : top + side, left : left + side]
        below.imshow(display(scale * crop), interpolation="none")
    plots.save(sheet, path, dpi=100)
