"""Texture coordinates of meshes that have none."""

import numpy as np
import pytest
from velour.core.projection import box_projection

AXES = [np.array(axis, float) for axis in ((1, 0, 0), (0, 1, 0), (0, 0, 1))]
NORMALS = [sign * axis for axis in AXES for sign in (1, -1)]


def projected(points, normal):
    return box_projection(np.array(points, float), np.tile(normal, (len(points), 1)).astype(float))


@pytest.mark.parametrize("normal", NORMALS)
def test_faces_along_axes_keep_lengths_and_are_not_mirrored(normal):
    """Who looks at the face sees u to the right of v: their product is the way that the face looks."""
    corners = np.eye(3) - np.outer(np.eye(3) @ normal, normal)  # of the axes on the face
    u, v = projected(corners, normal).T
    along_u, along_v = u @ np.eye(3), v @ np.eye(3)
    np.testing.assert_allclose(np.cross(along_u, along_v), normal, atol=1e-12)
    assert np.linalg.norm(along_u) == np.linalg.norm(along_v) == 1
    assert along_v[2 if normal[2] == 0 else 1] == 1  # up, where the face stands


def test_the_axis_that_a_face_faces_most():
    tilted = np.array((0.5, -0.7, 0.4))
    np.testing.assert_array_equal(projected([(1, 2, 3)], tilted), [(1, 3)])
    np.testing.assert_array_equal(projected([(1, 2, 3)], -tilted), [(-1, 3)])


def test_rounding_chooses_no_axis():
    """A slope of 45 degrees has the same projection whichever way its normal is rounded."""
    noise = np.random.default_rng(1).normal(scale=1e-6, size=(100, 3))
    points = np.tile((1.0, 2.0, 3.0), (100, 1))
    for normal in ((1, 1, 0), (0, 1, 1), (1, 0, -1), (1, 1, 1)):
        assert len(np.unique(box_projection(points, np.array(normal) + noise), axis=0)) == 1
