"""All methods of BTF compression at equal bytes, on captured tiles and on measured sets.

--btf-set adds measured sets, --methods and --tiles choose.
"""

from __future__ import annotations

import json
import statistics
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np
from velour.native.table import COMPRESS_METHODS

from .. import charts
from ..flip_metric import exposure, flip_map
from ..page import judged, missed
from ..project import MissingError, flags, velour
from ..reference import Curve
from ..run import Picture, Run
from ..scenes import SHEET_CAMERA, SHEET_TILES, Scene, write_sheet

CSV = "chart_btf.csv"
PAGES = {"chart_btf.md": "btf_chart"}
SETTINGS = {
    "texels": (64, 12),
    "ratios": ((50, 100, 200, 500, 1000, 2000), (10, 20)),
    "tiles": (("weave", "gravel", "net"), ("weave",)),
    "directions": (81, 37),
    "held_out": (64, 8),
    "size": ((200, 150), (48, 36)),
    "spp": (64, 16),
    "speed_ratio": (500, 20),  # at which render times are measured
    "speed_size": ((64, 48), (24, 18)),
    "speed_spp": ((16, 64), (8, 16)),
    "speed_reference": (1024, 64),
    "level": (0.02, 0.02),  # relmse to which render times are measured
    "methods": ((), ()),
    "btf_set": ((), ()),
}
WORLD = "potsdamer_platz"
MEMBERS = (None, 2, 3, 4)  # K of K-CTA; None: searched for
_ORDER = ("svd", "svd-view", "srbf", "tucker", "cta", "kcta")
HEADERS = 2300  # approximate bytes of a model's file besides the fitted parameters
_CLOSE = 0.08  # share of the bytes that may stay unused before another fit is tried
_SLACK = 1.01  # excess of bytes that does not change errors and often saves a fit
_TRIES = 4
_MARGIN = 0.99  # share of the target that is tried first
# Approximate packing() of the files, by method.
_PACKED, _PACKED_ELSE = {"svd": 0.85, "svd-view": 0.66}, 0.9
_CAPTURE_COST, _FIT_COST = 4e7, 6e7  # in samples, for the progress
_COLUMNS = 5  # pictures in a row of a sheet


class Method(NamedTuple):
    """A method of compression: its name, and its command line options."""

    name: str
    options: dict


class Tile(NamedTuple):
    name: str
    btf: Path  # its btf.json, or another file that Velour reads
    held_out: Path | None

    @property
    def raw_bytes(self) -> int:
        return velour("info", self.btf, "--quiet")["raw_bytes"]


def methods(known: Iterable[str], wanted: Iterable[str] = ()) -> list[Method]:
    """The library's methods, in the chart's order; K-CTA once for each K."""
    found = []
    for name in sorted(known, key=lambda n: _ORDER.index(n) if n in _ORDER else len(_ORDER)):
        for k in MEMBERS if name == "kcta" else (None,):
            label, members = (name, {}) if k is None else (f"{name} {k}", {"members": k})
            if not wanted or label in wanted:
                found.append(Method(label, {"method": name, **members}))
    return found


