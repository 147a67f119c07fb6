"""Blender's matrices as the library wants them.

Both are right-handed, +z up, in metres; cameras and lights look along -z.
"""

import numpy as np


def affine(matrix):
    """3 x 4 row-major numpy array of a mathutils 4 x 4 matrix."""
    return np.array([row[:] for row in matrix[:3]], np.float32)


def rigid(matrix):
    """`affine` without scale and shear, which Blender's cameras and lights do not obey."""
    location, rotation, _scale = matrix.decompose()
    out = np.empty((3, 4), np.float32)
    out[:, :3] = np.array(rotation.to_matrix(), np.float32)
    out[:, 3] = location
    return out


def column_lengths(matrix):
    """How much the matrix stretches the local x, y and z axes."""
    return tuple(matrix.col[axis].to_3d().length for axis in range(3))
