"""Errors of pictures: converged references as means of independent renders, whose spread gives their own
error, and curves of error against time."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from velour.native import images

from .run import Picture, Run
from .scenes import Scene

# First seed of references, far from the seeds of the pictures that are compared with them.
FIRST_SEED = 1000


class Batches:
    """Independent renders of one picture."""

    def __init__(self, pictures: list[Picture]):
        self.pictures = pictures

    def stack(self) -> np.ndarray:
        """[batch, row, column, channel], float64."""
        return np.array([picture.pixels for picture in self.pictures], np.float64)

    def mean(self) -> np.ndarray:
        return self.stack().mean(axis=0).astype(np.float32)

    def standard_error(self) -> np.ndarray:
        """Standard error of each pixel and channel of the mean."""
        return (self.stack().std(axis=0, ddof=1) / len(self.pictures) ** 0.5).astype(np.float32)

    def noise(self) -> tuple[float, float]:
        """rmse and relmse of the mean itself: those of a picture that deviates by one standard error."""
        mean = self.mean()
        return images.compare(mean + self.standard_error(), mean)

    def save(self, stem: Path) -> None:
        images.write(stem.with_name(f"{stem.name}.exr"), self.mean())
        images.write(stem.with_name(f"{stem.name}-standard-error.exr"), self.standard_error())


class Reference(Batches):
    """A reference of one of our scenes, to which renders can be added."""

    def __init__(self, run: Run, scene: Scene, spp: int, first_seed: int = FIRST_SEED, **options):
        super().__init__([])
        self._run, self._scene, self._spp = run, scene, spp
        self._first_seed, self._options = first_seed, options

    def add(self, count: int = 1) -> Reference:
        for _ in range(count):
            seed = self._first_seed + len(self.pictures)
            self.pictures.append(self._run.render(self._scene, self._spp, seed=seed, **self._options))
        return self

    @property
    def spp(self) -> int:
        return self._spp * len(self.pictures)

    @property
    def seconds(self) -> float:
        return sum(picture.seconds for picture in self.pictures)


def points(pictures: list[tuple[Picture, dict]], reference: Batches) -> list[dict]:
    """Points of curves of error against time, with what is said about each picture. The noise of the
    reference is independent of the pictures, so it is subtracted from the squares."""
    mean, noise, found = reference.mean(), reference.noise(), []
    for picture, about in pictures:
        rmse, relmse = picture.errors(mean)
        errors = {"mse": rmse**2 - noise[0] ** 2, "relmse": relmse - noise[1]}
        found.append({**about, "seconds": picture.seconds, **errors})
    return found


def silhouette(run: Run, scene: Scene, size: tuple[int, int]) -> np.ndarray:
    """The pixels that show the object, [row, column]. Pixels of the environment alone are equal for
    strategies that share camera rays."""
    a, b = (run.render(scene, 64, strategy=name, size=size).pixels for name in ("uniform", "cosine"))
    return (a != b).any(axis=-1)


def fit_error(differences: np.ndarray, reference: np.ndarray) -> tuple[float, float]:
    """rmse and relmse of the common part of independent `differences` [render, row, column, channel]: the
    error that a model causes in a picture, without the picture's noise.

    Each difference is model minus measurement with the same light directions, so most noise cancels. The
    remaining noise adds its variance v to the square of each difference and v / n to that of their mean: two
    equations with two unknowns.
    """
    n = len(differences)
    each = np.square([_errors(difference, reference) for difference in differences]).mean(axis=0)
    common = np.square(_errors(differences.mean(axis=0), reference))
    rmse, relmse_root = np.sqrt(np.maximum((n * common - each) / (n - 1), 0.0))
    return float(rmse), float(relmse_root**2)


def _errors(difference: np.ndarray, reference: np.ndarray) -> tuple[float, float]:
    """rmse and the root of relmse."""
    rmse, relmse = images.compare((reference + difference).astype(np.float32), reference)
    return rmse, relmse**0.5


@dataclass(frozen=True)
class Reading:
    value: float
    measured: bool  # between measured points; otherwise extrapolated by the fitted power law

    def __str__(self) -> str:
        return f"{'' if self.measured else '~'}{self.value:.3g}"


class Curve:
    """Points (seconds, error), interpolated linearly in the logarithms of both."""

    def __init__(self, points: list[tuple[float, float]]):
        usable = sorted(point for point in points if min(point) > 0)
        self.x, self.y = np.log(usable).T if usable else (np.empty(0), np.empty(0))

    def seconds_at(self, error: float) -> Reading | None:
        """When the curve falls below `error` for good; None if it does not."""
        y = np.log(error)
        below = np.flatnonzero(self.y > y)
        k = below[-1] + 1 if len(below) else 0
        if 0 < k < len(self.y):
            share = (self.y[k - 1] - y) / (self.y[k - 1] - self.y[k])
            return Reading(float(np.exp(self.x[k - 1] + share * (self.x[k] - self.x[k - 1]))), True)
        slope = self._slope()
        if slope is None or slope >= 0:
            return None
        end = 0 if k == 0 else -1
        return Reading(float(np.exp(self.x[end] + (y - self.y[end]) / slope)), False)

    def error_at(self, seconds: float) -> Reading | None:
        x = np.log(seconds)
        if len(self.x) and self.x[0] <= x <= self.x[-1]:
            return Reading(float(np.exp(np.interp(x, self.x, self.y))), True)
        slope = self._slope()
        if slope is None:
            return None
        end = 0 if x < self.x[0] else -1
        return Reading(float(np.exp(self.y[end] + slope * (x - self.x[end]))), False)

    def _slope(self) -> float | None:
        """Slope of the least-squares line through all points; None for fewer than two."""
        if len(self.x) < 2 or np.ptp(self.x) == 0:
            return None
        return float(np.polyfit(self.x, self.y, 1)[0])


def ratio(a: Reading | None, b: Reading | None) -> Reading | None:
    return Reading(a.value / b.value, a.measured and b.measured) if a and b else None


def shown(found: Reading | None) -> str:
    return "-" if found is None else str(found)
