"""The material of glTF 2.0 and its extensions, with constant parameters."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from .ggx_terms import Geometry, lobe, schlick
from .least_squares import ROUGHNESS, UNIT, Ranges, fit_material
from .open_pbr import OpenPbr
from .parameter_fit import Range
from .view_samples import ViewSamples, mean_error

_MIN_ALPHA = 1e-3
_REWEIGHTS = 2
_LEAST_ERROR = 0.05
_COAT_F0 = 0.04
_RANGES: Ranges = {
    "base_color": [UNIT] * 3,
    "metallic": [UNIT],
    "roughness": [ROUGHNESS],
    "specular": [UNIT],
    "specular_color": [UNIT] * 3,
    "ior": [Range(1.0, 3.0)],
    "clearcoat": [UNIT],
    "clearcoat_roughness": [ROUGHNESS],
}
_ANISOTROPY: Ranges = {"anisotropy": [UNIT]}


class Gltf(NamedTuple):
    """Factors; colors are linear Rec. 709 in [0, 1]."""

    base_color: tuple = (0.8, 0.8, 0.8)
    metallic: float = 0.0
    roughness: float = 0.5
    specular: float = 1.0
    specular_color: tuple = (1.0, 1.0, 1.0)
    ior: float = 1.5
    clearcoat: float = 0.0
    clearcoat_roughness: float = 0.0
    anisotropy: float = 0.0

    @classmethod
    def of_open_pbr(cls, p: OpenPbr) -> Gltf:
        aspect = 1 - p.specular_roughness_anisotropy
        alpha = p.specular_roughness**2 * math.sqrt(2 / (aspect**2 + 1)) * aspect  # across the tangent
        return cls(
            base_color=p.base_color,
            metallic=p.base_metalness,
            roughness=min(math.sqrt(alpha), 1.0),
            specular_color=p.specular_color,
            ior=p.specular_ior,
            clearcoat=p.coat_weight,
            clearcoat_roughness=p.coat_roughness,
            anisotropy=math.sqrt(max(0.0, min((alpha / aspect - alpha) / max(1 - alpha, 1e-6), 1.0))),
        )

    def material(self, name: str, turns: float, extras: dict) -> dict:
        """The material's JSON object; `turns`: rotation of the tangent, in turns."""
        anisotropy = {"anisotropyStrength": self.anisotropy, "anisotropyRotation": turns * math.tau}
        extensions = {
            "KHR_materials_ior": {"ior": self.ior},
            "KHR_materials_specular": {
                "specularFactor": self.specular,
                "specularColorFactor": list(self.specular_color),
            },
            "KHR_materials_clearcoat": {
                "clearcoatFactor": self.clearcoat,
                "clearcoatRoughnessFactor": self.clearcoat_roughness,
            },
            **({"KHR_materials_anisotropy": anisotropy} if self.anisotropy > 0 else {}),
        }
        return {
            "name": name,
            "pbrMetallicRoughness": {
                "baseColorFactor": [*self.base_color, 1.0],
                "metallicFactor": self.metallic,
                "roughnessFactor": self.roughness,
            },
            "extensions": extensions,
            "extras": extras,
        }


def f_cos(p: Gltf, g: Geometry) -> np.ndarray:
    """f cos(theta_l) [views x lights x 3] in 1/sr; x is the tangent."""
    base = np.asarray(p.base_color, float)
    alpha = max(p.roughness**2, _MIN_ALPHA)
    shape = lobe(g, alpha + (1 - alpha) * p.anisotropy**2, alpha)[..., None]
    rise = schlick(g.vh)[..., None]
    metal = (base + (1 - base) * rise) * shape
    f0 = ((p.ior - 1) / (p.ior + 1)) ** 2
    at_normal = np.minimum(f0 * np.asarray(p.specular_color, float), 1) * p.specular
    fresnel = at_normal + (p.specular - at_normal) * rise
    diffuse = base * (g.nl / np.pi)[..., None]
    dielectric = fresnel * shape + (1 - fresnel.max(-1, keepdims=True)) * diffuse
    below = p.metallic * metal + (1 - p.metallic) * dielectric
    coat_alpha = max(p.clearcoat_roughness**2, _MIN_ALPHA)
    coat = p.clearcoat * (_COAT_F0 + (1 - _COAT_F0) * schlick(g.nv))[..., None]
    return (1 - coat) * below + coat * lobe(g, coat_alpha, coat_alpha)[..., None]


def fit_gltf(samples: ViewSamples, start: Gltf, is_isotropic: bool) -> Gltf:
    ranges = _RANGES if is_isotropic else {**_RANGES, **_ANISOTROPY}
    coat = {
        "clearcoat": max(start.clearcoat, 0.3),
        "clearcoat_roughness": max(start.clearcoat_roughness, 0.3),
    }
    albedo = (samples.solid_angle[..., None] * samples.f_cos).sum(1)
    color = tuple(map(float, np.clip(albedo[np.argmax(samples.wv[:, 2])], 0, 1)))
    bare = start._replace(metallic=0.95, base_color=color, clearcoat=0.0)
    starts = start, *(start._replace(metallic=m, **coat) for m in (0.05, 0.95)), bare
    geometry = Geometry.of(samples.wv, samples.wl)

    def refitted(material):
        """The fit from this material, where views weigh less the more it errs: reweighted least squares.

        Grazing views that no metal of glTF resembles, because its reflectance rises to 1 there, would spoil
        all others.
        """
        error = np.nan_to_num(samples.relative_errors(f_cos(material, geometry)), nan=1.0)
        weight = 1 / np.sqrt(np.maximum(error, _LEAST_ERROR))
        return fit_material(samples, [material], ranges, f_cos, geometry, weight).material

    def best(materials):
        return min(materials, key=lambda each: mean_error(samples, f_cos(each, geometry)))

    found = best([*starts, *map(refitted, starts)])
    for _ in range(_REWEIGHTS):
        found = best([found, refitted(found)])
    return found