def measure(run: Run) -> dict:
    own, contenders = run.settings, methods(COMPRESS_METHODS, run.settings.methods)
    if own.speed_ratio not in own.ratios:
        own.speed_ratio = sorted(own.ratios)[len(own.ratios) // 2]
    study, count = Study(run), len(own.tiles) + len(own.btf_set)
    fits = count * len(contenders) * len(own.ratios)
    run.progress.expect(_CAPTURE_COST, 2 * count)
    run.progress.expect(_FIT_COST, fits)
    run.expect(own.spp, count=fits)
    tiles = [study.captured(kind) for kind in own.tiles]
    tiles += [Tile(Path(path).name, Path(path), None) for path in own.btf_set]
    # Starts with the most informative ratio, so that an interrupted run has it for all tiles.
    ratios = sorted(own.ratios, key=lambda r: r != own.speed_ratio)
    entries = [
        study.entry(tile, method, ratio) for ratio in ratios for tile in tiles for method in contenders
    ]
    rows = [row for row in entries if row]
    for tile in tiles:
        _sheet(run, study, tile, contenders, rows)
    captured = [tile for tile in tiles if tile.held_out]
    interpolated = {tile.name: study.compare(tile.held_out, tile.btf)["psnr"] for tile in captured}
    return {"conditions": run.conditions(), "rows": rows, "interpolated": interpolated}


class Study:
    """Captures, fits and renders, each kept under a hash of everything it depends on."""

    def __init__(self, run: Run):
        self._run, self._world = run, run.world(WORLD)
        self._packed: dict[str, float] = {}
        self.models: dict[tuple[str, str, int], Path] = {}  # of entries, by tile, method and ratio
        self._mesh = run.made("sheet.obj", write_sheet)

    def captured(self, kind: str) -> Tile:
        own = self._run.settings
        btf = self._capture(kind, {"views": own.directions, "lights": own.directions})
        return Tile(kind, btf, self._capture(kind, {"held-out": own.held_out}))

    def _capture(self, kind: str, options: dict) -> Path:
        """Captures are kept across builds of the library: those of one seed are meant to stay the same."""
        run = self._run
        options = {"texels": run.settings.texels, "sides": "one", "seed": run.seed, **options}
        name = "-".join([kind, *map(str, options.values()), *(k for k in options if k == "held-out")])
        folder = run.kept / "tiles" / name
        index, label = folder / "btf.json", f"capture of {name}"
        if index.is_file() and json.loads(index.read_text(encoding="utf-8"))["content"]:
            run.progress.skip(label, _CAPTURE_COST)
            return index
        folder.mkdir(parents=True, exist_ok=True)
        resume = ["--resume"] if index.is_file() else []
        with run.progress.work(label, _CAPTURE_COST):
            words = flags(options | {"threads": run.threads})
            velour("capture", kind, *words, *resume, "-o", folder, "--quiet")
        return index

    def entry(self, tile: Tile, method: Method, ratio: int) -> dict | None:
        """The row of a method at one size; None if it has no model that small."""
        expected = self._packed.get(method.name, _PACKED.get(method.name, _PACKED_ELSE))
        report = within(tile.raw_bytes // ratio, lambda size: self._fit(tile, method, size), expected)
        if report is None:
            return None
        self._packed[method.name] = packing(report)
        model = self.models[tile.name, method.name, ratio] = Path(report["file"])
        row = {"tile": tile.name, "method": method.name, "ratio": ratio}
        # The size of the model's file, the seconds of the fit, and the processor seconds of the whole call.
        row |= {name: report[name] for name in ("bytes", "seconds", "processor_seconds", "psnr", "ser")}
        row["evaluations"] = report["evaluations_per_second"]  # and thread
        unseen = self.compare(tile.held_out, model) if tile.held_out else {}
        row |= {f"{name}_unseen": unseen.get(name) for name in ("psnr", "ser")}
        picture, reference = (self.picture(tile, of).pixels for of in (model, tile.btf))
        row |= {"picture": relative_error(picture, reference), "flip": _flip(picture, reference)}
        if ratio == self._run.settings.speed_ratio:
            row["render_seconds"] = self._seconds_to_level(tile, model)
            row["brightness"] = self.compare(tile.btf, model)["brightness"]  # over that of the BTF
        return row

    def _fit(self, tile: Tile, method: Method, size: int) -> dict | None:
        """The report of a fit, with its file; None if it was refused."""
        options, label = (
            {**method.options, "seed": self._run.seed},
            f"{method.name} of {tile.name}, {size} bytes",
        )
        options |= {"bytes": size, "threads": self._run.threads}
        how = {"cost": _FIT_COST, "refusable": True}
        file, found = self._run.model(label, "compress", tile.btf, options, **how)
        return None if "refused" in found else {**found, "file": str(file)}

    def compare(self, btf: Path, other: Path) -> dict:
        parameters = {"btf": btf, "other": other}
        return self._run.velour(f"errors of {other.name}", "compare", parameters, "compare", btf, other)

    def picture(self, tile: Tile, material: Path) -> Picture:
        """Samples only the light: the directions, and nearly the noise, are the same for every material."""
        own = self._run.settings
        return self._render(tile, material, own.spp, own.size, "light")

    def _render(self, tile: Tile, material: Path, spp: int, size: tuple[int, int], strategy: str) -> Picture:
        scene = Scene(tile.name, self._mesh, "z", self._world, material, camera=SHEET_CAMERA)
        options = {"strategy": strategy, "texture-scale": f"{SHEET_TILES:g}"}
        return self._run.render(scene, spp, size=size, **options)

    def _seconds_to_level(self, tile: Tile, model: Path) -> float | None:
        """Processor seconds of the better strategy to the level of relmse against the model's own picture."""
        own, found = self._run.settings, []
        reference = self._render(tile, model, own.speed_reference, own.speed_size, "mis").pixels
        for strategy in ("mis", "product"):
            pictures = [self._render(tile, model, spp, own.speed_size, strategy) for spp in own.speed_spp]
            points = [(self._run.threads * p.seconds, p.errors(reference)[1]) for p in pictures]
            found.append(Curve(points).seconds_at(own.level))
        return min((reading.value for reading in found if reading), default=None)


def packing(report: Mapping) -> float:
    """Bytes of the file per fitted byte."""
    return max(report["bytes"] - HEADERS, 1) / report["parameter_bytes"]


def within(target: int, fit: Callable[[int], dict | None], packed: float = 1.0) -> dict | None:
    """The report of the largest file within `target` bytes. `fit` takes the bytes of the fitted parameters
    and returns a report, or None if it refuses; files are larger by their headers and smaller by compression.
    `packed`: the expected packing()."""
    best, tried, size = None, [], max(int(_MARGIN * (target - HEADERS) / packed), 1)
    for _ in range(_TRIES):
        report = fit(size)
        if report is None:
            break
        if report["bytes"] <= _SLACK * target and (best is None or report["bytes"] > best["bytes"]):
            best = report
        tried.append((report["parameter_bytes"], report["bytes"]))
        following = _next(target, tried)
        if best is report and following < (1 + _CLOSE) * size:
            break
        size = following
    return best


def _next(target: int, tried: list[tuple[int, int]]) -> int:
    """Fitted bytes that would fill the file, by a line through the last two of (fitted bytes, file size)."""
    fitted, size = tried[-1]
    slope = 1.0
    if len(tried) > 1 and tried[-2][0] != fitted:
        slope = min(max((size - tried[-2][1]) / (fitted - tried[-2][0]), 0.5), 2.0)
    return max(int(fitted + (target - size) / slope), fitted // 3, 1)


def relative_error(picture: np.ndarray, reference: np.ndarray) -> float:
    """Root mean square of the difference, relative to that of the reference."""
    return float(np.sqrt(((picture - reference) ** 2).mean() / (reference**2).mean()))


def _flip(picture: np.ndarray, reference: np.ndarray) -> float | None:
    """Mean FLIP at one exposure; None if its package is not installed."""
    scale = _exposure(reference)
    try:
        return float(flip_map(charts.display(scale * reference), charts.display(scale * picture)).mean())
    except MissingError:
        return None


def _exposure(reference: np.ndarray) -> float:
    return exposure(reference, np.ones(reference.shape[:2], bool))


def _sheet(run: Run, study: Study, tile: Tile, contenders: list[Method], rows: list[dict]) -> None:
    """A tile's pictures at equal bytes beside the BTF itself."""
    ratio, reference = run.settings.speed_ratio, study.picture(tile, tile.btf).pixels
    results, scale = Results(rows), _exposure(reference)
    cells = [("the BTF", charts.display(scale * reference))]
    for method in contenders:
        if row := results.get(tile.name, method.name, ratio):
            pixels = study.picture(tile, study.models[tile.name, method.name, ratio]).pixels
            title = f"{method.name}, {row['bytes'] / 1000:.0f} KB, {row['picture']:.3f}"
            cells.append((title, charts.display(scale * pixels)))
    path = run.output / f"images/chart_btf_{tile.name}.png"
    charts.sheet(path, charts.wrapped(cells, _COLUMNS), (2.0, 1.95))


class Results:
    """All rows, found by tile, method and ratio."""

    def __init__(self, rows: list[dict]):
        self._rows, self.all = {(row["tile"], row["method"], row["ratio"]): row for row in rows}, rows
        self.tiles, self.methods = (
            list(dict.fromkeys(row[name] for row in rows)) for name in ("tile", "method")
        )
        self.ratios = sorted({row["ratio"] for row in rows})

    def get(self, tile: str, method: str, ratio: int) -> dict | None:
        return self._rows.get((tile, method, ratio))

    def best(self, tile: str, ratio: int, methods: list[str]) -> str | None:
        """The one of the methods with the largest PSNR of fitted pairs."""
        rows = {method: row for method in methods if (row := self.get(tile, method, ratio))}
        return max(rows, key=lambda method: rows[method]["psnr"], default=None)

    def gain(self, tile: str, ratio: int, names: list[str], other: str, value: str = "psnr") -> float | None:
        """`value` of the best of the methods `names` minus that of `other`, at equal bytes."""
        best, own = (
            ((self.get(tile, name, ratio) or {}).get(value) for name in names),
            self.get(tile, other, ratio),
        )
        known = [found for found in best if found is not None]
        return max(known) - own[value] if known and own and own.get(value) is not None else None


def verdicts(results: Results) -> Iterator[dict]:
    kcta = [name for name in results.methods if name.startswith("kcta")]
    for target, names, other in (
        ("CTA at least as good as Tucker (fitted)", ["cta"], "tucker"),
        ("K-CTA at least as good as CTA (fitted)", kcta, "cta"),
    ):
        # For each tile at the ratio where the best of the methods gains least.
        for tile in results.tiles:
            gains = {ratio: results.gain(tile, ratio, names, other) for ratio in results.ratios}
            known = {ratio: gain for ratio, gain in gains.items() if gain is not None}
            worst = min(known, key=known.get, default=None)
            if worst is None:
                yield judged(target, tile, "-", None)
            else:
                measured = f"{_decibels(known[worst])} at 1:{worst}, {_decibels(max(known.values()))} at best"
                yield judged(target, tile, measured, known[worst] >= 0)
    for value, least, words in (
        ("psnr", 1.5, "1.5 dB better, fitted"),
        ("psnr_unseen", 0.0, "no worse, unseen"),
    ):
        target = f"K-CTA against singular values at 1:500, weave: {words}"
        gain = results.gain("weave", 500, kcta, "svd", value)
        yield judged(target, "weave", _decibels(gain), None if gain is None else gain >= least)
    for name in ("cta", *kcta):
        slowest = min((row["evaluations"] for row in results.all if row["method"] == name), default=None)
        measured = "-" if slowest is None else f"{slowest / 1e6:.1f} million"
        met = None if slowest is None else slowest >= 1e6
        yield judged("a million evaluations a second and core", name, measured, met)


def _decibels(gain: float | None) -> str:
    return "-" if gain is None else f"{gain:+.2f} dB"


def values(found: dict) -> dict:
    results, ratio = Results(found["rows"]), int(found["conditions"]["speed_ratio"])
    targets = list(verdicts(results))
    interpolated = found["interpolated"]
    names = [name for name in results.methods if " " not in name] or results.methods  # without fixed K
    known = {tile: [{"psnr": interpolated[tile]}] if tile in interpolated else [] for tile in results.tiles}
    return {
        "sheet_tiles": SHEET_TILES,
        "world": WORLD,
        "speed_spp_named": found["conditions"]["speed_spp"].replace(", ", " and "),
        "missed": missed(targets),
        "met": sum(target["met"] is True for target in targets),
        "judged": len(targets),
        "tiles_named": " | ".join(results.tiles),
        "psnr": [{"m": name, "cells": _errors(results, name, names, ratio)} for name in names],
        "costs": [row for name in names if (row := _costs(results, name, ratio))],
        "sections": [{"tile": tile, "known": known[tile]} for tile in results.tiles],
    }


def _costs(results: Results, method: str, ratio: int) -> dict | None:
    """Medians over the tiles; None if the method has no model of this size for any."""
    rows = [row for tile in results.tiles if (row := results.get(tile, method, ratio))]
    found = {"method": method}
    for name in ("bytes", "seconds", "processor_seconds", "evaluations", "render_seconds", "brightness"):
        known = [row[name] for row in rows if row.get(name) is not None]
        found[name] = statistics.median(known) if known else None
    return found if rows else None


def draw(output: Path, found: dict) -> None:
    results, panels = Results(found["rows"]), []
    titles = {"psnr": "PSNR of fitted pairs, dB", "psnr_unseen": "PSNR of unseen pairs, dB"}
    titles["picture"] = "picture error"
    for value in titles:
        for tile in results.tiles:
            curves = {method: [] for method in results.methods}
            for row in sorted(results.all, key=lambda row: row["ratio"]):
                if row["tile"] == tile and row.get(value) is not None:
                    curves[row["method"]].append((row["ratio"], row[value]))
            panels.append((tile, curves))
    chart, axes = output / "images/chart_btf.png", ("raw bytes / bytes of the file", [*titles.values()])
    charts.curves(chart, panels, *axes, columns=len(results.tiles), log="x", shared=False)


def _errors(results: Results, method: str, methods: list[str], ratio: int) -> str:
    """A cell per tile: PSNR of fitted pairs and, if it is known, of unseen ones; bold for the best method."""

    def cell(tile: str) -> str:
        row = results.get(tile, method, ratio)
        if row is None:
            return "-"
        text = " / ".join(f"{row[n]:.2f}" for n in ("psnr", "psnr_unseen") if row.get(n) is not None)
        return f"**{text}**" if results.best(tile, ratio, methods) == method else text

    return " | ".join(map(cell, results.tiles))
