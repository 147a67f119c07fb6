"""Throughput of Cycles with the closest Principled material, in camera rays per second."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from pathlib import Path

import headless_blender
from chart_scenes import ChartScene
from renders import Renders
from scenes import BUNNY_CAMERA


@dataclass(frozen=True)
class Throughput:
    """Camera rays per second, each with one direction of the material and one of the light."""

    version: str
    cycles: float
    ours: float


def throughput(scene: ChartScene, renders: Renders, extent) -> Throughput | str:
    """Measures the throughput on the bunny; returns a sentence if that is impossible."""
    framed = replace(scene.scene, camera=BUNNY_CAMERA)
    fewer, more = extent.cycles_rays
    try:
        report = _render(scene, renders, [fewer, more])
    except headless_blender.BlenderError as error:
        return f"Cycles is left out: {error}"
    ours = renders.render(framed, 2 * more, split=2, strategy="mis").report
    width, height = renders.settings.size
    # The difference of two renders excludes the work of each before its first sample.
    seconds = report["seconds"][1] - report["seconds"][0]
    if seconds <= 0:
        return (
            "Cycles is left out: its two renders are too short to tell their samples from their preparation."
        )
    rays = width * height * (more - fewer)
    return Throughput(report["version"], rays / seconds, ours["samples_per_second"] / 2)


def _render(scene: ChartScene, renders: Renders, rays: list[int]) -> dict:
    lobe = renders.ggx(scene.measurement)["ggx"]
    look = {
        "color": [min(max(value, 0.0), 1.0) for value in lobe["f0"]],
        "roughness": max(lobe["alpha"]) ** 0.5,  # Principled squares it
        "rays": rays,
        "size": list(renders.settings.size),
        "threads": renders.settings.threads,
        "camera": BUNNY_CAMERA,
    }
    files = {"mesh": scene.scene.mesh, "world": scene.scene.world}

    def run(report: Path) -> dict:
        partial = report.with_suffix(".partial")
        task = look | {name: str(path) for name, path in files.items()} | {"report": str(partial)}
        headless_blender.run("cycles_scene.py", task, renders.settings.folder / "cycles.log")
        partial.replace(report)
        return json.loads(report.read_text())

    program = Path(__file__).with_name("cycles_scene.py")
    return renders.keep("Cycles, bunny", "cycles", look | files | {"program": program}, run)
