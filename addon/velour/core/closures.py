"""Curves of a model for Blender's own nodes, and their error (docs/engine/closure_network.md)."""

from __future__ import annotations

from ..native import Model


def closures_of(model: Model, masking: str) -> dict:
    """What operators/closure_network.py takes, with the keys masking, relative_l2, by_view_angle and reason.

    masking: see Model.closures. relative_l2: the mean of the views up to 75 degrees. reason: a sentence if
    the error is large, otherwise "".
    """
    fit = model.closures(masking=masking)
    by_view_angle = zip(fit["views"], fit["relative_l2"], strict=True)
    return {
        "masking": masking,
        "frame": fit["frame"],
        "diffuse": fit["diffuse"],
        "lobes": fit["lobes"],
        "relative_l2": fit["relative_l2_mean"],
        "by_view_angle": {f"{view:g}": error for view, error in by_view_angle},
        "reason": fit["reason"],
    }
