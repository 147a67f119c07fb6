"""All methods of BTF compression at equal bytes, on captured tiles and on measured sets.

--btf-set adds measured sets, --methods and --tiles choose; --kept writes what is there already, without new
fits; --add keeps the rows of the page that this run does not measure.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from statistics import median

import numpy as np
from velour.native.table import COMPRESS_METHODS

from .. import charts, data_files, page, provenance
from ..curve import Curve
from ..flip_metric import NoFlipError, exposure, flip_map
from ..run import Picture, Run, flags, key
from ..scenes import SHEET_CAMERA, SHEET_TILES, Scene, made, write_sheet
from ..velour_cli import velour

CSV = "chart_btf.csv"
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
    "note": ("", ""),  # what the page's reader must know
    "kept": (False, False),
    "add": (False, False),
}
WORLD = "potsdamer_platz"
MEMBERS = (None, 2, 3, 4)  # K of K-CTA; None: searched for
_ORDER = ("svd", "svd-view", "srbf", "tucker", "cta", "kcta")
HEADERS = 2300  # approximate bytes of a model's file besides the fitted parameters
_CLOSE = 0.08  # share of the bytes that may stay unused before another fit is tried
_SLACK = 1.01
_TRIES = 4
_MARGIN = 0.99  # share of the target that is tried first
# Approximate packing() of the files, by method.
_PACKED, _PACKED_ELSE = {"svd": 0.85, "svd-view": 0.66}, 0.9
_HALF = 0.55  # share of the bytes: fits that fill less were made for a smaller target
_CAPTURE_COST, _FIT_COST = 4e7, 6e7  # in samples, for the progress
_FAR = 0.5  # pictures with a larger error differ everywhere and do not influence the choice of the crop
_CROP, _COLUMNS = 28, 5  # side of a crop in pixels; pictures in a row of a sheet


@dataclass(frozen=True)
class Method:
    """A method of compression: its name, and its command line options."""

    name: str
    options: tuple[tuple[str, object], ...]


@dataclass(frozen=True)
class Tile:
    name: str
    btf: Path  # its btf.json, or another file that Velour reads
    held_out: Path | None
    raw_bytes: int


def methods(known: Iterable[str], wanted: Iterable[str] = ()) -> list[Method]:
    """The library's methods, in the chart's order; K-CTA once for each K."""
    found = []
    for name in sorted(known, key=lambda n: _ORDER.index(n) if n in _ORDER else len(_ORDER)):
        for k in MEMBERS if name == "kcta" else (None,):
            extra = () if k is None else (("members", k),)
            label = name if k is None else f"{name} {k}"
            if not wanted or label in wanted:
                found.append(Method(label, (("method", name), *extra)))
    return found


def measure(run: Run) -> dict:
    own, contenders = run.settings, methods(COMPRESS_METHODS, run.settings.methods)
    if own.speed_ratio not in own.ratios and not own.add:
        own.speed_ratio = sorted(own.ratios)[len(own.ratios) // 2]
    study = Study(run)
    study.announce(len(contenders))
    tiles = [study.captured(kind) for kind in own.tiles] + [
        study.measured(Path(path)) for path in own.btf_set
    ]
    added, rows, interpolated = _before(run)
    # Starts with the most informative ratio, so that an interrupted run has it for all tiles.
    for ratio in sorted(own.ratios, key=lambda r: r != own.speed_ratio):
        rows += [study.entry(tile, method, ratio) for tile in tiles for method in contenders]
    rows = [row for row in rows if row]
    for tile in () if own.add else tiles:
        _sheet(run, study, tile, contenders, rows)
    interpolated |= {
        tile.name: study.compare(tile.held_out, tile.btf)["psnr"] for tile in tiles if tile.held_out
    }
    return {
        "conditions": run.conditions(added_to="; ".join(added)),
        "rows": rows,
        "interpolated": interpolated,
    }


def _before(run: Run) -> tuple[list[str], list[dict], dict]:
    """The dates and commits at which the kept rows were measured, the rows, and errors of the tiles."""
    if not run.settings.add:
        return [], [], {}
    conditions, rows = page.read_rows(run.output / CSV)
    rest = run.output / f"{run.name}.json"
    interpolated = json.loads(rest.read_text(encoding="utf-8"))["interpolated"] if rest.is_file() else {}
    earlier = filter(None, conditions.get("added_to", "").split("; "))
    before = f"{conditions['date']}, commit {conditions['commit']}"
    return list(dict.fromkeys([before, *earlier])), rows, interpolated


class Study:
    """Captures, fits and renders, each kept under a hash of everything it depends on."""

    def __init__(self, run: Run):
        self._run = run
        self._world = data_files.world(run.data, WORLD)
        self._packed: dict[str, float] = {}
        self._models: dict[tuple[str, str, int], Path] = {}
        self._mesh = made(run.kept / "sheet.obj", write_sheet)

    def announce(self, methods: int) -> None:
        own, progress = self._run.settings, self._run.progress
        tiles = len(own.tiles) + len(own.btf_set)
        fits = tiles * methods * len(own.ratios)
        progress.expect(_CAPTURE_COST, 2 * tiles)
        progress.expect(_FIT_COST, fits)
        self._run.expect(own.spp, count=fits)

    def captured(self, kind: str) -> Tile:
        own = self._run.settings
        btf = self._capture(kind, {"views": own.directions, "lights": own.directions})
        return Tile(kind, btf, self._capture(kind, {"held-out": own.held_out}), _raw_bytes(btf))

    @staticmethod
    def measured(path: Path) -> Tile:
        return Tile(path.name, path, None, _raw_bytes(path))

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
        report, own = self._sized(tile, method, ratio), self._run.settings
        if report is None:
            return None
        model = self._models[tile.name, method.name, ratio] = Path(report["file"])
        row = {"tile": tile.name, "method": method.name, "ratio": ratio}
        # The size of the model's file, the seconds of the fit, and the processor seconds of the whole call.
        row |= {name: report[name] for name in ("bytes", "seconds", "processor_seconds", "psnr", "ser")}
        row["evaluations"] = report["evaluations_per_second"]  # and thread
        unseen = self.compare(tile.held_out, model) if tile.held_out else {}
        row |= {f"{name}_unseen": unseen.get(name) for name in ("psnr", "ser")}
        picture, reference = (self.picture(tile, of).pixels for of in (model, tile.btf))
        row |= {"picture": relative_error(picture, reference), "flip": _flip(picture, reference)}
        if ratio == own.speed_ratio:
            row["render_seconds"] = self._seconds_to_level(tile, model)
            row["brightness"] = self.compare(tile.btf, model)["brightness"]  # over that of the BTF
        return row

    def model(self, tile: Tile, method: Method, ratio: int) -> Path | None:
        """Model file of an entry; entry() must have been called for it."""
        return self._models.get((tile.name, method.name, ratio))

    def _sized(self, tile: Tile, method: Method, ratio: int) -> dict | None:
        """Prefers kept fits. New fits expect the packing of the method's previous fit."""
        target = tile.raw_bytes // ratio
        report = largest_within(target, self._kept_fits(tile, method))
        if self._run.settings.kept:
            report = report if fills(target, report, _HALF) else None
        elif not fills(target, report):
            expected = self._packed.get(method.name, _PACKED.get(method.name, _PACKED_ELSE))
            report = within(target, lambda size: self._fit(tile, method, size), expected)
        if report:
            self._packed[method.name] = packing(report)
        return report

    def _series(self, tile: Tile, method: Method) -> dict:
        """Everything that a fit depends on, except its size."""
        return {"btf": tile.btf, **dict(method.options), "seed": self._run.seed}

    def _kept_fits(self, tile: Tile, method: Method) -> list[dict]:
        found = []
        for path in sorted(self._run.kept.glob(f"compress-{key(self._series(tile, method))}-*.json")):
            report = json.loads(path.read_text(encoding="utf-8"))
            if "refused" not in report:
                found.append({**report, "file": str(path.with_suffix(".velour"))})
        return found

    def _fit(self, tile: Tile, method: Method, size: int) -> dict | None:
        """The report of a fit, with its file; None if it was refused."""
        series, name = self._series(tile, method), f"compress-{key(self._series(tile, method))}"
        out = self._run.stem(name, series | {"bytes": size}).with_suffix(".velour")
        options = {k: v for k, v in series.items() if k != "btf"}
        words = (
            "compress",
            tile.btf,
            "-o",
            out,
            *flags(options | {"bytes": size, "threads": self._run.threads}),
        )
        label = f"{method.name} of {tile.name}, {size} bytes"
        how = {"cost": _FIT_COST, "refusable": True}
        found = self._run.velour(label, name, series | {"bytes": size}, *words, **how)
        return None if "refused" in found else {**found, "file": str(out)}

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


