"""A converged picture as the mean of independent renders, whose spread gives its error."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from renders import Picture, Renders
from scenes import Scene
from velour.native import images

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

    def __init__(self, renders: Renders, scene: Scene, spp: int, first_seed: int = FIRST_SEED, **options):
        super().__init__([])
        self._renders, self._scene, self._spp = renders, scene, spp
        self._first_seed, self._options = first_seed, options

    def add(self, count: int = 1) -> Reference:
        for _ in range(count):
            seed = self._first_seed + len(self.pictures)
            self.pictures.append(self._renders.render(self._scene, self._spp, seed=seed, **self._options))
        return self

    @property
    def spp(self) -> int:
        return self._spp * len(self.pictures)

    @property
    def seconds(self) -> float:
        return sum(picture.report["seconds"] for picture in self.pictures)
