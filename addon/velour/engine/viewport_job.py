"""The job of the library that renders what a viewport shows, and its picture."""

import threading
import time

from ..native import ProgressiveJob
from . import viewport_clock
from .viewport_picture import ViewportPicture

_LEAST_SECONDS = 0.05  # between two pictures
_SHARE = 0.1  # largest share of the main thread's time for pictures that only become less noisy
_LATEST = 2.0  # longest time in seconds that changes wait for a picture: they may make it obsolete


class ViewportJob:
    """Has no job at first and after close(). The last picture stays until another job has one."""

    def __init__(self):
        self._job = None
        self._closing = threading.Lock()  # guards the job, which other threads pause
        self._began = 0.0
        self._is_waiting = False  # the job starts when viewports are no longer paused
        self.options = None  # options of the job
        self.picture = ViewportPicture()

    def __bool__(self):
        return self._job is not None

    def restart(self, scene, options):
        """Begins from scratch. The scene must not change until halt()."""
        if self and options == self.options:
            self._job.restart()
        else:
            self.close()
            self._job = ProgressiveJob.of(scene, **options)
            self.options = options
        self.go_on()

    def go_on(self):
        """Continues where the job was, once nothing else renders."""
        self._is_waiting = viewport_clock.is_paused()
        self._began = time.monotonic()
        if not self._is_waiting:
            self._job.start()

    def halt(self):
        """Stops the job and keeps its picture for the next redraw."""
        if self:
            self._job.stop()
            self.take_picture()

    def pause(self):
        """May be called from any thread; go_on() ends the pause."""
        with self._closing:
            if self:
                self._job.cancel()

    def close(self):
        with self._closing:
            if self:
                self._job.close()
            self._job = None
        self.options = None
        self._is_waiting = False
        self.picture.begin()

    def raise_failure(self):
        """Raises the job's error if it failed."""
        if self and self._job.poll().state == "failed":
            self._job.wait()

    def is_unseen(self):
        """Whether the job runs and has no picture yet."""
        return bool(self) and self._job.poll().running and self._job.picture().width == 0

    def must_be_seen(self):
        """Whether changes wait for the job's picture: otherwise constant changes would show nothing."""
        return self.is_unseen() and time.monotonic() < self._began + _LATEST

    def await_first(self, seconds):
        end = time.monotonic() + seconds
        while self.is_unseen() and time.monotonic() < end:
            time.sleep(0.001)

    def take_picture(self):
        if self:
            self.picture.take(self._job)

    def turn(self):
        """Returns whether a redraw is due, and whether there is anything to come."""
        state = self._job.poll().state
        if self._is_waiting or state == "cancelled":
            self.go_on()
            return False, True
        more = state in ("running", "ready") or self.picture.is_behind(self._job)
        return state == "failed" or self._is_due(), more

    def _is_due(self):
        """Whether there is a new picture that is worth the time to draw it."""
        waited = time.monotonic() - self.picture.shown_at
        least = max(_LEAST_SECONDS, self.picture.seconds / _SHARE)
        return waited > least and self.picture.is_behind(self._job)