def _raw_bytes(btf: Path) -> int:
    return velour("info", btf, "--quiet")["raw_bytes"]


def packing(report: Mapping) -> float:
    """Bytes of the file per fitted byte."""
    return max(report["bytes"] - HEADERS, 1) / report["parameter_bytes"]


def largest_within(target: int, reports: Iterable[dict]) -> dict | None:
    """The largest file within 1.01 `target`: the excess does not change errors, and often saves a fit."""
    return max((r for r in reports if r["bytes"] <= _SLACK * target), key=lambda r: r["bytes"], default=None)


def fills(target: int, report: Mapping | None, least: float = 1 - _CLOSE) -> bool:
    """Whether at least this share of the bytes is used; by default, a share that is not worth another fit."""
    return report is not None and report["bytes"] >= least * target


def within(target: int, fit: Callable[[int], dict | None], packed: float = 1.0) -> dict | None:
    """The report of the largest file within `target` bytes. `fit` takes the bytes of the fitted parameters
    and returns a report, or None if it refuses; files are larger by their headers and smaller by compression.
    `packed`: the expected packing()."""
    best, tried, size = None, [], max(int(_MARGIN * (target - HEADERS) / packed), 1)
    for _ in range(_TRIES):
        report = fit(size)
        if report is None:
            break
        best = largest_within(target, [report, best] if best else [report])
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
    except NoFlipError:
        return None


