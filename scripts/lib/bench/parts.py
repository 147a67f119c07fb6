"""Keeps the results of a demonstration, and remakes only those whose inputs have changed."""

from __future__ import annotations

import functools
import hashlib
import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import velour
from velour.core import files

from . import run
from .progress import Progress
from .steps import Steps

_SOURCES = (Path(__file__).resolve().parents[1], Path(velour.__file__).parent)


@dataclass(frozen=True)
class Part:
    """Files that are made together."""

    name: str
    title: str
    steps: Mapping[str, float]  # seconds that each takes on two cores
    files: tuple[str, ...]  # files and folders that the part leaves in its folder

    def announce(self, progress: Progress) -> None:
        for cost in self.steps.values():
            progress.expect(cost)


class Parts:
    """`fresh`: makes everything again."""

    def __init__(self, progress: Progress, fresh: bool):
        self.progress, self.fresh = progress, fresh

    def make(
        self, part: Part, folder: Path, inputs: Mapping[str, Path], make: Callable[[Steps], dict]
    ) -> dict:
        """Returns the report of `make`, which makes the files of the part. "kept" in it says whether the
        files are from an earlier run with the same inputs, scripts, add-on, library and machine."""
        record = folder / f"{part.name}.kept.json"
        key = run.key({**inputs, "part": part, "code": _code()})
        if not self.fresh and (report := _report(record, key)) is not None:
            label = f"{part.title}, with the times of the run that made it"
            self.progress.skip(label, sum(part.steps.values()), len(part.steps))
            return {**report, "kept": True}
        record.unlink(missing_ok=True)
        with Steps(self.progress, part.steps) as steps:
            report = make(steps)
        hashes = {name: _hash(folder / name) for name in part.files}
        files.write_json(record, {"key": key, "files": hashes, "report": report})
        return {**report, "kept": False}


def _report(record: Path, key: str) -> dict | None:
    """The recorded report; None if the record has another key, or files are missing or have changed."""
    if not record.is_file():
        return None
    said = json.loads(record.read_text(encoding="utf-8"))
    same = all(_hash(record.with_name(name)) == value for name, value in said["files"].items())
    return said["report"] if same and said["key"] == key else None


def _hash(path: Path) -> str | None:
    """The hash of a file, or of the names and contents of a folder's files; None if there is neither."""
    if path.is_dir():
        contents = [[file.name, files.sha256(file)] for file in sorted(path.iterdir())]
        return hashlib.sha256(json.dumps(contents).encode()).hexdigest()
    return files.sha256(path) if path.is_file() else None


@functools.cache
def _code() -> str:
    """The hash of all scripts and of the add-on. run.key() adds that of the library."""
    sources = [path for folder in _SOURCES for path in sorted(folder.rglob("*.py"))]
    return hashlib.sha256("".join(map(files.sha256, sources)).encode()).hexdigest()
