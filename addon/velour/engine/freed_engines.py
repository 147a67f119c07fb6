"""Closes viewports whose engine Blender has freed, even if its Python half lives on; idle viewports have no
other clock."""

import weakref

import bpy

_SECONDS = 1.0

_viewports = weakref.WeakSet()


def watch(viewport):
    """Calls viewport.close() once viewport.is_freed()."""
    _viewports.add(viewport)
    if not bpy.app.timers.is_registered(_turn):
        bpy.app.timers.register(_turn, first_interval=_SECONDS, persistent=True)


def _turn():
    for viewport in tuple(_viewports):
        if viewport.is_freed():
            _viewports.discard(viewport)
            viewport.close()
    return _SECONDS if _viewports else None


def detach():
    if bpy.app.timers.is_registered(_turn):
        bpy.app.timers.unregister(_turn)
