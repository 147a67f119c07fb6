"""scripts/presets, after staging: models, previews and the .blend of the presets.

A model is a virtual measurement and its fit, kept under a hash of its inputs.
"""

from __future__ import annotations

import argparse
import contextlib
import dataclasses
import hashlib
import json
import shutil
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

import numpy as np
import tomllib
from bench import blender, charts
from bench.progress import Progress
from bench.project import ROOT
from bench.tiles import UNMOVED, model_of_tile, with_shell
from velour.core import files, presets
from velour.core.ball import ROWS, ball_job, ball_scene, shown
from velour.core.machine import threads
from velour.core.presets import CATALOG_FILE, INDEX_FILE, LIBRARY_FILE, LICENCE_FILE, MOST_BYTES
from velour.core.srgb import decoded, encoded
from velour.native import Measurement, Model, Scene, Tile, fit_job, images, library, microsurface_job

_RECIPE = 2  # incremented with each change, here or in the library, that changes models
_MODELS = ROOT / "addon/presets"  # in the repository
_BUILT = ROOT / "build/presets"
_KEY = "library.key"  # hash of everything that the .blend was made of
_PICTURE = ROOT / "docs/results/images/presets.png"
_COST = {True: 10, False: 1}  # relative time of a cloth and of other presets, for the progress
_SIDE, _COLUMNS = 256, 6  # pixels of a preview; columns of the sheet of all
_LICENCE = """The materials of this folder are in the public domain: CC0-1.0,
https://creativecommons.org/publicdomain/zero/1.0/
"""


@dataclasses.dataclass(frozen=True)
class Surface:
    """Arguments of velour.native.microsurface_job."""

    roughness: float
    metal: str = "copper"
    anisotropy: float = 1.0
    base_albedo: tuple[float, float, float] = (0.0, 0.0, 0.0)
    base_share: float = 0.0
    ior: float = 0.0
    flake_roughness: float = 0.2


@dataclasses.dataclass(frozen=True)
class Weave:
    """A tile of velour.native.Tile and the surfaces of its yarns, one per material slot."""

    kind: str
    yarns: tuple[Surface, ...]
    shape: dict = dataclasses.field(default_factory=dict)  # further arguments of Tile.create
    repeats: int = 24  # tiles around the preview's ball, and per unit of texture coordinates
    texels: int = 64  # along a side of a tile; that is what its model's size depends on most


@dataclasses.dataclass(frozen=True, eq=False)
class Preset:
    name: str
    catalog: str
    made_of: Surface | Weave
    description: str
    tags: tuple[str, ...]

    @property
    def file_name(self) -> str:
        return self.name.lower().replace(" ", "_")

    @property
    def repeats(self) -> int:
        """Tiles per unit of texture coordinates; 0: not a texture."""
        return self.made_of.repeats if isinstance(self.made_of, Weave) else 0


def _surface(values: dict) -> Surface:
    return Surface(**{name: tuple(v) if isinstance(v, list) else v for name, v in values.items()})


def _preset(name: str, catalog: str, description: str, tags: list, **made: dict) -> Preset:
    made_of = _surface(made["surface"]) if "surface" in made else Weave(**made)
    if "yarns" in made:
        made_of = dataclasses.replace(made_of, yarns=tuple(map(_surface, made["yarns"])))
    return Preset(name, catalog, made_of, description, tuple(tags))


