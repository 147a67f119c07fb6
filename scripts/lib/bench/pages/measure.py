"""Fits and renders of the test scenes, as a user makes them on the command line."""

from __future__ import annotations

from collections.abc import Iterator

from .. import charts, data_files, page
from ..run import Run
from ..scenes import STUDIO, SUNSET, Scene

CSV = "measurements.csv"
SETTINGS = {
    "size": ((640, 480), (64, 48)),
    "spp": (800, 16),
    "small_size": ((320, 240), (32, 24)),
    "lobes": ((2, 4, 8, 16), (2, 16)),
    "lobes_spp": (512, 16),
    "strategy_spp": (64, 8),
    "converged_spp": (8192, 64),
}
MATERIAL, TOLERANCE = "blue-metallic-paint", 0.02
STRATEGIES = ("uniform", "cosine", "table", "srbf", "ggx", "light", "mis", "mis-ggx", "product")
ANGLES = ("5", "30", "60", "75", "85")


def measure(run: Run) -> dict:
    own = run.settings
    materials = {name: data_files.merl(run.data, name) for name in data_files.merl_names(run.data)}
    options = {"max_lobes": own.lobes[-1], "threads": run.threads}
    models = {name: run.fit(path, **options) for name, path in materials.items()}
    found = {("fits", name): fit for name, (_, fit) in models.items()}
    scenes = {
        f"{name}, {world}": _scene(run, name, models[name][0], world)
        for name in (MATERIAL, "nickel")
        if name in models
        for world in (SUNSET, STUDIO)
    }
    first = next(iter(scenes.values()))
    found["render", MATERIAL] = run.render(first, own.spp).report
    for lobes in own.lobes:
        found["lobes", lobes] = _by_lobes(run, materials[MATERIAL], lobes)
    for name, scene in scenes.items():
        for strategy, report in _strategies(run, scene).items():
            found["strategies", f"{name}, {strategy}"] = report
    rows = [
        {"what": what, "case": case, "quantity": quantity, "value": value}
        for (what, case), report in found.items()
        for quantity, value in _flat(report)
    ]
    return {"conditions": run.conditions(), "rows": rows}


def _scene(run: Run, name: str, model, world: str) -> Scene:
    mesh, world_file = data_files.mesh(run.data, "bunny"), data_files.world(run.data, world)
    return Scene(f"bunny, {name}, {world}", mesh, "y", world_file, model)


def _by_lobes(run: Run, measurement, lobes: int) -> dict:
    """Model against reference mode with the same light directions: the difference is the model's error."""
    model, fit = run.fit(measurement, max_lobes=lobes, threads=run.threads)
    scene, own = _scene(run, f"{lobes} lobes", model, SUNSET), run.settings
    shown, raw = (
        run.render(each, own.lobes_spp, size=own.small_size) for each in (scene, scene.measured(measurement))
    )
    rmse, relmse = shown.errors(raw.pixels)
    return {**shown.report, "rmse": rmse, "relmse": relmse, "fit": fit, "reference_seconds": raw.seconds}


def _strategies(run: Run, scene: Scene) -> dict[str, dict]:
    own = run.settings
    converged = run.render(scene, own.converged_spp, size=own.small_size, seed=run.seed + 1).pixels
    found = {}
    for name in STRATEGIES:
        picture = run.render(scene, own.strategy_spp, size=own.small_size, strategy=name)
        rmse, relmse = picture.errors(converged)
        found[name] = {**picture.report, "rmse": rmse, "relmse": relmse}
    return found


def _flat(report: dict, prefix: str = "") -> Iterator[tuple[str, object]]:
    for key, value in report.items():
        if isinstance(value, dict):
            yield from _flat(value, f"{prefix}{key}.")
        elif key == "warnings":
            yield from ((f"{prefix}warning {number}", warning) for number, warning in enumerate(value, 1))
        elif not isinstance(value, list):
            yield f"{prefix}{key}", value


def write(run: Run, found: dict) -> None:
    cases: dict[str, dict[str, dict]] = {}
    for row in found["rows"]:
        # A field of a template cannot have dots.
        quantity = row["quantity"].replace(".", "_")
        cases.setdefault(row["what"], {}).setdefault(row["case"], {"case": row["case"]})[quantity] = row[
            "value"
        ]
    fits = cases["fits"]
    (render,) = cases["render"].values()
    stages = {key.removeprefix("stages_"): s for key, s in render.items() if key.startswith("stages_")}
    angles = [f"{{by_view_angle_{angle}:.4f}}" for angle in ANGLES]
    parts = {
        "fits": page.table(
            fits.values(),
            "material | seconds | lobes | bytes | relative_l2 | "
            + " | ".join(f"{angle}°" for angle in ANGLES),
            "{case} | {seconds:.1f} | {lobes} | {bytes} | {relative_l2:.4f} | " + " | ".join(angles),
        ),
        "render": _render(render),
        "stages": ", ".join(f"{name} {seconds:.2f} s" for name, seconds in stages.items()),
        "lobes": page.table(
            cases["lobes"].values(),
            "lobes a view | fit seconds | bytes | relative_l2 | relmse of the picture | rmse | seconds | "
            "raw seconds",
            "{case} | {fit_seconds:.1f} | {fit_bytes} | {fit_relative_l2:.4f} | {relmse:.2e} | {rmse:.2e} | "
            "{seconds:.1f} | {reference_seconds:.1f}",
        ),
        "strategies": _strategy_table(list(cases["strategies"].values())),
    }
    page.write(run.output, "measurements.md", page.text("measure", found["conditions"] | parts))
    errors = {
        name: [(int(a), e) for a in ANGLES if (e := fit[f"by_view_angle_{a}"]) is not None]
        for name, fit in fits.items()
    }
    chart, axes = run.output / "images/error_by_view_angle.png", ("view angle, degrees", "relative L2")
    charts.curves(chart, [("", errors)], *axes, levels=[TOLERANCE], log="y")


def _render(report: dict) -> str:
    cells = (
        ("seconds (tracing and shading)", "{seconds:.1f}", "under 60"),
        ("samples per second", "{samples_per_second:M.2f} million", ""),
        ("ray_share", "{ray_share:.2f}", "at least 0.3"),
        ("rays", "{rays:M.0f} million", ""),
        ("samples that were not finite", "{nan_samples}", "0"),
    )
    lines = [" | ".join(line) for line in cells]
    return page.table([report], "quantity | measured | target", " |\n| ".join(lines))


def _strategy_table(rows: list[dict]) -> str:
    """relmse x seconds: a row per strategy, a column per scene."""
    costs: dict[str, dict[str, float]] = {}
    for row in rows:
        scene, strategy = row["case"].rsplit(", ", 1)
        costs.setdefault(strategy, {})[scene] = row["relmse"] * row["seconds"]
    lines = [
        {"name": name, "cells": " | ".join(f"{cost:.1e}" for cost in own.values())}
        for name, own in costs.items()
    ]
    return page.table(lines, f"strategy | {' | '.join(costs['mis'])}", "{name} | {cells}")
