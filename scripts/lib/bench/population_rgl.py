"""Writes a BRDF in the adaptive parameterization of the RGL material database [RGL]."""

from __future__ import annotations

import struct
from collections.abc import Callable
from pathlib import Path

import numpy as np

# The database's isotropic files have these views (radians) and nodes along each axis.
_VIEWS = np.array([0.0, 0.48, 0.694, 0.872, 1.037, 1.2, 1.373, 0.5 * np.pi])
_NORMALS, _WARP = 128, 128
_LAST_VIEW = np.radians(88)  # formulas have no limit at the horizon


def write(path: Path, brdf: Callable, samples: int, noise: float, random: np.random.Generator) -> None:
    """`brdf`: f of wl [n, 3] and wv [n, 3], in 1/sr. `samples`: nodes along each axis of a view."""
    u = np.linspace(0, 1, _NORMALS)
    theta = 0.5 * np.pi * u**2
    normals = _normal_distribution(brdf, theta)
    areas = _projected_areas(normals, theta)
    warps, colors = [], []
    for view in _VIEWS:
        wv = np.array([np.sin(min(view, _LAST_VIEW)), 0, np.cos(min(view, _LAST_VIEW))])
        warp = _visible_normals(normals, u, wv)
        warps.append(warp)
        grid = np.linspace(0, 1, samples)
        x, y = _warped(warp, *(axis.ravel() for axis in np.meshgrid(grid, grid)))
        values = _f_cos(brdf, wv, 0.5 * np.pi * x**2, (2 * y - 1) * np.pi)
        values *= (4 * np.interp(np.sqrt(2 * view / np.pi), u, areas) / np.interp(x, u, normals))[:, None]
        values *= np.maximum(1 + noise * random.standard_normal((len(x), 1)), 0)
        colors.append(values.T.reshape(3, samples, samples))
    rgb = np.array(colors)[None]
    fields = {
        "description": np.frombuffer(b"made from a formula", np.uint8),
        "jacobian": np.ones(1, np.uint8),
        "phi_i": np.zeros(1, "<f4"),
        "theta_i": _VIEWS.astype("<f4"),
        "sigma": np.stack([areas, areas]).astype("<f4"),
        "ndf": np.stack([normals, normals]).astype("<f4"),
        "vndf": np.array(warps)[None].astype("<f4"),
        "luminance": rgb.mean(2).astype("<f4"),
        "rgb": rgb.astype("<f4"),
    }
    path.write_bytes(_tensor_file(fields))


def _direction(theta: np.ndarray, phi: np.ndarray) -> np.ndarray:
    theta, phi = np.broadcast_arrays(theta, phi)
    return np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], -1)


def _normal_distribution(brdf: Callable, theta: np.ndarray) -> np.ndarray:
    """From retroreflection, as the database's: D with an integral of D cos of 1."""
    w = _direction(np.minimum(theta, _LAST_VIEW), 0 * theta)
    found = np.maximum(brdf(w, w).mean(1) * w[:, 2] ** 2, 1e-6)
    return found / np.trapz(2 * np.pi * found * np.cos(theta) * np.sin(theta), theta)


def _projected_areas(normals: np.ndarray, theta: np.ndarray) -> np.ndarray:
    phi = np.linspace(0, 2 * np.pi, 128, endpoint=False)
    m = _direction(theta[:, None], phi[None])
    views = _direction(theta, 0 * theta)
    seen = np.maximum(np.einsum("tpk,vk->vtp", m, views), 0).mean(2) * 2 * np.pi
    return np.trapz(seen * normals * np.sin(theta), theta, axis=1)


def _visible_normals(normals: np.ndarray, u: np.ndarray, wv: np.ndarray) -> np.ndarray:
    """Density over the unit square of (u of theta, v of phi), [v, u]; its integral is 1."""
    x = np.linspace(0, 1, _WARP)
    theta, phi = 0.5 * np.pi * x**2, (2 * np.linspace(0, 1, _WARP) - 1) * np.pi
    seen = np.maximum(_direction(theta[None], phi[:, None]) @ wv, 0)
    density = seen * (np.interp(x, u, normals) * x * np.sin(theta))[None]
    return density / np.trapz(np.trapz(density, x), x)


def _warped(density: np.ndarray, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The positions with these shares of a bilinear density below them: of its rows, then along the row."""
    rows = np.trapz(density, axis=1)
    row = _inverted(rows[None].repeat(len(y), 0), y)
    low = np.minimum(row.astype(int), len(rows) - 2)
    part = (row - low)[:, None]
    column = _inverted((1 - part) * density[low] + part * density[low + 1], x)
    return column / (density.shape[1] - 1), row / (len(rows) - 1)


def _inverted(values: np.ndarray, share: np.ndarray) -> np.ndarray:
    """Where piecewise linear functions [n, nodes] have the share [n] of their integral below, in nodes."""
    areas = 0.5 * (values[:, 1:] + values[:, :-1])
    below = np.concatenate([np.zeros((len(values), 1)), np.cumsum(areas, 1)], 1)
    target = share * below[:, -1]
    node = np.clip((below <= target[:, None]).sum(1) - 1, 0, values.shape[1] - 2)
    pick = np.arange(len(values))
    a, b, rest = values[pick, node], values[pick, node + 1], target - below[pick, node]
    root = a + np.sqrt(np.maximum(a * a + 2 * rest * (b - a), 0))
    return node + np.clip(np.divide(2 * rest, root, out=np.zeros_like(rest), where=root > 0), 0, 1)


def _f_cos(brdf: Callable, wv: np.ndarray, theta: np.ndarray, phi: np.ndarray) -> np.ndarray:
    m = _direction(theta, phi)
    wl = 2 * (m @ wv)[:, None] * m - wv
    above = (wl[:, 2] > 1e-4) & (m @ wv > 0)
    found = np.zeros((len(wl), 3))
    found[above] = brdf(wl[above], np.broadcast_to(wv, wl.shape)[above]) * wl[above, 2:]
    return found


def _tensor_file(fields: dict[str, np.ndarray]) -> bytes:
    types = {np.dtype(np.uint8): 1, np.dtype("<f4"): 10}
    head = sum(2 + len(name) + 11 + 8 * values.ndim for name, values in fields.items())
    place, index, data = 18 + head, b"", b""
    for name, values in fields.items():
        index += struct.pack("<H", len(name)) + name.encode()
        index += struct.pack(f"<HBQ{values.ndim}Q", values.ndim, types[values.dtype], place, *values.shape)
        data += np.ascontiguousarray(values).tobytes()
        place += values.nbytes
    return b"tensor_file\0" + struct.pack("<BBI", 1, 0, len(fields)) + index + data
