"""The model of the BTF of a tile that repeats infinitely."""

from __future__ import annotations

from pathlib import Path

from velour.native import Btf, Model, Scene, capture_job, compress_job, directions


def model_of_tile(
    scene: Scene, tile: dict, data: Path, around: int, seed: int = 0, threads: int = 0, **capture
) -> tuple[Model, float]:
    """Captures a committed scene that holds the tile into `data`, also from below if one can see through it,
    and compresses the capture. Returns the model and the seconds.

    `tile`: its info(); `around`: number of views and of lights; `capture`: further options of capture_job().
    """
    angles = directions(str(around))
    with capture_job(
        scene,
        data,
        views=angles,
        lights=angles,
        period=tile["period"],
        source=tile["kind"],
        seed=seed,
        threads=threads,
        **capture,
    ) as job:
        seconds = job.run()["seconds"]
    with Btf.load(data) as btf, compress_job(btf, seed=seed, threads=threads) as job:
        seconds += job.run()["seconds"]
        return job.result_model(), seconds
