"""Silhouettes of shells (VOTFs) against geometry: outline, alpha, shadow, FLIP, seconds, megabytes."""

from __future__ import annotations

import contextlib
import itertools
import time
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy import ndimage
from velour.native import Measurement, Model, Scene, fit_job, microsurface_job, render_job

from .. import charts, flip_metric, tiles
from ..run import Run
from ..tiles import Cloth, Plane, Sphere, Structure, Surface, smooth_mesh, structured_mesh

SETTINGS = {
    "structures": (("net", "chainmail", "weave", "gravel", "corduroy", "scales"), ("net", "scales")),
    "angles": ((0, 30, 60, 75, 85), (0, 75)),  # between the view and the plane's normal, degrees
    "tile_pixels": ((4, 16, 64, 256), (8, 32)),
    "samples": ((64, 64, 8, 8), (16, 4)),  # per pixel, for each of `tile_pixels`
    "side": (384, 160),  # maximum, of a picture
    "shown": (64, 32),  # pixels a tile of the table and the pictures
    "rays": (40_000_000, 4_000_000),  # of the goniometer
    "texels": (32, 16),  # per side of the BTFs
    "directions": (81, 25),  # views and lights each; 81: those of the Bonn BTFs
}
CSV = "votf_numbers.csv"
PAGES = {"votf_numbers.md": "votf"}
WAYS = ("geometry", "BTF", "BTF + VOTF", "BRDF + VOTF")
SHELL = "BTF + VOTF"
_FIELD = np.radians(20)
_BEHIND = 0.25  # background radiance of the sheets and of FLIP
_SUN = (0.396, -0.724, 0.565)
_ANGLES = {"ball": 80, "cloth": 47}  # of the view, degrees
# Rows of the chart and their labels.
_ROWS = {
    "outline": "1 - IoU of outlines",
    "alpha": "1 - IoU of alpha",
    "shadow": "error of shadows",
    "flip": "FLIP",
    "seconds": "processor seconds",
}
_FLOOR = ((-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0))
# View of the picture of each structure whose failure the page explains.
FAILURES = {"scales": "plane 0", "corduroy": "plane 85", "gravel": "ball 80"}


