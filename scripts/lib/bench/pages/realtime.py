"""Scenes of blend-tests in the real-time viewport on a virtual screen: frames per second, and the error
against the ray tracer. The picture shows the ray tracer's image, the real-time image, and ten times their
difference about gray. Frames per second are valid only on an idle machine."""

from __future__ import annotations

import os
import shutil
import subprocess

import numpy as np

from .. import blender, charts
from ..run import Run
from ..velour_cli import ROOT

SETTINGS = {"screen_size": ((1400, 1000), (1400, 1000))}
_TIMES, _GRAY = 10, 0.214  # factor of the difference, around middle gray (linear)
_SHOWN = 0.82  # share of the height: above it is the shell's hem, which has no sides in real time


def measure(run: Run) -> dict:
    folder, (width, height) = run.work / "blender", run.settings.screen_size
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    tests, log = ROOT / "blend-tests", folder / "log.txt"
    environment = {"PYTHONPATH": str(tests), "BLENDER_USER_SCRIPTS": str(blender.STAGE)}
    environment["BLENDER_USER_CONFIG"] = str(folder / "config")
    command = ["xvfb-run", "-a", "-s", f"-screen 0 {width}x{height}x24", "blender", "--factory-startup"]
    command += ["--window-geometry", "0", "0", str(width), str(height), "--python-exit-code", "1", "--python"]
    command += [tests / "support/harness.py", "--", ROOT / "scripts/lib/bench/inside/realtime.py", folder]
    with open(log, "w", encoding="utf-8") as file:
        status = subprocess.run(command, stdout=file, stderr=file, env=os.environ | environment).returncode
    said = [line for line in log.read_text(errors="replace").splitlines() if line.startswith("real time")]
    if status or not (folder / "net.npy").is_file():
        raise blender.BlenderError(f"nothing was drawn; {log} says why")
    traced, drawn = np.load(folder / "net.npy")[..., :3]
    white, rows = np.percentile(traced, 99.5), round(_SHOWN * traced.shape[0])
    pictures = {
        "ray traced": traced / white,
        "real time": drawn / white,
        f"{_TIMES} times the difference": _GRAY + _TIMES * (drawn - traced) / white,
    }
    cells = [(title, charts.display(pixels[:rows])) for title, pixels in pictures.items()]
    charts.sheet(run.output / "images/realtime.png", [cells], (2.9, 2.9 * rows / traced.shape[1] + 0.25))
    return {"conditions": run.conditions(), "said": said}


def write(run: Run, found: dict) -> None:
    print("\n".join(found["said"]))
