"""Bounds on the deviation of a mean of samples from its expectation, if few samples contribute most of it.

An error bar assumes a normal distribution; contributions of rare events are closer to a Poisson distribution.
These bounds hold for independent samples X of any distribution in [0, b] with the given moments. For real s

    E exp(s X) <= 1 + s E X + s^2 / 2 E X^2 + psi(s b) / b^3 E X^3,   psi(u) = exp(u) - 1 - u - u^2 / 2,

because psi(u) / u^3 increases with u: Bennett's inequality [Ben62] extended by one moment. For the sum S of
all samples, Chernoff's bound is then P(S - E S >= t) <= exp(-s t) E exp(s (S - E S)), s > 0, and likewise for
the lower tail.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

# Values of s to try, relative to the optimum of a normal distribution; heavier tails need smaller values.
_TILTS = 2.0 ** -np.arange(0, 10, 0.125)


@dataclass(frozen=True)
class Moments:
    """Moments of one sample, for each of several pixels."""

    mean: np.ndarray
    second: np.ndarray
    third: np.ndarray
    largest: np.ndarray

    def at(self, where: np.ndarray) -> Moments:
        return Moments(self.mean[where], self.second[where], self.third[where], self.largest[where])

    @property
    def variance(self) -> np.ndarray:
        return np.maximum(self.second - self.mean**2, 0.0)


def log_p_of_pixels(
    difference: np.ndarray, moments: Moments, samples: int, variance: np.ndarray
) -> np.ndarray:
    """Bounds on the log probability that means of `samples` samples in each pixel differ by `difference` from
    estimates of their expectation, whose own error is normal with `variance`."""

    def cumulant(s: np.ndarray) -> np.ndarray:
        return _cumulant(moments, s) + 0.5 * samples * s**2 * variance

    return _log_p(difference, samples, moments.variance + samples * variance, cumulant)


def log_p_of_sum(
    difference: float, weights: np.ndarray, moments: Moments, samples: int, variance: np.ndarray
) -> float:
    """log_p_of_pixels() for the weighted sum of all pixels' differences."""
    w = weights * len(weights)  # the sum is the mean of w times a sample, over all samples of all pixels
    count = samples * len(weights)

    def cumulant(s: float) -> float:
        return (_cumulant(moments, s * w) + 0.5 * samples * (s * w) ** 2 * variance).mean()

    variance_of_one = (w**2 * (moments.variance + samples * variance)).mean()
    return float(_log_p(difference, count, variance_of_one, cumulant))


def _log_p(difference, count: int, variance_of_one, cumulant: Callable):
    """The bound for a mean of `count` samples. `cumulant`: bound on log E exp(s (X - E X)) of one sample."""
    normal = difference / variance_of_one
    bounds = [count * (cumulant(tilt * normal) - tilt * normal * difference) for tilt in _TILTS]
    return np.minimum(np.log(2) + np.min(bounds, axis=0), 0.0)


def _cumulant(moments: Moments, s):
    m, b = moments, moments.largest
    with np.errstate(over="ignore"):
        return np.log1p(s * m.mean + 0.5 * s**2 * m.second + _psi(s * b) * m.third / b**3) - s * m.mean


def _psi(u: np.ndarray) -> np.ndarray:
    """exp(u) - 1 - u - u^2 / 2 without cancellation."""
    return np.where(np.abs(u) < 1e-2, u**3 / 6 * (1 + u / 4), np.expm1(u) - u - 0.5 * u**2)
