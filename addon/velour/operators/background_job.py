"""What operators share that work on while a window stays usable."""

import time

import bpy

from ..export import ExportError
from ..native import VelourError


class BackgroundJob:
    """Mixin: a timer, the progress that panels and the status bar show, Esc and the panel's cross."""

    _timer = None

    def _is_refused(self, context):
        """One at a time: true, with an error said, while another is running."""
        running = context.window_manager.velour.running
        if running:
            self.report({"ERROR"}, "A fit or a capture is running already; wait for it, or cancel it.")
        return running

    def _enter(self, context, subject):
        """What `invoke` returns once the work has begun."""
        state = context.window_manager.velour
        state.running, state.cancel_requested, state.subject = True, False, subject
        self._timer = context.window_manager.event_timer_add(0.1, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def _wants_to_stop(self, context, event):
        return event.type == "ESC" or context.window_manager.velour.cancel_requested

    def _show(self, context, stage, fraction):
        state = context.window_manager.velour
        state.fraction, state.stage = fraction, stage
        if context.workspace:
            context.workspace.status_text_set(f"Velour: {stage} {fraction:.0%}   Esc: Cancel")
        for window in context.window_manager.windows:
            for area in window.screen.areas:
                if area.type == "PROPERTIES":
                    area.tag_redraw()

    def _leave(self, context):
        context.window_manager.velour.running = False
        if self._timer is not None:
            context.window_manager.event_timer_remove(self._timer)
            self._timer = None
        if context.workspace:
            context.workspace.status_text_set(None)


class OneJob(BackgroundJob):
    """Mixin of an operator that is one job of the library, or a few one after the other.

    `_begin(context)` starts `_job` and sets `_subject`, `_finish()` takes the result, `_what` is its name.
    """

    def _goes_on(self):
        """Starts the next job as `_job`, where there is one."""
        return False

    def execute(self, context):
        """Waits for the result."""
        try:
            self._begin(context)
            while True:
                self._job.wait(console_progress() if bpy.app.background else None)
                result = self._finish()
                if not self._goes_on():
                    return result
        except (ExportError, VelourError) as error:
            return self._fail(error)

    def invoke(self, context, _event):
        """Starts the job and lets the artist go on working; Esc cancels."""
        if self._is_refused(context):
            return {"CANCELLED"}
        try:
            self._begin(context)
        except (ExportError, VelourError) as error:
            return self._fail(error)
        return self._enter(context, self._subject)

    def modal(self, context, event):
        if self._wants_to_stop(context, event):
            self._job.cancel()
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        try:
            if not self._job.wait(timeout=0.0):
                state = self._job.poll()
                self._show(context, state.stage, state.fraction)
                return {"PASS_THROUGH"}
            result = self._finish()
            if self._goes_on():
                return {"PASS_THROUGH"}
            self._leave(context)
            return result
        except (ExportError, VelourError) as error:
            self._leave(context)
            return self._fail(error)

    def cancel(self, context):
        """Blender closes the window or loads another file."""
        self._leave(context)
        self._job.close()

    def _fail(self, error):
        cancelled = isinstance(error, VelourError) and error.cancelled
        sentence = f"{self._what} was cancelled." if cancelled else str(error)
        self.report({"WARNING" if cancelled else "ERROR"}, sentence)
        return {"CANCELLED"}


def console_progress():
    """Prints a line when the stage changes and about once a second."""
    last = {"stage": None, "time": 0.0}

    def show(job):
        now = time.monotonic()
        if job.stage != last["stage"] or now - last["time"] > 1.0:
            last.update(stage=job.stage, time=now)
            print(f"Velour: {job.stage} {job.fraction:.0%}", flush=True)

    return show
