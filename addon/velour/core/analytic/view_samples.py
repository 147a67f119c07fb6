"""Light directions at views, sampled where materials reflect, and values of a model at them."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ...native import Model

REPORTED = (5, 30, 60, 75, 85)  # degrees
WHITE = (1.0, 1.0, 1.0)
LUMINANCE = np.array((0.2126, 0.7152, 0.0722))
_FITTED = np.arange(2.5, 90, 5)  # degrees; none of them is reported
_UNIFORM, _VIEWER = 0.3, 0.1  # shares of the lights; the others lie about the mirror direction
_ALPHAS = (0.04, 0.12, 0.35)  # of GGX half vectors, with equal shares
_VIEWER_KAPPA = 20.0  # concentration of the lights about the viewer
_AZIMUTHS = (0.0, 45.0, 90.0, 135.0)  # of views of anisotropic models: degrees


class ViewSamples(NamedTuple):
    """Values at [views x lights]; unit directions in the local frame, +z normal."""

    wv: np.ndarray  # [views x 3]
    wl: np.ndarray  # [views x lights x 3]
    solid_angle: np.ndarray  # [views x lights] that a light stands for: sr; 0 below the horizon
    f_cos: np.ndarray  # [views x lights x 3]: 1/sr, linear Rec. 709

    def quarter_turned(self) -> ViewSamples:
        """The samples in a frame whose x axis is y."""
        return self._replace(wv=_quarter_turned(self.wv), wl=_quarter_turned(self.wl))

    def relative_errors(self, f_cos: np.ndarray) -> np.ndarray:
        """Relative L2 errors [views] of the luminance of other values; NaN at black views."""
        weight = self.solid_angle
        difference = (weight * ((f_cos - self.f_cos) @ LUMINANCE) ** 2).sum(-1)
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.sqrt(difference / (weight * (self.f_cos @ LUMINANCE) ** 2).sum(-1))


def fitted_samples(model: Model, lights: int | None = None, gain: tuple = WHITE) -> ViewSamples:
    """The model times `gain` at 18 views, 5 degrees apart; at four azimuths each if it is anisotropic."""
    return _samples(model, _FITTED, lights or (300 if model.info().get("isotropic", True) else 100), gain)


def errors(
    model: Model, f_cos: Callable[[ViewSamples], np.ndarray], lights: int = 4096, gain: tuple = WHITE
) -> dict:
    """Keys relative_l2 and by_view_angle, of a function f_cos(samples) against the model times `gain`."""
    fitted, reported = fitted_samples(model, gain=gain), _samples(model, REPORTED, lights, gain)
    by_angle = np.sqrt((reported.relative_errors(f_cos(reported)) ** 2).reshape(len(REPORTED), -1).mean(-1))
    return {
        "relative_l2": mean_error(fitted, f_cos(fitted)),
        "by_view_angle": {
            str(angle): float(error) if np.isfinite(error) else None
            for angle, error in zip(REPORTED, by_angle, strict=True)
        },
    }


def mean_error(samples: ViewSamples, f_cos: np.ndarray) -> float:
    """Mean relative L2 error of the views that are not black, as the picture of a sphere shows them."""
    weight = np.sin(2 * np.arccos(np.clip(samples.wv[:, 2], 0, 1)))
    relative = samples.relative_errors(f_cos)
    covered = np.isfinite(relative)
    return float(weight[covered] @ relative[covered] / max(weight[covered].sum(), 1e-9))


def _samples(model, degrees, lights, gain):
    azimuths = (0.0,) if model.info().get("isotropic", True) else _AZIMUTHS
    views = [(math.radians(theta), math.radians(phi)) for theta in degrees for phi in azimuths]
    wv = np.array([_direction(theta, phi) for theta, phi in views], np.float32)
    sampled = [_lights(theta, phi, lights) for theta, phi in views]
    wl, solid_angle = (np.stack(parts) for parts in zip(*sampled, strict=True))
    values = np.stack(
        [model.eval(view, light.astype(np.float32))[0] for view, light in zip(wv, wl, strict=True)]
    )
    f_cos = np.maximum(values, 0) * np.maximum(wl[..., 2:], 0) * np.asarray(gain)
    return ViewSamples(wv, wl, solid_angle, f_cos)


def _quarter_turned(directions):
    x, y, z = np.moveaxis(directions, -1, 0)
    return np.stack([y, -x, z], axis=-1)


def _direction(theta, phi):
    return math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta)


def _lights(theta, phi, count):
    """Directions [count x 3] for a view, and the solid angles [count] that they stand for.

    Densities of all techniques are combined by the balance heuristic.
    """
    wv = np.array(_direction(theta, 0.0))
    uniform, viewer = round(_UNIFORM * count), round(_VIEWER * count)
    shares = [len(part) for part in np.array_split(range(count - uniform - viewer), len(_ALPHAS))]
    wl = np.concatenate(
        [
            _uniform(*_points(uniform)),
            _about(wv, *_points(viewer)),
            *(
                _mirrored(wv, _half_vector(alpha, *_points(n)))
                for alpha, n in zip(_ALPHAS, shares, strict=True)
            ),
        ]
    )
    # Below the horizon nothing is reflected: those directions become the zenith, with no solid angle.
    above = wl[:, 2] > 1e-4
    wl[~above] = (0, 0, 1)
    density = uniform / (2 * math.pi) + viewer * _density_about(wv, wl)
    for alpha, n in zip(_ALPHAS, shares, strict=True):
        density = density + n * _half_density(alpha, wv, wl)
    cos, sin = math.cos(phi), math.sin(phi)
    turned = np.stack([cos * wl[:, 0] - sin * wl[:, 1], sin * wl[:, 0] + cos * wl[:, 1], wl[:, 2]], axis=-1)
    return turned, np.where(above, 1 / density, 0)


def _points(count):
    """The R2 sequence: evenly spread points in the unit square."""
    index = np.arange(count)
    return (0.5 + index * 0.7548776662466927) % 1, (0.5 + index * 0.5698402909980532) % 1


def _uniform(u, v):
    sine = np.sqrt(1 - u**2)
    return np.stack([sine * np.cos(2 * np.pi * v), sine * np.sin(2 * np.pi * v), u], axis=-1)


def _half_vector(alpha, u, v):
    tangent = alpha * np.sqrt(u / (1 - u))
    cosine = 1 / np.sqrt(1 + tangent**2)
    sine = tangent * cosine
    return np.stack([sine * np.cos(2 * np.pi * v), sine * np.sin(2 * np.pi * v), cosine], axis=-1)


def _mirrored(wv, h):
    return 2 * (h @ wv)[:, None] * h - wv


def _half_density(alpha, wv, wl):
    h = wl + wv
    h /= np.linalg.norm(h, axis=-1, keepdims=True)
    d = alpha**2 / (np.pi * (h[:, 2] ** 2 * (alpha**2 - 1) + 1) ** 2)
    return d * h[:, 2] / (4 * np.maximum(h @ wv, 1e-6))


def _about(wv, u, v):
    """Directions of a von Mises-Fisher lobe."""
    kappa = _VIEWER_KAPPA
    z = 1 + np.log1p((1 - u) * math.expm1(-2 * kappa)) / kappa
    sine = np.sqrt(np.maximum(1 - z**2, 0))
    x, y, z = sine * np.cos(2 * np.pi * v), sine * np.sin(2 * np.pi * v), z
    return np.stack([wv[2] * x + wv[0] * z, y, wv[2] * z - wv[0] * x], axis=-1)


def _density_about(wv, wl):
    kappa = _VIEWER_KAPPA
    return kappa / (2 * np.pi * -math.expm1(-2 * kappa)) * np.exp(kappa * (wl @ wv - 1))
