"""What a fit of constant parameters minimizes: differences of f cos and albedo at sampled views."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

import numpy as np

from .ggx_terms import Geometry
from .parameter_fit import Range, fit
from .view_samples import LUMINANCE, ViewSamples

Ranges = dict[str, list[Range]]  # of the components of a material's fields
UNIT, ROUGHNESS, IOR = Range(0.0, 1.0), Range(0.1, 1.0), Range(1.0, 3.0)


class Fit(NamedTuple):
    material: Any
    error: float  # root of the sum of the squared residuals, over that of a black material


def fit_material(
    samples: ViewSamples,
    starts: Iterable[Any],
    ranges: Ranges,
    f_cos: Callable[[Any, Geometry], np.ndarray],
    geometry: Geometry | None = None,
    view_weight: np.ndarray | None = None,
) -> Fit:
    """The best of the fits of the fields in `ranges`, from each of `starts`, named tuples.

    Residuals: f cos of each channel, its luminance, and albedos, relative to those of the view. Views weigh
    as much as the picture of a sphere shows of them, times `view_weight` [views], if given.
    """
    target = _Target(samples, view_weight)
    geometry = geometry or Geometry.of(samples.wv, samples.wl)
    bounds = [each for part in ranges.values() for each in part]
    black = max(float((target.residuals(np.zeros_like(samples.f_cos)) ** 2).sum()), 1e-30)
    found = []
    for start in starts:
        values, cost = fit(
            lambda values, start=start: target.residuals(f_cos(_with(start, ranges, values), geometry)),
            np.concatenate([np.atleast_1d(getattr(start, name)) for name in ranges]),
            bounds,
        )
        found.append(Fit(_with(start, ranges, values), math.sqrt(cost / black)))
    return min(found, key=lambda fit: fit.error)


def _with(material, ranges, values):
    """The material with these components of the fields in `ranges`."""
    fields, at = {}, 0
    for name, part in ranges.items():
        own = tuple(map(float, values[at : at + len(part)]))
        fields[name], at = (own if len(part) > 1 else own[0]), at + len(part)
    return material._replace(**fields)


class _Target:
    def __init__(self, samples, view_weight):
        self._f_cos = samples.f_cos
        self._solid_angle = samples.solid_angle[..., None]
        share = np.sqrt(np.sin(2 * np.arccos(np.clip(samples.wv[:, 2], 0, 1))))
        share = share if view_weight is None else share * view_weight
        root = np.sqrt(samples.solid_angle)
        self._weight = (share / _not_black((root * (self._f_cos @ LUMINANCE)) ** 2))[:, None] * root
        self._albedo = (self._solid_angle * self._f_cos).sum(1)
        brightness = self._albedo @ LUMINANCE
        self._albedo_weight = (share / _not_black(brightness[:, None] ** 2))[:, None]

    def residuals(self, f_cos):
        difference = f_cos - self._f_cos
        albedo = (self._solid_angle * f_cos).sum(1) - self._albedo
        parts = (
            difference * self._weight[..., None] / 3**0.5,
            difference @ LUMINANCE * self._weight,
            albedo * self._albedo_weight / 3**0.5,
        )
        return np.concatenate([part.ravel() for part in parts])


def _not_black(squares):
    """Norms [views], at least a thousandth of the largest, so that dark views do not count too much."""
    norms = np.sqrt(squares.sum(-1))
    return np.maximum(norms, max(1e-3 * float(norms.max()), 1e-12))
