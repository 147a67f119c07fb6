"""The scene of the BTF chart: a bent sheet under an environment."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from velour.core import files

CAMERA = "0,-2.6,1.9,0,0,0.307,28"
TILES = 6.0  # along the arc and along the axis of the sheet
_STRIPS = 96
_HALF_ANGLE = np.radians(80)


def write_sheet(path: Path) -> Path:
    """Part of a cylinder of radius 1 about the x axis, its top upwards, z up. Texture coordinates preserve
    lengths: one unit is the length of the arc, along the arc and along the axis."""
    angle = np.linspace(-_HALF_ANGLE, _HALF_ANGLE, _STRIPS + 1)
    length = 2 * _HALF_ANGLE
    lines = []
    for side, v in ((-length / 2, 0.0), (length / 2, 1.0)):
        for a in angle:
            lines.append(f"v {side:.6f} {np.sin(a):.6f} {np.cos(a):.6f}")
            lines.append(f"vn 0 {np.sin(a):.6f} {np.cos(a):.6f}")
            lines.append(f"vt {v:.6f} {(a + _HALF_ANGLE) / length:.6f}")
    for i in range(1, _STRIPS + 1):
        corners = (i, _STRIPS + 1 + i, _STRIPS + 2 + i, i + 1)
        lines.append("f " + " ".join(f"{c}/{c}/{c}" for c in corners))
    files.write_text(path, "\n".join(lines) + "\n")
    return path
