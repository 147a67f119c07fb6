"""Writes docs/results/chart: a plot and a CSV per scene, and the page with the tables derived from them."""

from __future__ import annotations

from pathlib import Path

import chart_plot
import chart_tables as tables
import chart_targets
import provenance
from chart_result import Result
from peer_cycles import Throughput
from peer_mitsuba import Comparison
from synthetic_sky import SunLobes
from table_csv import csv_text
from velour.core import files


def write(folder: Path, results: list[Result], peers: dict, sun: SunLobes, conditions: dict, extent) -> None:
    for result in results:
        chart_plot.draw(folder / f"{result.scene.file_name}.png", result)
        files.write_text(folder / f"{result.scene.file_name}.csv", csv_text(*_rows(result, conditions)))
    verdicts = chart_targets.verdicts(results, sun, peers["mitsuba"], extent.equal_spp)
    files.write_text(folder / "targets.csv", csv_text(*_target_rows(verdicts)))
    if not isinstance(peers["mitsuba"], str):
        files.write_text(folder / "mitsuba.csv", csv_text(*_mitsuba_rows(peers["mitsuba"])))
    files.write_text(folder / "README.md", _page(results, peers, sun, verdicts, conditions, extent))


def _rows(result: Result, conditions: dict) -> tuple[list, list[list]]:
    header = ["curve", "spp", "seed", "seconds", "rmse", "relmse"]
    rows = [["conditions", name, "", value, "", ""] for name, value in conditions.items()]
    noise = result.reference.noise()
    rows.append(["reference's noise", result.reference.spp, "", result.reference.seconds, *noise])
    for name, points in result.points.items():
        rows += [[name, p.spp, p.seed, p.seconds, max(p.mse, 0.0) ** 0.5, p.relmse] for p in points]
    return header, rows


def _target_rows(verdicts: list) -> tuple[list, list[list]]:
    return ["target", "where", "measured", "met"], [[v.target, v.where, v.measured, v.met] for v in verdicts]


def _mitsuba_rows(comparisons: list[Comparison]) -> tuple[list, list[list]]:
    header = ["material", "curve", "spp", "seed", "seconds", "rmse", "relmse"]
    return header, [
        [c.material, name, p.spp, p.seed, p.seconds, max(p.mse, 0.0) ** 0.5, p.relmse]
        for c in comparisons
        for name, points in c.points.items()
        for p in points
    ]


def _page(results: list[Result], peers: dict, sun: SunLobes, verdicts: list, conditions: dict, extent) -> str:
    parts = [
        _head(conditions, extent),
        *(_scene(result) for result in results),
        tables.targets(verdicts),
        tables.equal_error(results),
        tables.equal_time(results),
        tables.equal_samples(results, extent),
        tables.ggx(results),
        _sky(sun, results[-1]),
        tables.mitsuba(peers["mitsuba"], extent),
        _cycles(peers["cycles"]),
    ]
    return "\n".join(parts)


def _head(conditions: dict, extent) -> str:
    width, height = extent.size
    return f"""# Error against time

Written by `scripts/chart`; how to read it and how to take it on another machine:
[chart.md](../chart.md). Beside each picture lies the CSV of the same name; the targets are in
[targets.csv](targets.csv).
{provenance.sentence(conditions)}

{width}x{height}, default camera, direct light, split 8, models of at most 16 lobes a view. Errors are against
{extent.reference_batches} renders of the same model by `product` with {extent.reference_spp} light directions
each and other seeds; the noise of their mean, known from their spread, is subtracted. Seconds: tracing and
shading. `mis`, `mis-ggx` and `product`: means of {extent.seeds} seeds. "~": the curve's power law continued
beyond what was measured.
"""


def _scene(result: Result) -> str:
    noise = result.reference.noise()[1]
    return f"""![{result.scene.scene.name}]({result.scene.file_name}.png)

[CSV]({result.scene.file_name}.csv); relmse of the reference, which is subtracted: {noise:.1e}.
"""


def _sky(sun: SunLobes, result: Result) -> str:
    gain = result.gain("product", "mis", max(result.means("product")))
    return f"""## The small sun

The synthetic sky's sun is half a degree across and has 90 % of the energy. The mixture of `product` keeps
{sun.count} lobe(s) of it, {sun.diameter:.2f} degrees across, with {100 * sun.energy:.1f} % of the energy.
relmse of `product` / `mis` at {max(result.means("product"))} samples a pixel: {gain}.
"""


def _cycles(found: Throughput | str) -> str:
    text = found
    if not isinstance(found, str):
        text = f"""Cycles of Blender {found.version}, the bunny with the Principled material nearest to
blue-metallic-paint, direct light, no denoiser: {found.cycles / 1e6:.2f} million camera rays a second, each
with one direction of the material and one of the light. Velour with as much to do for each camera ray
(`mis`, split 2): {found.ours / 1e6:.2f} million. Materials differ, so this compares throughput alone."""
    return f"""## Cycles

{text}
"""
