"""Every model of every material: error, size, fit time, and nanoseconds per direction pair."""

from __future__ import annotations

import statistics
from collections.abc import Mapping
from pathlib import Path

from velour.native import Measurement, fit_job

from .. import charts, project
from ..project import BUILT, velour
from ..run import Run

CSV = "models/models.csv"
PAGES = {"models.md": "models"}
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
COSTS = ("f", "sample_pdf", "f_16", "sample_pdf_16")


def measure(run: Run) -> dict:
    conditions, subjects = run.conditions(load=project.busy_threads()), run.materials()
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
        errors, first = report.get("by_view_angle", {}), {"bound": None, "value": None}
        numbers = {key: report.get(key) for key in SIZES}
        numbers |= {f"error_{angle}": errors.get(angle) for angle in ANGLES}
        return {"material": name, "model": model, **first, **numbers, **cost, **more}

    fits, options = [], {"threads": run.threads, "tolerance": TOLERANCE}
    for model in KINDS:
        path, report = run.fit(measurement, model, **options)
        views = velour("info", path).get("views")
        fits.append(row(model, report, _cost(run, f"{name}, {model}", path), views=views))
    peers = {peer: run.compare_peer(measurement, peer) for peer in PEERS}
    noise = {"by_view_angle": peers["ggx"]["noise_by_view_angle"]}
    raw = {"bytes": measurement.stat().st_size}
    rows = [row("noise", noise), row("measurement", raw, _cost(run, name, measurement)), *fits]
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


def values(found: dict) -> dict:
    materials = _by_material(found)
    floor = next((row for row in found["rows"] if row["model"] == "floor"), {})
    return {
        "count": len(materials),
        "busy": project.busy(found["conditions"]["load"]),
        "floors": [floor] if floor.get("f") is not None else [],
        "summary": _summary(materials),
        "errors": [_errors(own) for own in materials.values()],
    }


def _by_material(found: dict) -> dict[str, dict[str, dict]]:
    """The rows without a bound, by material and model."""
    materials: dict[str, dict[str, dict]] = {}
    for row in found["rows"]:
        if row["material"] and not row["bound"]:
            materials.setdefault(row["material"], {})[row["model"]] = row
    return materials


def _summary(materials: Mapping) -> list[dict]:
    """A row per model: medians over the materials, and how many views meet their target."""
    models = [m for m in next(iter(materials.values())) if m not in ("noise", "measurement", UNTURNED)]
    summary = []
    for model in models:
        rows, found = [own[model] for own in materials.values()], dict.fromkeys(COSTS)
        for name in ("relative_l2", "parameter_bytes", "seconds", *COSTS):
            if all(row.get(name) is not None for row in rows):
                found[name] = statistics.median(row[name] for row in rows)
        covered = sum(row[f"error_{angle}"] is not None for row in rows for angle in ANGLES)
        good = sum(met(own[model], own["noise"]) for own in materials.values())
        summary.append(
            found | {"model": model, "good": good, "covered": covered, "plain": sum(map(met, rows))}
        )
    return summary


def _errors(own: Mapping) -> dict:
    """Errors of every model of a material, and alpha of its GGX lobe."""
    errors = {model: row["relative_l2"] for model, row in own.items()}
    return own["ggx"] | errors | {"unturned": errors[UNTURNED]}


def draw(output: Path, found: dict) -> None:
    materials = _by_material(found)
    for name, bound, x in (
        ("error_by_lobes", "max-lobes", "lobes (scattered: a view)"),
        ("error_by_bytes", "bytes", "bytes"),
    ):
        panels = {material: {} for material in materials}
        for row in found["rows"]:
            if row["bound"] == bound:
                size = row["value"] if bound == "max-lobes" else row["bytes"]
                panels[row["material"]].setdefault(row["model"], []).append((size, row["relative_l2"]))
        for material, own in materials.items():
            for peer, lobes in PEERS.items():
                size = lobes if bound == "max-lobes" else own[peer]["parameter_bytes"]
                panels[material][peer] = [(size, own[peer]["relative_l2"])]
        path = output / f"models/{name}.png"
        charts.curves(path, [*panels.items()], x, "relative L2", levels=[TOLERANCE])
