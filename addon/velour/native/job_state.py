"""Progress of a job. Not in job.py, because that needs numpy."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple


class JobState(NamedTuple):
    state: str  # one of table.JOB_STATES
    fraction: float  # 0..1, never falls, 1 only when done
    stage: str
    seconds: float  # since the start
    seconds_left: float | None  # estimate
    bytes_in_use: int  # memory of the whole process

    @property
    def running(self) -> bool:
        return self.state == "running"


ProgressCallback = Callable[[JobState], object]
