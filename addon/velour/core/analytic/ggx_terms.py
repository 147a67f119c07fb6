"""The GGX lobe and its albedo, as analytic materials use them, on NumPy arrays."""

from __future__ import annotations

import functools
from typing import NamedTuple

import numpy as np

_COSINES, _ROUGHNESSES, _SAMPLES = 32, 32, 24  # of the table of albedos


class Geometry(NamedTuple):
    """Cosines [views x lights] of pairs of directions; half vectors in the local frame."""

    nv: np.ndarray
    nl: np.ndarray
    lv: np.ndarray
    vh: np.ndarray
    h: np.ndarray  # [views x lights x 3]

    @classmethod
    def of(cls, wv: np.ndarray, wl: np.ndarray) -> Geometry:
        """wv [views x 3], wl [views x lights x 3]: unit vectors above the horizon."""
        view = np.broadcast_to(np.asarray(wv, float)[:, None], wl.shape)
        h = view + wl
        h = h / np.linalg.norm(h, axis=-1, keepdims=True)
        lv, vh = (wl * view).sum(-1), (h * view).sum(-1)
        return cls(np.maximum(view[..., 2], 1e-6), np.maximum(wl[..., 2], 1e-6), lv, np.clip(vh, 1e-6, 1), h)


def lobe(geometry: Geometry, alpha_x: float, alpha_y: float) -> np.ndarray:
    """D G2 / (4 n.v) in 1/sr [WMLT07]: the cosine of the light is a factor. G2 is height-correlated [H14]."""
    h = geometry.h
    spread = (h[..., 0] / alpha_x) ** 2 + (h[..., 1] / alpha_y) ** 2 + h[..., 2] ** 2
    alpha_sq = alpha_x * alpha_y
    light, view = (np.sqrt(alpha_sq + (1 - alpha_sq) * c**2) for c in (geometry.nl, geometry.nv))
    masking = 2 * geometry.nl * geometry.nv / (light * geometry.nv + view * geometry.nl)
    return masking / (np.pi * alpha_sq * spread**2 * 4 * geometry.nv)


def schlick(cosine: np.ndarray) -> np.ndarray:
    return (1 - cosine) ** 5


def albedo(cosine: np.ndarray, alpha: float) -> tuple[np.ndarray, np.ndarray]:
    """Directional albedos of a lobe whose Fresnel term is 1 - (1 - v.h)^5, and (1 - v.h)^5."""
    table = _albedo_table()
    row = np.clip(np.sqrt(alpha), 0, 1) * (_ROUGHNESSES - 1)
    first = min(int(row), _ROUGHNESSES - 2)
    curves = table[first] + (row - first) * (table[first + 1] - table[first])
    grid = (np.arange(_COSINES) + 0.5) / _COSINES
    return np.interp(cosine, grid, curves[:, 0]), np.interp(cosine, grid, curves[:, 1])


@functools.lru_cache(maxsize=1)
def _albedo_table():
    """[roughnesses x cosines x 2], by visible normals [H18]."""
    side = (np.arange(_SAMPLES) + 0.5) / _SAMPLES
    u, v = (axis.ravel() for axis in np.meshgrid(side, side))
    cosines = ((np.arange(_COSINES) + 0.5) / _COSINES)[:, None]
    rows = [_albedos(cosines, max((i / (_ROUGHNESSES - 1)) ** 2, 1e-3), u, v) for i in range(_ROUGHNESSES)]
    return np.stack(rows)


def _albedos(nv, alpha, u, v):
    sine = np.sqrt(1 - nv**2)
    stretched = np.concatenate([alpha * sine, nv], axis=1)
    stretched /= np.linalg.norm(stretched, axis=1, keepdims=True)
    # Uniform on the cap of the hemisphere that the view sees.
    z = (1 - u) * (1 + stretched[:, 1:]) - stretched[:, 1:]
    radius = np.sqrt(np.maximum(1 - z**2, 0))
    hx, hy = radius * np.cos(2 * np.pi * v) + stretched[:, :1], radius * np.sin(2 * np.pi * v)
    hz = np.maximum(z + stretched[:, 1:], 1e-9)
    length = np.sqrt((alpha * hx) ** 2 + (alpha * hy) ** 2 + hz**2)
    vh = (alpha * hx * sine + hz * nv) / length
    nl = 2 * vh * hz / length - nv
    root_l, root_v = (np.sqrt(alpha**2 + (1 - alpha**2) * c**2) for c in (np.maximum(nl, 1e-6), nv))
    weight = np.where(nl > 0, nl * (nv + root_v) / (root_l * nv + root_v * nl + 1e-12), 0)  # G2 / G1
    rise = schlick(np.clip(vh, 0, 1))
    return np.stack([(weight * (1 - rise)).mean(1), (weight * rise).mean(1)], axis=-1)
