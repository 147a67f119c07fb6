"""What panels show of models, read once a content and never while drawing: see engine/write_lock.py."""

import os

import bpy

from ..export import ExportError
from ..export.files import absolute_path, read_model
from ..native import VelourError

_KEPT = 64
_summaries = {}  # identity: info, or the sentence why there is none; oldest first
_waiting = {}  # identity: key of the image in bpy.data.images


def model_summary(image):
    """The model's info; the sentence why there is none; or None while it is not read yet."""
    identity = _identity(image)
    if identity not in _summaries and identity not in _waiting:
        _waiting[identity] = (image.name, image.library.filepath) if image.library else image.name
        if not bpy.app.timers.is_registered(_read_waiting):
            bpy.app.timers.register(_read_waiting)
    return _summaries.get(identity)


def forget():
    _summaries.clear()
    _waiting.clear()
    if bpy.app.timers.is_registered(_read_waiting):
        bpy.app.timers.unregister(_read_waiting)


def _identity(image):
    """Changes whenever the content may have changed; cheap. No pointer: undo replaces datablocks."""
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
    for identity, key in _waiting.items():
        image = bpy.data.images.get(key)
        if image is not None:
            _summaries[identity] = _read(image)
    _waiting.clear()
    while len(_summaries) > _KEPT:
        del _summaries[next(iter(_summaries))]
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
