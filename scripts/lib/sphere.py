"""The unit sphere as OBJ, with its exact normals."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from velour.core import files

_RINGS, _SECTORS = 128, 256


def write(path: Path) -> Path:
    theta = np.linspace(0, np.pi, _RINGS + 1)[:, None]
    phi = np.linspace(0, 2 * np.pi, _SECTORS, endpoint=False)[None, :]
    x, y = np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi)
    points = np.stack([x, y, np.broadcast_to(np.cos(theta), x.shape)], axis=-1).reshape(-1, 3)
    lines = [f"{kind} {x:.8f} {y:.8f} {z:.8f}" for kind in ("v", "vn") for x, y, z in points]
    lines += [f"f {a}//{a} {b}//{b} {c}//{c}" for a, b, c in _triangles()]
    files.write_text(path, "\n".join(lines) + "\n")
    return path


def _triangles():
    """Counter-clockwise seen from outside; omits triangles without area at the poles."""
    for ring in range(_RINGS):
        for sector in range(_SECTORS):
            a, b = (ring * _SECTORS + (sector + step) % _SECTORS + 1 for step in (0, 1))
            c, d = a + _SECTORS, b + _SECTORS
            if ring < _RINGS - 1:
                yield a, c, d
            if ring > 0:
                yield a, d, b
