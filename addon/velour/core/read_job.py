"""Runs Python code that reads files on a thread of its own, with the interface of a library job."""

from __future__ import annotations

import atexit
import math
import threading
import time
import weakref
from collections.abc import Callable

from ..native import Status, VelourError
from ..native.job_state import JobState, ProgressCallback
from . import reading_gate

_SLICE_SECONDS = 0.1  # between two calls of a progress callback
_PATIENCE = 2.0  # seconds that the exit of the process waits for the threads
_of_thread = threading.local()  # `cancelled`: Event of the thread's ReadJob
_all = weakref.WeakSet()


def is_cancelled() -> bool:
    """Whether this thread's ReadJob was canceled; False on other threads."""
    cancelled = getattr(_of_thread, "cancelled", None)
    if cancelled is None:
        return False
    reading_gate.pause()
    return cancelled.is_set()


def check() -> None:
    """Raises VelourError if this thread's ReadJob was canceled. Call it between the steps of long work."""
    if is_cancelled():
        raise VelourError(Status.CANCELLED, "Reading was canceled.")


class ReadJob:
    """Runs `read` on a thread of its own; result() is what it returned. `read` must not use Blender.

    A cancel ends wait() at once; the thread runs on to its next check(), and its result is discarded.
    """

    def __init__(self, read: Callable[[], object]):
        self._read, self._thread, self._cancelled = read, None, threading.Event()
        self._result = self._error = None
        _all.add(self)

    def start(self) -> ReadJob:
        # A new Event: a thread left behind by a cancel stays cancelled.
        self._cancelled, self._error, self._begun = threading.Event(), None, time.monotonic()
        # A daemon: the process must not wait for a file server at exit. _end_all() gives it time to finish.
        self._thread = threading.Thread(
            target=self._run, args=(self._cancelled,), name="velour-read", daemon=True
        )
        self._thread.start()
        return self

    def _run(self, cancelled: threading.Event) -> None:
        _of_thread.cancelled = cancelled
        with reading_gate.inside():
            try:
                result, error = self._read(), None
            except Exception as raised:  # wait() raises it
                result, error = None, raised
            if not cancelled.is_set():
                self._result, self._error = result, error

    def poll(self) -> JobState:
        running = self._thread.is_alive()
        ended = "cancelled" if self._cancelled.is_set() else "failed" if self._error else "done"
        state = "running" if running else ended
        return JobState(state, float(not running), "reading", time.monotonic() - self._begun, None, 0)

    def cancel(self) -> None:
        self._cancelled.set()

    def wait(self, progress: ProgressCallback | None = None, timeout: float | None = None) -> bool:
        """Like Job.wait(). Raises what `read` raised."""
        end = math.inf if timeout is None else time.monotonic() + timeout
        while True:
            with reading_gate.opened():
                self._thread.join(max(0.0, min(_SLICE_SECONDS, end - time.monotonic())))
            if self._cancelled.is_set():
                raise VelourError(Status.CANCELLED, "Reading was canceled.")
            if progress:
                progress(self.poll())
            if not self._thread.is_alive():
                if self._error is not None:
                    raise self._error
                return True
            if time.monotonic() >= end:
                return False

    def result(self) -> object:
        return self._result

    def close(self) -> None:
        """Cancels a running read and drops the result."""
        self.cancel()
        self._result = None


def _end_all() -> None:
    """Cancels all jobs. Threads within one long read, or waiting for a dead file server, are left behind."""
    threads = [job._thread for job in _all if job._thread is not None]
    for job in _all:
        job.cancel()
    end = time.monotonic() + _PATIENCE
    for thread in threads:
        thread.join(max(0.0, end - time.monotonic()))


atexit.register(_end_all)
