"""Keeps the threads that read out of Python for a while.

Blender looks up what temp_override() has set through Python, also while it runs an operator, for whose time
Python has let go of its lock. Up to Python 3.11 Blender takes a thread that holds the lock then for itself,
goes on without it, and crashes.
"""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Iterator

_PATIENCE = 1.0  # seconds for threads to come to their next pause; one that waits for a file server may never

_changed = threading.Condition()
_inside = 0  # threads in Python
_closed = 0  # of closed() that last


@contextlib.contextmanager
def inside() -> Iterator[None]:
    """What a thread does that reads."""
    _enter()
    try:
        yield
    finally:
        _leave()


def pause() -> None:
    """Of a thread that is inside(): here it waits while the gate is closed."""
    if _closed:
        _leave()
        _enter()


@contextlib.contextmanager
def closed() -> Iterator[None]:
    """For the main thread: until its end no thread that reads is in Python, but for one that has come to no
    pause within a second."""
    _count(1)
    try:
        _wait()
        yield
    finally:
        _count(-1)


@contextlib.contextmanager
def opened() -> Iterator[None]:
    """In the midst of closed(): what waits for a thread lets it go on."""
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
    """Of closed() that last."""
    global _closed
    if more:
        with _changed:
            _closed += more
            _changed.notify_all()


def _wait() -> None:
    """Until no thread is inside, if there is to be none."""
    with _changed:
        _changed.wait_for(lambda: not (_closed and _inside), _PATIENCE)
