"""The library's jobs for a viewport: one at a time, for each takes all the threads that they have."""

import threading

_STOPPED, _ENDED = ("ready", "cancelled"), ("done", "failed")


class JobLine:
    """Jobs that begin, and begin anew, with go_on() alone."""

    def __init__(self):
        self._jobs = []  # not taken yet; the first of those that are not done runs, or is to
        self._closing = threading.Lock()  # of jobs, which other threads pause

    def add(self, job):
        self._jobs.append(job)
        return job

    def drop(self, job):
        with self._closing:
            self._jobs.remove(job)
            job.close()

    def go_on(self):
        """Starts the next one unless one runs."""
        for job in self._jobs:
            state = job.poll().state
            if state in _STOPPED:
                job.start()
            if state not in _ENDED:
                return

    def pause(self):
        """Called from any thread."""
        with self._closing:
            for job in self._jobs:
                job.cancel()

    def has(self, job):
        """Whether the job has its result; raises what it failed with."""
        return job.poll().state in _ENDED and job.wait(timeout=0)
