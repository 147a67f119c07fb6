"""A chapter inside Blender's window."""

import bpy

from . import chapters
from .desk import Desk


def steps(folder, task):
    bpy.context.preferences.view.show_tooltips = False  # they would appear in pictures at random
    desk, facts = Desk(folder), {"blender": bpy.app.version_string}
    try:
        yield from getattr(chapters, task["chapter"])(desk, folder / task["measurement"], facts)
    except Exception:
        desk.picture_of_window("failed", height=None)
        raise
    return facts
