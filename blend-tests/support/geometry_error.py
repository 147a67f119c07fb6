"""Errors of a picture against one of real geometry. Linear premultiplied RGBA, [height x width x 4]."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

BLOCK = 8  # pixels


class GeometryError(NamedTuple):
    pixels: float  # root mean square of the difference over that of the truth
    blocks: float  # likewise for means over BLOCK x BLOCK pixels: the error seen from a distance
    mean: float  # mean radiance over that of the truth


def geometry_error(picture: np.ndarray, truth: np.ndarray) -> GeometryError:
    """Errors over the pixels where either picture shows the object."""
    seen = (picture[..., 3] > 0.5) | (truth[..., 3] > 0.5)
    found, expected = (np.where(seen[..., None], p[..., :3], 0).astype(float) for p in (picture, truth))
    blocks = _relative(_blocks(found), _blocks(expected))
    return GeometryError(_relative(found, expected), blocks, float(found.sum() / expected.sum()))


def _relative(found: np.ndarray, expected: np.ndarray) -> float:
    return float(np.sqrt(np.square(found - expected).sum() / np.square(expected).sum()))


def _blocks(pixels: np.ndarray) -> np.ndarray:
    rows, columns = (side // BLOCK for side in pixels.shape[:2])
    whole = pixels[: rows * BLOCK, : columns * BLOCK]
    return whole.reshape(rows, BLOCK, columns, BLOCK, 3).mean(axis=(1, 3))