def _exposure(reference: np.ndarray) -> float:
    return exposure(reference, np.ones(reference.shape[:2], bool))


def widest_spread(pictures: list[np.ndarray], side: int) -> tuple[int, int]:
    """Row and column of the side x side window in which the pictures differ most from one another, as
    displayed: the square root of each channel, clipped at 1."""
    shown = np.sqrt(np.clip(np.stack(pictures), 0, 1))
    spread = shown.var(axis=0).sum(axis=-1)
    sums = np.pad(spread.cumsum(axis=0).cumsum(axis=1), ((1, 0), (1, 0)))
    windows = sums[side:, side:] - sums[:-side, side:] - sums[side:, :-side] + sums[:-side, :-side]
    row, column = np.unravel_index(windows.argmax(), windows.shape)
    return int(row), int(column)


def _sheet(run: Run, study: Study, tile: Tile, contenders: list[Method], rows: list[dict]) -> None:
    """A tile's pictures at equal bytes beside the BTF itself, with the region where they differ most."""
    ratio, found = run.settings.speed_ratio, {"the BTF": study.picture(tile, tile.btf).pixels}
    for method in contenders:
        if model := study.model(tile, method, ratio):
            found[method.name] = study.picture(tile, model).pixels
    reference, results = found["the BTF"], Results(rows)
    scale, side = _exposure(reference), min(_CROP, *reference.shape[:2])
    close = [scale * p for p in found.values() if relative_error(p, reference) < _FAR]
    top, left = widest_spread(close, side)
    above, below = [], []
    for name, pixels in found.items():
        entry = results.get(tile.name, name, ratio)
        error = "" if entry is None else f", {entry['bytes'] / 1000:.0f} KB, {entry['picture']:.3f}"
        above.append((name + error, charts.display(scale * pixels)))
        below.append(("", charts.display(scale * pixels[top : top + side, left : left + side])))
    both = (charts.wrapped(cells, _COLUMNS) for cells in (above, below))
    lines = [line for pair in zip(*both, strict=True) for line in pair]
    charts.sheet(run.output / f"images/chart_btf_{tile.name}.png", lines, (2.0, 1.95))


