"""What moves over frames."""

import contextlib

import bpy


@contextlib.contextmanager
def _linear():
    """New keys have straight curves, whatever the version's structure of actions."""
    edit = bpy.context.preferences.edit
    before, edit.keyframe_new_interpolation_type = edit.keyframe_new_interpolation_type, "LINEAR"
    yield
    edit.keyframe_new_interpolation_type = before


def move(owner, path, values, first=0):
    """Keys of a property at successive frames from `first` on; straight lines in between."""
    with _linear():
        for frame, value in enumerate(values, first):
            setattr(owner, path, value)
            owner.keyframe_insert(path, frame=frame)


def blur(scene, shutter=1.0, position="CENTER"):
    """Motion blur in frame 1, for Cycles and Velour."""
    scene.frame_set(1)
    render = scene.render
    render.use_motion_blur, render.motion_blur_shutter = True, shutter
    owner = render if hasattr(render, "motion_blur_position") else scene.cycles
    owner.motion_blur_position = position
