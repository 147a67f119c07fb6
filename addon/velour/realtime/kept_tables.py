"""Cache of materials' tables by content, so that another export of the same materials reuses them."""

from __future__ import annotations

import hashlib
from typing import NamedTuple

import numpy as np

from .job_line import JobLine


class Part(NamedTuple):
    """Part of a material: the key of a table of the library, and what the table is turned into."""

    key: tuple  # identifies everything that it is made from
    tables: object  # called with gpu, the job, and the matrix to the working space


class KeptTables:
    """Tables of a viewport, which outlive its scenes, and the jobs of pending ones."""

    def __init__(self, line=None):
        self._line = JobLine() if line is None else line
        self._jobs = {}
        self._made = {}

    def close(self):
        for job in self._jobs.values():
            self._line.drop(job)
        self.__init__(self._line)

    def ask(self, key, make_job):
        """Queues the job of a table unless that exists or is pending."""
        if key not in self._made and key not in self._jobs:
            self._jobs[key] = self._line.add(make_job())

    def has(self, gpu, parts, to_working):
        """Whether all Parts exist, which must have been requested; drops all others."""
        wanted = {part.key: part.tables for part in parts}
        for key in self._jobs.keys() - wanted.keys():
            self._line.drop(self._jobs.pop(key))
        self._made = {key: made for key, made in self._made.items() if key in wanted}
        for key in tuple(self._jobs):
            if self._line.has(self._jobs[key]):
                self._made[key] = wanted[key](gpu, self._jobs[key], to_working)
                self._line.drop(self._jobs.pop(key))
        return not self._jobs

    def __getitem__(self, key):
        return self._made[key]

    def values(self):
        return self._made.values()


def digest(content):
    """Hash of bytes or an array, equal only for equal content."""
    return hashlib.blake2b(
        np.ascontiguousarray(content) if isinstance(content, np.ndarray) else content
    ).digest()
