"""Results of files of tests that passed, so that the next run of the same sources does not repeat
them. No Blender is needed to import this."""

import contextlib
import hashlib
import json
import os
import re
from pathlib import Path

from . import report

_ROOT = Path(__file__).resolve().parents[2]
# Words of the programs that read documents, by themselves or by support.guide and support.snippets.
_READS_DOCS = re.compile(rb"docs|guide|snippets")


class Kept:
    """Tests by the name of their file, each with a hash of the file and of the sources that it tested."""

    def __init__(self, path, sources):
        """`path`: where they are kept between runs; None keeps nothing. `sources`: a hash of all that tests
        read except their own files and the documents."""
        self._path, self._sources = path, sources
        self._files = {}
        if path:
            with contextlib.suppress(OSError, ValueError, TypeError):
                self._files = dict(json.loads(path.read_text()))

    def tests(self, name, program):
        """The tests of a file that passed; None if it has not, or if it or the sources have changed since."""
        try:
            found = self._files[name]
            if found["hash"] == self._hash(program):
                return [report.Test(**test) for test in found["tests"]]
        except (KeyError, TypeError):
            pass
        return None

    def keep(self, name, program, tests):
        """Keeps them at once, so that an interrupted run loses nothing, if some passed and none failed."""
        outcomes = {test.outcome for test in tests}
        if not self._path or report.FAILED in outcomes or report.PASSED not in outcomes:
            return
        self._files[name] = {"hash": self._hash(program), "tests": [test._asdict() for test in tests]}
        self._path.parent.mkdir(parents=True, exist_ok=True)
        partial = self._path.with_suffix(".partial")
        partial.write_text(json.dumps(self._files))
        os.replace(partial, self._path)

    def _hash(self, program):
        text = program.read_bytes()
        digest = hashlib.sha256(self._sources.encode() + text)
        if _READS_DOCS.search(text):
            for page in (_ROOT / "README.md", *sorted((_ROOT / "docs").rglob("*.md"))):
                digest.update(page.read_bytes())
        return digest.hexdigest()
