"""Texture coordinates for meshes that have none."""

import numpy as np

# Breaks ties: of axes that a face faces equally, rounding would choose a different one for each face.
_PREFERENCE = np.array((1, 1 + 1e-4, 1 + 2e-4))


def box_projection(positions: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """[n x 2] for points [n x 3] on faces with these normals [n x 3], in the unit of the points.

    Each face is projected along its dominant axis, seen from outside: u points right and v up, or along y
    if the face points up or down. Nothing is mirrored.
    """
    axis = np.argmax(np.abs(normals) * _PREFERENCE, axis=1)
    x, y, z = positions.T
    right = np.choose(axis, (y, -x, x))
    is_behind = np.take_along_axis(normals, axis[:, None], axis=1)[:, 0] < 0
    return np.stack([np.where(is_behind, -right, right), np.where(axis == 2, y, z)], axis=1)
