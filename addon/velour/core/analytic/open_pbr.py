"""OpenPBR Surface [OPBR24] with constant parameters: metal, or dielectric over a diffuse base, and a coat.

The formula is that of the node graph of MaterialX 1.39, without fuzz, thin film and subsurface.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from .ggx_terms import Geometry, albedo, lobe, schlick

_MIN_ALPHA = 1e-3
_C82 = 1 / 7  # cosine at which specular_color tints a metal


class OpenPbr(NamedTuple):
    """Inputs of open_pbr_surface; colors are linear Rec. 709 in [0, 1].

    base_weight is 1 and coat_darkening 0.
    """

    base_color: tuple = (0.8, 0.8, 0.8)
    base_diffuse_roughness: float = 0.0
    base_metalness: float = 0.0
    specular_weight: float = 1.0
    specular_color: tuple = (1.0, 1.0, 1.0)
    specular_roughness: float = 0.3
    specular_ior: float = 1.5
    specular_roughness_anisotropy: float = 0.0
    coat_weight: float = 0.0
    coat_roughness: float = 0.0
    coat_ior: float = 1.6

    @classmethod
    def of_principled(cls, principled: dict, anisotropic: float = 0.0) -> OpenPbr:
        """The parameters that come closest to those of Blender's Principled BSDF."""
        root = math.sqrt(min(max(0.08 * principled["specular"], 0.0), 0.9))
        aspect = 1 - 0.9 * anisotropic  # alpha_y / alpha_x
        return cls(
            base_color=tuple(principled["base_color"]),
            base_metalness=principled["metallic"],
            specular_color=tuple(min(tint, 1.0) for tint in principled["specular_tint"]),
            # OpenPBR keeps the mean of squared alphas, Blender their product.
            specular_roughness=min(principled["roughness"] * ((1 / aspect + aspect) / 2) ** 0.25, 1.0),
            specular_ior=(1 + root) / (1 - root),
            specular_roughness_anisotropy=1 - aspect,
            coat_weight=principled["coat"],
            coat_roughness=principled["coat_roughness"],
            coat_ior=1.5,
        )

    def inputs(self) -> dict:
        """Names and values of all inputs that matter, for files."""
        values = {name: _plain(value) for name, value in self._asdict().items()}
        return {"base_weight": 1.0, **values, "coat_darkening": 0.0}


def f_cos(p: OpenPbr, g: Geometry) -> np.ndarray:
    """f cos(theta_l) [views x lights x 3] in 1/sr; x is the tangent."""
    base = np.asarray(p.base_color, float)
    tint = np.asarray(p.specular_color, float)
    roughness = _below_coat(p)
    along = roughness**2 * math.sqrt(2 / ((1 - p.specular_roughness_anisotropy) ** 2 + 1))
    alphas = tuple(max(a, _MIN_ALPHA) for a in (along, along * (1 - p.specular_roughness_anisotropy)))
    alpha = math.sqrt(alphas[0] * alphas[1])
    shape, lost = lobe(g, *alphas)[..., None], _lost(g.nv, alpha)[..., None]

    fresnel = _metal_fresnel(base, tint, g.vh[..., None])
    metal = p.specular_weight * fresnel * shape * (1 + fresnel * lost)

    eta = _scaled_ior(_ior_below_coat(p), p.specular_weight)
    reflected, through = _dielectric(g, eta, alpha, shape[..., 0], lost[..., 0])
    dielectric = tint * reflected[..., None]
    dielectric = dielectric + through[..., None] * diffuse(base, p.base_diffuse_roughness, g)
    below = p.base_metalness * metal + (1 - p.base_metalness) * dielectric
    if p.coat_weight <= 0:
        return below
    coat_alpha = max(p.coat_roughness**2, _MIN_ALPHA)
    coat_lost = _lost(g.nv, coat_alpha)
    reflected, through = _dielectric(g, p.coat_ior, coat_alpha, lobe(g, coat_alpha, coat_alpha), coat_lost)
    passing = 1 - p.coat_weight * (1 - through)
    return p.coat_weight * reflected[..., None] + passing[..., None] * below


