"""Values of an approximation in glTF, whose materials are mixtures of a dielectric and a metal."""

from __future__ import annotations

_DIELECTRIC = 0.04  # reflectance of glTF's dielectric at normal incidence
_NEGLIGIBLE = 1e-6
_LUMINANCE = (0.2126, 0.7152, 0.0722)


def base_and_metallic(principled, diffuse):
    """Base color and metallic factor of a Principled BSDF with an added diffuse base, all in linear Rec. 709.

    glTF has no such sum: what the metal reflects beyond a dielectric becomes the metallic part.
    """
    color = principled["base_color"]
    if max(diffuse) <= 0:
        return tuple(color), principled["metallic"]
    metal = [max(f0 - _DIELECTRIC, 0.0) for f0 in color]
    base = [m + d for m, d in zip(metal, diffuse, strict=True)]
    return tuple(base), _luminance(metal) / max(_luminance(base), 1e-9)


def extensions(principled, diffuse):
    """Extensions of the material by name, of a Principled BSDF with an added diffuse base."""
    found = {}
    if principled["coat"] > 0:
        found["KHR_materials_clearcoat"] = {
            "clearcoatFactor": principled["coat"],
            "clearcoatRoughnessFactor": principled["coat_roughness"],
        }
    factor, tint = (
        2 * principled["specular"],
        principled["specular_tint"],
    )  # of a dielectric; a metal has none
    color = [max(factor, 1.0) * each for each in tint]
    is_plain = max(abs(each - 1) for each in (factor, *tint)) < _NEGLIGIBLE
    if not is_plain and principled["metallic"] < 1 and max(diffuse) <= 0:
        found["KHR_materials_specular"] = {
            "specularFactor": min(factor, 1.0),
            "specularColorFactor": color,
        }
    return found


def _luminance(color):
    return sum(c * weight for c, weight in zip(color, _LUMINANCE, strict=True))
