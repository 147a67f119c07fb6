"""The measuring scripts on made-up data, as small as can be: from their options to their pages, in seconds.

Their whole small runs on real data are long tests.
"""

from __future__ import annotations

import csv
import subprocess
import sys
from pathlib import Path

import inputs
import numpy as np
import pytest
from bench import __main__ as bench
from bench import progress, project
from command_line import environment, velour
from conftest import ADDONS, ROOT

_EXPAND = """
import os, pathlib, sys
os.symlink({paint!r}, pathlib.Path(sys.argv[1]) / f"{{sys.argv[2]}}.binary")
"""


def made_up_data(folder: Path, measurement: Path) -> Path:
    """A folder laid out as the test data: every measurement is the same, every mesh an octahedron."""
    from velour.native import images

    for name in ("brdf", "mesh", "hdr"):
        (folder / name).mkdir(parents=True)
    (folder / "brdf/expand_merl.py").write_text(_EXPAND.format(paint=str(measurement)))
    (folder / "brdf/blue-metallic-paint.nbrdf.npz").touch()
    (folder / "brdf/krylon_blue.brdf").symlink_to(measurement)
    for name in ("bunny", "buddha"):
        inputs.write_octahedron(folder / f"mesh/{name}.obj")
    sky = np.full((16, 32, 3), 0.2, np.float32)
    sky[8:] = 1.0
    sky[11, 20] = 30.0
    for name in ("studio_small_03", "venice_sunset", "potsdamer_platz"):
        images.write(folder / f"hdr/{name}.exr", sky)
        (folder / f"hdr/{name}.exr").rename(folder / f"hdr/{name}_1k.hdr")  # told by what is in it
    return folder


class Campaign:
    """Measures a page as `scripts/bench NAME --quick` does, in this process."""

    def __init__(self, work: Path, output: Path, data: Path, monkeypatch: pytest.MonkeyPatch):
        self.work, self.output, self.patch = work, output, monkeypatch
        monkeypatch.setenv("VELOUR_DATA", str(data))
        monkeypatch.setattr(project, "_EXPANDED", work / "merl")
        monkeypatch.setattr(project, "_run", run_in_this_process)
        # A line of progress from another thread would stand in the report of a slow call.
        monkeypatch.setattr(progress, "_LINE_SECONDS", 1e6)

    def run(self, name: str, *options: str) -> int:
        words = ["--quick", "--threads=2", f"--work={self.work}", f"--output={self.output}", *options]
        return bench.run(name, words)

    def rows(self, name: str) -> list[dict]:
        with open(self.output / name, newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def page(self, name: str) -> str:
        return (self.output / name).read_text(encoding="utf-8")


def run_in_this_process(*arguments, **_options) -> subprocess.CompletedProcess:
    """In place of a process for each call."""
    done = velour(*arguments, "--log-level", "error")
    if done.status:
        raise subprocess.CalledProcessError(done.status, arguments, done.out, done.err)
    return subprocess.CompletedProcess(arguments, done.status, done.out, done.err)


def only_kept(said: str) -> bool:
    """Whether a second run made nothing again."""
    lines = [line for line in said.splitlines() if line.startswith("[")]
    return bool(lines) and all(line.endswith(": kept") for line in lines)


def script_command(name: str, folder: Path, *more: str) -> list[str]:
    words = ["--built", "--quick", f"--work={folder}", f"--output={folder}/out", *more]
    return [sys.executable, "-P", "-m", "bench", name, *words]


def script_environment(data: Path) -> dict:
    return environment(VELOUR_DATA=str(data), PYTHONPATH=f"{ADDONS}:{ROOT / 'scripts/lib'}")


def run_script(name: str, folder: Path, *more: str, data: Path) -> subprocess.CompletedProcess:
    """Measures a page in a process of its own, as its user does."""
    command, env = script_command(name, folder, *more), script_environment(data)
    return subprocess.run(command, capture_output=True, text=True, timeout=900, env=env)
