"""Writes docs/results/perceptual.md, its CSV and its chart from the numbers of scripts/perceptual."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import plots
import provenance
from markdown_table import table
from perceptual_runs import DEFAULT
from table_csv import csv_text
from velour.core import files


def write(folder: Path, rows: list, thresholds, conditions: dict, extent) -> None:
    (folder / "perceptual").mkdir(exist_ok=True)
    _draw(folder / "perceptual/flip_by_error.png", rows, thresholds)
    files.write_text(folder / "perceptual/perceptual.csv", _csv(rows, conditions))
    files.write_text(folder / "perceptual.md", _page(rows, thresholds, conditions, extent))


def _page(rows: list, thresholds, conditions: dict, extent) -> str:
    width, height = extent.size
    worlds = " and ".join(f"`{world}`" for world in extent.worlds)
    return f"""# What a tolerance looks like

Written by `scripts/perceptual`; the rows behind tables and chart are in
[perceptual/perceptual.csv](perceptual/perceptual.csv).
{provenance.sentence(conditions)}

Pictures of fitted models beside pictures of the measurements themselves: {_count(rows, "material")} materials
on a sphere and on the bunny under {worlds},
{width}x{height}, default camera, direct light, {extent.spp} samples a pixel by `product`. Both pictures of a
pair come from the same seed and the same light directions, the model's, so that their noise is the same and
all but cancels.

Metric: LDR-FLIP [ANA20] in its authors' package, at its default distance of 67 pixels a degree, over the
pixels that show the object. Exposure: the object's mean luminance in the measurement's picture becomes 18 %;
then the sRGB curve, clipped, unrounded. FLIP is made for two pictures that take turns in one place, the
strictest way to compare.

Threshold: the mean below {thresholds.mean:.3f}, and 99 of 100 pixels below {thresholds.percentile:.3f}.
These are what FLIP says of two even grays that differ by 1 and by 2.3 in CIELAB: what observers do not
notice [MT11], and the classical just noticeable difference [MVO94].

{_verdict(rows, thresholds)}

## By tolerance

Over all materials and scenes, of the default model with up to 16 lobes, and with up to 2.
`error`: the relative L2 that the fits reached; with a loose tolerance it is often far below.

{_by_tolerance(rows, thresholds)}
![FLIP against the error of the fit](perceptual/flip_by_error.png)

The worst of each material's scenes, against the error that the fit reached; dotted: the thresholds.

## At the default tolerance

`noise`: FLIP between two pictures of the measurement with different seeds, which is what independent renders
would show and common ones do not.

{_at_default(rows, thresholds)}"""


def holds(seen, thresholds) -> bool:
    return seen.mean < thresholds.mean and seen.percentile < thresholds.percentile


def _verdict(rows: list, thresholds) -> str:
    at = [row for row in rows if row.order == DEFAULT]
    below = sum(holds(row.model, thresholds) for row in at)
    means = sum(row.model.mean < thresholds.mean for row in at)
    whole = [name for name in dict.fromkeys(row.material for row in at) if _all_hold(at, name, thresholds)]
    ending = "" if below == len(at) else " The others are named below."
    return f"""**At the default tolerance of {DEFAULT}, {below} of {len(at)} pictures are below the
threshold, and {means} have their mean below its own.** Materials with all their pictures below:
{", ".join(whole) or "none"}.{ending}"""


def _all_hold(rows: list, material: str, thresholds) -> bool:
    return all(holds(row.model, thresholds) for row in rows if row.material == material)


def _by_tolerance(rows: list, thresholds) -> str:
    header = ["tolerance", "error, median", "error, largest", "mean, median", "mean, largest"]
    header += ["99th percentile, median", "largest", "below the threshold"]
    out = []
    for order in dict.fromkeys(row.order for row in rows):
        of = [row for row in rows if row.order == order]
        cells = [order]
        for value in (_error, _mean, _percentile):
            values = [value(row) for row in of]
            cells += [f"{np.median(values):.4f}", f"{max(values):.4f}"]
        below = sum(holds(row.model, thresholds) for row in of)
        out.append([*cells, f"{below} of {len(of)}"])
    return table(header, out)


def _at_default(rows: list, thresholds) -> str:
    header = [
        "material",
        "scene",
        "error",
        "mean",
        "99th percentile",
        "noise, mean",
        "99th percentile",
        "below",
    ]
    out = []
    for row in rows:
        if row.order != DEFAULT:
            continue
        seen = [f"{value:.4f}" for seen in (row.model, row.noise) for value in (seen.mean, seen.percentile)]
        below = "yes" if holds(row.model, thresholds) else "no"
        out.append([row.material, row.scene, f"{_error(row):.4f}", *seen, below])
    return table(header, out)


def _draw(path: Path, rows: list, thresholds) -> None:
    panels = {}
    for material in dict.fromkeys(row.material for row in rows):
        of = [row for row in rows if row.material == material]
        panels[material] = {"mean": _worst(of, _mean), "99th percentile": _worst(of, _percentile)}
    names = ("relative L2 of the fit", "FLIP")
    plots.curves_by_panel(path, panels, names, [thresholds.mean, thresholds.percentile])


def _worst(rows: list, value: Callable) -> list[tuple[float, float]]:
    errors = sorted({_error(row) for row in rows})
    return [(error, max(value(row) for row in rows if _error(row) == error)) for error in errors]


def _error(row) -> float:
    return row.fit["relative_l2"]


def _mean(row) -> float:
    return row.model.mean


def _percentile(row) -> float:
    return row.model.percentile


def _count(rows: list, name: str) -> int:
    return len({getattr(row, name) for row in rows})


def _csv(rows: list, conditions: dict) -> str:
    header = [
        "material",
        "scene",
        "tolerance",
        "max_lobes",
        "relative_l2",
        "flip_mean",
        "flip_99",
        "noise_mean",
        "noise_99",
    ]
    out = [[name, value, *[""] * 7] for name, value in conditions.items()]
    for row in rows:
        noise = [row.noise.mean, row.noise.percentile] if row.noise else ["", ""]
        seen = [row.model.mean, row.model.percentile]
        out.append(
            [row.material, row.scene, row.order.tolerance, row.order.lobes, _error(row), *seen, *noise]
        )
    return csv_text(header, out)
