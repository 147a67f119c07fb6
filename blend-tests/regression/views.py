"""Pictures to look at: linear RGB of reference, new and difference, and what is cut out of them."""

from __future__ import annotations

import numpy as np

from support.judge import BLOCK

from .case import Outcome

GAIN = 10  # of the difference
MAGNIFICATION = 8  # of the failing crop
MARGIN = BLOCK // 2  # pixels around the failing block
_WHITE = 99  # percentile of the reference that is shown as white
_DARK = 0.25  # where that is between this and 1, pixels are shown as they are
_CHECKERS = (0.35, 0.45)  # behind what is transparent


def views(outcome: Outcome) -> tuple[dict[str, np.ndarray], str]:
    """By name, and how they were made."""
    white = float(np.percentile(outcome.reference[..., :3].max(axis=2), _WHITE))
    scale = 1 / white if white > 1 or 0 < white < _DARK else 1.0
    difference = np.abs(outcome.ours[..., : outcome.reference.shape[2]] - outcome.reference)
    colors = difference[..., :3] * scale + difference[..., 3:].sum(axis=2, keepdims=True)
    made = {
        "reference": _over_checkers(outcome.reference, scale),
        "new": _over_checkers(outcome.ours, scale),
        "difference": np.minimum(GAIN * colors, 1),
    }
    return (
        made,
        f"Linear values times {scale:.3g} with the sRGB curve; a difference of alpha is added as gray.",
    )


def crop(view: np.ndarray, block: tuple[int, int]) -> np.ndarray:
    """A block with a margin, magnified."""
    column, row = (index * BLOCK for index in block)
    rows = slice(max(row - MARGIN, 0), row + BLOCK + MARGIN)
    columns = slice(max(column - MARGIN, 0), column + BLOCK + MARGIN)
    return view[rows, columns].repeat(MAGNIFICATION, axis=0).repeat(MAGNIFICATION, axis=1)


def _over_checkers(pixels: np.ndarray, scale: float) -> np.ndarray:
    colors = pixels[..., :3] * scale
    if pixels.shape[2] < 4:
        return colors
    rows, columns = (indices // 8 for indices in np.indices(pixels.shape[:2]))
    behind = np.array(_CHECKERS)[(rows + columns) % 2]
    return colors + ((1 - pixels[..., 3]) * behind)[..., None]
