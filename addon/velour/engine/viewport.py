"""The rendered viewport: one 3D viewport that shows the scene while it is changed.

The main thread exports and draws; a job of the library renders. A change stops the job and is applied to the
library's scene; then the job starts again, coarse first.
"""

import functools
import logging
import weakref

import bpy

from ..export import ExportError
from ..export.changes import Changes
from ..export.film import film_exposure
from ..export.live import LiveExport
from ..export.look import Look
from ..export.viewport import viewport_frame
from ..native import VelourError
from ..realtime import UnshownError
from . import freed_engines, viewport_clock
from .engine_reference import engine_reference
from .options import samples_text, viewport_options
from .realtime_viewport import RealtimeViewport
from .refusal import Refusal
from .viewport_job import ViewportJob

log = logging.getLogger(__package__)

_PATIENCE = 0.04  # seconds that a change blocks Blender for the first picture of the previous change
_PROMPT = 0.04  # seconds for its own first picture, to show it in this redraw: another one would take longer

_all = weakref.WeakSet()


class Viewport:
    def __init__(self, engine):
        self._engine = engine_reference(engine)
        self._live = None  # LiveExport
        self._changes = Changes()  # not yet applied to it
        self._job = ViewportJob()
        self._key = None  # key of the view that the job shows; None: no view, or the scene has changed since
        self._place = None  # the picture's place in the region
        self._scene_error = self._view_error = ""
        self._real_time = None  # RealtimeViewport, if it shows the scene
        self._refusal = None  # why it cannot
        _all.add(self)
        freed_engines.watch(self)

    def close(self):
        viewport_clock.forget(self)
        self._drop_real_time()
        self._close_job()
        self._job = ViewportJob()  # without the last picture
        self._drop_scene()

    def is_freed(self):
        """Whether Blender has freed the engine."""
        return self._engine() is None

    def update(self, context, depsgraph):
        """Called when the scene has changed or is shown for the first time."""
        if self._refusal and self._refusal.may_be_over(depsgraph):
            self._refusal = None
        if self._is_real_time(depsgraph, lambda shown: shown.update(context, depsgraph)):
            return
        self._scene_error = ""
        self._take_up(context, depsgraph, is_told=True)

    def draw(self, context, depsgraph):
        lines = []
        show = functools.partial(self._draw_real_time, context, depsgraph)
        if self._is_real_time(depsgraph, lambda shown: lines.append(show(shown))):
            self._engine().update_stats("Velour", lines[0])
            return
        if self._live is None and not self._scene_error:
            self.update(context, depsgraph)  # its scene was forgotten
        elif self._changes:
            self._take_up(context, depsgraph, is_told=False)
        self._view_error = ""
        try:
            self._follow(context, depsgraph)
            self._show(depsgraph.scene_eval)
        except Exception as error:
            self._view_error = _sentence(error)
            self._close_job()
        line = self._scene_error or self._view_error or self._progress()
        said = self._refusal and self._refusal.sentence
        self._engine().update_stats("Velour", "; ".join(filter(None, (said, line))))

    def _draw_real_time(self, context, depsgraph, shown):
        line = shown.draw(context, depsgraph)
        if not shown.has_picture():  # keeps the ray tracer's meanwhile
            self._draw_picture(depsgraph.scene_eval)
        return line

    def _is_real_time(self, depsgraph, show):
        """Whether real time is chosen and works: `show` has been called with a RealtimeViewport.

        The ray tracer shows what real time cannot, with a sentence, until the Refusal may be over.
        """
        if depsgraph.scene.velour.viewport_mode != "REAL_TIME":
            self._drop_real_time()
            self._refusal = None
            return False
        if self._refusal:
            return False
        try:
            if self._real_time is None:
                self._close_job()
                self._drop_scene()
                self._real_time = RealtimeViewport(self._engine)
            show(self._real_time)
            return True
        except Exception as error:
            is_scene = isinstance(error, (UnshownError, ExportError, VelourError))
            reason = str(error) if isinstance(error, UnshownError) else _sentence(error)
            self._refusal = Refusal(reason, is_scene, depsgraph)
        self._drop_real_time()
        return False

    def _drop_real_time(self):
        if self._real_time:
            self._real_time.close()
        self._real_time = None

    def forget_scene(self):
        """Drops the exported scene, which must not be mistaken for the current one."""
        if self._real_time:
            self._real_time.forget_scene()
        self._close_job()
        self._drop_scene()
        engine = self._engine()
        if engine:
            engine.tag_redraw()

    def pause(self):
        """May be called from any thread; turn() continues later."""
        self._job.pause()

    def turn(self):
        """Called between redraws. False: there is nothing to wait for."""
        engine = self._engine()
        if engine is None:
            self.close()
        if not self._job:
            return False
        if viewport_clock.is_paused():
            self.pause()
            return True
        if self._key is None or (self._changes and not self._job.must_be_seen()):  # draw() handles it
            engine.tag_redraw()
            return True
        is_due, has_more = self._job.turn()
        if is_due:
            engine.tag_redraw()
        return has_more

    def _take_up(self, context, depsgraph, is_told):
        """Applies changes of the scene. `is_told`: the depsgraph says what has changed."""
        try:
            look = Look(context, depsgraph)
            if self._live is None:
                self._export(depsgraph, look)
                return
            if is_told:
                self._changes.add(self._live.changes(depsgraph, look))
                if self._changes:
                    self._job.await_first(_PATIENCE)
            if self._changes and not self._job.must_be_seen():  # otherwise turn() returns to them
                self._change(depsgraph, look)
        except Exception as error:
            self._scene_error = _sentence(error)
            self._close_job()
            self._drop_scene()

    def _export(self, depsgraph, look):
        self._close_job()
        self._drop_scene()
        self._live = LiveExport(depsgraph, look)

    def _change(self, depsgraph, look):
        changes, self._changes = self._changes, Changes()
        self._job.halt()
        self._key = None
        if changes.everything:
            self._export(depsgraph, look)
        else:
            self._live.update(changes, depsgraph, look)

    def _follow(self, context, depsgraph):
        """Applies changes of the view and of the render options."""
        if self._live is None:
            return
        self._job.raise_failure()
        frame = viewport_frame(context, depsgraph)
        self._place = frame and frame.place
        if frame is None:
            self._close_job()
            return
        options = viewport_options(depsgraph, frame.view)
        is_same = bool(self._job) and options == self._job.options
        if is_same and frame.key() == self._key:
            return
        if is_same and self._key is not None and self._job.is_unseen():
            return  # turn() returns to it: otherwise a view in constant motion would show nothing
        self._restart(frame, options)

    def _restart(self, frame, options):
        self._job.await_first(_PATIENCE)
        self._job.halt()
        frame.view.add_to(self._live.scene)
        self._job.restart(self._live.scene, options)
        self._key = frame.key()
        viewport_clock.watch(self)
        self._job.await_first(_PROMPT)

    def _close_job(self):
        self._job.close()
        self._key = None

    def _drop_scene(self):
        if self._live:
            self._live.close()
        self._live, self._changes = None, Changes()

    def _show(self, scene):
        self._job.take_picture()
        if self._live:
            self._draw_picture(scene)

    def _draw_picture(self, scene):
        if self._place:
            self._job.picture.draw(self._engine(), scene, self._place, film_exposure(scene))

    def _progress(self):
        if not self._job:
            return ""
        options = self._job.options
        return samples_text(self._job.picture.samples, options["spp"], options["split"])


def _sentence(error):
    """The error as one line for the viewport."""
    if isinstance(error, (ExportError, VelourError)):
        return str(error)
    log.error("viewport failed", exc_info=error)
    return f"Velour failed unexpectedly: {type(error).__name__}: {error}"


@bpy.app.handlers.persistent
def _forget_scenes(*_arguments):
    """After undo, redo and loading, other datablocks may lie at the addresses of exported ones."""
    for viewport in tuple(_all):
        viewport.forget_scene()


def _handlers():
    handlers = bpy.app.handlers
    return handlers.undo_post, handlers.redo_post, handlers.load_post


def attach():
    for handlers in _handlers():
        handlers.append(_forget_scenes)


def detach():
    for handlers in _handlers():
        handlers.remove(_forget_scenes)
