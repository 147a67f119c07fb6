"""Models of tiles that repeat infinitely: of their BTFs, and with their shells."""

from __future__ import annotations

from pathlib import Path

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
