"""Structures that repeat, models of their BTFs and with their shells, and surfaces that carry them: smooth,
and covered with the structure's geometry.

A point of a surface is (u, v) in periods of the tile; heights are in meters.
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np
from velour.native import Btf, Model, Scene, Tile, capture_job, compress_job, directions, votf_job

UNMOVED = ((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0))


class Structure(NamedTuple):
    """One period of a structure: a part that crosses the border exists once and sticks out."""

    kind: str
    period: tuple[float, float]
    mesh: dict  # arguments of Scene.add_mesh

    def add_to(self, scene: Scene, material: Model) -> None:
        """Adds the structure and commits the scene."""
        mesh, _dropped = scene.add_mesh(**self.mesh)
        scene.add_instance(mesh, UNMOVED, [scene.add_model_material(material)])
        scene.commit()


def structure(kind: str) -> Structure:
    """A kind of Tile, or "scales"."""
    if kind == "scales":
        return scales()
    with Tile.create(kind) as tile:
        mesh = tile.mesh()
        period = tuple(tile.info()["period"])
    return Structure(kind, period, {"positions": mesh.positions, "triangles": mesh.triangles})


def scales(pitch: float = 0.005, rows: int = 4, around: int = 24) -> Structure:
    """Rows of raised scales that overlap like roof tiles, each a closed mesh, as an artist models them."""
    points, triangles = _scale(around)
    y, x = np.divmod(np.arange(rows**2), rows)
    places = np.stack([x + y % 2 / 2, y, 0 * x], axis=-1)
    copies = triangles + len(points) * np.arange(rows**2)[:, None, None]
    mesh = {
        "positions": (pitch * (points + places[:, None])).reshape(-1, 3).astype(np.float32),
        "triangles": copies.reshape(-1, 3).astype(np.uint32, order="C"),
    }
    return Structure("scales", (rows * pitch, rows * pitch), mesh)


def _scale(around: int) -> tuple[np.ndarray, np.ndarray]:
    """Points and triangles of a flattened ellipsoid above z = 0; its tip, at -y, is raised."""
    half, tilt = np.array([0.48, 1.2, 0.1]), np.radians(20)
    polar, angle = np.meshgrid(
        np.linspace(0, np.pi, around // 2 + 1), np.arange(around) * (2 * np.pi / around), indexing="ij"
    )
    ball = [np.sin(polar) * np.cos(angle), np.sin(polar) * np.sin(angle), np.cos(polar)]
    x, y, z = half[:, None, None] * np.array(ball)
    z = z - 0.3 * x**2
    y, z = y * np.cos(tilt) + z * np.sin(tilt), z * np.cos(tilt) - y * np.sin(tilt)
    points = np.stack([x, y, z - z.min()], axis=-1).reshape(-1, 3)
    row, column = np.meshgrid(np.arange(around // 2), np.arange(around), indexing="ij")
    corner = [(row + i) * around + (column + j) % around for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))]
    quads = np.stack(corner, axis=-1).reshape(-1, 4)
    return points, np.concatenate([quads[:, :3], quads[:, [0, 2, 3]]])


def model_of_tile(
    scene: Scene, tile: dict, data: Path, around: int, seed: int = 0, threads: int = 0, **capture
) -> tuple[Model, float]:
    """Captures a committed scene that holds the tile into `data`, also from below if one can see through it,
    and compresses the capture. Returns the model and the seconds.

    `tile`: its kind and period; `around`: number of views and of lights; `capture`: further options of
    capture_job().
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


class Plane(NamedTuple):
    """A square of `rows` x `rows` tiles around the origin."""

    rows: int
    period: float

    @property
    def columns(self) -> int:
        return self.rows

    def frame(self, uv: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        points = np.zeros((*uv.shape[:-1], 3))
        points[..., :2] = (uv - self.rows / 2) * self.period
        return points, np.broadcast_to([0, 0, 1.0], points.shape)


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


Surface = Sphere | Plane | Cloth


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
    }
