"""For scripts/realtime, after the drawing: the ray-traced picture, the real-time one, the difference."""

import sys
from pathlib import Path

import numpy as np
import plots
from display import display

_TIMES, _GRAY = 10, 0.214  # factor of the difference, around middle gray (linear)
_SHOWN = 0.82  # share of the height: above it is the shell's hem, which has no sides in real time
_CELL = 2.9  # width of a picture in inches, at 100 dots per inch
_TITLES = ("ray traced", "real time", f"{_TIMES} times the difference")


def main() -> int:
    traced, drawn = np.load(sys.argv[1])[..., :3]
    white = np.percentile(traced, 99.5)
    difference = _GRAY + _TIMES * (drawn - traced) / white
    draw(Path(sys.argv[2]), (traced / white, drawn / white, difference))
    return 0


def draw(path: Path, pictures: tuple[np.ndarray, ...]) -> None:
    """`pictures`: linear, row 0 at the bottom."""
    rows, width = round(_SHOWN * pictures[0].shape[0]), pictures[0].shape[1]
    figure, (axes,) = plots.sheet(1, len(pictures), (len(pictures) * _CELL, _CELL * rows / width + 0.25))
    for cell, title, pixels in zip(axes, _TITLES, pictures, strict=True):
        cell.imshow(display(np.clip(pixels[:rows], 0, 1).astype(np.float32)), interpolation="none")
        cell.set_title(title, fontsize=9)
    plots.save(figure, path, dpi=100)


if __name__ == "__main__":
    sys.exit(main())