class View(NamedTuple):
    """A camera in the plane x = 0 that frames points from an angle to +z, in degrees."""

    points: np.ndarray
    angle: float

    @property
    def target(self) -> np.ndarray:
        return (self.points.min(axis=0) + self.points.max(axis=0)) / 2

    @property
    def width(self) -> float:
        """Width of the whole picture at the target, in meters."""
        return 1.3 * np.ptp(self.points[:, :2], axis=0).max()

    @property
    def eye(self) -> np.ndarray:
        angle = np.radians(max(self.angle, 0.1))  # straight down, the picture's up would be undefined
        towards = np.array([0, -np.sin(angle), np.cos(angle)])
        return self.target + self.width / (2 * np.tan(_FIELD / 2)) * towards

    def edge(self) -> np.ndarray:
        """The rightmost of the points in the picture, from (0, 0) to (1, 1)."""
        forward = self.target - self.eye
        forward /= np.linalg.norm(forward)
        right = np.array([1.0, 0, 0])
        x, y, depth = np.stack([right, np.cross(right, forward), forward]) @ (self.points - self.eye).T
        place = np.stack([x, y]) / depth / (2 * np.tan(_FIELD / 2)) + 0.5
        return place[:, np.argmax(place[0])]

    def size(self, tile_pixels: float, period: float, side: int) -> dict:
        """Options of a render in which a tile is `tile_pixels` wide; if that is more than `side` pixels, of a
        crop at the edge."""
        whole = round(self.width / period * tile_pixels)
        if whole <= side:
            return {"width": whole, "height": whole}
        x, y = np.clip(np.round(self.edge() * whole) - side // 2, 0, whole - side).astype(int).tolist()
        crop = {"crop_x0": x, "crop_x1": x + side, "crop_y0": y, "crop_y1": y + side}
        return {"width": whole, "height": whole, **crop}


class Picture(NamedTuple):
    pixels: np.ndarray  # RGBA, premultiplied
    seconds: float  # of the processors


Pictures = dict[tuple[str, int], Picture]  # by surface and angle, or "shadow", and by pixels a tile


class Subject(NamedTuple):
    """A surface that shows a structure: `mesh` with `model`, whose shell has tiles of `period` meters."""

    mesh: dict
    model: Model
    period: float

    def add_to(self, scene: Scene) -> tuple[int, int]:
        """Numbers of the mesh and the material."""
        number, _dropped = scene.add_mesh(**self.mesh)
        material = scene.add_model_material(self.model)
        if "shell" in self.model.info():
            scene.set_shell_tile(material, self.period)
        return number, material


def subjects(surface: Surface, structure: Structure, models: dict[str, Model]) -> dict[str, Subject]:
    """Each of WAYS to show the structure on the surface."""
    period = structure.period[0]
    covered, smooth = structured_mesh(surface, structure.mesh, period), smooth_mesh(surface)
    return {way: Subject(covered if way == WAYS[0] else smooth, models[way], period) for way in WAYS}


def photographed(
    run: Run, subject: Subject, views: dict[str, View], seeds: tuple[int, ...]
) -> tuple[list[Pictures], int]:
    """All pictures of a subject and of its shadow for each seed, and bytes of the subject's scene."""
    with Scene() as scene:
        number, material = subject.add_to(scene)
        scene.add_instance(number, tiles.UNMOVED, [material])
        scene.add_light("sun", (3, 3, 3), tiles.sun(_SUN), angle=0.02)
        scene.set_world_color((0.5, 0.5, 0.5))
        found = [_all_sizes(run, scene, subject.period, views, seed) for seed in seeds]
        size = scene.info()["bytes"]
        scene.clear_instances()
        scene.set_world_color((0, 0, 0))
        scene.add_instance(number, tiles.UNMOVED, [material], hidden=("camera", "bounces"))
        shadow = {"shadow": _add_floor(scene, next(iter(views.values())).points)}
        for pictures, seed in zip(found, seeds, strict=True):
            pictures |= _all_sizes(run, scene, subject.period, shadow, seed)
        return found, size


def _all_sizes(run: Run, scene: Scene, period: float, views: dict[str, View], seed: int) -> Pictures:
    own, found = run.settings, {}
    for name, view in views.items():
        for pixels, samples in zip(own.tile_pixels, own.samples, strict=True):
            size = view.size(pixels, period, own.side)
            options = {"spp": samples, "seed": seed, "threads": run.threads}
            found[name, pixels] = _render(scene, view, **size, **options)
    return found


def _render(scene: Scene, view: View, **options) -> Picture:
    scene.look_at(tuple(view.eye), tuple(view.target), _FIELD, 1.0)
    scene.commit()
    with render_job(scene, strategy="mis", split=1, transparent=1, **options) as job:
        start = time.process_time()
        job.run()
        return Picture(job.read_pass("Combined"), time.process_time() - start)


def _add_floor(scene: Scene, points: np.ndarray) -> View:
    """Adds a white floor under the points. Returns a view of their shadow, from above."""
    height, span = points[:, 2].min(), np.ptp(points[:, 0])
    floor = np.array(_FLOOR) * 10 * span + np.array([0, 0, height - 0.1 * span])
    number, _ = scene.add_mesh(floor.astype(np.float32), np.array([[0, 1, 2], [0, 2, 3]], np.uint32))
    white = scene.add_principled_material(base_color=(0.8, 0.8, 0.8), roughness=1.0, specular=0.0)
    scene.add_instance(number, tiles.UNMOVED, [white])
    away = (points[:, 2:] - floor[0, 2]) / _SUN[2]
    return View(points - away * np.array(_SUN), 0)


def measure(run: Run) -> dict:
    own, rows, sheet = run.settings, [], []
    with _brdf(run.work, own.rays) as material:
        for kind in own.structures:
            structure = tiles.structure(kind)
            with _models(run, structure, material) as models:
                for surface, (body, angles) in _surfaces(structure.period[0], own.angles).items():
                    views = {f"{surface} {a}": View(smooth_mesh(body)["positions"], a) for a in angles}
                    with run.progress.work(f"{kind}, {surface}", len(views)):
                        own_rows, found = _measured(run, kind, views, subjects(body, structure, models))
                    rows += own_rows
                    sheet += _sheets(run, kind, views, found)
    charts.sheet(run.output / "images/votf.png", sheet, (2.2, 2.4), few_colors=True)
    return {"conditions": run.conditions(), "rows": rows}


def _surfaces(period: float, angles: tuple[int, ...]) -> dict[str, tuple[Surface, tuple[int, ...]]]:
    """Surfaces, and angles of views of them."""
    bodies = {"plane": Plane(6, period), "ball": Sphere(8, period), "cloth": Cloth(8, period)}
    return {name: (body, angles if name == "plane" else (_ANGLES[name],)) for name, body in bodies.items()}


def _brdf(folder: Path, rays: int) -> Model:
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
def _models(run: Run, structure: Structure, brdf: Model) -> Iterator[dict[str, Model]]:
    """The model of each of WAYS. The structure is made of the material of `brdf`."""
    info, texels, directions = structure._asdict(), run.settings.texels, run.settings.directions
    common = {"seed": run.seed, "threads": run.threads}
    path = run.work / f"{structure.kind}-{texels}-{directions}-{run.seed}.velour"
    with contextlib.ExitStack() as handles, Scene() as scene:
        structure.add_to(scene, brdf)
        with run.progress.work(f"BTF of {structure.kind}", texels**2):
            if not path.exists():
                options = {"texels": texels, "resume": 1, **common}
                fitted, _ = tiles.model_of_tile(scene, info, path.with_suffix(".btf"), directions, **options)
                with fitted:
                    fitted.save(path)
        btf = handles.enter_context(Model.load(path))
        shells = [tiles.with_shell(scene, info, model, **common)[0] for model in (btf, brdf)]
        for shell in shells:
            handles.enter_context(shell)
        yield dict(zip(WAYS, (brdf, btf, *shells), strict=True))


def _measured(
    run: Run, kind: str, views: dict[str, View], ways: dict[str, Subject]
) -> tuple[list[dict], dict[str, Pictures]]:
    """The rows of a structure on a surface, and the pictures by way."""
    own, rows, found = run.settings, [], {}
    for way, subject in ways.items():
        # Equal random numbers everywhere: noise cancels where pictures agree. Another seed shows it.
        seeds = (run.seed, run.seed + 1) if way == WAYS[0] else (run.seed,)
        sets, size = photographed(run, subject, views, seeds)
        found[way], truth = sets[-1], found.setdefault("reference", sets[0])
        for view, pixels in itertools.product(views, own.tile_pixels):
            row = {"structure": kind, "view": view, "tile_pixels": pixels, "way": way}
            row |= errors(found[way][view, pixels].pixels, truth[view, pixels].pixels)
            row["shadow"] = shadow_error(*(p["shadow", pixels].pixels for p in (found[way], truth)))
            rows.append(row | {"seconds": found[way][view, pixels].seconds, "bytes": size})
    return rows, found


def _sheets(run: Run, kind: str, views: dict[str, View], found: dict[str, Pictures]) -> list:
    """Saves the picture of a failure. Returns the row of the ball in the sheet of all structures."""
    row = []
    for view in views:
        pictures = {way: _displayed(found[way][view, run.settings.shown].pixels) for way in WAYS}
        if view.startswith("ball"):
            row.append([(f"{kind}: {way}", picture) for way, picture in pictures.items()])
        if FAILURES.get(kind) == view:
            path = run.output / f"images/votf_failure_{kind}.png"
            charts.sheet(path, [[*pictures.items()]], (4, 4.2), few_colors=True)
    return row


def _behind(picture: np.ndarray) -> np.ndarray:
    return picture[..., :3] + (1 - picture[..., 3:]) * _BEHIND


def _displayed(picture: np.ndarray) -> np.ndarray:
    return charts.display(_behind(picture))


def soft_iou(a: np.ndarray, b: np.ndarray) -> float:
    """sum min / sum max."""
    return float(np.minimum(a, b).sum() / np.maximum(a, b).sum())


def without_holes(alpha: np.ndarray) -> np.ndarray:
    """Makes holes solid: regions of alpha below 0.5 that are not connected to the border."""
    solid = ndimage.binary_fill_holes(alpha >= 0.5)
    inside = ndimage.binary_erosion(solid)
    return np.where(inside, 1.0, np.where(solid, np.maximum(alpha, 0.5), alpha))


def errors(picture: np.ndarray, truth: np.ndarray) -> dict[str, float]:
    """Soft intersection over union of alpha, with holes filled (outline) and with holes (alpha), and the mean
    FLIP of the pixels where either shows the object."""
    a, b = picture[..., 3].astype(float), truth[..., 3].astype(float)
    either = (a > 0.5) | (b > 0.5)
    flip, _percentile = flip_metric.of_object(_behind(truth), _behind(picture), either)
    return {"outline": soft_iou(without_holes(a), without_holes(b)), "alpha": soft_iou(a, b), "flip": flip}


def shadow_error(picture: np.ndarray, truth: np.ndarray) -> float:
    """RMS of the difference of the irradiance that shadows take from the floor, over that of the truth."""
    lit = truth[..., 1].max()
    found, expected = (lit - each[..., 1].astype(float) for each in (picture, truth))
    return float(np.sqrt(np.square(found - expected).sum() / np.square(expected).sum()))


def values(found: dict) -> dict:
    shown = int(found["conditions"]["shown"])
    cells = _cells(row for row in found["rows"] if row["tile_pixels"] == shown)
    ratios = [cell[SHELL]["seconds"] / cell["geometry"]["seconds"] for cell in cells.values()]
    return {
        "rows": [_table_row(*key, cell) for key, cell in cells.items()],
        "slower": sum(ratio > 1 for ratio in ratios),
        "count": len(ratios),
        "least": min(ratios),
        "most": max(ratios),
    }


def _cells(rows: Iterable[dict]) -> dict[tuple[str, str], dict[str, dict]]:
    """Rows by structure and view, then by way."""
    cells: dict[tuple[str, str], dict[str, dict]] = {}
    for row in rows:
        cells.setdefault((row["structure"], row["view"]), {})[row["way"]] = row
    return cells


def _table_row(structure: str, view: str, cell: dict[str, dict]) -> dict:
    def shown(name: str, spec: str, ways: Iterable[str] = WAYS, scale: float = 1.0) -> str:
        return " / ".join(format(scale * cell[way][name], spec) for way in ways)

    shells = ("BTF", SHELL)  # the shell has the same outline with a BRDF
    numbers = {name: shown(name, ".3f", shells) for name in ("outline", "alpha", "shadow")}
    numbers |= {"flip": shown("flip", ".3f"), "seconds": shown("seconds", ".2f")}
    return {"structure": structure, "view": view, **numbers, "bytes": shown("bytes", ".1f", WAYS, 1e-6)}


def draw(output: Path, found: dict) -> None:
    rows, shown = found["rows"], int(found["conditions"]["shown"])
    _chart(output / "images/votf_pixels.png", rows, "tile_pixels", "pixels a tile")
    plane = [
        row | {"angle": int(row["view"].removeprefix("plane "))}
        for row in rows
        if row["tile_pixels"] == shown and row["view"].startswith("plane")
    ]
    _chart(
        output / "images/votf_angles.png", plane, "angle", "degrees between the view and the plane's normal"
    )


def _chart(path: Path, rows: list[dict], x: str, label: str) -> None:
    """Errors and seconds of WAYS against x, a column for each structure: means over the other rows."""
    structures = list(dict.fromkeys(row["structure"] for row in rows))
    panels = []
    measures = {name: text for name, text in _ROWS.items() if (name, x) != ("shadow", "angle")}
    for measure in measures:
        for structure in structures:
            own = [row for row in rows if row["structure"] == structure]
            ways = WAYS if measure in ("flip", "seconds") else WAYS[1:]
            panels.append((structure, {way: _curve(own, way, x, measure) for way in ways}))
    log = "y" if x == "angle" else "xy"
    charts.curves(path, panels, label, [*measures.values()], columns=len(structures), log=log, shared=False)


def _curve(rows: list[dict], way: str, x: str, name: str) -> list[tuple[float, float]]:
    points: dict[float, list[float]] = {}
    for row in rows:
        if row["way"] == way:
            points.setdefault(row[x], []).append(1 - row[name] if name in ("outline", "alpha") else row[name])
    return [(at, float(np.mean(own))) for at, own in sorted(points.items())]
