"""Converts Blender's matrices for the library.

Both are right-handed, +z up, in meters; cameras and lights look along -z.
"""

import numpy as np


def affine(matrix):
    """3 x 4 row-major numpy array of a mathutils 4 x 4 matrix."""
    return np.array([row[:] for row in matrix[:3]], np.float32)


def unscaled(matrix):
    """`affine` with unit axes: Blender's cameras and lights keep mirroring and shear, but ignore scale."""
    out = affine(matrix)
    lengths = np.linalg.norm(out[:, :3], axis=0)
    if lengths.min() > 0:
        out[:, :3] /= lengths
    else:
        out[:, :3] = np.array(matrix.to_quaternion().to_matrix(), np.float32)
    return out


def column_lengths(matrix):
    """Scale factors of the local x, y and z axes."""
    return tuple(matrix.col[axis].to_3d().length for axis in range(3))
