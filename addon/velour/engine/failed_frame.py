"""Remembers that a view layer of a frame failed: Blender would still render the others, and discard them."""

import bpy

_frames = 0  # that Blender has begun to render


class FailedFrame:
    """Belongs to one engine, which Blender may keep for later frames."""

    def __init__(self):
        self._number = None

    def note(self):
        self._number = _frames

    @property
    def is_current(self):
        return self._number == _frames


@bpy.app.handlers.persistent
def _begin(*_args):
    global _frames
    _frames += 1


def attach():
    bpy.app.handlers.render_pre.append(_begin)


def detach():
    bpy.app.handlers.render_pre.remove(_begin)
