"""Prints how much of a script's work is done, how long it took, and about how long the rest will take.

Finished work gets a line of its own. Work in progress gets a line every ten seconds, or on a terminal one
line that is updated every second, like with_progress in common.sh.
"""

from __future__ import annotations

import sys
import threading
import time
from contextlib import contextmanager

_LINE_SECONDS = 10.0
_CLEAR_LINE = "\r\x1b[K"


class Progress:
    """Work is announced with a cost in any unit; finished work determines the estimate of the remaining time.

    `rate`: first estimate of the seconds per unit of cost.
    """

    def __init__(self, rate: float | None = None):
        self.kept = 0  # items that an earlier run has done
        self._count = self._expected = 0
        self._cost_left = self._cost_paid = self._seconds = 0.0
        self._rate = rate

    def expect(self, cost: float, count: int = 1) -> None:
        self._expected += count
        self._cost_left += cost * count

    def skip(self, label: str, cost: float, count: int = 1) -> None:
        """Counts work that an earlier run has done. `cost`: of all `count` items together."""
        self.kept += count
        self._finish(cost, count)
        self._say(f"{label}: kept")

    @contextmanager
    def work(self, label: str, cost: float):
        start = time.monotonic()
        with self._reporting(label, start):
            yield
        seconds = time.monotonic() - start
        self._cost_paid += cost
        self._seconds += seconds
        self._rate = self._seconds / self._cost_paid
        self._finish(cost)
        self._say(f"{label}: {seconds:.1f} s{self._left()}")

    @contextmanager
    def _reporting(self, label: str, start: float):
        """Prints the progress from another thread."""
        ended = threading.Event()
        interval = 1.0 if sys.stdout.isatty() else _LINE_SECONDS

        def report() -> None:
            while not ended.wait(interval):
                seconds = time.monotonic() - start
                self._say(f"{label}: {seconds:.0f} s{self._left(seconds)}", in_progress=True)

        thread = threading.Thread(target=report, daemon=True)
        thread.start()
        try:
            yield
        finally:
            ended.set()
            thread.join()

    def _finish(self, cost: float, count: int = 1) -> None:
        self._count += count
        self._expected = max(self._expected, self._count)
        self._cost_left = max(self._cost_left - cost, 0.0)

    def _left(self, seconds: float = 0.0) -> str:
        """Text for the remaining time. `seconds`: time that the current work has taken so far."""
        if self._rate is None:
            return ""
        left = self._cost_left * self._rate - seconds
        return f", about {duration(left)} left" if left > 0 else ""

    def _say(self, text: str, in_progress: bool = False) -> None:
        line = f"[{self._count:3d}/{self._expected}] {text}"
        if sys.stdout.isatty():
            print(f"{_CLEAR_LINE}{line}", end="" if in_progress else "\n", flush=True)
        else:
            print(line, flush=True)


def duration(seconds: float) -> str:
    return f"{seconds:.0f} s" if seconds < 600 else f"{seconds / 60:.0f} min"
