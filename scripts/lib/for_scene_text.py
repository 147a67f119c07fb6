"""Writes the generated part of docs/results/for_scene.md and its CSV from scripts/for_scene."""

from __future__ import annotations

import math
from pathlib import Path

import provenance
from generated import replaced
from markdown_table import table
from table_csv import csv_text
from velour.core import files


def write(pages: Path, folder: Path, rows: list, conditions: dict, extent) -> None:
    part = _part(rows, conditions, extent)
    page = (pages / "for_scene.md").read_text(encoding="utf-8")
    files.write_text(folder / "for_scene.md", replaced(page, "for_scene", part, "for_scene"))
    files.write_text(folder / "for_scene.csv", _csv(rows, conditions))


def _part(rows: list, conditions: dict, extent) -> str:
    width, height = extent.size
    smaller = sum(_saving(row) >= 3 for row in rows)
    as_good = sum(_excess(row) <= 0 for row in rows)
    refused = sum(min(row.outside["moved camera"], row.outside["small sun"]) > 1e-3 for row in rows)
    return f"""{provenance.sentence(conditions)}
All numbers are also in [for_scene.csv](for_scene.csv).

A flat patch seen from 30 to 50 degrees under a dim dome with a bright patch of some 40 degrees' radius.
**Parameters shrink at least three times for {smaller} of {len(rows)} materials; the relmse of the picture
is at most 1.1 times the full model's for {as_good} of {len(rows)}{_within(rows)};
both other pictures are found to be outside for {refused} of {len(rows)}.**

Bytes of the parameters and lobes, full and reduced; seconds of the reduction, the full model being there.
relmse of pictures against the measurement's, {width}x{height}, {extent.spp} samples: products of two
independent differences in the place of squares, so that noise adds nothing on average; +- one standard error.

{_sizes(rows)}
What `velour render` says of the share of a picture that lies outside of the reduced model's domain: of the
same picture, from a camera that was moved to about 75 degrees, and under a sky with a sun of half a degree.
Above 0.1 % it warns and takes the full model.

{_shares(rows)}"""


def _excess(row) -> float:
    return row.reduced_error.relmse - 1.1 * row.full_error.relmse


def _within(rows: list) -> str:
    """How many of the materials above the bound may be there by chance."""
    above = [row for row in rows if _excess(row) > 0]
    near = sum(_excess(row) <= 2 * _deviation(row) for row in above)
    return f" (and within two standard errors of that for {near} more)" if near else ""


def _deviation(row) -> float:
    return math.hypot(row.reduced_error.standard_error, 1.1 * row.full_error.standard_error)


def _saving(row) -> float:
    return row.full["parameter_bytes"] / row.reduced["parameter_bytes"]


def _sizes(rows: list) -> str:
    header = ["material", "bytes", "reduced", "saving", "lobes", "reduced", "seconds"]
    header += ["relmse of the full model", "of the reduced one"]
    out = []
    for row in rows:
        sizes = [row.full["parameter_bytes"], row.reduced["parameter_bytes"], f"{_saving(row):.1f}"]
        lobes = [row.full["lobes"], row.reduced["lobes"], f"{row.reduced['seconds']:.1f}"]
        errors = [f"{e.relmse:.1e} +- {e.standard_error:.0e}" for e in (row.full_error, row.reduced_error)]
        out.append([row.material, *sizes, *lobes, *errors])
    return table(header, out)


def _shares(rows: list) -> str:
    names = list(rows[0].outside)
    out = [[row.material, *(f"{row.outside[name]:.2%}" for name in names)] for row in rows]
    return table(["material", *names], out)


def _csv(rows: list, conditions: dict) -> str:
    names = list(rows[0].outside)
    sizes = ("parameter_bytes", "lobes", "seconds")
    header = ["material", *(f"{model}_{size}" for model in ("full", "reduced") for size in sizes)]
    header += ["full_relmse", "full_error", "reduced_relmse", "reduced_error", *names]
    out = [[name, value, *[""] * (len(header) - 2)] for name, value in conditions.items()]
    for row in rows:
        fits = [report[size] for report in (row.full, row.reduced) for size in sizes]
        errors = [v for e in (row.full_error, row.reduced_error) for v in (e.relmse, e.standard_error)]
        out.append([row.material, *fits, *errors, *(row.outside[name] for name in names)])
    return csv_text(header, out)
