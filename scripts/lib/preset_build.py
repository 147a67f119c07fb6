"""Builds the models of presets: a virtual measurement and its fit, each kept under a hash of its inputs."""

from __future__ import annotations

import contextlib
import dataclasses
import hashlib
import json
import tempfile
from pathlib import Path
from typing import NamedTuple

from preset_table import Preset, Surface, Weave
from tile_btf import model_of_tile
from velour.core import files
from velour.native import Measurement, Model, Scene, Tile, fit_job, library, microsurface_job, votf_job

_RECIPE = 2  # incremented with each change, here or in the library, that changes models
_UNMOVED = ((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0))


class Sizes(NamedTuple):
    """Sizes of the measurements; all of them affect the models."""

    rays: int = 4_000_000  # for a microsurface that is a preset itself
    yarn_rays: int = 2_000_000  # for a microsurface of yarns
    texels: int = 64
    directions: int = 81  # number of views, and of lights
    samples: int = 8  # per texel and view
    outline_texels: int = 96


QUICK = Sizes(100_000, 100_000, 8, 81, 1, 32)


class Workshop:
    """Builds into `work`, where models are files named by a hash of what they depend on.

    That is the preset's own numbers, the sizes, the release of the library and _RECIPE. It is not the
    library's bytes, because each build of the library would then rebuild all models.
    """

    def __init__(self, work: Path, sizes: Sizes, threads: int, fresh: bool = False):
        self.work, self._sizes, self._threads, self._fresh = work, sizes, threads, fresh
        self._made: set[Path] = set()
        self._release = library.system()["version"]
        work.mkdir(parents=True, exist_ok=True)

    def model_path(self, preset: Preset) -> Path:
        return self._path(preset.made_of)

    def is_built(self, preset: Preset) -> bool:
        return self._is_kept(self.model_path(preset))

    def build(self, preset: Preset) -> Path:
        """Returns the file of the model; its report lies beside it as JSON."""
        made_of = preset.made_of
        return (
            self._of_weave(made_of)
            if isinstance(made_of, Weave)
            else self._of_surface(made_of, self._sizes.rays)
        )

    def report_of(self, preset: Preset) -> dict | None:
        """The report of a preset; None if it was not built."""
        report = self.model_path(preset).with_suffix(".json")
        return json.loads(report.read_text(encoding="utf-8")) if report.is_file() else None

    def _path(self, made_of: Surface | Weave, rays: int | None = None) -> Path:
        sizes = self._sizes._asdict() if isinstance(made_of, Weave) else {"rays": rays or self._sizes.rays}
        what = [_RECIPE, self._release, dataclasses.asdict(made_of), sizes]
        key = hashlib.sha256(json.dumps(what, sort_keys=True).encode()).hexdigest()[:16]
        return self.work / f"{type(made_of).__name__.lower()}-{key}.velour"

    def _is_kept(self, model: Path) -> bool:
        # The report is written last, so it implies a complete model.
        return model.with_suffix(".json").is_file() and (not self._fresh or model in self._made)

    def _keep(self, path: Path, model: Model, report: dict) -> Path:
        model.save(path)
        files.write_json(path.with_suffix(".json"), report)
        self._made.add(path)
        return path

    def _of_surface(self, surface: Surface, rays: int) -> Path:
        path = self._path(surface, rays)
        if self._is_kept(path):
            return path
        with tempfile.TemporaryDirectory(prefix="velour-preset-") as folder, contextlib.ExitStack() as opened:
            table = Path(folder) / ("surface.binary" if surface.anisotropy == 1.0 else "surface.exr")
            with microsurface_job(
                table, **dataclasses.asdict(surface), rays=rays, seed=1, threads=self._threads
            ) as job:
                measured = job.run()
            measurement = opened.enter_context(Measurement.load(table))
            job = opened.enter_context(fit_job(measurement, all_data=1, threads=self._threads))
            fitted = job.run()
            model = opened.enter_context(job.result_model())
            report = {
                "seconds": measured["seconds"] + fitted["seconds"],
                "albedo": measured["albedo"],
                "noise": measured["relative_standard_error"],
                "relative_l2": fitted["relative_l2"],
                "bytes": fitted["bytes"],
            }
            return self._keep(path, model, report)

    def _of_weave(self, weave: Weave) -> Path:
        path = self._path(weave)
        if self._is_kept(path):
            return path
        yarns = [self._of_surface(yarn, self._sizes.yarn_rays) for yarn in weave.yarns]
        with contextlib.ExitStack() as opened:
            tile = opened.enter_context(Tile.create(weave.kind, **weave.shape))
            scene = opened.enter_context(Scene())
            _add(tile, [opened.enter_context(Model.load(yarn)) for yarn in yarns], scene)
            look, seconds = self._look(scene, tile)
            return self._with_outline(path, scene, tile, opened.enter_context(look), seconds)

    def _look(self, scene: Scene, tile: Tile) -> tuple[Model, float]:
        """The model of the repeated tile's BTF, and the seconds that it took."""
        sizes = self._sizes
        with tempfile.TemporaryDirectory(prefix="capture-", dir=self.work) as folder:
            return model_of_tile(
                scene,
                tile.info(),
                Path(folder) / "tile.btf",
                sizes.directions,
                seed=1,
                threads=self._threads,
                texels=sizes.texels,
                samples=sizes.samples,
                bounces=2,
            )

    def _with_outline(self, path: Path, scene: Scene, tile: Tile, look: Model, seconds: float) -> Path:
        info = tile.info()
        with votf_job(
            scene,
            look,
            texels=self._sizes.outline_texels,
            period=info["period"],
            source=info["kind"],
            threads=self._threads,
        ) as job:
            outline = job.run()
            with job.result_model() as model:
                report = {
                    "seconds": seconds + outline["seconds"],
                    "relative_l2": look.info()["relative_l2"],
                    "coverage": outline["coverage"],
                    "tile_metres": info["period"],
                    "bytes": len(model.bytes()),
                }
                return self._keep(path, model, report)


def _add(tile: Tile, yarns: list[Model], scene: Scene) -> None:
    """Adds the tile's mesh with the yarns' models, oriented by texture coordinates that run along yarns."""
    mesh, _dropped = scene.add_mesh(**tile.mesh()._asdict())
    materials = [scene.add_model_material(yarn) for yarn in yarns]
    scene.add_instance(mesh, _UNMOVED, materials)
    scene.commit()
