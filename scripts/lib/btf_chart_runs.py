"""Captures, fits and renders of scripts/chart --btf, each kept under a hash of everything it depends on."""

from __future__ import annotations

import json
import resource
import subprocess
from dataclasses import dataclass, replace
from pathlib import Path

import btf_chart_scene
import data_files
import numpy as np
from btf_chart_numbers import Entry, Method, fills, largest_within, packing, relative_error, within
from curve import Curve
from flip_metric import NoFlipError, display, exposure, flip_map
from renders import Picture, Renders, flags, key
from scenes import Scene
from velour.core import files
from velour_cli import velour, velour_to_file

WORLD = "potsdamer_platz"
# Approximate packing() of the files, by method.
_PACKED, _PACKED_ELSE = {"svd": 0.85, "svd-view": 0.66}, 0.9
_HALF = 0.55  # share of the bytes: fits that fill less were made for a smaller target
_CAPTURE_COST, _FIT_COST = 4e7, 6e7  # in samples, for the progress


@dataclass(frozen=True)
class Extent:
    """How much is measured."""

    texels: int = 64
    ratios: tuple[int, ...] = (50, 100, 200, 500, 1000, 2000)
    tiles: tuple[str, ...] = ("weave", "gravel", "net")
    directions: int = 81
    held_out: int = 64
    size: tuple[int, int] = (200, 150)
    spp: int = 64
    speed_ratio: int = 500  # at which render times are measured
    speed_size: tuple[int, int] = (64, 48)
    speed_spp: tuple[int, ...] = (16, 64)
    speed_reference: int = 1024
    level: float = 0.02  # relmse to which render times are measured


QUICK = Extent(
    texels=12, ratios=(10, 20), tiles=("weave",), directions=37, held_out=8, size=(48, 36), spp=16,
    speed_ratio=20, speed_size=(24, 18), speed_spp=(8, 16), speed_reference=64,
)  # fmt: skip


@dataclass(frozen=True)
class Tile:
    name: str
    btf: Path  # its btf.json, or another file that Velour reads
    held_out: Path | None
    raw_bytes: int


