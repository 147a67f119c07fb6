"""Error against time, interpolated between the measured points and extrapolated if necessary."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Reading:
    value: float
    measured: bool  # between measured points; otherwise extrapolated by the fitted power law

    def __str__(self) -> str:
        return f"{'' if self.measured else '~'}{self.value:.3g}"


class Curve:
    """Points (seconds, error), interpolated linearly in the logarithms of both."""

    def __init__(self, points: list[tuple[float, float]]):
        usable = sorted(point for point in points if min(point) > 0)
        self.x, self.y = np.log(usable).T if usable else (np.empty(0), np.empty(0))

    def seconds_at(self, error: float) -> Reading | None:
        """When the curve falls below `error` for good; None if it does not."""
        y = np.log(error)
        below = np.flatnonzero(self.y > y)
        k = below[-1] + 1 if len(below) else 0
        if 0 < k < len(self.y):
            share = (self.y[k - 1] - y) / (self.y[k - 1] - self.y[k])
            return Reading(float(np.exp(self.x[k - 1] + share * (self.x[k] - self.x[k - 1]))), True)
        slope = self._slope()
        if slope is None or slope >= 0:
            return None
        end = 0 if k == 0 else -1
        return Reading(float(np.exp(self.x[end] + (y - self.y[end]) / slope)), False)

    def error_at(self, seconds: float) -> Reading | None:
        x = np.log(seconds)
        if len(self.x) and self.x[0] <= x <= self.x[-1]:
            return Reading(float(np.exp(np.interp(x, self.x, self.y))), True)
        slope = self._slope()
        if slope is None:
            return None
        end = 0 if x < self.x[0] else -1
        return Reading(float(np.exp(self.y[end] + slope * (x - self.x[end]))), False)

    def _slope(self) -> float | None:
        """Slope of the least-squares line through all points; None for fewer than two."""
        if len(self.x) < 2 or np.ptp(self.x) == 0:
            return None
        return float(np.polyfit(self.x, self.y, 1)[0])


def ratio(a: Reading | None, b: Reading | None) -> Reading | None:
    return Reading(a.value / b.value, a.measured and b.measured) if a and b else None


def shown(found: Reading | None) -> str:
    return "-" if found is None else str(found)
