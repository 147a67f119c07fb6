"""What a panel says of a model's weaknesses: a sentence each, with what to do."""

from __future__ import annotations

import math
import re

from .plain_words import plain

# A line a view, and a list of all fitted views: beside a table of errors they say it twice.
_MISSED = re.compile(r"view (\d+) degrees: relative L2 |fitted views that miss the tolerance")
_UNSEEN = re.compile(r"view (\d+) degrees: the measurement does not cover it")
_LOOKS = (  # the largest tolerance of each
    (0.014, "most pictures look like the measurement, as at 0.02 already"),
    (0.05, "most pictures look like the measurement"),
    (0.2, "differences show side by side, hardly in the distance"),
    (math.inf, "differences show"),
)


def panel_warnings(info: dict) -> list[str]:
    """Of a model's info as the library gives it."""
    missed, unseen, others = [], [], []
    for warning in info["warnings"]:
        if match := _MISSED.match(warning):
            missed.append(match[1])
        elif match := _UNSEEN.match(warning):
            unseen.append(match[1])
        else:
            others.append(plain(warning))
    if unseen:
        guess = f"The measurement has no view at {_angles(unseen)}: what the model shows there is a guess."
        others.insert(0, f"{guess} Take a more complete measurement, or show other angles.")
    if missed:
        where = f"at {_angles(missed)}" if any(missed) else "between the reported views"
        remedy = "Raise Max Lobes and fit again; the plot Size shows what more would bring."
        others.insert(0, f"The tolerance of {info['tolerance']:g} is missed {where}. {remedy}")
    return others


def _angles(degrees: list[str | None]) -> str:
    return ", ".join(f"{angle}\N{DEGREE SIGN}" for angle in degrees if angle)


def gain_warning(albedo_max: float | None, gain: tuple[float, float, float]) -> str | None:
    """Where a tint makes a model reflect more light than falls on it. None of `albedo_max`: not known."""
    brightest = max(gain) * (albedo_max or 0.0)
    if max(gain) <= 1.0 or brightest <= 1.0:
        return None
    return f"Reflects up to {brightest:.2g} times the light that falls on it; lower Tint or Exposure."


def tolerance_words(tolerance: float) -> str:
    """What a tolerance looks like; docs/perceptual.md has what was looked at."""
    seen = next(words for most, words in _LOOKS if tolerance <= most)
    return f"At most {100 * tolerance:.3g} % off up to 75\N{DEGREE SIGN}, twice that beyond: {seen}."


def roughness_reason(info: dict, use_reference: bool) -> str | None:
    """Why a material cannot be made rougher, and what helps. `info`: of its model; empty: there is none."""
    if use_reference:
        return "Roughness Offset is for models; to use it, switch off Render from Measurement."
    if "texels" in info:
        return "Roughness Offset is for models of BRDFs; this one, of a BTF, is rendered as it was measured."
    return None
