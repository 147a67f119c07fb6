"""The text of docs/results/measurements.md from the numbers of scripts/measure."""

from __future__ import annotations

import provenance
from markdown_table import error, small, table

ANGLES = ("5", "30", "60", "75", "85")


def page(results: dict) -> str:
    """The whole page."""
    parts = (_head(results["conditions"]), _fits(results["fits"]), _render(results["render"]))
    return "\n".join([*parts, _lobes(results["lobes"]), _strategies(results["strategies"])])


def _head(c: dict) -> str:
    return f"""# Measurements

Written by `scripts/measure`; the rows behind the tables are in [measurements.csv](measurements.csv).
{provenance.sentence(c)}

The materials are decoded from neural fits of MERL materials (Sztrajman et al. 2021): stand-ins of the
right layout and character, not the measurements themselves. What each number means is defined in
[conventions.md](../engine/conventions.md).
"""


def _fits(fits: dict[str, dict]) -> str:
    header = ["material", "seconds", "lobes", "bytes", "relative_l2", *(f"{a}°" for a in ANGLES)]
    rows = [
        [name, f"{r['seconds']:.1f}", r["lobes"], r["bytes"], error(r["relative_l2"]), *_errors(r)]
        for name, r in fits.items()
    ]
    missed = [f"- {name}: {warning}" for name, r in fits.items() for warning in r["warnings"]]
    named = "\n".join(missed) if missed else "No view misses the tolerance."
    return f"""## Fit of MERL-layout materials

Tolerance 0.02 (0.04 beyond 75 degrees), at most 16 lobes a view, Gaussian kernel. Relative L2 error by
view angle at directions that the fit never read. Target: under 10 s.

{table(header, rows)}
![Error by view angle](images/error_by_view_angle.png)

{named}
"""


def _render(report: dict) -> str:
    share = report["ray_share"]
    rows = [
        ["seconds (tracing and shading)", f"{report['seconds']:.1f}", "under 60"],
        ["samples per second", f"{report['samples_per_second'] / 1e6:.2f} million", ""],
        ["ray_share", "-" if share is None else f"{share:.2f}", "at least 0.3"],
        ["rays", f"{report['rays'] / 1e6:.0f} million", ""],
        ["samples that were not finite", report["nan_samples"], "0"],
    ]
    stages = ", ".join(f"{name} {seconds:.2f} s" for name, seconds in report["stages"].items())
    return f"""## Bunny, blue-metallic-paint, venice_sunset

640x480, 800 light directions a pixel, split 8, `mis`, default camera, direct light.

{table(["quantity", "measured", "target"], rows)}
Stages: {stages}.
"""


def _lobes(lobes: dict[int, dict]) -> str:
    header = [
        "lobes a view",
        "fit seconds",
        "bytes",
        "relative_l2",
        "relmse of the picture",
        "rmse",
        "seconds",
        "raw seconds",
    ]
    rows = [
        [
            n,
            f"{r['fit']['seconds']:.1f}",
            r["fit"]["bytes"],
            error(r["fit"]["relative_l2"]),
            small(r["relmse"]),
            small(r["rmse"]),
            f"{r['seconds']:.1f}",
            f"{r['reference_seconds']:.1f}",
        ]
        for n, r in lobes.items()
    ]
    return f"""## Picture of the model against the picture of the measurement, by lobes

The same scene at 320x240, 512 light directions a pixel, `mis`. The reference evaluates the raw measurement
on the very same light directions, drawn from the model, so noise cancels and what is left is the model's
error. Lobes: a view, at most.

{table(header, rows)}"""


def _strategies(scenes: dict[str, dict]) -> str:
    header = ["strategy", "seconds", "relmse", "relmse of mis / its own", "relmse x seconds", "ray_share"]
    tables = [f"{name}:\n\n{table(header, _strategy_rows(rows))}" for name, rows in scenes.items()]
    return f"""## Strategies

The bunny at 320x240, 64 light directions a pixel, split 8, models of at most 16 lobes a view, against a
`mis` render of the same model with 8192 of another seed. Relmse x seconds: lower is better, whatever the
number of samples. Seconds are tracing and shading; fits before the first pass (`ggx`, the sky of
`product`) are stages of their own, in the CSV.

{chr(10).join(tables)}"""


def _strategy_rows(strategies: dict[str, dict]) -> list[list]:
    mis = strategies["mis"]["relmse"]
    rows = []
    for name, r in strategies.items():
        share = "-" if r["ray_share"] is None else f"{r['ray_share']:.2f}"
        numbers = [small(r["relmse"]), f"{mis / r['relmse']:.2f}", small(r["relmse"] * r["seconds"])]
        rows.append([name, f"{r['seconds']:.2f}", *numbers, share])
    return rows


def _errors(report: dict) -> list[str]:
    return [error(report["by_view_angle"][angle]) for angle in ANGLES]
