"""Runs steps(folder, task) of a module in a window of Blender and writes what it returns to result.json.

task.json has the task and the name of the module.
"""

import importlib
import json
import math
import sys
from pathlib import Path

from support import window

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))


def start(folder):
    """Called by the harness when the window exists."""
    task = json.loads((folder / "task.json").read_text())

    def steps(folder):
        result = yield from importlib.import_module(task["module"]).steps(folder, task)
        (folder / "result.json").write_text(json.dumps(result))

    window.run(folder, (steps,), seconds=math.inf, viewport=True)
