"""Fits the parameters of OpenPBR to a model, from those of Blender's Principled material."""

from __future__ import annotations

from typing import NamedTuple

from ...native import Model
from .ggx_terms import Geometry
from .least_squares import IOR, ROUGHNESS, UNIT, Ranges, fit_material
from .open_pbr import OpenPbr, f_cos
from .parameter_fit import Range
from .view_samples import WHITE, ViewSamples, errors, fitted_samples

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
_WORTH = 0.002  # of the signal: what metal must gain
_ANISOTROPY: Ranges = {"specular_roughness_anisotropy": [Range(0.0, 0.98)]}


class FittedOpenPbr(NamedTuple):
    material: OpenPbr
    is_turned: bool  # the tangent is y
    errors: dict  # relative_l2 and by_view_angle, against the model


def fitted_open_pbr(
    model: Model, principled: dict, anisotropic: float = 0.0, is_turned: bool = False, gain: tuple = WHITE
) -> FittedOpenPbr:
    """OpenPBR fitted to a model times `gain`. The other arguments are its Approximation's."""
    is_isotropic = model.info().get("isotropic", True)
    is_turned = is_turned and not is_isotropic
    start = OpenPbr.of_principled(principled, anisotropic)
    material = fit_open_pbr(along_tangent(fitted_samples(model, gain=gain), is_turned), start, is_isotropic)

    def of(samples):
        own = along_tangent(samples, is_turned)
        return f_cos(material, Geometry.of(own.wv, own.wl))

    return FittedOpenPbr(material, is_turned, errors(model, of, gain=gain))


def along_tangent(samples: ViewSamples, is_turned: bool) -> ViewSamples:
    """The samples in the frame of a material whose tangent is y if it `is_turned`."""
    return samples.quarter_turned() if is_turned else samples


def fit_open_pbr(samples: ViewSamples, start: OpenPbr, is_isotropic: bool) -> OpenPbr:
    """Metal only where it helps: one of weak reflection is black, and any brighter base makes up for it."""
    ranges = _RANGES if is_isotropic else {**_RANGES, **_ANISOTROPY}
    dielectric = {name: part for name, part in ranges.items() if name != "base_metalness"}
    # A metalness between a dielectric and a metal rarely moves far: both are starts.
    coat = {"coat_weight": max(start.coat_weight, 0.3), "coat_roughness": max(start.coat_roughness, 0.3)}
    coated = start._replace(base_metalness=0.0, **coat)
    plain = fit_material(samples, (start._replace(base_metalness=0.0), coated), dielectric, f_cos)
    mixtures = (start, *(coated._replace(base_metalness=m) for m in (0.05, 0.95)))
    mixed = fit_material(samples, mixtures, ranges, f_cos)
    return mixed.material if mixed.error < plain.error - _WORTH else plain.material
