"""Writes docs/results/figures/README.md and figures.csv from the numbers of scripts/figures."""

from __future__ import annotations

from pathlib import Path

import provenance
from markdown_table import small, table
from table_csv import csv_text
from velour.core import files

SAMPLERS = ("dissertation", "default")


def write(folder: Path, figures: list, conditions: dict, extent) -> None:
    files.write_text(folder / "README.md", _page(figures, conditions, extent))
    files.write_text(folder / "figures.csv", _csv(figures, conditions))


def _page(figures: list, conditions: dict, extent) -> str:
    width, height = extent.size
    return f"""# The dissertation's figures

Written by `scripts/figures`; the rows behind the tables are in [figures.csv](figures.csv).
{provenance.sentence(conditions)}

Figures 7.11 to 7.13 of the dissertation, {width}x{height}, default camera, `venice_sunset`, direct
light: half of the light directions from the fitted model, half from the environment, balance
heuristic. Suzanne stands in for the Venus, which is not to be had. Nickel and
blue-metallic-paint are decoded from neural fits of MERL materials: stand-ins; Krylon Blue is the
measurement.

![Contact sheet](contact_sheet.png)

Upper rows: the scattered model, sampled as in the dissertation; last, the reference: the measurement
itself. Lower rows: the difference from the reference relative to it, black 0, brightest 20 %
and more; last, what the fit alone is off by.

## Errors

Against the reference. `dissertation` (strategy `mis-dissertation`): the densities of the four nearest
views, interpolated, a lobe by its share, its zenith by closed-form inversion where the dissertation has
Metropolis and Hastings' method, independent numbers. `default` (`mis`): tables of the model, Sobol
points. The pictures show the model, the reference the measurement, so errors do not fall below the fit's
own: the last row of each figure. Seconds are wall clock, of a machine that may have done other work:
[performance.md](../performance.md) has those of a free one.

{_errors(figures)}
## References

The measurement itself is evaluated; the best unbiased strategy, `product`, draws the directions, by the
model's lobes. Mean of independent renders; their spread gives each pixel's standard error (a picture
beside the reference in `build/figures`). Its RMS is to be under a tenth of the smallest RMSE of the
dissertation's strategy; renders are added until it is, up to {extent.batches[1]}. `default` errs less, and
the reference's error is a larger part of what is measured.

{_references(figures)}
Whether the dissertation's own reference, uniform samples, agrees with this strategy: [check.md](check.md).
"""


def _errors(figures: list) -> str:
    header = [
        "figure",
        "spp",
        *(f"{what} {s}" for s in SAMPLERS for what in ("relmse", "rmse", "seconds")),
    ]
    rows = []
    for figure in figures:
        for spp in sorted({spp for _, spp in figure.pictures}):
            cells = [_cells(figure, sampler, spp) for sampler in SAMPLERS]
            rows.append([_name(figure), spp, *cells[0], *cells[1]])
        rmse, relmse = map(small, figure.floor)
        rows.append([f"{_name(figure)}: the fit's error", "", relmse, rmse, "", relmse, rmse, ""])
    return table(header, rows)


def _cells(figure, sampler: str, spp: int) -> list[str]:
    rmse, relmse = figure.errors[sampler, spp]
    return [small(relmse), small(rmse), f"{figure.pictures[sampler, spp].report['seconds']:.1f}"]


def _references(figures: list) -> str:
    header = [
        "figure",
        "spp",
        "renders",
        "seconds",
        "RMS standard error",
        "smallest RMSE, dissertation",
        "ratio",
        "at least 10",
        "smallest RMSE, default",
        "ratio",
    ]
    rows = []
    for figure in figures:
        reference = figure.reference
        numbers = [
            reference.spp,
            len(reference.pictures),
            f"{reference.seconds:.0f}",
            small(reference.noise()[0]),
        ]
        ours, theirs = ([small(figure.smallest(s)), f"{figure.margin(s):.1f}"] for s in reversed(SAMPLERS))
        met = "met" if figure.margin("dissertation") >= 10 else "missed"
        rows.append([_name(figure), *numbers, *theirs, met, *ours])
    return table(header, rows)


def _name(figure) -> str:
    return f"{figure.subject.figure} {figure.subject.name}"


def _csv(figures: list, conditions: dict) -> str:
    header = ["figure", "what", "sampler", "spp", "rmse", "relmse", "seconds"]
    rows = [["", name, "", "", "", "", value] for name, value in conditions.items()]
    for figure in figures:
        number, reference = figure.subject.figure, figure.reference
        for (sampler, spp), errors in figure.errors.items():
            seconds = figure.pictures[sampler, spp].report["seconds"]
            rows.append([number, "picture", sampler, spp, *errors, seconds])
        rows.append([number, "fit", "", "", *figure.floor, ""])
        rows.append([number, "reference's noise", "", reference.spp, *reference.noise(), reference.seconds])
    return csv_text(header, rows)
