"""Ways to store the view-dependent occlusion of tiles: their errors and costs."""

from __future__ import annotations

import json
import subprocess
import zlib
from typing import NamedTuple

from .. import page
from ..run import BUILT, Run

SETTINGS = {"texels": (256, 64), "views": (300, 100), "unseen": (64, 16)}
_PROGRAM = BUILT / "bench/occlusion_tables"


class Case(NamedTuple):
    """The default net is periodic within its tile, which favors tables; the irregular one is not."""

    tile: str
    irregularity: float
    texels: int
    views: int
    unseen: int


def measure(run: Run) -> dict:
    own, results = run.settings, []
    size = (own.texels, own.views, own.unseen)
    for case in (Case("net", 0, *size), Case("net", 0.5, 64, 100, 16), Case("chainmail", 0, *size)):
        label = f"{case.tile}, irregularity {case.irregularity:g}"
        parameters = {"case": case, "seed": run.seed, "program": _PROGRAM}
        make = lambda case=case: _compared(run, case)  # noqa: E731
        results.append(run.keep(label, "tables", parameters, make, case.texels**2 * case.views))
    return {"conditions": run.conditions(), "results": results}


def _compared(run: Run, case: Case) -> dict:
    run.kept.joinpath("tables").mkdir(exist_ok=True)
    words = [_PROGRAM, *map(str, case), str(run.seed), run.kept / "tables"]
    result = json.loads(subprocess.run(words, check=True, stdout=subprocess.PIPE).stdout)
    for i, candidate in enumerate(result["candidates"]):
        stored = run.kept / f"tables/{i}.bin"
        candidate["packed"] = len(zlib.compress(stored.read_bytes(), 9))
        stored.unlink()
    return result


def write(run: Run, found: dict) -> None:
    results = found["results"]
    values = {"distances": _distances(results), "tables": _tables(results)}
    page.write(run.output, "votf_tables.md", page.text("votf_tables", found["conditions"] | values))


def _title(result: dict) -> str:
    irregular = f", irregularity {result['irregularity']:g}" if result["irregularity"] else ""
    return result["tile"] + irregular


def _distances(results: list[dict]) -> str:
    """What Velour keeps, at the resolution of the texels, a row per tile; bold where it misses a target."""
    rows = []
    for result in results:
        ours, linear = result["candidates"][-1], result["candidates"][0]
        share = ours["unseen"]["wrong"] / max(linear["unseen"]["wrong"], 1e-12)
        numbers = {
            "mb": (ours["packed"] / 1e6, lambda mb: mb < 1),
            "wrong": (100 * ours["stored"]["wrong"], lambda wrong: wrong <= 1),
            "border": (ours["stored"]["border"], lambda border: border <= 0.5),
            "share": (share, lambda share: share <= 0.5),
            "rate": (1e3 / ours["nanoseconds"]["any"], lambda rate: rate >= 20),
        }
        shown = {k: f"{v:.{1 if k == 'rate' else 2}f}" for k, (v, _) in numbers.items()}
        shown |= {k: f"**{shown[k]}**" for k, (v, is_met) in numbers.items() if not is_met(v)}
        rows.append(result | {"title": _title(result)} | shown)
    return (
        page.table(
            rows,
            "tile | texels | views | mean V | MB | wrong, % | border | of linear | million look-ups a second",
            "{title} | {texels} | {views} | {mean:.2f} | {mb} | {wrong} | {border} | {share} | {rate}",
        )
        + "| *target* |  |  |  | 1 | 1 | 0.5 | 0.5 | 20 |\n"
    )


def _tables(results: list[dict]) -> str:
    """A row per way to keep V: errors at unseen views, bytes, and the time of a look-up in the first tile."""
    rows, last = [], len(results[0]["candidates"]) - 1
    for candidates in zip(*(result["candidates"] for result in results), strict=True):
        # The resolution of the last two depends on the texels of the tile.
        name = candidates[0]["name"]
        name = {last - 1: "distances in the shell, half as fine", last: "distances in the shell"}.get(
            len(rows), name
        )
        cells = (f"{100 * c['unseen']['wrong']:.2f} | {c['packed'] / 1e3:,.0f}" for c in candidates)
        rows.append(candidates[0] | {"name": name, "cells": " | ".join(cells)})
    titles = " | ".join(f"{_title(result)} | kB" for result in results)
    return page.table(rows, f"kept | {titles} | ns", "{name} | {cells} | {nanoseconds[any]:.0f}")
