"""Closed form of a network of closures, as Cycles evaluates its nodes: the reference for pictures."""

import bpy
import numpy as np

STEPS = 65
X = np.linspace(0, 1, STEPS)  # theta_v over 90 degrees


def curves(diffuse=(0, 0, 0), lobes=()):
    """A dict as operators.closure_network takes it; constants become curves."""
    return {"diffuse": _curve(diffuse, 3).tolist(), "lobes": [lobe_curves(**lobe) for lobe in lobes]}


def lobe_curves(color=(1, 1, 1), roughness=0.3, tilt=0.0, anisotropy=0.0, distribution="GGX"):
    numbers = {"roughness": roughness, "tilt": tilt, "anisotropy": anisotropy}
    return {
        "distribution": distribution,
        "color": _curve(color, 3).tolist(),
        **{name: _curve(value, 1)[:, 0].tolist() for name, value in numbers.items()},
    }


def _curve(values, channels):
    """[STEPS x channels] of a constant, or of values that vary along the first axis."""
    values = np.asarray(values, float)
    if values.ndim and values.shape[0] == STEPS:
        return values.reshape(STEPS, -1) * np.ones(channels)
    return np.broadcast_to(values, (STEPS, channels))


def f_cos(closures, wv, wl):
    """f cos(theta_l) [n x 3] in 1/sr about the normal +z, for unit directions wv and wl [n x 3] above it."""
    wv, wl = np.broadcast_arrays(np.asarray(wv, float), np.asarray(wl, float))
    x = np.arccos(np.clip(wv[:, 2], -1, 1)) * 2 / np.pi
    total = _at(closures["diffuse"], x) * np.maximum(wl[:, 2:], 0) / np.pi
    for lobe in closures["lobes"]:
        total = total + _at(lobe["color"], x) * _lobe(lobe, closures.get("frame"), x, wv, wl)[:, None]
    return total


def _at(curve, x):
    curve = np.asarray(curve, float).reshape(STEPS, -1)
    return np.stack([np.interp(x, X, channel) for channel in curve.T], axis=-1)


def _lobe(lobe, frame, x, wv, wl):
    roughness, tilt, anisotropy = (_at(lobe[key], x)[:, 0] for key in ("roughness", "tilt", "anisotropy"))
    normal = np.broadcast_to(np.array([0.0, 0.0, 1.0]), wv.shape)
    normal = _unit(normal + tilt[:, None] * (wv - normal))
    along = np.broadcast_to(np.array([1.0, 0, 0]), wv.shape) if frame == "surface" else wv
    y = _unit(np.cross(normal, along + np.array([1e-9, 0, 0])))
    axes = np.stack([np.cross(y, normal), y, normal], axis=1)
    squeeze = np.where(anisotropy < 0, 1 / (1 + anisotropy), 1 - anisotropy)
    alpha = np.clip(np.stack([roughness**2 * squeeze, roughness**2 / squeeze], axis=-1), 0, 1)
    v, light, h = (np.einsum("nij,nj->ni", axes, d) for d in (wv, wl, _unit(wv + wl)))
    if lobe["distribution"] == "ASHIKHMIN_SHIRLEY":
        return _ashikhmin_shirley(alpha, v, light, h)
    is_ggx = lobe["distribution"] == "GGX"
    slopes = ((h[:, :2] / alpha) ** 2).sum(-1) / h[:, 2] ** 2
    falloff = (1 + slopes) ** -2.0 if is_ggx else np.exp(-slopes)
    d = falloff / (np.pi * alpha.prod(-1) * h[:, 2] ** 4)
    lambdas = [_smith_lambda(alpha, direction, is_ggx) for direction in (v, light)]
    masking = (
        1 / (1 + sum(lambdas)) if is_correlated() else 1 / np.prod([1 + each for each in lambdas], axis=0)
    )
    return np.where((light[:, 2] > 0) & (wl[:, 2] > 0), d * masking / (4 * v[:, 2]), 0)


def _ashikhmin_shirley(alpha, v, light, h):
    n = 2 / alpha**2 - 2
    exponent = (n * h[:, :2] ** 2).sum(-1) / np.maximum((h[:, :2] ** 2).sum(-1), 1e-12)
    norm = np.sqrt((n + 1).prod(-1)) / (8 * np.pi)
    falloff = (h * v).sum(-1) * np.maximum(v[:, 2], light[:, 2])
    return np.where(light[:, 2] > 0, light[:, 2] * norm * h[:, 2] ** exponent / falloff, 0)


def _smith_lambda(alpha, direction, is_ggx):
    with np.errstate(divide="ignore"):
        t = ((alpha * direction[:, :2]) ** 2).sum(-1) / direction[:, 2] ** 2
        if is_ggx:
            return 0.5 * (np.sqrt(1 + t) - 1)
        a = 1 / np.sqrt(t)
    below = np.minimum(a, 1.6)
    return np.where(a < 1.6, (1 - 1.259 * below + 0.396 * below**2) / (3.535 * below + 2.181 * below**2), 0)


def is_correlated():
    """Whether this Blender's lobes mask view and light together."""
    return bpy.app.version >= (3, 5, 0)


def _unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)
