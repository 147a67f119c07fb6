"""Runs a script inside Blender without a window, with the staged add-on."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

from .velour_cli import ROOT

STAGE = Path(os.environ.get("VELOUR_STAGE", ROOT / "build/release/blender"))


class BlenderError(RuntimeError):
    pass


def run(
    script: str,
    task: dict,
    log: Path,
    options: tuple[str, ...] = (),
    hear: Callable[[str], None] = lambda line: None,
    version: str | None = None,
) -> dict | None:
    """Calls main(task) of the module bench.inside.SCRIPT and returns what it returns.

    `options`: further options for Blender. `hear` is called with each line that Blender or the script prints.
    `version`: a version of scripts/blenders, with the packaged add-on.
    """
    report = log.with_suffix(".report.json")
    report.unlink(missing_ok=True)
    done = f"bench.inside.start({script!r}, {json.dumps(task)!r}, {str(report)!r})"
    path = [str(ROOT / "scripts/lib"), str(ROOT / "blend-tests")]
    code = f"import sys; sys.path[:0] = {path!r}; import bench.inside; {done}"
    command = [*_blender(version), "-b", "--factory-startup", "-noaudio"]
    # The order matters: --python-exit-code applies only to the arguments after it.
    command += ["--python-exit-code", "7", *options, "--python-expr", code]
    status = _run(command, log, hear)
    if status:
        lines = [line for line in log.read_text(errors="replace").splitlines() if line.strip()]
        raise BlenderError(f"Blender failed with status {status}; {log} ends: {' / '.join(lines[-3:])}")
    return json.loads(report.read_text(encoding="utf-8")) if report.is_file() else None


def _blender(version: str | None) -> list[str]:
    if version:
        stage = f"BLENDER_USER_SCRIPTS={ROOT / 'build/package/blender'}"
        return [str(ROOT / "scripts/blenders"), "--run", version, "env", stage, "blender"]
    found = shutil.which("blender")
    if not found:
        raise BlenderError("blender is not installed; run scripts/setup")
    # A distribution's Blender looks for its Python along PATH and must not find that of a version manager.
    path = os.pathsep.join((str(Path(found).resolve().parent), os.environ["PATH"]))
    return ["env", f"BLENDER_USER_SCRIPTS={STAGE}", f"PATH={path}", found]


def _run(command: list[str], log: Path, hear: Callable[[str], None]) -> int:
    """Returns the exit status. Kills Blender on any exception: Ctrl-C itself ends only its current render."""
    pipes = {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, "stderr": subprocess.STDOUT}
    with (
        open(log, "w") as file,
        subprocess.Popen(command, text=True, errors="replace", **pipes) as process,
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
