"""Contents of the measurement browser: a folder's files, and thumbnails of those shown.

Neither is made on the drawing thread. The latest request comes first; thumbnails wait for renders.
"""

import collections
from pathlib import Path
from typing import NamedTuple

import bpy
import bpy.utils.previews
import numpy as np

from ..core.measurement_files import find_measurements
from ..core.read_job import ReadJob, is_cancelled
from ..core.thumbnail_job import ThumbnailJob
from ..export.caches import cache_folder
from ..native import VelourError
from .summaries import redraw_panels

_KEPT = 600  # thumbnails; 64 kB each
_ASKED = 100
_TURN_SECONDS = 0.1
_found = {}  # (folder, visits): Found; one at most
_wanted = []  # (folder, visits); one at most
_searches = {}  # (folder, visits): _Search; one at most
_pictures = {}  # MeasurementFile: Picture; oldest first
_asked = collections.OrderedDict()  # MeasurementFile: None; latest request first
_works = []  # _Work; one at most
_previews = None


class Picture(NamedTuple):
    icon: int  # 0: none
    facts: dict
    sentence: str | None  # why there is no icon


class _Search:
    def __init__(self, folder):
        self.stopped = False
        self.job = ReadJob(lambda: find_measurements(folder, lambda: self.stopped or is_cancelled())).start()


class _Work:
    """Makes the thumbnails that have been requested so far."""

    def __init__(self):
        self._made = collections.deque()  # appended to by the job's thread
        self.job = ThumbnailJob(_asked, Path(cache_folder()), lambda *made: self._made.append(made)).start()

    def take(self):
        """Yields MeasurementFile and Thumbnail of each thumbnail made since the last call."""
        while self._made:
            yield self._made.popleft()


def found(folder, visits):
    """The files of the folder; None while it is searched. Safe in draw()."""
    key = folder, visits
    if key not in _found and key not in _searches:
        _wanted[:] = [key]
        _go_on()
    return _found.get(key)


def picture(file):
    """The Picture of a file; None if there is none yet. Safe in draw()."""
    return _pictures.get(file)


def ask(files):
    """Requests thumbnails of files, in this order. Safe in draw()."""
    for file in reversed([file for file in files if file not in _pictures]):
        _asked[file] = None
        _asked.move_to_end(file, last=False)
    while len(_asked) > _ASKED:
        _asked.popitem()
    if _asked:
        _go_on()


def is_at_rest():
    """Whether all requests are done."""
    return not _wanted and not _searches and not _asked and not _works


def forget():
    global _previews
    for work in _works:
        work.job.cancel()
    for search in _searches.values():
        search.stopped = True
    for kept in (_found, _wanted, _searches, _pictures, _asked, _works):
        kept.clear()
    if bpy.app.timers.is_registered(_turn):
        bpy.app.timers.unregister(_turn)
    if _previews is not None:
        bpy.utils.previews.remove(_previews)
        _previews = None


def _go_on():
    if not bpy.app.timers.is_registered(_turn):
        bpy.app.timers.register(_turn, persistent=True)


def _turn():
    """Timer on the main thread, between redraws; never blocks."""
    _search()
    _make()
    return None if is_at_rest() else _TURN_SECONDS


def _search():
    """Starts threads here, not in draw(), where that would let other threads run (engine/write_lock.py)."""
    if _wanted:
        for search in _searches.values():
            search.stopped = True
        _searches.clear()
        _asked.clear()
        key = _wanted.pop()
        _searches[key] = _Search(key[0])
    for key, search in list(_searches.items()):
        if search.job.wait(timeout=0.0):
            del _searches[key]
            _found.clear()
            _found[key] = search.job.result()
            redraw_panels()


def _make():
    rendering = bpy.app.is_job_running("RENDER")
    for work in list(_works):
        first = next(iter(_asked), None)
        if rendering or (first is not None and first not in work.job.files):
            work.job.cancel()
        ended = not work.job.poll().running
        for made in work.take():
            _show(*made)
        if ended:
            _works.remove(work)
            _end(work.job)
    if _asked and not _works and not rendering:
        _works.append(_Work())


def _end(job):
    try:
        job.wait()
    except VelourError as error:
        if not error.cancelled:
            raise


def _show(file, thumbnail):
    _asked.pop(file, None)
    icon = _icon(str(file), thumbnail.pixels) if thumbnail.pixels is not None else 0
    _pictures[file] = Picture(icon, thumbnail.facts, thumbnail.sentence)
    while len(_pictures) > _KEPT:
        oldest = next(iter(_pictures))
        del _pictures[oldest]
        if _previews is not None and str(oldest) in _previews:
            del _previews[str(oldest)]  # pop() would not free the icon
    redraw_panels()


def _icon(name, pixels):
    global _previews
    if _previews is None:
        _previews = bpy.utils.previews.new()
    preview = _previews.get(name) or _previews.new(name)
    preview.image_size = pixels.shape[1], pixels.shape[0]
    preview.image_pixels_float.foreach_set((pixels / np.float32(255)).ravel())
    return preview.icon_id
