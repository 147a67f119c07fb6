"""What operators share that work on while a window stays usable."""

import time


class BackgroundJob:
    """Mixin: a timer, the progress that panels and the status bar show, Esc and the panel's cross."""

    _timer = None

    def _is_refused(self, context):
        """One at a time: true, with an error said, while another is running."""
        running = context.window_manager.velour.running
        if running:
            self.report({"ERROR"}, "A fit is running already; wait for it, or cancel it.")
        return running

    def _enter(self, context, material_name):
        """What `invoke` returns once the work has begun."""
        state = context.window_manager.velour
        state.running, state.cancel_requested, state.material_name = True, False, material_name
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


def console_progress():
    """Prints a line when the stage changes and about once a second."""
    last = {"stage": None, "time": 0.0}

    def show(job):
        now = time.monotonic()
        if job.stage != last["stage"] or now - last["time"] > 1.0:
            last.update(stage=job.stage, time=now)
            print(f"Velour: {job.stage} {job.fraction:.0%}", flush=True)

    return show
