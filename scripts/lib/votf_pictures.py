"""Renders a surface with a tile's geometry, with its BTF alone, and with its shell."""

from __future__ import annotations

import dataclasses

import numpy as np
from velour.native import Model, Scene, Tile, render_job
from votf_shapes import Cloth, Surface, smooth_mesh, structured_mesh

_UNMOVED = ((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0))
_FIELD = np.radians(20)


@dataclasses.dataclass(frozen=True)
class Picture:
    pixels: np.ndarray  # RGBA, premultiplied
    seconds: float
    bytes: int  # memory of the scene


@dataclasses.dataclass(frozen=True)
class Shot:
    """A surface in a square picture of `side` pixels in which a tile is `tile_pixels` wide."""

    surface: Surface
    tile_pixels: float
    side: int
    samples: int

    def picture(self, scene: Scene, strategy: str = "mis") -> Picture:
        scene.add_light("sun", (3, 3, 3), _sun(0.6, 0.5), angle=0.02)
        scene.set_world_color((0.5, 0.5, 0.5))
        # A tile spans `tile_pixels` at the distance of the surface's center.
        distance = self.side * self.surface.period / self.tile_pixels / (2 * np.tan(_FIELD / 2))
        up = 0.75 if isinstance(self.surface, Cloth) else 0.15
        eye = distance * np.array([0, -np.cos(up), np.sin(up)])
        middle = (0, 0, -0.2 * self.surface.radius) if isinstance(self.surface, Cloth) else (0, 0, 0)
        scene.look_at(tuple(eye + np.array(middle)), middle, _FIELD, 1.0)
        scene.commit()
        options = {"width": self.side, "height": self.side, "spp": self.samples, "split": 1}
        with render_job(scene, strategy=strategy, transparent=1, **options) as job:
            seconds = job.run()["seconds"]
            return Picture(job.read_pass("Combined"), seconds, scene.info()["bytes"])


def of_geometry(shot: Shot, tile: Tile, material: Model | None) -> Picture:
    mesh = tile.mesh()._asdict()
    period = tile.info()["period"][0]
    with Scene() as scene:
        number, _ = scene.add_mesh(**structured_mesh(shot.surface, mesh, period))
        slots = [scene.add_model_material(material)] if material else _own(scene, tile)
        scene.add_instance(number, _UNMOVED, slots)
        return shot.picture(scene)


def of_model(shot: Shot, model: Model) -> Picture:
    """A picture of the smooth surface with `model`."""
    with Scene() as scene:
        number, _ = scene.add_mesh(**smooth_mesh(shot.surface))
        material = scene.add_model_material(model)
        scene.add_instance(number, _UNMOVED, [material])
        if "shell" in model.info():
            scene.set_shell_tile(material, shot.surface.period)
        return shot.picture(scene)


def _own(scene: Scene, tile: Tile) -> list[int]:
    return [
        scene.add_principled_material(**{name: m[name] for name in m if name != "name"})
        for m in tile.info()["materials"]
    ]


def _sun(elevation: float, azimuth: float) -> tuple:
    """Transform of a sun; its rays go along -z of the transform."""
    z = np.array(
        [np.cos(elevation) * np.sin(azimuth), -np.cos(elevation) * np.cos(azimuth), np.sin(elevation)]
    )
    x = np.cross([0, 0, 1.0], z)
    x /= np.linalg.norm(x)
    y = np.cross(z, x)
    return tuple((x[i], y[i], z[i], 0) for i in range(3))
