"""How long the rendered viewport of the real Blender takes to show a change, on a virtual screen, and whether
its memory grows when it is switched off and on. Leave the machine idle meanwhile.

Only a run of all scenes writes the page.
"""

from __future__ import annotations

import statistics

from .. import blender, project
from ..run import Run

SCENES = {
    "monkey": "A monkey of 31 thousand triangles in a measured paint, under a picture of a sky",
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
    first = next(iter(found["results"].values()))
    own = {key: first[key] for key in ("blender", "size", "samples")}
    own |= {
        "busy": project.busy(found["conditions"]["load"]),
        "seen": SEEN,
        "export": EXPORT,
        "held": 1000 * HELD,
    }
    return own | {"results": [_scene(*item) for item in found["results"].items()]}


def _scene(name: str, result: dict) -> dict:
    restarts, real_time = ([result[key]] if key in result else [] for key in ("restarts", "real_time"))
    for each in restarts:
        each["memory"] = ", ".join(f"{mib:.0f}" for mib in each["mib"])
    for each in real_time:
        seconds = statistics.median(each["seconds"])
        each |= {"milliseconds": 1000 * seconds, "rate": 1 / seconds}
    rows = [_row(*item) for item in result["changes"].items()]
    return result | {"about": SCENES[name], "rows": rows, "restarts": restarts, "real_time": real_time}


def _row(name: str, runs: list[dict]) -> dict:
    seen, export, held = (statistics.median(run[key] for run in runs) for key in ("seen", "export", "held"))
    is_first = len(runs) == 1
    return {
        "name": name,
        "seen": _marked(f"{seen:.2f}", not is_first and seen > SEEN),
        "export": _marked(f"{export:.3f}", is_first and export > EXPORT),
        "held": _marked(f"{1000 * held:.0f}", held > HELD),
    }


def _marked(text: str, is_missed: bool) -> str:
    return f"**{text}**" if is_missed else text
