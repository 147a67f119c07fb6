"""The verdict on a fit in one line: whether the model looks like the measurement, and what to do if not.

The library stores it with the model as quality, reason and numbers (native/src/model/records.h).
"""

from __future__ import annotations

from typing import NamedTuple

MAX_LOBES = {"parametric": 32, "scattered": 64}
_MIN_ERROR = 0.0005  # of the setting Max Error
_BTF_GROWTH = 4  # factor on the bytes of a BTF's model
_MOST_OF_BTF = 0.25  # largest share of the BTF's bytes

# What follows "Fair: " and "Poor: ", by reasons that have no words of their own below.
REASONS = {
    "grazing_views": "differs at grazing views",
    "highlights": "differs in the highlights",
    "color": "differs in color",
    "everywhere": "differs at all views",
}


class Remedy(NamedTuple):
    """A change of the settings of the fit."""

    label: str  # of the button that fits again
    question: str
    advice: str
    settings: dict  # properties of the operator velour.fit, for BTFs of velour.compress_btf


class Line(NamedTuple):
    text: str
    remedy: Remedy | None = None
    is_good: bool = False


def line(info: dict) -> Line | None:
    """None: not judged. `info`: a model's from the library, or a report of a comparison, which names no
    remedy."""
    verdict = info.get("verdict")
    if not verdict:
        return None
    if verdict["quality"] == "good":
        return Line("Good: looks like the measurement", is_good=True)
    reason, quality = _reason(verdict), verdict["quality"].capitalize()
    cause = _cause(info)
    if cause is not None:
        return Line(f"{quality}: {cause}")
    remedy = _remedy(info)
    if remedy is None:
        return Line(f"{quality}: {reason}")
    if quality == "Fair":
        return Line(f"Fair: {reason}; {remedy.question}", remedy)
    return Line(f"Poor: {reason}. {remedy.advice}", remedy)


def line_for(info: dict, digest: str | None) -> Line | None:
    """line() beside a measurement. `digest`: its SHA-256; empty: not known; None: there is no measurement."""
    source = info["source"]
    if digest and source["sha256"] and digest != source["sha256"]:
        return Line(f"The model was fitted to another measurement, '{source['name']}'. Fit again")
    return line(info)


def with_text(info: dict) -> dict | None:
    """The verdict of line(), with the line as `text`."""
    found = line(info)
    return {"text": found.text, **info["verdict"]} if found else None


def _cause(info: dict) -> str | None:
    """What no fit can mend, and the remedy."""
    if info["verdict"]["reason"] == "measurement_noise":
        return "the measurement is noisy. More lobes do not help; use a cleaner measurement"
    if info["verdict"]["reason"] == "unresolved_highlights":
        apart = info["verdict"]["value"]
        return (
            f"samples {apart:.0f}° apart do not resolve the highlights. More lobes do not help; measure more"
        )
    if info["verdict"]["reason"] == "anisotropic_samples":
        return "the surface is brushed, and the model is not. Use a measurement with azimuths"
    if info["verdict"]["reason"] == "held_out_samples":
        return "misses samples that were held out. More lobes do not help; measure more directions"
    if any(warning["code"] == "few_samples" for warning in info.get("warning_codes", ())):
        return "the measurement has too few samples. More lobes do not help; use a denser measurement"
    return None


def _reason(verdict: dict) -> str:
    if verdict["reason"] == "brightness":
        change = verdict["value"] - 1
        return f"{abs(change):.0%} {'brighter' if change > 0 else 'darker'} than the measurement"
    return REASONS.get(verdict["reason"], "differs from the measurement")


def _remedy(info: dict) -> Remedy | None:
    """The next larger model: more lobes if the fit ran out of them, otherwise a smaller error."""
    if "model" not in info:  # a report
        return None
    if "texels" in info:
        size = _BTF_GROWTH * info["parameter_bytes"]
        if size > _MOST_OF_BTF * info["raw_bytes"]:
            return None
        return Remedy("Larger Model", "larger model?", "Fit a larger model", {"megabytes": size / 1e6})
    order = info.get("order") or {}
    if not order.get("lobes"):
        return None
    lobes, kind = max(order["lobes"]), info["model"]
    at = order["chosen"] if order["chosen"] is not None else -1
    if order["worst"][at] <= 1 and info["tolerance"] > _MIN_ERROR:
        smaller = max(info["tolerance"] / 2, _MIN_ERROR)
        label = "Smaller Error"
        return Remedy(label, "smaller error?", "Fit with a smaller error", {"tolerance": smaller})
    if lobes < MAX_LOBES[kind]:
        more = min(2 * lobes, MAX_LOBES[kind])
        return Remedy("More Lobes", "more lobes?", "Fit with more lobes", {"max_lobes": more})
    if kind == "parametric":
        settings = {"model": "SCATTERED", "max_lobes": 32}
        return Remedy("Per-View Model", "per-view model?", "Fit a per-view model", settings)
    return None
