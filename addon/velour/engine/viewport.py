"""The rendered viewport: what one 3D viewport shows of the scene while it is looked at and changed.

The main thread exports and draws; a job of the library renders. A change stops the job, goes into the
library's scene, and the job starts anew, coarse first.
"""

import logging
import time
import weakref

from ..export import ExportError, Notes, export_scene
from ..export.film import film_exposure
from ..export.viewport import viewport_frame
from ..native import ProgressiveJob, VelourError
from . import viewport_clock
from .options import viewport_options

log = logging.getLogger(__package__)

_LEAST_SECONDS = 0.05  # between two pictures
_SHARE = 0.1  # of the main thread's time, at most, for pictures that only grow less noisy


class Viewport:
    def __init__(self, engine):
        self._engine = weakref.ref(engine)
        self._scene = None  # the library's
        self._job = None
        self._options = None  # of the job
        self._key = None  # of what the job shows
        self._place = None
        self._is_waiting = False  # the job begins when it is no longer paused
        self._picture = None  # of the job, that is drawn
        self._screen = None
        self._error = ""
        self._drawn_at = self._drawn_in = 0.0  # seconds

    def close(self):
        viewport_clock.forget(self)
        if self._job:
            self._job.close()
        if self._scene:
            self._scene.close()

    def update(self, context, depsgraph):
        """The scene has changed, or is shown for the first time."""
        self._guard(self._export, context, depsgraph)

    def draw(self, context, depsgraph):
        self._guard(self._follow, context, depsgraph)
        self._guard(self._show, depsgraph.scene_eval)
        self._say()

    def pause(self):
        """Called from any thread; turn() goes on later."""
        job = self._job
        if job and not job.closed:
            job.cancel()

    def turn(self):
        """Between redraws. False: there is nothing to wait for."""
        engine = self._engine()
        if engine is None or self._job is None or self._error:
            return False
        state = self._job.poll().state
        if viewport_clock.is_paused():
            self.pause()
            return True
        if self._is_waiting or state == "cancelled":
            self._start()
            return True
        if state == "failed":
            self._guard(self._job.wait)
        if self._error or self._is_news():
            engine.tag_redraw()
        return not self._error and (state == "running" or self._is_behind())

    def _is_behind(self):
        return self._picture is None or self._job.picture().version != self._picture.version

    def _is_news(self):
        """Whether there is a picture worth the time that it takes to draw."""
        picture = self._job.picture()
        if picture.width == 0 or (self._picture and picture.version == self._picture.version):
            return False
        return time.monotonic() - self._drawn_at > max(_LEAST_SECONDS, self._drawn_in / _SHARE)

    def _guard(self, step, *arguments):
        try:
            step(*arguments)
        except (ExportError, VelourError) as error:
            self._fail(str(error))
        except Exception as error:
            log.exception("viewport failed")
            self._fail(f"Velour failed unexpectedly: {type(error).__name__}: {error}")

    def _fail(self, sentence):
        """One line in the viewport until the next change."""
        self._error = sentence
        if self._job:
            self._job.close()
        self._job = self._options = self._key = None

    def _export(self, context, depsgraph):
        self._error = ""
        frame = viewport_frame(context, depsgraph)
        if self._job:
            self._job.close()
        self._job = self._options = self._key = None
        if frame is None:
            return
        scene, self._scene = self._scene, None
        if scene:
            scene.close()
        self._scene = export_scene(depsgraph, frame.view, Notes(), strict=False).scene

    def _follow(self, context, depsgraph):
        """Takes up what the viewport looks through, and how it is rendered."""
        if self._error or self._scene is None:
            return
        frame = viewport_frame(context, depsgraph)
        if frame is None:
            self._fail("")
            self._place = None
            return
        self._place = frame.place
        options = viewport_options(depsgraph.scene_eval, frame.view)
        if self._job and options == self._options and frame.key() == self._key:
            return
        if (
            self._job
            and options == self._options
            and self._job.picture().width == 0
            and self._job.poll().running
        ):
            viewport_clock.watch(self)  # else a view that turns on and on would never be seen
            return
        self._restart(frame, options)

    def _restart(self, frame, options):
        if self._job:
            self._job.stop()
        frame.view.add_to(self._scene)
        self._scene.commit()
        if options == self._options:
            self._job.restart()
        else:
            if self._job:
                self._job.close()
            self._job, self._options = ProgressiveJob.of(self._scene, **options), options
            self._picture = None
        self._key = frame.key()
        self._start()

    def _start(self):
        self._is_waiting = viewport_clock.is_paused()
        if not self._is_waiting:
            self._job.start()
        viewport_clock.watch(self)

    def _show(self, scene):
        from .viewport_picture import ViewportPicture  # needs a window

        begin = time.monotonic()
        if self._screen is None:
            self._screen = ViewportPicture()
        if self._job and self._is_behind():
            picture = self._screen.read(self._job, film_exposure(scene))
            if picture.width:
                self._picture, self._drawn_at = picture, begin
        if self._place:
            self._screen.draw(self._engine(), scene, self._place)
        self._drawn_in = time.monotonic() - begin

    def _say(self):
        self._engine().update_stats("Velour", self._error or self._progress())

    def _progress(self):
        if self._options is None or self._picture is None:
            return ""
        return f"Sample {self._picture.samples}/{self._options['spp']}"
