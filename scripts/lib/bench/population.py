"""Measurements made from seeds, by formulas that are not models of Velour, with the defects of real ones."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from . import population_rgl

# f of wl [n, 3] and wv [n, 3], both above the horizon: [n, 3] in 1/sr
Brdf = Callable[[np.ndarray, np.ndarray], np.ndarray]
# Seven, so that every kind meets every layout.
_LAYOUTS = ("merl", "rgl", "merl", "cornell", "merl", "rgl", "cornell")
_SCALES = np.array([1.0, 1.15, 1.66]) / 1500  # of MERL's planes
_WAVELENGTHS = (450, 550, 610)  # of the irregular samples: near the primaries


@dataclass(frozen=True)
class Member:
    name: str
    kind: str
    layout: str  # "merl", "cornell", "rgl"
    defect: str
    write: Callable[[Path], None]


def member(seed: int, index: int) -> Member:
    random = np.random.default_rng([seed, index])
    kind, make = _KINDS[index % len(_KINDS)]
    layout = _LAYOUTS[index % len(_LAYOUTS)]
    defect = _DEFECTS[int(random.integers(len(_DEFECTS)))]
    brdf = _with_defect(make(random), defect)
    noise = random.uniform(0.02, 0.15) if defect == "noise" else 0.0
    coarse = defect == "coarse"
    if layout == "merl":

        def write(path: Path) -> None:
            _write_merl(
                path, brdf, (45, 15, 18) if coarse else (90, 30, 36), defect == "holes", noise, random
            )

    elif layout == "rgl":

        def write(path: Path) -> None:
            population_rgl.write(path, brdf, 16 if coarse else 32, noise, random)

    else:
        count = int(random.integers(30, 100)) if coarse else int(random.integers(400, 1500))

        def write(path: Path) -> None:
            _write_cornell(path, brdf, count, noise, random)

    return Member(f"{kind} {index}", kind, layout, defect, write)


def _color(random, low=0.02, high=0.9) -> np.ndarray:
    return random.uniform(low, high, 3)


def _log_uniform(random, low: float, high: float) -> float:
    return float(np.exp(random.uniform(np.log(low), np.log(high))))


def _unit(v: np.ndarray) -> np.ndarray:
    return v / np.linalg.norm(v, axis=1, keepdims=True)


def _fresnel(cosine: np.ndarray, f0: np.ndarray) -> np.ndarray:
    return f0 + (1 - f0) * ((1 - np.clip(cosine, 0, 1)) ** 5)[:, None]


def _ggx(alpha: float, f0) -> Brdf:
    def smith(z):
        return 0.5 * (np.sqrt(1 + alpha**2 * (1 - z**2) / z**2) - 1)

    def f(wl, wv):
        h = _unit(wl + wv)
        c = h[:, 2] ** 2
        d = alpha**2 / (np.pi * (1 + (alpha**2 - 1) * c) ** 2)
        g = 1 / (1 + smith(wl[:, 2]) + smith(wv[:, 2]))
        return _fresnel((wl * h).sum(1), f0) * (d * g / (4 * wl[:, 2] * wv[:, 2]))[:, None]

    return f


def _beckmann(alpha: float, f0) -> Brdf:
    def f(wl, wv):
        h = _unit(wl + wv)
        c = h[:, 2] ** 2
        d = np.exp((c - 1) / (c * alpha**2)) / (np.pi * alpha**2 * c**2)
        cosine = (wl * h).sum(1)
        g = np.minimum(1, 2 * h[:, 2] * np.minimum(wl[:, 2], wv[:, 2]) / cosine)
        return _fresnel(cosine, f0) * (d * g / (4 * wl[:, 2] * wv[:, 2]))[:, None]

    return f


def _ashikhmin_shirley(power: float, f0) -> Brdf:
    def f(wl, wv):
        h = _unit(wl + wv)
        cosine = (wl * h).sum(1)
        d = (power + 1) / (8 * np.pi) * h[:, 2] ** power / (cosine * np.maximum(wl[:, 2], wv[:, 2]))
        return _fresnel(cosine, f0) * d[:, None]

    return f


def _lambert(color) -> Brdf:
    return lambda wl, wv: np.broadcast_to(np.asarray(color) / np.pi, wl.shape)


def _oren_nayar(sigma: float, color) -> Brdf:
    a, b = 1 - 0.5 * sigma**2 / (sigma**2 + 0.33), 0.45 * sigma**2 / (sigma**2 + 0.09)

    def f(wl, wv):
        along = np.maximum((wl[:, :2] * wv[:, :2]).sum(1), 0) / np.maximum(wl[:, 2], wv[:, 2])
        return color * ((a + b * along) / np.pi)[:, None]

    return f


def _sheen(power: float, color) -> Brdf:
    def f(wl, wv):
        h = _unit(wl + wv)
        sine = np.sqrt(np.maximum(1 - h[:, 2] ** 2, 0))
        return color * (sine**power / (wl[:, 2] + wv[:, 2]))[:, None]

    return f


def _retro(bandwidth: float, color) -> Brdf:
    def f(wl, wv):
        lobe = np.exp(bandwidth * ((wl * wv).sum(1) - 1)) * bandwidth / (2 * np.pi)
        return color * (lobe / np.maximum(wl[:, 2], wv[:, 2]))[:, None]

    return f


def _film(alpha: float, thickness: float) -> Brdf:
    """A metal whose reflectance changes color with the angle, by interference in a film (nanometers)."""
    plain, waves = _ggx(alpha, np.full(3, 0.9)), np.array([610.0, 550.0, 460.0])

    def f(wl, wv):
        cosine = (wl * _unit(wl + wv)).sum(1)
        inside = np.sqrt(1 - (1 - cosine**2) / 1.5**2)
        return plain(wl, wv) * (0.5 + 0.4 * np.cos(4 * np.pi * 1.5 * thickness * inside[:, None] / waves))

    return f


def _sum(*parts: Brdf) -> Brdf:
    return lambda wl, wv: sum(part(wl, wv) for part in parts)


def _plastic(random) -> Brdf:
    return _sum(_lambert(_color(random)), _ggx(_log_uniform(random, 0.008, 0.4), np.full(3, 0.04)))


def _gloss(random) -> Brdf:
    lobe = _ashikhmin_shirley(_log_uniform(random, 5, 5000), np.full(3, 0.05))
    return _sum(_lambert(_color(random)), lobe)


def _velvet(random) -> Brdf:
    rim = _sheen(random.uniform(1, 5), _color(random, 0.1, 0.5))
    return _sum(_lambert(_color(random, 0.01, 0.2)), rim)


def _coated_metal(random) -> Brdf:
    coat = _ggx(_log_uniform(random, 0.01, 0.08), np.full(3, 0.04))
    return _sum(_ggx(_log_uniform(random, 0.1, 0.5), _color(random, 0.3, 0.9)), coat)


def _retro_reflector(random) -> Brdf:
    lobe = _retro(_log_uniform(random, 20, 400), _color(random, 0.01, 0.1))
    return _sum(_lambert(_color(random)), lobe)


def _mixture(random) -> Brdf:
    rough = _oren_nayar(0.4, _color(random, 0.02, 0.4))
    broad = _beckmann(_log_uniform(random, 0.1, 0.4), _color(random, 0.02, 0.2))
    return _sum(rough, broad, _ggx(_log_uniform(random, 0.01, 0.1), np.full(3, 0.03)))


_KINDS = (
    ("metal", lambda r: _ggx(_log_uniform(r, 0.03, 0.6), _color(r, 0.4, 0.95))),
    ("plastic", _plastic),
    ("Beckmann", lambda r: _beckmann(_log_uniform(r, 0.05, 0.5), _color(r, 0.1, 0.9))),
    ("Ashikhmin-Shirley", _gloss),
    ("rough diffuse", lambda r: _oren_nayar(r.uniform(0.1, 1.0), _color(r))),
    ("velvet", _velvet),
    ("coated metal", _coated_metal),
    ("retro-reflector", _retro_reflector),
    ("thin film", lambda r: _film(_log_uniform(r, 0.05, 0.4), r.uniform(150, 600))),
    ("mixture", _mixture),
)
_DEFECTS = ("none", "none", "none", "noise", "noise", "holes", "coarse", "scale", "reciprocity")


def _with_defect(brdf: Brdf, defect: str) -> Brdf:
    if defect == "scale":
        return lambda wl, wv: 300 * brdf(wl, wv)
    if defect == "reciprocity":
        return lambda wl, wv: brdf(wl, wv) * (0.6 + 0.8 * wl[:, 2:])
    return brdf


def _write_merl(path: Path, brdf: Brdf, sizes, holes: bool, noise: float, random) -> None:
    n, m, p = sizes
    i, j, k = np.meshgrid(np.arange(n), np.arange(m), np.arange(p), indexing="ij")
    theta_h, theta_d = 0.5 * np.pi * (i / n) ** 2, 0.5 * np.pi * j / m
    phi_d = np.pi * k / p
    x, y, z = np.sin(theta_d) * np.cos(phi_d), np.sin(theta_d) * np.sin(phi_d), np.cos(theta_d)
    cosine, sine = np.cos(theta_h), np.sin(theta_h)

    def turned(x, y, z):  # from the frame of the half vector to that of the surface
        return np.stack([cosine * x + sine * z, y, cosine * z - sine * x], -1).reshape(-1, 3)

    wl, wv = turned(x, y, z), turned(-x, -y, z)
    above = (wl[:, 2] > 1e-3) & (wv[:, 2] > 1e-3)
    f = np.zeros((len(wl), 3))
    f[above] = brdf(wl[above], wv[above])
    f *= np.maximum(1 + noise * random.standard_normal((len(f), 1)), 0)
    seen = above & (np.minimum(wl[:, 2], wv[:, 2]) > (np.cos(np.radians(78)) if holes else 0))
    planes = np.where(seen[:, None], f / _SCALES, -1).T
    path.write_bytes(np.array(sizes, "<i4").tobytes() + np.ascontiguousarray(planes, "<f8").tobytes())


def _write_cornell(path: Path, brdf: Brdf, count: int, noise: float, random) -> None:
    def directions():
        theta, phi = np.radians(random.uniform(2, 82, count)), random.uniform(0, 2 * np.pi, count)
        # A third lies near the plane of incidence on the far side, as goniometers sample highlights.
        return (
            theta,
            phi,
            np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], 1),
        )

    (theta_l, phi_l, wl), (theta_v, _, _) = directions(), directions()
    near = random.uniform(size=count) < 0.33
    theta_v = np.where(near, theta_l + np.radians(8) * random.standard_normal(count), theta_v)
    theta_v = np.clip(theta_v, np.radians(1), np.radians(82))
    phi_v = phi_l + np.where(
        near, np.pi + 0.1 * random.standard_normal(count), random.uniform(0, 2 * np.pi, count)
    )
    wv = np.stack([np.sin(theta_v) * np.cos(phi_v), np.sin(theta_v) * np.sin(phi_v), np.cos(theta_v)], 1)
    f = brdf(wl, wv)[:, ::-1] * np.maximum(1 + noise * random.standard_normal((count, 1)), 0)
    lines = [str(len(_WAVELENGTHS)), " ".join(map(str, _WAVELENGTHS))]
    rows = np.column_stack([theta_l, phi_l, theta_v, phi_v, f])
    lines += [" ".join(f"{value:.6g}" for value in row) for row in rows]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
