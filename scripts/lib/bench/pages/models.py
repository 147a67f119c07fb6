"""Every model of every material: error, size, fit time, and nanoseconds per direction pair."""

from __future__ import annotations

import statistics
from collections.abc import Mapping
from pathlib import Path

from velour.native import Measurement, fit_job

from .. import charts, data_files, page, provenance
from ..run import BUILT, Run
from ..velour_cli import velour

CSV = "models/models.csv"
SETTINGS = {
    "materials": (99, 1),
    "lobes": ((1, 2, 4, 8, 16, 32), (1, 4)),
    "bytes": ((3000, 4000, 5000, 6000, 8000, 12000, 16000, 24000, 32000), (2000, 8000)),
}
PEERS = {"ggx": 1, "principled": 2}  # and their lobes, comparable to those of a fit
KINDS = ("scattered", "parametric")
TOLERANCE, UNBOUND = 0.02, 1e-6  # the latter is met by no fit, so that only the requested bound stops it
UNTURNED = "scattered, unturned"  # the per-view fit that mixes slices without aligning them
ANGLES = ("5", "30", "60", "75", "85")
SIZES = ("relative_l2", "lobes", "bytes", "parameter_bytes", "seconds")
COSTS = {"f": "f, ns", "sample_pdf": "sample, pdf", "f_16": "f, 16", "sample_pdf_16": "sample, pdf, 16"}
# Targets of the parametric model, in the columns of the summary.
TARGETS = "| *target* |  | all |  | 2700 | 2.00 | 60 | 120 | 30 | 60 |\n"


def measure(run: Run) -> dict:
    conditions = run.conditions(load=provenance.busy_threads())
    subjects = data_files.materials(run.data)[: run.settings.materials]
    points = len(run.settings.lobes) + len(run.settings.bytes)
    each = 2 + len(KINDS) * (points + 2) + 2 * len(PEERS)
    run.progress.expect(1, 1 + len(subjects) * each)
    floor, values = _cost(run, "nothing", "floor"), {}
    rows = [{"material": None, "model": "floor", **floor}] if floor else []
    for name, measurement in subjects:
        own, values[name] = _rows(run, name, measurement)
        rows += own
    return {"conditions": conditions, "rows": rows, "principled": values}


def _rows(run: Run, name: str, measurement: Path) -> tuple[list[dict], dict]:
    """The rows of a material, and the values of its Principled material."""

    def row(model: str, report: Mapping, cost: Mapping = {}, **more) -> dict:
        errors = report.get("by_view_angle", {})
        sizes = {key: report.get(key) for key in SIZES}
        angles = {f"error_{angle}": errors.get(angle) for angle in ANGLES}
        return {
            "material": name,
            "model": model,
            "bound": None,
            "value": None,
            **sizes,
            **angles,
            **cost,
            **more,
        }

    fits, options = [], {"threads": run.threads, "tolerance": TOLERANCE}
    for model in KINDS:
        path, report = run.fit(measurement, model, **options)
        more = {"views": velour("info", path).get("views")}
        fits.append(row(model, report, _cost(run, f"{name}, {model}", path), **more))
    peers = {peer: run.compare_peer(measurement, peer) for peer in PEERS}
    noise = peers["ggx"]["noise_by_view_angle"]
    raw = {"bytes": measurement.stat().st_size}
    rows = [
        row("noise", {"by_view_angle": noise}),
        row("measurement", raw, _cost(run, name, measurement)),
        *fits,
    ]
    for peer, report in peers.items():
        more = {"alpha": report["ggx"]["alpha"][0]} if peer == "ggx" else {}
        rows.append(row(peer, report, _cost(run, f"{name}, {peer}", measurement, peer), **more))
    rows.append(row(UNTURNED, _unturned(run, name, measurement)))
    for bound, values in (("max-lobes", run.settings.lobes), ("bytes", run.settings.bytes)):
        for model in KINDS:
            for value in values:
                bounded = options | {bound: value} | ({"tolerance": UNBOUND} if bound == "max-lobes" else {})
                report = run.fit(measurement, model, **bounded)[1]
                if "refused" not in report:
                    rows.append(row(model, report) | {"bound": bound, "value": value})
    return rows, peers["principled"]["principled"]


def _unturned(run: Run, name: str, measurement: Path) -> dict:
    options = {"model": "scattered", "tolerance": TOLERANCE, "align_views": 0}
    options |= {"seed": run.seed, "threads": run.threads}

    def make() -> dict:
        with Measurement.load(measurement) as source, fit_job(source, **options) as job:
            return job.run()

    return run.keep(f"unturned fit of {name}", "unturned", {"measurement": measurement, **options}, make, 1)


def _cost(run: Run, name: str, *words) -> dict:
    """Nanoseconds; empty if the program is not built."""
    return run.program(f"cost of {name}", BUILT / "bench/evaluation_cost", *words, cost=1) or {}


def target(angle: str, noise: float | None) -> float:
    """2 % up to 75 degrees, 4 % beyond; the measurement's own noise where that is larger."""
    return max(0.02 if int(angle) <= 75 else 0.04, noise or 0.0)


