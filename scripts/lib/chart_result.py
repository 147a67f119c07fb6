"""Results of one scene, and the numbers for tables and targets derived from them."""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np
from chart_scenes import ChartScene
from curve import Curve, Reading, ratio
from reference import Reference
from renders import Picture

DEFAULT, DISSERTATION = "mis", "mis-dissertation"


@dataclass(frozen=True)
class Contender:
    strategy: str
    sequence: str

    @property
    def options(self) -> dict:
        return {"strategy": self.strategy, "sequence": self.sequence}


@dataclass(frozen=True)
class Point:
    spp: int
    seed: int
    seconds: float
    mse: float  # linear RGB, with the reference's noise subtracted
    relmse: float  # the reference's noise is subtracted


def point_of(
    picture: Picture, spp: int, seed: int, reference: np.ndarray, noise: tuple[float, float]
) -> Point:
    """`noise`: rmse and relmse of the reference. It is independent of the picture, so the squares add up."""
    rmse, relmse = picture.errors(reference)
    return Point(spp, seed, picture.report["seconds"], rmse**2 - noise[0] ** 2, relmse - noise[1])


@dataclass(frozen=True)
class Gain:
    """A ratio of means over seeds, and its standard error, estimated from the seeds."""

    value: float
    error: float

    def __str__(self) -> str:
        return f"{self.value:.2f} ± {self.error:.2f}"


@dataclass(frozen=True)
class Result:
    scene: ChartScene
    points: dict[str, list[Point]]
    reference: Reference
    level_spp: int
    bound: dict | None
    ggx: dict

    @functools.cached_property
    def curves(self) -> dict[str, Curve]:
        """relmse against seconds, as means over seeds."""
        return {name: Curve([p[:2] for p in self.means(name).values()]) for name in self.points}

    def means(self, name: str) -> dict[int, tuple[float, float, float]]:
        """spp -> seconds, relmse, rmse"""
        return {spp: self._mean(name, spp) for spp in sorted({point.spp for point in self.points[name]})}

    @property
    def level(self) -> float:
        """relmse of the default strategy at `level_spp` samples."""
        return self._mean(DEFAULT, self.level_spp)[1]

    @property
    def level_seconds(self) -> float:
        return self._mean(DEFAULT, self.level_spp)[0]

    def seconds_to_level(self, name: str) -> Reading | None:
        return self.curves[name].seconds_at(self.level)

    def error_at_equal_time(self, name: str) -> Reading | None:
        return self.curves[name].error_at(self.level_seconds)

    def time_ratio(self, name: str, other: str) -> Reading | None:
        """Ratio of `name` to `other` in seconds to the level."""
        return ratio(self.seconds_to_level(name), self.seconds_to_level(other))

    def error_ratio(self, name: str, other: str) -> Reading | None:
        """Ratio of `name` to `other` in relmse at equal time."""
        return ratio(self.error_at_equal_time(name), self.error_at_equal_time(other))

    def gain(self, name: str, other: str, spp: int) -> Gain:
        """Ratio of `name` to `other` in relmse at equal samples."""
        a, b = (np.array([p.relmse for p in self.points[n] if p.spp == spp]) for n in (name, other))
        value = a.mean() / b.mean()
        relative = sum(_relative_variance(x) for x in (a, b))
        return Gain(float(value), float(abs(value) * relative**0.5))

    def share_of_bound(self) -> float | None:
        """Share of the variance reduction of exact product sampling over the default that `product` has."""
        if not self.bound:
            return None
        mis, product, exact = (self.bound[name] for name in ("mis", "product", "exact"))
        return (mis - product) / (mis - exact)

    def _mean(self, name: str, spp: int) -> tuple[float, float, float]:
        points = [point for point in self.points[name] if point.spp == spp]
        seconds, relmse, mse = np.mean([(p.seconds, p.relmse, p.mse) for p in points], axis=0)
        return float(seconds), float(relmse), float(max(mse, 0.0) ** 0.5)


def _relative_variance(x: np.ndarray) -> float:
    return x.var(ddof=1) / len(x) / x.mean() ** 2 if len(x) > 1 else np.nan
