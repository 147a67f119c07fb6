"""Error against seconds for every strategy, on scattered models and today's defaults, and beside Mitsuba."""

from __future__ import annotations

import functools
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
from velour.native.table import STRATEGIES

from .. import charts, mitsuba
from ..page import judged, missed
from ..project import BUILT
from ..reference import Curve, Reading, Reference, points, ratio, shown
from ..run import Run, words_of
from ..scenes import STUDIO, SUNSET, Scene, Subject, subjects, write_sunny_sky

CSV = "chart/chart.csv"
PAGES = {"chart/README.md": "chart"}
SETTINGS = {
    "size": ((320, 240), (48, 36)),
    "worlds": ((STUDIO, SUNSET), (SUNSET,)),
    "skipped": ((), ("cosine", "table", "srbf", "ggx", "light", "dissertation")),  # curves
    "spp": ((16, 64, 256, 1024), (8, 32)),
    "level_spp": (800, 16),  # the default strategy's error here is the level of the equal-error table
    "default_subjects": (3, 1),  # that are also fitted with today's defaults
    "equal_spp": (256, 32),  # one of `spp`, at which targets compare equal samples
    "seeds": (3, 2),  # compared curves; others have one seed
    "reference_spp": (2048, 64),  # per batch
    "reference_batches": (4, 2),
    "bound_hits": (200, 8),
    "peer_materials": (3, 1),
    "peer_size": ((160, 120), (32, 24)),
    "peer_rays": ((8, 32, 128), (2, 4)),  # camera rays per pixel, with eight light directions each
    "peer_reference_rays": (256, 8),
}
SKY = "synthetic sky"
DEFAULT, DISSERTATION = "mis", "mis-dissertation"
# Curves that targets compare closely have more seeds. Curves that no target names end a step earlier.
COMPARED = (DEFAULT, "mis-ggx", "product", "auto")
LONG = (*COMPARED, "uniform", DISSERTATION)
# How a scene's model is fitted: as the dissertation's, or by today's defaults, which have these curves.
SCATTERED, DEFAULTS = "scattered", "default model"
_OF_DEFAULTS = ("uniform", *COMPARED)
# Maximum relmse of `product` relative to the default strategy at equal samples.
_EQUAL_SAMPLES = {
    ("nickel", SUNSET): 0.6,
    ("blue-metallic-paint", SUNSET): 0.4,
    ("nickel", STUDIO): 0.5,
    ("blue-metallic-paint", STUDIO): 0.5,
    ("krylon-blue", STUDIO): 0.5,
}
# Curves with a column in the table of equal errors; the pictures and the CSV have all.
_SHOWN = ("uniform", "light", "mis", "mis-ggx", "product", "auto", "mis-dissertation", "mis, random")
_WITHIN = 1.1  # of the best: `auto`, at equal time
_MOST_GGX_ERROR = 0.2  # relative L2 above which SRBF lobes must be clearly faster


def measure(run: Run) -> dict:
    rows, found = [], []
    scenes = list(_scenes(run))
    for _, about in scenes:
        for name in _curves(run, about["model"]):
            for spp, seeds in _ladder(run, name):
                run.expect(spp, count=seeds)
        run.expect(run.settings.reference_spp, count=run.settings.reference_batches)
    for scene, about in scenes:
        own, measured = _scene(run, scene, about["model"])
        rows += own
        found.append({"name": scene.name} | about | measured)
    return {
        "conditions": run.conditions(),
        "rows": rows,
        "scenes": found,
        "mitsuba": mitsuba.compare(run),
    }


def _scenes(run: Run) -> Iterator[tuple[Scene, dict]]:
    """Each scene, with its material and world, how its model is fitted, and the error of the closest GGX."""
    shown_ = subjects(run)
    ggx = {s.material: run.compare_peer(s.measurement, "ggx")["relative_l2"] for s in shown_}

    def about(subject: Subject, world: str, model: str) -> dict:
        return {"material": subject.material, "world": world, "model": model, "ggx": ggx[subject.material]}

    for subject in shown_:
        for world in run.settings.worlds:
            yield subject.scene(world, run.data), about(subject, world, SCATTERED)
    bunny, sky = shown_[0], run.made("sunny.exr", write_sunny_sky)
    scene = Scene(f"{bunny.name}, {SKY}", bunny.mesh, "y", sky, bunny.model)
    yield scene, about(bunny, SKY, SCATTERED)
    for subject in shown_[: run.settings.default_subjects]:
        subject = replace(
            subject, name=f"{subject.name}, {DEFAULTS}", model=run.default_fit(subject.measurement)
        )
        for world in run.settings.worlds:
            yield subject.scene(world, run.data), about(subject, world, DEFAULTS)


