"""SIGTERM, by which systems and batch engines end what takes too long."""

from __future__ import annotations

import contextlib
import os
import signal
import time

from ..native import Job

_ONE_SIGNAL = 1.0  # seconds: engines send it to a whole group, of which one hands it on to another


class Stopping:
    """From hold() to release() SIGTERM ends the render that runs, at a whole pass, and a second one the
    process. So what is rendered is not lost while it is written: a signal that comes then is remembered.
    """

    def __init__(self):
        self._job: Job | None = None
        self._first: float | None = None
        self._earlier = None
        self._holds = False

    def hold(self) -> None:
        """In the main thread; again does nothing."""
        if not self._holds:
            self._earlier = signal.signal(signal.SIGTERM, self._stop)
            self._holds, self._first = True, None

    @contextlib.contextmanager
    def rendering(self, job: Job):
        """`job`, which has begun, is what the signal ends meanwhile; at once if it came before."""
        self._job = job
        try:
            if self._first is not None:
                job.stop()
            yield
        finally:
            self._job = None

    def release(self, obey: bool = False) -> None:
        """With `obey` the process ends now by a signal that came."""
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
    """Of one render, which has begun, until what it made is written."""
    held = Stopping()
    held.hold()
    try:
        with held.rendering(job):
            yield
    finally:
        held.release()
