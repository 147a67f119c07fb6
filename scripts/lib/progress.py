"""Says which of how many, how long it took, and about how long the rest will."""

from __future__ import annotations

import time
from contextlib import contextmanager


class Progress:
    """Work is announced with a cost in any unit; the time left follows from what the finished work took."""

    def __init__(self):
        self._count = self._expected = 0
        self._cost_left = self._cost_paid = self._seconds = 0.0

    def expect(self, cost: float, count: int = 1) -> None:
        self._expected += count
        self._cost_left += cost * count

    def skip(self, label: str, cost: float) -> None:
        """It was there already."""
        self._finish(cost)
        self._say(f"{label}: kept")

    @contextmanager
    def work(self, label: str, cost: float):
        start = time.monotonic()
        yield
        seconds = time.monotonic() - start
        self._cost_paid += cost
        self._seconds += seconds
        self._finish(cost)
        self._say(f"{label}: {seconds:.1f} s{self._left()}")

    def _finish(self, cost: float) -> None:
        self._count += 1
        self._expected = max(self._expected, self._count)
        self._cost_left = max(self._cost_left - cost, 0.0)

    def _left(self) -> str:
        left = self._cost_left * self._seconds / self._cost_paid
        return f", about {left / 60:.0f} min left" if left >= 90 else f", about {left:.0f} s left"

    def _say(self, text: str) -> None:
        print(f"[{self._count:3d}/{self._expected}] {text}", flush=True)
