"""Sentences for panels on a model's weaknesses, each with what to do."""

from __future__ import annotations

from .warning_table import sentence

# Warnings of errors, which the verdict replaces where there is one (core/verdict.py).
_ERRORS = {"views_exceed_tolerance", "fitted_views_exceed_tolerance", "noise_exceeds_tolerance"}


def panel_warnings(info: dict) -> list[str]:
    """`info`: a model's info from the library. Errors at the reported views stand for those at all views."""
    codes = {warning["code"] for warning in info["warning_codes"]}
    redundant = {"fitted_views_exceed_tolerance"} if "views_exceed_tolerance" in codes else set()
    if info.get("verdict"):
        redundant = _ERRORS
    return [sentence(warning) for warning in info["warning_codes"] if warning["code"] not in redundant]


def gain_warning(albedo_max: float | None, gain: tuple[float, float, float]) -> str | None:
    """Warns if a tint makes a model reflect more light than falls on it. `albedo_max` None: not known."""
    brightest = max(gain) * (albedo_max or 0.0)
    if max(gain) <= 1.0 or brightest <= 1.0:
        return None
    return f"The material reflects up to {brightest:.2g} times the light it receives. Lower Tint or Exposure."


def roughness_reason(info: dict, use_reference: bool) -> str | None:
    """Why a material cannot be made rougher, and what helps. `info`: its model's; empty without a model."""
    if use_reference:
        return "Roughness Offset has no effect on a measurement. Disable Render from Measurement to use it."
    if "texels" in info:
        return "Roughness Offset has no effect on the model of a BTF, which is rendered as measured."
    return None