class Results:
    """All rows, found by tile, method and ratio."""

    def __init__(self, rows: list[dict]):
        # A later row replaces an earlier one, which --add has kept.
        self._rows = {(row["tile"], row["method"], row["ratio"]): row for row in rows}
        self.all = list(self._rows.values())
        self.tiles, self.methods = (
            list(dict.fromkeys(r[name] for r in self.all)) for name in ("tile", "method")
        )
        self.ratios = sorted({row["ratio"] for row in self.all})

    def get(self, tile: str, method: str, ratio: int) -> dict | None:
        return self._rows.get((tile, method, ratio))

    def best(self, tile: str, ratio: int, value: str = "psnr", among: list[str] | None = None) -> str | None:
        """The method with the largest `value`, of those in `among`."""
        at = [row for row in self.all if (row["tile"], row["ratio"]) == (tile, ratio)]
        known = [row for row in at if row.get(value) is not None and row["method"] in (among or self.methods)]
        return max(known, key=lambda row: row[value])["method"] if known else None

    def gain(self, tile: str, ratio: int, method: str, other: str, value: str = "psnr") -> float | None:
        """`value` of `method` minus that of `other`, at equal bytes."""
        a, b = ((self.get(tile, name, ratio) or {}).get(value) for name in (method, other))
        return None if a is None or b is None else a - b


def verdicts(results: Results) -> Iterator[dict]:
    def judged(target: str, where: str, measured: str, met: bool | None) -> dict:
        return {"target": target, "where": where, "measured": measured, "met": met}

    kcta = [name for name in results.methods if name.startswith("kcta")]
    for target, names, other in (
        ("CTA at least as good as Tucker (fitted)", ["cta"], "tucker"),
        ("K-CTA at least as good as CTA (fitted)", kcta, "cta"),
    ):
        # The best of the methods, for each tile at the ratio where it gains least.
        for tile in results.tiles:
            gains = {
                r: _largest([results.gain(tile, r, name, other) for name in names]) for r in results.ratios
            }
            known = {ratio: gain for ratio, gain in gains.items() if gain is not None}
            if not known:
                yield judged(target, tile, "-", None)
                continue
            worst = min(known, key=known.get)
            measured = f"{_decibels(known[worst])} at 1:{worst}, {_decibels(max(known.values()))} at best"
            yield judged(target, tile, measured, known[worst] >= 0)
    for value, least, words in (
        ("psnr", 1.5, "1.5 dB better, fitted"),
        ("psnr_unseen", 0.0, "no worse, unseen"),
    ):
        target = f"K-CTA against singular values at 1:500, weave: {words}"
        gain = _largest([results.gain("weave", 500, name, "svd", value) for name in kcta])
        yield judged(target, "weave", _decibels(gain), None if gain is None else gain >= least)
    for name in ("cta", *kcta):
        slowest = min((row["evaluations"] for row in results.all if row["method"] == name), default=None)
        measured = "-" if slowest is None else f"{slowest / 1e6:.1f} million"
        met = None if slowest is None else slowest >= 1e6
        yield judged("a million evaluations a second and core", name, measured, met)


def _largest(gains: list[float | None]) -> float | None:
    return max((gain for gain in gains if gain is not None), default=None)


def _decibels(gain: float | None) -> str:
    return "-" if gain is None else f"{gain:+.2f} dB"


