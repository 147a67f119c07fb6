"""The status of a job: what is done, what failed and why, and what remains."""

from __future__ import annotations

import contextlib
from dataclasses import dataclass
from pathlib import Path

from . import frame, ranges
from .frame import DONE, FAILED, UNFINISHED
from .job import Job, Unit


@dataclass(frozen=True)
class Status:
    done: list[int]
    failed: dict[int, str]  # reasons by frame
    left: list[int]

    @property
    def code(self) -> int:
        if self.failed:
            return FAILED
        return UNFINISHED if self.left else DONE

    def lines(self) -> list[str]:
        lines = [f"frame {number} failed: {why}" for number, why in sorted(self.failed.items())]
        if self.left:
            lines.append(f"not done yet: {ranges.words(self.left)}")
        count = len(self.done) + len(self.failed) + len(self.left)
        return [
            *lines,
            f"{len(self.done)} of {count} frames done, {len(self.failed)} failed, {len(self.left)} left",
        ]


def look(job: Job) -> Status:
    """Reads every picture: one that another program damaged does not count as done."""
    done, failed, left = [], {}, []
    for number in job.frames:
        why = [said for path in job.failures(number) if (said := _read(path))]
        if not frame.problem(job, job.picture(number)):
            done.append(number)
        elif why:
            failed[number] = " ".join(why)
        else:
            left.append(number)
    return Status(done, failed, left)


def _read(path: Path) -> str:
    """The text of a file, which a running task may have removed by now."""
    with contextlib.suppress(FileNotFoundError):
        return path.read_text(encoding="utf-8").strip()
    return ""


def tasks_left(job: Job, status: Status) -> list[int]:
    """The tasks that have something to render."""
    frames = set(job.frames) - set(status.done)
    return [number for number in range(job.tasks) if any(_is_left(job, u, frames) for u in job.task(number))]


def _is_left(job: Job, unit: Unit, frames: set[int]) -> bool:
    if unit.frame not in frames:
        return False
    if not unit.part or not job.part_done(unit).is_file():
        return True
    # Only the picture remains: one task is enough to make it from all parts.
    return unit.part == 1 and all(job.part_done(each).is_file() for each in job.parts_of(unit.frame))
