"""One timer for all rendered viewports, which runs them between redraws, and a pause while Blender renders.

The library never calls into Python, so the timer looks for new pictures. It ends when no viewport has
anything to wait for.
"""

import contextlib
import threading

import bpy

_SECONDS = 0.02

_viewports = []
_lock = threading.Lock()  # guards _renders: renders have threads of their own
_renders = 0


def watch(viewport):
    """Call in the main thread. Calls viewport.turn() until it returns False, or until forget()."""
    if viewport not in _viewports:
        _viewports.append(viewport)
    if not bpy.app.timers.is_registered(_turn):
        bpy.app.timers.register(_turn, first_interval=_SECONDS, persistent=True)


def forget(viewport):
    if viewport in _viewports:
        _viewports.remove(viewport)


def viewports():
    """The viewports that have anything to wait for."""
    return tuple(_viewports)


def is_paused():
    return _renders > 0


@contextlib.contextmanager
def paused():
    """Pauses viewports during a render; they continue where they were. May be called from any thread."""
    global _renders
    with _lock:
        _renders += 1
    for viewport in tuple(_viewports):
        viewport.pause()
    try:
        yield
    finally:
        with _lock:
            _renders -= 1


def _turn():
    for viewport in tuple(_viewports):
        if not viewport.turn():
            forget(viewport)
    return _SECONDS if _viewports else None


def detach():
    if bpy.app.timers.is_registered(_turn):
        bpy.app.timers.unregister(_turn)
