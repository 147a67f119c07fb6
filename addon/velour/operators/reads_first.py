"""Base of operators that read a file on another thread and then act immediately, without queueing."""

from ..core.read_job import ReadJob
from ..export import ExportError
from ..native import VelourError
from .background_job import redraw


class ReadsFirst:
    """Operator mixin. `_read(context)` returns a function that does not access Blender, and sets `_subject`,
    a name for the status bar. `_use(context, found)` takes the function's result and returns the operator's;
    it must cope with changes made to the .blend meanwhile.

    These operators do not wait for running fits, since they need little CPU time.
    """

    _reading = _timer = None

    def execute(self, context):
        """Runs synchronously."""
        try:
            return self._use(context, self._read(context)())
        except (ExportError, VelourError) as error:
            return self._fail(error)

    def invoke(self, context, _event):
        try:
            self._reading = ReadJob(self._read(context)).start()
        except (ExportError, VelourError) as error:
            return self._fail(error)
        self._timer = context.window_manager.event_timer_add(0.05, window=context.window)
        context.window_manager.modal_handler_add(self)
        self._say(context, self._subject)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        try:
            if not self._reading.wait(timeout=0.0):
                return {"PASS_THROUGH"}
            self._leave(context)
            return self._use(context, self._reading.result())
        except (ExportError, VelourError) as error:
            self._leave(context)
            return self._fail(error)
        except BaseException:
            self._leave(context)
            raise

    def cancel(self, context):
        """Called when Blender closes the window or loads another file."""
        self._leave(context)
        self._reading.close()

    def _leave(self, context):
        if self._timer is not None:
            context.window_manager.event_timer_remove(self._timer)
            self._timer = None
        self._say(context, "")

    def _say(self, context, subject):
        context.window_manager.velour.reading = subject
        redraw(context)

    def _fail(self, error):
        self.report({"ERROR"}, str(error))
        return {"CANCELLED"}
