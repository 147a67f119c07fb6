"""Blender's matrices as the library wants them.

Both are right-handed, +z up, in metres; cameras and lights look along -z.
"""

import numpy as np


def affine(matrix):
    """3 x 4 row-major numpy array of a mathutils 4 x 4 matrix."""
    return np.array([row[:] for row in matrix[:3]], np.float32)


def unscaled(matrix):
    """`affine` with axes of length 1, as Blender's cameras and lights stand: mirrored, sheared, unscaled."""
    out = affine(matrix)
    lengths = np.linalg.norm(out[:, :3], axis=0)
    if lengths.min() > 0:
        out[:, :3] /= lengths
    else:
        out[:, :3] = np.array(matrix.to_quaternion().to_matrix(), np.float32)
    return out


def column_lengths(matrix):
    """How much the matrix stretches the local x, y and z axes."""
    return tuple(matrix.col[axis].to_3d().length for axis in range(3))
