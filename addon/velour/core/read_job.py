"""What Python reads itself, beside the thread that draws: used as a job of the library."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable

from ..native import Status, VelourError
from ..native.job import JobState, ProgressCallback

_SLICE_SECONDS = 0.1  # between two calls of a progress callback


class ReadJob:
    """Runs `read` on a thread of its own; result() is what it returned. `read` knows nothing of Blender.

    A cancel ends the waiting at once; the thread reads to the end of what it has begun, for nobody.
    """

    def __init__(self, read: Callable[[], object]):
        self._read, self._thread, self._cancelled = read, None, False
        self._result = self._error = None

    def start(self) -> ReadJob:
        self._cancelled, self._error, self._begun = False, None, time.monotonic()
        self._thread = threading.Thread(target=self._run, name="velour-read")
        self._thread.start()
        return self

    def _run(self) -> None:
        try:
            self._result = self._read()
        except Exception as error:  # belongs to whoever waits
            self._error = error

    def poll(self) -> JobState:
        running = self._thread.is_alive()
        state = "running" if running else "failed" if self._error else "done"
        return JobState(state, float(not running), "reading", time.monotonic() - self._begun, None, 0)

    def cancel(self) -> None:
        self._cancelled = True

    def wait(self, progress: ProgressCallback | None = None, timeout: float | None = None) -> bool:
        """As Job.wait(): raises what `read` raised."""
        end = math.inf if timeout is None else time.monotonic() + timeout
        while True:
            self._thread.join(max(0.0, min(_SLICE_SECONDS, end - time.monotonic())))
            if self._cancelled:
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
        """The thread keeps nothing but what it reads; its result goes with this object."""
        self._result = None