_READ = tomllib.loads(Path(__file__).with_name("presets.toml").read_text(encoding="utf-8"))
CATALOGS, GROUP_CATALOGS = _READ["catalogs"], _READ["group_catalogs"]
PRESETS = tuple(_preset(**values) for values in _READ["preset"])


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
        if isinstance(made_of, Weave):
            return self._of_weave(made_of)
        return self._of_surface(made_of, self._sizes.rays)

    def _path(self, made_of: Surface | Weave, rays: int | None = None) -> Path:
        sizes = self._sizes._asdict() if isinstance(made_of, Weave) else {"rays": rays or self._sizes.rays}
        what = [_RECIPE, self._release, dataclasses.asdict(made_of) | {"repeats": 0}, sizes]
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
        options = dataclasses.asdict(surface) | {"rays": rays, "seed": 1, "threads": self._threads}
        with tempfile.TemporaryDirectory(prefix="velour-preset-") as folder, contextlib.ExitStack() as opened:
            table = Path(folder) / ("surface.binary" if surface.anisotropy == 1.0 else "surface.exr")
            with microsurface_job(table, **options) as job:
                measured = job.run()
            measurement = opened.enter_context(Measurement.load(table))
            job = opened.enter_context(fit_job(measurement, all_data=1, threads=self._threads))
            fitted = job.run()
            model = opened.enter_context(job.result_model())
            report = {"seconds": measured["seconds"] + fitted["seconds"], "albedo": measured["albedo"]}
            report |= {"noise": measured["relative_standard_error"], "relative_l2": fitted["relative_l2"]}
            return self._keep(path, model, report | {"bytes": fitted["bytes"]})

    def _of_weave(self, weave: Weave) -> Path:
        """The model of the repeated tile's BTF, with its shell."""
        path, sizes = self._path(weave), self._sizes
        if self._is_kept(path):
            return path
        yarns = [self._of_surface(yarn, sizes.yarn_rays) for yarn in weave.yarns]
        with (
            contextlib.ExitStack() as opened,
            tempfile.TemporaryDirectory(prefix="capture-", dir=self.work) as folder,
        ):
            tile = opened.enter_context(Tile.create(weave.kind, **weave.shape))
            scene, info = opened.enter_context(Scene()), tile.info()
            # The yarns' models are oriented by texture coordinates that run along the yarns.
            mesh, _dropped = scene.add_mesh(**tile.mesh()._asdict())
            models = [opened.enter_context(Model.load(yarn)) for yarn in yarns]
            scene.add_instance(mesh, UNMOVED, [scene.add_model_material(model) for model in models])
            scene.commit()
            data, options = Path(folder) / "tile.btf", {"seed": 1, "threads": self._threads}
            capture = {"texels": min(sizes.texels, weave.texels), "samples": sizes.samples, "bounces": 2}
            look, seconds = model_of_tile(scene, info, data, sizes.directions, **options, **capture)
            opened.enter_context(look)
            shell = {"texels": sizes.outline_texels, "threads": self._threads}
            model, outline = with_shell(scene, info, look, **shell)
            opened.enter_context(model)
            report = {"seconds": seconds + outline["seconds"], "relative_l2": look.info()["relative_l2"]}
            report |= {"coverage": outline["coverage"], "tile_metres": info["period"]}
            return self._keep(path, model, report | {"bytes": len(model.bytes())})


def picture(preset: Preset, model_path: Path, spp: int) -> np.ndarray:
    """The preview of a preset in the asset browser: a ball in a studio, rendered by Velour.

    [_SIDE x _SIDE x 4] float32, sRGB as displayed, opaque; row 0 at the bottom, as in Blender's previews.
    """
    made_of = preset.made_of
    rows = made_of.repeats // 2 if isinstance(made_of, Weave) else ROWS
    with (
        Model.load(model_path) as model,
        ball_scene(lambda scene: scene.add_model_material(model), rows) as scene,
        ball_job(scene, _SIDE, spp) as job,
    ):
        job.run()
        return shown(job.read_pass("Combined"))


def main() -> int:
    args = _arguments()
    models = args.output or (_BUILT / "quick" if args.quick else _MODELS)
    library = models if args.output or args.quick else _BUILT
    if not args.library:
        _build(models, args)
    listed = presets.listed(models)
    if not listed:
        return 0
    if args.docs:
        sheet = [(entry.name, encoded(images.read_picture(entry.picture))[::-1]) for entry in listed]
        charts.sheet(_PICTURE, charts.wrapped(sheet, _COLUMNS), (1.6, 1.8))
    write_library(models, library)
    kept = {path for place in (models, library) for path in place.iterdir() if path.is_file()}
    size = sum(path.stat().st_size for path in kept)
    print(f"{library / LIBRARY_FILE}: {len(listed)} of {len(PRESETS)} presets, {size / 1e6:.2f} MB in all")
    if size > MOST_BYTES:
        print(f"presets: that is more than {MOST_BYTES / 1e6:.0f} MB", file=sys.stderr)
        return 1
    return 0


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="presets")
    parser.add_argument("--only", metavar="NAME[,NAME...]", default="", help="builds no others")
    parser.add_argument("--quick", action="store_true", help="small and coarse, to try the script")
    parser.add_argument("--fresh", action="store_true", help="builds again what is kept")
    parser.add_argument("--library", action="store_true", help="builds only the .blend, from kept models")
    parser.add_argument("--docs", action="store_true", help=f"writes {_PICTURE.relative_to(ROOT)}, too")
    parser.add_argument("--output", metavar="FOLDER", type=Path)
    parser.add_argument("--threads", metavar="T", type=int, default=threads())
    return parser.parse_args()


