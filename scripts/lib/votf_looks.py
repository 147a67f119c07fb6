"""Materials of scripts/votf: one BRDF, or the tile's BTF, each smooth and with its shell."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from progress import Progress
from tile_btf import model_of_tile
from velour.native import Measurement, Model, Scene, Tile, fit_job, microsurface_job, votf_job

_UNMOVED = ((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0))
_DIRECTIONS = 81  # views and lights each, the directions of the Bonn BTFs


class Look(NamedTuple):
    name: str
    smooth: Model
    shell: Model
    of_geometry: Model | None  # None: the tile's own materials


def brdf(folder: Path, rays: int) -> Model:
    """A rough metal over a diffuse base, from the virtual goniometer."""
    table, model = folder / "metal.exr", folder / f"metal-{rays}.velour"
    if not model.exists():
        options = {"metal": "copper", "roughness": 0.4, "base_albedo": (0.5, 0.4, 0.3), "base_share": 0.6}
        with microsurface_job(table, rays=rays, **options) as job:
            job.run()
        with Measurement.load(table) as measured, fit_job(measured) as job:
            job.run()
            with job.result_model() as fitted:
                fitted.save(model)
    return Model.load(model)


@contextlib.contextmanager
def looks(
    tile: Tile, plain: Model, folder: Path, texels: int, progress: Progress
) -> Iterator[tuple[Look, Look]]:
    """The look of the BRDF, then that of the BTF."""
    info = tile.info()
    with contextlib.ExitStack() as handles, Scene() as scene:
        mesh, materials = tile.add_to(scene)
        scene.add_instance(mesh, _UNMOVED, materials)
        scene.commit()
        with progress.work(f"BTF of {info['kind']}", texels**2):
            own = handles.enter_context(_btf(scene, info, folder / f"{info['kind']}-{texels}.velour", texels))
        shells = [handles.enter_context(_with_shell(scene, info, model)) for model in (plain, own)]
        yield Look("BRDF", plain, shells[0], plain), Look("BTF", own, shells[1], None)


def _btf(scene: Scene, info: dict, path: Path, texels: int) -> Model:
    if not path.exists():
        data = path.with_suffix(".btf")
        fitted, _seconds = model_of_tile(scene, info, data, _DIRECTIONS, texels=texels, resume=1)
        with fitted:
            fitted.save(path)
    return Model.load(path)


def _with_shell(scene: Scene, info: dict, model: Model) -> Model:
    with votf_job(scene, model, origin=(0, 0), period=info["period"], source=info["kind"]) as job:
        job.run()
        return job.result_model()
