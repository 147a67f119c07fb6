"""Progress of a job as text."""

from __future__ import annotations

import logging
from typing import TextIO

from ...native.job_state import JobState

_WIDTH = 30
_LINE_SECONDS = 10.0


class ProgressLines:
    """Called with the states of a job; logs a line every ten seconds."""

    def __init__(self, log: logging.Logger):
        self._log = log
        self._next = _LINE_SECONDS

    def __call__(self, state: JobState) -> None:
        if state.running and state.seconds >= self._next:
            self._log.info("%s", text(state))
            self._next = state.seconds + _LINE_SECONDS


class ProgressBar:
    """Called with the states of a job; redraws its line and erases it at the end."""

    def __init__(self, stream: TextIO):
        self._stream = stream

    def __call__(self, state: JobState) -> None:
        full = round(_WIDTH * state.fraction)
        line = f"[{'#' * full}{'.' * (_WIDTH - full)}] {text(state)}" if state.running else ""
        self._stream.write(f"\r\x1b[K{line}")
        self._stream.flush()


def text(state: JobState) -> str:
    left = "" if state.seconds_left is None else f", {state.seconds_left:.0f} s left"
    return f"{state.fraction:4.0%} {state.stage}{left}"
