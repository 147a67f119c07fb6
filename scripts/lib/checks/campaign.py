"""Results of scripts/test --all: the next run does not repeat groups whose sources are unchanged."""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import re
from pathlib import Path

from .cases import FAILED, PASSED, Case, count
from .groups import ROOT
from .sources import sources

# What runs the groups; the tests of this itself are in Python.
_RUNNER = ("scripts/lib/checks/", "scripts/lib/test_run.py")
_TESTS = ("addon/tests/", "native/tests/", "native/fuzz/")
# Measured pages that no test renders; the tests of their scripts are in Python.
_PAGES = tuple(f"scripts/lib/bench/{part}" for part in ("pages/", "night/", "inside/night", "inside/gallery"))
_DOCUMENTS = ("docs/", "README.md", "CHANGELOG.md")
# Paths that no test of a group reads. Groups that are not listed may read everything.
_UNREAD: dict[str, tuple[str, ...]] = {
    "native": ("addon/", "blend-tests/", *_DOCUMENTS, "scripts/lib/"),
    "fuzz": ("addon/", "blend-tests/", *_DOCUMENTS, "scripts/lib/"),
    "scenes": (*_TESTS, *_PAGES, *_DOCUMENTS, *_RUNNER),
    "night": (*_TESTS, *_DOCUMENTS, *_RUNNER),
    "blender": (*_TESTS, *_PAGES, *_RUNNER),
}
# blend-tests/run itself sees whether these have changed.
_SEEN_BY_FILES = re.compile(r"blend-tests/(parity/)?(test|window)_\w+\.py$|docs/|README\.md$|CHANGELOG\.md$")


class Campaign:
    """Groups that passed, by name, each with a hash of the sources that it was run on."""

    def __init__(self, file: Path, root: Path = ROOT):
        self._file, self._root = file, root
        self._at_first: dict[str, str] = {}  # hashes before a run, so that changes during it are noticed
        self._ended = self._read()

    def _read(self) -> dict[str, dict]:
        with contextlib.suppress(OSError, ValueError, TypeError):
            return dict(json.loads(self._file.read_text()))
        return {}

    def kept(self, name: str) -> list[Case] | None:
        """The group's cases, or None if it has not passed or its sources have changed since."""
        self._at_first[name] = self._sources(name)
        try:
            ended = self._ended[name]
            return (
                [Case(*case) for case in ended["cases"]] if ended["sources"] == self._at_first[name] else None
            )
        except (KeyError, TypeError):
            return None

    def keep(self, name: str, found: list[Case]) -> None:
        """Keeps a group if some of it passed and none failed: what was skipped may run another time. Call it
        after kept() returned None. What a run of other groups beside this one has added to the file stays."""
        counts = count(found)
        if counts[FAILED] or not counts[PASSED]:
            return
        self._ended |= self._read()
        self._ended[name] = {"sources": self._at_first[name], "cases": found}
        self._file.parent.mkdir(parents=True, exist_ok=True)
        partial = self._file.with_suffix(".partial")
        partial.write_text(json.dumps(self._ended))
        os.replace(partial, self._file)

    def sources_but_files(self, name: str) -> str:
        """A hash of what each file of tests in Blender reads except itself and the documents."""
        return self._sources(name, _SEEN_BY_FILES)

    def _sources(self, name: str, without: re.Pattern[str] | None = None) -> str:
        """A hash of all sources, except those that no test of the group reads and what `without` matches.
        "blender 5.2" reads the same as "blender"."""
        unread = _UNREAD.get(name.split()[0], ())
        digest = hashlib.sha256()
        for file in sources(self._root):
            if file.startswith(unread) or (without and without.match(file)):
                continue
            if (path := self._root / file).is_file():
                digest.update(os.fsencode(file) + b"\0" + hashlib.sha256(path.read_bytes()).digest())
        return digest.hexdigest()