def _chosen(only: str) -> list[Preset]:
    by_name = {preset.name.lower(): preset for preset in PRESETS}
    names = [name.strip().lower() for name in only.split(",") if name.strip()]
    unknown = [name for name in names if name not in by_name]
    if unknown:
        known = ", ".join(preset.name for preset in PRESETS)
        raise SystemExit(f"presets: there is no {unknown[0]!r}; there are {known}")
    return [by_name[name] for name in names] or list(PRESETS)


def _build(models: Path, args: argparse.Namespace) -> None:
    """Builds the chosen presets into the folder `models`. Others that are there stay; the index names all."""
    models.mkdir(parents=True, exist_ok=True)
    work = _BUILT / "quick/work" if args.quick else _BUILT / "work"
    workshop = Workshop(work, QUICK if args.quick else Sizes(), args.threads, args.fresh)
    progress = Progress()
    costs = {preset: _COST[isinstance(preset.made_of, Weave)] for preset in _chosen(args.only)}
    for cost in costs.values():
        progress.expect(cost)
    for preset, cost in costs.items():
        if workshop.is_built(preset):
            progress.skip(preset.name, cost)
        else:
            with progress.work(preset.name, cost):
                workshop.build(preset)
        put(preset, workshop.model_path(preset), models, 8 if args.quick else 1024)
    entries = [entry_of(preset, models) for preset in PRESETS]
    files.write_text(models / INDEX_FILE, presets.index_text([e for e in entries if e.model.is_file()]))
    files.write_text(models / LICENCE_FILE, _LICENCE)


def entry_of(preset: Preset, models: Path) -> presets.Preset:
    paths = (models / f"{preset.file_name}.{suffix}" for suffix in ("velour", "png"))
    return presets.Preset(
        preset.name, *paths, preset.catalog, preset.description, preset.tags, preset.repeats
    )


def put(preset: Preset, model: Path, models: Path, spp: int) -> None:
    """Copies a built model into the folder of all, with a new preview, unless it is there already."""
    entry = entry_of(preset, models)
    if entry.picture.is_file() and entry.model.is_file() and entry.model.read_bytes() == model.read_bytes():
        return
    linear = decoded(picture(preset, model, spp)[..., :3])
    images.write(entry.picture, np.ascontiguousarray(linear, np.float32))
    files.write_atomic(entry.model, lambda temporary: shutil.copyfile(model, temporary))


def write_library(models: Path, folder: Path) -> None:
    """Writes the .blend of all presets in `models`, its catalogs and license, unless it is up to date."""
    folder.mkdir(parents=True, exist_ok=True)
    key, kept = _library_key(models), folder / _KEY
    if (folder / LIBRARY_FILE).is_file() and kept.is_file() and kept.read_text() == key:
        return
    task = {"path": str((folder / LIBRARY_FILE).resolve()), "folder": str(models.resolve())}
    task |= {"catalogs": CATALOGS, "group_catalogs": GROUP_CATALOGS}
    blender.run("presets", task, folder / "blender.log")
    paths = {number: f"Velour/{name}" for name, number in CATALOGS.items()}
    paths |= {number: f"Velour/Node Groups/{name}" for name, number in GROUP_CATALOGS.items()}
    lines = [f"{number}:{path}:{path.replace('/', '-').replace(' ', '-')}" for number, path in paths.items()]
    files.write_text(folder / CATALOG_FILE, "\n".join(("VERSION 1", "", *lines, "")))
    files.write_text(folder / LICENCE_FILE, _LICENCE)
    files.write_text(kept, key)


def _library_key(models: Path) -> str:
    """Hash of the models and of the code that turns them into materials."""
    digest = hashlib.sha256()
    code = [*(ROOT / "addon/velour").rglob("*.py"), Path(__file__).with_name("bench") / "inside/presets.py"]
    code.append(Path(__file__).with_name("presets.toml"))
    # The folder may also hold the .blend, its key and Blender's log.
    made_of = [path for kind in (INDEX_FILE, "*.velour", "*.png") for path in models.glob(kind)]
    for path in (*sorted(made_of), *sorted(code)):
        digest.update(path.name.encode() + path.read_bytes())
    return digest.hexdigest()


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        print("presets: stopped; the next run goes on from here.", file=sys.stderr)
        sys.exit(130)
