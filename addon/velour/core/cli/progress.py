"""One line that tells how far a job is."""

from __future__ import annotations

from typing import TextIO

from ...native.job import JobState

_WIDTH = 30


class ProgressBar:
    """Called with the states of a job; redraws its line and wipes it at the end."""

    def __init__(self, stream: TextIO):
        self._stream = stream

    def __call__(self, state: JobState) -> None:
        line = bar_line(state) if state.running else ""
        self._stream.write(f"\r\x1b[K{line}")
        self._stream.flush()

    def close(self) -> None:
        self._stream.write("\r\x1b[K")
        self._stream.flush()


def bar_line(state: JobState) -> str:
    full = round(_WIDTH * state.fraction)
    left = "" if state.seconds_left is None else f", {state.seconds_left:.0f} s left"
    return f"[{'#' * full}{'.' * (_WIDTH - full)}] {state.fraction:4.0%} {state.stage}{left}"
