"""A flat patch seen from 30 to 50 degrees under a soft environment, and its cameras."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from velour.native import images

# At 40 degrees from a distance of 3: the near edge is seen at 30 degrees, the middle of the far edge at 50.
CAMERA = "0,-1.928,2.298,0,0.05,0,27"
MOVED_CAMERA = "0,-2.9,0.6,0,0.05,0,27"  # about 75 degrees
_NEAR, _FAR, _SIDE = -0.6, 0.81, 0.5
_AXIS = np.array([0.30, 0.51, 0.81])
_BANDWIDTH, _PEAK, _BASE = 4.0, 2.5, 0.4


def write_patch(path: Path) -> Path:
    """A quad in the plane z = 0, z up."""
    corners = [(-_SIDE, _NEAR), (_SIDE, _NEAR), (_SIDE, _FAR), (-_SIDE, _FAR)]
    lines = [f"v {x} {y} 0" for x, y in corners] + ["vt 0 0", "vt 1 0", "vt 1 1", "vt 0 1"]
    path.write_text("\n".join([*lines, "f 1/1 2/2 3/3 4/4", ""]), encoding="ascii")
    return path


def write_sky(path: Path, rows: int = 128) -> Path:
    """A dim dome with a bright patch of about 40 degrees radius; rows as in synthetic_sky."""
    elevation = (np.pi * ((np.arange(rows) + 0.5) / rows - 0.5))[:, None]
    azimuth = np.pi * (1 - (np.arange(2 * rows) + 0.5) / rows)[None, :]
    x, y, z = np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)
    ax, ay, az = _AXIS / np.linalg.norm(_AXIS)
    light = _BASE + _PEAK * np.exp(_BANDWIDTH * (ax * x + ay * y + az * z - 1))
    images.write(path, (light[..., None] * np.array([1.0, 0.95, 0.9])).astype(np.float32))
    return path