class Study:
    def __init__(self, renders: Renders, extent: Extent, data: Path, only_kept: bool = False):
        """`only_kept`: makes no new fits."""
        self._only_kept = only_kept
        self._renders, self._extent = renders, extent
        self._world = data_files.world(data, WORLD)
        self._packed: dict[str, float] = {}
        self._found: dict[tuple[str, str, int], dict | None] = {}
        self._sheet = renders.settings.folder / "sheet.obj"
        if not self._sheet.is_file():
            btf_chart_scene.write_sheet(self._sheet)

    def announce(self, tiles: int, methods: int) -> None:
        fits = tiles * methods * len(self._extent.ratios)
        self._renders.progress.expect(_CAPTURE_COST, 2 * tiles)
        self._renders.progress.expect(_FIT_COST, fits)
        self._renders.expect(self._extent.spp, count=fits)

    def captured(self, kind: str) -> Tile:
        e = self._extent
        btf = self._capture(kind, {"views": e.directions, "lights": e.directions})
        held_out = self._capture(kind, {"held-out": e.held_out})
        return Tile(kind, btf, held_out, velour("info", btf, "--quiet")["raw_bytes"])

    @staticmethod
    def measured(path: Path) -> Tile:
        return Tile(path.name, path, None, velour("info", path, "--quiet")["raw_bytes"])

    def _capture(self, kind: str, options: dict) -> Path:
        """Captures are kept across builds of the library: those of one seed are meant to stay the same."""
        seed, threads = self._renders.settings.seed, self._renders.settings.threads
        options = {"texels": self._extent.texels, "sides": "one", "seed": seed, **options}
        name = "-".join([kind, *map(str, options.values()), *(k for k in options if k == "held-out")])
        folder = self._renders.settings.folder / "tiles" / name
        index, label = folder / "btf.json", f"capture of {name}"
        if index.is_file() and json.loads(index.read_text(encoding="utf-8"))["content"]:
            self._renders.progress.skip(label, _CAPTURE_COST)
            return index
        folder.mkdir(parents=True, exist_ok=True)
        resume = ["--resume"] if index.is_file() else []
        with self._renders.progress.work(label, _CAPTURE_COST):
            velour("capture", kind, *flags(options | {"threads": threads}), *resume, "-o", folder, "--quiet")
        return index

    def interpolated(self, tile: Tile) -> dict | None:
        """Errors of the interpolated BTF itself at held-out pairs; None if the tile has none."""
        if tile.held_out is None:
            return None
        return self._compare(tile.held_out, tile.btf)

    def entry(self, tile: Tile, method: Method, ratio: int) -> Entry | None:
        """None if the method has no model that small."""
        report = self._sized(tile, method, ratio)
        if report is None:
            return None
        model = Path(report["file"])
        entry = Entry(
            tile.name, method.name, ratio, report["bytes"], report["seconds"], report["processor_seconds"],
            report["psnr"], report["ser"],
            report["evaluations_per_second"],
        )  # fmt: skip
        if tile.held_out:
            unseen = self._compare(tile.held_out, model)
            entry = replace(entry, psnr_unseen=unseen["psnr"], ser_unseen=unseen["ser"])
        picture, reference = (self.picture(tile, of).pixels for of in (model, tile.btf))
        entry = replace(entry, picture=relative_error(picture, reference), flip=flip(picture, reference))
        if ratio != self._extent.speed_ratio:
            return entry
        brightness = self._compare(tile.btf, model)["brightness"]
        return replace(entry, render_seconds=self._seconds_to_level(tile, model), brightness=brightness)

    def model(self, tile: Tile, method: Method, ratio: int) -> Path | None:
        """Model file of an entry; entry() must have been called for it."""
        report = self._found[tile.name, method.name, ratio]
        return Path(report["file"]) if report else None

    def _sized(self, tile: Tile, method: Method, ratio: int) -> dict | None:
        """Prefers kept fits. New fits expect the packing of the method's previous fit."""
        target = tile.raw_bytes // ratio
        report = largest_within(target, self._kept_fits(tile, method))
        if self._only_kept:
            report = report if fills(target, report, _HALF) else None
        elif not fills(target, report):
            usual = _PACKED.get(method.name, _PACKED_ELSE)
            expected = self._packed.get(method.name, usual)
            report = within(target, lambda size: self._fit(tile, method, size), expected)
        if report:
            self._packed[method.name] = packing(report)
        self._found[tile.name, method.name, ratio] = report
        return report

    def _series(self, tile: Tile, method: Method) -> dict:
        """Everything that a fit depends on, except its size."""
        return {"btf": tile.btf, **dict(method.options), "seed": self._renders.settings.seed}

    def _kept_fits(self, tile: Tile, method: Method) -> list[dict]:
        wanted, found = key(self._series(tile, method)), []
        for path in sorted(self._renders.settings.folder.glob("compress-*.json")):
            report = json.loads(path.read_text(encoding="utf-8"))
            if report.get("series") == wanted and "refused" not in report:
                found.append({**report, "file": str(path.with_suffix(".velour"))})
        return found

    def _fit(self, tile: Tile, method: Method, size: int) -> dict | None:
        """The report of a fit, with its processor seconds and file; None if it was refused."""
        series = self._series(tile, method)
        parameters = {**series, "bytes": size}
        out = self._renders.stem("compress", parameters).with_suffix(".velour")
        options = {name: value for name, value in parameters.items() if name != "btf"} | self._threads()

        def run(report: Path) -> dict:
            return _reported(report, key(series), "compress", tile.btf, "-o", out, *flags(options))

        label = f"{method.name} of {tile.name}, {size} bytes"
        found = self._renders.keep(label, "compress", parameters, run, _FIT_COST)
        return None if "refused" in found else {**found, "file": str(out)}

    def _compare(self, btf: Path, other: Path) -> dict:
        def run(report: Path) -> dict:
            return velour_to_file(report, "compare", btf, other)

        return self._renders.keep(f"errors of {other.name}", "compare", {"btf": btf, "other": other}, run)

    def picture(self, tile: Tile, material: Path) -> Picture:
        """Samples only the light: the directions, and nearly the noise, are the same for every material."""
        return self._render(tile, material, self._extent.spp, self._extent.size, "light")

    def _render(self, tile: Tile, material: Path, spp: int, size: tuple[int, int], strategy: str) -> Picture:
        scene = Scene(tile.name, self._sheet, "z", self._world, material, camera=btf_chart_scene.CAMERA)
        options = {"strategy": strategy, "texture-scale": f"{btf_chart_scene.TILES:g}"}
        return self._renders.render(scene, spp, size=size, **options)

    def _seconds_to_level(self, tile: Tile, model: Path) -> float | None:
        """Processor seconds of the better strategy to the level of relmse against the model's own picture."""
        e = self._extent
        reference = self._render(tile, model, e.speed_reference, e.speed_size, "mis").pixels
        found = []
        for strategy in ("mis", "product"):
            points = []
            for spp in e.speed_spp:
                picture = self._render(tile, model, spp, e.speed_size, strategy)
                seconds = self._renders.settings.threads * picture.report["seconds"]
                points.append((seconds, picture.errors(reference)[1]))
            found.append(Curve(points).seconds_at(e.level))
        return min((reading.value for reading in found if reading), default=None)

    def _threads(self) -> dict:
        return {"threads": self._renders.settings.threads}


def flip(picture: np.ndarray, reference: np.ndarray) -> float | None:
    """Mean FLIP at one exposure; None if its package is not installed."""
    scale = exposure(reference, np.ones(reference.shape[:2], bool))
    try:
        return float(flip_map(display(scale * reference), display(scale * picture)).mean())
    except NoFlipError:
        return None


def _reported(report: Path, series: str, *arguments) -> dict:
    """Report of a call that may be refused, with the series it belongs to and its processor seconds."""
    beside = report.with_suffix(".partial")
    before = _processor_seconds()
    try:
        found = velour_to_file(beside, *arguments)
    except subprocess.CalledProcessError as error:
        if error.returncode != 1:
            raise
        found = {"refused": True}
    found |= {"series": series, "processor_seconds": _processor_seconds() - before}
    beside.unlink(missing_ok=True)
    files.write_json(report, found)
    return found


def _processor_seconds() -> float:
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime
