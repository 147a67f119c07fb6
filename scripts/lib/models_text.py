"""Writes models.md of docs/results, its CSV, and the generated tables of fit.md, ggx.md and principled.md."""

from __future__ import annotations

import statistics
from pathlib import Path

import models_tables
import provenance
from generated import replaced
from markdown_table import table
from model_runs import Result
from models_targets import NO_NOISE, met
from table_csv import csv_text
from velour.core import files

_ANGLES = models_tables.ANGLES
# Targets of the parametric model, in the columns of the summary.
TARGETS = ["*target*", "", "all", "", "2700", "2.00", "60", "120", "30", "60"]


def write(pages: Path, output: Path, results: list[Result], floor: dict, conditions: dict) -> None:
    """Copies the pages of the folder `pages` with new generated parts to `output`, and writes the CSV."""
    parts = {
        "models": _models(results, floor, conditions),
        "fit": f"{provenance.sentence(conditions)}\n\n{models_tables.scattered(results)}",
        "ggx": f"{provenance.sentence(conditions)}\n\n{models_tables.ggx(results)}",
        "principled": f"{provenance.sentence(conditions)}\n\n{models_tables.principled(results)}",
    }
    for name, part in parts.items():
        page = (pages / f"{name}.md").read_text(encoding="utf-8")
        files.write_text(output / f"{name}.md", replaced(page, name, part))
    files.write_text(output / "models/models.csv", _csv(results, floor, conditions))


def _models(results: list[Result], floor: dict, conditions: dict) -> str:
    return f"""{provenance.sentence(conditions)}
The rows behind tables and curves are in [models/models.csv](models/models.csv).

## All of them

Medians of {len(results)} materials. The target of an error is 2 % up to 75 degrees and 4 % at 85, or the
measurement's own noise where that is larger: `met` counts the views that meet it, of all that are covered,
`without noise` those that meet the plain percentages. The last row is what an isotropic model is asked for.

{_summary(results)}
## Errors

Relative L2 at the held-out views, **bold** where it meets the target. `noise` is what the measurement says of
its own, from mirror images and reciprocal pairs. In MERL's layout it is all of the first kind: the networks
behind the stand-ins are not symmetric, and a symmetric model is off by at least noise / sqrt(2). In RGL's
files it is all of the second: the tables are not reciprocal. A model that is not reciprocal either can follow
them, so there it is a generous bound. The Principled material cannot do without its rise to full reflection
at grazing angles, which the stand-ins of metals do not show: hence its errors at 85 degrees.

{models_tables.errors(results)}
## Size, fit, evaluation

Bytes of the file, and of the parameters alone: a peer has no file. Seconds of the fit, without
reading the measurement{_neighbors(conditions["load"])}.

Nanoseconds on one core, random views and lights, everything in cache, the least of many runs: `f`, one
view and one light a call; `sample, pdf`, one direction drawn at one view, with its density and f; `16`: one
view with 16 lights, or 16 directions drawn, a call, per light. {_floor(floor)}
A measurement's table of many megabytes is in cache only where it was just asked.

{models_tables.costs(results)}
## Error against lobes

Fits that only `--max-lobes` ends. A lobe of the scattered model counts in each of its views; a renderer
evaluates those of two. The GGX peer has one lobe, the Principled material two. Relative L2 over the views;
dotted: the default tolerance.

![Error against lobes](models/error_by_lobes.png)

## Error against bytes

Fits with the default tolerance under `--bytes`, the whole file; bounds that no model of a material fits into
are left out. Peers by their parameters alone.

![Error against bytes](models/error_by_bytes.png)
"""


def _neighbors(load: float) -> str:
    if load < 0.2:
        return ""
    return f"; **other programs kept {load:.1f} processors busy**, so they are too many"


def _floor(floor: dict) -> str:
    if not floor:
        return "They need `evaluation_cost`, which was not built."
    one, many = ([f"{floor[key + number]:.1f}" for key in ("f", "sample_pdf")] for number in ("", "_16"))
    return f"The calls alone, without\narithmetic, take {' and '.join(one)} ns, {' and '.join(many)} with 16."


def _summary(results: list[Result]) -> str:
    numbers = ["relative_l2", "met", "without noise", "parameter bytes", "seconds"]
    rows = [_summary_row(model, results) for model in results[0].rows]
    return table(["model", *numbers, *models_tables.COST_NAMES], [*rows, TARGETS])


def _summary_row(model: str, results: list[Result]) -> list[str]:
    def median(key: str, digits: int) -> str:
        return f"{statistics.median(result.rows[model].report[key] for result in results):.{digits}f}"

    errors = [result.rows[model].report["by_view_angle"] for result in results]
    covered = sum(error is not None for of in errors for error in of.values())
    good = sum(met(of, result.noise) for of, result in zip(errors, results, strict=True))
    plain = sum(met(of, NO_NOISE) for of in errors)
    costs = [result.rows[model].cost for result in results]
    nanoseconds = {
        key: statistics.median(cost[key] for cost in costs) for key in models_tables.COSTS if all(costs)
    }
    views = [f"{good} of {covered}", str(plain)]
    sizes = [median("parameter_bytes", 0), median("seconds", 2)]
    return [model, median("relative_l2", 4), *views, *sizes, *models_tables.nanoseconds(nanoseconds)]


def _csv(results: list[Result], floor: dict, conditions: dict) -> str:
    costs = list(models_tables.COSTS)
    sizes = ("relative_l2", "lobes", "bytes", "parameter_bytes", "seconds")
    header = ["material", "model", "bound", "value", *sizes, *(f"error_{a}" for a in _ANGLES), *costs]
    rows = [["", "", name, value] for name, value in conditions.items()]
    rows.append(
        ["", "floor", "", "", *[""] * (len(sizes) + len(_ANGLES)), *(floor.get(key, "") for key in costs)]
    )
    for result in results:

        def add(model: str, bound: str, value, report: dict, cost: dict, name=result.name) -> None:
            errors = [report["by_view_angle"][angle] for angle in _ANGLES]
            own = [report.get(key, "") for key in sizes]
            rows.append([name, model, bound, value, *own, *errors, *(cost.get(key, "") for key in costs)])

        add("noise", "", "", {"by_view_angle": result.noise}, {})
        raw = {"by_view_angle": dict.fromkeys(_ANGLES), "bytes": result.bytes}
        add("measurement", "", "", raw, result.cost)
        for model, row in result.rows.items():
            add(model, "", "", row.report, row.cost)
        add("scattered, unturned", "", "", result.unturned, {})
        for bound, curves in (("max-lobes", result.lobes), ("bytes", result.sizes)):
            for model, points in curves.items():
                for value, report in points.items():
                    add(model, bound, value, report, {})
    return csv_text(header, rows)
