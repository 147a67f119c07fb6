"""Applies an artist's tint, exposure and roughness to the values of an approximation."""

from __future__ import annotations

from typing import NamedTuple


class Look(NamedTuple):
    """The defaults leave the approximation as it was fitted."""

    gain: tuple = (1.0, 1.0, 1.0)  # factor on reflected light
    roughness: float = 0.0  # highlights are spread as a mirror would be by this Blender roughness


def with_look(values: dict, look: Look) -> dict:
    """Applies `look` to `principled`, `anisotropic`, `diffuse` of an Approximation, in the gain's space.

    Colors and weights are clamped to 1: anything brighter than white becomes white.
    """
    given = values["principled"]
    brightness = sum(look.gain) / 3
    roughness, anisotropic = _spread(given["roughness"], values["anisotropic"], look.roughness)
    coat_roughness, _ = _spread(given["coat_roughness"], 0.0, look.roughness)
    # A metal's base color already has the gain; its own tint, for grazing views, is relative to that.
    metallic = given["metallic"]
    tints = (
        t * (metallic + (1 - metallic) * _over(g, brightness))
        for t, g in zip(given["specular_tint"], look.gain, strict=True)
    )
    return {
        **values,
        "principled": {
            **given,
            "base_color": dyed(given["base_color"], look.gain),
            "roughness": roughness,
            "specular": min(given["specular"] * brightness, 1.0),
            "specular_tint": tuple(tints),
            "coat": min(given["coat"] * brightness, 1.0),
            "coat_roughness": coat_roughness,
        },
        "anisotropic": anisotropic,
        "diffuse": dyed(values["diffuse"], look.gain),
    }


def dyed(color, gain):
    return tuple(min(c * g, 1.0) for c, g in zip(color, gain, strict=True))


def _over(part, whole):
    return part / whole if whole > 0 else 1.0


def _spread(roughness, anisotropic, offset):
    """Roughness and anisotropy of a highlight, spread as `offset` spreads a mirror: squared alphas add."""
    aspect = (1 - 0.9 * anisotropic) ** 0.5  # Blender's alphas are r^2 / aspect and r^2 aspect
    wide, narrow = ((roughness**4 * a + offset**4) ** 0.5 for a in (1 / aspect**2, aspect**2))
    if wide == 0:
        return 0.0, anisotropic
    return min((wide * narrow) ** 0.25, 1.0), (1 - narrow / wide) / 0.9