def diffuse(color: np.ndarray, roughness: float, g: Geometry) -> np.ndarray:
    """f cos of an energy-preserving Oren-Nayar surface [PKP24]; Lambert's for roughness 0."""
    if roughness <= 0:
        return color * (g.nl / np.pi)[..., None]
    a = 1 / (1 + (0.5 - 2 / (3 * np.pi)) * roughness)
    s = g.lv - g.nv * g.nl
    single = a * (1 + roughness * np.where(s > 0, s / np.maximum(np.maximum(g.nl, g.nv), 1e-6), s))
    lost = [np.maximum(1 - _oren_nayar_albedo(a, roughness, c), 0) for c in (g.nl, g.nv)]
    mean = a * (1 + (2 / 3 - 28 / (15 * np.pi)) * roughness)
    scattered = color**2 * mean / (1 - color * (1 - mean))
    multiple = scattered * (lost[0] * lost[1] / max(1 - mean, 1e-6))[..., None]
    return (color * single[..., None] + multiple) * (g.nl / np.pi)[..., None]


def _oren_nayar_albedo(a, roughness, cosine):
    sine = np.sqrt(np.maximum(1 - cosine**2, 0))
    g = sine * (np.arccos(np.clip(cosine, -1, 1)) - sine * cosine)
    g = g + 2 / 3 * (sine / cosine * (1 - sine**3) - sine)
    return a * (1 + roughness * g / np.pi)


def _below_coat(p):
    """Roughness of the base, blurred by the coat."""
    blurred = min(2 * p.coat_roughness**4 + p.specular_roughness**4, 1.0) ** 0.25
    return p.specular_roughness + p.coat_weight * (blurred - p.specular_roughness)


def _ior_below_coat(p):
    ratio = p.specular_ior / p.coat_ior
    return p.specular_ior + p.coat_weight * (max(ratio, 1 / ratio) - p.specular_ior)


def _scaled_ior(ior, weight):
    """The index whose reflectance at normal incidence is `weight` times that of `ior`."""
    root = (ior - 1) / (ior + 1)
    scaled = math.copysign(math.sqrt(min(weight * root**2, 0.99999)), root)
    return (1 + scaled) / (1 - scaled)


def _lost(nv, alpha):
    """(1 - E) / E of a white lobe: light lost between facets, which energy compensation returns [T19]."""
    first, rise = albedo(nv, alpha)
    white = np.clip(first + rise, 1e-3, 1)
    return (1 - white) / white


def _dielectric(g, ior, alpha, shape, lost):
    """Reflected f cos, and the share of the light that passes; [views x lights]."""
    fresnel = _dielectric_fresnel(g.vh, ior)
    gain = 1 + fresnel * lost
    f0 = ((ior - 1) / (ior + 1)) ** 2
    first, rise = albedo(g.nv, alpha)
    return fresnel * shape * gain, np.clip(1 - (f0 * first + rise) * gain, 0, 1)


def _dielectric_fresnel(cosine, ior):
    if abs(ior - 1) < 1e-6:
        return np.zeros_like(cosine)
    g = np.sqrt(np.maximum(ior**2 + cosine**2 - 1, 0))
    parallel = ((g + cosine) * cosine - 1) / ((g - cosine) * cosine + 1)
    return np.minimum(0.5 * ((g - cosine) / (g + cosine)) ** 2 * (1 + parallel**2), 1)


def _metal_fresnel(f0, tint, cosine):
    """Schlick's term, times `tint` at the cosine 1/7 [KHE21]."""
    at_82 = (f0 + (1 - f0) * schlick(_C82)) * (1 - tint) / (_C82 * (1 - _C82) ** 6)
    return np.maximum(f0 + (1 - f0) * schlick(cosine) - at_82 * cosine * (1 - cosine) ** 6, 0)


def _plain(value):
    return [float(each) for each in value] if np.ndim(value) else float(value)
