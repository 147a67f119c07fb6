"""Handles SIGTERM, with which systems and batch engines end processes that take too long."""

from __future__ import annotations

import contextlib
import os
import signal
import time

from ..native import Job

_ONE_SIGNAL = 1.0  # seconds: engines signal a whole group, whose members pass it on: this counts once


class Stopping:
    """From hold() to release(), SIGTERM ends the running render after a whole pass; a second one ends the
    process. A signal during writing is remembered, so that what was rendered is not lost.
    """

    def __init__(self):
        self._job: Job | None = None
        self._first: float | None = None
        self._earlier = None
        self._holds = False

    def hold(self) -> None:
        """Call in the main thread. Repeated calls do nothing."""
        if not self._holds:
            self._earlier = signal.signal(signal.SIGTERM, self._stop)
            self._holds, self._first = True, None

    @contextlib.contextmanager
    def rendering(self, job: Job):
        """Within this block the signal ends `job`, which has started; at once if it came before."""
        self._job = job
        try:
            if self._first is not None:
                job.stop()
            yield
        finally:
            self._job = None

    def release(self, obey: bool = False) -> None:
        """With `obey`, a signal that was remembered ends the process now."""
        if not self._holds:
            return
        signal.signal(signal.SIGTERM, self._earlier or signal.SIG_DFL)
        self._holds = False
        if obey and self._first is not None:
            os.kill(os.getpid(), signal.SIGTERM)

    def _stop(self, number, _frame) -> None:
        if self._first is None:
            self._first = time.monotonic()
            if self._job:
                self._job.stop()
        elif time.monotonic() - self._first > _ONE_SIGNAL:
            signal.signal(number, signal.SIG_DFL)
            os.kill(os.getpid(), number)


@contextlib.contextmanager
def stopping(job: Job):
    """Holds the signal for one render, which has started, until its result is written."""
    held = Stopping()
    held.hold()
    try:
        with held.rendering(job):
            yield
    finally:
        held.release()
