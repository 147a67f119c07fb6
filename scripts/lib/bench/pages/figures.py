"""The dissertation's figures 7.11 to 7.13: its strategy and numbers of samples, compared with references."""

from __future__ import annotations

import numpy as np

from .. import charts, page
from ..reference import Reference, fit_error
from ..run import Picture, Run
from ..scenes import SUNSET, Subject, subjects

CSV = "figures/figures.csv"
PAGES = {"figures/README.md": "figures"}
SETTINGS = {
    "size": ((640, 480), (96, 72)),
    "spp": ((200, 400, 600, 800, 1000), (8, 32)),
    "batch_spp": (2048, 64),
    "batches": (4, 2),  # initial number of renders of a reference
    "most_batches": (24, 3),
    "floor_renders": (4, 2),  # renders each of model and measurement, for the fit's error
    "floor_spp": (128, 16),
}
# Half of the directions from the environment, with the dissertation's densities and random numbers or ours.
HALF = {"heuristic": "balance", "share": 0.5}
SAMPLERS = {"dissertation": HALF | {"strategy": "mis-dissertation"}, "default": HALF | {"strategy": "mis"}}
BEST = {"strategy": "product"}
# Minimum ratio of the smallest error of the dissertation's strategy to the reference's own error.
MARGIN = 10.0
_WORST = 0.2  # relative error at which the brightness saturates


def measure(run: Run) -> dict:
    own, rows, sheet = run.settings, [], []
    shown = subjects(run)
    for _ in shown:
        for spp in own.spp:
            run.expect(spp, count=len(SAMPLERS))
        run.expect(own.batch_spp, count=own.batches)
        run.expect(own.floor_spp, count=2 * own.floor_renders)
    for subject in shown:
        figure_rows, figure_sheet = _figure(run, subject)
        rows += figure_rows
        sheet += figure_sheet
    charts.sheet(run.output / "figures/contact_sheet.png", sheet, (2.6, 2.25))
    return {"conditions": run.conditions(), "rows": rows}


def _figure(run: Run, subject: Subject) -> tuple[list[dict], list]:
    """The rows of a figure, and its two rows of the contact sheet."""
    own, scene = run.settings, subject.scene(SUNSET, run.data)
    measured = scene.measured(subject.measurement)
    pictures = {
        (sampler, spp): run.render(scene, spp, **options)
        for sampler, options in SAMPLERS.items()
        for spp in own.spp
    }
    reference = Reference(run, measured, own.batch_spp, **BEST).add(own.batches)
    seeds = range(run.seed, run.seed + own.floor_renders)
    pairs = [[run.render(s, own.floor_spp, seed=k, **BEST).pixels for s in (scene, measured)] for k in seeds]
    differences = np.array([np.subtract(*pair) for pair in pairs])
    errors = _converge(pictures, reference, own.most_batches)
    reference.save(run.work / f"reference-{subject.figure}")
    mean, floor = reference.mean(), fit_error(differences, reference.mean())
    figure = {"figure": f"{subject.figure} {subject.name}"}
    rows = [
        {**figure, "what": "picture", "sampler": sampler, "spp": spp, **_errors(found)}
        | {"seconds": pictures[sampler, spp].seconds, "renders": 1}
        for (sampler, spp), found in errors.items()
    ]
    rows.append({**figure, "what": "fit", **_errors(floor)})
    noise = {"what": "reference's noise", "spp": reference.spp, **_errors(reference.noise())}
    rows.append({**figure, **noise, "seconds": reference.seconds, "renders": len(reference.pictures)})
    above, below = [], []
    for spp in own.spp:
        pixels = pictures["dissertation", spp].pixels
        ours, theirs = (errors[sampler, spp][1] for sampler in ("default", "dissertation"))
        above.append((f"{subject.name}, {spp} spp", charts.display(pixels)))
        below.append((f"relmse {theirs:.2e}; default {ours:.2e}", _relative(pixels, mean)))
    above.append((f"measured, {reference.spp} spp", charts.display(mean)))
    below.append((f"the fit's: {floor[1]:.2e}", _relative(mean + differences.mean(axis=0), mean)))
    return rows, [above, below]


def _errors(found: tuple[float, float]) -> dict:
    return dict(zip(("rmse", "relmse"), found, strict=True))


def _converge(pictures: dict[tuple, Picture], reference: Reference, most: int) -> dict[tuple, tuple]:
    """Adds renders to the reference until its error is small beside the dissertation's. Returns errors."""
    while True:
        mean = reference.mean()
        errors = {name: picture.errors(mean) for name, picture in pictures.items()}
        smallest = min(rmse for (sampler, _), (rmse, _) in errors.items() if sampler == "dissertation")
        margin = smallest / reference.noise()[0]
        print(
            f"    reference of {reference.spp} spp: the smallest error is {margin:.1f} times its own",
            flush=True,
        )
        if margin >= MARGIN or len(reference.pictures) >= most:
            return errors
        reference.add()


def _relative(pixels: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """Error of the channels' sum, relative to the reference and a tenth of its mean, as in relmse."""
    x, r = pixels.sum(axis=-1), reference.sum(axis=-1)
    return charts.colored(np.abs(x - r) / np.sqrt(r**2 + 0.01 * r.mean() ** 2), "inferno", 0, _WORST)


def values(found: dict) -> dict:
    figures: dict[str, list[dict]] = {}
    for row in found["rows"]:
        figures.setdefault(row["figure"], []).append(row)
    samplers = list(dict.fromkeys(row["sampler"] for row in found["rows"] if row["sampler"]))
    titles = " | ".join(f"relmse {s} | rmse {s}" for s in samplers)
    lines = [line for rows in figures.values() for line in _lines(rows, samplers)]
    references = [_reference(rows, samplers) for rows in figures.values()]
    return {"titles": titles, "samplers": samplers, "lines": lines, "references": references}


_CELLS = "{relmse:.2e} | {rmse:.2e}"


def _lines(rows: list[dict], samplers: list[str]) -> list[dict]:
    """Lines of the fewest and the most samples, then one of the fit's error."""
    pictures = [row for row in rows if row["what"] == "picture"]
    counts, lines = [row["spp"] for row in pictures], []
    for spp in dict.fromkeys((min(counts), max(counts))):
        own = {row["sampler"]: page.fields(_CELLS, row) for row in pictures if row["spp"] == spp}
        cells = " | ".join(own[sampler] for sampler in samplers)
        lines.append({"figure": rows[0]["figure"], "spp": spp, "cells": cells})
    (fit,) = (page.fields(_CELLS, row) for row in rows if row["what"] == "fit")
    cells = " | ".join([fit] * len(samplers))
    return [*lines, {"figure": f"{rows[0]['figure']}: the fit's error", "spp": None, "cells": cells}]


def _reference(rows: list[dict], samplers: list[str]) -> dict:
    (noise,) = (row for row in rows if row["what"] == "reference's noise")
    smallest = [min(row["rmse"] for row in rows if row["sampler"] == sampler) for sampler in samplers]
    ratios = [rmse / noise["rmse"] for rmse in smallest]
    return noise | {"smallest": smallest, "ratios": ratios, "met": page.verdict(ratios[0] >= MARGIN)}
