"""Makes thumbnails of many files on a background thread."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path

from ..native.job_state import JobState
from .measurement_files import MeasurementFile
from .read_job import ReadJob, check
from .thumbnails import Thumbnail, thumbnail


class ThumbnailJob(ReadJob):
    """Makes the thumbnails of `files` in order and passes each to `receive`, on a thread of its own.

    After a cancel the thread ends as soon as the library has read the current file."""

    def __init__(
        self,
        files: Iterable[MeasurementFile],
        cache: Path,
        receive: Callable[[MeasurementFile, Thumbnail], object],
        threads: int = 1,
    ):
        super().__init__(self._make_all)
        self.files, self._cache, self._receive, self._threads = tuple(files), cache, receive, threads
        self._done = 0

    def poll(self) -> JobState:
        state = super().poll()
        if not state.running or not self._done:
            return state._replace(stage="rendering thumbnails")
        left = state.seconds / self._done * (len(self.files) - self._done)
        return state._replace(
            fraction=self._done / len(self.files), stage="rendering thumbnails", seconds_left=left
        )

    def _make_all(self) -> None:
        self._done = 0
        for file in self.files:
            check()
            self._receive(file, thumbnail(file, self._cache, check, self._threads))
            self._done += 1
