"""SIGTERM, by which systems and batch engines end what takes too long."""

from __future__ import annotations

import contextlib
import os
import signal
import time

from ..native import Job

_ONE_SIGNAL = 1.0  # seconds: engines send it to a whole group, of which one hands it on to another


@contextlib.contextmanager
def stopping(job: Job):
    """Meanwhile SIGTERM ends a running render at a whole pass, and a second one the process."""
    first = None

    def stop(number, _frame):
        nonlocal first
        if first is None:
            first = time.monotonic()
            job.stop()
        elif time.monotonic() - first > _ONE_SIGNAL:
            signal.signal(number, signal.SIG_DFL)
            os.kill(os.getpid(), number)

    earlier = signal.signal(signal.SIGTERM, stop)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, earlier or signal.SIG_DFL)
