"""What operators share that act at once when they have read a file: beside the window, and in no line."""

from ..core.read_job import ReadJob
from ..export import ExportError
from ..native import VelourError
from .background_job import redraw


class ReadsFirst:
    """Mixin of an operator. `_read(context)` returns a function that knows nothing of Blender, and sets
    `_subject`, a name for the status bar. `_use(context, found)` takes what the function returned, and gives
    what the operator returns; what was done to the .blend meanwhile is for it to find out.

    A fit that runs does not keep them waiting: they need no processor to speak of.
    """

    _reading = _timer = None

    def execute(self, context):
        """Waits for the file."""
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
        """Blender closes the window or loads another file."""
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
