"""Runs scripts inside Blender with the staged add-on, with and without a window."""

from __future__ import annotations

import json
import os
import shutil
import sys
from collections.abc import Sequence
from pathlib import Path

from .project import ROOT

sys.path.append(str(ROOT / "blend-tests"))

from support import process, report

STAGE = Path(os.environ.get("VELOUR_STAGE", ROOT / "build/release/blender"))
INSIDE = Path(__file__).with_name("inside")
_HARNESS = ROOT / "blend-tests/support/harness.py"


class BlenderError(RuntimeError):
    pass


def run(
    script: str,
    task: dict,
    log: Path,
    options: tuple[str, ...] = (),
    version: str | None = None,
    screen: bool = False,
) -> dict | None:
    """Calls main(task) of the module bench.inside.SCRIPT and returns what it returns.

    `options`: further options for Blender. `version`: one of scripts/blenders, with the packaged add-on.
    `screen`: with a virtual screen, which EEVEE needs.
    """
    found = log.with_suffix(".report.json")
    found.unlink(missing_ok=True)
    done = f"bench.inside.start({script!r}, {json.dumps(task)!r}, {str(found)!r})"
    path = [str(ROOT / "scripts/lib"), str(ROOT / "blend-tests")]
    code = f"import sys; sys.path[:0] = {path!r}; import bench.inside; {done}"
    command = [*_blender(version, screen), "-b", "--factory-startup", "-noaudio"]
    # The order matters: --python-exit-code applies only to the arguments after it.
    command += ["--python-exit-code", "7", *options, "--python-expr", code]
    if status := process.execute(command, process.environment(command[0], STAGE), log, None):
        raise BlenderError(f"Blender failed with status {status}; {_ending(log)}")
    return json.loads(found.read_text(encoding="utf-8")) if found.is_file() else None


def in_window(
    module: str,
    task: dict,
    folder: Path,
    screen: tuple[int, int],
    program: str = "blender",
    options: Sequence[str] = (),
    files: Sequence[Path] = (),
    seconds: float = 3600,
) -> dict:
    """Runs steps(folder, task) of a module, a generator function, in a window of `screen` pixels and returns
    what it returns.

    The folder is new, with copies of `files`. `program`: Blender's name or path.
    """
    for tool in ("xvfb-run", program):
        if not shutil.which(tool):
            raise BlenderError(f"{tool} is not installed; run scripts/setup")
    folder = folder.resolve()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for file in files:
        shutil.copy(file, folder)
    (folder / "task.json").write_text(json.dumps({**task, "module": module}))
    program, size, log = shutil.which(program), [str(side) for side in screen], folder / "log.txt"
    command = ["env", "-C", folder, f"BLENDER_USER_CONFIG={folder / 'config'}"]
    command += ["xvfb-run", "-a", "-s", f"-screen 0 {'x'.join(size)}x24 -fbdir . -nocursor"]
    command += [program, "--factory-startup", "-noaudio", *options, "--window-geometry", "0", "0", *size]
    command += ["--python-exit-code", "1", "--python", _HARNESS, "--", INSIDE / "in_window.py", folder]
    status = process.execute(list(map(str, command)), process.environment(program, STAGE), log, seconds)
    found = report.read(folder)
    if status != 0 or not found or any(test.outcome == report.FAILED for test in found):
        raise BlenderError(f"{folder.name} failed in Blender; {_ending(log)}")
    return json.loads((folder / "result.json").read_text())


def _ending(log: Path) -> str:
    lines = [line for line in log.read_text(errors="replace").splitlines() if line.strip()]
    return f"{log} ends: {' / '.join(lines[-3:])}"


def _blender(version: str | None, screen: bool) -> list[str]:
    on_screen = ["xvfb-run", "-a"] if screen else []
    if version:
        stage = f"BLENDER_USER_SCRIPTS={ROOT / 'build/package/blender'}"
        return [str(ROOT / "scripts/blenders"), "--run", version, "env", stage, *on_screen, "blender"]
    for tool in (*on_screen[:1], "blender"):
        if not shutil.which(tool):
            raise BlenderError(f"{tool} is not installed; run scripts/setup")
    return [*on_screen, shutil.which("blender")]
