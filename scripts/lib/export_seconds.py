"""Seconds that large scenes take on their way to the renderer, beside Cycles' own."""

from __future__ import annotations

import re
from pathlib import Path

import headless_blender
from markdown_table import table

SCENES = {
    "one mesh of 5 million triangles": {"kind": "grid", "count": 5_000_000},
    "100,000 instances of a sphere of 992 triangles": {"kind": "instances", "count": 100_000},
    "10,000 objects, each with a mesh of its own": {"kind": "objects", "count": 10_000},
}
HEADER = ["scene", "export, s", "Cycles' synchronisation, s", "ratio", "hierarchies for tracing, s", "MiB"]
RENDERS = 3  # of each engine, in turn; the least seconds count: other programs only add
_OURS = re.compile(r"Exported .* (\d+) MiB in ([\d.]+) s, including ([\d.]+) s")
_CYCLES = re.compile(r"Total time spent synchronizing data: ([\d.]+)")


def measured(folder: Path) -> str:
    """The table; logs of Blender lie in `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    lines = []
    for number, (name, task) in enumerate(SCENES.items()):
        log = folder / f"{number}.log"
        headless_blender.run("large_scenes.py", {**task, "renders": RENDERS}, log, ["--debug-cycles"])
        text = log.read_text(errors="replace")
        ours, cycles = _OURS.findall(text), _CYCLES.findall(text)
        if len(ours) != RENDERS or len(cycles) != RENDERS:
            raise headless_blender.BlenderError(f"{log} does not tell how long each export took")
        hierarchies = min(float(tracing) for _, _, tracing in ours)
        seconds = min(float(total) - float(tracing) for _, total, tracing in ours)
        theirs = min(map(float, cycles))
        numbers = (seconds, theirs, seconds / theirs, hierarchies)
        lines.append([name, *(f"{number:.2f}" for number in numbers), ours[0][0]])
    return table(HEADER, lines)
