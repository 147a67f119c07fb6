"""Runs a script inside Blender, without a window, with the staged add-on."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from pathlib import Path

HERE = Path(__file__).resolve().parent
STAGE = Path(os.environ.get("VELOUR_STAGE", HERE.parents[1] / "build/release/blender"))


class BlenderError(RuntimeError):
    pass


def run(script: str, task: dict, log: Path, options: list[str] | None = None) -> None:
    """`script` lies in this folder and finds `task` as JSON after "--". `options`: more of Blender's own."""
    blender = shutil.which("blender")
    if not blender:
        raise BlenderError("blender is not installed; run scripts/setup")
    # The order matters: what stands before --python-exit-code does not know of it.
    command = [blender, "-b", "--factory-startup", "-noaudio", "--python-exit-code", "7", *(options or [])]
    command += ["--python", str(HERE / script), "--", json.dumps(task)]
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
