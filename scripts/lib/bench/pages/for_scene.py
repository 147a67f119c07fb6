"""What scene models save and cost, and what is reported on pictures outside of their scene."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np

from ..project import flags
from ..run import Run
from ..scenes import MOVED_PATCH_CAMERA, PATCH_CAMERA, Scene, write_patch, write_soft_sky, write_sunny_sky

CSV = "for_scene.csv"
PAGES = {"for_scene.md": "for_scene"}
SETTINGS = {"size": ((120, 90), (32, 24)), "spp": (4096, 64), "materials": (99, 1)}
OUTSIDE = ("same picture", "moved camera", "small sun")
_SMALL = (32, 24)  # size of renders that measure only the share outside the scene usage


def measure(run: Run) -> dict:
    subjects = run.materials()
    run.expect(run.settings.spp, count=8 * len(subjects))
    run.expect(1, _SMALL, count=len(OUTSIDE) * len(subjects))
    return {"conditions": run.conditions(), "rows": [_row(run, *subject) for subject in subjects]}


def _row(run: Run, name: str, measurement: Path) -> dict:
    model, full = run.fit(measurement, "parametric", max_lobes=16)
    patch = run.made("patch.obj", write_patch)
    soft, sunny = run.made("soft.exr", write_soft_sky), run.made("sunny.exr", write_sunny_sky)
    scene = Scene(name, patch, "z", soft, model, camera=PATCH_CAMERA)
    small, reduced = _fit_for(run, scene, measurement)
    seen = replace(scene, name=f"{name} reduced", material=small)
    references = [_pictures(run, scene.measured(measurement), first) for first in (0, 2)]
    row = {"material": name}
    for what, report in (("full", full), ("reduced", reduced)):
        row |= {f"{what}_{key}": report[key] for key in ("parameter_bytes", "lobes", "seconds")}
    for what, own, first in (("full", scene, 4), ("reduced", seen, 6)):
        row[f"{what}_relmse"], row[f"{what}_error"] = _error(_pictures(run, own, first), *references)
    others = (seen, replace(seen, camera=MOVED_PATCH_CAMERA), replace(seen, world=sunny))
    for what, other in zip(OUTSIDE, others, strict=True):
        row[what] = run.render(other, 1, size=_SMALL, strategy="mis").report["out_of_domain"]
    return row


def _fit_for(run: Run, scene: Scene, measurement: Path) -> tuple[Path, dict]:
    """The reduced model and the report of its fit."""
    seen = {**scene.options, "size": "640x480"}
    usage = run.stem("observe", seen).with_suffix(".scene.json")
    run.velour(f"observing {scene.name}", "observe", seen, "observe", *flags(seen), "-o", usage)
    options = {"for-scene": usage, "full-model": scene.material, "seed": run.seed}
    return run.model(f"fit of {measurement.stem} for the scene", "fit", measurement, options, "reduce")


def _pictures(run: Run, scene: Scene, first_seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Two independent renders."""
    seeds = (100 * run.seed + first_seed + i for i in range(2))
    a, b = (run.render(scene, run.settings.spp, seed=seed, strategy="mis").pixels for seed in seeds)
    return a.astype(np.float64), b.astype(np.float64)


def _error(pictures: tuple, first: tuple, second: tuple) -> tuple[float, float]:
    """An unbiased estimate of relmse against the measurement, and its standard error: uses the product of two
    independent differences in place of a square, over the patch alone."""
    (a, b), reference = pictures, (sum(first) + sum(second)) / 4
    mean = reference.mean(axis=(0, 1))
    shown = (a - sum(first) / 2) * (b - sum(second) / 2) / (reference**2 + 0.01 * mean**2)
    shares = shown.mean(axis=2).ravel()
    return float(shares.mean()), float(shares.std() / np.sqrt(shares.size))


def values(found: dict) -> dict:
    rows = found["rows"]
    for row in rows:
        row["saving"] = row["full_parameter_bytes"] / row["reduced_parameter_bytes"]
        row["excess"] = row["reduced_relmse"] - 1.1 * row["full_relmse"]
    return {
        "rows": rows,
        "count": len(rows),
        "smaller": sum(row["saving"] >= 3 for row in rows),
        "as_good": sum(row["excess"] <= 0 for row in rows),
        "within": _within([row for row in rows if row["excess"] > 0]),
        "refused": sum(min(row["moved camera"], row["small sun"]) > 1e-3 for row in rows),
    }


def _within(above: list[dict]) -> str:
    """How many of the materials above the bound may be there by chance."""
    near = sum(r["excess"] <= 2 * math.hypot(r["reduced_error"], 1.1 * r["full_error"]) for r in above)
    return f" (and within two standard errors of that for {near} more)" if near else ""
