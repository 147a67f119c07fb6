"""Which Blender and which Velour, and how they are started."""

from __future__ import annotations

import json
import signal
import sys
from dataclasses import dataclass
from pathlib import Path

from support import process

HERE = Path(__file__).resolve().parent


class BlenderError(RuntimeError):
    """One sentence: what went wrong in or with Blender, and what to do."""


@dataclass(frozen=True)
class Installation:
    program: str
    stage: Path | None  # a staged folder that takes the place of the user's scripts; None: what is installed
    seconds: int  # that a process may take

    def command(self, *arguments: str) -> list[str]:
        start = ["--factory-startup", "--addons", "velour"] if self.stage else []
        return [self.program, "-b", "-noaudio", *start, *map(str, arguments)]

    def execute(self, log: Path, *arguments: str) -> int | None:
        variables = process.environment(self.program, self.stage)
        return process.execute(self.command(*arguments), variables, log, self.seconds)

    def run(self, script: str, task: dict, folder: Path) -> dict:
        """The report of a script of this folder; raises BlenderError."""
        name = Path(script).stem
        log, report = folder / f"{name}.log", folder / f"{name}.json"
        report.unlink(missing_ok=True)
        # --python-exit-code only holds for what follows it.
        task = json.dumps({**task, "report": str(report)})
        status = self.execute(log, "--python-exit-code", "7", "--python", HERE / script, "--", task)
        found = json.loads(report.read_text(encoding="utf-8")) if report.is_file() else {}
        if found.get("error"):
            raise BlenderError(found["error"])
        if status != 0 or not found:
            raise BlenderError(f"{ending(status, self.seconds)}; what Blender said is in {log}.")
        return found


def ending(status: int | None, seconds: int) -> str:
    if status is None:
        return f"Blender took longer than {seconds} s; give it more time, or a smaller picture"
    number = -status if status < 0 else status - 128  # a script around Blender adds 128
    if number in set(signal.Signals):
        return f"Blender crashed ({signal.Signals(number).name})"
    return f"Blender ended with status {status}"


def notes(log: Path) -> list[str]:
    """What the engine said about the scene, each sentence once."""
    lines = log.read_text(encoding="utf-8", errors="replace").splitlines() if log.is_file() else []
    prefix = "Velour: "
    return list(dict.fromkeys(line.removeprefix(prefix) for line in lines if line.startswith(prefix)))


def use_package(addons: Path) -> None:
    """Lets `import velour` find the package in a folder of add-ons."""
    sys.path.insert(0, str(addons))
