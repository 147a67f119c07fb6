"""What runs in Blender: main(task), or in a window the generator steps(folder, task); and their scenes."""

import importlib
import json


def start(script, task, report):
    """Calls main() of a script of this folder and writes what it returns to the file `report`."""
    found = importlib.import_module(f"{__name__}.{script}").main(json.loads(task))
    if found is not None:
        with open(report, "w") as file:
            json.dump(found, file)
