"""SIGTERM, by which systems and batch engines end what takes too long."""

from __future__ import annotations

import contextlib
import signal

from ..native import Job


@contextlib.contextmanager
def stopping(job: Job):
    """Meanwhile the first SIGTERM ends a running render at a whole pass, and the second one the process."""

    def stop(_number, _frame):
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        job.stop()

    earlier = signal.signal(signal.SIGTERM, stop)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, earlier or signal.SIG_DFL)
