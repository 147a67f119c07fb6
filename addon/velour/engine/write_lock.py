"""A guard against a race in Blender between panels and render threads.

While a panel draws, Blender forbids Python to write data; each call of a Python class saves that state and
puts it back at its end. If a render thread enters Python in the middle of a drawing panel, it saves "no
writes" and puts that back when the render ends: from then on no timer and no handler of any add-on can
write. Seen in 3.4.1 within seconds while previews render and panels redraw.

The interpreter hands over to a waiting thread after a switch interval, by default 5 ms, less than a slow
panel takes. With a longer one the hand-over falls between two panels, where Blender releases the
interpreter anyway.
"""

import sys

import bpy

_SECONDS = 0.1
_before = None


def attach():
    """Only with a window: without one nothing draws."""
    global _before
    if not bpy.app.background and sys.getswitchinterval() < _SECONDS:
        _before = sys.getswitchinterval()
        sys.setswitchinterval(_SECONDS)


def detach():
    global _before
    if _before is not None:
        sys.setswitchinterval(_before)
        _before = None
