"""Compares shells with real geometry: silhouette, alpha, light, seconds, megabytes."""

from __future__ import annotations

import dataclasses
import json
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import provenance
import script
import votf_text
from progress import Progress
from velour.core.machine import threads
from velour.native import Tile
from velour_cli import ROOT
from votf_errors import ShellErrors, shell_errors
from votf_looks import Look, brdf, looks
from votf_pictures import Shot, of_geometry, of_model
from votf_shapes import Cloth, Cylinder, Sphere, Surface

_HEIGHT = 0.06  # height of the shell over the sphere's radius
_MOST_SIDE = 2048  # maximum side of a picture, in pixels


@dataclasses.dataclass(frozen=True)
class Extent:
    tiles: tuple[str, ...] = ("net", "chainmail", "weave", "gravel")
    tile_pixels: tuple[int, ...] = (64, 16, 4)
    side: int = 512
    samples: int = 16
    rays: int = 40_000_000  # rays of the goniometer
    texels: int = 64  # texels per side of the BTFs


QUICK = Extent(tiles=("net",), tile_pixels=(16,), side=128, samples=4, rays=4_000_000, texels=16)


@dataclasses.dataclass(frozen=True)
class Row:
    tile: str
    look: str
    surface: str
    tile_pixels: int
    errors: tuple[ShellErrors, ShellErrors]  # smooth, shell
    seconds: tuple[float, float, float]  # geometry, smooth, shell
    bytes: tuple[int, int, int]


def main() -> int:
    args = script.arguments("votf", ROOT / "docs/results")
    extent = QUICK if args.quick else Extent()
    args.work.mkdir(parents=True, exist_ok=True)
    (args.output / "images").mkdir(parents=True, exist_ok=True)
    rows, progress = [], Progress()
    with brdf(args.work, extent.rays) as plain:
        for name in extent.tiles:
            with (
                Tile.create(name) as tile,
                looks(tile, plain, args.work, extent.texels, progress) as both,
            ):
                for look in both:
                    rows += _rows(name, tile, look, extent, args.output / "images", progress)
    votf_text.write(args.output, rows, provenance.conditions(0, threads()), extent)
    (args.work / "rows.json").write_text(json.dumps([dataclasses.asdict(row) for row in rows], indent=1))
    print(args.output / "votf_numbers.md")
    return 0


def _rows(name: str, tile: Tile, look: Look, extent: Extent, images: Path, progress: Progress) -> list[Row]:
    rows, sheet = [], []
    for surface_name, surface in _surfaces(tile).items():
        for pixels in extent.tile_pixels:
            with progress.work(f"{name}, {look.name}, {surface_name}, {pixels} pixels a tile", pixels**2):
                row, pictures = _compared(tile, surface, pixels, look, extent)
            rows.append(Row(name, look.name, surface_name, pixels, *row))
            if pixels == max(extent.tile_pixels):
                sheet.append((surface_name, pictures))
    votf_text.draw(images / votf_text.sheet_name(name, look.name), sheet)
    return rows


def _surfaces(tile: Tile) -> dict[str, Surface]:
    info = tile.info()
    period, (low, high) = info["period"][0], info["heights"]
    radius = (high - low) / _HEIGHT
    rows = max(2, round(math.pi * radius / period))
    across = max(2, round(2 * radius / period))
    return {
        "sphere": Sphere(rows, period),
        "cylinder": Cylinder(2 * rows, across, period),
        "cloth": Cloth(across, period),
    }


def _compared(tile, surface: Surface, pixels: int, look: Look, extent: Extent) -> tuple:
    # Large enough for the whole surface.
    side = math.ceil(2.6 * surface.radius / surface.period * pixels)
    shot = Shot(surface, pixels, min(_MOST_SIDE, max(extent.side, side)), extent.samples)
    pictures = (
        of_geometry(shot, tile, look.of_geometry),
        of_model(shot, look.smooth),
        of_model(shot, look.shell),
    )
    truth = pictures[0].pixels
    errors = tuple(shell_errors(p.pixels, truth) for p in pictures[1:])
    row = errors, tuple(p.seconds for p in pictures), tuple(p.bytes for p in pictures)
    return row, [p.pixels for p in pictures]


if __name__ == "__main__":
    sys.exit(script.guarded("votf", main))
