"""Curvature of surfaces by their corner normals."""

import numpy as np
from velour.core.curvature import curvature_range


def _sphere_patch(radius, count=200, seed=3):
    """Small triangles on a sphere of that radius, and its outward normals."""
    numbers = np.random.default_rng(seed)
    normals = numbers.normal(size=(count, 1, 3)) + 0.05 * numbers.normal(size=(count, 3, 3))
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    return radius * normals, normals


def test_a_sphere_bends_alike_everywhere():
    corners, normals = _sphere_patch(2.0)
    np.testing.assert_allclose(curvature_range(corners, normals), (0.5, 0.5), rtol=1e-6)


def test_from_inside_it_is_hollow():
    corners, normals = _sphere_patch(2.0)
    np.testing.assert_allclose(curvature_range(corners, -normals), (-0.5, -0.5), rtol=1e-6)


def test_a_plane_does_not_bend():
    corners = np.random.default_rng(1).random((10, 3, 3)) * (1, 1, 0)
    assert curvature_range(corners, np.broadcast_to((0.0, 0.0, 1.0), corners.shape)) == (0, 0)


def test_what_has_no_extent_says_nothing():
    corners, normals = _sphere_patch(1.0, 4)
    corners[0], normals[1] = 0, np.nan
    least, largest = curvature_range(corners, normals)
    np.testing.assert_allclose((least, largest), (1, 1), rtol=1e-2)
    assert curvature_range(np.zeros((0, 3, 3)), np.zeros((0, 3, 3))) == (0, 0)
