"""Runs a script inside Blender without a window, with the staged add-on."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

HERE = Path(__file__).resolve().parent
STAGE = Path(os.environ.get("VELOUR_STAGE", HERE.parents[1] / "build/release/blender"))


class BlenderError(RuntimeError):
    pass


def run(
    script: str,
    task: dict,
    log: Path,
    options: list[str] | None = None,
    hear: Callable[[str], None] = lambda line: None,
) -> None:
    """`script` is a file of this folder and gets `task` as JSON after "--". `options`: further options for
    Blender. `hear` is called with each line that Blender or the script prints."""
    blender = shutil.which("blender")
    if not blender:
        raise BlenderError("blender is not installed; run scripts/setup")
    # The order matters: --python-exit-code applies only to the arguments after it.
    command = [blender, "-b", "--factory-startup", "-noaudio", "--python-exit-code", "7", *(options or [])]
    command += ["--python", str(HERE / script), "--", json.dumps(task)]
    # A distribution's Blender looks for its Python along PATH and must not find that of a version manager.
    path = os.pathsep.join((str(Path(blender).resolve().parent), os.environ["PATH"]))
    environment = {**os.environ, "BLENDER_USER_SCRIPTS": str(STAGE), "PATH": path}
    status = _run(command, environment, log, hear)
    if status:
        lines = [line for line in log.read_text(errors="replace").splitlines() if line.strip()]
        raise BlenderError(f"Blender failed with status {status}; {log} ends: {' / '.join(lines[-3:])}")


def _run(command: list[str], environment: dict[str, str], log: Path, hear: Callable[[str], None]) -> int:
    """Returns the exit status. Kills Blender on any exception: Ctrl-C itself ends only its current render."""
    with (
        open(log, "w") as file,
        subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            env=environment,
            text=True,
            errors="replace",
        ) as process,
    ):
        try:
            for line in process.stdout:
                file.write(line)
                file.flush()
                hear(line)
        except BaseException:
            process.kill()
            raise
    return process.returncode
