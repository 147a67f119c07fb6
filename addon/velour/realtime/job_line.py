"""Queue of the library's jobs for a viewport: one at a time, since each uses all of their threads."""

import threading

_STOPPED, _ENDED = ("ready", "cancelled"), ("done", "failed")


class JobLine:
    """Queue of jobs that only go_on() starts and restarts."""

    def __init__(self):
        self._jobs = []  # not taken yet; the first unfinished one is running or next
        self._closing = threading.Lock()  # guards closing of jobs, which other threads pause

    def add(self, job):
        self._jobs.append(job)
        return job

    def drop(self, job):
        with self._closing:
            self._jobs.remove(job)
            job.close()

    def go_on(self):
        """Starts the next job unless one is running."""
        for job in self._jobs:
            state = job.poll().state
            if state in _STOPPED:
                job.start()
            if state not in _ENDED:
                return

    def pause(self):
        """Stops all jobs until go_on(). May be called from any thread."""
        with self._closing:
            for job in self._jobs:
                job.cancel()

    def has(self, job):
        """Whether the job has its result; raises its error if it failed."""
        return job.poll().state in _ENDED and job.wait(timeout=0)
