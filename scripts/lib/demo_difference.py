"""The difference between the renders of the model and of its measurement or BTF."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from velour.native import images


def write_difference(folder: Path) -> tuple[float, float]:
    """Writes difference.{exr,png} of model.exr and reference.exr; returns rmse and relmse."""
    model, reference = (
        images.read(folder / f"{name}.exr")[..., :3].copy() for name in ("model", "reference")
    )
    difference = np.ascontiguousarray(np.abs(model - reference))
    for name in ("difference.exr", "difference.png"):
        images.write(folder / name, difference)
    return images.compare(model, reference)
