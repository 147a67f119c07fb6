"""Steps of a longer work, each told as it begins: by this process, or by a line that another one prints."""

from __future__ import annotations

import contextlib
from collections.abc import Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from progress import Progress

_MARK = "step: "


def print_step(name: str) -> None:
    """For the process whose lines hear() gets."""
    print(f"{_MARK}{name}", flush=True)


class Steps:
    """A context manager; the work of a step ends when the next one begins, the last when the context ends."""

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
