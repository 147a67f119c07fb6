"""Pictures of the procedural tiles, repeated 3 x 3 times, under a sun and a gray environment."""

from __future__ import annotations

import math

import numpy as np
from velour.native import Scene, Tile, images, render_job

from .. import tiles
from ..run import Run

SETTINGS = {"side": (280, 70), "spp": (400, 16)}
REPEATS = 3
FIELD_OF_VIEW = 0.25  # radians
SUN_IRRADIANCE = 2.2
SKY_RADIANCE = 0.35


def measure(run: Run) -> None:
    folder = run.output / "mesostructures"
    folder.mkdir(parents=True, exist_ok=True)
    for kind in Tile.kinds():
        path = folder / f"{kind['name']}.png"
        with Tile.create(kind["name"]) as tile:
            images.write(path, picture(tile, run.settings.side, run.settings.spp))
        print(path)


def picture(tile: Tile, side: int, spp: int) -> np.ndarray:
    """Linear pixels [side x side x 3]; black behind the holes."""
    width = tile.info()["period"][0]
    # Looks down at 40 degrees from the vertical, so that about 2 repeats fill the picture.
    distance, tilt = 2 * width / (2 * math.tan(FIELD_OF_VIEW / 2)), math.radians(40)
    with Scene() as scene:
        repeat(tile, scene)
        scene.set_world_color([SKY_RADIANCE] * 3)
        scene.add_light("sun", [SUN_IRRADIANCE] * 3, tiles.sun((0.6275, 0.4394, 0.6428)), angle=0.01)
        eye = (0.0, -distance * math.sin(tilt), distance * math.cos(tilt))
        scene.look_at(eye, (0, 0, 0), FIELD_OF_VIEW, 1.0)
        scene.commit()
        options = {"width": side, "height": side, "spp": spp, "bounces": 3, "transparent": 1}
        with render_job(scene, **options) as job:
            job.run()
            return job.read_pass("Combined")[..., :3].copy()


def repeat(tile: Tile, scene: Scene) -> None:
    """REPEATS x REPEATS copies around the origin, and more around them, so that no edge is visible."""
    mesh, materials = tile.add_to(scene)
    period = tile.info()["period"]
    for x in range(-2, REPEATS + 2):
        for y in range(-2, REPEATS + 2):
            matrix = np.eye(4)
            matrix[:2, 3] = (x - REPEATS / 2) * period[0], (y - REPEATS / 2) * period[1]
            scene.add_instance(mesh, matrix, materials)
