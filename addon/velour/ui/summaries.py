"""Info on models and measurements for panels, read once per content on other threads than the drawing one
(engine/write_lock.py)."""

import functools
import os
from typing import NamedTuple

import bpy

from ..core.read_job import ReadJob
from ..export import ExportError
from ..export.files import ChangedFileError, StoredFile, absolute_path
from ..native import VelourError
from ..operators.job_target import key_of

_KEPT = 64
_TURN_SECONDS = 0.02
_READERS = {"Model": StoredFile.model_info, "Measurement": StoredFile.chosen_raw_info}
# Keys of these: _Asked.
_summaries = {}  # info, or a sentence why there is none; oldest first
_waiting = {}  # name; latest request first
_jobs = {}  # ReadJob; at most one of each kind
_changed = set()  # those whose sentence reports a changed file


class _Asked(NamedTuple):
    kind: str  # key in _READERS
    identity: tuple


def model_summary(image):
    """The model's info, or a sentence why there is none; None until it is read. Safe in draw()."""
    return _summary("Model", image)


def measurement_summary(image):
    """Like model_summary(), for a measurement or BTF, which is read completely."""
    return _summary("Measurement", image)


def is_changed(image):
    """Whether there is no summary because the file has changed since it was chosen. Safe in draw()."""
    return any(_Asked(kind, identity(image)) in _changed for kind in _READERS)


def _summary(kind, image):
    known = _Asked(kind, identity(image))
    if known not in _summaries and known not in _jobs:
        _waiting[known] = key_of(image)
    if not is_at_rest() and not bpy.app.timers.is_registered(_turn):
        bpy.app.timers.register(_turn, persistent=True)
    return _summaries.get(known)


def is_at_rest():
    """Whether all requests are done."""
    return not _waiting and not _jobs


def forget():
    _summaries.clear()
    _changed.clear()
    _waiting.clear()
    for job in _jobs.values():
        job.close()
    _jobs.clear()
    if bpy.app.timers.is_registered(_turn):
        bpy.app.timers.unregister(_turn)


def identity(image):
    """Cheap key that changes whenever the content may have changed."""
    path = absolute_path(image)
    if image.packed_file is not None:
        return image.name, path, image.velour.sha256, image.packed_file.size
    try:
        state = os.stat(path)
        return image.name, path, image.velour.sha256, state.st_mtime_ns, state.st_size
    except OSError:
        return image.name, path, image.velour.sha256


def _turn():
    """Timer on the main thread, between redraws; never blocks."""
    _begin_some()
    for known, job in list(_jobs.items()):
        try:
            if job.wait(timeout=0.0):
                _keep(known, job.result())
        except (ExportError, VelourError) as error:
            if isinstance(error, ChangedFileError):
                _changed.add(known)
            _keep(known, str(error))
    return None if is_at_rest() else _TURN_SECONDS


def _begin_some():
    """Starts at most one job of each kind, so that a large measurement does not delay models."""
    for known in reversed(tuple(_waiting)):
        if all(known.kind != other.kind for other in _jobs):
            _begin(known, _waiting.pop(known))


def _begin(known, name):
    image = bpy.data.images.get(name)
    if image is not None:
        stored = StoredFile.of(image, f"{known.kind} '{image.name}'")
        _jobs[known] = ReadJob(functools.partial(_READERS[known.kind], stored)).start()


def _keep(known, summary):
    del _jobs[known]
    _summaries[known] = summary
    while len(_summaries) > _KEPT:
        oldest = next(iter(_summaries))
        del _summaries[oldest]
        _changed.discard(oldest)
    redraw_panels()


def redraw_panels():
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "PROPERTIES":
                area.tag_redraw()
