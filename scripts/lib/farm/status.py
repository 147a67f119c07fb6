"""What is done of a job, what failed and why, and what is left."""

from __future__ import annotations

from dataclasses import dataclass

from . import frame, ranges
from .job import Job

DONE, FAILED, UNFINISHED = 0, 1, 3  # exit statuses


@dataclass(frozen=True)
class Status:
    done: list[int]
    failed: dict[int, str]  # why
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
    """Every picture is read: one that another program damaged is not done."""
    done, failed, left = [], {}, []
    for number in job.frames:
        why = job.failure(number)
        if not frame.problem(job, job.picture(number)):
            done.append(number)
        elif why.is_file():
            failed[number] = why.read_text(encoding="utf-8").strip()
        else:
            left.append(number)
    return Status(done, failed, left)


def tasks_left(job: Job, status: Status) -> list[int]:
    """The tasks that have a frame to render."""
    done = set(status.done)
    return [number for number in range(job.tasks) if set(job.task(number)) - done]
