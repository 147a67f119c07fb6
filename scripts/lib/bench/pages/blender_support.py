"""Which features of a Blender scene render as in Cycles, and how long the export of large scenes takes.

--last reuses the results of the last run of the parity tests.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
from collections.abc import Iterable, Iterator

from .. import blender
from ..project import ROOT
from ..run import Run

CSV = "blender_parity.csv"  # of the honored features; others stand on the page
SETTINGS = {"last": (False, False), "renders": (3, 1)}  # renders: of each engine, in turn; the fastest counts
PAGES = {"blender_parity.md": "blender_parity", "blender_export.md": "blender_export"}
_ROWS = ROOT / "build/blend-tests/parity"
_SCENES = {
    "one mesh of 5 million triangles": {"kind": "grid", "count": 5_000_000},
    "100,000 instances of a sphere of 992 triangles": {"kind": "instances", "count": 100_000},
    "10,000 objects, each with a mesh of its own": {"kind": "objects", "count": 10_000},
}
_NOTABLE = 0.3  # per cent from which an honored feature is named on the page
_OURS = re.compile(r"Exported .* (\d+) MiB in ([\d.]+) s, including ([\d.]+) s")
_CYCLES = re.compile(r"Total time spent synchronizing data: ([\d.]+)")


def measure(run: Run) -> dict:
    if not run.settings.last:
        long = os.environ | {"VELOUR_LONG_TESTS": "1"}
        long.pop("PYTHONSAFEPATH", None)  # set by scripts/bench; the tests import from their own folder
        subprocess.run([ROOT / "blend-tests/run", "parity"], check=True, env=long)
    lines = [line for file in sorted(_ROWS.glob("*/rows.jsonl")) for line in file.open(encoding="utf-8")]
    if not lines:
        raise FileNotFoundError(f"there is no row in {_ROWS}; run without --last.")
    features = list(map(json.loads, lines))
    return {
        "conditions": run.conditions(seed=0, blender=features[0]["blender"]),
        "rows": list(_groups(row for row in features if row["verdict"] == "honored")),
        "others": [row for row in features if row["verdict"] != "honored"],
        "export": [_export(run, name, task) for name, task in _SCENES.items()],
    }


def _export(run: Run, name: str, task: dict) -> dict:
    """Seconds of a scene on its way to the renderer, beside Cycles' own."""
    log, renders = run.work / f"{task['kind']}.log", run.settings.renders
    blender.run("large_scenes", {**task, "renders": renders}, log, ("--debug-cycles",))
    text = log.read_text(errors="replace")
    ours, cycles = _OURS.findall(text), _CYCLES.findall(text)
    if len(ours) != renders or len(cycles) != renders:
        raise blender.BlenderError(f"{log} does not tell how long each export took")
    seconds = min(float(total) - float(tracing) for _, total, tracing in ours)
    theirs = min(map(float, cycles))
    numbers = {"seconds": seconds, "cycles": theirs, "ratio": seconds / theirs, "mib": int(ours[0][0])}
    return {"scene": name, "hierarchies": min(float(tracing) for _, _, tracing in ours), **numbers}


def values(found: dict) -> dict:
    groups = found["rows"]
    return {
        "scenes": sum(group["scenes"] for group in groups),
        "features": len(groups),
        "apart": max(group["errors"] for group in groups if group["errors"] is not None),
        "notable": _NOTABLE,
        "groups": [group for group in groups if group["percent"] >= _NOTABLE],
        "others": [row | {"errors": _shown(row["z"])} for row in found["others"]],
        "export": found["export"],
    }


def _groups(rows: Iterable[dict]) -> Iterator[dict]:
    """A row per group of features, which is named before the colon; the largest differences of the group."""
    groups: dict[str, list[dict]] = {}
    for row in rows:
        groups.setdefault(row["feature"].partition(": ")[0], []).append(row)
    for group, own in groups.items():
        errors = [row["z"] for row in own if row["z"] is not None]  # None: pictures without noise
        features = "; ".join(filter(None, (row["feature"].partition(": ")[2] for row in own)))
        numbers = {"percent": max(row["percent"] for row in own), "errors": max(errors, default=None)}
        yield {"honored": group, "scenes": len(own), **numbers, "features": features}


def _shown(errors: float | None) -> str | None:
    """A difference in standard errors; None for pictures without noise."""
    return None if errors is None else f"{errors:.{0 if errors >= 100 else 1}f}"
