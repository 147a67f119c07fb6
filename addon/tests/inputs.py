"""Synthetic inputs, and models that the repository has."""

from __future__ import annotations

from pathlib import Path

import numpy as np

_MODELS = Path(__file__).resolve().parents[2] / "blend-tests/scenes/data"
BTF_MODEL, BRUSHED_MODEL = _MODELS / "weave.velour", _MODELS / "brushed.velour"
MERL_SHAPE = (90, 90, 180)
_MERL_SCALE = np.array([1.0, 1.15, 1.66]) / 1500.0


def write_merl(path: Path, color=(0.5, 0.2, 0.1), gloss=0.8, sharpness=60.0) -> Path:
    """Diffuse `color` / pi and a lobe gloss exp(sharpness (cos theta_h - 1)), in 1/sr."""
    theta_h = np.radians(np.arange(90) ** 2 / 90.0)
    lobe = gloss * np.exp(sharpness * (np.cos(theta_h) - 1.0))
    with open(path, "wb") as file:
        np.array(MERL_SHAPE, "<i4").tofile(file)
        for channel in range(3):
            f = (color[channel] / np.pi + lobe) / _MERL_SCALE[channel]
            np.broadcast_to(f[:, None, None], MERL_SHAPE).astype("<f8").tofile(file)
    return path


def write_ribs(path: Path) -> Path:
    """One of them, 1 x 1 across and 0.3 high: a tile whose capture takes little."""
    corners = ["0 0 0", "0.7 0 0.3", "1 0 0", "0 1 0", "0.7 1 0.3", "1 1 0"]
    faces = ["1 2 5", "1 5 4", "2 3 6", "2 6 5"]
    path.write_text("".join(f"v {c}\n" for c in corners) + "".join(f"f {f}\n" for f in faces))
    return path


def write_octahedron(path: Path) -> Path:
    corners = ["1 0 0", "-1 0 0", "0 1 0", "0 -1 0", "0 0 1", "0 0 -1"]
    faces = ["1 3 5", "3 2 5", "2 4 5", "4 1 5", "3 1 6", "2 3 6", "4 2 6", "1 4 6"]
    path.write_text("".join(f"v {c}\n" for c in corners) + "".join(f"f {f}\n" for f in faces))
    return path
