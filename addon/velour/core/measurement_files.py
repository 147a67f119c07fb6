"""Finds the measurements and models of a folder by name, without opening a file."""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from typing import NamedTuple

# Without .exr and .xml, which are mostly other pictures and data.
MODELS = (".velour",)
MEASUREMENTS = (".binary", ".bsdf", ".brdf", ".btf")
SUFFIXES = (*MODELS, *MEASUREMENTS)
_OFTEN_OTHERS = (".exr", ".xml")  # tables, and BSDFs of Radiance and WINDOW
INDICES = ("btf.json", "btf.csv")  # each makes its folder one BTF; the first one present counts
MOST_ENTRIES = 100_000  # entries visited at most: a folder may be the root of a file server
_MOST_DEPTH = 8


def file_filter(without: str = "") -> str:
    """Filter of a file browser for everything that a material can be made of, except the suffix `without`."""
    suffixes = (suffix for suffix in (*SUFFIXES, *_OFTEN_OTHERS) if suffix != without)
    return ";".join((*(f"*{suffix}" for suffix in suffixes), *INDICES))


class MeasurementFile(NamedTuple):
    """Identifies the state of a file, but not of the pictures that the index of a BTF names."""

    path: str
    name: str  # relative to the folder that was searched, without the suffix
    bytes: int  # for a BTF folder: size of its index
    modified: int  # nanoseconds


class Found(NamedTuple):
    files: tuple[MeasurementFile, ...]  # in natural order: 2 before 10
    problems: tuple[str, ...]  # one sentence each


def find_measurements(folder: str | os.PathLike, stopped: Callable[[], bool] = lambda: False) -> Found:
    """Searches the folder and its subfolders. Ends with what was found so far if `stopped` returns True."""
    search = _Search(os.path.abspath(folder), stopped)
    search.run()
    return Found(tuple(sorted(search.files, key=_order)), tuple(search.problems))


def _order(file: MeasurementFile) -> list:
    parts = re.split(r"(\d+)", file.name.casefold())
    return [(int(part), part) if number % 2 else (0, part) for number, part in enumerate(parts)]


class _Search:
    def __init__(self, folder: str, stopped: Callable[[], bool]):
        self._folder, self._stopped, self._looked_at = folder, stopped, 0
        self.files, self.problems = [], []

    def run(self) -> None:
        waiting = [(self._folder, 0)]
        while waiting and not self._stopped():
            folder, depth = waiting.pop()
            try:
                below = self._look_into(folder)
            except OSError as error:
                self.problems.append(
                    f"{folder} cannot be read ({error.strerror}); check its name and permissions."
                )
                continue
            if self._looked_at >= MOST_ENTRIES:
                self.problems.append(
                    f"{self._folder}: only the first {MOST_ENTRIES:,} entries were searched; choose a"
                    " subfolder."
                )
                return
            if depth < _MOST_DEPTH:
                waiting.extend((each, depth + 1) for each in below)

    def _look_into(self, folder: str) -> list[str]:
        """Adds the files in a folder. Returns the subfolders to search."""
        below, found, indices = [], [], {}
        with os.scandir(folder) as entries:
            for entry in entries:
                self._looked_at += 1
                if self._looked_at >= MOST_ENTRIES or self._stopped():
                    break
                if entry.name in INDICES:
                    indices[entry.name] = entry
                elif entry.name.lower().endswith(SUFFIXES):
                    found.append(entry)
                elif not entry.name.startswith(".") and entry.is_dir(follow_symlinks=False):
                    below.append(entry.path)
        if indices:  # the rest belongs to the BTF
            found, below = [next(indices[name] for name in INDICES if name in indices)], []
        for entry in found:
            self._add(entry)
        return below

    def _add(self, entry: os.DirEntry) -> None:
        try:
            if not entry.is_file():
                return
            state = entry.stat()
        except OSError:  # removed meanwhile
            return
        named = os.path.dirname(entry.path) if entry.name in INDICES else os.path.splitext(entry.path)[0]
        name = os.path.basename(named) if named == self._folder else os.path.relpath(named, self._folder)
        self.files.append(MeasurementFile(entry.path, name, state.st_size, state.st_mtime_ns))