def _curves(run: Run, model: str) -> list[str]:
    wanted = STRATEGIES if model == SCATTERED else _OF_DEFAULTS
    return [name for name in wanted if name not in run.settings.skipped]


def _ladder(run: Run, name: str) -> list[tuple[int, int]]:
    """Pairs (spp, number of seeds) of a curve."""
    own = run.settings
    steps = {*own.spp, own.level_spp} if name == DEFAULT else {*own.spp}
    seeds = own.seeds if name in COMPARED else 1
    return [(spp, seeds) for spp in sorted(steps) if name in LONG or spp < max(steps)]


def _scene(run: Run, scene: Scene, model: str) -> tuple[list[dict], dict]:
    """The points of all curves, the noise of the reference, and the bound."""
    own = run.settings
    reference = Reference(run, scene, own.reference_spp, strategy="product").add(own.reference_batches)
    pictures = []
    for name in _curves(run, model):
        for spp, seeds in _ladder(run, name):
            for seed in range(run.seed, run.seed + seeds):
                # The dissertation's strategies have their own random numbers.
                picture = run.render(scene, spp, seed=seed, strategy=name, sequence="sobol")
                pictures.append((picture, {"scene": scene.name, "curve": name, "spp": spp, "seed": seed}))
    return points(pictures, reference), {"noise": reference.noise()[1], "bound": _bound(run, scene)}


def _bound(run: Run, scene: Scene) -> dict | None:
    """Variances of one direction by `mis`, `product` and exact product sampling, by a program that tabulates
    f cos times radiance at some hits; None if it is not built."""
    options = {"mesh": scene.mesh, "material": scene.material, "world": scene.world}
    options |= {"size": "{}x{}".format(*run.settings.size), "hits": run.settings.bound_hits, "seed": run.seed}
    found = run.program(f"{scene.name}, bound", BUILT / "bench/product_bound", *words_of(options))
    return found and found["variance"]


class Result:
    """The numbers of one scene that tables and targets derive from the points of its curves."""

    def __init__(self, about: Mapping, points: Mapping[str, list[Mapping]], level_spp: int):
        """`points`: spp, seed, seconds, relmse and mse (linear RGB), without the reference's noise."""
        self.about, self.points, self.level_spp = about, points, level_spp

    @functools.cached_property
    def curves(self) -> dict[str, Curve]:
        """relmse against seconds, as means over seeds."""
        return {name: Curve([p[:2] for p in self.means(name).values()]) for name in self.points}

    def means(self, name: str) -> dict[int, tuple[float, float, float]]:
        """spp -> seconds, relmse, rmse"""
        found = {}
        for spp in sorted({p["spp"] for p in self.points[name]}):
            own = [[p["seconds"], p["relmse"], p["mse"]] for p in self.points[name] if p["spp"] == spp]
            seconds, relmse, mse = np.mean(own, axis=0)
            found[spp] = float(seconds), float(relmse), float(max(mse, 0.0) ** 0.5)
        return found

    @property
    def level(self) -> float:
        """relmse of the default strategy at `level_spp` samples."""
        return self.means(DEFAULT)[self.level_spp][1]

    def seconds_to_level(self, name: str) -> Reading | None:
        return self.curves[name].seconds_at(self.level) if name in self.curves else None

    def time_ratio(self, name: str, other: str) -> Reading | None:
        """Ratio of `name` to `other` in seconds to the level."""
        return ratio(*map(self.seconds_to_level, (name, other)))

    def error_ratio(self, name: str, other: str) -> Reading | None:
        """Ratio of `name` to `other` in relmse at equal time."""
        seconds = self.means(DEFAULT)[self.level_spp][0]
        return ratio(*(self.curves[curve].error_at(seconds) for curve in (name, other)))

    def to_best(self, name: str) -> Reading | None:
        """Ratio of `name` to the best other strategy in relmse at equal time."""
        found = [self.error_ratio(name, other) for other in self.points if other != name]
        return max(filter(None, found), key=lambda reading: reading.value, default=None)

    def gain(self, name: str, other: str, spp: int) -> tuple[float, float]:
        """Ratio of `name` to `other` in relmse at equal samples, of means over seeds, and its standard error,
        estimated from the seeds."""
        a, b = (np.array([p["relmse"] for p in self.points[n] if p["spp"] == spp]) for n in (name, other))
        relative = [x.var(ddof=1) / len(x) / x.mean() ** 2 if len(x) > 1 else np.nan for x in (a, b)]
        value = float(a.mean() / b.mean())
        return value, abs(value) * sum(relative) ** 0.5

    @property
    def share_of_bound(self) -> float | None:
        """Share of the variance reduction of exact product sampling over the default that `product` has."""
        bound = self.about["bound"]
        return bound and (bound["mis"] - bound["product"]) / (bound["mis"] - bound["exact"])


