"""Evaluates frames of a scene in render mode, without rendering.

Blender gives Python an evaluated scene in render mode (render visibility, render levels of modifiers, every
view layer) only inside a render engine. So a copy of the scene is "rendered", and the engine calls a visitor
instead. The scene itself, its current frame and its render result remain unchanged.
"""

import contextlib

import bpy

from .notes import ExportError
from .other_context import other_context

_visit = None


def current():
    """Function that the engine calls with itself and the depsgraph instead of rendering; None: it renders."""
    return _visit


def visit_frame(scene, frame, visit, engine_id):
    """Calls `visit(engine, depsgraph)` for every enabled view layer; raises its first exception."""
    errors = []

    def guarded(engine, depsgraph):
        try:
            if not errors:
                visit(engine, depsgraph)
        except Exception as error:
            errors.append(error)

    with (
        _kept_frame(scene),
        _copy(scene, frame, engine_id) as copy,
        _instead_of_rendering(guarded),
        other_context(scene=copy),  # Blender renders the frame of the context's scene
    ):
        _render(copy)
    if errors:
        raise errors[0]


def _render(scene):
    try:
        bpy.ops.render.render(scene=scene.name)
    except RuntimeError as error:  # Blender itself refuses, as without a camera
        sentence = str(error).splitlines()[0].removeprefix("Error: ")
        raise ExportError(f"The scene cannot be evaluated: {sentence}.") from error


@contextlib.contextmanager
def _kept_frame(scene):
    """Restores the frame: rendering a copy leaves that frame's animated values in the original scene, too."""
    try:
        yield
    finally:
        scene.frame_set(scene.frame_current, subframe=scene.frame_subframe)


@contextlib.contextmanager
def _copy(scene, frame, engine_id):
    copy = scene.copy()
    try:
        copy.render.engine = engine_id
        copy.render.use_border = copy.render.use_compositing = copy.render.use_sequencer = False
        copy.render.use_single_layer = False
        copy.render.use_freestyle = False  # strokes alone take seconds, and crash Blender 4.3 and 5.2
        copy.render.use_persistent_data = False  # nothing of the copy may outlive it
        copy.frame_current = frame
        yield copy
    finally:
        # scenes.remove crashes Blender 3.4 if the context has no window, as in timers.
        bpy.data.batch_remove((copy,))


@contextlib.contextmanager
def _instead_of_rendering(visit):
    global _visit
    _visit = visit
    try:
        yield
    finally:
        _visit = None
