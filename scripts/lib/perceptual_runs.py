"""Renders models at several tolerances and their measurements, and measures how different they look."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import chart_scenes
import data_files
import flip_metric
import numpy as np
import silhouette
import sphere
from renders import Renders
from scenes import Scene

STRATEGY = {"strategy": "product"}
# Bounds of the mean and of the 99th percentile, as CIELAB differences on uniform gray: observers do not
# notice 1 [MT11]; 2.3 is a just noticeable difference [MVO94].
THRESHOLDS = (1.0, 2.3)


@dataclass(frozen=True)
class Order:
    """Options of a fit."""

    tolerance: float
    lobes: int = 16  # at most

    def __str__(self) -> str:
        return f"{self.tolerance:g}" if self.lobes == 16 else f"{self.tolerance:g}, {self.lobes} lobes"


DEFAULT = Order(0.02)


@dataclass(frozen=True)
class Extent:
    """How much is rendered."""

    size: tuple[int, int] = (200, 150)
    spp: int = 96
    # Fits with a loose tolerance are often far better than that; few lobes show what large errors look like.
    orders: tuple[Order, ...] = (
        *(Order(t) for t in (0.005, 0.01, 0.02, 0.04, 0.08, 0.16)),
        Order(0.02, lobes=2),
    )
    materials: int = 99
    worlds: tuple[str, ...] = (chart_scenes.STUDIO, chart_scenes.SUNSET)


QUICK = Extent((64, 48), 16, (DEFAULT, Order(0.02, 2)), 1, (chart_scenes.SUNSET,))


@dataclass(frozen=True)
class Seen:
    """FLIP over the pixels that show the object."""

    mean: float
    percentile: float  # the 99th

    @classmethod
    def of(cls, reference: np.ndarray, test: np.ndarray, where: np.ndarray) -> Seen:
        scale = flip_metric.exposure(reference, where)
        pictures = (flip_metric.display(scale * picture) for picture in (reference, test))
        values = flip_metric.flip_map(*pictures)[::-1][where]
        return cls(float(values.mean()), float(np.percentile(values, 99)))


@dataclass(frozen=True)
class Row:
    material: str
    scene: str
    order: Order
    fit: dict  # its report
    model: Seen  # model against measurement, both with directions sampled from the model
    noise: Seen | None  # measurement against itself with another seed; only for the default order


class Study:
    def __init__(self, renders: Renders, data: Path, extent: Extent):
        self._renders, self._data, self._extent = renders, data, extent
        self._materials = data_files.materials(data)[: extent.materials]
        ball = renders.settings.folder / "sphere.obj"
        self._meshes = {
            "sphere": (ball if ball.is_file() else sphere.write(ball), "z"),
            "bunny": (data_files.mesh(data, "bunny"), "y"),
        }
        self._silhouettes: dict[str, np.ndarray] = {}

    def rows(self) -> list[Row]:
        places = [(mesh, world) for mesh in self._meshes for world in self._extent.worlds]
        count = len(self._materials) * len(places) * (2 * len(self._extent.orders) + 1)
        self._renders.expect(self._extent.spp, count=count)
        return [
            self._row(name, measurement, order, mesh, world)
            for name, measurement in self._materials
            for order in self._extent.orders
            for mesh, world in places
        ]

    def _row(self, name: str, measurement: Path, order: Order, mesh: str, world: str) -> Row:
        model, fit = self._renders.fit(measurement, "parametric", order.tolerance, order.lobes)
        path, up = self._meshes[mesh]
        scene = Scene(f"{mesh}, {name}, {world}", path, up, data_files.world(self._data, world), model)
        measured = scene.measured(measurement)
        where = self._where(mesh, scene)
        reference, seen = self._picture(measured), self._picture(scene)
        noise = None
        if order == DEFAULT:
            noise = Seen.of(reference, self._picture(measured, another=1), where)
        return Row(name, f"{mesh}, {world}", order, fit, Seen.of(reference, seen, where), noise)

    def _picture(self, scene: Scene, another: int = 0) -> np.ndarray:
        seed = self._renders.settings.seed + another
        return self._renders.render(scene, self._extent.spp, seed=seed, **STRATEGY).pixels

    def _where(self, mesh: str, scene: Scene) -> np.ndarray:
        """The pixels that show the object; they depend only on the mesh."""
        if mesh not in self._silhouettes:
            self._silhouettes[mesh] = silhouette.of(scene, self._renders, self._extent.size)
        return self._silhouettes[mesh]
