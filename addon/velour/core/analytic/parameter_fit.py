"""Levenberg-Marquardt for the few constant parameters of analytic materials, within bounds."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

_STEP = 1e-3  # of finite differences
_MARGIN = 1e-3  # starts keep this share of a range from its ends, where the map is flat


class Range(NamedTuple):
    low: float
    high: float


def fit(
    residuals: Callable[[np.ndarray], np.ndarray], start: np.ndarray, ranges: list[Range], steps: int = 30
) -> tuple[np.ndarray, float]:
    """Parameters within `ranges` that minimize the squared norm of `residuals`, from `start`; that norm."""
    low, high = np.array(ranges, float).T

    def bounded(angle):
        return low + (high - low) * (0.5 - 0.5 * np.cos(angle))

    share = np.clip((np.asarray(start, float) - low) / (high - low), _MARGIN, 1 - _MARGIN)
    angle = np.arccos(1 - 2 * share)
    current = residuals(bounded(angle))
    cost, damping = float(current @ current), 1e-2
    for _ in range(steps):
        columns = []
        for i in range(len(angle)):
            moved = angle.copy()
            moved[i] += _STEP
            columns.append((residuals(bounded(moved)) - current) / _STEP)
        jacobian = np.stack(columns, axis=1)
        curvature, slope = jacobian.T @ jacobian, jacobian.T @ current
        before = cost
        while damping < 1e6:
            scale = np.diag(np.diag(curvature) + 1e-9)
            trial = angle - np.linalg.solve(curvature + damping * scale, slope)
            values = residuals(bounded(trial))
            if float(values @ values) < cost:
                angle, current, cost = trial, values, float(values @ values)
                damping = max(damping / 5, 1e-7)
                break
            damping *= 4
        if before - cost < 1e-5 * before:
            break
    return bounded(angle), cost