def results_of(found: Mapping) -> list[Result]:
    results = []
    for about in found["scenes"]:
        points: dict[str, list[dict]] = {}
        for row in found["rows"]:
            if row["scene"] == about["name"]:
                points.setdefault(row["curve"], []).append(row)
        results.append(Result(about, points, int(found["conditions"]["level_spp"])))
    return results


def peers_of(found: Mapping) -> list[Mapping]:
    """For each material: seconds to the relmse of Mitsuba's longest render, and its seconds over ours."""
    materials = []
    for sphere in found["spheres"]:
        own = [row for row in found["rows"] if row["scene"] == sphere["material"]]
        names = ("mitsuba", *mitsuba.STRATEGIES)
        level = [row["relmse"] for row in own if row["curve"] == "mitsuba"][-1]
        seconds = {}
        for name in names:
            curve = Curve([(row["seconds"], row["relmse"]) for row in own if row["curve"] == name])
            seconds[name] = curve.seconds_at(level) if level > 0 else None
        ours = [seconds[name] for name in mitsuba.STRATEGIES if seconds[name]]
        speed_up = ratio(seconds["mitsuba"], min(ours, key=lambda reading: reading.value, default=None))
        materials.append({**sphere, "level": level, "seconds": seconds, "speed_up": speed_up})
    return materials


def verdicts(results: list[Result], peers: list[Mapping], spp: int) -> Iterator[dict]:
    """Targets and whether they are met. `spp`: the number of samples at which equal samples are compared."""
    figures = [result for result in results if result.about["world"] != SKY]
    for result in figures:
        name, material = result.about["name"], result.about["material"]
        most = _EQUAL_SAMPLES.get((material, result.about["world"]))
        if most and result.about["model"] == SCATTERED:
            gain = result.gain("product", DEFAULT, spp)
            target = f"relmse of `product` / `mis` at {spp} spp at most {most}"
            yield judged(target, name, _gain(gain), gain[0] <= most)
        part = 100 if material == "nickel" else 5
        is_hard = result.about["ggx"] > _MOST_GGX_ERROR
        most, words = (2 / 3, "2/3 of") if is_hard else (1.0, "those of")
        to_equal, to_time = "seconds of `mis` to equal error at most", "at equal time at most"
        for target, found, bound in (
            (f"relmse of `product` / `mis` {to_time} 1.2", result.error_ratio("product", DEFAULT), 1.2),
            (f"{to_equal} 1/{part} of `uniform`", result.time_ratio(DEFAULT, "uniform"), 1 / part),
            (f"{to_equal} {words} `mis-ggx`", result.time_ratio(DEFAULT, "mis-ggx"), most),
        ):
            yield judged(target, name, shown(found), found and found.value <= bound)
    for result in results:
        if "auto" not in result.points:
            continue
        found = result.to_best("auto")
        target = f"relmse of `auto` at equal time at most {_WITHIN} of the best strategy's"
        yield judged(target, result.about["name"], shown(found), found and found.value <= _WITHIN)
    scattered = [result for result in figures if result.about["model"] == SCATTERED]
    readings = [result.error_ratio("product", DEFAULT) for result in scattered]
    better = sum(reading is not None and reading.value < 1 for reading in readings)
    target = "`product` better than `mis` at equal time on at least four of six"
    yield judged(target, "all scattered", f"{better} of {len(readings)}", better >= 4)
    for peer in peers:
        target, found = "seconds of Mitsuba to equal error over ours above 1", peer["speed_up"]
        yield judged(target, peer["material"], shown(found), found and found.value > 1)
        target, apart = "converged spheres of Mitsuba and ours differ by at most 1 %", peer["relative"]
        yield judged(target, peer["material"], f"{100 * apart:.2f} %", apart <= 0.01)


