"""The sRGB transfer function (IEC 61966-2-1) on arrays."""

from __future__ import annotations

import numpy as np


def encoded(linear: np.ndarray) -> np.ndarray:
    """Display values of linear ones, which must not be negative."""
    curve = 1.055 * np.maximum(linear, 0.0031308) ** (1 / 2.4) - 0.055
    return np.where(linear <= 0.0031308, 12.92 * linear, curve)


def decoded(display: np.ndarray) -> np.ndarray:
    return np.where(display <= 0.04045, display / 12.92, ((display + 0.055) / 1.055) ** 2.4)
