"""Scenes are looked at from timers, too, where the context has no window."""

import bpy

from support import window


def start(folder):
    window.run(folder, (from_a_timer,))


def from_a_timer(folder):
    """Every turn of a test is one; none of what is looked at stays behind."""
    assert bpy.context.window is None
    before = set(bpy.data.scenes)
    assert bpy.ops.velour.check_scene() == {"FINISHED"}
    assert set(bpy.data.scenes) == before
    yield 0.2
