"""Works around a race in Blender between panels and render threads.

While a panel draws, Blender forbids Python to write data. Each call of a Python class saves that state and
restores it at its end. A render thread that enters Python while a panel draws (draw() may be slow or wait for
the disk) saves "no writes"; if it outlasts the panel, it restores that state when nothing draws any more.
From then on no timer or handler of any add-on can write ("can't modify blend data in this state") until
Blender exits. Previews of any engine written in Python cause it in 3.4 and 4.3; 5.2 is not affected.

No Python call allows writes again, but two calls that end out of order do, just as they forbade them: Blender
allows writes during the getter of a property. A poll() that another thread begins in that time saves this
state and restores it after the getter has returned.
"""

import threading

import bpy

_WAIT_SECONDS = 1.0  # for a thread to begin; it takes a tenth of a millisecond


class VELOUR_OT_allow_writes(bpy.types.Operator):
    bl_idname = "velour.allow_writes"
    bl_label = "Allow Writes"
    bl_description = "Internal operator"
    bl_options = {"INTERNAL"}

    @classmethod
    def poll(cls, _context):
        if _cure is not None and threading.current_thread() is _cure.thread:
            _cure.begun.set()
            _cure.over.wait(_WAIT_SECONDS)
        return False


class _Cure:
    """A poll() that lasts from begin() to end()."""

    def __init__(self):
        self.begun, self.over = threading.Event(), threading.Event()
        self.thread = threading.Thread(target=bpy.ops.velour.allow_writes.poll, name="Velour: writes")

    def begin(self):
        self.thread.start()
        self.begun.wait(_WAIT_SECONDS)

    def end(self):
        self.over.set()
        if self.begun.is_set():
            self.thread.join()


_cure = None


def attach():
    """Only with a window: without one nothing draws."""
    if not bpy.app.background:
        bpy.types.WindowManager.velour_write_lock = bpy.props.BoolProperty(get=_getter, options={"HIDDEN"})
        bpy.app.timers.register(_turn, persistent=True)


def detach():
    if bpy.app.timers.is_registered(_turn):
        bpy.app.timers.unregister(_turn)
        del bpy.types.WindowManager.velour_write_lock


class _NoClassOfBlender:
    """Used instead of `object`: Blender reads a dictionary that built-in classes lack since Python 3.12."""


def writes_are_forbidden():
    """Call from timers, which should always be allowed to write. Takes a microsecond."""
    try:
        bpy.utils.register_class(_NoClassOfBlender)  # always refused; a forbidden write is the first reason
    except RuntimeError as refusal:
        return "readonly" in str(refusal)
    return False


def _turn():
    """Called in each turn of Blender's main loop, so that later timers can write."""
    if writes_are_forbidden():
        _allow_writes()
    return 0.0


def _allow_writes():
    global _cure
    _cure = _Cure()
    try:
        _ = bpy.context.window_manager.velour_write_lock
    finally:
        _cure.end()
        _cure = None


def _getter(_window_manager):
    if _cure is not None and not _cure.begun.is_set():
        _cure.begin()
    return True
