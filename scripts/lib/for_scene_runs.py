"""Full models and scene models: sizes, errors of pictures, reports on pictures outside the scene usage."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import soft_scene
import synthetic_sky
from renders import Renders, flags
from scenes import Scene
from velour_cli import velour_to_file


@dataclass(frozen=True)
class Extent:
    """How much is rendered."""

    size: tuple[int, int] = (120, 90)
    spp: int = 4096
    materials: int = 99


QUICK = Extent((32, 24), 64, 1)
_SMALL = (32, 24)  # size of renders that measure only the share outside the scene usage


@dataclass(frozen=True)
class PictureError:
    """An unbiased estimate of relmse against the measurement."""

    relmse: float
    standard_error: float


@dataclass(frozen=True)
class Row:
    material: str
    full: dict  # reports of the fits
    reduced: dict
    full_error: PictureError
    reduced_error: PictureError
    outside: dict[str, float]  # share of a picture outside the scene usage


class Study:
    def __init__(self, renders: Renders, extent: Extent):
        self._renders, self._extent = renders, extent
        folder = renders.settings.folder
        self._patch, self._soft = folder / "patch.obj", folder / "soft_sky.exr"
        self._sunny = folder / "synthetic_sky.exr"
        for path, write in (
            (self._patch, soft_scene.write_patch),
            (self._soft, soft_scene.write_sky),
            (self._sunny, synthetic_sky.write),
        ):
            if not path.is_file():
                write(path)

    def announce(self, materials: int) -> None:
        self._renders.expect(self._extent.spp, count=8 * materials)
        self._renders.expect(1, _SMALL, count=3 * materials)

    def row(self, name: str, measurement: Path) -> Row:
        model, full = self._renders.fit(measurement, "parametric")
        scene = Scene(name, self._patch, "z", self._soft, model, camera=soft_scene.CAMERA)
        small, reduced = self._fit_for(scene, measurement, full_model=model)
        seen = replace(scene, name=f"{name} reduced", material=small)
        references = (
            self._pictures(scene.measured(measurement), 0),
            self._pictures(scene.measured(measurement), 2),
        )
        return Row(
            name,
            full,
            reduced,
            self._error(self._pictures(scene, 4), references),
            self._error(self._pictures(seen, 6), references),
            {
                "same picture": self._outside(seen),
                "moved camera": self._outside(replace(seen, camera=soft_scene.MOVED_CAMERA)),
                "small sun": self._outside(replace(seen, world=self._sunny)),
            },
        )

    def _fit_for(self, scene: Scene, measurement: Path, full_model: Path) -> tuple[Path, dict]:
        """The reduced model and the report of its fit."""
        seen = {**scene.options, "size": "640x480"}
        observation = self._renders.stem("observe", seen).with_suffix(".scene.json")
        self._renders.keep(
            f"observing {scene.name}",
            "observe",
            seen,
            lambda report: velour_to_file(report, "observe", *flags(seen), "-o", observation),
        )
        options = {"for-scene": observation, "full-model": full_model, "seed": self._renders.settings.seed}
        parameters = {"measurement": measurement, **options}
        out = self._renders.stem("reduce", parameters).with_suffix(".velour")
        report = self._renders.keep(
            f"fit of {measurement.stem} for the scene",
            "reduce",
            parameters,
            lambda report: velour_to_file(report, "fit", measurement, "-o", out, *flags(options)),
        )
        return out, report

    def _pictures(self, scene: Scene, first_seed: int) -> tuple[np.ndarray, np.ndarray]:
        """Two independent renders."""
        seeds = (100 * self._renders.settings.seed + first_seed + i for i in range(2))
        a, b = (
            self._renders.render(scene, self._extent.spp, seed=seed, strategy="mis").pixels.astype(np.float64)
            for seed in seeds
        )
        return a, b

    @staticmethod
    def _error(pictures: tuple, references: tuple) -> PictureError:
        """Uses the product of two independent differences in place of a square, over the patch alone."""
        (a, b), ((r0, r1), (r2, r3)) = pictures, references
        reference = (r0 + r1 + r2 + r3) / 4
        mean = reference.mean(axis=(0, 1))
        shown = (a - (r0 + r1) / 2) * (b - (r2 + r3) / 2) / (reference**2 + 0.01 * mean**2)
        shares = shown.mean(axis=2).ravel()
        return PictureError(float(shares.mean()), float(shares.std() / np.sqrt(shares.size)))

    def _outside(self, scene: Scene) -> float:
        report = self._renders.render(scene, 1, size=_SMALL, strategy="mis").report
        return report["out_of_domain"]
