"""Fits of measurements that nobody tuned on, made from seeds by other formulas, with defects."""

from __future__ import annotations

import statistics
from pathlib import Path

from .. import population
from ..run import Run

CSV = "population.csv"
PAGES = {"population.md": "population"}
# The seed of the second half is for releases alone: opened once, reported, never tuned on.
SETTINGS = {"members": (60, 3), "population_seed": (1, 1)}
VIEWS = ("5", "30", "60", "75", "85")
PEERS = ("ggx", "principled")
LAYOUTS = ("merl", "rgl", "cornell")
QUALITIES = ("good", "fair", "poor")
_VISIBLE = 0.1  # FLIP of a fit that must not pass for more than poor


def measure(run: Run) -> dict:
    folder = run.work / "measurements"
    folder.mkdir(exist_ok=True)
    run.progress.expect(1, run.settings.members * (2 + len(PEERS)))
    rows = [_row(run, folder, index) for index in range(run.settings.members)]
    return {"conditions": run.conditions(), "rows": rows}


def _row(run: Run, folder: Path, index: int) -> dict:
    made = population.member(run.settings.population_seed, index)
    path = folder / f"{run.settings.population_seed}-{index}.{made.layout}"
    if not path.is_file():
        made.write(path)
    row = {"member": made.name, "kind": made.kind, "layout": made.layout, "defect": made.defect}
    report = run.fit(path, "auto", threads=run.threads)[1]
    row |= {
        "model": model_kind(report),
        "seconds": report["seconds"],
        "processor": report["processor_seconds"],
    }
    row |= {"bytes": report["bytes"], "error": report["relative_l2"]}
    row |= {"verdict": report["verdict"]["quality"], "flip": report["verdict"]["flip_mean"]}
    row |= {f"error_{view}": report["by_view_angle"][view] for view in VIEWS}
    row["per_view"] = run.fit(path, "scattered", threads=run.threads)[1]["relative_l2"]
    peers = {peer: run.compare_peer(path, peer) for peer in PEERS}
    row |= {peer: found["relative_l2"] for peer, found in peers.items()}
    row |= {f"noise_{view}": peers["ggx"]["noise_by_view_angle"][view] for view in VIEWS}
    return row


def model_kind(report: dict) -> str:
    return "parametric" if "view_range" in report else "per-view"


def spread(values: list[float | None]) -> dict:
    """Median, 95th percentile and largest of the values that there are."""
    known = sorted(value for value in values if value is not None)
    if not known:
        return {"median": None, "most": None, "worst": None}
    return {
        "median": statistics.median(known),
        "most": known[min(len(known) - 1, int(0.95 * len(known)))],
        "worst": known[-1],
    }


def beaten(row: dict) -> bool:
    """Whether another model is more than a tenth better."""
    return 1.1 * min(row["per_view"], *(row[peer] for peer in PEERS)) < row["error"]


def values(found: dict) -> dict:
    rows = found["rows"]
    columns = {f"error at {view}°": [row[f"error_{view}"] for row in rows] for view in VIEWS}
    columns |= {
        "mean error": [row["error"] for row in rows],
        "mean error, no noise added": [row["error"] for row in rows if row["defect"] != "noise"],
    }
    columns |= {f"mean error, {name}": [row[name] for row in rows] for name in ("per_view", *PEERS)}
    for layout in LAYOUTS:
        columns[f"mean error, {layout}"] = [row["error"] for row in rows if row["layout"] == layout]
    columns |= {name: [row[name] for row in rows] for name in ("flip", "seconds", "processor", "bytes")}
    return {
        "count": len(rows),
        "spreads": [{"what": what, **spread(values)} for what, values in columns.items()],
        "worst": sorted(rows, key=lambda row: -row["error"])[:3],
        "beaten": sum(map(beaten, rows)),
        "per_view_models": sum(row["model"] == "per-view" for row in rows),
        "hidden": sum(row["flip"] > _VISIBLE and row["verdict"] != "poor" for row in rows),
        **{quality: sum(row["verdict"] == quality for row in rows) for quality in QUALITIES},
    }
