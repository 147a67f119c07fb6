"""Fits the parameters of OpenPBR to a model, from those of Blender's Principled material."""

from __future__ import annotations

from .least_squares import IOR, ROUGHNESS, UNIT, Ranges, fit_material
from .open_pbr import OpenPbr, f_cos
from .parameter_fit import Range
from .view_samples import ViewSamples

_RANGES: Ranges = {
    "base_color": [UNIT] * 3,
    "base_diffuse_roughness": [UNIT],
    "base_metalness": [UNIT],
    "specular_weight": [UNIT],
    "specular_color": [UNIT] * 3,
    "specular_roughness": [ROUGHNESS],
    "specular_ior": [IOR],
    "coat_weight": [UNIT],
    "coat_roughness": [ROUGHNESS],
    "coat_ior": [IOR],
}
_ANISOTROPY: Ranges = {"specular_roughness_anisotropy": [Range(0.0, 0.98)]}


def fit_open_pbr(samples: ViewSamples, start: OpenPbr, is_isotropic: bool) -> OpenPbr:
    ranges = _RANGES if is_isotropic else {**_RANGES, **_ANISOTROPY}
    return fit_material(samples, _starts(start), ranges, f_cos)


def _starts(start: OpenPbr) -> tuple[OpenPbr, ...]:
    """`start`, and a coated dielectric and metal, as a metalness between both rarely moves far."""
    coat = {"coat_weight": max(start.coat_weight, 0.3), "coat_roughness": max(start.coat_roughness, 0.3)}
    return start, *(start._replace(base_metalness=m, **coat) for m in (0.05, 0.95))
