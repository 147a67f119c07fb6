"""References made new, and put in the place of earlier ones only if somebody approves of the difference."""

from __future__ import annotations

import itertools
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path

from velour.core import files

from . import check, passes_file, reference
from .blender import Installation
from .case import Case, Outcome, Settings


class Staged:
    """New references that wait in a folder for approval. Threads may add to it."""

    def __init__(self, folder: Path):
        self._folder, self._numbers = folder, itertools.count(1)
        self._made: dict[Path, Path] = {}  # new picture by the path that it is for

    def add(self, path: Path, renders: check.Renders) -> None:
        """`path`: of the picture of the reference that is to be replaced."""
        new = self._folder / f"{next(self._numbers):03d}" / path.name
        new.parent.mkdir(parents=True)
        check.write(new, renders)
        self._made[path] = new

    def approve(self, yes: bool) -> int:
        """Replaces the references if `yes`, or if the terminal says so; the exit status."""
        count = len(self._made)
        if count == 0:
            return 0
        if not yes and not sys.stdin.isatty():
            print(f"{_references(count)} kept; look at the page, and approve with --update --yes.")
            return 1
        if not yes and not _asked(f"Replace {_references(count)} by the new ones on the page? [y/N] "):
            print(f"{_references(count)} kept.")
            return 1
        for path, new in sorted(self._made.items()):
            _replace(path, new)
        print(f"{_references(count)} replaced.")
        return 0


def update(
    case: Case, blender: Installation, settings: Settings, pictures: int, staged: Staged
) -> Iterator[Outcome]:
    """Writes the references that do not exist yet; those that do are compared and go to `staged`."""

    def outcome_of(frame: int | None, renders: check.Renders) -> Outcome:
        path = case.references[frame]
        if not path.is_file():
            return check.written(case, frame, renders)
        outcome = check.judged(case, frame, renders, pictures)
        staged.add(path, renders)
        outcome.passed, outcome.to_approve = True, True
        return outcome

    return check.rendered(case, blender, settings, True, outcome_of)


def _replace(path: Path, new: Path) -> None:
    """The passes last: they are bound to the picture, so that a half replaced reference is noticed."""
    for place in (reference.error_path, Path, passes_file.passes_path):
        source = place(new)
        files.write_atomic(place(path), lambda temporary, source=source: shutil.copyfile(source, temporary))


def _asked(question: str) -> bool:
    try:
        return input(question).strip().lower() in ("y", "yes")
    except EOFError:
        return False


def _references(count: int) -> str:
    return f"{count} reference{'s' if count > 1 else ''}"
