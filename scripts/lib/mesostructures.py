"""Renders pictures of the procedural tiles, each repeated 3 x 3 times, under a sun and a gray environment."""

from __future__ import annotations

import argparse
import math
from pathlib import Path

import numpy as np
from velour.native import Scene, Tile, images, render_job

ROOT = Path(__file__).resolve().parents[2]
REPEATS = 3
SIDE = 280  # pixels
FIELD_OF_VIEW = 0.25  # radians
SUN_IRRADIANCE = 2.2
SKY_RADIANCE = 0.35


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--spp", type=int, default=400, help="light directions a pixel (400)")
    parser.add_argument("--output", type=Path, default=ROOT / "docs/results/mesostructures", metavar="FOLDER")
    arguments = parser.parse_args()
    arguments.output.mkdir(parents=True, exist_ok=True)
    for kind in Tile.kinds():
        path = arguments.output / f"{kind['name']}.png"
        with Tile.create(kind["name"]) as tile:
            images.write(path, picture(tile, arguments.spp))
        print(path)


def picture(tile: Tile, spp: int) -> np.ndarray:
    """Linear pixels [SIDE x SIDE x 3]; black behind the holes."""
    width = tile.info()["period"][0]
    with Scene() as scene:
        repeat(tile, scene)
        scene.set_world_color([SKY_RADIANCE] * 3)
        scene.add_light("sun", [SUN_IRRADIANCE] * 3, _turned(50, 35), angle=0.01)
        _look(scene, width)
        scene.commit()
        options = {"width": SIDE, "height": SIDE, "spp": spp, "bounces": 3, "transparent": 1}
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


def _look(scene: Scene, width: float) -> None:
    """Looks down at 40 degrees from the vertical, so that about 2 repeats fill the picture."""
    distance = 2 * width / (2 * math.tan(FIELD_OF_VIEW / 2))
    tilt = math.radians(40)
    eye = (0.0, -distance * math.sin(tilt), distance * math.cos(tilt))
    scene.look_at(eye, (0, 0, 0), FIELD_OF_VIEW, 1.0)


def _turned(theta: float, phi: float) -> np.ndarray:
    """Transform of a light that shines from polar angle theta and azimuth phi, in degrees."""
    t, p = math.radians(theta), math.radians(phi)
    back = np.array([math.sin(t) * math.cos(p), math.sin(t) * math.sin(p), math.cos(t)])
    side = np.array([-math.sin(p), math.cos(p), 0.0])
    matrix = np.eye(4)
    matrix[:3, 0], matrix[:3, 1], matrix[:3, 2] = side, np.cross(back, side), back
    return matrix


if __name__ == "__main__":
    main()