def write(run: Run, found: dict) -> None:
    results, conditions = Results(found["rows"]), found["conditions"]
    targets = [target | {"word": page.verdict(target["met"])} for target in verdicts(results)]
    ratio, spp = int(conditions["speed_ratio"]), conditions["speed_spp"].replace(", ", " and ")
    sections = [_tile(tile, ratio, found.get("interpolated", {})) for tile in results.tiles]
    values = {
        "origin": _origin(conditions),
        "sheet_tiles": SHEET_TILES,
        "world": WORLD,
        "speed_spp_named": spp,
        "targets": page.table(
            targets, "target | where | measured | ", "{target} | {where} | {measured} | {word}"
        ),
        "sections": "\n".join(sections),
        "errors": _errors(results, ratio),
        "costs": page.table(
            filter(None, (_median_costs(results, method, ratio) for method in _shown(results))),
            "method | KB | fit, s | processor s | million evaluations a second and core | "
            f"render to {conditions['level']}, processor s | brightness",
            "`{method}` | {bytes:k.0f} | {seconds:.1f} | {processor_seconds:.0f} | "
            "{evaluations:M.2f} | {render_seconds:.2f} | {brightness:.3f}",
        ),
    }
    page.write(run.output, "chart_btf.md", page.text("btf_chart", conditions | values))
    titles = {
        "psnr": "PSNR of fitted pairs, dB",
        "psnr_unseen": "PSNR of unseen pairs, dB",
        "picture": "picture error",
    }
    panels = [(tile, _curves(results, tile, value)) for value in titles for tile in results.tiles]
    chart, axes = run.output / "images/chart_btf.png", ("raw bytes / bytes of the file", [*titles.values()])
    charts.curves(chart, panels, *axes, columns=len(results.tiles), log="x", shared=False)


def _shown(results: Results) -> list[str]:
    """Methods with rows on the page: not K-CTA of a fixed K."""
    return [method for method in results.methods if " " not in method] or results.methods


def _median_costs(results: Results, method: str, ratio: int) -> dict | None:
    """Medians over the tiles; None if the method has no model of this size for any."""
    rows = [row for tile in results.tiles if (row := results.get(tile, method, ratio))]
    names = ("bytes", "seconds", "processor_seconds", "evaluations", "render_seconds", "brightness")
    known = {name: [row[name] for row in rows if row.get(name) is not None] for name in names}
    return {"method": method} | {n: median(v) if v else None for n, v in known.items()} if rows else None


def _origin(conditions: Mapping) -> str:
    """Where the numbers come from: kept results may come from several runs."""
    sentence, one_run = provenance.sentence(conditions), "All numbers come from one run:"
    if conditions["kept"] == "True":
        sentence = sentence.replace(one_run, "Written from kept results of several runs; this page:")
    if conditions["added_to"]:
        sentence = sentence.replace(one_run, "The last run:")
        sentence += f"\nIts rows were added to those of {conditions['added_to']}."
    return sentence


def _curves(results: Results, tile: str, value: str) -> dict[str, list[tuple[float, float]]]:
    curves = {}
    for method in results.methods:
        rows = (results.get(tile, method, ratio) for ratio in results.ratios)
        curves[method] = [(row["ratio"], row[value]) for row in rows if row and row.get(value) is not None]
    return curves


def _tile(tile: str, speed_ratio: int, interpolated: Mapping) -> str:
    itself = f"The BTF itself, interpolated at unseen pairs: {interpolated.get(tile, 0):.2f} dB.\n\n"
    values = {"tile": tile, "speed_ratio": speed_ratio, "itself": itself if tile in interpolated else ""}
    return page.text("btf_chart_tile", values)


def _errors(results: Results, ratio: int) -> str:
    """A row per method, a column per tile: PSNR of fitted pairs and, if it is known, of unseen ones."""
    names = _shown(results)

    def cell(method: str, tile: str) -> str:
        row = results.get(tile, method, ratio)
        if row is None:
            return "-"
        text = " / ".join(f"{row[n]:.2f}" for n in ("psnr", "psnr_unseen") if row.get(n) is not None)
        return f"**{text}**" if results.best(tile, ratio, among=names) == method else text

    rows = [{"m": m, "cells": " | ".join(cell(m, tile) for tile in results.tiles)} for m in names]
    return page.table(rows, f"method | {' | '.join(results.tiles)}", "`{m}` | {cells}")
