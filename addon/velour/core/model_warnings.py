"""Sentences for panels on a model's weaknesses, each with what to do."""

from __future__ import annotations

import math

from .warning_table import sentence

_LOOKS = (  # (largest tolerance, what the errors look like)
    (0.014, "most images look like the measurement, as they already do at 0.02"),
    (0.05, "most images look like the measurement"),
    (0.2, "differences are visible side by side, but hardly from a distance"),
    (math.inf, "differences are visible"),
)


def panel_warnings(info: dict) -> list[str]:
    """`info`: a model's info from the library. Errors at the reported views stand for those at all views."""
    codes = {warning["code"] for warning in info["warning_codes"]}
    redundant = {"fitted_views_exceed_tolerance"} if "views_exceed_tolerance" in codes else set()
    return [sentence(warning) for warning in info["warning_codes"] if warning["code"] not in redundant]


def gain_warning(albedo_max: float | None, gain: tuple[float, float, float]) -> str | None:
    """Warns if a tint makes a model reflect more light than falls on it. `albedo_max` None: not known."""
    brightest = max(gain) * (albedo_max or 0.0)
    if max(gain) <= 1.0 or brightest <= 1.0:
        return None
    return f"The material reflects up to {brightest:.2g} times the light it receives. Lower Tint or Exposure."


def tolerance_words(tolerance: float) -> str:
    """Describes how visible errors within a tolerance are. Measured in docs/results/perceptual.md."""
    seen = next(words for most, words in _LOOKS if tolerance <= most)
    return f"Error of at most {100 * tolerance:.3g} % up to 75\N{DEGREE SIGN}, twice that beyond: {seen}."


def roughness_reason(info: dict, use_reference: bool) -> str | None:
    """Why a material cannot be made rougher, and what helps. `info`: its model's; empty without a model."""
    if use_reference:
        return "Roughness Offset has no effect on a measurement. Disable Render from Measurement to use it."
    if "texels" in info:
        return "Roughness Offset has no effect on the model of a BTF, which is rendered as measured."
    return None
