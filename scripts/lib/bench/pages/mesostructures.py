"""Pictures of the procedural tiles, repeated 3 x 3 times, under a sun and a gray environment."""

from __future__ import annotations

import math

import numpy as np
from velour.native import Scene, Tile, images, render_job

from .. import tiles
from ..run import Run

SETTINGS = {"side": (280, 70), "spp": (400, 16)}
FIELD_OF_VIEW = 0.25  # radians
_TILT = math.radians(40)  # from the vertical
_COPIES = range(-4, 3)  # around the origin, more than are seen, so that no edge is visible


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
    width, height = tile.info()["period"]
    distance = 2 * width / (2 * math.tan(FIELD_OF_VIEW / 2))  # about 2 repeats fill the picture
    with Scene() as scene:
        mesh, materials = tile.add_to(scene)
        for x in _COPIES:
            for y in _COPIES:
                matrix = np.eye(4)
                matrix[:2, 3] = (x + 0.5) * width, (y + 0.5) * height
                scene.add_instance(mesh, matrix, materials)
        scene.set_world_color([0.35] * 3)
        scene.add_light("sun", [2.2] * 3, tiles.sun((0.6275, 0.4394, 0.6428)), angle=0.01)
        eye = (0.0, -distance * math.sin(_TILT), distance * math.cos(_TILT))
        scene.look_at(eye, (0, 0, 0), FIELD_OF_VIEW, 1.0)
        scene.commit()
        options = {"width": side, "height": side, "spp": spp, "bounces": 3, "transparent": 1}
        with render_job(scene, **options) as job:
            job.run()
            return job.read_pass("Combined")[..., :3].copy()
