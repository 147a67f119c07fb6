"""Keeps reader threads out of Python for a while.

Blender looks up the members of temp_override() through Python, even while an operator runs and Python has
released its lock. Up to Python 3.11 Blender then mistakes a thread that holds the lock for its own, continues
without the lock, and crashes.
"""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Iterator

_PATIENCE = 1.0  # seconds for threads to reach pause(); one that waits for a file server may never do so

_changed = threading.Condition()
_inside = 0  # number of reader threads in Python
_closed = 0  # number of active closed() blocks


@contextlib.contextmanager
def inside() -> Iterator[None]:
    """The block in which a reader thread works."""
    _enter()
    try:
        yield
    finally:
        _leave()


def pause() -> None:
    """Call within inside(): waits while the gate is closed."""
    if _closed:
        _leave()
        _enter()


@contextlib.contextmanager
def closed() -> Iterator[None]:
    """For the main thread: no reader thread is in Python within this block, except one that did not reach
    pause() within a second."""
    _count(1)
    try:
        _wait()
        yield
    finally:
        _count(-1)


@contextlib.contextmanager
def opened() -> Iterator[None]:
    """Within closed(): lets reader threads continue while the caller waits for one."""
    before = _closed
    _count(-before)
    try:
        yield
    finally:
        _count(before)
        _wait()


def _enter() -> None:
    global _inside
    with _changed:
        _changed.wait_for(lambda: not _closed)
        _inside += 1


def _leave() -> None:
    global _inside
    with _changed:
        _inside -= 1
        _changed.notify_all()


def _count(more: int) -> None:
    """Adds to the number of active closed() blocks."""
    global _closed
    if more:
        with _changed:
            _closed += more
            _changed.notify_all()


def _wait() -> None:
    """Waits until no thread is inside, if the gate is closed; at most _PATIENCE."""
    with _changed:
        _changed.wait_for(lambda: not (_closed and _inside), _PATIENCE)
