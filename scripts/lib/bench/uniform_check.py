"""Checks whether a picture of uniform samples is consistent with their true moments.

Error bars from the spread of some renders are too short where one of many thousands of samples contributes
most of a pixel: renders that missed it do not know about it. Here, error bars come from the moments of a
sample (uniform_moments), and probabilities from a bound for any distribution with these moments (tail_bound).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from velour.core.luminance import LUMINANCE

from .agreement import LEVEL, two_sided_z
from .tail_bound import Moments, log_p_of_pixels, log_p_of_sum

SEEN = 2.326  # standard errors above the refused difference: such a bias is detected in 99 of 100 cases
_BISECTIONS = 50


@dataclass(frozen=True)
class UniformAgreement:
    """Tests: every pixel, their mean, and the mean with the weights that detect a common factor best."""

    tests: int
    largest_z: float  # computed with true error bars
    spread_of_z: float  # standard deviation over the pixels; 1 where the error bars are right
    p_value: float  # probability of the least likely difference among that many tests (Sidak)
    ratio: float  # mean of the uniform samples over that of the other renders
    factor_seen: float  # relative bias of all pixels alike that is refused in 99 of 100 cases
    pixel_bias_seen: float  # likewise for one pixel alone; median over the pixels

    @property
    def holds(self) -> bool:
        return self.p_value >= LEVEL

    @property
    def sidak_z(self) -> float:
        return two_sided_z(_level_of_one(self.tests))


def uniform_agreement(
    uniform: np.ndarray, other: np.ndarray, where: np.ndarray, moments: Moments, samples: int
) -> UniformAgreement:
    """`uniform`: mean of `samples` independent samples per pixel, [row, column, channel]. `other`: renders to
    compare with, [batch, row, column, channel]; the error of their mean is treated as normal."""
    where = where & (moments.variance > 0)  # other pixels are black, or constant
    u, others = uniform[where] @ LUMINANCE, other[:, where] @ LUMINANCE
    pixels = _Pixels(moments.at(where), samples, others.var(axis=0, ddof=1) / len(others))
    d, sums = u - others.mean(axis=0), [np.full(len(u), 1 / len(u)), pixels.factor_weights()]
    log_p = np.append(pixels.log_p(d), [pixels.log_p_of_sum(w @ d, w) for w in sums])
    z = np.append(d / pixels.error, [w @ d / pixels.error_of_sum(w) for w in sums])
    level = _level_of_one(len(log_p))
    return UniformAgreement(
        tests=len(log_p),
        largest_z=float(np.abs(z).max()),
        spread_of_z=float(z[: len(u)].std()),
        p_value=float(-np.expm1(len(log_p) * np.log1p(-np.exp(log_p.min())))),
        ratio=float(u.mean() / others.mean()),
        factor_seen=pixels.sum_seen(sums[1], level) / float(sums[1] @ pixels.moments.mean),
        pixel_bias_seen=float(np.median(pixels.seen(level) / pixels.moments.mean)),
    )


@dataclass(frozen=True)
class _Pixels:
    moments: Moments
    samples: int
    variance: np.ndarray  # variance of the estimates that the samples' means are compared with

    @property
    def error(self) -> np.ndarray:
        return np.sqrt(self.moments.variance / self.samples + self.variance)

    def error_of_sum(self, weights: np.ndarray) -> float:
        return float(np.sqrt((weights**2 * self.error**2).sum()))

    def factor_weights(self) -> np.ndarray:
        """Weights of the sum of uniform samples that is most sensitive to a common factor on all pixels,
        relative to its error. Computed from the moments alone, so that they do not depend on a render."""
        weights = self.moments.mean / self.moments.variance
        return weights / weights.sum()

    def log_p(self, difference: np.ndarray) -> np.ndarray:
        return log_p_of_pixels(difference, self.moments, self.samples, self.variance)

    def log_p_of_sum(self, difference: float, weights: np.ndarray) -> float:
        return log_p_of_sum(difference, weights, self.moments, self.samples, self.variance)

    def seen(self, level: float) -> np.ndarray:
        """The bias of each pixel that is refused at `level` in 99 of 100 cases."""
        return _least_refused(self.log_p, self.error, level) + SEEN * self.error

    def sum_seen(self, weights: np.ndarray, level: float) -> float:
        error = self.error_of_sum(weights)
        least = _least_refused(lambda d: self.log_p_of_sum(d, weights), error, level)
        return float(least + SEEN * error)


def _least_refused(log_p, error, level: float):
    """The positive difference whose bound is `level`, by bisection between 0 and 2^10 standard errors."""
    low, high = np.zeros_like(error), 1024 * error
    for _ in range(_BISECTIONS):
        middle = 0.5 * (low + high)
        refused = log_p(middle) < np.log(level)
        low, high = np.where(refused, low, middle), np.where(refused, middle, high)
    return high


def _level_of_one(tests: int) -> float:
    return float(-np.expm1(np.log1p(-LEVEL) / tests))
