"""A chapter inside Blender's window; task.json names it."""

import json
import math
import sys
from pathlib import Path

import bpy
from support import window

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from guide import chapters
from guide.desk import Desk


def start(folder):
    """Called by the harness when the window exists."""
    task = json.loads((folder / "task.json").read_text())
    bpy.context.preferences.view.show_tooltips = False  # they would appear in pictures at random

    def steps(folder):
        desk, facts = Desk(folder), {"blender": bpy.app.version_string}
        try:
            yield from getattr(chapters, task["chapter"])(desk, folder / task["measurement"], facts)
        except Exception:
            desk.picture_of_window("failed", height=None)
            raise
        (folder / "result.json").write_text(json.dumps(facts))

    window.run(folder, (steps,), seconds=math.inf, viewport=True)
