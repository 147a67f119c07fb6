"""Fits OpenPBR's parameters to a model, from Blender's Principled material."""

from __future__ import annotations

import numpy as np

from .ggx_terms import Geometry
from .open_pbr import OpenPbr, f_cos
from .parameter_fit import Range, fit
from .view_samples import LUMINANCE, ViewSamples

_UNIT = Range(0.0, 1.0)
_ROUGHNESS, _IOR = Range(0.1, 1.0), Range(1.0, 3.0)
_RANGES = {
    "base_color": [_UNIT] * 3,
    "base_diffuse_roughness": [_UNIT],
    "base_metalness": [_UNIT],
    "specular_weight": [_UNIT],
    "specular_color": [_UNIT] * 3,
    "specular_roughness": [_ROUGHNESS],
    "specular_ior": [_IOR],
    "coat_weight": [_UNIT],
    "coat_roughness": [_ROUGHNESS],
    "coat_ior": [_IOR],
}
_ANISOTROPY = {"specular_roughness_anisotropy": [Range(0.0, 0.98)]}


def fit_open_pbr(samples: ViewSamples, start: OpenPbr, is_isotropic: bool) -> OpenPbr:
    """Least squares over f cos of each channel, of its luminance, and albedos, relative to those of each view."""
    ranges = _RANGES if is_isotropic else {**_RANGES, **_ANISOTROPY}
    target = _Target(samples)
    geometry = Geometry.of(samples.wv, samples.wl)
    bounds = [each for part in ranges.values() for each in part]

    def residuals(values):
        return target.residuals(f_cos(_material(start, ranges, values), geometry))

    found = [fit(residuals, _values(begin, ranges), bounds) for begin in _starts(start)]
    best, _cost = min(found, key=lambda each: each[1])
    return _material(start, ranges, best)


def _starts(start):
    """The Principled material, and a dielectric and a metal, since a metalness between them rarely moves far."""
    coated = start._replace(coat_weight=max(start.coat_weight, 0.3), coat_roughness=max(start.coat_roughness, 0.3))
    return start, coated._replace(base_metalness=0.05), coated._replace(base_metalness=0.95)


def _values(material, ranges):
    return np.concatenate([np.atleast_1d(getattr(material, name)) for name in ranges])


def _material(material, ranges, values):
    parts, at = {}, 0
    for name, part in ranges.items():
        own = values[at : at + len(part)]
        parts[name], at = (tuple(own) if len(part) > 1 else float(own[0])), at + len(part)
    return material._replace(**parts)


class _Target:
    """Weighted differences from samples: views weigh as much as a picture of a sphere shows of them."""

    def __init__(self, samples):
        self._f_cos = samples.f_cos
        share = np.sqrt(np.sin(2 * np.arccos(np.clip(samples.wv[:, 2], 0, 1))))
        root = np.sqrt(samples.solid_angle)
        self._solid_angle = samples.solid_angle[..., None]
        self._albedo = (self._solid_angle * self._f_cos).sum(1)
        luminance = self._f_cos @ LUMINANCE
        norm = np.sqrt((root**2 * luminance**2).sum(-1))
        floor = 1e-3 * norm.max() + 1e-12
        self._weight = (share / np.maximum(norm, floor))[:, None] * root
        brightness = self._albedo @ LUMINANCE
        self._albedo_weight = (share / np.maximum(brightness, 1e-3 * brightness.max() + 1e-12))[:, None]

    def residuals(self, f_cos):
        difference = f_cos - self._f_cos
        albedo = ((self._solid_angle * f_cos).sum(1) - self._albedo) * self._albedo_weight
        parts = difference * self._weight[..., None] / 3**0.5, difference @ LUMINANCE * self._weight, albedo / 3**0.5
        return np.concatenate([part.ravel() for part in parts])