def meets(row: Mapping, angle: str, noise: Mapping) -> bool:
    error = row[f"error_{angle}"]
    return error is not None and error <= target(angle, noise.get(f"error_{angle}"))


def met(row: Mapping, noise: Mapping = {}) -> int:
    """Number of views that meet their target."""
    return sum(meets(row, angle, noise) for angle in ANGLES)


def write(run: Run, found: dict) -> None:
    rows, conditions = found["rows"], found["conditions"]
    floor = next((row for row in rows if row["model"] == "floor"), {})
    materials: dict[str, dict[str, dict]] = {}
    for row in rows:
        if row["material"] and not row["bound"]:
            materials.setdefault(row["material"], {})[row["model"]] = row
    values = {
        "count": len(materials),
        "summary": _summary(materials) + TARGETS,
        "angles": _angles(materials),
        "errors": _errors(materials),
        "neighbors": _neighbors(float(conditions["load"])),
        "floor": _floor(floor),
    }
    page.write(run.output, "models.md", page.text("models", conditions | values))
    _draw(run.output / "models", rows, materials)


def _models(own: Mapping) -> list[dict]:
    """The rows of the models of a material, with and without peers."""
    return [row for model, row in own.items() if model not in ("noise", "measurement", UNTURNED)]


_COST_TITLES = " | ".join(COSTS.values())
_COST_CELLS = " | ".join(f"{{{name}:.0f}}" for name in COSTS)


def _summary(materials: Mapping) -> str:
    def of(model: str) -> dict:
        rows = [own[model] for own in materials.values()]
        numbers = ("relative_l2", "parameter_bytes", "seconds", *COSTS)
        medians = {
            name: statistics.median(row[name] for row in rows)
            for name in numbers
            if all(row.get(name) is not None for row in rows)
        }
        covered = sum(row[f"error_{angle}"] is not None for row in rows for angle in ANGLES)
        good = sum(met(own[model], own["noise"]) for own in materials.values())
        counts = {"met": f"{good} of {covered}", "plain": sum(map(met, rows))}
        return dict.fromkeys(COSTS) | medians | counts | {"model": model}

    first = next(iter(materials.values()))
    return page.table(
        (of(row["model"]) for row in _models(first)),
        f"model | relative_l2 | met | without noise | parameter bytes | seconds | {_COST_TITLES}",
        f"{{model}} | {{relative_l2:.4f}} | {{met}} | {{plain}} | {{parameter_bytes:.0f}} | "
        f"{{seconds:.2f}} | {_COST_CELLS}",
    )


def _angles(materials: Mapping) -> str:
    """Errors of the default model beside the noise of the measurement."""

    def cell(row: Mapping, noise: Mapping, angle: str) -> str:
        error, own = ("-" if (e := of[f"error_{angle}"]) is None else f"{e:.4f}" for of in (row, noise))
        return f"**{error}** / {own}" if meets(row, angle, noise) else f"{error} / {own}"

    rows = [
        {"material": name, "cells": " | ".join(cell(own["parametric"], own["noise"], a) for a in ANGLES)}
        for name, own in materials.items()
    ]
    return page.table(rows, f"material | {' | '.join(f'{a}°' for a in ANGLES)}", "{material} | {cells}")


def _errors(materials: Mapping) -> str:
    """Errors of every model, and alpha of the GGX lobe."""
    names = (*KINDS, UNTURNED, *PEERS)
    rows = [
        own["ggx"] | {"errors": [own[name]["relative_l2"] for name in names]} for own in materials.values()
    ]
    cells = " | ".join(f"{{errors[{k}]:.4f}}" for k in range(len(names)))
    return page.table(
        rows,
        f"material | {' | '.join(names)} | alpha",
        f"{{material}} | {cells} | {{alpha:.3f}}",
    )


def _neighbors(load: float) -> str:
    if load < 0.2:
        return ""
    return f"; **other programs kept {load:.1f} processors busy**, so they are too many"


def _floor(floor: Mapping) -> str:
    if floor.get("f") is None:
        return "They need `evaluation_cost`, which was not built."
    one, many = ([f"{floor[key + n]:.1f}" for key in ("f", "sample_pdf")] for n in ("", "_16"))
    return f"The calls alone, without\narithmetic, take {' and '.join(one)} ns, {' and '.join(many)} with 16."


def _draw(folder: Path, rows: list[dict], materials: Mapping) -> None:
    for name, bound, x in (
        ("error_by_lobes", "max-lobes", "lobes (scattered: a view)"),
        ("error_by_bytes", "bytes", "bytes"),
    ):
        panels = {material: {} for material in materials}
        for row in rows:
            if row["bound"] == bound:
                size = row["value"] if bound == "max-lobes" else row["bytes"]
                panels[row["material"]].setdefault(row["model"], []).append((size, row["relative_l2"]))
        for material, own in materials.items():
            for peer, lobes in PEERS.items():
                size = lobes if bound == "max-lobes" else own[peer]["parameter_bytes"]
                panels[material][peer] = [(size, own[peer]["relative_l2"])]
        charts.curves(folder / f"{name}.png", [*panels.items()], x, "relative L2", levels=[TOLERANCE])
