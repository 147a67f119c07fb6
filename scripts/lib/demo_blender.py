"""Runs demo_scene.py inside Blender."""

from __future__ import annotations

import json
import tempfile
from pathlib import Path

import headless_blender


def render(model_file: Path, measurement_file: Path, folder: Path) -> dict:
    """Writes model and reference pictures; returns the report of demo_scene.py."""
    with tempfile.TemporaryDirectory(prefix="velour-demo-") as temporary:
        report = Path(temporary) / "report.json"
        task = {
            "model": str(model_file.resolve()),
            "measurement": str(measurement_file.resolve()),
            "folder": str(folder.resolve()),
            "report": str(report),
        }
        headless_blender.run("demo_scene.py", task, folder / "blender.log")
        return json.loads(report.read_text())
