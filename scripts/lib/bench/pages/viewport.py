"""How long the rendered viewport of the real Blender takes to show a change, on a virtual screen, and whether
its memory grows when it is switched off and on. Leave the machine idle meanwhile.

Only a run of all scenes writes the page.
"""

from __future__ import annotations

import json
import statistics

from .. import blender, page, provenance
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
SEEN, EXPORT, HELD = 0.2, 3.0, 0.05  # targets in seconds
SCREEN = (1400, 1000)


def measure(run: Run) -> dict:
    own = run.settings
    if len(own.scenes) < len(SCENES):
        run.output = run.work / "part"  # it must not replace the page
    load, results = provenance.busy_threads(), {}
    for scene in own.scenes:
        print(f"{scene} ...", flush=True)
        results[scene] = _measured(run, scene)
    return {"conditions": run.conditions(load=load, seed=0), "results": results}


def _measured(run: Run, scene: str) -> dict:
    folder = run.work / scene
    task = {"scene": scene, "restarts": run.settings.restarts if scene == "monkey" else 0}
    blender.in_window(blender.INSIDE / "viewport.py", task, folder, SCREEN, run.settings.blender)
    return json.loads((folder / "result.json").read_text())


def write(run: Run, found: dict) -> None:
    results, conditions = found["results"], found["conditions"]
    first, load = next(iter(results.values())), conditions["load"]
    values = {
        "blender": first["blender"],
        "size": first["size"],
        "samples": first["samples"],
        "busy": "" if load < 0.2 else f" **Other programs kept {load:.1f} processors busy.**",
        "seen": SEEN,
        "export": EXPORT,
        "held": f"{1000 * HELD:.0f}",
        "scenes": "\n".join(f"- {scene}: {SCENES[scene]}" for scene in results),
        "changes": _changes(results),
        "more": "".join(map(_more, results.values())),
    }
    part = page.text("viewport", conditions | values)
    page.write_parts(run.output, "viewport.md", "viewport", measured=part)


def _changes(results: dict[str, dict]) -> str:
    """A row per change and a column per scene; then images a second, and memory."""
    rows = [
        {"change": name, "cells": " | ".join(_cell(result["changes"][name]) for result in results.values())}
        for name in next(iter(results.values()))["changes"]
    ]
    for name, key, form in (
        ("images a second while an object moves", "dragged", ".1f"),
        ("memory of Blender, MiB", "mib", ".0f"),
    ):
        cells = " | ".join(f"{result[key]:{form}}" for result in results.values())
        rows.append({"change": name, "cells": cells})
    return page.table(rows, f"change | {' | '.join(results)}", "{change} | {cells}")


def _cell(runs: list[dict]) -> str:
    seen, export, held = (statistics.median(run[key] for run in runs) for key in ("seen", "export", "held"))
    is_first = len(runs) == 1
    parts = (
        _marked(f"{seen:.2f}", not is_first and seen > SEEN),
        _marked(f"{export:.3f}", is_first and export > EXPORT),
        _marked(f"{1000 * held:.0f}", held > HELD),
    )
    return " / ".join(parts)


def _more(result: dict) -> str:
    text = ""
    if "restarts" in result:
        count = result["restarts"]["count"]
        memory = ", ".join(f"{mib:.0f}" for mib in result["restarts"]["mib"])
        text += f"\nSwitched off and on {count} times; MiB after each tenth of them: {memory}.\n"
    if "real_time" in result:
        seconds = statistics.median(result["real_time"]["seconds"])
        width, height = result["real_time"]["size"]
        text += f"""
In real time ([realtime.md](../engine/realtime.md)) an image of {width} x {height} takes
{1000 * seconds:.0f} ms, {1 / seconds:.1f} a second, reading it back included; the target is 30 on a
modest graphics processor.
"""
    return text


def _marked(text: str, is_missed: bool) -> str:
    return f"**{text}**" if is_missed else text