def values(found: dict) -> dict:
    results, conditions = results_of(found), found["conditions"]
    absent = found["mitsuba"] if isinstance(found["mitsuba"], str) else ""
    peers = [] if absent else peers_of(found["mitsuba"])
    equal_spp, sun = int(conditions["equal_spp"]), next(r for r in results if r.about["world"] == SKY)
    most_spp = max(sun.means("product"))
    targets = list(verdicts(results, peers, equal_spp))
    bounded = all(result.about["bound"] for result in results)
    curves = [name for name in _SHOWN if name in results[0].points]
    every = [equal_spp]
    bound_titles = " | share of the gain"
    return {
        "scenes": [result.about | {"picture": _picture(result)} for result in results],
        "missed": missed(targets),
        "met": sum(target["met"] is True for target in targets),
        "judged": len(targets),
        "curves": " | ".join(curves),
        "equal_error": [_equal_error(result, curves) for result in results],
        "bounded": [{}] if bounded else [],
        "unbounded": [] if bounded else [{}],
        "every": " | ".join(f"{spp} spp" for spp in every)
        + " | `mis` / `mis-dissertation`"
        + bound_titles * bounded,
        "equal_samples": [_equal_samples(result, every, equal_spp, bounded) for result in results],
        "sun_gain": _gain(sun.gain("product", DEFAULT, most_spp)),
        "most_spp": most_spp,
        "absent": [{"why": absent}] if absent else [],
        "present": [] if absent else [_mitsuba(found["mitsuba"], peers, conditions)],
    }


def draw(output: Path, found: dict) -> None:
    for result in results_of(found):
        means = {name: list(result.means(name).values()) for name in result.points}
        panels = [
            (error, {name: [(point[0], point[k]) for point in points] for name, points in means.items()})
            for k, error in ((1, "relmse"), (2, "rmse"))
        ]
        title = f"{result.about['name']}; dotted: {DEFAULT} at {result.level_spp} samples a pixel"
        axes, path = ("seconds", "error against the reference"), output / "chart" / _picture(result)
        charts.curves(path, panels, *axes, levels={"relmse": result.level}, shared=False, title=title)


def _picture(result: Result) -> str:
    return result.about["name"].replace(", ", "-").replace(" ", "_").lower() + ".png"


def _gain(gain: tuple[float, float]) -> str:
    return f"{gain[0]:.2f} ± {gain[1]:.2f}"


def _equal_error(result: Result, curves: list[str]) -> dict:
    cells = [*map(result.seconds_to_level, curves), result.time_ratio("uniform", DEFAULT)]
    return {"name": result.about["name"], "level": result.level, "cells": " | ".join(map(shown, cells))}


def _equal_samples(result: Result, every: list[int], equal_spp: int, bounded: bool) -> dict:
    cells = [_gain(result.gain("product", DEFAULT, spp)) for spp in every]
    has_both = DISSERTATION in result.points
    cells.append(f"{result.gain(DEFAULT, DISSERTATION, equal_spp)[0]:.2f}" if has_both else "")
    if bounded:
        cells.append(f"{100 * result.share_of_bound:.0f} %")
    return {"name": result.about["name"], "cells": " | ".join(cells)}


def _mitsuba(found: Mapping, peers: list[Mapping], conditions: Mapping) -> dict:
    for peer in peers:
        peer["cells"] = " | ".join(map(shown, [*peer["seconds"].values(), peer["speed_up"]]))
    strategies = " | ".join(f"`{name}`" for name in mitsuba.STRATEGIES)
    most = conditions["peer_rays"].split(", ")[-1]
    own = {"most_rays": most, "peers": peers, "strategies": strategies}
    return {"version": found["version"], "variant": found["variant"], **own}
