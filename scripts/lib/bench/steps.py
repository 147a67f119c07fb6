"""Progress of work in steps. Each step is announced when it begins, by a call or by a printed line."""

from __future__ import annotations

import contextlib
from collections.abc import Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .progress import Progress

_MARK = "step: "


def print_step(name: str) -> None:
    """Announces a step to the process that passes the printed lines to hear()."""
    print(f"{_MARK}{name}", flush=True)


class Steps:
    """A context manager. A step ends when the next one begins, the last one with the context."""

    def __init__(self, progress: Progress, costs: Mapping[str, float]):
        self._progress, self._costs = progress, costs
        self._work = contextlib.ExitStack()

    def __enter__(self) -> Steps:
        return self

    def __exit__(self, *error) -> None:
        self._work.__exit__(*error)

    def begin(self, name: str) -> None:
        self._work.close()
        self._work.enter_context(self._progress.work(name, self._costs[name]))

    def hear(self, line: str) -> None:
        if line.startswith(_MARK):
            self.begin(line.removeprefix(_MARK).strip())
