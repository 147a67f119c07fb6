"""Models of tiles that repeat infinitely, of their BTFs and with their shells, and surfaces that carry them:
smooth, and covered with a tile's geometry.

A point of a surface is (u, v) in periods of the tile; heights are in meters.
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np
from velour.native import Btf, Model, Scene, Tile, capture_job, compress_job, directions, votf_job

UNMOVED = ((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0))


def add(tile: Tile, scene: Scene) -> None:
    """Adds a tile with its own materials and commits the scene."""
    mesh, materials = tile.add_to(scene)
    scene.add_instance(mesh, UNMOVED, materials)
    scene.commit()


def model_of_tile(
    scene: Scene, tile: dict, data: Path, around: int, seed: int = 0, threads: int = 0, **capture
) -> tuple[Model, float]:
    """Captures a committed scene that holds the tile into `data`, also from below if one can see through it,
    and compresses the capture. Returns the model and the seconds.

    `tile`: its info(); `around`: number of views and of lights; `capture`: further options of capture_job().
    """
    options = {"views": directions(str(around)), "lights": directions(str(around)), **capture}
    options |= {"period": tile["period"], "source": tile["kind"], "seed": seed, "threads": threads}
    with capture_job(scene, data, **options) as job:
        seconds = job.run()["seconds"]
    with Btf.load(data) as btf, compress_job(btf, seed=seed, threads=threads) as job:
        seconds += job.run()["seconds"]
        return job.result_model(), seconds


def with_shell(scene: Scene, tile: dict, model: Model, **options) -> tuple[Model, dict]:
    """`model` with the shell of the tile that the committed scene holds, and the report."""
    options = {"origin": (0, 0), "period": tile["period"], "source": tile["kind"], **options}
    with votf_job(scene, model, **options) as job:
        report = job.run()
        return job.result_model(), report


def sun(towards: tuple[float, float, float]) -> tuple:
    """Transform of a sun that shines from a direction; its rays go along -z of the transform."""
    z = np.array(towards) / np.linalg.norm(towards)
    x = np.cross([0, 0, 1.0], z)
    x /= np.linalg.norm(x)
    y = np.cross(z, x)
    return tuple((x[i], y[i], z[i], 0) for i in range(3))


_FACETS = 8  # facets of the smooth mesh per side of a tile


class Sphere(NamedTuple):
    """A sphere parameterized by longitude and latitude, its axis along z; `rows` tiles from pole to pole."""

    rows: int
    period: float

    @property
    def columns(self) -> int:
        return 2 * self.rows

    @property
    def radius(self) -> float:
        return self.rows * self.period / np.pi

    def frame(self, uv: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Points and unit normals."""
        longitude = uv[..., 0] * (np.pi / self.rows)
        latitude = np.clip(uv[..., 1] / self.rows - 0.5, -0.5, 0.5) * np.pi
        across = np.cos(latitude)
        normal = np.stack([across * np.cos(longitude), across * np.sin(longitude), np.sin(latitude)], axis=-1)
        return self.radius * normal, normal


class Cylinder(NamedTuple):
    """A cylinder about z, `columns` tiles around and `rows` tiles along."""

    columns: int
    rows: int
    period: float

    @property
    def radius(self) -> float:
        return self.columns * self.period / (2 * np.pi)

    def frame(self, uv: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        angle = uv[..., 0] * (2 * np.pi / self.columns)
        height = (uv[..., 1] - self.rows / 2) * self.period
        normal = np.stack([np.cos(angle), np.sin(angle), np.zeros_like(angle)], axis=-1)
        return self.radius * normal + height[..., None] * np.array([0, 0, 1.0]), normal


class Cloth(NamedTuple):
    """A square cloth that hangs over the edge of a round table: flat in the middle, with folds around."""

    rows: int
    period: float

    @property
    def columns(self) -> int:
        return self.rows

    @property
    def radius(self) -> float:
        return self.rows * self.period / 2

    def frame(self, uv: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        step = 1e-4
        sides = [
            self._points(uv + np.array(d)) - self._points(uv - np.array(d)) for d in ((step, 0), (0, step))
        ]
        normal = np.cross(*sides)
        return self._points(uv), normal / np.linalg.norm(normal, axis=-1, keepdims=True)

    def _points(self, uv: np.ndarray) -> np.ndarray:
        x, y = np.moveaxis((uv / self.rows * 2 - 1), -1, 0)
        r, angle = np.hypot(x, y), np.arctan2(y, x)
        fall = np.maximum(0, r - 0.45) ** 2
        z = -1.1 * fall * (1 + 0.35 * np.cos(6 * angle))
        inwards = 1 - 0.45 * fall
        return self.radius * np.stack([x * inwards, y * inwards, z], axis=-1)


Surface = Sphere | Cylinder | Cloth


def smooth_mesh(surface: Surface) -> dict:
    """Arguments of Scene.add_mesh; texture coordinates count tiles."""
    nu, nv = surface.columns * _FACETS, surface.rows * _FACETS
    u, v = np.meshgrid(np.arange(nu + 1) / _FACETS, np.arange(nv + 1) / _FACETS)
    uv = np.stack([u, v], axis=-1)
    points, normals = (a.reshape(-1, 3) for a in surface.frame(uv))
    first = (np.arange(nv)[:, None] * (nu + 1) + np.arange(nu)).ravel()
    quads = np.stack([first, first + 1, first + nu + 2, first + nu + 1], axis=-1)
    corners = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    area = np.linalg.norm(
        np.cross(
            points[corners[:, 1]] - points[corners[:, 0]], points[corners[:, 2]] - points[corners[:, 0]]
        ),
        axis=-1,
    )
    corners = corners[area > 1e-9 * area.max()]
    return {
        "positions": points.astype(np.float32),
        "triangles": corners.astype(np.uint32),
        "corner_normals": normals[corners].astype(np.float32),
        "corner_uvs": uv.reshape(-1, 2)[corners].astype(np.float32),
    }


def structured_mesh(surface: Surface, tile: dict, period: float) -> dict:
    """Covers the surface with copies of the tile's `positions` and `triangles`: p + height n."""
    points = tile["positions"].astype(float)
    count, triangles, placed = len(points), [], []
    for row in range(surface.rows):
        for column in range(surface.columns):
            p, n = surface.frame(points[:, :2] / period + np.array([column, row]))
            triangles.append(tile["triangles"].astype(np.uint64) + len(placed) * count)
            placed.append((p + n * points[:, 2:]).astype(np.float32))
    return {
        "positions": np.concatenate(placed),
        "triangles": np.concatenate(triangles).astype(np.uint32),
        "material_slots": np.tile(tile["material_slots"], surface.rows * surface.columns),
    }
