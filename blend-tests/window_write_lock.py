"""The window: after Blender's race between a drawing panel and a render thread add-ons can write."""

import threading
from unittest import mock

import bpy

from support import inputs, window

_SECONDS = 10.0  # after which what is waited for has failed
_found = {}


class _Thread(bpy.types.Operator):
    """In the place of a render: Blender's calls of Python classes are alike."""

    bl_idname = "test.thread"
    bl_label = "Thread"

    begun, over = threading.Event(), threading.Event()

    @classmethod
    def poll(cls, _context):
        if threading.current_thread() is not threading.main_thread():
            cls.begun.set()
            cls.over.wait(_SECONDS)
        return False


class _Panel(bpy.types.Panel):
    """Which a thread enters Python in the middle of."""

    bl_idname = "TEST_PT_panel"
    bl_label = "Panel"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "material"

    thread = None

    def draw(self, _context):
        if _Panel.thread is not None and not _Thread.begun.is_set():
            _Panel.thread.start()
            assert _Thread.begun.wait(_SECONDS)


def start(folder):
    """Called by the harness once the window is there."""
    bpy.utils.register_class(_Thread)
    bpy.utils.register_class(_Panel)
    window.run(folder, (by_nobody_else, allowed_again, idle))


def _write_lock():
    return inputs.module("engine.write_lock")


def _can_write():
    try:
        bpy.context.scene.frame_end += 1
    except AttributeError:
        return False
    return True


def _race():
    """Turns until a panel was drawn that a thread began in and outlasts; the thread."""
    for event in (_Thread.begun, _Thread.over):
        event.clear()
    _Panel.thread = thread = threading.Thread(target=bpy.ops.test.thread.poll)
    yield from window.show_properties("MATERIAL")
    assert _Thread.begun.is_set(), "the panel was not drawn"
    assert _can_write(), "the panel is over, and the thread runs still"
    _Panel.thread = None
    return thread


def _end(thread):
    _Thread.over.set()
    thread.join(_SECONDS)


def by_nobody_else(folder):
    """The control: Blender alone stays in that state, whatever it draws. 5.2 does not get into it."""
    with mock.patch.object(_write_lock(), "_allow_writes"):
        _end((yield from _race()))
        for area in window.first().screen.areas:
            area.tag_redraw()
        yield 0.5
        _found["stays"] = not _can_write()
    print(f"writes are {'forbidden' if _found['stays'] else 'allowed'} after the race", flush=True)
    assert _found["stays"] or bpy.app.version >= (5, 2)
    yield 0.1
    assert _can_write()


def allowed_again(folder):
    """What forbids writes is ended within a turn, as often as it comes."""
    for _ in range(3):
        _end((yield from _race()))
        assert _write_lock().writes_are_forbidden() == (not _can_write()) == _found["stays"]
        yield 0.1
        assert _can_write()
        assert not _write_lock().writes_are_forbidden()
        bpy.ops.ed.undo_push(message="an operator")


def idle(folder):
    """Looking for it does not keep a window busy that has nothing to do."""
    yield 0.5
    seconds = []
    turn = window.timed(_write_lock()._turn, seconds)
    for _ in range(1000):
        turn()
    assert not _write_lock().writes_are_forbidden()
    print(f"a turn takes {1e6 * sorted(seconds)[500]:.1f} microseconds")
    assert sorted(seconds)[500] < 20e-6
