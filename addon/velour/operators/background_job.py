"""What operators share that work on while a window stays usable."""

import time

import bpy

from ..export import ExportError
from ..native import Status, VelourError

TABS = ("MATERIAL", "OBJECT", "COLLECTION")  # of the Properties editor: their panels show the progress
_line = []  # of those that run or wait, the first runs


class _Ticket:
    """A place in line."""

    is_given_up = False


class BackgroundJob:
    """Mixin of a modal operator: a timer, a place in line, progress for panels and status bar, and its end.

    `_start(context)` begins the work when its turn has come; `_step(context)` gives what the operator
    returns, or None as long as the work goes on; `_stop()` gives that too, or None where a step will tell.

    Never with REGISTER: Adjust Last Operation and Repeat Last call `execute`, which holds the window.
    """

    _timer = None
    _ticket = None

    def _enter(self, context, subject):
        """What `invoke` returns once the work is ready to begin."""
        self._shown_as = subject
        self._ticket = _Ticket()
        _line.append(self._ticket)
        context.window_manager.velour.waiting = len(_line) - 1
        try:
            self._has_turn(context)
        except (ExportError, VelourError) as error:
            return self._end(context, self._fail(error))
        except BaseException:
            self._leave(context)
            raise
        self._timer = context.window_manager.event_timer_add(0.1, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        try:
            if self._ticket.is_given_up:
                raise VelourError(Status.CANCELLED, "It was taken out of the line.")
            result = self._wants_to_stop(context, event) and self._stop()
            if not result and event.type == "TIMER" and self._has_turn(context):
                result = self._step(context)
        except (ExportError, VelourError) as error:
            result = self._fail(error)
        except BaseException:
            self._leave(context)
            raise
        return self._end(context, result) if result else {"PASS_THROUGH"}

    def _has_turn(self, context):
        """Whether it is the first in line; the work begins when that comes true."""
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
        state.waiting = len(_line) - int(state.running)  # the next one, until its timer's turn, as well
        if self._timer is not None:
            context.window_manager.event_timer_remove(self._timer)
            self._timer = None
        redraw(context)


def give_up_waiting(context):
    """All but the one that runs; each says so at its next turn."""
    for ticket in _line[int(context.window_manager.velour.running) :]:
        ticket.is_given_up = True


def _over_progress(context, event):
    """Esc belongs to whatever the cursor is over: a tab that shows the progress, or the status bar."""
    areas = context.window.screen.areas if context.window else ()
    for area in areas:
        inside = 0 <= event.mouse_x - area.x < area.width and 0 <= event.mouse_y - area.y < area.height
        if inside:
            return area.type == "PROPERTIES" and area.spaces.active.context in TABS
    # The status bar is below all areas of the screen, the top bar above them.
    return all(event.mouse_y < area.y for area in areas)


def redraw(context):
    """The panels and the status bar."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "PROPERTIES":
                area.tag_redraw()
        # Makes the bar draw its header, and at once. The public status_text_set would take away what add-ons
        # append to that header.
        window.workspace.status_text_set_internal(None)


class OneJob(BackgroundJob):
    """Mixin of an operator that is one job of the library, or a few one after the other.

    `_begin(context)` makes `_job`, not yet started, and sets `_subject`; where the jobs before it may change
    what it reads, `_take_turn()` makes `_job`. `_finish()` takes the result, `_what` is its name.
    """

    _job = None
    _after_cancel = ""  # what may be done then

    def _take_turn(self):
        """Those before it are done."""

    def _goes_on(self):
        """Makes the next job `_job`, where there is one."""
        return False

    def execute(self, context):
        """Waits for the result."""
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
        """Lets the artist go on working: the job starts when those before it are done."""
        try:
            self._begin(context)
        except (ExportError, VelourError) as error:
            return self._fail(error)
        return self._enter(context, self._subject)

    def cancel(self, context):
        """Blender closes the window or loads another file."""
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
        sentence = f"{self._what} was cancelled{self._after_cancel}." if cancelled else str(error)
        self.report({"WARNING" if cancelled else "ERROR"}, sentence)
        return {"CANCELLED"}


class JobsInSteps(OneJob):
    """Mixin of an operator whose last jobs are those of `_steps`: next_job() gives each, at the end None."""

    _steps = None  # none: they are not wanted
    _next = None

    def _advance(self):
        """Whether another job is to be run before the steps' result is there."""
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
