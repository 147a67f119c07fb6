"""Tests whether two estimates of the same picture agree within their error bars."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import stats
from velour.core.luminance import LUMINANCE

LEVEL = 0.01  # significance level of all tests together, not of each


@dataclass(frozen=True)
class Agreement:
    tests: int  # number of tests: the pixels that vary, and the mean
    largest_z: float
    sidak_z: float  # bound on the largest |z| of that many tests, with probability 1 - LEVEL
    p_value: float  # probability of the largest |z| among that many tests (Sidak)
    ratio: float  # mean of a over mean of b

    @property
    def holds(self) -> bool:
        return self.p_value >= LEVEL


def agreement(a: np.ndarray, b: np.ndarray, where: np.ndarray) -> Agreement:
    """a, b: independent renders of both estimates, [batch, row, column, channel].

    Tests the luminance of each pixel of `where` and their mean: Welch's t of the batches, converted to the z
    of equal probability.
    """
    a, b = (_with_mean(stack[:, where] @ LUMINANCE) for stack in (a, b))
    varies = (a.var(axis=0) > 0) | (b.var(axis=0) > 0)
    t = stats.ttest_ind(a[:, varies], b[:, varies], equal_var=False)
    smallest, tests = float(np.min(t.pvalue)), int(varies.sum())
    return Agreement(
        tests=tests,
        largest_z=two_sided_z(smallest),
        sidak_z=two_sided_z(-np.expm1(np.log1p(-LEVEL) / tests)),
        p_value=float(-np.expm1(tests * np.log1p(-smallest))),
        ratio=float(a[:, -1].mean() / b[:, -1].mean()),
    )


def two_sided_z(p: float) -> float:
    return float(stats.norm.isf(p / 2))


def _with_mean(luminance: np.ndarray) -> np.ndarray:
    """Appends the mean over the pixels as the last column: [batch, pixel + 1]."""
    return np.column_stack([luminance, luminance.mean(axis=1)])
