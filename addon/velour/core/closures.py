"""Curves of a model for Blender's own nodes, and their error (docs/engine/closure_network.md)."""

from __future__ import annotations

import numpy as np

from ..native import Model, model_peer_job
from ..native.job_state import ProgressCallback

_STEPS = 65
_LARGE = 0.05  # a relative error that needs a reason
_ONE_LOBE = "It is anisotropic, so one GGX lobe has to do."


def closures_of(model: Model, masking: str, progress: ProgressCallback | None = None) -> dict:
    """What operators/closure_network.py takes, with the keys relative_l2, by_view_angle and reason.

    masking: see Model.closures. relative_l2: the mean of the views up to 75 degrees. reason: a sentence if
    the error is large, otherwise "".
    """
    if model.info().get("isotropic", True):
        return closures_of_fit(model.closures(masking=masking))
    with model_peer_job(model, "ggx") as job:
        return closures_of_ggx(job.run(progress))


def closures_of_fit(fit: dict) -> dict:
    """`fit`: from Model.closures; its curves lie in the plane of incidence."""
    return {
        "frame": "incidence",
        "diffuse": fit["diffuse"],
        "lobes": fit["lobes"],
        "relative_l2": fit["relative_l2_mean"],
        "by_view_angle": {
            f"{view:g}": error for view, error in zip(fit["views"], fit["relative_l2"], strict=True)
        },
        "reason": fit["reason"],
    }


def closures_of_ggx(report: dict) -> dict:
    """One GGX lobe in the frame of the surface; its color rises toward grazing views as Fresnel terms do.

    report: of the peer "ggx".
    """
    ggx = report["ggx"]
    cosine = np.cos(np.linspace(0, np.pi / 2, _STEPS))[:, None]
    f0, f90 = np.array(ggx["f0"]), np.array(ggx["f90"])
    along, across = ggx["alpha"]
    squeeze = (along / across) ** 0.5
    lobe = {
        "distribution": "GGX",
        "color": (f0 + (f90 - f0) * (1 - cosine) ** 5).tolist(),
        "roughness": [min((along * across) ** 0.25, 1.0)] * _STEPS,
        "tilt": [0.0] * _STEPS,
        "anisotropy": [1 - squeeze if squeeze < 1 else 1 / squeeze - 1] * _STEPS,
    }
    return {
        "frame": "surface",
        "diffuse": [list(ggx["diffuse"])] * _STEPS,
        "lobes": [lobe],
        "relative_l2": report["relative_l2"],
        "by_view_angle": report["by_view_angle"],
        "reason": _ONE_LOBE if report["relative_l2"] > _LARGE else "",
    }
