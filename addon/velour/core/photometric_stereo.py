"""The normals of a surface from pictures of it under one light each [Woo80]."""

from __future__ import annotations

import numpy as np

_DARKEST = 1 / 4  # share of a texel's pictures left out as shadows; black ones always are
_KEPT = 1 / 3  # share of the others that is kept, the darkest: the rest may be highlights
_LEAST_UP = 0.17  # cosine to the vertical; steeper normals are edges or holes
_LEAST_VOLUME = 1e-3  # determinant of the mean of l l^T; below it the kept lights lie in a plane
_SHADOW = 1e-3  # black, relative to a texel's brightest picture
_BLACK = 1e-3  # black, relative to the mean of all texels
_TEXELS = 1 << 14  # texels solved at once


def normals_of(lights: np.ndarray, radiance: np.ndarray, coverage: np.ndarray) -> np.ndarray:
    """Unit normals [rows x columns x 3] of a tile whose mean slope is 0.

    lights [k x 3]: unit directions towards the lights, which are equally strong; radiance [k x rows x
    columns]; coverage [rows x columns], 0 where there is no surface. The normal is (0, 0, 1) where the
    radiance is inconclusive.
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
    """rho n [t x 3] from radiance [k x t] = rho n . l [Woo80], by least squares over the kept pictures."""
    ranked = np.argsort(radiance, axis=0, kind="stable")
    values, places = np.take_along_axis(radiance, ranked, axis=0), np.arange(len(lights))[:, None]
    black = (values <= _SHADOW * values[-1]).sum(axis=0)
    first = np.maximum(round(len(lights) * _DARKEST), black)
    kept = (places >= first) & (places < first + np.ceil((len(lights) - first) * _KEPT))
    directions = lights[ranked] * kept[..., None]  # [k x t x 3]
    squares = np.einsum("kti,ktj->tij", directions, directions) / np.maximum(kept.sum(0), 1)[:, None, None]
    flat = np.linalg.det(squares) < _LEAST_VOLUME
    products = np.einsum("kti,kt->ti", directions, values) / np.maximum(kept.sum(0), 1)[:, None]
    squares[flat], products[flat] = np.eye(3), 0
    return np.linalg.solve(squares, products[..., None])[..., 0]


def _upright(slopes: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Subtracts the mean of the slopes: those of a periodic surface sum to zero, so any mean is an error."""
    mean = (slopes * weights[..., None]).sum((0, 1)) / max(float(weights.sum()), 1e-30)
    slopes = np.where(weights[..., None] > 0, slopes - mean, 0.0)
    normals = np.dstack([slopes, np.ones(slopes.shape[:2])])
    return normals / np.linalg.norm(normals, axis=-1, keepdims=True)
