"""What scripts/test --all has run: a stopped run goes on from there while the sources are the same."""

from __future__ import annotations

import hashlib
import json
import os
import subprocess
from pathlib import Path

from .cases import Case
from .groups import ROOT


class Campaign:
    """Groups that ended without a failure, by name. Anything changed in the tree starts from nothing."""

    def __init__(self, file: Path, sources: str):
        self._file, self._sources = file, sources
        self._ended: dict[str, list[Case]] = {}
        try:
            kept = json.loads(file.read_text())
            if kept["sources"] == sources:
                self._ended = {name: [Case(*case) for case in found] for name, found in kept["ended"].items()}
        except (OSError, ValueError, KeyError, TypeError):
            pass

    def kept(self, name: str) -> list[Case] | None:
        return self._ended.get(name)

    def keep(self, name: str, found: list[Case]) -> None:
        self._ended[name] = found
        self._file.parent.mkdir(parents=True, exist_ok=True)
        partial = self._file.with_suffix(".partial")
        partial.write_text(json.dumps({"sources": self._sources, "ended": self._ended}))
        os.replace(partial, self._file)


def sources() -> str:
    """A hash of the commit and of everything that differs from it."""

    def git(*arguments: str) -> bytes:
        return subprocess.run(["git", "-C", ROOT, *arguments], capture_output=True, check=True).stdout

    digest = hashlib.sha256(git("rev-parse", "HEAD") + git("diff", "HEAD", "--binary"))
    for name in git("ls-files", "--others", "--exclude-standard", "-z").split(b"\0")[:-1]:
        digest.update(name + b"\0" + (ROOT / os.fsdecode(name)).read_bytes())
    return digest.hexdigest()
