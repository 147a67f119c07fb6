"""What a panel says of a model's weaknesses: a sentence each, with what to do."""

from __future__ import annotations

import re

# A line a view, and a list of all fitted views: beside a table of errors they say it twice.
_MISSED = re.compile(r"view (\d+) degrees: relative L2 |fitted views that miss the tolerance")


def panel_warnings(info: dict) -> list[str]:
    """Of a model's info as the library gives it."""
    missed = [_MISSED.match(warning) for warning in info["warnings"]]
    others = [warning for warning, match in zip(info["warnings"], missed, strict=True) if not match]
    if not any(missed):
        return others
    angles = [f"{match[1]}\N{DEGREE SIGN}" for match in missed if match and match[1]]
    where = f" at {', '.join(angles)}" if angles else " between the reported views"
    remedy = "More lobes may help (Max Lobes); the plot Size shows what each brings."
    return [f"The tolerance of {info['tolerance']:g} is missed{where}. {remedy}", *others]


def gain_warning(albedo_max: float | None, gain: tuple[float, float, float]) -> str | None:
    """Where a tint makes a model reflect more light than falls on it. None of `albedo_max`: not known."""
    brightest = max(gain) * (albedo_max or 0.0)
    if max(gain) <= 1.0 or brightest <= 1.0:
        return None
    return f"Reflects up to {brightest:.2g} times the light that falls on it; lower Tint or Exposure."


def roughness_reason(info: dict, use_reference: bool) -> str | None:
    """Why a material cannot be made rougher, and what helps. `info`: of its model; empty: there is none."""
    if use_reference:
        return "Roughness Offset is for models; to use it, switch off Render from Measurement."
    if "texels" in info:
        return "Roughness Offset is for models of BRDFs; this one, of a BTF, is rendered as it was measured."
    return None
