"""Saves sheets of renders as small files: most of their content is noise, which needs few colors."""

from __future__ import annotations

from pathlib import Path

import plots
from PIL import Image


def save(figure, path: Path) -> None:
    plots.save(figure, path, dpi=100)
    shrink(path)


def shrink(path: Path) -> None:
    """Reduces a picture to 256 colors, a third of the bytes, without dithering, which would add noise."""
    with Image.open(path) as drawn:
        picture = drawn.convert("RGB")
    picture.quantize(256, kmeans=1, dither=Image.Dither.NONE).save(path, optimize=True)
