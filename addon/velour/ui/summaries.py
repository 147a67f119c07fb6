"""What panels show of models: read once a content, beside the thread that draws (engine/write_lock.py)."""

import os

import bpy

from ..core.read_job import ReadJob
from ..export import ExportError
from ..export.files import StoredFile, absolute_path
from ..native import VelourError
from ..operators.job_target import key_of

_KEPT = 64
_TURN_SECONDS = 0.02
_summaries = {}  # identity: info, or the sentence why there is none; oldest first
_waiting = {}  # identity: name; what was asked for last comes first
_jobs = {}  # identity: ReadJob; one at most


def model_summary(image):
    """The model's info; the sentence why there is none; None while it is not read yet. For draw()."""
    known = identity(image)
    if known not in _summaries and known not in _jobs:
        _waiting[known] = key_of(image)
    if not is_at_rest() and not bpy.app.timers.is_registered(_turn):
        bpy.app.timers.register(_turn, persistent=True)
    return _summaries.get(known)


def is_at_rest():
    """Whether all that was asked for is known."""
    return not _waiting and not _jobs


def forget():
    _summaries.clear()
    _waiting.clear()
    for job in _jobs.values():
        job.close()
    _jobs.clear()
    if bpy.app.timers.is_registered(_turn):
        bpy.app.timers.unregister(_turn)


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


def _turn():
    """A timer: runs on the main thread between two redraws, and waits for nothing."""
    if not _jobs:
        _begin(*_waiting.popitem())
    for known, job in list(_jobs.items()):
        try:
            if job.wait(timeout=0.0):
                _keep(known, job.result())
        except (ExportError, VelourError) as error:
            _keep(known, str(error))
    return None if is_at_rest() else _TURN_SECONDS


def _begin(known, name):
    image = bpy.data.images.get(name)
    if image is not None:
        _jobs[known] = ReadJob(StoredFile.of(image, f"Model '{image.name}'").model_info).start()


def _keep(known, summary):
    del _jobs[known]
    _summaries[known] = summary
    while len(_summaries) > _KEPT:
        del _summaries[next(iter(_summaries))]
    redraw_panels()


def redraw_panels():
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "PROPERTIES":
                area.tag_redraw()
