"""The normals of a surface from pictures of it under one light each [Woo80]."""

from __future__ import annotations

import numpy as np

_DARKEST, _BRIGHTEST = 1 / 4, 1 / 2  # of a texel's pictures, left out as shadows and as highlights
_LEAST_UP = 0.17  # cosine from the vertical: what seems steeper is an edge or a hole
_LEAST_VOLUME = 1e-3  # determinant of the mean of l l^T: below it the lights kept lie in a plane
_BLACK = 1e-3  # of the mean of all texels
_TEXELS = 1 << 14  # that are solved at once


def normals_of(lights: np.ndarray, radiance: np.ndarray, coverage: np.ndarray) -> np.ndarray:
    """Unit normals [rows x columns x 3] of a tile of which the mean is upright.

    lights: unit, towards them, [k x 3]; radiance [k x rows x columns], all of them as strong; coverage
    [rows x columns], 0 where there is nothing. Where radiance tells nothing the normal is (0, 0, 1).
    """
    columns = radiance.reshape(len(lights), -1)
    parts = [_scaled(lights, columns[:, t : t + _TEXELS]) for t in range(0, columns.shape[1], _TEXELS)]
    scaled = np.concatenate(parts).reshape(*radiance.shape[1:], 3)
    length = np.linalg.norm(scaled, axis=-1)
    up = scaled[..., 2] / np.maximum(length, 1e-30)
    told = (coverage > 0) & (length > _BLACK * radiance.mean()) & (up > _LEAST_UP)
    slopes = scaled[..., :2] / np.where(told, scaled[..., 2], 1.0)[..., None]
    return _upright(slopes, np.where(told, coverage, 0.0))


def root_mean_square_slope(normals: np.ndarray) -> float:
    return float(np.sqrt(((normals[..., :2] / normals[..., 2:]) ** 2).sum(-1).mean()))


def _scaled(lights: np.ndarray, radiance: np.ndarray) -> np.ndarray:
    """rho n [t x 3] of radiance [k x t] = rho n . l [Woo80], by least squares over what is kept."""
    count = len(lights)
    ranked = np.argsort(radiance, axis=0, kind="stable")
    kept = ranked[round(count * _DARKEST) : count - round(count * _BRIGHTEST)]
    directions = lights[kept]  # [m x t x 3]
    values = np.take_along_axis(radiance, kept, axis=0)
    squares = np.einsum("mti,mtj->tij", directions, directions) / len(kept)
    flat = np.linalg.det(squares) < _LEAST_VOLUME
    squares[flat], products = np.eye(3), np.einsum("mti,mt->ti", directions, values) / len(kept)
    products[flat] = 0
    return np.linalg.solve(squares, products[..., None])[..., 0]


def _upright(slopes: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """The slopes of a surface that repeats sum up to nothing: what is left of their mean is not its own."""
    mean = (slopes * weights[..., None]).sum((0, 1)) / max(float(weights.sum()), 1e-30)
    slopes = np.where(weights[..., None] > 0, slopes - mean, 0.0)
    normals = np.dstack([slopes, np.ones(slopes.shape[:2])])
    return normals / np.linalg.norm(normals, axis=-1, keepdims=True)
