"""Which Blender and which Velour, and how they are started."""

from __future__ import annotations

import atexit
import contextlib
import json
import os
import selectors
import signal
import subprocess
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path

from support import process

HERE = Path(__file__).resolve().parent
_DONE = b"velour: done\n"  # as in inside.py
_END_SECONDS = 5


class BlenderError(RuntimeError):
    """One sentence: what went wrong in or with Blender, and what to do."""


@dataclass(frozen=True)
class Installation:
    """Threads may share it: each run has a Blender of its own, which later runs take over."""

    program: str
    stage: Path | None  # a staged folder that takes the place of the user's scripts; None: what is installed
    seconds: int  # that a run may take
    _idle: list[_Obedient] = field(default_factory=list, init=False, compare=False)

    def command(self, *arguments: str) -> list[str]:
        start = ["--factory-startup", "--addons", "velour"] if self.stage else []
        return [self.program, "-b", "-noaudio", *start, *map(str, arguments)]

    @property
    def variables(self) -> dict[str, str]:
        return process.environment(self.program, self.stage)

    def execute(self, log: Path, *arguments: str) -> int | None:
        return process.execute(self.command(*arguments), self.variables, log, self.seconds)

    def run(self, script: str, task: dict, folder: Path) -> dict:
        """The report of a script of this folder; raises BlenderError."""
        name = Path(script).stem
        log, report = folder / f"{name}.log", folder / f"{name}.json"
        report.unlink(missing_ok=True)
        log.write_bytes(b"")
        try:
            blender = self._idle.pop()
        except IndexError:
            blender = _Obedient(self, log)
        order = {"script": script, "log": str(log), "task": {**task, "report": str(report)}}
        answered = blender.obey(order, self.seconds)
        if answered and not task.get("scripts"):  # a file's own scripts may change Blender for the next
            self._idle.append(blender)
        else:
            blender.close()
        found = json.loads(report.read_text(encoding="utf-8")) if report.is_file() else {}
        if found.get("error"):
            raise BlenderError(found["error"])
        if not answered or not found:
            raise BlenderError(f"{ending(blender.status, self.seconds)}; what Blender said is in {log}.")
        return found


class _Obedient:
    """A Blender that obeys one order after the other (inside.py)."""

    def __init__(self, installation: Installation, log: Path):
        self.status: int | None = None  # of its end; None: it has not ended by itself
        command = installation.command("--python", HERE / "inside.py")
        with log.open("ab") as errors:
            self._process = process.start(
                command, installation.variables, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=errors
            )
        atexit.register(self.close)

    def obey(self, order: dict, seconds: float) -> bool:
        """Whether it has done the order; else the end of its log says more."""
        with contextlib.suppress(BrokenPipeError):
            self._process.stdin.write(json.dumps(order).encode() + b"\n")
            self._process.stdin.flush()
        said, end = b"", time.monotonic() + seconds
        with selectors.DefaultSelector() as selector:
            selector.register(self._process.stdout, selectors.EVENT_READ)
            while not said.endswith(_DONE):
                if not selector.select(end - time.monotonic()):
                    said += f"\nkilled after {seconds} s\n".encode()
                    process.stop(self._process)
                    break
                part = os.read(self._process.stdout.fileno(), 4096)
                if not part:
                    self.status = self._process.wait()
                    break
                said += part
            else:
                return True
        with Path(order["log"]).open("ab") as log:
            log.write(said)
        return False

    def close(self) -> None:
        """Lets it end, if it obeys."""
        atexit.unregister(self.close)
        with contextlib.suppress(BrokenPipeError):
            self._process.stdin.close()
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(_END_SECONDS)
        self._process.stdout.close()
        process.stop(self._process)


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
