"""Base of operators that run in the background while the window stays usable."""

import time

import bpy

from ..export import ExportError
from ..native import Status, VelourError
from .autosave import Autosave

TABS = ("MATERIAL", "OBJECT", "COLLECTION")  # tabs of the Properties editor whose panels show the progress
_line = []  # queue of tickets; the first one runs
_autosave = Autosave()


_SECONDS, _WAITING_SECONDS = 0.1, 2.0  # between looks at the job that runs, and at one that is queued


class _Ticket:
    """A place in the queue, and the timer that wakes its operator."""

    is_given_up = False
    _timer = _window = None

    def wake(self, context, seconds, window=None):
        """Wakes the operator at this interval from now on, in the window in which it was started."""
        self.sleep(context)
        self._window = window or self._window
        self._timer = context.window_manager.event_timer_add(seconds, window=self._window)

    def sleep(self, context):
        if self._timer is not None:
            context.window_manager.event_timer_remove(self._timer)
            self._timer = None


class BackgroundJob:
    """Mixin for a modal operator: timer, place in the queue, progress for panels and status bar, and cleanup.

    `_start(context)` begins the work when its turn has come; `_step(context)` returns the operator's result,
    or None while the work continues; `_stop()` returns it too, or None if a later step will.

    Never use REGISTER: Adjust Last Operation and Repeat Last call `execute`, which blocks the window.
    """

    _ticket = None
    _looked = 0.0  # time of the last step: the timers of other operators wake this one, too

    def _enter(self, context, subject):
        """Queues work that is ready to begin; returns the result of `invoke`."""
        self._shown_as = subject
        self._ticket = _Ticket()
        _line.append(self._ticket)
        state = context.window_manager.velour
        state.waiting, state.canceled = len(_line) - 1, ""
        try:
            self._has_turn(context)
        except (ExportError, VelourError) as error:
            return self._end(context, self._fail(error))
        except BaseException:
            self._leave(context)
            raise
        self._ticket.wake(context, _SECONDS if _line[0] is self._ticket else _WAITING_SECONDS, context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        _autosave.notice(event)
        try:
            if self._ticket.is_given_up:
                raise VelourError(Status.CANCELLED, "The job was removed from the queue.")
            result = self._wants_to_stop(context, event) and self._stop()
            if not result and event.type == "TIMER" and self._is_due() and self._has_turn(context):
                result = self._step(context)
        except (ExportError, VelourError) as error:
            result = self._fail(error)
        except BaseException:
            self._leave(context)
            raise
        return self._end(context, result) if result else {"PASS_THROUGH"}

    def _is_due(self):
        now = time.monotonic()
        if now - self._looked < 0.9 * _SECONDS:
            return False
        self._looked = now
        return True

    def _has_turn(self, context):
        """Whether it is first in the queue; starts the work as soon as it is."""
        if _line[0] is not self._ticket:
            return False
        state = context.window_manager.velour
        if not state.running:
            state.running, state.cancel_requested, state.subject = True, False, self._shown_as
            state.waiting = len(_line) - 1
            self._start(context)
        return True

    def _wants_to_stop(self, context, event):
        if _line[0] is not self._ticket or not context.window_manager.velour.running:
            return False
        escaped = event.type == "ESC" and event.value == "PRESS" and _over_progress(context, event)
        return escaped or context.window_manager.velour.cancel_requested

    def _show(self, context, stage, fraction, seconds_left=None):
        state = context.window_manager.velour
        state.fraction, state.stage = fraction, stage
        state.seconds_left = -1.0 if seconds_left is None else seconds_left
        redraw(context)

    def _end(self, context, result):
        self._leave(context)
        return result

    def _leave(self, context):
        if self._ticket in _line:
            if _line.index(self._ticket) == 0:
                context.window_manager.velour.running = False
            _line.remove(self._ticket)
        state = context.window_manager.velour
        state.waiting = len(_line) - int(state.running)  # includes the next job until its timer event
        self._ticket.sleep(context)
        if _line and not state.running:
            _line[0].wake(context, _SECONDS)
        redraw(context)


def give_up_waiting(context):
    """Cancels all queued jobs except the running one; each reports it at its next event."""
    for ticket in _line[int(context.window_manager.velour.running) :]:
        ticket.is_given_up = True


def _over_progress(context, event):
    """Whether the cursor is over a tab that shows the progress, or over the status bar, where Esc cancels."""
    areas = context.window.screen.areas if context.window else ()
    for area in areas:
        inside = 0 <= event.mouse_x - area.x < area.width and 0 <= event.mouse_y - area.y < area.height
        if inside:
            return area.type == "PROPERTIES" and area.spaces.active.context in TABS
    # The status bar is below all areas of the screen, the top bar above them.
    return all(event.mouse_y < area.y for area in areas)


def redraw(context):
    """Redraws the panels and the status bar."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "PROPERTIES":
                area.tag_redraw()
        # Redraws the status bar's header immediately. The public status_text_set would remove what add-ons
        # append to that header.
        window.workspace.status_text_set_internal(None)


class OneJob(BackgroundJob):
    """Mixin for an operator that runs one job of the library, or several in sequence.

    `_begin(context)` makes `_job`, not yet started, and sets `_subject`; if earlier jobs may change what it
    reads, `_take_turn()` makes `_job` instead. `_finish()` takes the result; `_what` names it in messages.
    """

    _job = None
    _after_cancel = ""  # appended to the message after a cancel

    def _take_turn(self):
        """Called when earlier jobs are done."""

    def _goes_on(self):
        """Sets `_job` to the next job; returns whether there is one."""
        return False

    def execute(self, context):
        """Runs synchronously."""
        try:
            self._begin(context)
            self._take_turn()
            while True:
                self._job.start().wait(console_progress() if bpy.app.background else None)
                result = self._finish()
                if not self._goes_on():
                    return result
        except (ExportError, VelourError) as error:
            return self._fail(error)

    def invoke(self, context, _event):
        """Runs in the background: the job starts when earlier ones are done."""
        try:
            self._begin(context)
        except (ExportError, VelourError) as error:
            return self._fail(error)
        return self._enter(context, self._subject)

    def cancel(self, context):
        """Blender closes the window or loads another file, or a dialog before the job is left."""
        if self._ticket is None:
            return
        state = context.window_manager.velour
        state.canceled = f"{self._what} was canceled: its window was closed, or another file was opened."
        state.canceled_subject = getattr(self, "_subject", "")
        self._leave(context)
        if self._job is not None:
            self._job.close()

    def _start(self, _context):
        self._take_turn()
        self._job.start()

    def _stop(self):
        self._job.cancel()

    def _step(self, context):
        if not self._job.wait(timeout=0.0):
            _autosave.step(context)
            state = self._job.poll()
            self._show(context, state.stage, state.fraction, state.seconds_left)
            return None
        result = self._finish()
        if not self._goes_on():
            return result
        self._job.start()
        return None

    def _fail(self, error):
        cancelled = isinstance(error, VelourError) and error.cancelled
        sentence = f"{self._what} was canceled{self._after_cancel}." if cancelled else str(error)
        if cancelled:
            state = bpy.context.window_manager.velour
            state.canceled, state.canceled_subject = sentence, getattr(self, "_subject", "")
        self.report({"WARNING" if cancelled else "ERROR"}, sentence)
        return {"CANCELLED"}


class JobsInSteps(OneJob):
    """Mixin for an operator that ends with the jobs of `_steps`: next_job() returns each, then None."""

    _steps = None  # None: no further jobs
    _next = None

    def _advance(self):
        """Takes the next job of the steps; returns whether there is one."""
        self._next = self._steps.next_job() if self._steps else None
        return self._next is not None

    def _goes_on(self):
        if self._next is None:
            return False
        self._job, self._next = self._next, None
        return True


def console_progress():
    """Prints a line when the stage changes and about once a second."""
    last = {"stage": None, "time": 0.0}

    def show(job):
        now = time.monotonic()
        if job.stage != last["stage"] or now - last["time"] > 1.0:
            last.update(stage=job.stage, time=now)
            print(f"Velour: {job.stage} {job.fraction:.0%}", flush=True)

    return show
