"""Shells (VOTFs) beside real geometry: silhouette, alpha, light, seconds, megabytes."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy import ndimage
from velour.native import Measurement, Model, Scene, Tile, fit_job, microsurface_job, render_job

from .. import charts, tiles
from ..run import Run
from ..tiles import Cloth, Cylinder, Sphere, Surface, smooth_mesh, structured_mesh

SETTINGS = {
    "tiles": (("net", "chainmail", "weave", "gravel"), ("net",)),
    "tile_pixels": ((64, 16, 4), (16,)),
    "side": (512, 128),
    "samples": (16, 4),
    "rays": (40_000_000, 4_000_000),  # of the goniometer
    "texels": (64, 16),  # per side of the BTFs
}
CSV = "votf_numbers.csv"
PAGES = {"votf_numbers.md": "votf"}
_HEIGHT = 0.06  # height of the shell over the sphere's radius
_MOST_SIDE = 2048  # maximum side of a picture, in pixels
_DIRECTIONS = 81  # views and lights each, the directions of the Bonn BTFs
_FIELD = np.radians(20)
_BEHIND = 0.25  # background radiance of the sheets
_WAYS = ("geometry", "smooth", "shell")


class Look(NamedTuple):
    name: str
    smooth: Model
    shell: Model
    of_geometry: Model | None  # None: the tile's own materials


class Picture(NamedTuple):
    pixels: np.ndarray  # RGBA, premultiplied
    seconds: float
    bytes: int  # memory of the scene


class Shot(NamedTuple):
    """A surface in a square picture of `side` pixels in which a tile is `tile_pixels` wide."""

    surface: Surface
    tile_pixels: float
    side: int
    samples: int

    def picture(self, scene: Scene) -> Picture:
        scene.add_light("sun", (3, 3, 3), tiles.sun((0.396, -0.724, 0.565)), angle=0.02)
        scene.set_world_color((0.5, 0.5, 0.5))
        # A tile spans `tile_pixels` at the distance of the surface's center.
        distance = self.side * self.surface.period / self.tile_pixels / (2 * np.tan(_FIELD / 2))
        is_cloth = isinstance(self.surface, Cloth)
        up, middle = (0.75, (0, 0, -0.2 * self.surface.radius)) if is_cloth else (0.15, (0, 0, 0))
        eye = distance * np.array([0, -np.cos(up), np.sin(up)]) + np.array(middle)
        scene.look_at(tuple(eye), middle, _FIELD, 1.0)
        scene.commit()
        options = {"width": self.side, "height": self.side, "spp": self.samples, "split": 1}
        with render_job(scene, strategy="mis", transparent=1, **options) as job:
            seconds = job.run()["seconds"]
            return Picture(job.read_pass("Combined"), seconds, scene.info()["bytes"])

    def of_geometry(self, tile: Tile, material: Model | None) -> Picture:
        mesh, info = tile.mesh()._asdict(), tile.info()
        with Scene() as scene:
            number, _ = scene.add_mesh(**structured_mesh(self.surface, mesh, info["period"][0]))
            if material:
                slots = [scene.add_model_material(material)]
            else:
                own = ({name: m[name] for name in m if name != "name"} for m in info["materials"])
                slots = [scene.add_principled_material(**values) for values in own]
            scene.add_instance(number, tiles.UNMOVED, slots)
            return self.picture(scene)

    def of_model(self, model: Model) -> Picture:
        """A picture of the smooth surface with `model`."""
        with Scene() as scene:
            number, _ = scene.add_mesh(**smooth_mesh(self.surface))
            material = scene.add_model_material(model)
            scene.add_instance(number, tiles.UNMOVED, [material])
            if "shell" in model.info():
                scene.set_shell_tile(material, self.surface.period)
            return self.picture(scene)


def measure(run: Run) -> dict:
    rows, own = [], run.settings
    with _brdf(run.work, own.rays) as plain:
        for name in own.tiles:
            with Tile.create(name) as tile, _looks(run, tile, plain) as both:
                for look in both:
                    rows += _rows(run, name, tile, look)
    return {"conditions": run.conditions(seed=0), "rows": rows}


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
def _looks(run: Run, tile: Tile, plain: Model) -> Iterator[tuple[Look, Look]]:
    """The look of the BRDF, then that of the BTF."""
    info, texels = tile.info(), run.settings.texels
    path = run.work / f"{info['kind']}-{texels}.velour"
    with contextlib.ExitStack() as handles, Scene() as scene:
        tiles.add(tile, scene)
        with run.progress.work(f"BTF of {info['kind']}", texels**2):
            if not path.exists():
                options = {"texels": texels, "resume": 1}
                fitted, _ = tiles.model_of_tile(scene, info, path.with_suffix(".btf"), _DIRECTIONS, **options)
                with fitted:
                    fitted.save(path)
            own = handles.enter_context(Model.load(path))
        shells = [handles.enter_context(tiles.with_shell(scene, info, model)[0]) for model in (plain, own)]
        yield Look("BRDF", plain, shells[0], plain), Look("BTF", own, shells[1], None)


def _rows(run: Run, name: str, tile: Tile, look: Look) -> list[dict]:
    own, rows, sheet = run.settings, [], []
    for surface_name, surface in _surfaces(tile).items():
        for pixels in own.tile_pixels:
            # Large enough for the whole surface.
            side = math.ceil(2.6 * surface.radius / surface.period * pixels)
            shot = Shot(surface, pixels, min(_MOST_SIDE, max(own.side, side)), own.samples)
            with run.progress.work(f"{name}, {look.name}, {surface_name}, {pixels} pixels a tile", pixels**2):
                truth = shot.of_geometry(tile, look.of_geometry)
                pictures = [truth, shot.of_model(look.smooth), shot.of_model(look.shell)]
            row = {"tile": name, "look": look.name, "surface": surface_name, "tile_pixels": pixels}
            for way, picture in zip(_WAYS, pictures, strict=True):
                found = {"seconds": picture.seconds, "bytes": picture.bytes}
                if picture is not truth:
                    found |= shell_errors(picture.pixels, truth.pixels)._asdict()
                row |= {f"{way}_{name}": number for name, number in found.items()}
            rows.append(row)
            if pixels == max(own.tile_pixels):
                sheet += _pictures(surface_name, [picture.pixels for picture in pictures])
    path = run.output / "images" / f"{_stem(name, look.name)}.png"
    charts.sheet(path, sheet, (3.0, 3.25), few_colors=True)
    return rows


def _surfaces(tile: Tile) -> dict[str, Surface]:
    info = tile.info()
    period, (low, high) = info["period"][0], info["heights"]
    radius = (high - low) / _HEIGHT
    rows, across = (max(2, round(length / period)) for length in (math.pi * radius, 2 * radius))
    tube = Cylinder(2 * rows, across, period)
    return {"sphere": Sphere(rows, period), "cylinder": tube, "cloth": Cloth(across, period)}


def _pictures(surface: str, pictures: list[np.ndarray]) -> list:
    """Two rows of a sheet: the three pictures of a surface, and a magnified part of each."""
    seen = [pixels[..., :3] + (1 - pixels[..., 3:]) * _BEHIND for pixels in pictures]
    whole = [(f"{way}, {surface}", charts.display(p)) for way, p in zip(_WAYS, seen, strict=True)]
    edges = [charts.display(_edge(picture, pictures[0][..., 3])) for picture in seen]
    return [whole, [("the same, magnified", edge) for edge in edges]]


def _edge(picture: np.ndarray, alpha: np.ndarray) -> np.ndarray:
    """Crops a picture around the rightmost point of the object."""
    side = picture.shape[0] // 5
    column = int(np.flatnonzero(alpha.max(axis=0) > 0.5)[-1])
    row = int(np.median(np.flatnonzero(alpha[:, column] > 0.5)))
    left = np.clip(column - 3 * side // 4, 0, picture.shape[1] - side)
    low = np.clip(row - side // 2, 0, picture.shape[0] - side)
    return picture[low : low + side, left : left + side]


class ShellErrors(NamedTuple):
    outline: float  # soft intersection over union of alpha, with holes filled
    alpha: float  # likewise, with holes
    light: float | None  # RMS of the difference over that of the truth, where both show the object


def soft_iou(a: np.ndarray, b: np.ndarray) -> float:
    """sum min / sum max."""
    return float(np.minimum(a, b).sum() / np.maximum(a, b).sum())


def without_holes(alpha: np.ndarray) -> np.ndarray:
    """Makes holes solid: regions of alpha below 0.5 that are not connected to the border."""
    solid = ndimage.binary_fill_holes(alpha >= 0.5)
    inside = ndimage.binary_erosion(solid)
    return np.where(inside, 1.0, np.where(solid, np.maximum(alpha, 0.5), alpha))


def shell_errors(picture: np.ndarray, truth: np.ndarray) -> ShellErrors:
    a, b = picture[..., 3].astype(float), truth[..., 3].astype(float)
    both = (a > 0.5) & (b > 0.5)
    found, expected = picture[both][:, :3].astype(float), truth[both][:, :3].astype(float)
    light = np.sqrt(np.square(found - expected).sum() / np.square(expected).sum()) if both.any() else None
    outline = soft_iou(without_holes(a), without_holes(b))
    return ShellErrors(outline, soft_iou(a, b), light and float(light))


def values(found: dict) -> dict:
    looks = {look: [row for row in found["rows"] if row["look"] == look] for look in ("BTF", "BRDF")}
    largest = max(row["tile_pixels"] for row in looks["BTF"])
    names = dict.fromkeys(row["tile"] for row in looks["BTF"])
    brdf = ({f"{way}_brdf": row[f"{way}_light"] for way in _WAYS[1:]} for row in looks["BRDF"])
    both = [own | other for own, other in zip(looks["BTF"], brdf, strict=True)]
    shown = [row for row in both if row["tile_pixels"] == largest]
    sheets = [{"tile": n, "look": look, "stem": _stem(n, look)} for look in looks for n in names]
    return {"largest": largest, "rows": shown, "sheets": sheets} | {
        f"{look}_ratios": _ratios(rows) for look, rows in looks.items()
    }


def _stem(tile: str, look: str) -> str:
    """File of a sheet, without its suffix."""
    return f"votf_{tile}" if look == "BRDF" else f"votf_{tile}_{look.lower()}"


def _ratios(rows: list[dict]) -> str:
    """Ratio of the render times of the shell and the smooth surface, for each size of tiles."""
    parts = []
    for pixels in dict.fromkeys(row["tile_pixels"] for row in rows):
        own = [row for row in rows if row["tile_pixels"] == pixels]
        ratios = [row["shell_seconds"] / row["smooth_seconds"] for row in own]
        parts.append(f"{min(ratios):.1f} to {max(ratios):.1f} with {pixels} pixels a tile")
    return ", ".join(parts)
