"""Starts Blender, on a node and where jobs are made."""

from __future__ import annotations

import contextlib
import os
import re
import shutil
import signal
import subprocess
import threading
from collections.abc import Iterator
from pathlib import Path

from .job import Job, Unit

# "Error: ..." of Blender 3 and 4, "... | ERROR ..." of 5, "ValueError: ..." of Python.
_ERROR = re.compile(r"\b(?:\w*Error|ERROR)\b.*")
_OUT_OF_TIME = re.compile(r"Stopped at sample \d+ of \d+;")  # Velour's message after it has saved the film
stopped = threading.Event()  # set once SIGTERM has arrived
FAILED = 7  # the exit status of a script that raises; Blender's own failures have 1


def start(job: Job) -> list[str]:
    """The command up to the .blend. --python-exit-code applies only to the arguments after it."""
    command = [job.blender, "-b", "-noaudio", "--python-exit-code", str(FAILED)]
    if not job.preferences:
        command.append("--factory-startup")
    command.append("-y" if job.scripts else "-Y")
    return [*command, "--addons", job.addon, job.blend]


def render(job: Job, unit: Unit, picture: Path) -> list[str]:
    """`picture`: its path without number and extension.

    -E makes a node without Velour fail. Otherwise Blender renders with EEVEE and reports success.
    """
    command = [*start(job), "-E", "VELOUR", "-t", str(job.threads), "-o", f"{picture}####"]
    command += ["-F", job.format, "-x", "1", "-f", str(unit.frame)]
    # Blender keeps the film, in case it cannot write the whole picture; we remove it after the check.
    own = ["--velour-parts", str(job.film(unit.frame)), "--velour-keep-parts"]
    if unit.part:
        own += ["--velour-samples", f"{unit.part}/{job.parts}"]
    if job.memory_mib:
        own += ["--velour-memory", f"{job.memory_mib}M"]
    return [*command, "--", *own]


def execute(command: list[str], log: Path) -> int:
    """Returns the exit status; all output goes to `log`. Forwards SIGTERM and waits for Blender to end, so
    that Velour saves what it has of the frame. After SIGTERM, nothing is started."""
    log.parent.mkdir(parents=True, exist_ok=True)
    with open(log, "wb") as file, heeding_sigterm() as children:
        if stopped.is_set():
            return -signal.SIGTERM
        try:
            child = subprocess.Popen(
                command,
                stdin=subprocess.DEVNULL,
                stdout=file,
                stderr=subprocess.STDOUT,
                env=environment(command[0]),
            )
        except OSError as error:
            file.write(f"Error: {command[0]} cannot be started ({error.strerror})\n".encode())
            return 127
        children.append(child)
        with child:
            try:
                if stopped.is_set():  # it came while Blender was started
                    child.terminate()
                return child.wait()
            except BaseException:
                child.kill()
                raise


@contextlib.contextmanager
def heeding_sigterm() -> Iterator[list[subprocess.Popen]]:
    """Within this context, SIGTERM sets `stopped` and ends only the children in the list."""
    children: list[subprocess.Popen] = []

    def stop(_number, _frame):
        stopped.set()
        for child in children:
            child.terminate()

    earlier = signal.signal(signal.SIGTERM, stop)
    try:
        yield children
    finally:
        signal.signal(signal.SIGTERM, earlier or signal.SIG_DFL)


def environment(program: str) -> dict[str, str]:
    """Puts Blender's folder first on PATH, where a distribution's Blender looks for its Python: it must not
    find that of a version manager."""
    found = shutil.which(program)
    if not found:
        return dict(os.environ)
    folder = str(Path(found).resolve().parent)
    return {**os.environ, "PATH": os.pathsep.join((folder, os.environ.get("PATH", os.defpath)))}


def ending(status: int, log: Path) -> str:
    """Why Blender ended, with the last error that it printed."""
    number = -status if status < 0 else status - 128  # a script around Blender adds 128
    if number in set(signal.Signals):
        words = f"Blender was ended by {signal.Signals(number).name}"
    else:
        words = f"Blender ended with status {status}"
    error = _last_error(log)
    return f"{words}: {error.rstrip('. ')}" if error else words


def ran_out_of_time(log: Path) -> bool:
    """Whether the .blend's own time limit ended Blender, so that the next run continues from there."""
    return bool(_OUT_OF_TIME.search(_last_error(log)))


def _last_error(log: Path) -> str:
    said = log.read_text(encoding="utf-8", errors="replace") if log.is_file() else ""
    return ["", *_ERROR.findall(said)][-1]
