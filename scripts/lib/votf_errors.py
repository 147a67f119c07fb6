"""Errors of the silhouette, the holes and the light of a picture against real geometry."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy import ndimage


class ShellErrors(NamedTuple):
    outline: float  # soft intersection over union of alpha, with holes filled
    alpha: float  # likewise, with holes
    light: float  # root mean square of the difference over that of the truth, where both show the object


def soft_iou(a: np.ndarray, b: np.ndarray) -> float:
    """sum min / sum max."""
    return float(np.minimum(a, b).sum() / np.maximum(a, b).sum())


def filled(alpha: np.ndarray) -> np.ndarray:
    """Makes holes solid: regions of alpha below 0.5 that are not connected to the border."""
    solid = ndimage.binary_fill_holes(alpha >= 0.5)
    inside = ndimage.binary_erosion(solid)
    return np.where(inside, 1.0, np.where(solid, np.maximum(alpha, 0.5), alpha))


def shell_errors(picture: np.ndarray, truth: np.ndarray) -> ShellErrors:
    a, b = picture[..., 3].astype(float), truth[..., 3].astype(float)
    both = (a > 0.5) & (b > 0.5)
    found, expected = picture[both][:, :3].astype(float), truth[both][:, :3].astype(float)
    light = np.sqrt(np.square(found - expected).sum() / np.square(expected).sum()) if both.any() else np.nan
    return ShellErrors(soft_iou(filled(a), filled(b)), soft_iou(a, b), float(light))
