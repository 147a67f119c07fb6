"""Runs a chapter inside Blender's window: `--python inside.py -- FOLDER`; FOLDER/task.json names it."""

import importlib
import json
import math
import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "blend-tests"))

from support import blender, window

from guide.desk import Desk


def main():
    folder = Path(sys.argv[sys.argv.index("--") + 1])
    task = json.loads((folder / "task.json").read_text())
    # The window must exist first.
    bpy.app.timers.register(lambda: _start(folder, task), first_interval=1.0)


def _start(folder, task):
    blender.enable_addon()
    bpy.context.preferences.view.show_tooltips = False  # they would appear in pictures at random

    def steps(folder):
        chapter = importlib.import_module(f"guide.{task['chapter']}")
        desk, facts = Desk(folder), {"blender": bpy.app.version_string}
        try:
            yield from chapter.steps(desk, folder / task["measurement"], facts)
        except Exception:
            desk.picture_of_window("failed", height=None)
            raise
        (folder / "facts.json").write_text(json.dumps(facts))

    window.run(folder, (steps,), seconds=math.inf)


main()
