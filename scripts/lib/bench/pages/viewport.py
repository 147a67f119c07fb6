"""How long the rendered viewport of the real Blender takes to show a change, on a virtual screen, and whether
its memory grows when it is switched off and on. Leave the machine idle meanwhile.

Only a run of all scenes writes the page.
"""

from __future__ import annotations

import statistics

from .. import blender, project
from ..run import Run

SCENES = {
    "monkey": "a monkey of 31 thousand triangles in a measured paint, under a picture of a sky",
    "objects": "5 million triangles in 500 objects, each with a mesh of its own",
    "instances": "100,000 instances of a sphere of 992 triangles",
}
SETTINGS = {
    "restarts": (1000, 10),
    "blender": ("blender", "blender"),  # path
    "scenes": (tuple(SCENES), ("monkey",)),
}
PAGES = {"viewport.md": "viewport"}
SEEN, EXPORT, HELD = 0.2, 3.0, 0.05  # targets in seconds
SCREEN = (1400, 1000)


def measure(run: Run) -> dict:
    own = run.settings
    if len(own.scenes) < len(SCENES):
        run.output = run.work / "part"  # it must not replace the page
    load, results = project.busy_threads(), {}
    for scene in own.scenes:
        print(f"{scene} ...", flush=True)
        task = {"scene": scene, "restarts": own.restarts if scene == "monkey" else 0}
        how = (task, run.work / scene, SCREEN, own.blender)
        results[scene] = blender.in_window("bench.inside.viewport", *how)
    return {"conditions": run.conditions(load=load, seed=0), "results": results}


def values(found: dict) -> dict:
    results = found["results"]
    first = next(iter(results.values()))
    restarts, real_time = (
        [result[key] for result in results.values() if key in result] for key in ("restarts", "real_time")
    )
    for each in restarts:
        each["memory"] = ", ".join(f"{mib:.0f}" for mib in each["mib"])
    for each in real_time:
        seconds = statistics.median(each["seconds"])
        each |= {"milliseconds": 1000 * seconds, "rate": 1 / seconds}
    return {key: first[key] for key in ("blender", "size", "samples")} | {
        "busy": project.busy(found["conditions"]["load"]),
        "seen": SEEN,
        "export": EXPORT,
        "held": 1000 * HELD,
        "scenes": "\n".join(f"- {scene}: {SCENES[scene]}" for scene in results),
        "names": " | ".join(results),
        "changes": _changes(list(results.values())),
        "restarts": restarts,
        "real_time": real_time,
    }


def _changes(results: list[dict]) -> list[dict]:
    """A row per change with a cell per scene; then images a second, and memory."""
    rows = {name: [_cell(result["changes"][name]) for result in results] for name in results[0]["changes"]}
    rows["images a second while an object moves"] = [f"{result['dragged']:.1f}" for result in results]
    rows["memory of Blender, MiB"] = [f"{result['mib']:.0f}" for result in results]
    return [{"name": name, "cells": " | ".join(cells)} for name, cells in rows.items()]


def _cell(runs: list[dict]) -> str:
    seen, export, held = (statistics.median(run[key] for run in runs) for key in ("seen", "export", "held"))
    is_first = len(runs) == 1
    parts = (
        _marked(f"{seen:.2f}", not is_first and seen > SEEN),
        _marked(f"{export:.3f}", is_first and export > EXPORT),
        _marked(f"{1000 * held:.0f}", held > HELD),
    )
    return " / ".join(parts)


def _marked(text: str, is_missed: bool) -> str:
    return f"**{text}**" if is_missed else text
