"""Runs commands with their output in a log, and prints their progress."""

from __future__ import annotations

import contextlib
import os
import re
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Sequence
from pathlib import Path

_SAY_SECONDS = 15  # between two lines of progress
_PATIENCE_SECONDS = 20
_END_LINES = 100  # maximum number of a log's last lines that are shown after a failure


def say(text: str) -> None:
    print(text, flush=True)


def run(
    command: Sequence[str | Path],
    log: Path,
    progress: Callable[[str], str] | None = None,
    folder: Path | None = None,
    seconds: float | None = None,
    **variables: str,
) -> int | None:
    """Returns the exit status, or None after `seconds`. `progress` makes a message from the log so far.

    No started process outlives this call, Ctrl-C included.
    """
    log.parent.mkdir(parents=True, exist_ok=True)
    with log.open("wb") as output:
        child = subprocess.Popen(
            [str(part) for part in command],
            cwd=folder,
            env={**os.environ, **variables},
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )
    ended = threading.Event()
    watcher = threading.Thread(target=_watch, args=(log, progress, ended), daemon=True)
    if progress:
        watcher.start()
    try:
        return child.wait(seconds)
    except subprocess.TimeoutExpired:
        return None
    finally:
        ended.set()
        _end(child)


def _end(child: subprocess.Popen) -> None:
    """Ends the remaining processes of its group. It has some seconds to end what it started in other groups.

    Does not use SIGINT, which processes started from a shell's background ignore.
    """
    with contextlib.suppress(ProcessLookupError, subprocess.TimeoutExpired):
        if child.poll() is None:
            os.killpg(child.pid, signal.SIGTERM)
            child.wait(_PATIENCE_SECONDS)
    with contextlib.suppress(ProcessLookupError):
        os.killpg(child.pid, signal.SIGKILL)
    child.wait()


def _watch(log: Path, progress: Callable[[str], str], ended: threading.Event) -> None:
    start = time.monotonic()
    while not ended.wait(_SAY_SECONDS):
        say(f"  {time.monotonic() - start:4.0f} s  {progress(log.read_text(errors='replace'))}")


def matches(pattern: str, what: str) -> Callable[[str], str]:
    """Progress by counting the lines that match."""
    compiled = re.compile(pattern, re.MULTILINE)
    return lambda text: f"{len(compiled.findall(text))} {what}"


def last(pattern: str, what: str) -> Callable[[str], str]:
    """Progress by the last match of a pattern with one group."""
    compiled = re.compile(pattern)

    def progress(text: str) -> str:
        found = compiled.findall(text)
        return f"{found[-1] if found else 0} {what}"

    return progress


def show_end(log: Path, leave_out: str | None = None) -> None:
    lines = log.read_text(errors="replace").splitlines() if log.is_file() else []
    if leave_out:
        lines = [line for line in lines if not re.search(leave_out, line)]
    sys.stdout.write("".join(f"{line}\n" for line in lines[-_END_LINES:]))
    sys.stdout.flush()
