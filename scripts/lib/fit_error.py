"""The error that a model causes in a picture, without the picture's noise."""

from __future__ import annotations

import numpy as np
from velour.native import images


def fit_error(differences: np.ndarray, reference: np.ndarray) -> tuple[float, float]:
    """rmse and relmse of the common part of independent `differences` [render, row, column, channel].

    Each difference is model minus measurement with the same light directions, so most noise cancels. The
    remaining noise adds its variance v to the square of each difference and v / n to that of their mean: two
    equations with two unknowns.
    """
    n = len(differences)
    each = np.square([_errors(difference, reference) for difference in differences]).mean(axis=0)
    common = np.square(_errors(differences.mean(axis=0), reference))
    rmse, relmse_root = np.sqrt(np.maximum((n * common - each) / (n - 1), 0.0))
    return float(rmse), float(relmse_root**2)


def _errors(difference: np.ndarray, reference: np.ndarray) -> tuple[float, float]:
    """rmse and the root of relmse."""
    rmse, relmse = images.compare((reference + difference).astype(np.float32), reference)
    return rmse, relmse**0.5
