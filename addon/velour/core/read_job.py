"""What Python reads itself, beside the thread that draws: used as a job of the library."""

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
_PATIENCE = 2.0  # seconds that the end of the process waits for threads
_of_thread = threading.local()  # `cancelled`: the Event of the reading that a thread does
_all = weakref.WeakSet()


def is_cancelled() -> bool:
    """Whether nobody wants any more what this thread reads; False on threads that are no ReadJob's."""
    cancelled = getattr(_of_thread, "cancelled", None)
    if cancelled is None:
        return False
    reading_gate.pause()
    return cancelled.is_set()


def check() -> None:
    """Ends a reading that was cancelled: to be called between two pieces of what takes long."""
    if is_cancelled():
        raise VelourError(Status.CANCELLED, "The reading was cancelled.")


class ReadJob:
    """Runs `read` on a thread of its own; result() is what it returned. `read` knows nothing of Blender.

    A cancel ends the waiting at once; the thread goes on to the next check() in what it reads, for nobody.
    """

    def __init__(self, read: Callable[[], object]):
        self._read, self._thread, self._cancelled = read, None, threading.Event()
        self._result = self._error = None
        _all.add(self)

    def start(self) -> ReadJob:
        # Another Event: a thread that a cancel has left behind stays cancelled.
        self._cancelled, self._error, self._begun = threading.Event(), None, time.monotonic()
        # A daemon: the end of the process waits for no file server. _end_all() lets it end by itself.
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
            except Exception as raised:  # belongs to whoever waits
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
        """As Job.wait(): raises what `read` raised."""
        end = math.inf if timeout is None else time.monotonic() + timeout
        while True:
            with reading_gate.opened():
                self._thread.join(max(0.0, min(_SLICE_SECONDS, end - time.monotonic())))
            if self._cancelled.is_set():
                raise VelourError(Status.CANCELLED, "The reading was cancelled.")
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
        """Cancels what still runs; the result goes with this object."""
        self.cancel()
        self._result = None


def _end_all() -> None:
    """What is read in one piece, or by a file server that is gone, is left behind."""
    threads = [job._thread for job in _all if job._thread is not None]
    for job in _all:
        job.cancel()
    end = time.monotonic() + _PATIENCE
    for thread in threads:
        thread.join(max(0.0, end - time.monotonic()))


atexit.register(_end_all)
