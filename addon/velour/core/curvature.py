"""Curvature of a surface, from its corner normals."""

from __future__ import annotations

import numpy as np


def curvature_range(corners: np.ndarray, normals: np.ndarray) -> tuple[float, float]:
    """Smallest and largest normal curvature along the edges of triangles, in 1 / the unit of the corners.

    Convex is positive. `corners`, `normals` [n x 3 x 3]: triangle, corner, x y z; normals are unit. Edges
    of length 0 are left out; (0, 0) if no edge remains.
    """
    edges = np.roll(corners, -1, axis=1) - corners
    turns = np.roll(normals, -1, axis=1) - normals
    square = np.einsum("tki,tki->tk", edges, edges)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        curvature = np.einsum("tki,tki->tk", turns, edges) / square
    curvature = curvature[(square > 0) & np.isfinite(curvature)]
    if not curvature.size:
        return 0.0, 0.0
    return float(curvature.min()), float(curvature.max())
