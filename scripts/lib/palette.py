"""Sheets of renders as small files: noise is most of them, and needs few colours."""

from __future__ import annotations

from pathlib import Path

import plots
from PIL import Image


def save(figure, path: Path) -> None:
    plots.save(figure, path, dpi=100)
    shrink(path)


def shrink(path: Path) -> None:
    """With 256 colours, a third of the bytes. Not dithered: that would be noise of its own."""
    with Image.open(path) as drawn:
        picture = drawn.convert("RGB")
    picture.quantize(256, kmeans=1, dither=Image.Dither.NONE).save(path, optimize=True)
