"""What panels show of models, read once a content and never while drawing: see engine/write_lock.py."""

import os

import bpy

from ..export import ExportError
from ..export.files import absolute_path, read_model
from ..native import VelourError

_KEPT = 64
_summaries = {}  # identity: info, or the sentence why there is none; oldest first
_waiting = {}  # identity: name


def model_summary(image):
    """The model's info; the sentence why there is none; or None while it is not read yet."""
    known = identity(image)
    if known not in _summaries and known not in _waiting:
        _waiting[known] = name_of(image)
        if not bpy.app.timers.is_registered(_read_waiting):
            bpy.app.timers.register(_read_waiting)
    return _summaries.get(known)


def forget():
    _summaries.clear()
    _waiting.clear()
    if bpy.app.timers.is_registered(_read_waiting):
        bpy.app.timers.unregister(_read_waiting)


def name_of(image):
    """The key of the image in bpy.data.images. No pointer: undo replaces datablocks."""
    return (image.name, image.library.filepath) if image.library else image.name


def identity(image):
    """Changes whenever the content may have changed; cheap."""
    path = absolute_path(image)
    if image.packed_file is not None:
        return image.name, path, image.velour.sha256, image.packed_file.size
    try:
        state = os.stat(path)
        return image.name, path, image.velour.sha256, state.st_mtime_ns, state.st_size
    except OSError:
        return image.name, path, image.velour.sha256


def _read_waiting():
    """A timer: runs on the main thread between two redraws."""
    for known, name in _waiting.items():
        image = bpy.data.images.get(name)
        if image is not None:
            _summaries[known] = _read(image)
    _waiting.clear()
    while len(_summaries) > _KEPT:
        del _summaries[next(iter(_summaries))]
    redraw_panels()


def redraw_panels():
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "PROPERTIES":
                area.tag_redraw()


def _read(image):
    try:
        with read_model(image, f"Model '{image.name}'") as model:
            return model.info()
    except (ExportError, VelourError) as error:
        return str(error)
