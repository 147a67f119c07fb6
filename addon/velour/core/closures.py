"""Curves of a model for Blender's own nodes, and their error (docs/engine/closure_network.md)."""

from __future__ import annotations

import numpy as np

from ..native import Model, model_peer_job
from ..native.job_state import ProgressCallback

_STEPS = 65


def closures_of(model: Model, progress: ProgressCallback | None = None) -> dict:
    """What operators/closure_network.py takes, with the keys relative_l2 and by_view_angle.

    One GGX lobe in the frame of the surface, whose color rises toward grazing views as its Fresnel term does.
    """
    with model_peer_job(model, "ggx") as job:
        report = job.run(progress)
    errors = {key: report[key] for key in ("relative_l2", "by_view_angle")}
    return {**closures_of_ggx(report["ggx"]), **errors}


def closures_of_ggx(ggx: dict) -> dict:
    """The curves of a GGX lobe over a diffuse base, with the keys of the report of a fitted GGX lobe."""
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
    return {"frame": "surface", "diffuse": [list(ggx["diffuse"])] * _STEPS, "lobes": [lobe]}
