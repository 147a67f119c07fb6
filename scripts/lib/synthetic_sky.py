"""A clear sky with a small sun, which a mixture of lobes loses most easily."""

from __future__ import annotations

import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from velour.core.luminance import LUMINANCE
from velour.native import images

SUN_DIAMETER = np.radians(0.5)
SUN_SHARE = 0.9  # share of the sky's energy
SUN_ELEVATION, SUN_AZIMUTH = (
    np.radians(40.0),
    np.radians(-60.0),
)  # azimuth from +x, counter-clockwise from above
SUN_COLOR = np.array([1.05, 1.0, 0.85])
_HEIGHT = 1024  # rows; the sun is three texels across
_SUBSAMPLES = 32  # per side of a texel near the sun


@dataclass(frozen=True)
class SunLobes:
    """Lobes of a mixture that keep the sun: within a diameter of its center, at most two diameters wide."""

    count: int
    energy: float  # share of the mixture's energy
    diameter: float  # degrees: of the disk with the same mean cosine as a lobe; mean weighted by energy


def sun_direction() -> np.ndarray:
    """Unit vector, z up."""
    across = np.cos(SUN_ELEVATION)
    return np.array([across * np.cos(SUN_AZIMUTH), across * np.sin(SUN_AZIMUTH), np.sin(SUN_ELEVATION)])


def write(path: Path) -> Path:
    """Equirectangular, row 0 at the bottom, the middle column toward +x, azimuth increasing to the left."""
    centers = np.arange(_HEIGHT) + 0.5, np.arange(2 * _HEIGHT) + 0.5
    elevation = _elevation(centers[0])[:, None]
    sky = np.broadcast_to(_gradient(elevation), (_HEIGHT, 2 * _HEIGHT, 3))
    sun = _coverage(*centers)
    area = np.cos(elevation)  # up to a factor
    energy = (area[..., None] * sky).sum(axis=(0, 1)) @ LUMINANCE
    radiance = SUN_SHARE / (1 - SUN_SHARE) * energy / ((area * sun).sum() * (SUN_COLOR @ LUMINANCE))
    images.write(path, (sky + radiance * sun[..., None] * SUN_COLOR).astype(np.float32))
    return path


def _elevation(row: np.ndarray) -> np.ndarray:
    return np.pi * (row / _HEIGHT - 0.5)


def _gradient(elevation: np.ndarray) -> np.ndarray:
    """Pale at the horizon, blue above, brown below."""
    height = np.clip(np.sin(elevation), 0, 1)[..., None]
    above = np.array([0.75, 0.85, 1.0]) * (1 - height) ** 2 + np.array([0.15, 0.3, 0.7])
    return np.where(elevation[..., None] > 0, above, np.array([0.12, 0.1, 0.08]))


def _coverage(rows: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """Share of each texel that the sun's disk covers."""
    covered = np.zeros((len(rows), len(columns)))
    inner = (np.arange(_SUBSAMPLES) + 0.5) / _SUBSAMPLES - 0.5
    near = _cosine_to_sun(rows[:, None], columns[None, :]) > np.cos(2 * SUN_DIAMETER)
    for row, column in np.argwhere(near):
        cosine = _cosine_to_sun(rows[row] + inner[:, None], columns[column] + inner[None, :])
        covered[row, column] = (cosine > np.cos(SUN_DIAMETER / 2)).mean()
    return covered


def _cosine_to_sun(row: np.ndarray, column: np.ndarray) -> np.ndarray:
    elevation, azimuth = _elevation(row), np.pi * (1 - column / _HEIGHT)
    x, y, z = sun_direction()
    return np.cos(elevation) * (x * np.cos(azimuth) + y * np.sin(azimuth)) + z * np.sin(elevation)


def sun_lobes(mixture: Path) -> SunLobes:
    """`mixture`: a file that `velour render --cache` wrote."""
    center, color = (
        _part(mixture, "lobes.center").reshape(-1, 3),
        _part(mixture, "lobes.coefficient").reshape(-1, 3),
    )
    bandwidth = _part(mixture, "lobes.bandwidth").ravel()
    # The integral of exp(lambda (t - 1)) over the sphere.
    energy = color @ LUMINANCE * 2 * np.pi * -np.expm1(-2 * bandwidth) / bandwidth
    # The mean cosine of a disk of radius a is 1 - a^2 / 4, that of a lobe 1 - 1 / lambda.
    diameter = 4 / np.sqrt(bandwidth)
    near = center @ sun_direction() > np.cos(SUN_DIAMETER)
    kept = near & (diameter <= 2 * SUN_DIAMETER)
    mean = np.average(diameter[kept], weights=energy[kept]) if kept.any() else np.nan
    return SunLobes(int(kept.sum()), float(energy[kept].sum() / energy.sum()), float(np.degrees(mean)))


def _part(mixture: Path, name: str) -> np.ndarray:
    alone = mixture.with_name(f"part-{name}.exr")
    subprocess.run(["oiiotool", mixture, "--subimage", name, "-o", alone], check=True)
    return images.read(alone)
