"""Texture coordinates for meshes that have none."""

import numpy as np

# Of axes that faces face equally rounding would choose another one for each face.
_PREFERENCE = np.array((1, 1 + 1e-4, 1 + 2e-4))


def box_projection(positions: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """[n x 2] of points [n x 3] on faces of these normals [n x 3], in the unit of the points.

    Each face is seen along the axis that it faces most, from outside: u to the right and v up, of what faces
    up or down along y. Nothing is mirrored.
    """
    axis = np.argmax(np.abs(normals) * _PREFERENCE, axis=1)
    x, y, z = positions.T
    right = np.choose(axis, (y, -x, x))
    is_behind = np.take_along_axis(normals, axis[:, None], axis=1)[:, 0] < 0
    return np.stack([np.where(is_behind, -right, right), np.where(axis == 2, y, z)], axis=1)
