"""Runs demo_scene.py inside Blender with the staged add-on."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
STAGE = HERE.parents[1] / "build/release/blender"


class BlenderError(RuntimeError):
    pass


def render(model_file: Path, measurement_file: Path, folder: Path) -> dict:
    """Writes model and reference pictures; returns the report of demo_scene.py."""
    blender = shutil.which("blender")
    if not blender:
        raise BlenderError("blender is not installed; run scripts/setup")
    with tempfile.TemporaryDirectory(prefix="velour-demo-") as temporary:
        report = Path(temporary) / "report.json"
        task = {
            "model": str(model_file.resolve()),
            "measurement": str(measurement_file.resolve()),
            "folder": str(folder.resolve()),
            "report": str(report),
        }
        _run(
            blender, ["--python", str(HERE / "demo_scene.py"), "--", json.dumps(task)], folder / "blender.log"
        )
        return json.loads(report.read_text())


def _run(blender: str, arguments: list[str], log: Path) -> None:
    # The order matters: what stands before --python-exit-code does not know of it.
    command = [blender, "-b", "--factory-startup", "-noaudio", "--python-exit-code", "7", *arguments]
    # A distribution's Blender looks for its Python along PATH: not a version manager's, please.
    path = os.pathsep.join((str(Path(blender).resolve().parent), os.environ["PATH"]))
    environment = {**os.environ, "BLENDER_USER_SCRIPTS": str(STAGE), "PATH": path}
    with open(log, "w") as file:
        done = subprocess.run(
            command, stdout=file, stderr=subprocess.STDOUT, env=environment, stdin=subprocess.DEVNULL
        )
    if done.returncode:
        lines = [line for line in log.read_text(errors="replace").splitlines() if line.strip()]
        raise BlenderError(
            f"Blender failed with status {done.returncode}; {log} ends: {' / '.join(lines[-3:])}"
        )
