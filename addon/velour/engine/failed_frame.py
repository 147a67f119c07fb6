"""Remembers that a view layer of a frame failed: Blender would still render the others, and discard them."""

import bpy

from .written_file import end_render

_frames = 0  # that Blender has begun to render
_scene = ""  # name of the one that it renders; its compositor and sequencer may need others


class FailedFrame:
    """Belongs to one engine, which Blender may keep for later frames."""

    def __init__(self):
        self._number = None

    def note(self, scene):
        """Blender discards the frame of a scene that fails, but not what composites or cuts it: that ends."""
        self._number = _frames
        if _scene and scene.name_full != _scene:
            end_render()

    @property
    def is_current(self):
        return self._number == _frames


@bpy.app.handlers.persistent
def _begin(scene, *_args):
    global _frames, _scene
    _frames += 1
    _scene = scene.name_full


def attach():
    bpy.app.handlers.render_pre.append(_begin)


def detach():
    bpy.app.handlers.render_pre.remove(_begin)
